# SPDX-License-Identifier: Apache-2.0
import tempfile
import unittest
from pathlib import Path

from dtof_synth import line_buffer, standard_cells
from dtof_synth.errors import FlowError
from dtof_synth.library import Library
from dtof_synth.technology import Technology

from .partial import part_of
from .small_results import ROOT, result


class Area(unittest.TestCase):
    kept: tempfile.TemporaryDirectory[str]
    folder: Path
    technology: Technology

    @classmethod
    def setUpClass(cls) -> None:
        cls.kept = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.kept.name)
        liberty = cls.folder / "typical.lib"
        liberty.write_text(standard_cells.library(standard_cells.TYPICAL), encoding="utf-8")
        cls.technology = part_of(Technology, root=ROOT, typical=part_of(Library, path=liberty))

    @classmethod
    def tearDownClass(cls) -> None:
        cls.kept.cleanup()

    def test_a_bit_costs_the_same_in_every_line(self) -> None:
        def per_bit(lines: int) -> float:
            wide, narrow = (line_buffer.area((8, lines, width), self.technology, self.folder) for width in (40, 20))
            return (wide - narrow) / 20

        two, three = per_bit(2), per_bit(3)
        self.assertGreater(two, 0)
        self.assertGreater(three, 1.3 * two)
        self.assertLess(three, 1.7 * two)

    def test_illegal_lines_are_refused(self) -> None:
        with self.assertRaisesRegex(FlowError, "LINES must be at least 2"):
            line_buffer.area((8, 1, 8), self.technology, self.folder)


class Section(unittest.TestCase):
    def test_the_size_is_the_subsystems_default(self) -> None:
        self.assertEqual(line_buffer.size(result("ezpointer").configuration), (320, 2, 2000))

    def test_the_goal_is_judged(self) -> None:
        arrays = [(result("ezpointer"), 1e6), (result("poolpointer"), 1e6)]
        text = line_buffer.section(arrays, {"ezpointer": 30000.0, "poolpointer": 30001.0})
        self.assertIn("| ezPointer | 2 | 4002 | 0.0300 | 3.00% | yes |", text)
        self.assertIn("| poolPointer | 2 | 4002 | 0.0300 | 3.00% | no |", text)
        met, missed = line_buffer.goals(arrays, {"ezpointer": 30000.0, "poolpointer": 30001.0})
        self.assertTrue(met.met)
        self.assertFalse(missed.met)
        self.assertEqual(missed.text, "poolPointer: line buffer at most 3 % of the array")


if __name__ == "__main__":
    unittest.main()
