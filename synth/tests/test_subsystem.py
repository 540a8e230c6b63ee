# SPDX-License-Identifier: Apache-2.0
"""dtof_subsystem around an array: faults that must stop the flow, in a netlist of two registers and an array, and the report."""

import copy
import json
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import array_stand_in, library, resizing, standard_cells, subsystem, subsystem_report, timing
from dtof_synth.activity import STREAMING
from dtof_synth.array_stand_in import MODES, Port, Ports
from dtof_synth.errors import FlowError
from dtof_synth.subsystem import Ends, Part, Slacks, Subsystem
from dtof_synth.subsystem_power import Parts, SubsystemPower
from dtof_synth.technology import Technology

from .partial import part_of
from .small_netlists import cell, module
from .small_results import NONE, ROOT, result

TIMES = [Port("d_i", False, 0.4, 0.0, 2.0), Port("rst_ni", False, 0.3, 0.1, 2.0), Port("q_o", True, 0.7, 0.3)]
PORTS = Ports({mode: TIMES for mode in MODES}, {"state_o"}, {"raw_i"})


def design() -> dict:
    """d_i - register - array - register in a module - q_o; the array has a constant output and an input that it does not use."""
    array = cell("dtof_array", {"clk_i": 2, "rst_ni": 3, "d_i": 11, "raw_i": 10, "sram_cfg_i": 5}, {"q_o": 12, "sram_cfg_o": 13, "state_o": 20})
    child = module({"clk_i": ("input", 2), "d_i": ("input", 3), "q_o": ("output", 4)}, {"r": cell("DFF_X1", {"CK": 2, "D": 3}, {"Q": 4})})
    top = module({"clk_i": ("input", 2), "rst_ni": ("input", 3), "d_i": ("input", 10), "sram_cfg_i": ("input", 5),
                  "scan_mode_i": ("input", 6), "q_o": ("output", 14), "sram_cfg_o": ("output", 13)},
                 {"r": cell("DFFR_X1", {"CK": 2, "D": 10, "RN": 3}, {"Q": 11}), "u_array_here": array,
                  "u_child": cell("child", {"clk_i": 2, "d_i": 12}, {"q_o": 14}),
                  "u_array_reset": cell("array_reset", {"rst_ni": 3}, {"array_rst_no": 21}),  # which the constraints name
                  "constant": cell("DFF_X1", {"CK": 2, "D": 20}, {"Q": 15})}, top=True)
    array_reset = module({"rst_ni": ("input", 2), "array_rst_no": ("output", 3)}, {"b": cell("BUF_X1", {"A": 2}, {"Y": 3})})
    return {"modules": {"dtof_subsystem": top, "child": child, "array_reset": array_reset, "dtof_array": {"attributes": {}, "ports": {}, "cells": {}}}}


