# SPDX-License-Identifier: Apache-2.0
"""Power on a scene, from counted transitions to the array and to a frame, by hand."""

import subprocess
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import configuration, library, run, scene_power, sram_model, standard_cells
from dtof_synth.activity import OTHER, STREAMING, Activity, Energy, Scope
from dtof_synth.configuration import Configuration
from dtof_synth.errors import FlowError
from dtof_synth.library import Library
from dtof_synth.mapping import EFFORTS
from dtof_synth.power import ClockTree
from dtof_synth.technology import Technology

from .partial import part_of
from .small_netlists import cell, module
from .small_results import ROOT, result

NAMED = configuration.load(ROOT / "configurations.toml")
NO_POWER = scene_power.Parts(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class Frame(unittest.TestCase):
    def test_energy_of_a_frame_is_that_of_its_three_parts(self) -> None:
        # 330 MHz, 30 frames/s: 11e6 clocks. 5e6 at 200 mW, 1e6 at 50 mW, 5e6 idle at 10 mW, or at 4 mW gated:
        # (1000 + 50 + 50) / 330 mJ, or (1000 + 50 + 20) / 330 mJ.
        one = scene_power.ScenePower(NAMED["ezpointer"], "day", 0.1, 0.0, replace(NO_POWER, columns=200.0),
                                     replace(NO_POWER, columns=50.0), 10.0, 4.0, 5_000_000, 1_000_000)
        self.assertAlmostEqual(one.frame_mj, 1100 / 330, places=9)
        self.assertAlmostEqual(one.mean_mw, 30 * 1100 / 330, places=9)
        self.assertAlmostEqual(one.gated_mean_mw, 30 * 1070 / 330, places=9)

    def test_every_part_is_in_the_total(self) -> None:
        self.assertEqual(scene_power.Parts(1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 5.0).total, 63.0)


class Array(unittest.TestCase):
    """ezPointer: 200 columns of one inverter, whose net toggles; nothing else but control, which is one inverter, too."""

    scratch: tempfile.TemporaryDirectory[str]
    library: Library
    configuration: Configuration
    power: scene_power.ScenePower

    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        folder = Path(cls.scratch.name)
        (folder / "typical.lib").write_text(standard_cells.library(standard_cells.TYPICAL), encoding="utf-8")
        cls.library = library.read(folder / "typical.lib")
        (folder / run.FINISHED_COLUMN).write_text("{}", encoding="utf-8")
        column = module({"clk_i": ("input", 2), "a": ("input", 3), "y": ("output", 4)}, {
            "r": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 5}), "i": cell("INV_X1", {"A": 5}, {"Y": 4})})
        top = module({"clk_i": ("input", 2), "a": ("input", 3)}, {
            "u_column": cell("a_column_netlist", {"clk_i": 2, "a": 3}, {"y": 4}), "i": cell("INV_X1", {"A": 4}, {"Y": 5})}, top=True)
        design = {"modules": {"a_column_netlist": column, "t": top}}
        # The net between register and inverter toggles in every second streaming clock and never elsewhere.
        counted = Activity({"": Scope("t"), "p0": Scope("a_column_netlist", {STREAMING: {5: 500}})}, {STREAMING: 1000, OTHER: 250})
        cls.configuration = NAMED["ezpointer"]
        some = result("ezpointer")
        some = replace(some, shared=replace(some.shared, area=cls.library.area["INV_X1"], clock_energy_fj=100.0),
                       column_module=replace(some.column_module, clock_energy_fj=7.0), clock_tree=ClockTree(1, 1.0, 1000.0))
        technology = part_of(Technology, typical=cls.library, slow=cls.library)
        with mock.patch.object(scene_power, "simulate", return_value=(design, counted)), \
                mock.patch.object(scene_power, "uniform_mw", return_value=0.0):
            cls.power = scene_power.power(cls.configuration, "day", some, folder, technology, folder, 1)

    def test_leakage_is_that_of_all_columns_their_srams_and_control(self) -> None:
        leakage = {group.name: group.number("cell_leakage_power")
                   for group in scene_power.liberty.read(self.library.path).children("cell")}
        sram_uw = sram_model.macro(sram_model.Size(2, 160, 14)).leakage
        expected = (200 * (leakage["DFF_X1"] + leakage["INV_X1"]) + leakage["INV_X1"]) * 1e-6 + 200 * sram_uw * 1e-3
        self.assertAlmostEqual(self.power.leakage_mw, expected, places=9)
        self.assertAlmostEqual(self.power.streaming.leakage, expected, places=9)

    def test_a_frame_has_a_clock_for_each_slot_of_each_pixel_of_an_acquisition(self) -> None:
        self.assertEqual(self.power.streaming_clocks, 33_333 * 160 * 2)
        # What the small frame had beside acquisitions, and a result for each of 200 x 160 pixels.
        self.assertEqual(self.power.other_clocks, 250 + 32_000)

    def test_columns_take_what_their_nets_and_cells_do(self) -> None:
        # 500 transitions in 1000 clocks of 200 columns: half of C V^2 of an inverter and 2 um of wire, and the register's energy.
        net_fj = 0.5 * (standard_cells.CINV_FF + self.library.wire_ff_per_sink) * 1.1**2
        cell_fj = standard_cells._path_energy((standard_cells.inverter(),) * 4, 1.1)
        self.assertAlmostEqual(self.power.streaming.columns / (0.5 * 200 * (net_fj + cell_fj) * 330e-6), 1, delta=1e-4)
        self.assertEqual(self.power.other.columns, 0.0)

    def test_the_clock_is_charged_in_every_clock(self) -> None:
        # 200 columns of 7 fJ, 100 fJ of control, 1000 fF of tree at 1.1 V.
        expected = (200 * 7.0 + 100.0 + 1000.0 * 1.21) * 330e-6
        self.assertAlmostEqual(self.power.streaming.clock, expected, places=9)
        self.assertAlmostEqual(self.power.idle_mw, expected + self.power.leakage_mw, places=9)

