# SPDX-License-Identifier: Apache-2.0
"""The picture of read-outs and rivals shows what the table says."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import rivals
from dtof_synth import rival_area

HEADER = "klux,scene,estimator,kind,bits_per_pixel,pixels,above_3_percent,above_3_percent_low,above_3_percent_high"
ROWS = ("50,all,hisPointer,read-out,339,100,0.2,0.1,0.3", "50,all,32-bin histogram,rival,256,100,0.1,0.05,0.2",
        "50,all,matched filter (single pixel),reference,,100,0.0,0.0,0.01", "50,room,hisPointer,read-out,339,100,0.9,0.9,0.9",
        "14,all,hisPointer,read-out,339,100,0.01,0,0.02")


class Picture(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name) / "rivals.csv"
        self.path.write_text("\n".join((HEADER, *ROWS)) + "\n", encoding="utf-8")

    def tearDown(self) -> None:
        self.folder.cleanup()

    def test_points_are_of_all_scenes_together(self) -> None:
        lights = rivals.points_of(self.path)
        self.assertEqual(list(lights), ["50", "14"])
        self.assertEqual([(p.title, p.bits, p.percent) for p in lights["50"]],
                         [("hisPointer", 339, 20), ("32-bin histogram", 256, 10), ("matched filter (single pixel)", None, 0)])

    def test_front_has_what_nothing_smaller_beats(self) -> None:
        point = lambda title, bits, percent: rivals.Point(title, "rival", bits, percent, percent, percent)  # noqa: E731
        points = [point("d", None, 0.1), point("c", 300, 2), point("b", 200, 1), point("a", 100, 3), point("a2", 100, 4)]
        self.assertEqual([p.title for p in rivals.front(points)], ["a", "b"])

    def test_every_point_is_numbered_and_named(self) -> None:
        text = rivals.script("50", rivals.points_of(self.path)["50"], rivals.AXES[0], Path("out.svg"))
        self.assertIn("set label '{/:Bold 1}  32-bin histogram, 256'", text)
        self.assertIn("set label '2  hisPointer, 339'", text)
        self.assertIn("'matched filter (single pixel)' at graph", text)
        self.assertIn(f"first {rivals.LEAST_PERCENT} to graph 1", text)

    def test_bits_are_those_of_the_readouts_own_configurations(self) -> None:
        area = Path(self.folder.name) / "area.csv"
        area.write_text("configuration,readout,bits_per_pixel\nhispointer,hispointer,339\nhispointer_wide,hispointer,400\n"
                        "poolpointer_lean,poolpointer-lean,19\n", encoding="utf-8")
        self.assertEqual(rivals.known_bits(area), {"hispointer": "339", "poolpointer-lean": "19"})
        self.assertEqual(rivals.known_bits(area.with_name("none.csv")), {})

    def with_hardware(self) -> list[rivals.Point]:
        (self.path.parent / "rival_hardware.csv").write_text(
            "rival,option,bits_per_pixel,words,word_bits,adder_bits,table_bits,host_operations,pooling_operations\n"
            "32-bin histogram,histogram32,256,32,8,0,0,10000,200\n", encoding="utf-8")
        return rivals.points_of(self.path)["50"]

    def test_areas_are_synthesised_or_estimated(self) -> None:
        readout, rival, reference = self.with_hardware()
        self.assertEqual(readout.mm2, rivals.known_areas(rivals.AREA)["hisPointer"])
        self.assertEqual((readout.operations, rival.operations), (rivals.READOUT_OPERATIONS, 10000))
        base = rival_area.Base.read(rivals.AREA)
        self.assertEqual(rival.mm2, rival_area.array_mm2(base, rival_area.Hardware(32, 8), 200, 160))
        self.assertIsNone(reference.mm2)
        self.assertNotIn("histogram", rivals.known_areas(rivals.AREA))  # synthesised for fewer pixels

    def test_the_best_within_an_area(self) -> None:
        points = self.with_hardware()
        self.assertIsNone(rivals.best_within(points, 1.0))
        best = rivals.best_within(points, 100.0)
        assert best is not None
        self.assertEqual(best.title, "32-bin histogram")
        section = rivals.sensor_section({"mine": {"50": points}})
        area = f"{points[1].mm2:.2f} mm2"
        self.assertIn(f"| mine | in the sun, 50 klux | - | - | - | 32-bin histogram: 10.00 +-7.50 ({area}) |", section)
        self.assertIn("Number of cells in which a read-out is the best one, of 1 in all: 32-bin histogram 1.", section)

    def test_sensors_are_files_or_presets(self) -> None:
        presets = {path.stem for path in (rivals.ROOT / "models/dtof/sensor/presets").glob("*.toml")}
        for sensor in rivals.SENSORS:
            argument = rivals.argument_of(sensor)
            self.assertTrue(argument in presets or Path(argument).is_file(), argument)

    def test_a_run_that_ended_is_not_made_again_unless_something_changes(self) -> None:
        folder = Path(self.folder.name)
        study, made = folder / "study", folder / "made"
        scene, out = folder / "map.png", folder / "out"
        scene.write_text("1", encoding="utf-8")

        def runs(text: str, *options: str) -> int:
            study.write_text(f"#!/bin/sh\n{text}\nmkdir -p {out}\ntouch {out}/rivals.csv\necho x >> {made}\n", encoding="utf-8")
            study.chmod(0o755)
            before = made.read_text().count("x") if made.is_file() else 0
            rivals.run(str(study), out, ["--photographed", f"Art={scene}", *options])
            return made.read_text().count("x") - before

        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual([runs("true"), runs("true")], [1, 0])
            self.assertEqual([runs("true", "--seeds", "2"), runs(": other", "--seeds", "2")], [1, 1])
            scene.write_text("2", encoding="utf-8")
            self.assertEqual(runs(": other", "--seeds", "2"), 1)
            with self.assertRaises(SystemExit):
                runs("exit 3")
            self.assertEqual([runs("true"), runs("true")], [1, 0])
            (out / "rivals.csv").unlink()
            self.assertEqual([runs("true"), runs("true")], [1, 0])

    def test_the_report_has_the_sections_before_the_lights(self) -> None:
        folder = self.path.parent
        self.with_hardware()
        (folder / "rivals.md").write_text("# Rivals\n\n## Beside each other\n\n* a\n\n## 14 klux\n\ntable\n", encoding="utf-8")
        rivals.report(folder)
        text = (folder / "report.md").read_text(encoding="utf-8")
        order = [text.index(part) for part in ("## Beside each other", "## Which read-out", "## Area and host work", "\n## 14 klux")]
        self.assertEqual(order, sorted(order))
        self.assertTrue((folder / "rivals_mm2_50klux.svg").is_file())
        self.assertIn("**32-bin histogram**", text)


if __name__ == "__main__":
    unittest.main()
