# SPDX-License-Identifier: Apache-2.0
"""The playground's page in a browser, around a module that stands in for the models: what the page itself does.

`make playground-test` compares the models' module with `dtof frame`; it needs emscripten, and this test does not."""

import importlib.util
import tempfile
import time
import unittest
from pathlib import Path
from types import ModuleType

from page.site import Site
from tests.browser import Browser, missing

ROOT = Path(__file__).resolve().parent.parent.parent
SCREENSHOTS = ROOT / "build" / "report_test"
SECONDS = 30
# Two read-outs of 16 x 8 pixels, columns from 1 m to 2.5 m: the first reads 0.1 m too much, the second 0.1 m too little.
STAND_IN = """
const createModels = async () => {
  const heap = new ArrayBuffer(1 << 20), HEAPF32 = new Float32Array(heap), HEAPU16 = new Uint16Array(heap);
  let asked = {}, readout = 0, sentence = "";
  const pixels = () => asked.columns * asked.rows;
  const truth = (i) => 1 + 0.1 * (i % asked.columns);
  const floats = (place, value) => {
    for (let i = 0; i < pixels(); ++i) { HEAPF32[place / 4 + i] = value(i); }
    return place;
  };
  const off = () => readout === 0 ? 0.1 : -0.1;
  const functions = {
    catalogue: () => "readout\\tfirst\\tFirst\\treads too far\\nreadout\\tsecond\\tSecond\\treads too near\\nscene\\troom\\ta room\\n" +
      "scene\\tflat\\ta wall\\nsensor\\tthesis\\t16\\t8\\t0.5\\t100\\t6.75\\n",
    begin: (text) => {
      asked = Object.fromEntries(text.split("\\n").map((line) => line.split(" ")));
      sentence = Number(asked.seed) === 13 ? "13 is refused" : "";
      return sentence === "" ? 1 : 0;
    },
    error: () => sentence, columns: () => Number(asked.columns), rows: () => Number(asked.rows),
    truth: () => floats(0, truth), reflectivity: () => floats(1 << 16, () => 0.5), calibrate: () => 1, read_column: () => 1,
    frame: (index) => { readout = index; return 1; },
    depth: () => floats(2 << 16, (i) => truth(i) + off()), error_map: () => floats(3 << 16, off),
    results: () => {
      for (let i = 0; i < pixels(); ++i) { HEAPU16.set([i, 0, 3, 0], (4 << 16) / 2 + 4 * i); }
      return 4 << 16;
    },
    figures: () => ["100", "100", "100", "50 %", "10 %"].join("\\n"),
  };
  return { HEAPF32, HEAPU16, ccall: (name, result, types, values) => functions[name.replace("playground_", "")](...values) };
};
"""


def builder() -> ModuleType:
    path = ROOT / "app" / "playground" / "page" / "build_page.py"
    spec = importlib.util.spec_from_file_location("build_page", path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Building(unittest.TestCase):
    def test_its_parts_are_where_it_looks(self) -> None:
        module = builder()
        self.assertEqual(module.ROOT, ROOT)
        text = module.page("// the module")
        for mark in ("/*STYLE*/", "/*COST*/", "/*PAGE*/", "/*WORKER*/"):
            self.assertNotIn(mark, text)
        self.assertIn("// the module", text)

    def test_a_module_that_would_end_its_script_is_refused(self) -> None:
        with self.assertRaises(SystemExit):
            builder().page("'</script>'")

    def test_the_start_page_leads_to_it(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name in ("README.md", "configurations.toml", "studies.toml"):
                (root / name).write_text((ROOT / name).read_text(encoding="utf-8"), encoding="utf-8")
            for there in (False, True):
                if there:
                    (root / "build/playground").mkdir(parents=True)
                    (root / "build/playground/index.html").write_text(builder().page("// the module"), encoding="utf-8")
                wrong = Site(root, root / "out").write()
                self.assertEqual([line for line in wrong if "playground" in line], [])
                self.assertEqual((root / "out/playground.html").is_file(), there)
                self.assertEqual('href="playground.html"' in (root / "out/index.html").read_text(encoding="utf-8"), there)


@unittest.skipIf(missing(), missing() or "")
class InTheBrowser(unittest.TestCase):
    browser: Browser

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.page = Path(folder.name) / "index.html"
        cls.page.write_text(builder().page(STAND_IN), encoding="utf-8")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def show(self, width: int = 1440, height: int = 900) -> None:
        self.browser.complaints.clear()
        self.browser.window(width, height)
        self.browser.open(self.page)
        self.assertEqual(self.state(), "done")

    def state(self) -> str:
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            state = self.browser.evaluate("document.body.dataset.state ?? 'running'")
            if state != "running":
                return str(state)
            time.sleep(0.05)
        return "running"

    def tearDown(self) -> None:
        self.assertEqual(self.browser.complaints, [])

    def test_what_the_models_say_is_shown(self) -> None:
        for width, height in ((390, 844), (1440, 900)):
            self.show(width, height)
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
            self.assertEqual(self.browser.evaluate("[...document.querySelectorAll('#cards h3')].map(h => h.textContent)"),
                             ["The scene", "First", "Second"])
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
        self.browser.evaluate("form.querySelector('[value=second]').checked = false; form.requestSubmit()")
        self.assertEqual(self.state(), "done")
        self.assertTrue(self.browser.evaluate("document.getElementById('compare').hidden"))


if __name__ == "__main__":
    unittest.main()
