# SPDX-License-Identifier: Apache-2.0
"""The SRAM model against its stated rule, the public points and the list of sizes."""

import math
import tempfile
import unittest
from pathlib import Path

from dtof_synth import sram_kit, sram_model, sram_report
from dtof_synth.errors import FlowError
from dtof_synth.sram_model import KINDS, Size, macro

PDK = Path(__file__).resolve().parents[3] / "shared" / "pdk"


class SramModel(unittest.TestCase):
    def test_area_by_hand(self) -> None:
        # 160 x 10, two ports: mux 2 gives 80 rows and 20 columns.
        found = macro(Size(2, 160, 10))
        self.assertEqual((found.mux, found.rows, found.columns, found.banks), (2, 80, 20, 1))
        self.assertAlmostEqual(found.area, (55.6 + 0.472 / 0.356 * 20) * (35.7 + 0.356 * 80), places=3)

    def test_the_chosen_mux_is_legal_and_none_is_smaller(self) -> None:
        for ports, kind in KINDS.items():
            for words in (16, 160, 1000, 5120, 10240):
                for bits in (1, 5, 10, 19, 30):
                    found = macro(Size(ports, words, bits))
                    if found.banks > 1:
                        continue
                    self.assertTrue(16 <= found.rows <= 512)
                    self.assertLessEqual(max(found.width / found.height, found.height / found.width), 4)
                    for mux in sram_model.MUXES:
                        rows = math.ceil(words / mux)
                        width = kind.strip_width + kind.cell_width * bits * mux
                        height = kind.strip_height + kind.cell_height * rows
                        if 16 <= rows <= 512 and max(width / height, height / width) <= 4:
                            self.assertLessEqual(found.area, width * height + 1e-6)

    def test_a_wide_array_of_few_words_has_rows_that_are_not_used(self) -> None:
        # 232 columns are (29 + 232 x 0.8067) = 216.1 um wide, a quarter of which is 22.5 + 0.3 x 106 um high.
        few, many = macro(Size(1, 100, 232)), macro(Size(1, 106, 232))
        self.assertEqual((few.mux, few.rows, few.columns, few.banks), (1, 106, 232, 1))
        self.assertAlmostEqual(few.area, (29.0 + 0.242 / 0.30 * 232) * (22.5 + 0.30 * 106), places=3)
        self.assertEqual((few.area, few.access_slow, few.read_energy, few.leakage),
                         (many.area, many.access_slow, many.read_energy, many.leakage))
        self.assertEqual(macro(Size(1, 110, 232)).rows, 110)

    def test_access_time_is_anchored_and_grows(self) -> None:
        for ports in KINDS:
            self.assertAlmostEqual(macro(Size(ports, 10240, 10)).access_slow, 2.2)
            self.assertAlmostEqual(macro(Size(ports, 10240, 10)).access_typical, 1.2)
            times = [macro(Size(ports, words, 10)).access_slow for words in (160, 1024, 5120, 10240)]
            self.assertEqual(times, sorted(times))

    def test_figures_by_hand(self) -> None:
        # One port: 7.7239e-4 x 160^0.66146 x (14 + 3.6932) pJ a read, 4.0184e-3 x 160^0.43953 x 14^1.06473 pJ a write and
        # 5.1345e-6 x 160^0.96475 x 14^0.93028 mW of leakage. An access takes (160 / 10240)^0.18204 x (14 / 10)^0.16401 of the anchor's time.
        for ports, slow, read, write, leakage in ((1, 1.09042, 0.392266, 0.621079, 8.00097e-3), (2, 1.11122, 0.573701, 0.675679, 9.29982e-3)):
            found = macro(Size(ports, 160, 14))
            for value, expected in ((found.access_slow, slow), (found.access_typical, slow * 1.2 / 2.2), (found.read_energy, read),
                                    (found.write_energy, write), (found.leakage, leakage)):
                self.assertAlmostEqual(value / expected, 1, delta=1e-5)

    def test_organisations_by_hand(self) -> None:
        # Narrow words: the array is made as square as the strips at its edges, 29 and 22.5 um wide, ask for; at most 512 rows, and at
        # least 16 unless there are fewer words.
        for words, bits, organisation in ((8, 1, (1, 1, 8)), (16, 1, (1, 1, 16)), (31, 1, (1, 2, 16)), (64, 1, (1, 4, 16)), (128, 1, (1, 8, 16)),
                                          (512, 1, (1, 16, 32)), (2048, 1, (1, 32, 64)), (5120, 1, (1, 64, 80)), (8192, 8, (1, 16, 512)),
                                          (40960, 1, (2, 64, 320)), (163840, 100, (64, 8, 487))):
            found = macro(Size(1, words, bits))
            self.assertEqual((found.banks, found.mux, found.rows), organisation, (words, bits))
            self.assertAlmostEqual(found.width, found.banks * (29.0 + 0.242 / 0.30 * bits * found.mux))
            self.assertAlmostEqual(found.height, 22.5 + 0.30 * found.rows)
        self.assertEqual(macro(Size(1, 40960, 1)).organisation(), "2 banks of 320 rows x 64 columns, mux 64")
        self.assertEqual(macro(Size(1, 31, 1)).organisation(), "16 rows x 2 columns, mux 2")

    def test_a_given_multiplexer_is_taken_whatever_the_shape(self) -> None:
        found = macro(Size(1, 100, 232), 2)
        self.assertEqual((found.mux, found.rows, found.columns), (2, 50, 464))
        self.assertGreater(found.width / found.height, 4)

    def test_names_and_sizes(self) -> None:
        self.assertEqual([(size.name, size.address_bits, size.capacity) for size in (Size(1, 160, 14), Size(2, 1, 3), Size(2, 1024, 8), Size(1, 1025, 1))],
                         [("sram_1rw_160x14", 8, 2240), ("sram_1r1w_1x3", 1, 3), ("sram_1r1w_1024x8", 10, 8192), ("sram_1rw_1025x1", 11, 1025)])

    def test_a_name_has_its_size(self) -> None:
        for size in (Size(1, 160, 14), Size(2, 1, 3), Size(1, 100, 232, 8)):
            self.assertEqual(Size.of_name(size.name), size)
        self.assertEqual(Size(1, 100, 232, 8).name, "sram_1rw_100x232_8p")
        with self.assertRaises(FlowError):
            Size.of_name("sram_1rw_160")

    def test_a_write_mask_by_hand(self) -> None:
        # Eight flip-flops with gates of 12 um2. A write of no part costs a read, a write of all parts a write.
        whole, masked = macro(Size(1, 100, 232)), macro(Size(1, 100, 232, 8))
        self.assertAlmostEqual(masked.area, whole.area + 96, places=6)
        self.assertEqual((masked.read_energy, masked.write_energy), (whole.read_energy, whole.write_energy))
        self.assertAlmostEqual(masked.write_energy_of(0), whole.read_energy)
        self.assertAlmostEqual(masked.write_energy_of(8), whole.write_energy)
        self.assertAlmostEqual(masked.write_energy_of(2), 0.75 * whole.read_energy + 0.25 * whole.write_energy)

    def test_large_memories_are_banked(self) -> None:
        found = macro(Size(2, 163840, 10))
        self.assertGreater(found.banks, 1)
        self.assertGreater(found.area, 163840 * 10 * 0.472)

    def test_impossible_size_is_refused(self) -> None:
        for size in (Size(3, 160, 10), Size(1, 0, 10), Size(1, 160, 0)):
            with self.assertRaisesRegex(FlowError, "ports must be 1 or 2"):
                macro(size)
        with self.assertRaisesRegex(FlowError, "sram_1rw_4194304x1: no organisation with 16 to 512 rows .* up to 4 exists, even in 64 banks"):
            macro(Size(1, 4194304, 1))

    @unittest.skipUnless((PDK / "sram_points").is_dir(), "../shared/pdk is not present")
    def test_laws_are_the_fit_of_the_cacti_points(self) -> None:
        for ports, kind in KINDS.items():
            rows = sram_report.cacti_points(PDK, ports)
            self.assertEqual(len(rows), 20)
            for column, law in (("access_ns", kind.access), ("write_pJ", kind.write_energy), ("leak_uW", kind.leakage)):
                again = sram_report.fit_power_law(self.points(rows, column))
                self.assertAlmostEqual(again.scale / law.scale, 1, delta=1e-3, msg=f"{ports} {column}")
                self.assertAlmostEqual(again.words_exponent, law.words_exponent, delta=1e-4)
                self.assertAlmostEqual(again.bits_exponent, law.bits_exponent, delta=1e-4)
            line = sram_report.fit_linear_in_bits(self.points(rows, "read_pJ"))
            self.assertAlmostEqual(line.scale / kind.read_energy.scale, 1, delta=1e-3)
            self.assertAlmostEqual(line.words_exponent, kind.read_energy.words_exponent, delta=1e-4)
            self.assertAlmostEqual(line.offset, kind.read_energy.offset, delta=1e-2)

    @unittest.skipUnless((PDK / "sram_points").is_dir(), "../shared/pdk is not present")
    def test_read_energy_is_within_a_quarter_of_every_cacti_point(self) -> None:
        for ports in KINDS:
            for words, bits, energy in self.points(sram_report.cacti_points(PDK, ports), "read_pJ"):
                self.assertAlmostEqual(macro(Size(ports, words, bits)).read_energy / energy, 1, delta=0.25)

    @unittest.skipUnless((PDK / "sram_points").is_dir(), "../shared/pdk is not present")
    def test_one_port_words_twice_as_wide_as_those_fitted_are_found_within_a_tenth(self) -> None:
        """CACTI's points end at 64 bits, the pool read-outs' words have up to 264: what the law of 32 bits makes of 64."""
        points = self.points(sram_report.cacti_points(PDK, 1), "read_pJ")
        law = sram_report.fit_linear_in_bits([point for point in points if point[1] <= 32])
        wide = [point for point in points if point[1] > 32]
        self.assertTrue(wide)
        for words, bits, energy in wide:
            self.assertAlmostEqual(law(words, bits) / energy, 1, delta=0.1)

    def test_each_further_bit_of_a_wide_word_costs_as_much_as_the_last(self) -> None:
        for ports in KINDS:
            energies = [macro(Size(ports, 200, bits)).read_energy for bits in (112, 176, 240)]
            self.assertAlmostEqual(energies[2] - energies[1], energies[1] - energies[0])
            # A word of double the bits costs no more than two words.
            self.assertLess(energies[2], 2 * macro(Size(ports, 200, 120)).read_energy)

    @staticmethod
    def points(rows: list[dict[str, str]], column: str) -> list[tuple[int, int, float]]:
        return [(int(row["words"]), int(row["bits"]), float(row[column])) for row in rows]


class SizesList(unittest.TestCase):
    def test_round_trip(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "sizes.csv"
            sizes = [Size(1, 160, 6), Size(1, 160, 6, 2), Size(2, 5120, 10)]
            sram_kit.write_sizes(path, sizes)
            self.assertEqual(sram_kit.read_sizes(path), sizes)
            self.assertEqual(path.read_text(encoding="utf-8").splitlines()[0][:24], "# Every SRAM size in use")

    def test_bad_lists_are_refused(self) -> None:
        for text in ("", "ports,words,bits\n1,2,3\n", "ports,words,bits,parts\n1,2\n", "ports,words,bits,parts\n1,x,2,1\n"):
            with self.subTest(text=text), tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "sizes.csv"
                path.write_text(text, encoding="utf-8")
                with self.assertRaises(FlowError):
                    sram_kit.read_sizes(path)


if __name__ == "__main__":
    unittest.main()
