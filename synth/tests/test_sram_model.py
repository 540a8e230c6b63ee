# SPDX-License-Identifier: Apache-2.0
"""The SRAM model against its stated rule, the public points and the list of sizes."""

import math
import tempfile
import unittest
from pathlib import Path

from dtof_synth import sram_kit, sram_model, sram_report
from dtof_synth.errors import FlowError
from dtof_synth.sram_model import KINDS, PowerLaw, Size, macro

PDK = Path(__file__).resolve().parents[3] / "shared" / "pdk"


def fit(points: list[tuple[int, int, float]]) -> PowerLaw:
    """Least squares of log(value) = a + b log(words) + c log(bits), by the normal equations."""
    rows = [(1.0, math.log(words), math.log(bits)) for words, bits, _ in points]
    logs = [math.log(value) for _, _, value in points]
    matrix = [[sum(row[i] * row[j] for row in rows) for j in range(3)]
              + [sum(row[i] * value for row, value in zip(rows, logs))] for i in range(3)]
    for i in range(3):
        for k in range(3):
            if k != i:
                factor = matrix[k][i] / matrix[i][i]
                matrix[k] = [x - factor * y for x, y in zip(matrix[k], matrix[i])]
    a, b, c = (matrix[i][3] / matrix[i][i] for i in range(3))
    return PowerLaw(math.exp(a), b, c)


class SramModel(unittest.TestCase):
    def test_area_by_hand(self):
        # 160 x 10, two ports: mux 2 gives 80 rows and 20 columns.
        found = macro(Size(2, 160, 10))
        self.assertEqual((found.mux, found.rows, found.columns, found.banks), (2, 80, 20, 1))
        self.assertAlmostEqual(found.area, (55.6 + 0.472 / 0.356 * 20) * (35.7 + 0.356 * 80), places=3)

    def test_the_chosen_mux_is_legal_and_none_is_smaller(self):
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

    def test_access_time_is_anchored_and_grows(self):
        for ports in KINDS:
            self.assertAlmostEqual(macro(Size(ports, 10240, 10)).access_slow, 2.2)
            self.assertAlmostEqual(macro(Size(ports, 10240, 10)).access_typical, 1.2)
            times = [macro(Size(ports, words, 10)).access_slow for words in (160, 1024, 5120, 10240)]
            self.assertEqual(times, sorted(times))

    def test_large_memories_are_banked(self):
        found = macro(Size(2, 163840, 10))
        self.assertGreater(found.banks, 1)
        self.assertGreater(found.area, 163840 * 10 * 0.472)

    def test_impossible_size_is_refused(self):
        with self.assertRaisesRegex(FlowError, "ports must be 1 or 2"):
            macro(Size(3, 160, 10))

    @unittest.skipUnless((PDK / "sram_points").is_dir(), "../shared/pdk is not present")
    def test_power_laws_are_the_fit_of_the_cacti_points(self):
        for ports, kind in KINDS.items():
            points = sram_report.cacti_points(PDK, ports)
            self.assertEqual(len(points), 20)
            for column, law in (("access_ns", kind.access), ("read_pJ", kind.read_energy),
                                ("write_pJ", kind.write_energy), ("leak_uW", kind.leakage)):
                again = fit([(int(p["words"]), int(p["bits"]), float(p[column])) for p in points])
                self.assertAlmostEqual(again.scale / law.scale, 1, delta=1e-3, msg=f"{ports} {column}")
                self.assertAlmostEqual(again.words_exponent, law.words_exponent, delta=1e-4)
                self.assertAlmostEqual(again.bits_exponent, law.bits_exponent, delta=1e-4)


class SizesList(unittest.TestCase):
    def test_round_trip(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "sizes.csv"
            sizes = [Size(1, 160, 6), Size(2, 5120, 10)]
            sram_kit.write_sizes(path, sizes)
            self.assertEqual(sram_kit.read_sizes(path), sizes)

    def test_bad_lists_are_refused(self):
        for text in ("", "words,bits\n1,2\n", "ports,words,bits\n1,2\n", "ports,words,bits\n1,x,2\n"):
            with self.subTest(text=text), tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "sizes.csv"
                path.write_text(text, encoding="utf-8")
                with self.assertRaises(FlowError):
                    sram_kit.read_sizes(path)


if __name__ == "__main__":
    unittest.main()
