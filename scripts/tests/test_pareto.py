# SPDX-License-Identifier: Apache-2.0
"""Every configuration has a name under which the scenes' accuracy is looked up. The page has the sentences and verdicts of tables that
were made by hand."""

import csv
import tempfile
import unittest
from collections.abc import Sequence
from pathlib import Path
from unittest import mock

import pareto
from dtof_synth.goals import ARRAY_MM2


class EstimatorTitle(unittest.TestCase):
    def test_of_every_configuration(self):
        configurations = pareto.load(pareto.ROOT / "configurations.toml")
        titles = {name: pareto.estimator_title(configuration, configurations[configuration.variant_of or name])
                  for name, configuration in configurations.items()}
        self.assertEqual(titles["hispointer"], "hisPointer")
        self.assertEqual(titles["hispointer_gate"], "hisPointer")  # a parameter that changes no result
        self.assertEqual(titles["hispointer_count8"], "hisPointer COUNT_WIDTH=8")
        self.assertEqual(titles["poolpointer"], "poolPointer")


SCENES = ("sensor", "klux", "scene", "estimator", "pixels", "above_3_percent", "above_10_percent", "relative_rmse", "relative_bound",
          "single_above_10_percent")
POOL, SINGLE = "poolPointer", "hisPointer"
ROWS = [
    ("thesis", "14", "room", SINGLE, "300", "0.10", "0.02", "0.20", "", ""),
    ("thesis", "14", "planes", SINGLE, "100", "0.02", "0.01", "0.04", "", ""),
    ("thesis", "14", "isolated", SINGLE, "0", "0", "0", "0", "", "0.04"),
    ("thesis", "50", "room", SINGLE, "300", "0.40", "0.20", "0.50", "", ""),
    ("thesis", "50", "planes", SINGLE, "100", "0.20", "0.10", "0.10", "", ""),
    ("thesis", "50", "isolated", SINGLE, "0", "0", "0", "0", "", ""),
    ("thesis", "14", "room", POOL, "300", "0.01", "0.00", "0.02", "", ""),
    ("thesis", "14", "planes", POOL, "100", "0.01", "0.00", "0.02", "", ""),
    ("thesis", "14", "isolated", POOL, "0", "0", "0", "0", "", "0.05"),
    ("thesis", "50", "room", POOL, "300", "0.10", "0.02", "0.10", "", ""),
    ("thesis", "50", "planes", POOL, "100", "0.10", "0.01", "0.10", "", ""),
    ("thesis", "50", "isolated", POOL, "0", "0", "0", "0", "", ""),
    ("thesis", "14", "flat 0.2 m", POOL, "10", "0", "0", "0.019", "0.01", ""),
    *(("thesis", "14", f"flat {metres} m", POOL, "10", "0", "0", rmse, "0.01", "")
      for metres, rmse in (("1", "0.012"), ("2", "0.015"), ("3", "0.016"), ("4", "0.010"))),
]
AREA = [("hispointer", "200", "9.839", "11.48", "339"), ("poolpointer", "200", "1.30", "", "40")]
PAGE = """# Area against accuracy

Written by `make pareto`. Areas: 200 columns of 160 pixels, from [area.csv](area.csv) (`make synth`). Accuracies: from \
[scenes.csv](scenes.csv) and [scenes_variants.csv](scenes_variants.csv) (`make scenes`), preset `thesis`, over all scenes except flat \
targets: room, planes, isolated. For variants that change results, fewer columns of each scene were read.

![Pixels off by more than 3 %](pareto.svg)

![Relative rmse](pareto_rmse.svg)

Large marks: read-outs. Small marks: their variants. Crosses: the area that the thesis states (Table 5), at the accuracy measured here. \
A row is on the front if no other row has a smaller area and fewer pixels above 3 %.

**Missing** (no area or no accuracy yet): poolpointer_lean, ezpointer.

| read-out | mm2 | thesis mm2 | bits a pixel | indoor: above 3 %, % | rmse, % | front | outdoor: above 3 %, % | rmse, % | front |
|---|---:|---:|---:|---:|---:|:---:|---:|---:|:---:|
| poolPointer | 1.30 |  | 40 | 1.00 | 2.00 | x | 10.00 | 10.00 | x |
| hisPointer | 9.84 | 11.48 | 339 | 8.00 | 17.44 |  | 35.00 | 43.59 |  |
| matched filter (single pixel) |  |  |  | 3.00 | 4.00 |  | 20.00 | 30.00 |  |

## Goals
"""


