#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The page of `make playground` in headless Chromium beside `dtof frame` and `dtof replay`: every code and figure equal.

The commands compared with are those that the page shows. Screenshots are left in build/playground/test/.
"""

import base64
import csv
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest
from pathlib import Path

import numpy

from tests.browser import Browser, missing

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "build" / "playground" / "index.html"
SCREENSHOTS = ROOT / "build" / "playground" / "test"
SHARED = ROOT / os.environ.get("SHARED_DATA", "../shared/data")
SECONDS = 300  # for a frame: the machine may be busy

Pixel = tuple[int, ...]


class Frame:
    """Results of a run by read-out: code, fraction and confidence of each pixel, and figures."""

    def __init__(self) -> None:
        self.pixels: dict[str, list[Pixel]] = {}
        self.figures: dict[str, list[str]] = {}

    def differences(self, other: "Frame") -> list[str]:
        if self.pixels.keys() != other.pixels.keys():
            return [f"read-outs {sorted(self.pixels)} and {sorted(other.pixels)}"]
        found = []
        for name, pixels in self.pixels.items():
            others = other.pixels[name]
            if len(pixels) != len(others):
                found.append(f"{name}: {len(pixels)} and {len(others)} pixels")
                continue
            wrong = [i for i, (one, two) in enumerate(zip(pixels, others)) if one != two]
            if wrong:
                i = wrong[0]
                found.append(f"{name}: {len(wrong)} of {len(pixels)} pixels differ, the first is {i}: {pixels[i]} "
                             f"and {others[i]}")
            if self.figures[name] != other.figures[name]:
                found.append(f"{name}: figures {self.figures[name]} and {other.figures[name]}")
        return found


def native(command: str, **changes: str) -> Frame:
    """Runs the command that the page shows, with some of its options changed."""
    words = shlex.split(command.replace("\\\n", " "))
    for option, value in changes.items():
        words[words.index(f"--{option}") + 1] = value
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([*words, "--out", folder], cwd=ROOT, check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        frame = Frame()
        with open(Path(folder) / "summary.csv", newline="", encoding="utf-8") as file:
            summary = list(csv.reader(file))[1:]
        listed = subprocess.run([words[0], "list"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        for row in summary:
            name = next(path.stem for path in Path(folder).glob("*.csv")
                        if path.stem.replace("-", "") == title_name(row[0]) and path.stem in listed)
            with open(Path(folder) / f"{name}.csv", newline="", encoding="utf-8") as file:
                frame.pixels[name] = [tuple(map(int, line[2:])) for line in list(csv.reader(file))[1:]]
            frame.figures[name] = row[1:7]
    return frame


def replayed(command: str, recording: Path) -> Frame:
    """Runs the command that the page shows on a recording; it has no figures."""
    words = shlex.split(command.replace("\\\n", " "))
    words[2] = str(recording)
    frame = Frame()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([*words, "--out", folder], cwd=ROOT, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for path in Path(folder).glob("*.csv"):
            if path.stem in ("summary", "measurements"):  # of a recording with true distances
                continue
            with open(path, newline="", encoding="utf-8") as file:
                frame.pixels[path.stem] = [tuple(map(int, line[2:])) for line in list(csv.reader(file))[1:]]
    frame.figures = {name: [] for name in frame.pixels}
    return frame


def title_name(title: str) -> str:
    """hisPointer v1 -> hispointer1"""
    return title.lower().replace(" v", "").replace(" ", "")


@unittest.skipIf(missing(), missing() or "")
class Playground(unittest.TestCase):
    browser: Browser

    @classmethod
    def setUpClass(cls) -> None:
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def setUp(self) -> None:
        self.browser.complaints.clear()
        self.browser.requests.clear()
        self.browser.window(1400, 1000)

    def tearDown(self) -> None:
        self.assertEqual(self.browser.complaints, [])
        self.assertEqual([url for url in self.browser.requests if not url.startswith(("file:", "blob:", "data:"))], [])

    def wait(self) -> str:
        """Waits for the end of the run; returns the page's state."""
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            state = self.browser.evaluate("document.body.dataset.state ?? 'running'")
            if state != "running":
                return str(state)
            time.sleep(0.2)
        self.fail(f"no result in {SECONDS} s: {self.status()}")

    def status(self) -> str:
        return str(self.browser.evaluate("document.getElementById('status').textContent"))

    def set(self, settings: dict[str, object], readouts: list[str] | None = None) -> None:
        """Fills in the form as a user does, and submits it."""
        for name, value in settings.items():
            self.browser.evaluate(f"form.elements.{name}.value = '{value}';"
                                  f"form.elements.{name}.dispatchEvent(new Event('input', {{bubbles: true}}))")
        if readouts is not None:
            self.browser.evaluate("form.querySelectorAll('[name=readout]').forEach("
                                  f"box => {{ box.checked = {readouts}.includes(box.value); }})")
        self.browser.evaluate("form.requestSubmit()")

    def shown(self) -> Frame:
        """The frame on the page, with the figures of the table."""
        frame = Frame()
        results = self.browser.evaluate("frames.map(f => [f.readout, [...f.results], f.figures])")
        for name, values, figures in results:
            frame.pixels[name] = list(zip(values[0::4], values[1::4], values[2::4]))
            frame.figures[name] = figures
        cells = self.browser.evaluate(
            "[...document.querySelectorAll('#table tbody tr')].map(r => [...r.cells].map(c => c.textContent))")
        self.assertEqual(len(cells), len(results))
        for row, (name, _, (rmse, bias, _, above_3, above_10, _)) in zip(cells, results):
            self.assertEqual(title_name(row[0]), name.replace("-", ""))
            self.assertEqual(row[1:5], [above_3, above_10, f"{rmse} mm", f"{bias} mm"])
        return frame

    def command(self) -> str:
        return str(self.browser.evaluate("document.getElementById('command').textContent"))

    def assert_equal_to_native(self) -> None:
        self.assertEqual(self.wait(), "done", self.status())
        self.assertEqual(self.shown().differences(native(self.command())), [])

    def test_the_first_frame_and_another_seed(self) -> None:
        self.browser.open(PAGE)
        self.assert_equal_to_native()
        self.browser.screenshot(SCREENSHOTS / "wide.png")
        shown = self.shown()
        self.assertEqual(list(shown.pixels), list(tomllib.loads((ROOT / "readouts.toml").read_text(encoding="utf-8"))["readout"]))
        self.assertTrue(all(len(pixels) == 32000 for pixels in shown.pixels.values()))
        # The comparison sees another seed in every read-out.
        others = shown.differences(native(self.command(), seed="2"))
        for name in shown.pixels:
            self.assertTrue(any(line.startswith(f"{name}: ") and "pixels differ" in line for line in others), name)

    def test_other_settings(self) -> None:
        self.browser.open(PAGE)
        self.wait()
        few = ["hispointer", "threesteps", "poolpointer-lean"]
        # So near and bright that photons are drawn one after the other; an array with fewer rows than the pools'.
        self.set({"scene": "staircase", "near": 0.1, "far": 6.5, "steps": 5, "klux": 120, "reflectivity": 2,
                  "acquisitions": 800, "size": "50 40", "seed": 9007199254740991}, few)
        self.assert_equal_to_native()
        self.assertEqual(sorted(self.shown().pixels), sorted(few))
        self.set({"sensor": "phone", "scene": "poles", "klux": 40, "seed": 12, "size": "100 80"}, ["poolpointer", "pifh"])
        self.assert_equal_to_native()
        self.assertIn("--reflectivity 0.5 --acquisitions 3333", self.command())

    def test_own_files(self) -> None:
        """A sensor file and a depth map that are dropped on the page."""
        self.browser.open(PAGE)
        self.wait()
        with tempfile.TemporaryDirectory() as folder:
            sensor, depth = Path(folder) / "mine.toml", Path(folder) / "map.npy"
            sensor.write_text((ROOT / "models/dtof/sensor/presets/phone.toml").read_text(encoding="utf-8"), encoding="utf-8")
            metres = numpy.random.default_rng(1).uniform(1, 3, (20, 30)).astype(numpy.float32)
            metres[2, 3] = 0
            numpy.save(depth, metres)
            self.set({"seed": 3}, ["ezpointer", "sifh", "poolpointer"])
            for file in (sensor, depth):
                self.assertEqual(self.wait(), "done", self.status())
                self.browser.evaluate("form.size.selectedIndex = 2")
                self.drop(file)
            self.assertEqual(self.wait(), "done", self.status())
            self.assertIn("--depth map.npy --sensor mine.toml", self.command())
            self.assertEqual(self.shown().differences(native(self.command(), sensor=str(sensor), depth=str(depth))), [])

    def drop(self, file: Path) -> None:
        content = base64.b64encode(file.read_bytes()).decode()
        self.browser.evaluate(
            f"document.body.dataset.state = 'running'; (data => {{ data.items.add(new File([Uint8Array.from(atob('{content}'),"
            f" letter => letter.charCodeAt(0))], '{file.name}')); document.body.dispatchEvent(new DragEvent('drop', "
            "{dataTransfer: data, bubbles: true, cancelable: true})); })(new DataTransfer())")

    def replay(self) -> Frame:
        """The frame of a recording on the page."""
        self.assertEqual(self.wait(), "done", self.status())
        frame = Frame()
        for name, values in self.browser.evaluate("frames.map(f => [f.readout, [...f.results]])"):
            frame.pixels[name] = list(zip(values[0::4], values[1::4], values[2::4]))
            frame.figures[name] = []
        return frame

    def test_a_recording(self) -> None:
        """A TDC stream and histograms that are dropped on the page; the pixel's states end with its result."""
        self.browser.open(PAGE)
        self.wait()
        with tempfile.TemporaryDirectory() as folder:
            stream, cube = Path(folder) / "mine.csv", Path(folder) / "cube.npy"
            subprocess.run(["build/cpp/bin/dtof", "frame", "--scene", "plane", "--array-columns", "12", "--array-rows", "8", "--acquisitions", "600",
                            "--readout", "ezpointer", "--record", str(stream), "--out", folder + "/frame"], cwd=ROOT, check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            numpy.save(cube, numpy.random.default_rng(1).poisson(3, (6, 5, 64)).astype(numpy.uint16))
            self.drop(stream)
            shown = self.replay()
            self.assertEqual(len(shown.pixels), len(tomllib.loads((ROOT / "readouts.toml").read_text(encoding="utf-8"))["readout"]))
            self.assertEqual(shown.differences(replayed(self.command(), stream)), [])
            for width, height in ((1400, 1000), (390, 800)):
                self.browser.window(width, height)
                self.trace("poolpointer", 4, 3)
                self.browser.screenshot(SCREENSHOTS / f"recording_{width}.png", whole=False)
                self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
            for name in ("ezpointer", "poolpointer", "sifh"):
                code = shown.pixels[name][3 * 12 + 4][0]
                self.assertEqual(int(self.trace(name, 4, 3)), code, name)
            # The comparison sees that one pixel's detections are later.
            lines = stream.read_text(encoding="utf-8").splitlines()
            later = [",".join([*line.split(",")[:3], "1000"]) if line.split(",")[1:3] == ["4", "3"] else line for line in lines]
            stream.write_text("\n".join(later) + "\n", encoding="utf-8")
            self.assertNotEqual(shown.differences(replayed(self.command(), stream)), [])
            self.browser.evaluate("form['bin-width'].value = '600'")
            self.drop(cube)
            self.assertEqual(self.replay().differences(replayed(self.command(), cube)), [])
            stream.write_text("acquisition,column,row,timestamp\n0,0,0,1024\n", encoding="utf-8")
            self.drop(stream)
            self.assertEqual((self.wait(), self.status()), ("failed", "mine.csv:2: timestamp 1024 is outside 0..1023 (NP = 10)"))

    @unittest.skipUnless(SHARED.is_dir(), f"{SHARED} is absent")
    def test_recordings_of_other_sensors(self) -> None:
        """Logs, time tags and photon times as their makers publish them; the page's own unpacking of gzip and MATLAB files."""
        self.browser.open(PAGE)
        self.wait()
        self.set({"seed": 3}, ["ezpointer", "hispointer", "poolpointer"])
        self.assertEqual(self.wait(), "done", self.status())
        for source, photons, pixels in (("ams_tmf8829_log.json.gz", "", 26 * 16), ("sifferman_tmf8820_distance_data.json", "300", 159 * 9),
                                        ("shin2016_two_layer_photon_times.mat", "", 10000), ("picoquant/v20.ht3", "", 4)):
            with self.subTest(source=source):
                self.browser.evaluate(f"form.photons.value = '{photons}'")
                self.drop(SHARED / source)
                shown = self.replay()
                self.assertEqual([len(results) for results in shown.pixels.values()], 3 * [pixels])
                self.assertEqual(shown.differences(replayed(self.command(), SHARED / source)), [])
                self.browser.screenshot(SCREENSHOTS / f"{Path(source).name.split('.')[0]}.png", whole=False)
        for source, photons, sentence in (("sifferman_tmf8820_distance_data.json", "", "photons are more than the 67108864 that a page draws: give the photons per pixel"),
                                          ("picoquant/v30_t2.ptu.gz", "", "the file is of mode T2 and has no syncs: no time of a photon has a begin")):
            self.browser.evaluate(f"form.photons.value = '{photons}'")
            self.drop(SHARED / source)
            self.assertEqual(self.wait(), "failed")
            self.assertIn(sentence, self.status())

    def test_a_faulty_map_or_sensor_has_the_sentence_of_the_command(self) -> None:
        self.browser.open(PAGE)
        self.wait()
        self.set({"size": "50 40"}, ["ezpointer"])
        with tempfile.TemporaryDirectory() as folder:
            maps = {"nan.npy": numpy.nan, "dark.npy": 0, "far.npy": 20}
            for name, metres in maps.items():
                numpy.save(Path(folder) / name, numpy.full((20, 30), metres, numpy.float32))
            sensors = {"empty.toml": "", "typing.toml": "[array]\ncolums = 3\n", "many.toml": "[array]\ncolumns = 1000000\n",
                       "nan.toml": "[laser]\npulse_fwhm_ns = nan\n", "no.toml": "columns = = 3\n"}
            for name, text in sensors.items():
                (Path(folder) / name).write_text(text, encoding="utf-8")
            for name in (*maps, *sensors):
                with self.subTest(name=name):
                    file = Path(folder) / name
                    self.drop(file)
                    self.assertEqual(self.wait(), "failed", self.status())
                    option = "--depth" if name in maps else "--sensor"
                    run = subprocess.run(["build/cpp/bin/dtof", "frame", option, str(file), "--array-columns", "50", "--array-rows", "40", "--readout",
                                          "ezpointer", "--out", folder + "/frame"], cwd=ROOT, capture_output=True, text=True)
                    self.assertNotEqual(run.returncode, 0)
                    self.assertEqual(run.stderr.strip().replace(f"{folder}/", ""), f"dtof: error: {self.status()}")
                    # A map that the models refuse is still there: it can be taken away, or the sensor changed.
                    self.browser.evaluate("given.depth && drop('depth')")
                    self.wait()

    def trace(self, readout: str, column: int, row: int) -> float:
        """The last position of a pixel's trace, once all its steps are there."""
        self.browser.evaluate(f"document.getElementById('trace-readout').value = '{readout}'; watched.states = []; watchPixel({column}, {row})")
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            if self.browser.evaluate("watched.pixel && !watched.waiting && watched.states.length === steps()"):
                return float(self.browser.evaluate("watched.states.at(-1).position"))
            time.sleep(0.2)
        self.fail(f"no trace of {readout} in {SECONDS} s")

    def test_what_cannot_be_is_refused(self) -> None:
        self.browser.open(PAGE)
        self.wait()
        for settings, sentence in (({"scene": "flat", "distance": 9}, "Distance, m: 9 is no number from 0.05 to 6.74."),
                                   ({"distance": 1, "seed": "1.5"}, "Seed: 1.5 is no whole number from 0 to 9007199254740991.")):
            self.set(settings)
            self.assertEqual(self.wait(), "failed")
            self.assertEqual(self.status(), sentence)
        self.set({"seed": 1}, [])
        self.assertEqual((self.wait(), self.status()), ("failed", "Choose at least one read-out."))
        # What the models themselves refuse.
        self.browser.evaluate("form.elements.distance.max = ''")
        self.set({"distance": 9}, ["ezpointer"])
        self.assertEqual((self.wait(), self.status()), ("failed",
                         "9 m is beyond the sensor's range, 6.75 m (light there and back in 45 ns)"))
        self.set({"distance": 2})
        self.assertEqual(self.wait(), "done")

    def advice(self) -> dict[str, list[str]]:
        """Asks for advice; the cells of the table and the sentences on the page."""
        self.browser.evaluate("delete document.body.dataset.advice; byId('ask').click()")
        end = time.monotonic() + SECONDS
        while self.browser.evaluate("document.body.dataset.advice ?? 'running'") == "running" and time.monotonic() < end:
            time.sleep(0.2)
        found = {"state": [self.browser.evaluate("document.body.dataset.advice")], "status": [self.browser.evaluate("byId('advice-status').textContent")]}
        for name, selector in (("cells", "#advice-table th, #advice-table td"), ("says", "#advice-says p"), ("changes", "#advice-changes li")):
            found[name] = self.browser.evaluate(f"[...document.querySelectorAll('{selector}')].map(e => e.textContent)")
        return found

    def test_advice_is_that_of_the_command(self) -> None:
        self.browser.open(PAGE)
        self.wait()
        with tempfile.TemporaryDirectory() as folder:
            sensor = Path(folder) / "mine.toml"
            text = (ROOT / "models/dtof/sensor/presets/phone.toml").read_text(encoding="utf-8")
            for name, value in (("columns", 36), ("rows", 16), ("acquisitions", 400)):
                text = re.sub(f"(?m)^{name} = .*$", f"{name} = {value}", text)
            sensor.write_text(text, encoding="utf-8")
            self.set({"seed": 3}, ["ezpointer"])
            self.drop(sensor)
            self.assertEqual(self.wait(), "done", self.status())
            for limit in ("0.6", "0.001"):
                self.browser.evaluate(f"adviceForm['max-mm2'].value = '{limit}'")
                found = self.advice()
                words = shlex.split(self.browser.evaluate("adviceRequest().command"))
                words[words.index("--sensor") + 1] = str(sensor)
                run = subprocess.run([*words, "--out", folder + "/design"], cwd=ROOT, capture_output=True, text=True)
                if run.returncode != 0:
                    self.assertEqual(found["state"], ["failed"])
                    self.assertIn(found["status"][0], run.stderr)
                    continue
                self.assertEqual(found["state"], ["done"], found["status"])
                lines = run.stdout.splitlines()
                table = [line for line in lines if line.startswith("|") and not line.startswith("|--")]
                self.assertEqual(found["cells"], [cell.strip() for line in table for cell in line.strip("|").split("|")])
                self.assertEqual(found["says"], [line for line in lines if line.startswith("Recommended: ")])
                self.assertEqual(["* " + line for line in found["changes"]], [line for line in lines if line.startswith("* ")])
                self.browser.screenshot(SCREENSHOTS / "advice.png")
        self.assertEqual(limit, "0.001")
        self.assertIn("would do: --max-mm2", found["status"][0])

    def test_a_run_that_is_under_way_is_given_up(self) -> None:
        self.browser.open(PAGE)
        self.set_when_ready({"seed": 5, "size": "50 40"}, ["sifh"])
        self.assert_equal_to_native()

    def set_when_ready(self, settings: dict[str, object], readouts: list[str]) -> None:
        while self.browser.evaluate("document.body.dataset.state") is None:
            time.sleep(0.01)
        self.set(settings, readouts)

    def test_on_a_phone_in_the_dark(self) -> None:
        self.browser.window(390, 800, dark=True)
        self.browser.open(PAGE)
        self.assertEqual(self.wait(), "done", self.status())
        self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), 390)
        self.browser.screenshot(SCREENSHOTS / "phone.png")


if __name__ == "__main__":
    if not PAGE.exists():
        sys.exit("error: build/playground/index.html is missing: make playground")
    unittest.main()
