# SPDX-License-Identifier: Apache-2.0
"""The playground's page for those who have a finger or a keyboard, a phone, or no eyes for a picture."""

import unittest

from tests.browser import missing
from tests.playground import SCREENSHOTS, SIZES, STAND_IN, InPlayground

# Elements that have text and reach over the right end of what they stand in; the element's own scroll bars are no excuse.
OVER = """[...document.querySelectorAll('%s *')].filter((e) => e.children.length === 0 && e.textContent.trim() && e.getClientRects().length > 0 &&
  !e.closest('.scroll, pre, option') && e.getBoundingClientRect().right > e.closest('%s').getBoundingClientRect().right + 1).map((e) => e.textContent)"""
# Controls and pictures without a name for a screen reader.
NAMELESS = """[...document.querySelectorAll('input, select, textarea, button, progress, canvas[role=img], [role=region]')].filter((e) =>
  !e.closest('[hidden]') && !(e.getAttribute('aria-label') || e.textContent.trim() && e.tagName === 'BUTTON' ||
  e.labels && [...e.labels].some((l) => l.textContent.trim()))).map((e) => e.outerHTML)"""
POOL = "(l => { l.value = 'poolpointer'; l.dispatchEvent(new Event('input')); })(document.getElementById('trace-readout'))"


