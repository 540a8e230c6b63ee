# SPDX-License-Identifier: Apache-2.0
"""The start page, the bar with the navigation, and the search: their parts, and in a browser, from a disk."""

import json
import re
import tempfile
import time
import unittest
from pathlib import Path

from page import layout, start
from page.search import FILE, Index
from page.site import Site
from tests.browser import Browser, missing
from tests.moved_page import moved_page

ROOT = Path(__file__).resolve().parent.parent.parent
SCREENSHOTS = ROOT / "build" / "report_test"
README = (ROOT / "README.md").read_text(encoding="utf-8")


class Start(unittest.TestCase):
    def test_the_doors_are_those_of_the_readme(self) -> None:
        found = start.doors(README)
        self.assertEqual([door.title for door in found], list(start.SAYS))
        for door in found:
            self.assertNotIn("\n\n", door.text)
        self.assertEqual(found[0].commands[0], ("build/cpp/bin/dtof list", "read-outs, presets, scenes"))
        self.assertIn("design --sensor", " ".join(command for command, _ in found[1].commands))
        self.assertEqual(found[2].commands, ())
        self.assertIn("dtof_subsystem.sv", found[2].text)

    def test_every_command_of_a_door_is_shown(self) -> None:
        section = re.sub(r"<!-- printed by .*-->\n\n    .*\n", "", README[README.index("## Three doors"):README.index("## Read on")])
        lines = [line for line in section.splitlines() if line.startswith("    ")]
        self.assertEqual(sum(len(door.commands) for door in start.doors(README)), len(lines))

    def test_what_it_is_ends_at_the_first_picture(self) -> None:
        self.assertEqual(start.about("# T\n\nfirst [1]\n\nsecond\n\n![p](p.svg)\n\nthird\n"), "first\n\nsecond")


class Bar(unittest.TestCase):
    ENTRIES = [layout.Entry("Start", "index.html"), layout.Entry("Results", "results.html", "reports/")]

    def test_where_one_is(self) -> None:
        self.assertIn('<a href="../results.html" aria-current=page>Results</a>', layout.bar("reports/a.html", self.ENTRIES))
        self.assertIn('<a href="index.html" aria-current=page>Start</a>', layout.bar("index.html", self.ENTRIES))
        self.assertNotIn("aria-current", layout.bar("commands.html", self.ENTRIES))

    def test_headings_of_a_page(self) -> None:
        body = '<h2 id="a">A <code>x</code></h2><section id="b"><h2>B</h2><h3 id="d">D</h3></section><h2 id="c">C</h2>'
        shown = layout.contents(body)
        for link in ('<a href="#a">A x</a>', '<a href="#b">B</a>', '<a href="#c">C</a>'):
            self.assertIn(link, shown)
        self.assertNotIn("#d", shown)
        self.assertEqual(layout.contents('<h2 id="a">A</h2>'), "")


class Indexing(unittest.TestCase):
    def places(self, body: str) -> list[tuple[int, str, str, str]]:
        index = Index()
        index.add("a.html", "A", body)
        return index.places

    def test_text_belongs_to_the_heading_above_it(self) -> None:
        self.assertEqual(self.places('<h1 id="t">T</h1><p>one <em>two</em></p><h2 id="h">H &amp; <code>x</code></h2><p>three</p><script>no'
                                     '</script>'), [(0, "t", "T", "one two"), (0, "h", "H & x", "three")])

    def test_the_heading_of_a_section_has_the_anchor_of_the_section(self) -> None:
        self.assertEqual(self.places('<section id="s"><h2>S</h2><p>in it</p></section>'), [(0, "s", "S", "in it")])

    def test_figures_of_tables_are_left_out_and_their_words_are_not(self) -> None:
        self.assertEqual(self.places("<p>a</p><table><tr><td>SiFH</td><td>40.56 %</td><td>x<br>y</td></tr></table>"),
                         [(0, "", "", "a SiFH xy")])

    def test_a_row_with_an_anchor_is_a_place(self) -> None:
        self.assertEqual(self.places('<h1 id="t">T</h1><table><tr id="word-bin"><td>bin</td><td>An <em>interval</em></td></tr></table>'),
                         [(0, "word-bin", "bin", "An interval"), (0, "t", "T", "")])


