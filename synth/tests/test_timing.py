# SPDX-License-Identifier: Apache-2.0
"""What is read out of OpenSTA's reports."""

import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import standard_cells, timing, tools
from dtof_synth.errors import FlowError, found_in

ROOT = Path(__file__).resolve().parents[2]


class Slacks(unittest.TestCase):
    def test_setup_stands_before_hold(self) -> None:
        path = "Startpoint: a\nEndpoint: b\n  0.30   data arrival time\n 0.1000   slack (MET)\n"
        output = "".join(f"{prefix}_SLACK 0.1 0.2\n{prefix}_PATH_MAX\n{path}" for prefix in ("DTOF", "DTOF_MARGIN"))
        output += ("DTOF_TRANSITION\nDTOF_END\nDTOF_CLOSING_PERIOD 2.5\nDTOF_FAST_SLACK 0.05\n"
                   "DTOF_RESET\n**async_default** 0.4000\n**async_default** 0.3000\nDTOF_END\n")
        report = timing.Report(output, {})
        found = report.timing()
        self.assertEqual((found.slack, found.hold_slack, found.fast_slack, found.fmax_mhz), (0.1, 0.2, 0.05, 400.0))
        margin = report.margin()
        self.assertEqual((margin.slack, margin.hold_slack, margin.reset_slack), (0.1, 0.2, 0.3))
        self.assertEqual((margin.start, margin.end), ("a", "b"))

    def test_a_corner_without_a_check_of_the_reset_is_refused(self) -> None:
        output = "DTOF_MARGIN_SLACK 0.1 0.2\nDTOF_MARGIN_PATH_MAX\nStartpoint: a\nEndpoint: b\n 0.1  slack (MET)\nDTOF_RESET\nDTOF_END\n"
        with self.assertRaisesRegex(FlowError, "no check of the reset"):
            timing.Report(output, {}).margin()


class Sections(unittest.TestCase):
    """What each step of synth/sta/timing.tcl prints."""

    def test_warnings_of_check_setup(self) -> None:
        report = timing.Report("DTOF_CHECK\nWarning: There are 2 unconstrained endpoints.\n  a/D\n  b/D\nWarning: There is 1 unclocked register pin.\n"
                               "  c/CK\nloop of gates\nDTOF_END\nDTOF_SLACK 1 2\n", {})
        self.assertEqual(report.unchecked, {"unconstrained endpoints": ["a/D", "b/D"], "unclocked register pin": ["c/CK"], "loop of gates": []})

    def test_steps_that_repair(self) -> None:
        report = timing.Report("DTOF_SPARE\na/A 0.125\nb/B -0.5\nDTOF_END\nDTOF_RESIZED a_column i INV_X2\nDTOF_RESIZED top j INV_X4\n"
                               "DTOF_DROPPED a_column k\nDTOF_RESIZED_SLACK 0.031\nDTOF_RESIZED_AREA -42.5\n", {})
        self.assertEqual(report.spare, {"a/A": 0.125, "b/B": -0.5})
        self.assertEqual(report.resized, [("a_column", "i", "INV_X2"), ("top", "j", "INV_X4")])
        self.assertEqual((report.dropped, report.resized_slack, report.resized_area), ([("a_column", "k")], 0.031, -42.5))

    def test_paths_that_are_too_early_without_those_to_a_port(self) -> None:
        path = ("Startpoint: a\nEndpoint: {end}\n 0.00 0.00 ^ a/CK (DFF_X1)\n 0.05 0.05 ^ a/Q (DFF_X1)\n 0.00 0.05 ^ g/A1 (NAND2_X1)\n"
                " 0.02 0.07 v g/Y (NAND2_X1)\n 0.00 0.07 v {end} (x)\n   0.07   data arrival time\n 0.00 0.10 ^ b/CK (DFF_X1)\n   -0.0300   slack (VIOLATED)\n")
        report = timing.Report(f"DTOF_EARLY\n{path.format(end='b/D')}{path.format(end='q_o')}DTOF_END\n", {})
        self.assertEqual(report.early, [timing.TimedPath(["g/A1", "b/D"], -0.03)])

    def test_slow_edges_and_srams_are_counted(self) -> None:
        path = "Startpoint: a\nEndpoint: b\n  0.30   data arrival time\n 0.1000   slack (MET)\n"
        report = timing.Report(f"DTOF_SLACK 0.1 0.2\nDTOF_PATH_MAX\n{path}DTOF_TRANSITION\na VIOLATED\nb VIOLATED\nDTOF_MIN_PERIOD\nm 2.0 (VIOLATED)\n"
                               "DTOF_END\nDTOF_CLOSING_PERIOD 2.0\nDTOF_FAST_SLACK -0.5\n", {})
        self.assertEqual(report.timing(), timing.Timing(0.1, 0.2, -0.5, 500.0, "a", "b", 0, 2))
        self.assertTrue(report.too_fast_for_sram)
        self.assertFalse(timing.Report("DTOF_MIN_PERIOD\nm 2.0\nDTOF_END\nVIOLATED\n", {}).too_fast_for_sram)

    def test_a_report_without_a_path_is_refused(self) -> None:
        with self.assertRaisesRegex(FlowError, "no timing path"):
            timing.Report("DTOF_PATH_MAX\nNo paths found.\nDTOF_END\n", {})._slowest_path("DTOF_PATH_MAX")


