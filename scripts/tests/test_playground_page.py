# SPDX-License-Identifier: Apache-2.0
"""The playground's page in a browser, around a module that stands in for the models: what the page itself does.

`make playground-test` compares the models' module with `dtof frame`; it needs emscripten, and this test does not."""

import gzip
import io
import tempfile
import time
import unittest
import zlib
from pathlib import Path

import numpy

import playground_page
from page.site import Site
from tests.browser import missing
from tests.playground import SCREENSHOTS, SECONDS, InPlayground, npy, png

ROOT = Path(__file__).resolve().parent.parent.parent


class Building(unittest.TestCase):
    def test_its_parts_are_where_it_looks(self) -> None:
        self.assertEqual(playground_page.ROOT, ROOT)
        text = playground_page.page("// the module")
        for mark in ("/*STYLE*/", "/*COST*/", "/*PAGE*/", "/*WORKER*/"):
            self.assertNotIn(mark, text)
        self.assertIn("// the module", text)

    def test_a_module_that_would_end_its_script_is_refused(self) -> None:
        with self.assertRaises(SystemExit):
            playground_page.page("'</script>'")

    def test_the_start_page_leads_to_it(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name in ("README.md", "configurations.toml", "studies.toml"):
                (root / name).write_text((ROOT / name).read_text(encoding="utf-8"), encoding="utf-8")
            for there in (False, True):
                if there:
                    (root / "build/playground").mkdir(parents=True)
                    (root / "build/playground/index.html").write_text(playground_page.page("// the module"), encoding="utf-8")
                wrong = Site(root, root / "out").write()
                self.assertEqual([line for line in wrong if "playground" in line], [])
                self.assertEqual((root / "out/playground.html").is_file(), there)
                if there:
                    text = (root / "out/playground.html").read_text(encoding="utf-8")
                    for link in ('<a href="index.html">Start</a>', '<a href="plots.html">Plots</a>', '<a href="playground.html" aria-current=page>'):
                        self.assertIn(link, text)
                self.assertEqual("Drop a sensor file" in (root / "out/search_index.js").read_text(encoding="utf-8"), there)
                self.assertEqual('href="playground.html"' in (root / "out/index.html").read_text(encoding="utf-8"), there)


@unittest.skipIf(missing(), missing() or "")
class InTheBrowser(InPlayground):
    def test_what_the_models_say_is_shown(self) -> None:
        for width, height in ((390, 844), (1440, 900)):
            self.show(width, height)
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
            self.assertEqual(self.browser.evaluate("[...document.querySelectorAll('#cards h3')].map(h => h.textContent)"),
                             ["The scene", "First", "Pool", "Second"])
            self.assertIn("--scene room --sensor thesis --array-columns 16 --array-rows 8", self.browser.evaluate(
                "document.getElementById('command').textContent"))

    def test_a_refusal_is_shown(self) -> None:
        self.show()
        self.browser.evaluate("form.seed.value = 13; form.requestSubmit()")
        self.assertEqual(self.state(), "failed")
        self.assertEqual(self.browser.evaluate("document.getElementById('status').textContent"), "13 is refused")

    def colours(self) -> list[str]:
        """The first row of the map of two read-outs: blue is too near, red too far."""
        return self.browser.evaluate(
            "(c => { const copy = new OffscreenCanvas(c.width, 1).getContext('2d', {willReadFrequently: true}); copy.drawImage(c, 0, 0);"
            "return [...Array(c.width).keys()].map(x => copy.getImageData(x, 0, 1, 1).data)"
            ".map(([red, green, blue]) => red > blue ? 'red' : 'blue'); })(document.getElementById('compare-map'))")

    def slide(self, value: int) -> None:
        self.browser.evaluate(f"(s => {{ s.value = {value}; s.dispatchEvent(new Event('input', {{bubbles: true}})); }})"
                              "(document.getElementById('compare-split'))")

    def test_two_readouts_share_a_map_and_the_slider_divides_it(self) -> None:
        for width, height in ((390, 844), (1440, 900)):
            self.show(width, height)
            self.assertEqual(self.colours(), 8 * ["red"] + 8 * ["blue"])
            self.slide(250)
            self.assertEqual(self.colours(), 4 * ["red"] + 12 * ["blue"])
            self.assertEqual(self.browser.evaluate("document.getElementById('compare-names').innerText").split("\n"),
                             ["left: First", "right: Second"])
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
            self.browser.evaluate("document.getElementById('compare').scrollIntoView()")
            self.browser.screenshot(SCREENSHOTS / f"playground_compare_{width}.png", whole=False)

    def test_the_line_follows_the_pressed_mouse(self) -> None:
        self.show()
        x, y, width = self.browser.evaluate("(c => { c.scrollIntoView({block: 'center'}); const r = c.getBoundingClientRect();"
                                            "return [r.left, r.top + r.height / 2, r.width]; })(document.getElementById('compare-map'))")
        place = {"x": x + width * 12 / 16, "y": y, "button": "left"}
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=place["x"], y=y)
        self.assertEqual(self.colours(), 8 * ["red"] + 8 * ["blue"])
        self.browser.call("Input.dispatchMouseEvent", type="mousePressed", buttons=1, clickCount=1, **place)
        self.browser.call("Input.dispatchMouseEvent", type="mouseReleased", clickCount=1, **place)
        self.assertEqual(self.colours(), 12 * ["red"] + 4 * ["blue"])
        said = self.browser.evaluate("document.getElementById('compare-pixel').textContent")
        self.assertRegex(said, "^Column 12, row 4: First measured 2.300 m, true 2.200 m.*; Second measured 2.100 m, true 2.200 m")

    def test_what_is_compared_can_be_chosen_and_stays(self) -> None:
        self.show()
        self.browser.evaluate("(list => { list.value = 'second'; list.dispatchEvent(new Event('input')); })(document.getElementById('compare-left'))")
        self.assertEqual(self.colours(), 16 * ["blue"])
        self.browser.evaluate("form.seed.value = 2; form.requestSubmit()")
        self.assertEqual(self.state(), "done")
        self.assertEqual(self.colours(), 16 * ["blue"])

    def test_one_readout_is_not_compared(self) -> None:
        self.show()
        self.browser.evaluate("form.querySelectorAll('[value=second], [value=poolpointer]').forEach(box => {"
                              " box.checked = false; }); form.requestSubmit()")
        self.assertEqual(self.state(), "done")
        self.assertTrue(self.browser.evaluate("document.getElementById('compare').hidden"))

    def histogram(self, says: str) -> dict[int, int]:
        """By bar, the counts that are not 0, once the page says this of them."""
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            if self.browser.evaluate("document.getElementById('watch-says').textContent") == says:
                break
            time.sleep(0.05)
        self.assertEqual(self.browser.evaluate("document.getElementById('watch-says').textContent"), says)
        return {bar: count for bar, count in enumerate(self.browser.evaluate("watched.counts")) if count}

    def test_the_pixel_under_the_mouse_shows_its_histogram_over_the_frame(self) -> None:
        for width, height in ((390, 844), (1440, 900)):
            self.show(width, height)
            self.assertTrue(self.browser.evaluate("document.getElementById('watch').hidden"))
            for selector, column in (("#cards article:nth-of-type(2) canvas", 6), ("#compare-map", 9)):
                self.point_at(selector, column, 2)
                self.assertEqual(self.histogram(f"Column {column}, row 2: 51 timestamps in the first 100 of 100 acquisitions"),
                                 {column: 50, 112: 1})
            self.browser.evaluate("(s => { s.value = 200; s.dispatchEvent(new Event('input', {bubbles: true})); })"
                                  "(document.getElementById('watch-time'))")
            self.assertEqual(self.histogram("Column 9, row 2: 10 timestamps in the first 20 of 100 acquisitions"), {9: 10})
            self.assertEqual(self.browser.evaluate("document.getElementById('watch-marks').innerText.match(/▮ [^▮]*/g).map(t => t.slice(2).trim())"),
                             ["First", "Pool", "Second", "true distance"])
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
            box = self.browser.evaluate("(r => [r.top, r.bottom])(document.getElementById('watch').getBoundingClientRect())")
            self.assertTrue(0 < box[0] < box[1] <= height, box)  # in sight, wherever the pixel is
            self.browser.screenshot(SCREENSHOTS / f"playground_pixel_{width}.png", whole=False)
        self.browser.evaluate("delete document.body.dataset.state; form.requestSubmit()")
        self.assertEqual(self.state(), "done")
        self.assertTrue(self.browser.evaluate("document.getElementById('watch').hidden"))

    def test_the_state_of_the_pixel_grows_over_the_frame(self) -> None:
        for width, height in ((390, 844), (1440, 900)):
            self.show(width, height)
            self.point_at("#cards article:nth-of-type(2) canvas", 6, 2)
            self.assertEqual(self.states(64)[:2], [[2, 8.5], [3, 12.5]])
            self.assertEqual(self.states(64)[-1], [100, 400.5])
            self.assertRegex(self.traced(), r"^After 100 acquisitions: at 2.39 m \(code 400.5\), confidence 5\. Blue: ")
            self.browser.evaluate("(l => { l.value = 'poolpointer'; l.dispatchEvent(new Event('input')); })(document.getElementById('trace-readout'))")
            self.states(24)
            self.assertIn("rival at 1.73 m; candidates (score): 0.59 m (100), 3.13 m (1).", self.traced())
            self.browser.screenshot(SCREENSHOTS / f"playground_trace_{width}.png", whole=False)
            self.browser.evaluate("(s => { s.value = 500; s.dispatchEvent(new Event('input', {bubbles: true})); })"
                                  "(document.getElementById('watch-time'))")
            self.assertRegex(self.traced(), r"^After 50 acquisitions: at 1.07 m \(code 200.5\)")
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
            self.browser.evaluate("document.getElementById('watch-time').value = 1000")

    def test_the_phases_of_a_readout_are_marked(self) -> None:
        named = "[...document.querySelectorAll('#trace-phases span')].map(s => [s.textContent, s.title])"
        line = ("(c => { const alpha = c.getContext('2d').getImageData(0, 1, c.width, 1).data.filter((_, i) => i % 4 === 3);"
                " return [...alpha.keys()].filter(i => Math.abs(alpha[i] - 128) < 3).map(i => i / c.width); })(document.getElementById('trace'))")
        for width, height in ((390, 844), (1440, 900)):
            self.show(width, height)
            self.point_at("#cards article:nth-of-type(2) canvas", 6, 2)
            self.states(64)
            self.assertEqual(self.browser.evaluate(named), [["pointer", "pointer, ends at acquisition 100"]])
            self.browser.evaluate("(l => { l.value = 'poolpointer'; l.dispatchEvent(new Event('input')); })(document.getElementById('trace-readout'))")
            self.states(24)
            self.assertEqual(self.browser.evaluate(named), [["coarse", "coarse, ends at acquisition 20"], ["track", "track, ends at acquisition 55"],
                                                            ["pointer", "pointer, ends at acquisition 100"]])
            places = self.browser.evaluate(line)
            self.assertTrue(places and {round(place, 2) for place in places} <= {0.2, 0.55}, places)
            self.browser.screenshot(SCREENSHOTS / f"playground_phases_{width}.png", whole=False)

    def states(self, count: int) -> list[list[float]]:
        """Acquisition and position of each step, once there are this many."""
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            states: list[list[float]] = self.browser.evaluate("watched.states.map(s => [s.until, s.position])")
            if len(states) == count:
                break
            time.sleep(0.05)
        self.assertEqual(len(states), count)
        return states

    def traced(self) -> str:
        return str(self.browser.evaluate("document.getElementById('trace-says').textContent"))

    # ---- Files --------------------------------------------------------------------------------------------

    def test_a_depth_map_is_the_scene(self) -> None:
        metres = numpy.linspace(0.5, 4.0, 128, dtype=numpy.float32).reshape(8, 16)
        metres[3, 4] = 0
        millimetres = numpy.random.default_rng(1).integers(1, 4000, (8, 16)).astype(numpy.uint16)
        few = numpy.random.default_rng(2).integers(1, 7, (8, 16)).astype(numpy.uint16)  # the last filter often finds two as near
        begins_with_a_line_end = metres.copy()
        begins_with_a_line_end[7, 0] = numpy.frombuffer(b"\n\x00\x80\x3f", "<f4")[0]
        for name, content, wanted in (
                ("map.npy", npy(metres), metres), ("map.npy", npy(metres.astype(">f8")), metres), ("map.npy", npy(metres[None]), metres),
                ("map.pfm", b"Pf\n16 8\n-2.0\n" + (metres[::-1] / 2).astype("<f4").tobytes(), metres),
                ("map.pfm", b"Pf 16 8 1\r\n" + metres[::-1].astype(">f4").tobytes(), metres),
                ("map.pfm", b"Pf 16 8 -1\r" + begins_with_a_line_end[::-1].astype("<f4").tobytes(), begins_with_a_line_end),
                ("map.png", png(few, 16, (4,)), (few * 1e-3).astype(numpy.float32)),
                ("map.png", png(millimetres, 16), (millimetres * 1e-3).astype(numpy.float32))):
            self.show()
            self.drop((name, content))
            self.assertEqual(self.state(), "done", self.status())
            self.assertEqual(self.truth(), wanted.ravel().tolist())
            self.assertIn(f"dtof frame --depth {name} --sensor thesis", self.command())
            self.assertNotIn("--scene", self.command())
        self.assertIn("map.png, 16 x 8 pixels", self.browser.evaluate("document.getElementById('cards').innerText"))
        self.browser.evaluate("delete document.body.dataset.state; document.getElementById('drop-depth').click()")
        self.assertEqual(self.state(), "done")
        self.assertIn("--scene room", self.command())
        self.assertAlmostEqual(self.truth()[15], 2.5, 5)

    def test_a_map_of_8_bits_waits_for_its_scale(self) -> None:
        self.show()
        units = numpy.arange(128, dtype=numpy.uint8).reshape(8, 16)
        self.drop(("a map.png", png(units, 8)))
        self.assertEqual(self.state(), "failed")
        self.assertIn("a map.png: a depth map of 8 bits needs its scale", self.status())
        self.browser.evaluate("delete document.body.dataset.state; form['depth-scale'].value = '0.05';"
                              "form['depth-scale'].dispatchEvent(new Event('change', {bubbles: true}))")
        self.assertEqual(self.state(), "done", self.status())
        self.assertEqual(self.truth(), (units * 0.05).astype(numpy.float32).ravel().tolist())
        self.assertIn("--depth 'a map.png' --depth-scale 0.05", self.command())

    def test_a_sensor_file_is_the_sensor(self) -> None:
        self.show()
        self.drop(("mine.toml", b"name = 'mine'\n"))
        self.assertEqual(self.state(), "done", self.status())
        self.assertIn("--scene room --sensor mine.toml --array-columns 32 --array-rows 8", self.command())
        self.assertIn("--reflectivity 0.25 --acquisitions 77", self.command())
        self.assertEqual(len(self.truth()), 256)
        self.drop(("other.toml", b"wrong"))
        self.assertEqual((self.state(), self.status()), ("failed", "other.toml:1: wrong"))
        self.browser.evaluate("delete document.body.dataset.state; document.getElementById('drop-sensor').click()")
        self.assertEqual(self.state(), "done")
        self.assertIn("--sensor thesis --array-columns 16", self.command())

    def test_a_recording_is_replayed(self) -> None:
        stream = b"acquisition\n\x07\x02\x03"
        for name, content in (("a frame.csv", stream), ("frame.csv.gz", gzip.compress(stream))):
            for width, height in ((390, 844), (1440, 900)):
                self.show(width, height)
                self.drop((name, content))
                self.assertEqual(self.state(), "done", self.status())
                self.assertEqual(self.browser.evaluate("[...scene.brightness]"), list(stream))
                quoted = f"'{name}'" if " " in name else name
                self.assertEqual(self.command(), f"build/cpp/bin/dtof replay {quoted} --t-int 45 --np 10 --slots 2 --readout all")
                self.assertEqual(self.browser.evaluate("[...document.querySelectorAll('#cards h3')].map(h => h.textContent)"),
                                 ["The recording", "First", "Pool", "Second"])
                self.assertEqual(self.browser.evaluate("document.querySelectorAll('#cards canvas').length"), 4)  # no map of errors
                self.assertTrue(self.browser.evaluate("form.scene.disabled && form.klux.disabled && form.acquisitions.disabled"))
                self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
                self.browser.screenshot(SCREENSHOTS / f"playground_recording_{width}.png")
        self.browser.evaluate("delete document.body.dataset.state; document.getElementById('drop-recording').click()")
        self.assertEqual(self.state(), "done")
        self.assertIn("--scene room", self.command())
        self.assertFalse(self.browser.evaluate("form.scene.disabled || form.klux.disabled || form.acquisitions.disabled"))

    def test_histograms_are_a_recording(self) -> None:
        cube = numpy.arange(24, dtype=numpy.uint16).reshape(2, 3, 4)
        archives = []
        for save in (numpy.savez, numpy.savez_compressed):
            file = io.BytesIO()
            save(file, histograms=cube, bin_width_ps=numpy.float64(250.5))
            archives.append(file.getvalue())
        self.show()
        for content in archives:
            self.drop(("cube.npz", content))
            self.assertEqual(self.state(), "done", self.status())
            self.assertEqual(self.browser.evaluate("given.recording.contents.size"), len(npy(cube)))
            self.assertEqual(self.command(), "build/cpp/bin/dtof replay cube.npz --bin-width 250.5 --acquisitions 100 --seed 1 "
                                             "--t-int 45 --np 10 --slots 2 --readout all")
        self.drop(("cube.npy", npy(cube)))
        self.assertEqual((self.state(), self.status()), ("failed", "cube.npy: histograms need the width of their bins: give it in ps"))
        self.browser.evaluate("delete document.body.dataset.state; form['bin-width'].value = '100';"
                              "form['bin-width'].dispatchEvent(new Event('change', {bubbles: true}))")
        self.assertEqual(self.state(), "done", self.status())
        self.assertIn("dtof replay cube.npy --bin-width 100 --acq", self.command())
        self.drop(("map.npy", npy(numpy.ones((8, 16), numpy.float32))))  # a map takes the recording's place
        self.assertEqual(self.state(), "done", self.status())
        self.assertIn("--depth map.npy", self.command())

    def test_time_tags_logs_and_photon_times_are_recordings(self) -> None:
        tail = "--acquisitions 100 --seed 1 --t-int 45 --np 10 --slots 2 --readout all"
        header, element = b"MATLAB 5.0 MAT-file".ljust(128), b"\x0e\0\0\0\x08\0\0\0photons!"
        deflated = zlib.compress(element)
        packed = header + b"".join(number.to_bytes(4, "little") for number in (15, len(deflated))) + deflated
        for name, content, unpacked in (("tags.ptu", b"PQTTTR\0\0", None), ("tags.ptu.gz", gzip.compress(b"PQTTTR\0\0"), b"PQTTTR\0\0"),
                                        ("log.json", b"[{}]", None), ("times.mat", packed, header + element),
                                        ("plain.mat", header + element, None)):
            with self.subTest(name=name):
                self.show()
                self.drop((name, content))
                self.assertEqual(self.state(), "done", self.status())
                self.assertEqual(self.command(), f"build/cpp/bin/dtof replay {name} {tail}")
                given = "(async () => [...new Uint8Array(await given.recording.contents.arrayBuffer())])().then(b => { window.bytes = b; })"
                self.browser.evaluate(given)
                self.wait_for("window.bytes")
                self.assertEqual(bytes(self.browser.evaluate("window.bytes")), unpacked or content)
                self.assertFalse(self.browser.evaluate("form.acquisitions.disabled || form.seed.disabled"))

    def test_a_long_name_stays_in_its_box(self) -> None:
        name = "a_recording_with_a_name_that_is_longer_than_the_settings_are_wide.json"
        for width, height in ((390, 844), (1440, 900)):
            self.show(width, height)
            self.drop((name, b"[{}]"))
            self.assertEqual(self.state(), "done", self.status())
            for box in ("drop-recording", "scene-summary"):
                inside = f"(b => b.scrollWidth <= b.clientWidth && b.getBoundingClientRect().right <= byId('controls').getBoundingClientRect().right)(byId('{box}'))"
                self.assertTrue(self.browser.evaluate(inside), box)

    def test_a_recording_is_thinned_and_shifted(self) -> None:
        self.show()
        self.browser.evaluate("form.photons.value = '500'; form.shift.value = '-2.5'; form['bin-width'].value = '90'")
        for name, content, width in (("log.json", b"[{}]", "--bin-width 90 "), ("tags.ptu", b"PQTTTR\0\0", "")):
            self.drop((name, content))
            self.assertEqual(self.state(), "done", self.status())
            self.assertEqual(self.command(), f"build/cpp/bin/dtof replay {name} {width}--photons 500 --shift -2.5 --acquisitions 100 --seed 1 "
                                             "--t-int 45 --np 10 --slots 2 --readout all")
            self.assertIn("photons 500\nshift -2.5\nacquisitions 100", self.browser.evaluate("request().text"))
        self.drop(("a.csv", b"acquisition\n\x07"))  # a TDC stream is replayed as it was recorded
        self.assertEqual(self.state(), "done", self.status())
        self.assertNotIn("--photons", self.command())

    def test_a_recording_that_cannot_be_read_has_its_sentence(self) -> None:
        for name, content, sentence in (("x.csv", b"!", "x.csv:1: wrong"), ("x.csv.gz", gzip.compress(b""), "x.csv.gz: empty"),
                                        ("x.csv.gz", gzip.compress(b"acquisition")[:-9], "x.csv.gz: damaged gzip data"),
                                        ("x.npz", b"PK\x03\x04 no archive", "x.npz: a damaged NPZ")):
            self.show()
            self.drop((name, content))
            self.assertEqual((self.state(), self.status()), ("failed", sentence))

    def test_a_file_that_is_none_of_these_is_refused_and_changes_nothing(self) -> None:
        good = npy(numpy.ones((8, 16), numpy.float32))
        for content, sentence in ((b"hello", "neither a sensor file (.toml) nor a depth map (PNG, PFM, NPY) nor a recording"), (good[:-4], "need 512 bytes, the file has 508"),
                                  (npy(-numpy.ones((2, 2))), "column 0, row 0: a negative depth"),
                                  (npy(numpy.ones((2, 2), numpy.complex64)), "NPY of c8"), (npy(numpy.ones(4)), "NPY shape (4)"),
                                  (b"Pf\n2 2\n0\n" + bytes(16), "PFM scale 0 is not"), (b"Pf\n2 2\n1\n" + bytes(15), "the file has 15"),
                                  (png(numpy.ones((2, 2)), 16)[:-40], "a damaged PNG")):
            with self.subTest(sentence=sentence):
                self.show()
                self.drop(("x.bin", content))
                self.assertEqual(self.state(), "failed")
                self.assertTrue(self.status().startswith("x.bin: ") and sentence in self.status(), self.status())
                self.assertIn("--scene room", self.command())
                self.assertTrue(self.browser.evaluate("document.getElementById('drop-depth').hidden"))


if __name__ == "__main__":
    unittest.main()
