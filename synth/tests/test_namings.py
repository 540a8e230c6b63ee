# SPDX-License-Identifier: Apache-2.0
"""When a search over names is made and when its known end serves."""

import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

from dtof_synth import configuration, namings, run
from dtof_synth.errors import FlowError
from dtof_synth.namings import Naming

ROOT = Path(__file__).resolve().parents[2]
KNOWN = Naming(1, 3, 7, "digest")


class Namings(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = Path(self.folder.name) / "namings.csv"

    def efforts_tried(self, known: Naming | None, closing: set, most: int | None = None, name: str = "hispointer") -> list:
        """(effort, namings known) of each mapping, where those in `closing` close."""
        tried = []

        def attempt(_configuration, _technology, _folder, number, _digest, naming=None):
            tried.append((number, naming))
            return SimpleNamespace(closes_with_margins=(number, naming) in closing)

        with mock.patch.object(run, "_attempt", attempt), mock.patch.object(run, "mapping_digest", lambda *_: "digest"):
            run._attempts(configuration.load(ROOT / "configurations.toml")[name], None, Path(), most, known)
        return tried

    def test_a_known_naming_of_the_same_mapping_is_all_that_is_tried(self):
        self.assertEqual(self.efforts_tried(KNOWN, {(1, KNOWN)}), [(1, KNOWN)])

    def test_a_naming_of_another_mapping_is_not_used(self):
        self.assertEqual(self.efforts_tried(Naming(1, 3, 7, "other"), {(0, None)}), [(0, None)])

    def test_a_known_naming_that_does_not_close_is_what_the_search_found(self):
        self.assertEqual(self.efforts_tried(KNOWN, {(1, None)}), [(1, KNOWN)])

    def test_efforts_are_tried_until_one_closes(self):
        for name in ("ezpointer", "poolpointer2"):
            self.assertEqual(self.efforts_tried(None, {(0, None)}, name=name), [(0, None)])
            self.assertEqual(self.efforts_tried(None, {(1, None)}, name=name), [(0, None), (1, None)])

    def test_the_smallest_that_closes_is_taken_else_the_one_that_misses_least(self):
        def attempt(area: float, rank: float) -> SimpleNamespace:
            return SimpleNamespace(rank=rank, closes_with_margins=rank >= 0, netlist=SimpleNamespace(cell_area=lambda: area))

        self.assertEqual(run._best([attempt(3, 0.2), attempt(2, 0.0), attempt(1, -0.1)]).netlist.cell_area(), 2)
        self.assertEqual(run._best([attempt(3, -0.1), attempt(2, -0.2)]).netlist.cell_area(), 3)

    def test_without_a_search_for_timing_it_need_not_close(self):
        self.assertEqual(self.efforts_tried(KNOWN, set(), most=1), [(1, KNOWN)])

    def test_what_is_written_is_read(self):
        other = Naming(0, 0, 1, "d")
        namings.write(self.file, {"a": KNOWN, "b": other}, ["b", "a"])
        namings.write(self.file, {"c": other}, ["c", "a"])
        self.assertEqual(namings.read(self.file), {"c": other, "a": KNOWN})
        self.assertEqual(list(namings.read(self.file)), ["c", "a"])

    def test_a_damaged_file_is_one_clear_line(self):
        self.file.write_text("configuration,effort,column,shared,digest\na,one,2,3,d\n", encoding="utf-8")
        with self.assertRaisesRegex(FlowError, "namings.csv: not a list of namings"):
            namings.read(self.file)


if __name__ == "__main__":
    unittest.main()
