# SPDX-License-Identifier: Apache-2.0
"""What the flow of one configuration asks of its steps, and what it makes of their figures. The steps themselves are replaced."""

import json
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast
from unittest import mock

from dtof_synth import configuration, library, netlist, run, sram_model, standard_cells, timing
from dtof_synth.errors import FlowError
from dtof_synth.floorplan import Floorplan
from dtof_synth.netlist import Counts
from dtof_synth.power import ClockTree
from dtof_synth.sram_model import Size
from dtof_synth.technology import Technology

from .partial import part_of
from .small_results import MARGIN, ROOT, TIMING, result
from .test_floorplan import array

NAMED = configuration.load(ROOT / "configurations.toml")


class InFolder(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)


class Netlists(InFolder):
    """An array of five columns of ezPointer's width, with real cells and stand-ins."""

    def setUp(self) -> None:
        super().setUp()
        texts = {corner.name: standard_cells.library(corner) for corner in standard_cells.CORNERS}
        for name, text in texts.items():
            (self.folder / f"{name}.lib").write_text(text, encoding="utf-8")
        cells = {name: library.read(self.folder / f"{name}.lib") for name in texts}
        self.technology = Technology(cells["typical"], cells["slow"], self.folder / "kit", ROOT, 330.0, cells["fast"])
        chosen = part_of(configuration.Configuration, name="some", top="array", column_modules=5, engines=0, engine_columns=0, module_columns=1)
        self.design = array(5)
        self.netlist = run._Netlist(self.design, Floorplan(self.design, 1), chosen, self.technology, self.folder / "effort0", {})
        self.netlist.prepare()

    def measured(self, corner: str, *steps: str, **settings) -> tuple:
        report = SimpleNamespace(unchecked={}, resized=[], dropped=[], resized_slack=0.2)
        with mock.patch.object(run.timing, "measure", return_value=report) as measure, \
                mock.patch.object(run.endpoints, "judge", return_value="ends") as self.judge:
            self.netlist.time(corner, *steps, **settings)
        return measure.call_args.args

    def test_the_first_two_columns_and_the_last_are_real(self) -> None:
        self.assertEqual(self.netlist.real, ["g_column_0__u_column", "g_column_1__u_column", "g_column_4__u_column"])
        blocks = json.loads((self.folder / "effort0" / timing.BLOCKS).read_text(encoding="utf-8"))
        self.assertEqual(blocks["blocks"], ["test_column", self.netlist.real, 5])
        self.assertEqual(blocks["stand_ins"][:2], ["test_column", ["g_column_2__u_column", "g_column_3__u_column"]])
        names = json.loads((self.folder / "effort0" / timing.NAMES).read_text(encoding="utf-8"))
        self.assertEqual(names["g_column_4__u_column"], "g_column[4].u_column")

    def test_every_file_that_opensta_reads_is_written(self) -> None:
        self.assertLessEqual({"timing.v", "stand_in.lib", "wires_typical.spef", "wires_slow.spef", "wires_fast.spef"},
                             {path.name for path in (self.folder / "effort0").iterdir()})
        self.assertEqual(len(netlist.columns(self.design)), 5)

    def test_a_corner_has_its_cells_memories_and_wires(self) -> None:
        for corner in ("typical", "slow", "fast"):
            files, root, mhz, log, steps, settings = self.measured(corner, "margins", pins=["a"])
            folder = self.folder / "effort0"
            self.assertEqual(files.liberty_files, [self.folder / f"{corner}.lib", self.folder / "kit" / f"sram40_{corner}.lib",
                                                   folder / "stand_in.lib"])
            self.assertEqual((files.verilog, files.wires, files.top), (folder / "timing.v", folder / f"wires_{corner}.spef", "array"))
            self.assertEqual(files.wire_load, self.technology.slow.wire_load)
            self.assertEqual((root, mhz, log, steps), (ROOT, 330.0, folder / f"sta_{corner}.log", ("margins",)))
            self.assertEqual(settings, {"measured_column": "g_column_0__u_column", "pins": ["a"]})
            self.judge.assert_not_called()

    def test_slacks_at_the_target_clock_come_with_a_check_of_every_end(self) -> None:
        *_, steps, _ = self.measured("slow", "nominal", "closing")
        self.assertEqual(steps, ("check", "nominal", "closing"))
        self.assertEqual(self.judge.call_args.args[0], "some")

    def test_gates_are_resized_in_the_slow_corner(self) -> None:
        cases: list[tuple[dict[str, list], bool]] = [({}, False), ({"resized": [("test_column", "i", "INV_X2")]}, True),
                                                     ({"dropped": [("test_column", "i")]}, True)]
        for found, changed in cases:
            report = SimpleNamespace(**{"resized": [], "dropped": [], "resized_slack": 0.125, **found})
            with mock.patch.object(run._Netlist, "time", return_value=report) as timed, mock.patch.object(run.netlist, "drop_buffers"):
                resized = self.netlist.resize(True, 0.01)
            self.assertEqual(timed.call_args.args, ("slow", "resize"))
            self.assertEqual((timed.call_args.kwargs["guard"], timed.call_args.kwargs["shrinkable"]), ("0.01", []))
            self.assertEqual(resized, run.Resized(changed, 0.125))

    def test_the_log_of_resizing_is_one_of_its_own(self) -> None:
        self.assertEqual(self.measured("slow", "resize")[3].name, "sta_resize.log")

    def test_cells_of_the_whole_array(self) -> None:
        # Five columns of an inverter; what is shared are two registers.
        cells = self.technology.slow
        shared = sum(cells.area[cell["type"]] for cell in netlist.top(self.design)["cells"].values() if cell["type"] in cells.area)
        self.assertAlmostEqual(self.netlist.cell_area(), 5 * cells.area["INV_X1"] + shared)