class Pool(unittest.TestCase):
    """poolPointer: 50 quads with an SRAM outside each, 6 engines with an SRAM in each; every scope has energies of choice."""

    scratch: tempfile.TemporaryDirectory[str]
    library: Library
    simulate: mock.Mock
    uniform: mock.Mock
    power: scene_power.ScenePower

    ENERGIES = {"a_quad_netlist": Energy(nets=100.0, cells=50.0, sram=0.0, sram_reads=0.0, gated_clock=20.0),
                "t": Energy(nets=30.0, cells=10.0, sram=400.0, sram_reads=250.0), "an_engine_netlist": Energy(60.0, 40.0, 80.0, 8.0, 6.0)}

    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        folder = Path(cls.scratch.name)
        (folder / "typical.lib").write_text(standard_cells.library(standard_cells.TYPICAL), encoding="utf-8")
        (folder / run.FINISHED_COLUMN).write_text('{"finished": 1}', encoding="utf-8")
        cls.library = library.read(folder / "typical.lib")
        inverters = {f"i{index}": cell("INV_X1", {"A": 3}, {"Y": 4 + index}) for index in range(4)}
        blocks = {kind: module({"a": ("input", 3)}, dict(list(inverters.items())[:number]))
                  for kind, number in (("a_quad_netlist", 1), ("an_engine_netlist", 2))}
        design = {"modules": blocks | {"t": module({"a": ("input", 3)}, inverters | {
            "q": cell("a_quad_netlist", {"a": 3}, {}), "e": cell("an_engine_netlist", {"a": 3}, {})}, top=True)}}
        counted = Activity({"": Scope("t"), "p0": Scope("a_quad_netlist", {STREAMING: {4: 50}}), "p1": Scope("an_engine_netlist")},
                           {STREAMING: 100, OTHER: 50})
        area = cls.library.area["INV_X1"]
        some = result("poolpointer")
        # Control is 3 times, engines are 12 times the small array's: 4 and 2 inverters.
        some = replace(some, shared=replace(some.shared, area=36 * area, clock_energy_fj=100.0), engines=replace(some.engines, area=24 * area),
                       column_module=replace(some.column_module, clock_energy_fj=7.0), clock_tree=ClockTree(1, 1.0, 1000.0))
        with mock.patch.object(scene_power, "simulate", return_value=(design, counted)) as cls.simulate, \
                mock.patch.object(scene_power, "uniform_mw", return_value=9.5) as cls.uniform, \
                mock.patch.object(scene_power.activity, "energy", lambda scope, *_: cls.ENERGIES[scope.module]):
            technology = part_of(Technology, typical=cls.library, slow=cls.library)
            cls.power = scene_power.power(NAMED["poolpointer"], "dusk", some, folder, technology, folder, 5)

    def test_each_part_is_scaled_to_the_array(self) -> None:
        # fJ in 100 clocks of 330 MHz.
        to_mw = 330e-6 / 100
        part = self.power.streaming
        for found, fj in ((part.columns, 50 * 150.0), (part.engines, 12 * 100.0), (part.control, 3 * 40.0),
                          (part.sram, 50 * 400.0 + 6 * 80.0), (part.sram_reads, 50 * 250.0 + 6 * 8.0)):
            self.assertAlmostEqual(found, fj * to_mw, places=9)
        self.assertAlmostEqual(self.power.other.columns, 2 * part.columns, places=9)  # the same in half the clocks

    def test_the_clock_is_the_trees_and_what_gates_pass(self) -> None:
        always = (50 * 7.0 + 100.0 + 1000.0 * 1.1**2) * 330e-6
        self.assertAlmostEqual(self.power.streaming.clock, always + (50 * 20.0 + 12 * 6.0) * 330e-6 / 100, places=9)
        self.assertAlmostEqual(self.power.idle_mw, always + self.power.leakage_mw, places=9)

    def test_everything_leaks(self) -> None:
        nw = next(group.number("cell_leakage_power") for group in scene_power.liberty.read(self.library.path).children("cell") if group.name == "INV_X1")
        column, engine = (sram_model.macro(size).leakage for size in (sram_model.Size(1, 100, 232), sram_model.Size(1, 160, 33)))
        expected = (50 * nw + 3 * 4 * nw + 12 * 2 * nw) * 1e-6 + (50 * column + 6 * engine) * 1e-3
        self.assertAlmostEqual(self.power.leakage_mw, expected, places=12)

    def test_what_is_asked_of_the_steps(self) -> None:
        chosen, finished, _, _, klux, seed = self.simulate.call_args.args
        self.assertEqual((chosen.name, finished, klux, seed), ("poolpointer", {"finished": 1}, 2.0, 5))
        # One net of the quad's one toggles 50 times in 100 clocks.
        self.assertEqual((self.power.column_rate, self.uniform.call_args.args[3], self.power.uniform_mw), (0.5, 0.5, 9.5))

    def test_a_phase_without_a_clock_stops(self) -> None:
        counted = Activity({"": Scope("t"), "p0": Scope("a_quad_netlist")}, {STREAMING: 100})
        with mock.patch.object(scene_power, "simulate", return_value=({"modules": {"t": module({}, {}, top=True) | {"cells": {
                "i": cell("INV_X1", {"A": 3}, {"Y": 4})}}, "a_quad_netlist": module({}, {})}}, counted)), \
                mock.patch.object(scene_power, "uniform_mw", return_value=0.0), self.assertRaisesRegex(FlowError, "no clock of the phase other"):
            scene_power.power(NAMED["ezpointer"], "day", result("ezpointer"), Path(self.scratch.name),
                              part_of(Technology, typical=self.library, slow=self.library), Path(self.scratch.name), 1)


