# SPDX-License-Identifier: Apache-2.0
"""What fails `make synth STRICT=1`: missed and open goals, negative slacks, and exceptions that do not fit."""

import argparse
import tempfile
import unittest
from dataclasses import fields, replace
from datetime import date
from pathlib import Path
from typing import Any
from unittest import mock

from dtof_synth import cli, gates, goals, report
from dtof_synth.errors import FlowError
from dtof_synth.gates import Exemption
from dtof_synth.goals import Goal

from .small_results import MARGIN, ROOT, TIMING, result

SLACKS = ("slack", "hold_slack", "reset_slack")


def negative(slack: str) -> dict[str, Any]:
    """A change of one slack, for dataclasses.replace."""
    return {slack: -0.001}


def failing(checks: list[Goal]) -> list[str]:
    return [check.text for check in checks if not check.met]


class Slacks(unittest.TestCase):
    def test_each_negative_slack_is_one_check_that_fails(self):
        good = result("ezpointer")
        self.assertEqual(failing([*gates.slacks({"ezpointer": good}), *goals.check({"ezpointer": good})]), [])
        for corner in ("slow", "fast"):
            for slack, kind in zip(SLACKS, ("setup", "hold", "reset")):
                bad = replace(good, margins=good.margins | {corner: replace(MARGIN, **negative(slack))})
                self.assertEqual(failing(gates.slacks({"ezpointer": bad})), [f"ezpointer: {kind} with margins, {corner} corner"])
        for corner, slack, text in (("typical", "slack", "setup"), ("typical", "hold_slack", "hold"), ("slow", "hold_slack", "hold")):
            bad = replace(good, timing=good.timing | {corner: replace(TIMING, **negative(slack))})
            self.assertEqual(failing(gates.slacks({"ezpointer": bad})), [f"ezpointer: {text}, {corner} corner"])

    def test_a_slow_edge_is_a_check_that_fails(self):
        good = result("ezpointer")
        for corner in ("slow", "typical"):
            bad = replace(good, timing=good.timing | {corner: replace(TIMING, slow_edges=1)})
            self.assertEqual(failing(gates.slacks({"ezpointer": bad})), [f"ezpointer: edges, {corner} corner"])

    def test_setup_in_the_slow_corner_is_a_goal_or_a_check(self):
        for name, text in (("ezpointer", "ezPointer: closes 330 MHz, slow corner"), ("ezpointer_bare", "ezpointer_bare: setup, slow corner")):
            bad = result(name)
            bad = replace(bad, timing=bad.timing | {"slow": replace(TIMING, slack=-0.001)})
            self.assertEqual(failing([*gates.slacks({name: bad}), *goals.check({name: bad})]), [text])

    def test_every_slack_of_the_result_is_looked_at(self):
        # A slack that is added to a result, but to none of the checks, fails here.
        self.assertEqual({field.name for field in fields(MARGIN) if "slack" in field.name}, set(SLACKS))
        self.assertEqual({field.name for field in fields(TIMING) if "slack" in field.name}, {"slack", "hold_slack", "fast_slack"})


class Goals(unittest.TestCase):
    def test_a_limit_is_the_largest_value_that_is_met(self):
        # ezPointer's column 700 um2, others' 1200, poolPointer's array 1.15 mm2, lean's 0.81 mm2, one-port ezPointer's 0.65 mm2.
        pool, lean, one_port = (result(name, 0.0) for name in ("poolpointer", "poolpointer_lean", "ezpointer_one_port"))
        pool_shared = 1.15e6 - pool.total_mm2 * 1e6
        lean_shared = 0.81e6 - lean.total_mm2 * 1e6
        one_port_shared = 0.65e6 - one_port.total_mm2 * 1e6
        for name, at, above, text in (
                ("ezpointer", {"logic_um2": 700.0}, {"logic_um2": 701.0}, "ezPointer: logic of a column at most 700 um2"),
                ("fifh", {"logic_um2": 1200.0}, {"logic_um2": 1201.0}, "FiFH: logic of a column at most 1200 um2"),
                ("poolpointer", {"logic_um2": 0.0, "shared_um2": pool_shared - 1}, {"logic_um2": 0.0, "shared_um2": pool_shared + 1},
                 "poolPointer: array at most 1.15 mm2"),
                ("poolpointer_lean", {"logic_um2": 0.0, "shared_um2": lean_shared - 1}, {"logic_um2": 0.0, "shared_um2": lean_shared + 1},
                 "poolPointer lean: array at most 0.81 mm2"),
                ("ezpointer_one_port", {"logic_um2": 0.0, "shared_um2": one_port_shared - 1},
                 {"logic_um2": 0.0, "shared_um2": one_port_shared + 1}, "ezPointer, one-port SRAM: array at most 0.65 mm2")):
            self.assertEqual(failing(goals.check({name: result(name, **at)})), [])
            self.assertEqual(failing(goals.check({name: result(name, **above)})), [text])

    def test_the_fast_clock_is_a_goal(self):
        bad = result("fifh")
        bad = replace(bad, timing=bad.timing | {"typical": replace(TIMING, fast_slack=-0.001)})
        self.assertEqual(failing(goals.check({"fifh": bad})), ["FiFH: closes 500 MHz, typical corner"])

    def test_the_order_of_areas_is_a_goal(self):
        # hisPointer's columns get the cells that make its array 1.05 times FiFH's.
        def areas(hispointer_um2: float) -> list[str]:
            found = {name: result(name, 0.0) for name in ("ezpointer", "sifh")}
            found["fifh"] = result("fifh", 1000.0)
            found["hispointer"] = result("hispointer", hispointer_um2)
            return failing(goals.check(found))

        fifh = result("fifh", 1000.0).total_mm2
        sram = result("hispointer", 0.0).total_mm2
        largest = (1.05 * fifh - sram) * 1e6 / 200
        text = "Table 1: area ranks ezPointer 1, FiFH and hisPointer 2, SiFH 3"
        self.assertEqual(areas(largest - 1), [])
        self.assertEqual(areas(largest + 1), [text])

    def test_reasons_stand_behind_the_table(self):
        missed, met = Goal("small", "large", False), Goal("small", "tiny", True)
        exemptions = [Exemption("small", "It is large.", date(2026, 11, 26))]
        self.assertIn("| small | large | **no** |\n\nMissed:\n\n* small: large. It is large. (2026-11-26)\n",
                      report.goals_section([missed], exemptions))
        self.assertIn("* small: large.\n", report.goals_section([missed], []))
        self.assertNotIn("Missed", report.goals_section([met], []))