class Faults(unittest.TestCase):
    kept: tempfile.TemporaryDirectory[str]
    technology: Technology

    @classmethod
    def setUpClass(cls) -> None:
        cls.kept = tempfile.TemporaryDirectory()
        liberty = Path(cls.kept.name) / "slow.lib"
        liberty.write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        slow = library.read(liberty)
        cls.technology = part_of(Technology, root=ROOT, slow=slow, target_mhz=330.0, library=lambda corner: slow)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.kept.cleanup()

    def timed(self, of: dict, ports: Ports = PORTS) -> subsystem._Timed:
        folder = Path(tempfile.mkdtemp(dir=self.kept.name))
        (folder / timing.NAMES).write_text(json.dumps({}), encoding="utf-8")
        others = subsystem.connect_stand_in(of, ports)
        timed = subsystem._Timed(result("ezpointer").configuration, self.technology, folder, of, {"slow": ports}, others)
        timed.write()
        return timed

    def test_every_end_is_counted_and_timed(self) -> None:
        ends, late = self.timed(design()).ends()
        # Data: three registers, d_i of the array, q_o and sram_cfg_o. Resets: a register and the array.
        self.assertEqual(ends, Ends(6, 4, 1, 1, 2, 1, 2))
        self.assertEqual(set(late), {"dtof_subsystem", "child", "array_stand_in"})

    def test_paths_to_and_from_the_array_have_its_times(self) -> None:
        timed = self.timed(design())
        _, late = timed.ends()
        # Behind the array's 0.7 ns the child's register is next. Its setup time is that of a register whose input has this slew.
        setup = 1000 / 330 - 0.15 - 0.7 - late["child"]
        self.assertAlmostEqual(setup, 0.1487, places=3)
        # At the array's inputs: the register's delay and the reset's budget, before 0.4 and 0.3 ns.
        path = timed.time("slow", "margins", "margins").output
        self.assertIn("-0.3000    2.5803   library recovery time", path)

    def test_a_late_reset_of_the_array_is_no_late_setup(self) -> None:
        late_reset = [Port("rst_ni", False, 2.5, 0.1, 2.0) if port.name == "rst_ni" else port for port in TIMES]
        _, late = self.timed(design(), Ports({mode: late_reset for mode in MODES}, PORTS.constant, PORTS.unused)).ends()
        self.assertGreater(late["array_stand_in"], 1.5)

    def test_a_port_without_a_budget_is_found(self) -> None:
        timed = self.timed(design())
        text = timed.constraints.read_text(encoding="utf-8").replace('ne "clk_i"', 'ni {clk_i d_i}')
        other = timed.folder / "other.sdc"
        other.write_text(text, encoding="utf-8")
        with mock.patch.object(subsystem._Timed, "constraints", other), \
                self.assertRaisesRegex(FlowError, "OpenSTA warns of 1 .*(input port|unconstrained endpoint).*: (d_i|r/D)"):
            timed.ends()

    def test_an_array_without_arcs_is_found(self) -> None:
        def without(ports, others, mode, voltage) -> str:
            names = [*((port.name, port.is_output) for port in ports), *others]
            return kept([], names, mode, voltage)

        kept = array_stand_in.liberty
        with mock.patch.object(array_stand_in, "liberty", without), self.assertRaisesRegex(FlowError, "unconstrained endpoint|of the array"):
            self.timed(design()).ends()

    def test_an_array_without_arcs_at_its_inputs_is_found(self) -> None:
        def without(ports, others, mode, voltage) -> str:
            ports = list(ports)
            return kept([port for port in ports if port.is_output], [*((port.name, False) for port in ports if not port.is_output), *others],
                        mode, voltage)

        kept = array_stand_in.liberty
        with mock.patch.object(array_stand_in, "liberty", without), self.assertRaisesRegex(FlowError, "OpenSTA times 0 of 2 pins of the array"):
            self.timed(design()).ends()

    def test_a_register_that_nothing_clocks_is_found(self) -> None:
        of = design()
        of["modules"]["dtof_subsystem"]["cells"]["r"]["connections"]["CK"] = [99]
        with self.assertRaisesRegex(FlowError, "OpenSTA warns of 1 unclocked .*: r/CK"):
            self.timed(of).ends()

    def test_an_array_with_another_port_is_found(self) -> None:
        of = design()
        of["modules"]["dtof_subsystem"]["cells"]["u_array_here"]["connections"]["new_i"] = [10]
        of["modules"]["dtof_subsystem"]["cells"]["u_array_here"]["port_directions"]["new_i"] = "input"
        with self.assertRaisesRegex(FlowError, "the array was measured without its port new_i"):
            self.timed(of)
        of = design()
        del of["modules"]["dtof_subsystem"]["cells"]["u_array_here"]["connections"]["q_o"]
        with self.assertRaisesRegex(FlowError, "the array in dtof_subsystem lacks the port q_o"):
            self.timed(of)

    def test_a_subsystem_without_an_array_is_found(self) -> None:
        of = design()
        del of["modules"]["dtof_subsystem"]["cells"]["u_array_here"]
        with self.assertRaisesRegex(FlowError, "dtof_subsystem has 0 arrays"):
            self.timed(of)

    def test_parts_are_the_modules_and_the_rest(self) -> None:
        parts = {part.name: part for part in self.timed(design()).parts()}
        area = self.technology.slow.area
        self.assertAlmostEqual(parts["child"].counts.area, area["DFF_X1"])
        self.assertAlmostEqual(parts["dtof_subsystem"].counts.area, area["DFF_X1"] + area["DFFR_X1"])


