# SPDX-License-Identifier: Apache-2.0
"""The table of poolPointer's parts: shares weighted by pixels, parts that nobody describes, and every named number legal."""

import tempfile
import unittest
from pathlib import Path

import pool_parts

ROOT = Path(__file__).resolve().parents[2]


class PoolParts(unittest.TestCase):
    def test_shares_are_weighted_by_pixels(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "pool.csv"
            path.write_text("klux,scene,estimator,pixels,above_3_percent,above_10_percent\n"
                            "14,room,a,100,0.5,0.1\n14,poles,a,300,0.1,0.1\n50,room,a,10,1,0\n", encoding="utf-8")
            found = pool_parts.errors(path)
        self.assertAlmostEqual(found["a", "14"][0], 0.2)
        self.assertAlmostEqual(found["a", "14"][1], 0.1)
        self.assertEqual(found["a", "50"], (1.0, 0.0))

    def test_a_part_with_cells_needs_a_row(self):
        self.assertEqual(pool_parts.unknown_parts({("quad", "u_new"): {"area_um2": 2.0}, ("quad", "u_timestamp_input"): {"area_um2": 0.0},
                                                   ("engine", "SRAM"): {"area_um2": 5.0}}), ["quad/u_new"])

    def test_the_report_has_every_part_and_every_estimator(self):
        figures = {(part.block, part.instance): {"area_um2": 10.0 * (number + 1), "day_mw": 1.0, "dusk_mw": 0.5}
                   for number, part in enumerate(pool_parts.PARTS)}
        shares = {(estimator, klux): (0.02, 0.01) for _, _, estimator in pool_parts.accuracy_rows() for klux in pool_parts.LIGHTS}
        text = pool_parts.report(figures, shares, 7)
        self.assertIn("| quad: label_match | track: finds the candidates near a timestamp | 20 |", text)
        self.assertIn(f"| sum | | {10 * sum(range(1, len(pool_parts.PARTS) + 1))} | | {len(pool_parts.PARTS):.1f} |", text)
        self.assertIn("| beside_evidence | the left column | 2.00 / 1.00 | 2.00 / 1.00 |", text)
        table = pool_parts.table_csv(figures, shares).splitlines()
        self.assertEqual({line.count(",") for line in table}, {9})

    def test_parts_are_instances_of_the_rtl(self):
        hdl = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "hdl").glob("*/*.sv"))
        for part in pool_parts.PARTS:
            if part.instance.startswith("u_"):
                self.assertIn(f"{part.instance} (", hdl)


if __name__ == "__main__":
    unittest.main()