class Measured(unittest.TestCase):
    def measured(self, *rows: str) -> list[Goal]:
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "pool.md"
            page.write_text("\n".join(["# Page", "", "## Goals", "", "Words.", "", "| goal | measured | limit | met |", "|---|---:|---:|---:|",
                                       *rows, "", "## Next", "| a | 9.0 +-1.0 | 1.0 | yes |", ""]), encoding="utf-8")
            return gates.measured(page)

    def test_a_goal_is_met_only_by_its_whole_interval(self):
        found = self.measured("| below | 0.85 +-0.04 | 0.90 | yes |", "| touches | 0.86 +-0.04 |  0.90 | yes |",
                              "| holds it | 0.93 +-0.04 | 0.90 | **no** |", "| above | 0.95 +-0.04 | 0.90 | yes |")
        self.assertEqual([(goal.text, goal.met, goal.is_open) for goal in found],
                         [("below", True, False), ("touches", False, True), ("holds it", False, True), ("above", False, False)])

    def test_a_row_that_cannot_be_read_is_no_goal_that_is_met(self):
        for rows in (("| without interval | 0.85 | 0.90 | yes |",), ()):
            with self.assertRaisesRegex(FlowError, "pool.md"):
                self.measured(*rows)


class Exceptions(unittest.TestCase):
    MISSED, MET = Goal("a", "1", False), Goal("b", "2", True)

    def judge(self, *whats: str, everything: bool = True) -> tuple[list[str], bool]:
        return gates.judge([self.MISSED, self.MET], [Exemption(what, "so", date(2026, 11, 26)) for what in whats], everything)

    def test_what_is_missed_fails_unless_excepted(self):
        self.assertEqual(self.judge(), (["missed: a: 1"], True))
        self.assertEqual(self.judge("a"), (["missed: a: 1 (excepted 2026-11-26: so)"], False))
        self.assertEqual(gates.judge([Goal("c", "3", False, True)], [], True), (["goal open: c: 3"], True))

    def test_an_exception_that_is_not_needed_fails(self):
        self.assertEqual(self.judge("a", "b")[1], True)
        self.assertIn("exception no longer needed: b: 2", self.judge("a", "b")[0])

    def test_an_exception_for_nothing_fails_where_everything_is_checked(self):
        self.assertEqual(self.judge("a", "gone"), (["missed: a: 1 (excepted 2026-11-26: so)",
                                                    "exception for a check that does not exist: gone"], True))
        self.assertEqual(self.judge("a", "gone", everything=False)[1], False)

    def test_the_committed_list_can_be_read(self):
        self.assertTrue(gates.read(ROOT / gates.FILE))

    def test_an_entry_without_reason_or_date_is_refused(self):
        whole = '[[exception]]\nwhat = "a"\nreason = "so"\ndate = 2026-11-26\n'
        for text, message in ((whole.replace('reason = "so"\n', ""), "exception 1: needs"), (whole.replace("2026-11-26", '"today"'), "needs"),
                              (whole.replace('"so"', '""'), "needs"), (whole + "more = 1\n", "needs"), (whole + whole, "exception 2: 'a' stands"),
                              ("x = ", "exceptions.toml")):
            with tempfile.TemporaryDirectory() as folder, self.subTest(text=text):
                file = Path(folder) / "exceptions.toml"
                file.write_text(text, encoding="utf-8")
                with self.assertRaisesRegex(FlowError, message):
                    gates.read(file)


class NoReport(unittest.TestCase):
    def test_a_report_without_goals_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "pool.md"
            for text, message in ((None, "no section 'Goals'"), ("# Pool\n", "no section 'Goals'"), ("## Goals\n\nNone.\n", "no goal in the section"),
                                  ("## Goals\n| goal | a |\n|---|---|\n| b |\n", "cannot read the goal")):
                if text is not None:
                    file.write_text(text, encoding="utf-8")
                with self.assertRaisesRegex(FlowError, message):
                    gates.measured(file)


class Command(unittest.TestCase):
    """The status of `make synth`."""

    def status(self, strict: bool, goals_: list[Goal], budgets_: list[str]) -> int:
        with mock.patch.object(cli, "_say"), mock.patch.object(cli.budgets, "moved", lambda *_: budgets_), \
                mock.patch.object(cli.gates, "read", lambda _: []):
            return cli._gate(argparse.Namespace(strict=strict), {}, goals_, {}, everything=True)

    def test_strict_fails_for_a_goal_and_for_a_budget(self):
        missed, met = Goal("a", "1", False), Goal("b", "2", True)
        self.assertEqual(self.status(True, [met], []), 0)
        self.assertEqual(self.status(True, [missed], []), 1)
        self.assertEqual(self.status(True, [met], ["some moved"]), 1)
        self.assertEqual(self.status(False, [missed], ["some moved"]), 0)


if __name__ == "__main__":
    unittest.main()