class Page(unittest.TestCase):
    """Two scenes of 300 and 100 pixels, some flat targets, two arrays."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        patch = mock.patch.object(pareto, "REPORTS", self.folder)
        patch.start()
        self.addCleanup(patch.stop)
        self.write("scenes.csv", SCENES, ROWS)
        self.write("scenes_variants.csv", SCENES, [])
        self.write("area.csv", ("configuration", "columns", "total_mm2", "thesis_mm2", "bits_per_pixel"), AREA)
        self.write("timing.csv", ("configuration", "corner", "fmax_mhz"),
                   [("poolpointer", "typical", "500"), ("poolpointer", "slow", "329.6")])

    def write(self, name: str, header: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> None:
        with (self.folder / name).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([header, *rows])

    def goals(self) -> dict[str, tuple[str, str]]:
        return {goal: (measured, met) for goal, measured, met in pareto.goals(pareto.Scenes())}

    def test_sentences_and_table(self) -> None:
        scenes = pareto.Scenes()
        points, missing = pareto.collect(scenes)
        self.assertEqual(missing[:2], ["poolpointer_lean", "ezpointer"])
        references = {"matched filter (single pixel)": {"indoor": (0.03, 0.04), "outdoor": (0.2, 0.3)}}
        page = pareto.report(points, missing[:2], scenes, references)
        self.assertEqual(page.split("## Goals\n")[0] + "## Goals\n", PAGE.replace("\\\n", ""))
        self.assertEqual(page.split("## Goals\n")[1].splitlines()[:3], ["", "| goal | measured | met |", "|---|---|:---:|"])

    def test_without_missing_figures_the_page_says_nothing_of_them(self) -> None:
        points, _ = pareto.collect(pareto.Scenes())
        self.assertNotIn("Missing", pareto.report(points, [], pareto.Scenes(), {}))

    def test_verdicts(self) -> None:
        goals = self.goals()
        self.assertEqual(goals["50 klux, boxes, planes, depth maps: pixels above 3 %, at most 1/3 of hisPointer's"],
                         ("room 0.25 (10.00 / 40.00 %); planes 0.50 (10.00 / 20.00 %); disparity map not measured", "**no**"))
        self.assertEqual(goals["50 klux, the same: outliers above 10 %, at most 1/5"],
                         ("room 0.10 (2.00 / 20.00 %); planes 0.10 (1.00 / 10.00 %); disparity map not measured", "**no**"))
        self.assertEqual(goals["14 klux, flat at 0.2 m: within 2 % (rmse)"], ("0.2 m 1.90 %", "yes"))
        self.assertEqual(goals["14 klux, flats from 1 to 4 m: rmse at most 1.5 times the single pixel's bound"],
                         ("1 m 1.20; 2 m 1.50; 3 m 1.60; 4 m 1.00", "**no**"))
        self.assertEqual(goals["14 klux, isolated pixels at 3 m: kept as often as by hisPointer"], ("lost: 5.00 % (hisPointer 4.00 %)", "**no**"))
        self.assertEqual(goals["poolPointer: at most 40 bits a pixel"], ("40", "yes"))
        self.assertEqual(goals[f"poolPointer: at most {ARRAY_MM2['poolpointer']:g} mm2 (aim 1.15)"], ("1.300 mm2", "**no**"))
        self.assertEqual(goals["poolPointer: 330 MHz in the slow corner"], ("330 MHz", "**no**"))
        self.assertEqual(goals["poolPointer lean: memory, area, clock"], ("not in reports/area.csv", "-"))

    def test_a_goal_is_met_only_with_every_scene(self) -> None:
        whole = [row for light in ("14", "50") for row in (("thesis", light, "disparity map", SINGLE, "10", "0.9", "0.6", "1", "", ""),
                                                           ("thesis", light, "disparity map", POOL, "10", "0.3", "0.1", "1", "", ""))]
        fewer = [row if row[1:4] != ("50", "planes", POOL) else (*row[:5], "0.06", *row[6:]) for row in ROWS]
        self.write("scenes.csv", SCENES, [*fewer, *whole])
        goals = self.goals()
        self.assertEqual(goals["50 klux, boxes, planes, depth maps: pixels above 3 %, at most 1/3 of hisPointer's"][1], "yes")
        self.assertEqual(goals["50 klux, the same: outliers above 10 %, at most 1/5"][1], "yes")


if __name__ == "__main__":
    unittest.main()
