# SPDX-License-Identifier: Apache-2.0
"""The playground's advice in a browser, around a module that stands in for the models: what the page itself does.

`make playground-test` compares the advice of the models' module with `dtof design`."""

import tempfile
import time
import unittest
from pathlib import Path

import playground_page
from tests.browser import Browser, missing
from tests.playground import SCREENSHOTS, SECONDS, STAND_IN

# Lines as playground/advice.hpp has them. The sentence has the request and the sensor, so that a test sees both.
ADVICE = """
  Object.assign(functions, {
    preset_text: (name) => `# the file of ${name}\\n`,
    advise: (text) => {
      const said = Object.fromEntries(text.split("\\n").map((line) => line.split(" ")));
      const own = sensor === "" ? `preset ${said.sensor}` : sensor.split("\\t")[1];
      adviceProgress("parameters", 1, 2);
      sentence = Number(said["max-mm2"]) < 0.1 ? "design: no read-out keeps the limits; one of these would do: --max-mm2 0.4 (First)" : "";
      advice = ["head\\tread-out\\toff\\tmm2\\tframes/s", "row\\tPool\\t1.00 [0.50, 1.50]\\t0.75\\t235.8", "row\\tSecond\\t9.00 [8.00, 9.99]\\t0.40\\t30.1",
        `recommendation\\tRecommended: Pool. ${own}: ${text.replaceAll("\\n", ", ")}`, "change\\tarea 10 % less: Second", "change\\tarea 10 % more: the same",
        "clocks\\tPool: 1,400,000 clocks", "left\\tFirst\\tneeds --max-mm2 15", "readout\\tpoolpointer", "product\\t--readout poolpointer --slots 1"].join("\\n");
      return sentence === "" ? 1 : 0;
    },
    advice_text: () => advice,
  });
  let advice = "";
"""