@unittest.skipIf(missing(), missing() or "")
class InTheBrowser(unittest.TestCase):
    """The pages of this tree, moved elsewhere, opened from the disk."""

    folder: tempfile.TemporaryDirectory[str]
    out: Path
    browser: Browser

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.out, _ = moved_page(Path(cls.folder.name))
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def show(self, page: str, width: int = 1440, height: int = 900) -> None:
        self.browser.complaints.clear()
        self.browser.requests.clear()
        self.browser.window(width, height)
        self.browser.open(self.out / page)

    def search(self, words: str) -> list[list[str]]:
        """Types the words; heading, page, address, and text of each place that is found."""
        self.browser.evaluate("(() => { const input = document.querySelector('form[role=search] input'); input.focus();"
                              f"input.value = {json.dumps(words)}; input.dispatchEvent(new Event('input', {{bubbles: true}})); }})()")
        end = time.monotonic() + 30
        while self.browser.evaluate("document.getElementById('found').textContent") == "" and time.monotonic() < end:
            time.sleep(0.05)
        return self.browser.evaluate(
            "[...document.querySelectorAll('#found a')].map(a => [a.querySelector('strong').textContent,"
            "a.querySelector('small')?.textContent ?? '', new URL(a.href).pathname + new URL(a.href).hash, a.querySelector('p').textContent])")

    def test_a_known_word_is_found_from_every_kind_of_page_at_phone_and_desk_size(self) -> None:
        for page in ("index.html", "reports/area.html", "documents/docs/reference/blocks/pointer.html"):
            for width, height in ((390, 844), (1440, 900)):
                with self.subTest(page=page, width=width):
                    self.show(page, width, height)
                    found = self.search("walk error")
                    self.assertGreater(len(found), 2)
                    self.assertEqual(found[0][:2], ["walk error", "Glossary"])
                    self.assertTrue(found[0][2].endswith("documents/docs/reference/glossary.html#word-walk-error"), found[0])
                    self.assertTrue(any("reports/walk_error.html" in address for _, _, address, _ in found))
                    box = self.browser.evaluate("(r => [r.left, r.right, r.bottom])(document.getElementById('found').getBoundingClientRect())")
                    self.assertGreaterEqual(box[0], 0)
                    self.assertLessEqual(box[1], width)
                    self.assertLessEqual(box[2], height)
                    self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)
                    self.assertEqual(self.browser.complaints, [])

    def test_every_word_has_to_be_there_and_is_marked(self) -> None:
        self.show("index.html")
        found = self.search("POOLPOINTER lean netlist")
        self.assertGreater(len(found), 0)
        for heading, page, _, _ in found:
            self.assertTrue(heading + page, found)
        marked = self.browser.evaluate("[...document.querySelectorAll('#found mark')].map(m => m.textContent.toLowerCase())")
        self.assertLessEqual(set(marked), {"poolpointer", "lean", "netlist"})
        self.assertEqual(self.search("poolpointer zzyzx"), [])
        self.assertIn('Nothing has "poolpointer zzyzx"', self.browser.evaluate("document.getElementById('found').textContent"))

    def test_a_place_that_is_chosen_is_shown(self) -> None:
        self.show("results.html")
        self.search("walk error")
        self.browser.events.clear()
        self.browser.evaluate("document.querySelector('form[role=search]').requestSubmit()")
        while not any(event.get("method") == "Page.loadEventFired" for event in self.browser.events):
            self.browser.note(self.browser.message())
        self.assertIn("glossary.html#word-walk-error", self.browser.evaluate("location.href"))
        self.assertEqual(self.browser.evaluate("document.querySelector('tr:target').cells[0].textContent"), "walk error")

    def test_keys(self) -> None:
        self.show("index.html")
        key = "document.dispatchEvent(new KeyboardEvent('keydown', {{key: '{}', bubbles: true}}))"
        self.browser.evaluate("document.body." + key.format("/").removeprefix("document."))
        self.assertEqual(self.browser.evaluate("document.activeElement.type"), "search")
        self.search("histogram")
        self.assertFalse(self.browser.evaluate("document.getElementById('found').hidden"))
        self.browser.evaluate("document.activeElement." + key.format("Escape").removeprefix("document."))
        self.assertTrue(self.browser.evaluate("document.getElementById('found').hidden"))

    def test_the_index_that_is_missing_is_said(self) -> None:
        (self.out / FILE).rename(self.out / "hidden.js")
        self.addCleanup(lambda: (self.out / "hidden.js").rename(self.out / FILE))
        self.show("index.html")
        self.search("histogram")
        end = time.monotonic() + 10
        while time.monotonic() < end and "is missing" not in self.browser.evaluate("document.getElementById('found').textContent"):
            time.sleep(0.05)
        self.assertIn("search_index.js is missing", self.browser.evaluate("document.getElementById('found').textContent"))

    def test_the_bar_leads_to_every_kind_of_page(self) -> None:
        self.show("reports/area.html")
        links = self.browser.evaluate("[...document.querySelectorAll('header nav a')].map(a => [a.textContent, a.href])")
        self.assertEqual([title for title, _ in links], [entry.title for entry in Site(ROOT, self.out).entries])
        for title, _ in links:
            self.show("reports/area.html")
            self.browser.events.clear()
            self.browser.evaluate(f"[...document.querySelectorAll('header nav a')].find(a => a.textContent === {json.dumps(title)}).click()")
            while not any(event.get("method") == "Page.loadEventFired" for event in self.browser.events):
                self.browser.note(self.browser.message())
            if title == "Playground":  # a page of its own, which leads back
                self.assertTrue(self.browser.evaluate("[...document.links].some(a => a.getAttribute('href') === 'index.html')"))
                continue
            self.assertEqual(self.browser.evaluate("document.querySelector('header [aria-current]').textContent"), title)

    def test_screenshots(self) -> None:
        for name, width, height in (("desk", 1440, 900), ("phone", 390, 844)):
            self.show("documents/docs/reference/glossary.html", width, height)
            self.search("pointer")
            path = SCREENSHOTS / f"search_{name}.png"
            self.browser.screenshot(path, whole=False)
            self.assertGreater(path.stat().st_size, 20_000)


if __name__ == "__main__":
    unittest.main()