class _Finished:
    """A netlist whose slow corner has the given slacks with margins, one after the other."""

    design, plan = {"a": "design"}, "plan"

    def __init__(self, slacks: list[float], changes: list[bool]) -> None:
        self.slacks, self.changes = slacks, changes
        self.done: list[tuple] = []

    def netlist(self) -> run._Netlist:
        """This netlist for code that takes one of the flow."""
        return cast(run._Netlist, self)

    def time(self, corner: str, *steps: str) -> SimpleNamespace:
        self.done.append((corner, *steps))
        slack = self.slacks.pop(0) if corner == "slow" else 0.0
        return SimpleNamespace(margin=lambda: replace(MARGIN, slack=slack), timing=lambda: replace(TIMING, start=corner), output=corner)

    def resize(self, again: bool, guard_ns: float, engine: int) -> run.Resized:
        self.done.append(("resize", again, round(guard_ns, 6), engine))
        return run.Resized(self.changes.pop(0), 0.0)

    def engine_of(self, _) -> int:
        return 3

    def fix_hold(self, report, spare) -> timing.Margin:
        self.done.append(("hold", report.output, spare))
        return replace(MARGIN, start="fast")

    def cell_area(self) -> float:
        return 1.0

    def check_logic(self) -> None:
        self.done.append(("logic",))

    def finished_column(self) -> dict:
        return {"finished": "column"}

    def counts(self) -> tuple[Counts, Counts, Counts]:
        return Counts(1, 2, 3.0, 4, 5.0, 6.0, 7.0, 8), Counts(10, 20, 30.0, 40, 50.0, 60.0, 70.0, 80), Counts(0, 0, 0.0, 0, 0.0, 0.0, 0.0)

    def endpoints(self, report) -> str:
        return f"ends of {report.output}"


