# SPDX-License-Identifier: Apache-2.0
import csv
import unittest
from pathlib import Path

from dtof_synth import ihp130, sram_model
from dtof_synth.sram_model import Size

ROOT = Path(__file__).resolve().parents[2]
PDK = ROOT.parent / "shared" / "pdk"


def compiled(ports: int, words: int, bits: int, area: float, access: float = 3.0) -> ihp130.Compiled:
    return ihp130.Compiled(f"{ports}P_{words}x{bits}", Size(ports, words, bits), 2, area, 1.0, access, access + 2, 0.4, 0.8)


class Choice(unittest.TestCase):
    MACROS = [compiled(1, 64, 64, 500), compiled(1, 256, 16, 300), compiled(1, 256, 64, 900), compiled(2, 256, 16, 600)]

    def test_the_smallest_that_holds_all_words(self):
        for size, copies, name in ((Size(1, 60, 60), 1, "1P_64x64"), (Size(1, 160, 14), 1, "1P_256x16"),
                                   (Size(1, 160, 20), 2, "1P_256x16"), (Size(1, 100, 116), 2, "1P_256x64"),
                                   (Size(2, 256, 16), 1, "2P_256x16")):
            chosen = ihp130.choose(size, self.MACROS)
            self.assertEqual((chosen[0], chosen[1].name), (copies, name), size)

    def test_too_many_words_or_other_ports(self):
        self.assertIsNone(ihp130.choose(Size(1, 257, 4), self.MACROS))
        self.assertIsNone(ihp130.choose(Size(2, 16, 4), self.MACROS[:3]))

    def test_the_memory_has_its_figures(self):
        memory = ihp130.macro(Size(1, 160, 20), self.MACROS)
        self.assertEqual((memory.banks, memory.area, memory.access_slow, memory.setup, memory.hold), (2, 600, 5.0, 0.4, 0.8))
        self.assertEqual(ihp130.macro(Size(1, 257, 4), self.MACROS), sram_model.macro(Size(1, 257, 4)))


@unittest.skipUnless((PDK / "ihp130").is_dir(), f"{PDK}/ihp130 is not here")
class ThePdk(unittest.TestCase):
    def test_sizes_and_access_times_beside_a_list_read_by_hand(self):
        macros = {(macro.size.words, macro.size.bits): macro for macro in ihp130.read(PDK / "ihp130" / "sram")
                  if macro.size.ports == 1}
        compared = 0
        with (PDK / "sram_points" / "ihp130_1p.csv").open(encoding="utf-8") as file:
            for row in csv.DictReader(file):
                macro = macros.get((int(row["words"]), int(row["bits"])))
                if macro is None:
                    continue
                self.assertAlmostEqual(macro.width, float(row["w_um"]))
                self.assertAlmostEqual(macro.height, float(row["h_um"]))
                if row["clk2q_slow_ns"]:
                    self.assertAlmostEqual(macro.access_typical, float(row["clk2q_typ_ns"]), delta=0.15)
                    self.assertAlmostEqual(macro.access_slow, float(row["clk2q_slow_ns"]), delta=0.2)
                    compared += 1
        self.assertGreaterEqual(compared, 1)


if __name__ == "__main__":
    unittest.main()