class Measure(unittest.TestCase):
    def measure(self, steps: tuple[str, ...], output: str = "") -> tuple[timing.Report, dict]:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / timing.NAMES).write_text('{"a_1_": "a[1]"}', encoding="utf-8")
            files = timing.Netlist("some", folder / "t.v", folder / "t.spef", [Path("a.lib"), Path("b.lib")], "wires", "t")
            with mock.patch.object(timing.tools, "write_settings") as written, \
                    mock.patch.object(timing.tools, "run_sta", return_value=output) as self.sta:
                found = timing.measure(files, ROOT, 330.0, folder / "sta.log", steps, {"more": ["x"]})
            self.settings_file, settings = written.call_args.args
            self.assertEqual((self.settings_file, settings.pop("netlist"), settings.pop("wires")),
                             (folder / "sta.tcl", folder / "t.v", folder / "t.spef"))
            return found, settings

    def test_what_opensta_is_given(self) -> None:
        # 330 and 500 MHz. Margins: the slew of an inverter with a fan-out of four, the load of ten inverters; a net toggles every ten clocks.
        found, settings = self.measure(("margins",), "said")
        self.assertEqual(settings, {
            "steps": ["margins"], "liberty_files": [Path("a.lib"), Path("b.lib")], "top": "t", "wire_load": "wires",
            "constraints": ROOT / "constraints/dtof.sdc", "margins": ROOT / "constraints/margins.sdc", "target_period": "3.030303",
            "fast_period": "2.000000", "activity": 0.1, "slew": f"{standard_cells.FO4_NS:.4f}", "load": f"{10 * standard_cells.CINV_FF:.4f}",
            "more": ["x"]})
        self.assertEqual(self.sta.call_args.args[0], ROOT / "synth/sta/timing.tcl")
        self.assertEqual((found.output, found.called), ("said", {"a_1_": "a[1]"}))

    def test_a_clock_that_is_too_fast_for_an_sram_stops_the_flow(self) -> None:
        output = "DTOF_MIN_PERIOD\nm (VIOLATED)\nDTOF_END\n"
        self.measure(("margins",), output)
        with self.assertRaisesRegex(FlowError, "some: the clock is faster than an SRAM's minimum period"):
            self.measure(("nominal",), output)