class Run(InFolder):
    NOMINAL = ("slow", "nominal", "closing", "margins")
    EARLY = ("fast", "margins", "early")

    def finish(self, name: str = "ezpointer", slacks: tuple = (0.1,), changes: tuple = (), corners: tuple = run.BOTH_CORNERS, margin=MARGIN):
        """(result, what was done with the netlist)."""
        timed = _Finished([*slacks], [*changes])
        early = part_of(timing.Report, output="early report") if margin else None
        best = run._Attempt(timed.netlist(), 2, 0.3, margin, early, {"pin": 0.5})
        cells = part_of(library.Library, nand2_area=0.8, mux2_area=2.0)
        self.technology = part_of(Technology, slow=cells, typical=part_of(library.Library), fast=object())
        with mock.patch.object(run, "elaborate") as self.elaborate, mock.patch.object(run, "_attempts", return_value=[best]) as self.attempts, \
                mock.patch.object(run.loads, "check", return_value="fullest") as self.loads, \
                mock.patch.object(run.floorplan, "pin_load", return_value="pin load"), \
                mock.patch.object(run.power, "clock_tree", return_value=ClockTree(1, 2.0, 3.0)) as self.tree, \
                mock.patch.object(run.power, "logic_mw", return_value=10.0) as self.logic, \
                mock.patch.object(run.power, "sram_mw", return_value=20.0) as self.sram, \
                mock.patch.object(run.power, "clock_mw", return_value=30.0) as self.clock:
            return run.run(NAMED[name], self.technology, self.folder, corners, 3, 7), timed.done

    def test_an_array_that_closes_is_timed_in_every_corner_once(self) -> None:
        found, done = self.finish()
        self.assertEqual(done, [("hold", "early report", {"pin": 0.5}), self.NOMINAL, ("logic",), ("typical", "nominal", "closing", "power")])
        self.assertEqual(self.elaborate.call_args.args, (NAMED["ezpointer"], self.technology, self.folder))
        self.assertEqual(self.attempts.call_args.args, (NAMED["ezpointer"], self.technology, self.folder, 3, 7))
        self.assertEqual({corner: one.start for corner, one in found.timing.items()}, {"slow": "slow", "typical": "typical"})
        self.assertEqual((found.margins["slow"].slack, found.margins["fast"].start), (0.1, "fast"))
        self.assertEqual((found.effort, found.ends, found.fullest_load), (2, "ends of slow", "fullest"))
        self.assertEqual((found.nand2_area, found.mux2_area), (0.8, 2.0))
        self.assertEqual(json.loads((self.folder / run.FINISHED_COLUMN).read_text(encoding="utf-8")), {"finished": "column"})
        self.assertEqual(self.loads.call_args.args, ("ezpointer", _Finished.design, "plan", self.technology.slow, "pin load"))

    def test_power_is_that_of_the_typical_corner_and_of_all_columns(self) -> None:
        found, _ = self.finish()
        self.assertEqual((found.power.logic, found.power.sram, found.power.clock), (10.0, 20.0, 30.0))
        self.assertEqual(self.logic.call_args.args, ("typical", 200))
        self.assertEqual(self.sram.call_args.args, (NAMED["ezpointer"], 330.0))
        self.assertEqual(self.clock.call_args.args, ("typical", 200, ClockTree(1, 2.0, 3.0), self.technology.typical, 330.0))

    def test_the_clock_tree_feeds_columns_control_and_every_macro(self) -> None:
        # ezPointer: 200 columns with a macro each. poolPointer: 50 modules with a macro each, 6 engines with one.
        pin = run.sram_kit.CLOCK_PIN_FF
        for name, modules, macros in (("ezpointer", 200, 200), ("poolpointer", 50, 56)):
            self.finish(name)
            sinks, ff, cells = self.tree.call_args.args
            self.assertEqual((sinks, cells), (modules * 8 + 80 + macros, self.technology.slow))
            self.assertAlmostEqual(ff, modules * 6.0 + 60.0 + macros * pin)

    def test_what_hold_buffers_take_is_won_back_in_at_most_two_rounds(self) -> None:
        _, done = self.finish(slacks=(-0.02, -0.01, 0.0), changes=(True, True))
        self.assertEqual(done[1:7], [self.NOMINAL, ("resize", True, 0.024, 3), self.EARLY, ("hold", "fast", {"pin": 0.5}), self.NOMINAL,
                                     ("resize", True, 0.014, 3)])
        _, done = self.finish(slacks=(-0.02, -0.01, -0.005), changes=(True, True))
        self.assertEqual([step for step in done if step == self.NOMINAL], [self.NOMINAL] * 3)
        _, done = self.finish(slacks=(-0.02,), changes=(False,))
        self.assertEqual(done[1:4], [self.NOMINAL, ("resize", True, 0.024, 3), ("logic",)])

    def test_one_corner_has_neither_margins_nor_power(self) -> None:
        found, done = self.finish(corners=("slow",))
        self.assertEqual(done, [("slow", "nominal", "closing"), ("logic",)])
        self.assertEqual((found.margins, found.power, list(found.timing)), ({}, None, ["slow"]))
        found, done = self.finish(margin=None)
        self.assertEqual(done, [("slow", "nominal", "closing"), ("logic",), ("typical", "nominal", "closing", "power")])
        self.assertEqual(found.margins, {})