class Hierarchy(unittest.TestCase):
    def test_modules_of_the_top_are_read_from_the_netlist(self) -> None:
        text = ("module \\other\n  cell \\inner \\u\n  end\nend\n"
                "attribute \\top 1\nattribute \\src \"a\"\nmodule \\dtof_subsystem\n  cell $paramod$12ab\\dtof_line_buffer \\u_a\n  end\n"
                "  cell $and $b\n  end\n  cell \\dtof_new \\u_c\n  end\n  cell $paramod\\dtof_clock_gate\\NEEDED=s32'1 \\u_d\n  end\n"
                "  cell $paramod$3\\dtof_array \\u_e\n  end\nend\nmodule \\last\n  cell \\behind \\u\n  end\nend\n")
        self.assertEqual(subsystem.children(text), ["dtof_line_buffer", "dtof_new"])

    def test_derived_modules_get_plain_names(self) -> None:
        top = module({}, {"a": cell("$paramod\\m\\W=1", {}, {}), "b": cell("$paramod$ff\\m", {}, {}), "c": cell("BUF", {}, {})}, top=True)
        inner = module({}, {"x": cell("BUF", {}, {})})
        of = {"modules": {"top": top, "$paramod\\m\\W=1": inner, "$paramod$ff\\m": copy.deepcopy(inner)}}
        subsystem.plain_modules(of)
        self.assertEqual(list(of["modules"]), ["top", "m", "m__2"])
        self.assertEqual([one["type"] for one in top["cells"].values()], ["m", "m__2", "BUF"])


def around(name: str, line_buffer_um2: float = 20000.0, setup: float = 0.1, edges: int = 0, overloaded: tuple[str, ...] = ()) -> Subsystem:
    """An array of 1 mm2, and a subsystem of the line buffer, two watchdogs of 200 um2 each, and 800 um2 of its own."""
    parts = [Part("dtof_line_buffer", 1, replace(NONE, cells=100, flip_flops=40, area=line_buffer_um2)),
             Part("dtof_subsystem", 1, replace(NONE, cells=8, area=800.0)), Part("dtof_watchdog", 2, replace(NONE, cells=4, area=400.0))]
    slacks = {(corner, mode): Slacks(setup if (corner, mode) == ("slow", "margins") else 0.5, 0.2, 0.3, "from", "to")
              for corner in subsystem.CORNERS for mode in MODES}
    return Subsystem(result(name).configuration, parts, 1.0, slacks, Ends(50, 46, 3, 1, 12, 7, 30),
                     {"dtof_line_buffer": 0.1, "dtof_watchdog": setup, "array_stand_in": 0.4},
                     {"slow": edges, "typical": 0, "fast": 0}, list(overloaded), 330.0,
                     SubsystemPower(Parts(3.0, 2.0, 0.25), Parts(1.0, 1.5, 0.25) if name == "ezpointer" else None, 1.2,
                                    {"dtof_line_buffer": 4.0, "dtof_settle": 0.001}, {STREAMING: 640}, 200 if name == "ezpointer" else 0))


class Kept(unittest.TestCase):
    def test_a_result_is_kept_until_an_input_changes(self) -> None:
        measured = [around("ezpointer", setup=setup) for setup in (0.1, 0.2, 0.3, 0.4)]
        with tempfile.TemporaryDirectory() as name, mock.patch.object(subsystem, "measure", side_effect=measured) as measure:
            folder, technology = Path(name), part_of(Technology, root=ROOT)

            def once(of: str, digest: str) -> float:
                return subsystem.measure_once(result(of), technology, folder, folder, digest).late["dtof_watchdog"]

            self.assertEqual([once("ezpointer", "a"), once("ezpointer", "a"), once("ezpointer", "b"), once("hispointer", "b")], [0.1, 0.1, 0.2, 0.3])
            (folder / "result.pickle").write_bytes(b"torn")
            self.assertEqual(once("hispointer", "b"), 0.4)
            self.assertEqual(measure.call_count, 4)


