# SPDX-License-Identifier: Apache-2.0
"""The leaderboard: figures worked out by hand, the figures of dtof.frame, and what is refused."""

import contextlib
import csv
import io
import json
import re
import shutil
import tempfile
import unittest
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast
from unittest import mock

import numpy as np

import dtof
from dtof import leaderboard

from programs import ROOT

SMALL = leaderboard.Settings(klux=(5.0,), scenes=("flat",), columns=4, rows=6, frames=2)


class Metres:
    """A look-up table for positions that are distances already."""

    def distance(self, position: Any) -> Any:
        return np.asarray(position)


def entry(title: str, bits: float | None, *distances: float) -> leaderboard.Entry:
    """Results of an entry: the distances in m, over and over."""
    def read_out(photons: Sequence[dtof.Photons]) -> leaderboard.Positions:
        return np.resize(np.array(distances), (photons[-1].rows, photons[-1].columns))

    return leaderboard.Entry(title, "model file", bits, read_out, lambda klux: cast(dtof.LookupTable, Metres()))


def run(*arguments: str) -> tuple[int, str, str]:
    out, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
        code = leaderboard.main(arguments)
    return code, out.getvalue(), errors.getvalue()


class Figures(unittest.TestCase):
    def test_shares_by_hand(self) -> None:
        # The wall is at 1 m. Of three pixels the last entry has one right, one 5 % off and one without a distance.
        entries = [entry("bad", 8, 1.0, 1.05, np.nan), entry("near", 16, 1.029, 0.971), entry("off", 4, 1.05)]
        rows = leaderboard.measure(entries, SMALL)
        self.assertEqual([row.entry.title for row in rows], ["near", "bad", "off"])
        self.assertEqual([round(row.shares["above_3_percent"].value, 6) for row in rows], [0.0, round(2 / 3, 6), 1.0])
        self.assertEqual([round(row.shares["above_10_percent"].value, 6) for row in rows], [0.0, round(1 / 3, 6), 0.0])
        self.assertEqual([row.pixels for row in rows], [2 * 24] * 3)

    def test_the_front_by_hand(self) -> None:
        rows = leaderboard.measure([entry("good", 16, 1.0), entry("small", 4, 1.05, 1.0), entry("beaten", 16, 1.0, 1.0, 1.0, 1.05),
                                    entry("unknown", None, 1.0)], SMALL)
        self.assertEqual({row.entry.title for row in rows if leaderboard.on_the_front(row, rows)}, {"good", "small"})
        self.assertIn("| **good** | model file | 16 | 0.00 |", leaderboard.table(rows))
        self.assertIn("| unknown | model file | - | 0.00 |", leaderboard.table(rows))

    def test_a_readout_has_the_figures_of_dtof_frame(self) -> None:
        settings = leaderboard.Settings(klux=(14.0,), scenes=("room",), columns=34, rows=8, frames=2)
        row, = leaderboard.measure([leaderboard.readout_entry("sifh", settings)], settings)
        shares = []
        for number in range(2):
            sensor = settings.sensor.replace(columns=34, rows=8)
            scene = leaderboard.middle("room", settings, 1 + number)
            table = dtof.LookupTable.flat("sifh", sensor, 14.0, seed=1)
            made = dtof.frame(scene, sensor, "sifh", klux=14.0, seed=1 + number, table={"sifh": table})["sifh"]
            shares.append(made.figures["share_above_3_percent"])
        self.assertAlmostEqual(row.shares["above_3_percent"].value, float(np.mean(shares)), 9)
        self.assertGreater(row.shares["above_3_percent"].value, 0.0)

    def test_a_pixel_without_a_true_distance_is_not_judged(self) -> None:
        settings = leaderboard.Settings(klux=(5.0,), scenes=("sky",), columns=34, rows=40, frames=2)
        row, = leaderboard.measure([entry("two", 1, 2.0)], settings)
        truth = dtof.Scene("sky", dtof.Sensor("thesis")).depth_m[60:100, 83:117]
        known = truth[truth > 0]
        self.assertLess(known.size, truth.size)
        self.assertEqual(row.pixels, 2 * known.size)
        self.assertAlmostEqual(row.shares["above_3_percent"].value, float(np.mean(np.abs(known - 2.0) > 0.06)), 9)
        nothing = dtof.Scene.from_depth(np.zeros((40, 34)))
        with mock.patch.object(leaderboard, "middle", return_value=nothing), self.assertRaisesRegex(ValueError, "no pixel of the scenes sky has a true"):
            leaderboard.measure([entry("two", 1, 2.0)], settings)

    def test_the_middle_is_the_middle(self) -> None:
        whole = dtof.Scene("planes", dtof.Sensor("thesis"), seed=3)
        part = leaderboard.middle("planes", leaderboard.Settings(columns=34, rows=64), 3)
        np.testing.assert_allclose(part.depth_m, whole.depth_m[48:112, 83:117], rtol=1e-6)  # float32 between them

    def test_a_rival_that_needs_frames_has_the_oldest_first(self) -> None:
        settings = leaderboard.Settings(klux=(14.0,), scenes=("room",), columns=34, rows=4, frames=2)
        guided = leaderboard.rival_entry("guided", settings)
        self.assertEqual(guided.frames, 3)
        seen: list[list[int]] = []

        def read_out(photons: Sequence[dtof.Photons]) -> leaderboard.Positions:
            seen.append([len(one.column(0)) for one in photons])
            return np.ones((4, 34))

        leaderboard.measure([leaderboard.Entry("three", "rival", 1, read_out, lambda klux: cast(dtof.LookupTable, Metres()), 3)], settings)
        sensor, scene = settings.sensor.replace(columns=34, rows=4), leaderboard.middle("room", settings, 1)
        self.assertEqual(seen[0], [len(dtof.photons(scene, sensor, 14.0, seed=1, frame=number).column(0)) for number in (2, 1, 0)])


