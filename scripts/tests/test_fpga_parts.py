# SPDX-License-Identifier: Apache-2.0
import unittest

import fpga_check
import fpga_parts
from fpga_parts import Need, Part

PARTS = (Part("small", 1000, 500, 4), Part("large", 2000, 4000, 8))


class FpgaParts(unittest.TestCase):
    def test_the_smallest_part_that_holds_an_array(self) -> None:
        self.assertEqual(fpga_parts.answer(PARTS, Need(800, 500, 4)), "small")
        for need in (Need(801, 500, 4), Need(800, 501, 4), Need(800, 500, 5)):  # four fifths of the look-up tables, all of the others
            self.assertEqual(fpga_parts.answer(PARTS, need), "large")
        self.assertEqual(fpga_parts.answer(PARTS, Need(1601, 4000, 9)), "none: large has too few look-up tables and block RAMs")
        self.assertEqual(fpga_parts.answer(PARTS, Need(1600, 4001, 8)), "none: large has too few flip-flops")

    def test_parts_come_in_ascending_order(self) -> None:
        for parts in fpga_parts.PARTS.values():
            for part, larger in zip(parts, parts[1:]):
                self.assertTrue(part.tables < larger.tables and part.registers < larger.registers and part.block_rams < larger.block_rams)

    def test_a_block_ram_of_36_kbit_counts_twice(self) -> None:
        text = "Number of cells: 30\n     RAMB18E1   3\n     RAMB36E1   2\n     LUT6  20\n     FDCE 5\n"
        self.assertEqual(fpga_check.needed(fpga_check.FAMILIES["xilinx"], text), Need(20, 5, 7))

    def test_the_section_has_a_row_for_each_array(self) -> None:
        needs = {(name, size, family): Need(size * 100, size * 50, size * 2) for name in fpga_parts.READOUTS for size in fpga_parts.SIZES
                 for family in fpga_parts.PARTS}
        lines = fpga_parts.section(needs, {name: name for name in fpga_parts.READOUTS}, {"xilinx": "Xilinx 7", "ecp5": "ECP5"})
        self.assertEqual(sum(line.startswith("| ") for line in lines), 1 + 2 * len(fpga_parts.READOUTS))
        self.assertIn("| ezpointer | 32 x 32 | 64 | 3,200 | 1,600 | XC7A35T | 64 | 3,200 | 1,600 | LFE5U-45 |", lines)
        self.assertIn("| hispointer | 64 x 64 | 128 | 6,400 | 3,200 | XC7A100T | 128 | 6,400 | 3,200 | LFE5U-85 |", lines)


if __name__ == "__main__":
    unittest.main()
