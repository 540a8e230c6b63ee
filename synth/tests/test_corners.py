# SPDX-License-Identifier: Apache-2.0
"""Each corner has its own wires, and each repair is measured in the corner that it is for."""

import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast
from unittest import mock

from dtof_synth import library, run, spef, standard_cells, timing
from dtof_synth.configuration import Configuration, load
from dtof_synth.floorplan import Floorplan
from dtof_synth.technology import Technology

from .partial import part_of
from .small_results import MARGIN
from .test_floorplan import array

COLUMNS = 13  # from the middle of the first to that of the last: 12 pitches of 25 um, 300 um


class Wires(unittest.TestCase):
    def test_the_slow_corner_has_a_quarter_more_resistance_and_capacitance(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
            cells = library.read(folder / "slow.lib")
            design = array(COLUMNS)
            plan = Floorplan(design, 1)
            plan.rename(spef.plain_names(design)["array"])
            timed = run._Netlist(design, plan, part_of(Configuration), part_of(Technology, slow=cells), folder, {})
            timed.write_wires(design)
            for corner, ohm_per_um, ff_per_um in (("slow", 1.875, 0.25), ("typical", 1.5, 0.2), ("fast", 1.5, 0.2)):
                text = (folder / f"wires_{corner}.spef").read_text(encoding="utf-8")
                net = next(part for part in text.split("*D_NET ") if "far:Q" in part)
                ohm = [float(line.split()[3]) for line in net.split("*RES\n")[1].split("*END")[0].splitlines()]
                ff = [float(line.split()[2]) for line in net.split("*CAP\n")[1].split("*RES")[0].splitlines()]
                # A node of no length has 0.01 ohm; each column's pin has the wire load of a sink, 2 um of 0.2 fF.
                self.assertAlmostEqual(sum(ohm), 300 * ohm_per_um, delta=0.05, msg=corner)
                self.assertAlmostEqual(sum(ff), 300 * ff_per_um + COLUMNS * cells.wire_ff_per_sink, delta=0.01, msg=corner)


class _Recorder:
    """A netlist that notes what it is asked to time."""

    design: dict = {"modules": {"t": {"attributes": {"top": "1"}, "cells": {}}}}

    def __init__(self) -> None:
        self.asked: list[tuple[str, ...]] = []
        self.technology = part_of(Technology, fast=object())

    def time(self, corner: str, *steps: str, **_) -> SimpleNamespace:
        self.asked.append((corner, *steps))
        return SimpleNamespace(slack=0.2, margin=lambda: MARGIN, early=[], spare={})

    def resize(self, again: bool, guard_ns: float, engine: int) -> run.Resized:
        return run.Resized(False, 0.0)

    def early_pins(self, _) -> list[str]:
        return []

    def engine_of(self, _) -> int:
        return 0

    def netlist(self) -> run._Netlist:
        """The recorder for code that takes a netlist."""
        return cast(run._Netlist, self)


class Repairs(unittest.TestCase):
    def test_setup_is_judged_in_the_slow_corner_and_hold_in_the_fast_one(self) -> None:
        recorder = _Recorder()
        run._timed(recorder.netlist(), 0)
        self.assertEqual([asked[:3] for asked in recorder.asked if "early" in asked], [("fast", "margins", "early")])
        self.assertEqual([asked[:3] for asked in recorder.asked if "nominal" in asked], [("slow", "nominal", "margins")])

    def test_what_resizing_cannot_mend_is_timed_once_after_each_change(self) -> None:
        class Late(_Recorder):
            changes = iter([True, True, False])
            guards: list[float] = []

            def time(self, corner: str, *steps: str, **settings) -> SimpleNamespace:
                report = super().time(corner, *steps, **settings)
                report.margin = lambda: replace(MARGIN, slack=-0.1)
                return report

            def resize(self, again: bool, guard_ns: float, engine: int) -> run.Resized:
                self.guards.append(guard_ns)
                return run.Resized(next(self.changes), 0.03)

        recorder = Late()
        attempt = run._timed(recorder.netlist(), 0)
        self.assertEqual([asked[0] for asked in recorder.asked], ["fast", "slow"] * 2)
        # The first engine had 0.03 ns to spare where the array missed by 0.1: as much more is asked of it then.
        self.assertEqual([round(guard, 6) for guard in recorder.guards], [0.004, 0.134, 0.134])
        self.assertFalse(attempt.closes_with_margins)

    def test_the_engine_of_the_slowest_path_is_resized_next(self) -> None:
        class Elsewhere(_Recorder):
            engines: list[tuple[int, float]] = []

            def time(self, corner: str, *steps: str, **settings) -> SimpleNamespace:
                report = super().time(corner, *steps, **settings)
                report.margin = lambda: replace(MARGIN, slack=-0.1)
                return report

            def resize(self, again: bool, guard_ns: float, engine: int) -> run.Resized:
                self.engines.append((engine, round(guard_ns, 6)))
                return run.Resized(len(self.engines) < 3, 0.03)

            def engine_of(self, _) -> int:
                return 2

        recorder = Elsewhere()
        run._timed(recorder.netlist(), 0)
        # What the array misses is asked of an engine that has not been examined yet.
        self.assertEqual(recorder.engines, [(0, 0.004), (2, 0.104), (2, 0.134)])

    def test_the_ends_of_a_path_tell_its_engine(self) -> None:
        pool = load(Path(__file__).resolve().parents[2] / "configurations.toml")["poolpointer"]
        timed = part_of(run._Netlist, configuration=pool)
        for start, end, engine in (("received[145]", "g_quad[14].u_quad/g_pair[1].u_pair.leader_cell_q[0]", 1), ("received[1]", "g_quad[0].u_quad/u_sram", 0),
                                   ("g_quad[49].u_quad/u_sram", "u_parity_store.accessed_q[3]", 5), ("rst_ni", "g_engine[3].u_engine/above_valid_q", 3),
                                   ("start_i", "u_control.u_controller.state_q[0]", 0)):
            with self.subTest(end=end):
                self.assertEqual(run._Netlist.engine_of(timed, replace(MARGIN, start=start, end=end)), engine)

    def test_hold_is_mended_until_the_fast_corner_has_no_early_path(self) -> None:
        class TooEarly(_Recorder):
            plan = SimpleNamespace(places={})

            def write(self) -> None:
                pass

        path = SimpleNamespace(slack=-0.03, pins=["g/A"])
        recorder = TooEarly()
        report = part_of(timing.Report, early=[path], margin=lambda: MARGIN)
        recorder.technology = part_of(Technology, slow=None, fast=recorder.technology.fast)
        with mock.patch.object(run.netlist, "delay_pins", return_value={}) as delayed:
            run._Netlist.fix_hold(recorder.netlist(), report, {"g/A": 1.0})
        # 0.03 ns take two buffers of 0.0169 ns.
        self.assertEqual(delayed.call_args.args[1], {("", "g", "A"): 2})
        self.assertEqual(recorder.asked, [("fast", "margins", "early")])


if __name__ == "__main__":
    unittest.main()