class Attempts(unittest.TestCase):
    def test_an_attempt_closes_with_a_tenth_of_a_nanosecond_and_with_margins(self) -> None:
        nothing = part_of(run._Netlist)
        for slack, margin, closes in ((0.1, 0.0, True), (0.0999, 0.2, False), (0.3, -0.0001, False), (0.1, None, True), (0.09, None, False)):
            attempt = run._Attempt(nothing, 0, slack, None if margin is None else replace(MARGIN, slack=margin))
            self.assertEqual(attempt.closes_with_margins, closes, (slack, margin))
        self.assertAlmostEqual(run._Attempt(nothing, 0, 0.3, replace(MARGIN, slack=0.05)).rank, 0.05)
        self.assertAlmostEqual(run._Attempt(nothing, 0, 0.12, replace(MARGIN, slack=0.05)).rank, 0.02)

    def test_an_attempt_with_an_overloaded_driver_does_not_close(self) -> None:
        nothing = part_of(run._Netlist)
        overloaded = run._Attempt(nothing, 0, 0.5, None, overloaded=1)
        self.assertFalse(overloaded.closes_with_margins)
        late = run._Attempt(nothing, 1, 0.05, None)
        self.assertIs(run._best([overloaded, late]), late)
        self.assertIs(run._best([overloaded]), overloaded)

    def test_an_attempt_counts_the_drivers_with_too_much_to_drive(self) -> None:
        found = [run.loads.Load("a", 9.0, 8.0, 1), run.loads.Load("b", 1.0, 8.0, 1), run.loads.Load("c", 8.1, 8.0, 1)]
        with mock.patch.object(run, "map_to_cells"), mock.patch.object(run, "efforts", return_value=(0, 1)), mock.patch.object(run, "same_logic"), \
                mock.patch.object(run, "floorplan"), mock.patch.object(run._Netlist, "prepare"), \
                mock.patch.object(run, "_timed", return_value=run._Attempt(part_of(run._Netlist), 1, 0.5, None)), \
                mock.patch.object(run.loads, "of_all", return_value=found):
            attempt = run._attempt(NAMED["ezpointer"], part_of(Technology, slow=part_of(library.Library)), Path(), 1, 0)
        self.assertEqual(attempt.overloaded, 2)
        self.assertFalse(attempt.closes_with_margins)

    def test_a_slow_path_of_the_array_decides_about_a_library_without_a_fast_corner(self) -> None:
        timed = part_of(run._Netlist, technology=part_of(Technology, fast=None),
                        time=lambda *asked: SimpleNamespace(slack=0.25 if asked == ("slow", "nominal") else 9))
        self.assertEqual(run._timed(timed, 4), run._Attempt(timed, 4, 0.25, None))