class Names(unittest.TestCase):
    def test_register_names_are_rtl_names(self) -> None:
        self.assertEqual(timing._readable("u_pixel_sequencer_first_slot_t1_o_DFFR_X1_copy5604", {
            "u_pixel_sequencer_first_slot_t1_o_DFFR_X1_copy5604": r"u_pixel_sequencer.first_slot_t1_o\\DFFR_X1_copy5604"}),
                         "u_pixel_sequencer.first_slot_t1_o")
        self.assertEqual(timing._readable(r"g_column[9].g_ez_pointer.u_column/u_pointer_builder.word_q[12]\\DFF_X1", {}),
                         "column u_pointer_builder.word_q[12]")
        self.assertEqual(timing._readable("g_column[0].genblk1.u_column/u_b.u_peak_sram.u_words.g_one_port.u_macro.g_160x6.u_macro", {}),
                         "column u_b.u_peak_sram")

    def test_the_slowest_path_is_that_of_the_least_slack(self) -> None:
        # A group of paths is reported after the other: the reset's first, then the clock's.
        report = """DTOF_PATH_MAX
Startpoint: rst_ni (input port clocked by clk)
Endpoint: c (recovery check against rising-edge clock clk)
  0.60 0.60 ^ rst_ni (in)
  0.00 0.60 ^ c/RN (DFFR_X1)
       0.60   data arrival time
  0.00 3.00 ^ c/CK (DFFR_X1)
             2.4000   slack (MET)
Startpoint: a (rising edge-triggered flip-flop clocked by clk)
Endpoint: b (rising edge-triggered flip-flop clocked by clk)
  0.00 0.00 ^ a/CK (DFF_X1)
  0.10 0.10 ^ a/Q (DFF_X1)
  0.10 0.20 v n1/Y (NAND2_X1)
  0.10 0.30 ^ n2/Y (INV_X1)
  0.00 0.30 ^ b/D (DFF_X1)
       0.30   data arrival time
  0.00 0.20 ^ b/CK (DFF_X1)
             -0.1000   slack (VIOLATED)
"""
        self.assertEqual(timing.Report(report, {})._slowest_path("DTOF_PATH_MAX"), ("a", "b", 2))

    def test_longer_wires_in_the_wire_load_model_delay_as_much_as_their_capacitance(self) -> None:
        # Inverters in a row: three lengths a third apart are two equal steps of delay.
        self.assertEqual(standard_cells.library(standard_cells.SLOW),
                         standard_cells.library(standard_cells.SLOW, standard_cells.WIRE_UM_PER_FANOUT))
        nets = [f"n{index}" for index in range(13)]
        gates = "".join(f"  INV_X1 i{index} (.A({a}), .Y({b}));\n" for index, (a, b) in enumerate(zip(nets, nets[1:])))
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            (folder / "chain.v").write_text(
                f"module chain (clk_i, a);\n  input clk_i; input a;\n  wire q, {', '.join(nets)};\n"
                f"  DFF_X1 a (.D(a), .CK(clk_i), .Q({nets[0]}));\n{gates}"
                f"  DFF_X1 b (.D({nets[-1]}), .CK(clk_i), .Q(q));\nendmodule\n", encoding="utf-8")
            (folder / "dtof.sdc").write_text("create_clock -name clk -period $period [get_ports clk_i]\n", encoding="utf-8")

            def slack(um: float) -> float:
                (folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW, um), encoding="utf-8")
                tools.write_settings(folder / "settings.tcl", {
                    "liberty_files": [folder / "slow.lib"], "netlist": folder / "chain.v", "wires": "", "top": "chain",
                    "wire_load": standard_cells.WIRE_LOAD, "constraints": folder / "dtof.sdc", "target_period": "3.0",
                    "steps": ["nominal"]})
                output = tools.run_sta(ROOT / "synth/sta/timing.tcl", folder / "settings.tcl", folder / "log", "chain")
                return float(found_in("OpenSTA", r"^DTOF_SLACK (\S+)", output)[1])

            short, middle, long = slack(2.0), slack(5.0), slack(8.0)
        self.assertGreater(short - middle, 0.05)
        self.assertAlmostEqual((middle - long) / (short - middle), 1, delta=0.1)


if __name__ == "__main__":
    unittest.main()