class Steps(unittest.TestCase):
    """What goes to the tools, and what the report and the table say."""

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        typical, slow = (part_of(Library, path=Path(f"{corner}.lib"), wire_load=f"{corner} wires") for corner in ("typical", "slow"))
        self.technology = part_of(Technology, typical=typical, slow=slow, kit=Path("kit"), root=ROOT)

    def test_opensta_gets_the_rate_in_the_typical_corner(self) -> None:
        for name, column, modules in (("ezpointer", "u_column", 200), ("poolpointer", "u_quad", 50)):
            with mock.patch.object(scene_power.tools, "write_settings") as written, mock.patch.object(scene_power.tools, "run_sta") as sta, \
                    mock.patch.object(scene_power.power_model, "data_mw", return_value=0.5):
                self.assertEqual(scene_power.uniform_mw(NAMED[name], self.technology, self.folder, 0.125), 0.5 * modules)
            self.assertEqual(written.call_args.args[1], {
                "liberty_files": [Path("typical.lib"), Path("kit/sram40_typical.lib")], "netlist": self.folder / "static.v", "top": NAMED[name].top,
                "wire_load": "typical wires", "period": "3.030303", "column": column, "activity": "0.125000"})
            self.assertEqual(sta.call_args.args[0], ROOT / "synth/sta/power.tcl")

    def test_the_small_array_is_a_module_of_columns_with_all_pixels(self) -> None:
        for name, columns, engine in (("ezpointer", 1, None), ("poolpointer", 4, 4)):
            case = scene_power.small_case(NAMED[name], 9)
            self.assertEqual((case.configuration["SRAM_NUM"], case.configuration["PIXELS_PER_SRAM"], case.frames, case.seed), (columns, 160, (64,), 9))
            self.assertEqual(case.configuration.parameters.get("ENGINE_COLUMNS") if engine else None, engine)

    def test_a_clock_streams_if_a_word_is_offered_and_taken(self) -> None:
        for ready, valid in ((0, 0), (0, 1), (1, 0), (1, 1)):
            self.assertEqual(scene_power._streams({"tdc_ready_o": ready, "tdc_valid_i": valid}), bool(ready and valid))
        self.assertFalse(scene_power._streams({}))

    def test_the_simulated_array_has_the_finished_column_in_place_of_its_own(self) -> None:
        mapped = {"modules": {"a_column": module({}, {}), "t": module({}, {"c": cell("a_column", {}, {})}, top=True)}}
        with mock.patch.object(scene_power, "elaborate") as elaborate, mock.patch.object(scene_power, "map_to_cells", return_value=mapped) as mapped_with, \
                mock.patch.object(scene_power.floorplan, "finish") as finish, mock.patch.object(scene_power, "_write_verilog") as write, \
                mock.patch.object(scene_power, "count_activity", return_value="counted") as count:
            design, counted = scene_power.simulate(NAMED["ezpointer"], {"finished": 1}, self.technology, self.folder, 50.0, 3)
        self.assertEqual((design["modules"]["a_column"], counted), ({"finished": 1}, "counted"))
        self.assertEqual(elaborate.call_args.args[0], scene_power.small(NAMED["ezpointer"]))
        self.assertEqual(mapped_with.call_args.args[3], EFFORTS[0])
        self.assertEqual(finish.call_args.args[1:], (self.technology.slow, scene_power.sram_kit.PIN_FF, NAMED["ezpointer"]))
        self.assertEqual((write.call_args.args[3], count.call_args.args[4]), ("static", 50.0))

    def test_a_waveform_is_counted_while_it_is_written(self) -> None:
        """A bench in place of the array's: the part in the netlist toggles three times, the clock rises four times."""
        bench = """module dtof_array_bench; reg clk = 0; wire a; array u_netlist(.clk_i(clk), .tdc_ready_o(a));
          initial begin repeat (8) #5 clk = !clk; $display("DTOF_PASS frames 1 results 1 clocks 4"); $finish(0); end endmodule
          module array(input clk_i, output tdc_ready_o); part p0(.clk_i(clk_i), .q(tdc_ready_o)); endmodule
          module part(input clk_i, output reg q = 0); always @(posedge clk_i) if ($time < 30) q <= !q; endmodule
        """
        design = {"modules": {"part": module({"clk_i": ("input", 2), "q": ("output", 5)}, {"r": cell("DFF_X1", {"CK": 2}, {"Q": 5})}),
                              "array": module({"clk_i": ("input", 2), "tdc_ready_o": ("output", 5)}, {
                                  "u_column": cell("part", {"clk_i": 2}, {"q": 5})}, top=True)}}
        case = scene_power.simulation.Case(scene_power.small(NAMED["ezpointer"]), (64,), 3)

        def compile_bench(_case, _root, folder, files, tops):
            (folder / "bench.v").write_text(bench, encoding="utf-8")
            subprocess.run(["iverilog", "-g2012", "-s", "dtof_array_bench", *(word for top in tops for word in ("-s", top)), "-o", "bench.vvp",
                            "bench.v", *map(str, files)], cwd=folder, check=True)

        with mock.patch.object(scene_power.simulation, "write_simulation_netlist", return_value=()), \
                mock.patch.object(scene_power.simulation, "write_vectors") as vectors, \
                mock.patch.object(scene_power.simulation, "compile_bench", compile_bench):
            counted = scene_power.count_activity(design, case, self.technology, self.folder, 2.5)
        self.assertEqual(vectors.call_args.args[3], ("--scene", "room", "--klux", "2.5"))
        self.assertEqual(counted.clocks, {OTHER: 4})
        self.assertEqual(set(counted.scopes), {"", "p0"})
        self.assertEqual(counted.scopes["p0"].transitions[OTHER][5], 3)
        self.assertFalse((self.folder / "activity.vcd").exists())

    def test_a_simulation_that_ends_before_its_waveform_begins_is_an_error(self) -> None:
        design = {"modules": {"array": module({"clk_i": ("input", 2)}, {}, top=True)}}
        case = scene_power.simulation.Case(scene_power.small(NAMED["ezpointer"]), (64,), 3)
        with mock.patch.object(scene_power.simulation, "write_simulation_netlist", return_value=()), \
                mock.patch.object(scene_power.simulation, "write_vectors"), mock.patch.object(scene_power.simulation, "compile_bench"), \
                self.assertRaisesRegex(FlowError, "bench.vvp"):
            scene_power.count_activity(design, case, self.technology, self.folder, 2.5)
        self.assertFalse((self.folder / "activity.vcd").exists())

    def found(self) -> list[scene_power.ScenePower]:
        streaming = scene_power.Parts(70.0, 5.0, 1.0, 60.0, 40.0, 10.0, 50.0)
        other = scene_power.Parts(7.0, 0.5, 0.1, 6.0, 4.0, 1.0, 5.0)
        return [scene_power.ScenePower(NAMED["poolpointer"], light, 0.125, 65.0, streaming, replace(other, columns=columns), 12.0, 10.0, 5_500_000,
                                       1_100_000) for light, columns in (("day", 7.0), ("dusk", 8.0))]

    def test_the_report(self) -> None:
        lines = scene_power.report(self.found(), {"poolpointer": result("poolpointer")}, "0123456789abcdef", 4).splitlines()
        self.assertIn("| poolPointer | day | 0.12 | 70.0 | 65.0 | 5.0 | 1.0 | 60.0 | 40.0 | 10.0 | 186.0 | 6.0 |", lines)
        # 330 MHz, 30 frames/s: 11e6 clocks. (186 x 5.5e6 + 18.6 x 1.1e6 + 12 x 4.4e6) / 330e6 = 3.322 mJ, of 32,000 pixels.
        self.assertIn("| poolPointer | day | 186.0 | 18.6 | 12.0 | 10.0 | 50% | 10.0% | 3.32 | 104 | 99.7 | 98.9 |", lines)
        self.assertIn("| poolPointer, day: at most 150 mW | 186.0 mW | **no** |", lines)
        text = "\n".join(lines)
        for words in ("`room` at 50 klux (day), 2 klux (dusk)", "330 MHz, typical corner, seed 4; inputs `0123456789ab`", "toggled 0.1 times a clock",
                      "25% of the TDC slots", "A frame of 33333 acquisitions, 30 frames/s", "with 64 acquisitions"):
            self.assertIn(words, text)
        for above, line in zip(lines, lines[1:]):
            if line.startswith("|---"):
                self.assertEqual(above.count(" | "), line.count("|") - 2, above)

    def test_each_light_has_its_goal(self) -> None:
        day, dusk = self.found()
        found = [replace(day, streaming=replace(day.streaming, columns=34.0)),  # 150.0 mW
                 replace(dusk, streaming=replace(dusk.streaming, columns=34.1, sram=0.0))]  # 90.1 mW
        lines = scene_power.report(found, {"poolpointer": result("poolpointer")}, "0", 1).splitlines()
        self.assertIn("| poolPointer, day: at most 150 mW | 150.0 mW | yes |", lines)
        self.assertIn("| poolPointer, dusk: at most 90 mW | 90.1 mW | **no** |", lines)

    def test_the_table(self) -> None:
        scene_power.write_csv(self.folder / "power.csv", self.found())
        lines = (self.folder / "power.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(lines[0].split(",")[5:9], ["phase", "columns_mw", "engines_mw", "control_mw"])
        self.assertEqual(lines[1], "poolpointer,day,50,0.1250,65.000,streaming,70.000,5.000,1.000,60.000,50.000,40.000,10.000,186.000,5500000,3.3220")
        self.assertEqual(lines[4].split(",")[:2] + lines[4].split(",")[5:8] + lines[4].split(",")[13:15],
                         ["poolpointer", "dusk", "other", "8.000", "0.500", "19.600", "1100000"])
        self.assertEqual(len(lines), 5)

    def run_all(self, fails: str = "") -> tuple[list, list[str], list[str]]:
        """(results, what was said, what began)"""
        begun: list[str] = []
        said: list[str] = []

        def power(chosen, light, _result, run_folder, _technology, folder, _seed):
            begun.append(f"{chosen.name} {light} {run_folder.name} {folder.name}")
            if chosen.name == fails:
                raise FlowError(f"{fails} fails")
            return part_of(scene_power.ScenePower, configuration=chosen, light=light, streaming=part_of(scene_power.Parts, total=1.5))

        chosen = [NAMED[name] for name in ("ezpointer", "poolpointer")]
        with mock.patch.object(scene_power, "power", power), mock.patch.object(scene_power, "ProcessPoolExecutor", ThreadPoolExecutor):
            found = scene_power.run(chosen, dict.fromkeys(("ezpointer", "poolpointer"), part_of(run.Result)), Path("runs"), self.technology,
                                    self.folder, 1, 1, said.append)
        return [f"{one.configuration.name} {one.light}" for one in found], said, begun

    def test_long_simulations_begin_first_and_results_have_the_order_of_the_list(self) -> None:
        found, said, begun = self.run_all()
        self.assertEqual(found, ["ezpointer day", "ezpointer dusk", "poolpointer day", "poolpointer dusk"])
        self.assertEqual(begun, [f"{name} {light} {name} {name}_{light}" for name in ("poolpointer", "ezpointer") for light in ("day", "dusk")])
        self.assertEqual(sorted(line.split("] ")[1] for line in said), sorted(f"{name}, {light}: 1.5 mW" for name in ("poolpointer", "ezpointer")
                                                                              for light in ("day", "dusk")))
        self.assertEqual([line.split("]")[0] for line in said], ["[1/4", "[2/4", "[3/4", "[4/4"])

    def test_the_first_failure_stops_all(self) -> None:
        with self.assertRaisesRegex(FlowError, "poolpointer fails"):
            self.run_all("poolpointer")


if __name__ == "__main__":
    unittest.main()