class ModelFiles(unittest.TestCase):
    def file(self, text: str) -> str:
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        (Path(folder) / "mine.py").write_text(text, encoding="utf-8")
        return str(Path(folder) / "mine.py")

    def refused(self, text: str, reason: str) -> None:
        code, out, errors = run(self.file(text), "--beside", "none", "--klux", "2", "--scene", "flat", "--rows", "2")
        self.assertEqual((code, out, errors.count("\n")), (1, "", 1), errors)
        self.assertIn(reason, errors)
        self.assertTrue(errors.startswith("leaderboard: error: "), errors)

    def test_the_example_beside_a_rival(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "new"
            code, said, errors = run(str(ROOT / "examples/leaderboard/peak_and_mean.py"), "--beside", "histogram32,ezpointer", "--bits",
                                     "ezpointer=14", "--klux", "14", "--scene", "room", "--frames", "2", "--rows", "16", "--out", str(out))
            self.assertEqual((code, errors), (0, ""))
            with (out / "leaderboard.csv").open(newline="", encoding="utf-8") as stream:
                rows = {row["readout"]: row for row in csv.DictReader(stream)}
            self.assertEqual((out / "leaderboard.md").read_text(encoding="utf-8"), said)
        mine, ez = rows["peak and mean of 32 bins"], rows["ezPointer"]
        self.assertEqual((mine["kind"], mine["bits_per_pixel"], ez["bits_per_pixel"], mine["pixels"]), ("model file", "320", "14", "1088"))
        self.assertLess(float(mine["above_3_percent"]), 0.2)
        self.assertGreater(float(ez["above_3_percent"]), float(mine["above_3_percent_high"]))

    def test_a_readout_of_the_project_as_a_model_file_has_the_same_figures(self) -> None:
        """The model file's look-up table is fitted in Python, the read-out's by the library."""
        model = self.file("import dtof, numpy\nTITLE = 'copy'\nBITS_PER_PIXEL = None\ndef read_out(photons, sensor):\n"
                          "    made = dtof.read_out(photons, dtof.Readout('sifh', sensor))\n"
                          "    return numpy.where(made.has_distance, made.position, numpy.nan)\n")
        settings = leaderboard.Settings(klux=(14.0,), scenes=("room",), columns=34, rows=32)
        rows = leaderboard.measure([leaderboard.model_entry(Path(model), settings), leaderboard.readout_entry("sifh", settings)], settings)
        copy, original = sorted(rows, key=lambda row: row.entry.kind)
        self.assertEqual((copy.entry.title, original.entry.title), ("copy", "SiFH"))
        for name in leaderboard.LIMITS:
            low, high = original.shares[name].interval
            self.assertTrue(low <= copy.shares[name].value <= high, f"{name}: {copy.shares[name].value} is not within {low} to {high}")

    def test_the_page_has_a_model_that_runs(self) -> None:
        page = (ROOT / "docs/user/leaderboard.md").read_text(encoding="utf-8")
        model, = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
        code, said, errors = run(self.file(model), "--beside", "none", "--klux", "2", "--scene", "room", "--frames", "2", "--rows", "8")
        self.assertEqual((code, errors), (0, ""))
        self.assertIn("| 1 | **median** | model file | 10 |", said)

    def test_json_has_the_rows_of_the_tables(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            arguments = ("--beside", "sifh,histogram32,ezpointer", "--bits", "sifh=24", "--klux", "5", "14", "--scene", "room", "--rows", "4",
                         "--frames", "2", "--out", folder)
            code, out, errors = run(*arguments, "--json")
            self.assertEqual((code, errors), (0, ""))
            said = json.loads(out)
            with (Path(folder) / "leaderboard.csv").open(newline="", encoding="utf-8") as stream:
                lines = list(csv.DictReader(stream))
            page = (Path(folder) / "leaderboard.md").read_text(encoding="utf-8")
        self.assertEqual(said["settings"], {"sensor": "thesis", "acquisitions": dtof.Sensor("thesis").acquisitions, "scenes": ["room"], "columns": 34,
                                            "rows": 4, "frames": 2, "seed": 1})
        self.assertEqual([(row["klux"], row["rank"]) for row in said["rows"]], [(klux, rank) for klux in (5, 14) for rank in (1, 2, 3)])
        for row, line in zip(said["rows"], lines, strict=True):
            self.assertEqual((row["readout"], row["kind"], row["pixels"]), (line["readout"], line["kind"], int(line["pixels"])))
            self.assertEqual("" if row["bits_per_pixel"] is None else f"{row['bits_per_pixel']:g}", line["bits_per_pixel"])
            for name in line.keys() - {"readout", "kind", "bits_per_pixel"}:
                self.assertEqual(f"{row[name]:.6g}", f"{float(line[name]):.6g}", name)
        bold = [row["readout"] for row in said["rows"] if row["on_the_front"]]
        self.assertEqual(bold, re.findall(r"\*\*(.*?)\*\*", page))
        self.assertEqual({row["bits_per_pixel"] for row in said["rows"] if row["readout"] == "ezPointer"}, {None})

    def test_an_interrupt_ends_with_one_line(self) -> None:
        model = self.file("TITLE = 'x'\nBITS_PER_PIXEL = 1\ndef read_out(photons, sensor):\n    raise KeyboardInterrupt\n")
        self.assertEqual(run(model, "--beside", "none", "--klux", "2", "--scene", "flat", "--rows", "2"), (130, "", "leaderboard: interrupted\n"))

    def test_a_folder_that_cannot_be_written(self) -> None:
        model = self.file("import numpy\nTITLE = 'x'\nBITS_PER_PIXEL = 1\ndef read_out(photons, sensor):\n"
                          "    return numpy.full((photons.rows, photons.columns), photons.column(0).timestamp.mean())\n")
        code, _, errors = run(model, "--beside", "none", "--klux", "2", "--scene", "flat", "--rows", "2", "--frames", "2", "--out", f"{model}/out")
        self.assertEqual((code, errors.count("\n")), (4, 1), errors)

    def test_refusals(self) -> None:
        good = "TITLE = 'x'\nBITS_PER_PIXEL = 1\n"
        self.refused("TITLE = 'x'\n", "mine.py: defines no BITS_PER_PIXEL")
        self.refused("import nothing_of_this_name\n", "ModuleNotFoundError")
        self.refused(good + "def read_out(photons, sensor):\n    return [[1.0]]\n", "read_out returns an array (1, 1) for 160 rows of 1 columns")
        self.refused(good + "def read_out(photons, sensor):\n    return photons.rows / 0\n", "read_out: ZeroDivisionError")
        self.refused("import numpy\n" + good + "def read_out(photons, sensor):\n    return numpy.full((photons.rows, photons.columns), 5000.0)\n",
                     "positions outside of 0 to 1024 bins")
        self.refused("TITLE = 'a|b'\nBITS_PER_PIXEL = 1\nread_out = len\n", "TITLE is a text")
        self.refused("TITLE = 'a'\nBITS_PER_PIXEL = 'many'\nread_out = len\n", "BITS_PER_PIXEL is a number of bits or None, not 'many'")
        for arguments, reason in [(("/nowhere/mine.py",), "/nowhere/mine.py: no such file"), (("--beside", "nobody"), "unknown read-out or rival 'nobody'"),
                                  (("--beside", "none"), "nothing to rank"), (("--frames", "1"), "at least 2 frames, not 1"),
                                  (("--seed", "-1"), "--seed: -1 is not within"),
                                  (("--columns", "400"), "400 x 64 pixels do not fit"), (("--scene", "roome"), "roome")]:
            code, out, errors = run(*arguments)
            self.assertEqual((code, out, errors.count("\n")), (1, "", 1), errors)
            self.assertIn(reason, errors)


if __name__ == "__main__":
    unittest.main()