class Report(unittest.TestCase):
    def test_the_answer_comes_first(self) -> None:
        lines = subsystem_report.report([around("ezpointer"), around("poolpointer", 40000.0)], "0123456789abcdef").splitlines()
        self.assertEqual(lines[:3], ["# Subsystem", "", "Around an array of 200 columns, `dtof_subsystem` takes 0.021 to 0.041 mm2, 2.1% to 4.1% "
                                     "of the array. Without the array it takes 5.2 to 5.2 mW while lines stream in, and 1.2 to 1.2 mW idle. It "
                                     "closes 330 MHz with margins around every array."])
        self.assertIn("inputs `0123456789ab`", "\n".join(lines))

    def test_a_miss_and_its_module_come_first(self) -> None:
        line = subsystem_report.report([around("ezpointer"), around("poolpointer", setup=-0.25)], "0" * 64).splitlines()[2]
        self.assertTrue(line.endswith("**It misses 330 MHz with margins around poolPointer.** Setup is missed in `dtof_watchdog`; "
                                      "every other module meets it."), line)

    def test_tables_have_the_figures(self) -> None:
        text = subsystem_report.report([around("ezpointer"), around("poolpointer", 40000.0, setup=-0.25)], "0" * 64)
        for row in ("| ezPointer | 1.000 | 0.0212 | 2.12% | 1.021 | 112 | 40 | 0 |", "| `dtof_line_buffer` | 1 | 20000 | 40000 |",
                    "| `dtof_watchdog` | 2 | 400 | 400 |", "| own cells | 1 | 800 | 800 |",
                    "| poolPointer | slow | +0.500 | +0.200 | +0.300 | -0.250 | +0.200 | +0.300 | `from` | `to` |",
                    "| `dtof_watchdog` | +0.100 | -0.250 |", "| the array | +0.400 | +0.400 |",
                    "| ezPointer | 50 | 46 | 3 | 1 | 12 | 7 | 30 |",
                    "| ezPointer | 3.00 | 2.00 | 0.25 | 5.25 | 1.00 | 1.50 | 2.75 | 1.20 | 640 | 200 |",
                    "| poolPointer | 3.00 | 2.00 | 0.25 | 5.25 | - | - | - | 1.20 | 640 | - |",
                    "Around ezPointer the first 200 results are simulated, and are those of the model. Around poolPointer **results are "
                    "not measured**", "| `dtof_line_buffer` | 4.00 | 4.00 |",
                    "| ezPointer: line buffer at most 3 % of the array | 2.00% | yes |",
                    "| poolPointer: line buffer at most 3 % of the array | 4.00% | **no** |",
                    "| poolPointer: closes 330 MHz in all corners | worst slack +0.200 ns | yes |",
                    "| poolPointer: closes 330 MHz in all corners with margins | worst slack -0.250 ns | **no** |"):
            self.assertIn(row, text)

    def test_edges_and_loads_beyond_their_limits_are_goals_that_fail(self) -> None:
        text = subsystem_report.report([around("ezpointer"), around("poolpointer", edges=2, overloaded=("u drives 9.0 fF of 8.0", "v"))], "0" * 64)
        self.assertIn("| ezPointer: no edge and no load beyond its limit | 0 edges, 0 loads | yes |", text)
        self.assertIn("| poolPointer: no edge and no load beyond its limit | 2 edges, 2 loads, the first: u drives 9.0 fF of 8.0 | **no** |", text)

    def test_pins_with_slow_edges_are_found(self) -> None:
        listing = "DTOF_EDGES\nmax_transition\nu/A 0.4 0.5 -0.1 (VIOLATED)\nm/v/B[1]    0.4 0.6 -0.2 (VIOLATED)\n" \
            "w/C 0.4 0.3 0.1 (MET)\nDTOF_END\nx/D 1 2 -1 (VIOLATED)\n"
        self.assertEqual(subsystem.pins_of_slow_edges(listing), ["u/A", "m/v/B[1]"])
        with self.assertRaises(FlowError):
            subsystem.pins_of_slow_edges("DTOF_END\n")

    def test_the_page_says_where_no_gate_was_resized(self) -> None:
        found = [around("ezpointer", setup=-0.4), around("poolpointer", setup=-0.5)]
        self.assertIn("so around poolPointer no gate is resized", subsystem_report.report(found, "0" * 64))
        self.assertNotIn("no gate is resized", subsystem_report.report(found[:1], "0" * 64))

    def test_the_page_has_the_limit_of_the_flow(self) -> None:
        self.assertIn(f"set HOPELESS_NS {resizing.HOPELESS_NS}\n", (ROOT / "synth" / "sta" / "resize.tcl").read_text(encoding="utf-8"))

    def test_the_csv_has_a_line_for_each_array(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            subsystem_report.write_csv(Path(folder) / "subsystem.csv", [around("ezpointer"), around("poolpointer")])
            header, line, other = (Path(folder) / "subsystem.csv").read_text(encoding="utf-8").splitlines()
        figures, without = (dict(zip(header.split(","), one.split(","), strict=True)) for one in (line, other))
        self.assertEqual([(one["lines_mw"], one["results_mw"], one["idle_mw"], one["results_compared"]) for one in (figures, without)],
                         [("5.250", "2.750", "1.200", "200"), ("5.250", "", "1.200", "0")])
        self.assertEqual((figures["configuration"], figures["subsystem_mm2"], figures["share"], figures["line_buffer_mm2"], figures["ends"],
                          figures["timed_ends"], figures["slow_margins_setup_ns"], figures["fast_nominal_reset_ns"]),
                         ("ezpointer", "0.02120", "0.0212", "0.02000", "50", "46", "0.1000", "0.3000"))


if __name__ == "__main__":
    unittest.main()