@unittest.skipIf(missing(), missing() or "")
class Access(InPlayground):
    STAND_IN = STAND_IN.replace("tFirst", "tpooled matched filter").replace("tSecond", "tcoarse histogram of every pixel")

    def pick(self, column: int, row: int) -> None:
        """Enters a pixel, as those do who have no mouse."""
        self.browser.evaluate(f"for (const [id, value] of [['pick-column', {column}], ['pick-row', {row}]]) {{ byId(id).value = value;"
                              "byId(id).dispatchEvent(new Event('input', {bubbles: true})); }")
        self.wait_for(f"watched.pixel && watched.pixel.column === {column} && watched.pixel.row === {row} && watched.states.length === steps()")

    def key(self, name: str) -> None:
        for kind in ("rawKeyDown", "keyUp"):
            self.browser.call("Input.dispatchKeyEvent", type=kind, key=name, code=name,
                              windowsVirtualKeyCode={"ArrowRight": 39, "ArrowUp": 38, "Escape": 27}[name])

    def test_no_text_reaches_over_its_box(self) -> None:
        for width, height in SIZES:
            self.show(width, height)
            self.pick(6, 2)
            self.browser.evaluate(POOL)
            for box in ("#controls", "#watch", "#watch-marks", "#state", "article", "#advise", ".halves > div"):
                self.assertEqual(self.browser.evaluate(OVER % (box, box)), [], f"{box} at {width}")
            self.browser.screenshot(SCREENSHOTS / f"playground_access_{width}.png", whole=False)

    def test_every_control_and_picture_has_a_name(self) -> None:
        self.show()
        self.pick(6, 2)
        self.assertEqual(self.browser.evaluate(NAMELESS), [])
        labels = self.browser.evaluate("[...document.querySelectorAll('#cards canvas')].map(c => c.getAttribute('aria-label'))")
        self.assertEqual(len(set(labels)), len(labels), labels)
        self.assertIn("pooled matched filter: error", labels)

    def test_a_pixel_is_entered_without_a_mouse(self) -> None:
        self.show()
        self.pick(6, 2)
        self.assertFalse(self.browser.evaluate("byId('watch').hidden"))
        self.assertTrue(self.browser.evaluate("byId('pixel').textContent").startswith("Column 6, row 2: pooled matched filter measured 1.700 m, true 1.600 m"))
        self.browser.evaluate("byId('pick-column').focus()")
        self.key("ArrowUp")
        self.wait_for("watched.pixel.column === 7")
        self.key("Escape")
        self.assertTrue(self.browser.evaluate("byId('watch').hidden"))
        self.browser.evaluate("byId('pick-column').value = 16; byId('pick-column').dispatchEvent(new Event('input'))")
        self.assertEqual(self.browser.evaluate("[watched.pixel.column, watched.next]"), [7, None])  # there is no column 16
        self.point_at("#cards article:nth-of-type(2) canvas", 3, 5)
        self.assertEqual(self.browser.evaluate("[byId('pick-column').value, byId('pick-row').value]"), ["3", "5"])

    def touch(self, selector: str, shares: list[float]) -> None:
        """A finger goes from one share of the element's width to the next."""
        left, middle, width = self.browser.evaluate(f"(c => {{ c.scrollIntoView({{block: 'center'}}); const r = c.getBoundingClientRect();"
                                                    f"return [r.left, r.top + r.height / 2, r.width]; }})(document.querySelector('{selector}'))")
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        for i, share in enumerate(shares):
            self.browser.call("Input.dispatchTouchEvent", type="touchMove" if i else "touchStart", touchPoints=[{"x": left + share * width, "y": middle}])
        self.browser.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=False)

    def split(self) -> int:
        return int(self.browser.evaluate("splitColumn()"))

    def test_the_line_and_the_slider_follow_a_finger(self) -> None:
        for selector in ("#compare-map", "#compare-split"):
            self.show(*SIZES[0])
            self.assertEqual(self.split(), 8)
            self.touch(selector, [0.5, 0.45, 0.4, 0.35, 0.3, 0.25])
            self.assertEqual(self.split(), 4, selector)
            self.assertTrue(self.browser.evaluate("byId('watch').hidden"))  # the pixel's panel would cover the slider
            self.assertIn("left: pooled matched filter", self.browser.evaluate("byId('compare-names').innerText"))

    def test_the_slider_follows_the_keyboard(self) -> None:
        self.show()
        self.browser.evaluate("byId('compare-split').value = 497; byId('compare-split').focus()")
        for _ in range(40):
            self.key("ArrowRight")
        self.assertEqual(self.split(), 9)
        self.assertTrue(self.browser.evaluate("byId('compare-split').getAttribute('aria-valuetext')").startswith("9 columns of pooled matched filter"))

    def test_the_status_is_in_sight_wherever_the_page_is(self) -> None:
        for width, height in SIZES:
            self.show(width, height)
            for part in ("#controls", "#cards", "#advise"):
                self.browser.evaluate(f"document.querySelector('{part}').scrollIntoView({{block: 'end'}}); fail('planted')")
                top, bottom = self.browser.evaluate("(r => [r.top, r.bottom])(byId('status').getBoundingClientRect())")
                self.assertTrue(0 <= top < bottom <= height, (part, top, bottom))

    def test_links_lead_to_the_parts_that_are_there(self) -> None:
        for width, height in SIZES:
            self.show(width, height)
            for name in self.browser.evaluate("[...document.querySelectorAll('#state a')].map(a => a.hash)"):
                self.browser.evaluate(f"document.querySelector('#state [href=\"{name}\"]').click()")
                top = self.browser.evaluate(f"document.querySelector('{name}').getBoundingClientRect().top - byId('state').getBoundingClientRect().bottom")
                self.assertGreaterEqual(top, -1, name)
            self.browser.evaluate("form.querySelectorAll('[value=second], [value=poolpointer]').forEach(box => { box.checked = false; });"
                                  "delete document.body.dataset.state; form.requestSubmit()")
            self.assertEqual(self.state(), "done")
            self.assertEqual(self.browser.evaluate("[...document.querySelectorAll('#state a')].filter(a => a.hidden).map(a => a.hash)"), ["#compare"])

    def test_axes_have_names_and_the_true_distance_is_where_its_echo_is(self) -> None:
        self.show()
        self.pick(6, 2)
        texts = [self.browser.evaluate(f"byId('{name}').innerText").split("\n") for name in ("watch-up", "watch-ends", "trace-up", "trace-ends")]
        self.assertEqual(texts, [["50", "events a bar", "0"], ["-0.25 m", "distance of a timestamp", "6.50 m"], ["6.50 m", "distance", "-0.25 m"],
                                 ["0", "acquisitions", "100"]])
        # 1.6 m of 6.75 m, and 0.25 m later, because the pulse's width is subtracted from distances.
        place = self.browser.evaluate("(c => { const row = c.getContext('2d').getImageData(0, 3, c.width, 1).data; return [...Array(c.width).keys()]"
                                      ".filter(x => row[4 * x] === 0x1b && row[4 * x + 1] === 0x1f).map(x => x / c.width); })(byId('watch-histogram'))")
        self.assertTrue(place, "no line")
        self.assertAlmostEqual(sum(place) / len(place), (1.6 + 0.25) / 6.75, 2)

    def test_the_frame_is_played(self) -> None:
        self.show()
        self.pick(6, 2)
        self.browser.evaluate("window.seen = []; (drawn => { paintTrace = () => { seen.push(Number(byId('watch-time').value)); drawn(); }; })(paintTrace); byId('watch-play').click()")
        self.assertEqual(self.browser.evaluate("byId('watch-play').textContent"), "stop")
        self.wait_for("playing === 0")
        seen = self.browser.evaluate("seen")
        self.assertGreater(len(seen), 20)
        self.assertEqual(seen, sorted(seen))
        self.assertLess(seen[0], 100)
        self.assertEqual((seen[-1], self.browser.evaluate("byId('watch-play').textContent")), (1000, "play the frame"))
        self.browser.evaluate("byId('watch-play').click()")
        self.key("Escape")
        self.assertEqual(self.browser.evaluate("playing"), 0)

    def test_a_trace_says_how_far_it_is(self) -> None:
        self.show()
        self.pick(6, 2)
        self.assertEqual(self.browser.evaluate("byId('trace-busy').textContent"), "")
        said = self.browser.evaluate("(() => { const kept = watched.states; watched.states = kept.slice(0, 5); paintTrace();"
                                     "const text = byId('trace-busy').textContent; watched.states = kept; return text; })()")
        self.assertEqual(said, "step 6 of 64 ...")


if __name__ == "__main__":
    unittest.main()
