# SPDX-License-Identifier: Apache-2.0
"""The page of `make report`: its parts on small examples, and the page of this tree in a browser."""

import gzip
import json
import os
import re
import tempfile
import unittest
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote, urlsplit

import check_pictures
from figures import staleness, store
from figures.reports import load
from figures.source_tree import SourceTree
from page import figures, links, render, sections
from page.commands import commands
from page.site import Site
from tests.browser import Browser, missing
from tests.moved_page import moved_page

ROOT = Path(__file__).resolve().parent.parent.parent
SCREENSHOTS = ROOT / "build" / "report_test"
SIZES = ((1440, 900), (390, 844))  # a desk and a phone


class Folder(unittest.TestCase):
    """A tree with the files that the page needs to know read-outs and commands."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name) / "tree"
        for name in ("configurations.toml", "Makefile", "studies.toml"):
            self.write(name, (ROOT / name).read_text(encoding="utf-8"))
        for makefile in [*ROOT.glob("scripts/*.mk"), *ROOT.glob("synth/*.mk")]:
            self.write(str(makefile.relative_to(ROOT)), makefile.read_text(encoding="utf-8"))

    def write(self, name: str, text: str) -> Path:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def site(self) -> tuple[list[str], Path]:
        out = self.root / "build" / "report"
        return Site(self.root, out).write(), out


class Rendering(unittest.TestCase):
    def html(self, text: str, prefix: str = "") -> str:
        return render.to_html(text, lambda address: None if address == "lost" else f"to/{address}", prefix=prefix)

    def test_anchors_are_githubs(self) -> None:
        text = self.html("# A `b`: c, d_e\n\n## Netlist = RTL = model\n\n## Twice\n\n## Twice\n")
        for anchor in ("a-b-c-d_e", "netlist--rtl--model", "twice", "twice-1"):
            self.assertIn(f'id="{anchor}"', text)
        self.assertIn('<h1 id="x-t">', self.html("# T", "x-"))

    def test_links_and_pictures_follow_and_leave_their_text_where_they_lead_nowhere(self) -> None:
        text = self.html("[here](a.md#b) [gone](lost) ![seen](p.svg) ![unseen](lost)")
        self.assertIn('<a href="to/a.md#b">here</a> gone ', text)
        self.assertIn('<img src="to/p.svg" alt="seen"', text)
        self.assertIn("unseen: the picture is not here", text)

    def test_text_is_escaped_and_tables_scroll(self) -> None:
        text = self.html("a < b & `c <d>`\n\n| x | y |\n|---|---:|\n| 1 | 2 |\n")
        self.assertIn("a &lt; b &amp; <code>c &lt;d&gt;</code>", text)
        self.assertIn('<div class="scroll" tabindex="0"><table>', text)
        self.assertIn("</table></div>", text)

    def test_a_list_follows_its_paragraph(self) -> None:
        self.assertEqual(self.html("a:\n- b\n- c\n").count("<li>"), 2)

    def test_excerpts(self) -> None:
        text = "# T\n\nfirst\n\n## A\n\nin a\n\n### B\n\nin b\n\n## C\n\n### B\n\nb of c\n\n```\n## no heading\n```\n"
        self.assertEqual(render.excerpt(text, ()), "first\n")
        self.assertEqual(render.excerpt(text, ("A",)), "first\n\n## A\n\nin a\n")
        shown = render.excerpt(text, ("C/B",))
        self.assertIn("## C: B\n\nb of c", shown)
        self.assertIn("## no heading", shown)
        self.assertNotIn("in b", shown)


class Links(Folder):
    def problems(self, body: str) -> list[str]:
        self.write("out/index.html", body)
        self.write("out/sub/b.html", '<h2 id="there">b</h2>')
        return links.problems(self.root / "out")

    def test_what_resolves(self) -> None:
        self.assertEqual(self.problems('<p id="a"><a href="#a">x</a><a href="sub/b.html#there">x</a><a href='
                                       '"https://example.org/">x</a></p><link href="data:,">'), [])

    def test_what_does_not(self) -> None:
        for body, sentence in {
                '<a href="#b">x</a>': "#b has no such anchor",
                '<a href="sub/b.html#a">x</a>': "sub/b.html#a has no such anchor",
                '<a href="c.html">x</a>': "c.html does not exist",
                '<img src="c.png">': "c.png does not exist",
                '<img src="https://example.org/a.png">': "is outside of the page's folder",
                '<script src="//example.org/a.js"></script>': "is outside of the page's folder",
                '<a href="/etc/passwd">x</a>': "is outside of the page's folder",
                '<a href="../Makefile">x</a>': "is outside of the page's folder",
                '<p id="a"></p><p id="a"></p>': "the anchor a is there twice"}.items():
            found = self.problems(body)
            self.assertEqual(len(found), 1, body)
            self.assertIn(sentence, found[0])


class Sources(Folder):
    REPORT = sections.Report("walk_error", "Walk", "walk-error", "walk_error.md", "walk/walk_error.md",
                             with_it=(("walk/kept.svg", "kept.svg"),))
    BUILT = "text\n\n![kept one](kept.svg)\n\n![other](other.svg)\n"

    def stamp(self, path: Path, seconds: int) -> Path:
        os.utime(path, (seconds, seconds))
        return path

    def test_reports_keeps_the_text_and_some_pictures(self) -> None:
        self.write("build/walk/walk_error.md", self.BUILT)
        text = sections.for_reports(self.REPORT, self.root)
        self.assertIn("![kept one](kept.svg)", text)
        self.assertNotIn("other.svg", text)
        self.assertIn("*other: this report's command draws the picture", text)

    def test_reports_leaves_out_what_a_report_names_and_says_where_it_is(self) -> None:
        report = sections.Report("a", "A", "a", "a.md", "a/a.md", left_out=("B/.*",), text_only=("C",),
                                 with_it=(("a/kept.csv", "kept.csv"),))
        text = "# T\n\nfirst\n\n## B\n\nof b\n\n### D\n\nd\n\n## C\n\nSays:\n\n| x |\n|---|\n| 1 |\n\nof c\n"
        short = sections.as_committed(report, text)
        note = "*The whole report, with 10 more lines of tables, is what `make a` writes to build/a/a.md; `make report` shows it.*\n"
        self.assertEqual(short, f"# T\n\nfirst\n\n## B\n\nof b\n\n## C\n\nof c\n\n{note}")
        self.assertEqual(sections.as_committed(report, short), short)
        self.assertEqual(sections.as_committed(report, "[t](kept.csv) [u](left.csv) [v](../area.csv)\n"),
                         "[t](kept.csv) `build/a/left.csv` [v](../area.csv)\n")

    def test_a_compressed_table_is_the_same_bytes_each_time(self) -> None:
        source = self.write("build/a.csv", "a,b\n1,2\n")
        for name in ("one.csv.gz", "other.csv.gz"):
            sections.copy_table(source, self.root / name)
        self.assertEqual((self.root / "one.csv.gz").read_bytes(), (self.root / "other.csv.gz").read_bytes())
        self.assertEqual(gzip.decompress((self.root / "one.csv.gz").read_bytes()), source.read_bytes())

    def test_a_table_that_is_compressed_is_not_compressed_again(self) -> None:
        sections.copy_table(self.write("build/a.csv", "a,b\n"), self.root / "build/a.csv.gz")
        sections.copy_table(self.root / "build/a.csv.gz", self.root / "reports/a.csv.gz")
        self.assertEqual(gzip.decompress((self.root / "reports/a.csv.gz").read_bytes()), b"a,b\n")

    def test_the_newer_one_is_shown_but_pictures_where_the_texts_agree(self) -> None:
        self.assertIsNone(sections.chosen(self.REPORT, self.root))
        committed = self.stamp(self.write("reports/walk_error.md", "else\n"), 2000)
        self.assertEqual(sections.chosen(self.REPORT, self.root), committed)
        built = self.stamp(self.write("build/walk/walk_error.md", self.BUILT), 1000)
        self.assertEqual(sections.chosen(self.REPORT, self.root), committed)
        self.stamp(built, 3000)
        self.assertEqual(sections.chosen(self.REPORT, self.root), built)
        self.stamp(self.write("reports/walk_error.md", sections.for_reports(self.REPORT, self.root)), 4000)
        self.assertEqual(sections.chosen(self.REPORT, self.root), built)


class Pages(Folder):
    SUMMARY = "read-out,rmse mm,bias mm,bias before table mm,above 3 %,above 10 %,no distance,cycles\nSiFH,478,-75,-114,40.56 %,5.35 %,0.02 %,1\n"

    def test_without_any_report_each_section_names_its_command(self) -> None:
        wrong, out = self.site()
        self.assertEqual(wrong, [])
        text = (out / "results.html").read_text(encoding="utf-8")
        for report in (sections.FRAME, *sections.SHOWN):
            start = text.index(f'<section id="{report.name}">')
            section = text[start:text.index("</section>", start)]
            self.assertIn(f'Not made yet: <a href="commands.html#make-{report.target}">', section)
        self.assertEqual(text.count("<em>Not made yet.</em>"), len(sections.LISTED))

    def test_figures_of_the_main_job(self) -> None:
        self.write("build/frame/summary.md", "Scene room: 14 klux.\n")
        self.write("build/frame/summary.csv", self.SUMMARY)
        store.record(self.root, "synth", "make synth", "1234", {"area.sifh.array_mm2": store.Figure("14.9061", "mm2"),
                                                                "area.sifh.bits_per_pixel": store.Figure("646")})
        store.record(self.root, "power", "make power", "1234", {"power.sifh.day_mw": store.Figure("104.802", "mW")})
        one, = figures.figures(self.root, self.root / "build/frame")
        self.assertEqual((one.above_3, one.rmse_mm, one.mm2, one.mw, one.bits), ("40.56 %", "478", "14.91", "105", "646"))
        wrong, out = self.site()
        self.assertEqual(wrong, [])
        self.assertIn("draws them", (out / "results.html").read_text(encoding="utf-8"))
        for kind in ("depth", "error"):
            self.write(f"build/frame/sifh_{kind}.png", "picture")
        wrong, out = self.site()
        self.assertEqual(wrong, [])
        text = (out / "results.html").read_text(encoding="utf-8")
        self.assertIn('src="files/build/frame/sifh_error.png"', text)
        self.assertTrue((out / "files/build/frame/sifh_error.png").is_file())

    def test_a_stale_report_says_so_on_every_page_that_shows_it(self) -> None:
        self.write("studies.toml", "[study]\n")
        self.write("reports/reports.toml", '[report.area]\ncommand = "make synth"\nminutes = 40\npages = ["area.md"]\n'
                                           'inputs = ["hdl/*.sv"]\n[report.sram]\ncommand = "make sram"\nminutes = 1\npages = '
                                           '["sram.md"]\ninputs = ["hdl/*.sv"]\n')
        self.write("hdl/a.sv", "module a; endmodule\n")
        for name in ("area", "sram"):
            self.write(f"reports/{name}.md", f"# {name}\n\ntext\n")
            entry = load(self.root)[name]
            staleness.begin(self.root, entry, SourceTree(self.root))
            staleness.record(self.root, entry)
        _, out = self.site()
        self.assertNotIn("Measured before", (out / "results.html").read_text(encoding="utf-8"))
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        _, out = self.site()
        results = (out / "results.html").read_text(encoding="utf-8")
        self.assertEqual(results.count("Measured before: changes in hdl"), 2)  # a section, and the list
        self.assertIn("Measured before: changes in hdl", (out / "reports/sram.html").read_text(encoding="utf-8"))

    def test_a_foreign_folder_is_left_alone(self) -> None:
        mine = self.write("other/thesis.txt", "mine")
        self.assertIn("has other files", Site(self.root, mine.parent).write()[0])
        self.assertTrue(mine.is_file())

    def test_every_report_of_the_list_is_shown(self) -> None:
        listed = load(ROOT)
        self.assertEqual({page for report in listed.values() for page in report.pages},
                         {report.committed for report in sections.ALL})
        first = {report.committed for report in (sections.FRAME, *sections.SHOWN)}
        for report in listed.values():
            self.assertEqual(report.first, bool(first & set(report.pages)), report.name)

    def test_every_command_named_is_one_of_make(self) -> None:
        known = commands(ROOT)
        for report in sections.ALL:
            self.assertIn(report.target, known, report.name)


class Pictures(Folder):
    def test_limits(self) -> None:
        self.write("README.md", "![a](reports/a.svg)\n")
        self.write("reports/a.svg", "x" * 200_000)
        self.assertEqual(check_pictures.problems(self.root, ["README.md", "reports/a.svg"]), [])
        self.write("reports/a.svg", "x" * 200_001)
        self.assertIn("200001 bytes", check_pictures.problems(self.root, ["README.md", "reports/a.svg"])[0])
        self.write("reports/b.png", "")
        self.assertIn("shown by no document", check_pictures.problems(self.root, ["README.md", "reports/b.png"])[0])
        many = [f"reports/{number}.svg" for number in range(11)]
        for name in many:
            self.write(name, "")
        self.write("README.md", "\n".join(f"![a]({name})" for name in many))
        self.assertEqual(check_pictures.problems(self.root, ["README.md", *many]),
                         ["11 pictures under reports/, 10 are allowed"])


@dataclass(frozen=True)
class Visit:
    """What a page did when it was opened at desk size, and then shown at phone size."""

    complaints: list[str]
    requests: list[str]
    broken: list[str]  # pictures
    widths: dict[int, int]  # of the page, by that of the window


@unittest.skipIf(missing(), missing() or "")
class InTheBrowser(unittest.TestCase):
    """Chromium shows the page of this tree, moved elsewhere."""

    folder: tempfile.TemporaryDirectory[str]
    out: Path
    wrong: list[str]
    browser: Browser
    visits: dict[Path, Visit]

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.out, cls.wrong = moved_page(Path(cls.folder.name))
        cls.browser = Browser()
        cls.visits = {}

    @classmethod
    def tearDownClass(cls) -> None:
        cls.browser.__exit__()
        cls.folder.cleanup()

    def show(self, page: Path, width: int = 1280, height: int = 900, dark: bool = False) -> list[str]:
        """What the browser complains about."""
        self.browser.complaints.clear()
        self.browser.requests.clear()
        self.browser.window(width, height, dark)
        self.browser.open(page)
        return self.browser.complaints

    def visit(self, page: Path) -> Visit:
        """Opens the page, once for all tests."""
        if page not in self.visits:
            complaints = self.show(page, *SIZES[0])
            broken = self.browser.evaluate("[...document.images].filter(i => !i.naturalWidth).map(i => i.src)")
            widths = {}
            for width, height in SIZES:
                self.browser.window(width, height)
                widths[width] = self.browser.evaluate("document.documentElement.scrollWidth")
            self.visits[page] = Visit(list(complaints), list(self.browser.requests), broken, widths)
        return self.visits[page]

    def test_every_link_and_anchor_of_every_page_resolves(self) -> None:
        self.assertEqual(self.wrong, [])

    def test_every_page_opens_without_a_complaint_and_asks_for_nothing_outside(self) -> None:
        pages = sorted(self.out.rglob("*.html"))
        self.assertGreater(len(pages), len(sections.SHOWN))
        for page in pages:
            with self.subTest(page=str(page.relative_to(self.out))):
                visit = self.visit(page)
                self.assertEqual((visit.complaints, visit.broken), ([], []))
                for address in visit.requests:
                    self.assertTrue(address.startswith((self.out.as_uri(), "data:", "blob:")), address)

    def test_every_link_of_start_and_results_leads_where_the_browser_finds_it(self) -> None:
        addresses = []
        for name in ("index.html", "results.html"):
            self.show(self.out / name)
            addresses += self.browser.evaluate("[...document.links].map(a => a.href)")
        self.assertGreater(len(addresses), 50)
        anchors: dict[str, set[str]] = {}
        for address in addresses:
            path, _, anchor = address.partition("#")
            self.assertTrue(path.startswith(self.out.as_uri()), address)
            anchors.setdefault(path, set()).add(anchor)
        for path, names in sorted(anchors.items()):
            file = Path(unquote(urlsplit(path).path))
            self.assertTrue(file.is_file(), path)
            if file.suffix == ".html":  # any other would be downloaded
                self.show(file)
                for name in names - {""}:
                    found = self.browser.evaluate(f"!!document.getElementById({json.dumps(name)})")
                    self.assertTrue(found, f"{path}#{name}")

    def test_no_page_is_wider_than_a_phone_or_a_desk(self) -> None:
        for page in sorted(self.out.rglob("*.html")):
            for width, shown in self.visit(page).widths.items():
                with self.subTest(page=str(page.relative_to(self.out)), width=width):
                    self.assertLessEqual(shown, width)

    def test_on_a_phone_tables_break_between_words(self) -> None:
        for page, cells in (("index.html", ".commands .word"), ("results.html", ".scroll tbody td:first-child")):
            self.show(self.out / page, width=390)
            words = self.browser.evaluate(f"""[...document.querySelectorAll({json.dumps(cells)})].flatMap(cell => {{
                const texts = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT), range = document.createRange(), found = [];
                for (let text = texts.nextNode(); text; text = texts.nextNode()) {{
                  for (const {{ 0: word, index }} of text.data.matchAll(/\\S+/g)) {{
                    range.setStart(text, index);
                    range.setEnd(text, index + word.length);
                    found.push([word, range.getClientRects().length]);
                  }}
                }}
                return found;
              }})""")
            self.assertGreater(len(words), 20)
            # In the tables of reports a word may break behind a hyphen, and a word wider than the column may break anywhere.
            may = re.compile(r"\w-\w|.{18}") if page == "results.html" else re.compile(r"(?!)")
            self.assertEqual([word for word, lines in words if lines != 1 and not may.search(word)], [], page)

    def test_on_a_phone_a_command_has_the_whole_width(self) -> None:
        for page in ("index.html", "commands.html"):
            self.show(self.out / page, width=390)
            places = self.browser.evaluate("[...document.querySelectorAll('.commands tbody tr')].map(row => [...row.cells].slice(0, 2).map("
                                           "cell => { const { left, right, top } = cell.getBoundingClientRect(); return [left, right, top]; }))")
            self.assertGreater(len(places), 4)
            for command, does in places:
                self.assertEqual(command[:2], does[:2])
                self.assertGreater(command[1] - command[0], 340)
                self.assertLess(command[2], does[2])

    def test_light_and_dark(self) -> None:
        papers = {}
        for dark in (False, True):
            self.show(self.out / "index.html", dark=dark)
            papers[dark] = self.browser.evaluate("getComputedStyle(document.body).backgroundColor")
        self.assertNotEqual(papers[False], papers[True])

    def test_screenshots(self) -> None:
        for name, page, width, dark in (("start", "index", 1440, False), ("start_dark_phone", "index", 390, True),
                                        ("results", "results", 1440, False), ("results_dark_phone", "results", 390, True)):
            self.show(self.out / f"{page}.html", width=width, dark=dark)
            path = SCREENSHOTS / f"{name}.png"
            self.browser.screenshot(path)
            self.assertGreater(path.stat().st_size, 50_000)

    def test_planted_faults_are_seen(self) -> None:
        """Or else the tests above would say nothing."""
        page = self.out / "planted.html"
        self.addCleanup(page.unlink)
        for body, complaint in {"<script>console.error('planted')</script>": "planted",
                                "<script>throw new Error('thrown')</script>": "thrown",
                                '<img src="none.png">': "ERR_FILE_NOT_FOUND"}.items():
            page.write_text(f"<!DOCTYPE html><title>x</title>{body}", encoding="utf-8")
            self.visits.pop(page, None)
            self.assertTrue(any(re.search(complaint, said) for said in self.visit(page).complaints), body)
        page.write_text('<!DOCTYPE html><title>x</title><p style="width: 500px">wide</p><img src="none.png">', encoding="utf-8")
        del self.visits[page]
        visit = self.visit(page)
        self.assertGreater(visit.widths[390], 390)
        self.assertEqual(len(visit.broken), 1)
        del self.visits[page]


if __name__ == "__main__":
    unittest.main()
