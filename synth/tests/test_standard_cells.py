# SPDX-License-Identifier: Apache-2.0
"""The generated standard cells against their stated figures and, where present, Nangate 45 nm."""

import unittest
from pathlib import Path

from dtof_synth import liberty, standard_cells
from dtof_synth.standard_cells import CINV_FF, FAST, SLOW, TYPICAL, inverter, path_delay

NANGATE = Path(__file__).resolve().parents[3] / "shared" / "pdk" / "liberty" / "nangate45_typ.lib.gz"


def fo4(corner) -> float:
    """Delay of an inverter with fan-out 4 whose input comes from another one."""
    tau = standard_cells.FO4_NS / 5 * corner.gate
    _, slew = path_delay((inverter(),), 0.0, 4 * CINV_FF, tau)
    return path_delay((inverter(),), slew, 4 * CINV_FF, tau)[0]


class StandardCells(unittest.TestCase):
    def test_fo4_is_28_ps_typical_and_nangate_ratio_slow(self):
        self.assertAlmostEqual(fo4(TYPICAL), 0.028, places=6)
        self.assertAlmostEqual(fo4(SLOW) / fo4(TYPICAL), 81 / 25.8, places=6)
        self.assertAlmostEqual(fo4(FAST) / fo4(TYPICAL), 16 / 25.8, places=6)

    def test_setup_and_hold_of_a_flip_flop(self):
        # Nangate's 0.029 and 0.017 ns by 28 / 25.8; slow 0.137 and 0.058 ns, fast 0.026 and 0.008 ns by the same.
        for corner, setup, hold in ((TYPICAL, 0.029, 0.017), (SLOW, 0.137, 0.058), (FAST, 0.026, 0.008)):
            cell = next(cell for cell in liberty.parse(standard_cells.library(corner), "generated").children("cell")
                        if cell.name == "DFF_X1")
            pin = next(pin for pin in cell.children("pin") if pin.name == "D")
            found = {arc.get("timing_type"): float(dict(arc.groups[0].attributes)["values"][0]) for arc in pin.children("timing")}
            self.assertEqual(list(found), ["setup_rising", "hold_rising"])
            self.assertAlmostEqual(found["setup_rising"], setup * 28 / 25.8, places=4)
            self.assertAlmostEqual(found["hold_rising"], hold * 28 / 25.8, places=4)

    def test_area_anchors(self):
        cells = {cell.name: cell.number("area") for cell in
                 liberty.parse(standard_cells.library(TYPICAL), "generated").children("cell")}
        self.assertAlmostEqual(cells["NAND2_X1"], 0.7056, places=4)
        self.assertGreaterEqual(cells["DFF_X1"], 3.0)
        self.assertLessEqual(cells["DFF_X1"], 3.6)

    def test_delay_grows_with_load_and_slew_in_every_table(self):
        library = liberty.parse(standard_cells.library(SLOW), "generated")
        tables = 0
        for cell in library.children("cell"):
            for pin in cell.children("pin"):
                for timing in pin.children("timing"):
                    for table in timing.children("cell_rise"):
                        rows = [list(map(float, row.split(","))) for row in dict(table.attributes)["values"]]
                        tables += 1
                        for row in rows:
                            self.assertEqual(row, sorted(row), cell.name)
                            self.assertGreater(row[0], 0, cell.name)
                        for column in zip(*rows):
                            self.assertEqual(list(column), sorted(column), cell.name)
        self.assertGreater(tables, 100)

    @unittest.skipUnless(NANGATE.exists(), "../shared/pdk is not present")
    def test_areas_are_nangates_times_the_shrink(self):
        theirs = {cell.name: cell.number("area") for cell in liberty.read(NANGATE).children("cell")}
        compared = 0
        for gate in standard_cells.gates():
            if gate.name in theirs and gate.name.endswith("_X1") and gate.name != "AOI211_X1":
                ratio = gate.pitches * standard_cells.PITCH_AREA_UM2 / theirs[gate.name]
                self.assertAlmostEqual(ratio, 0.884, delta=0.01, msg=gate.name)
                compared += 1
        self.assertGreater(compared, 20)


if __name__ == "__main__":
    unittest.main()