class OtherWays(InFolder):
    """The netlist that a run left, timed again."""

    def setUp(self) -> None:
        super().setUp()
        self.effort = self.folder / "effort1"
        self.effort.mkdir()
        self.result = replace(result("ezpointer"), effort=1)
        slow = part_of(library.Library, path=Path("cells.lib"), wire_load="slow wires", drives=[["A", "B"]], area={"A": 1.0},
                       buffers=[part_of(library.Buffer, input_pin="A", output_pin="Y")])
        fast = part_of(library.Library, path=Path("other.lib"), wire_load="other")
        self.technology = part_of(Technology, slow=slow, typical=part_of(library.Library, wire_load="other"), fast=fast, kit=Path("kit"), root=ROOT,
                                  target_mhz=330.0)
        (self.effort / timing.BLOCKS).write_text(json.dumps({"blocks": ["a_column", ["c0"], 2]}), encoding="utf-8")

    def measured(self, what, *arguments):
        report = SimpleNamespace(margin=lambda: replace(MARGIN, slack=0.07), slack=0.11, resized_slack=0.09, resized_area=2500.0)
        with mock.patch.object(run.timing, "measure", return_value=report) as self.measure:
            return what(self.result, self.technology, self.folder, *arguments)

    def test_the_flat_run_has_every_column_real_in_the_slow_corner(self) -> None:
        text = "module t;\n  a_column c0 (.a(b));\n  column_stand_in c1 (.a(b));\n  column_stand_in_x y (.a(b));\nendmodule\n"
        (self.effort / "timing.v").write_text(text, encoding="utf-8")
        self.assertEqual(self.measured(run.flat), run.Flat(MARGIN.slack, 0.07))
        self.assertEqual((self.effort / "flat.v").read_text(encoding="utf-8"), text.replace("column_stand_in c1", "a_column c1"))
        files, root, mhz, log, steps, settings = self.measure.call_args.args
        self.assertEqual(files, timing.Netlist("ezpointer, slow corner, all columns real", self.effort / "flat.v", self.effort / "wires_slow.spef",
                                               [Path("cells.lib"), Path("kit/sram40_slow.lib"), self.effort / "stand_in.lib"], "slow wires", "dtof_array"))
        self.assertEqual((root, mhz, log, steps, settings), (ROOT, 330.0, self.effort / "sta_flat.log", ("nominal", "margins"), None))
        (self.effort / "timing.v").write_text("module t;\nendmodule\n", encoding="utf-8")
        with self.assertRaisesRegex(FlowError, "ezpointer: no column has a stand-in"):
            self.measured(run.flat)

    def test_other_wires_are_timed_as_it_is_and_resized(self) -> None:
        self.assertEqual(self.measured(run.with_wires, 7.4), run.OtherWires(0.11, 0.07, 0.09, 0.0025))
        self.assertEqual((self.effort / "slow_wires.lib").read_text(encoding="utf-8"), standard_cells.library(standard_cells.SLOW, 7.4))
        asked = [call.args for call in self.measure.call_args_list]
        self.assertEqual([(one[0].liberty_files[:2], one[0].verilog, one[4]) for one in asked],
                         [([self.effort / "slow_wires.lib", Path("kit/sram40_slow.lib")], self.effort / "timing.v", steps)
                          for steps in (("nominal", "margins"), ("resize",))])
        self.assertEqual(asked[1][5], {"blocks": ["a_column", ["c0"], 2], "drives": [["A", "B"]], "cell_areas": {"A": 1.0}, "guard": "0.004",
                                       "shrinkable": [], "buffer_pins": ["A", "Y"], "dispensable": []})


class Areas(unittest.TestCase):
    def test_an_arrays_area_by_hand(self) -> None:
        # poolPointer: 50 modules of four columns, each with an SRAM; 6 engines with one. 800 um2 of cells a module, 5,000 um2 shared.
        found = result("poolpointer", 200.0, 5000.0)
        column, engine = (sram_model.macro(size).area for size in (Size(1, 100, 232, 8), Size(1, 160, 33)))
        self.assertEqual((found.columns, found.column.area), (200, 200.0))
        self.assertAlmostEqual(found.sram_area, column / 4)
        self.assertAlmostEqual(found.engine_sram_area, 6 * engine)
        self.assertAlmostEqual(found.total_mm2, (50 * (800.0 + column) + 5000.0 + 6 * engine) / 1e6)
        self.assertAlmostEqual(found.kge(1600.0), 2.0)  # of a NAND2 of 0.8 um2
        self.assertEqual(found.bits_per_pixel, 100 * 232 / (4 * 160))


if __name__ == "__main__":
    unittest.main()