@unittest.skipIf(missing(), missing() or "")
class Advice(unittest.TestCase):
    page: Path
    browser: Browser

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.page = Path(folder.name) / "index.html"
        cls.page.write_text(playground_page.page(STAND_IN.replace("  return { HEAPF32", ADVICE + "  return { HEAPF32")), encoding="utf-8")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def setUp(self) -> None:
        self.browser.complaints.clear()
        self.browser.window(1440, 900)
        self.browser.open(self.page)
        self.assertEqual(self.wait("state"), "done")

    def tearDown(self) -> None:
        self.assertEqual(self.browser.complaints, [])

    def wait(self, what: str) -> str:
        """The state of the frame or of the advice, once it is not running any more."""
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            state = self.browser.evaluate(f"document.body.dataset.{what} ?? 'running'")
            if state != "running":
                return str(state)
            time.sleep(0.05)
        return "running"

    def ask(self, **limits: object) -> str:
        for name, value in limits.items():
            self.browser.evaluate(f"adviceForm['{name.replace('_', '-')}'].value = '{value}'")
        self.browser.evaluate("delete document.body.dataset.advice; byId('ask').click()")
        return self.wait("advice")

    def text(self, name: str) -> str:
        return str(self.browser.evaluate(f"byId('{name}').innerText"))

    def texts(self, selector: str) -> list[str]:
        return list(self.browser.evaluate(f"[...document.querySelectorAll('{selector}')].map(e => e.textContent)"))

    def test_what_the_models_recommend_is_shown(self) -> None:
        self.assertTrue(self.browser.evaluate("byId('advice').hidden"))
        self.assertEqual(self.ask(), "done")
        self.assertEqual(self.texts("#advice-table thead th"), ["read-out", "off", "mm2", "frames/s"])
        self.assertEqual(self.texts("#advice-table tbody th"), ["Pool", "Second"])
        self.assertEqual(self.texts("#advice-table tbody td"), ["1.00 [0.50, 1.50]", "0.75", "235.8", "9.00 [8.00, 9.99]", "0.40", "30.1"])
        self.assertEqual(self.text("advice-says"), "Recommended: Pool. preset thesis: sensor thesis, frame-rate 30, clock-mhz 330, seed 1")
        self.assertEqual(self.texts("#advice-changes li"), ["area 10 % less: Second", "area 10 % more: the same"])
        self.assertEqual(self.texts("#advice-clocks li"), ["Pool: 1,400,000 clocks"])
        self.assertEqual(self.texts("#advice-left li"), ["First: needs --max-mm2 15"])
        self.assertTrue(self.browser.evaluate("byId('advice-nothing-left').hidden"))
        self.assertEqual(self.text("advice-command").splitlines(), [
            "build/cpp/bin/dtof design --sensor thesis --quick --frame-rate 30 --clock-mhz 330 --seed 1",
            "build/cpp/bin/dtof product --sensor thesis --readout poolpointer --slots 1 --out build/chip"])
        for width, height in ((390, 844), (1440, 900)):
            self.browser.window(width, height)
            self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
            self.browser.evaluate("byId('advise').scrollIntoView()")
            self.browser.screenshot(SCREENSHOTS / f"playground_advice_{width}.png", whole=False)

    def test_the_limits_are_asked_for(self) -> None:
        self.assertEqual(self.ask(max_mm2="1.5", max_mw=150, frame_rate=60, clock_mhz=200), "done")
        asked = "max-mm2 1.5, max-mw 150, frame-rate 60, clock-mhz 200, seed 1"
        self.assertTrue(self.text("advice-says").endswith(asked), self.text("advice-says"))
        self.assertIn("--quick --max-mm2 1.5 --max-mw 150 --frame-rate 60 --clock-mhz 200 --seed 1", self.text("advice-command"))

    def test_a_refusal_is_shown_in_place_of_the_advice(self) -> None:
        self.assertEqual(self.ask(), "done")
        self.assertEqual(self.ask(max_mm2="0.01"), "failed")
        self.assertEqual(self.text("advice-status"), "design: no read-out keeps the limits; one of these would do: --max-mm2 0.4 (First)")
        self.assertTrue(self.browser.evaluate("byId('advice').hidden"))
        self.assertEqual(self.ask(max_mm2="-1"), "failed")
        self.assertEqual(self.text("advice-status"), "Largest array, mm²: -1 is no number from 0.001 to 1000000.")

    def test_a_typed_sensor_is_advised_on(self) -> None:
        self.browser.evaluate("document.querySelector('#advise details').open = true; byId('type-preset').click()")
        end = time.monotonic() + SECONDS
        while self.browser.evaluate("byId('typed').value") == "" and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(self.browser.evaluate("byId('typed').value"), "# the file of thesis\n")
        self.browser.evaluate("delete document.body.dataset.state; byId('typed').value = 'columns = 32'; byId('type-use').click()")
        self.assertEqual(self.wait("state"), "done")
        self.assertEqual(self.browser.evaluate("form.size.options[0].textContent"), "32 x 8")
        self.assertEqual(self.ask(), "done")
        self.assertIn("Recommended: Pool. typed.toml: frame-rate 30", self.text("advice-says"))
        self.assertIn("--sensor typed.toml --quick", self.text("advice-command"))

    def test_a_typed_sensor_is_advised_on_without_a_second_button(self) -> None:
        self.browser.evaluate("document.querySelector('#advise details').open = true; byId('typed').value = 'columns = 32'")
        self.assertEqual(self.ask(), "done")
        self.assertIn("Recommended: Pool. typed.toml: frame-rate 30", self.text("advice-says"))
        self.browser.evaluate("byId('typed').value = 'wrong'")
        self.assertEqual(self.ask(), "failed")
        self.assertEqual((self.text("advice-status"), self.text("status")), 2 * ("typed.toml:1: wrong",))

    def test_frames_are_read_while_advice_is_computed(self) -> None:
        self.browser.evaluate("byId('ask').click(); form.seed.value = 2; delete document.body.dataset.state; form.requestSubmit()")
        self.assertEqual((self.wait("state"), self.wait("advice")), ("done", "done"))


if __name__ == "__main__":
    unittest.main()
