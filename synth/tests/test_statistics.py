# SPDX-License-Identifier: Apache-2.0
"""Numbers of cells in the texts of an old and a new Yosys."""

import unittest

from dtof_synth import statistics
from dtof_synth.errors import FlowError

OLD = """
2.51. Printing statistics.

=== t ===

   Number of wires:                 32
   Number of cells:                 70
     SB_CARRY                       70

3. Printing statistics.

=== t ===

   Number of wires:                 32
   Number of wire bits:            186
   Number of memories:               0
   Number of processes:              0
   Number of cells:                 67
     SB_CARRY                        7
     SB_DFF                         32
     $_NOT_                         25
     SB_RAM40_4K                     3

"""
NEW = """
2.51. Printing statistics.

=== t ===

       50 wires
       70 cells
       70   SB_CARRY

3. Printing statistics.

=== t ===

        +----------Local Count, excluding submodules.
        |
       50 wires
      188 wire bits
       50 public wires
        8 ports
       58 port bits
        - memories
       67 cells
        7   SB_CARRY
       32   SB_DFF
       25   $_NOT_
        3   SB_RAM40_4K

"""
CELLS = {"SB_CARRY": 7, "SB_DFF": 32, "$_NOT_": 25, "SB_RAM40_4K": 3}


class Statistics(unittest.TestCase):
    def test_the_last_modules_cells_of_either_version(self):
        for name, text in {"old": OLD, "new": NEW}.items():
            with self.subTest(name=name):
                self.assertEqual(statistics.cells(text), CELLS)
                self.assertEqual(statistics.cells(statistics.last(text)), CELLS)
                self.assertTrue(statistics.last(text).startswith("=== t ===\n"))

    def test_a_text_that_is_not_understood_is_no_empty_table(self):
        for text in ("", OLD.replace("Number of cells", "Cells"), OLD.replace("SB_DFF                         32", ""),
                     NEW.replace(" cells", " instances"), NEW.replace("       32   SB_DFF\n", "")):  # fmt: skip
            with self.subTest(text=text[-200:]), self.assertRaisesRegex(FlowError, "Yosys printed"):
                statistics.cells(text)


if __name__ == "__main__":
    unittest.main()
