# SPDX-License-Identifier: Apache-2.0
"""The estimate of an area without RTL: closed forms, and beside what was synthesised."""

import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import rival_area, sram_model, standard_cells
from dtof_synth.errors import FlowError
from dtof_synth.rival_area import Base, Hardware

ROOT = Path(__file__).resolve().parent.parent.parent
AREA = ROOT / "reports" / "area.csv"


class RivalArea(unittest.TestCase):
    def test_words_that_change_apart_need_two_ports(self) -> None:
        self.assertEqual(rival_area.sram_um2(160, Hardware(32, 8)),
                         sram_model.macro(sram_model.Size(2, 5120, 8)).area)
        self.assertEqual(rival_area.sram_um2(160, Hardware(1, 14)),
                         sram_model.macro(sram_model.Size(1, 160, 14)).area)

    def test_wide_words_lie_in_several_macros(self) -> None:
        one = sram_model.macro(sram_model.Size(1, 160, 630)).area
        wide = rival_area.sram_um2(160, Hardware(1, 630))
        self.assertLess(wide, one)
        self.assertGreater(wide, 630 * 160 * sram_model.KINDS[1].cell_area)

    def test_macros_side_by_side_are_as_many_as_save_area(self) -> None:
        def area(bits: int) -> float:
            return sram_model.macro(sram_model.Size(1, 160, bits)).area

        for most, expected in ((1, area(630)), (2, 2 * area(315)), (3, min(2 * area(315), 3 * area(210)))):
            with mock.patch.object(rival_area, "MOST_MACROS", most):
                self.assertAlmostEqual(rival_area.sram_um2(160, Hardware(1, 630)), expected)
        self.assertLess(2 * area(315), area(630))
        self.assertEqual(rival_area.sram_um2(160, Hardware(1, 1)), area(1))

    def test_cells_of_a_bit_and_of_a_flag(self) -> None:
        # In pitches of the generated library, whose area is that of a NAND2's third.
        pitches = {gate.name: gate.pitches for gate in standard_cells.gates()} | {"DFF": standard_cells.sequential_pitches("DFF")}
        for area, parts in ((rival_area.bit_um2(), ("DFF", "DFF", "FA_X1", "MUX2_X1")),
                            (rival_area.flag_um2(), ("DFF", "AND2_X1", "AND2_X1", "OR2_X1"))):
            self.assertAlmostEqual(area, standard_cells.PITCH_AREA_UM2 * sum(pitches[part] for part in parts))
        with self.assertRaisesRegex(FlowError, "no standard cell is called XYZ"):
            rival_area._cell_um2("XYZ")

    def test_logic_adds_up(self) -> None:
        base = Base(100.0, 50.0)
        bit, adder = rival_area.bit_um2(), rival_area.logic_um2(Base(0.0, 0.0), Hardware(1, 0, 1))
        self.assertGreater(bit, 2 * adder)  # two flip-flops, an adder, a multiplexer
        self.assertAlmostEqual(rival_area.logic_um2(base, Hardware(4, 10, 20, 1000)), 100 + 10 * bit + 20 * adder + 80)
        self.assertAlmostEqual(rival_area.array_mm2(base, Hardware(1, 14), 3, 160) * 1e6,
                               3 * (rival_area.sram_um2(160, Hardware(1, 14)) + 100 + 14 * bit) + 50)

    def test_the_smallest_column_is_met_exactly(self) -> None:
        base = Base.read(AREA)
        self.assertGreater(base.column_um2, 0)
        rows = {line.split(",")[0]: line.split(",") for line in AREA.read_text(encoding="utf-8").splitlines()}
        synthesised = float(rows[rival_area.SMALLEST][rows["configuration"].index("total_mm2")])
        self.assertAlmostEqual(rival_area.array_mm2(base, Hardware(1, 10), 200, 160), synthesised, places=3)

    def test_the_thesis_readouts_are_estimated_within_five_percent(self) -> None:
        beside = rival_area.beside_synthesis(AREA, ROOT / "configurations.toml")
        self.assertGreaterEqual(len(beside), 8)
        for entry in beside:
            self.assertAlmostEqual(entry.estimated_mm2 / entry.synthesised_mm2, 1, delta=0.05, msg=entry.title)


if __name__ == "__main__":
    unittest.main()
