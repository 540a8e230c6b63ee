# SPDX-License-Identifier: Apache-2.0
"""The live plots: what they are made of, their library, and in a browser: a figure under the mouse, filters, pictures instead."""

import functools
import json
import os
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

from figures import staleness, store
from figures.reports import load
from figures.source_tree import SourceTree
from page import library, plots
from page.library import Library
from tests.browser import Browser, missing
from tests.moved_page import NO_LIBRARY, moved_page

ROOT = Path(__file__).resolve().parent.parent.parent
SCREENSHOTS = ROOT / "build" / "report_test"
SIZES = ((390, 844), (1440, 900))
PARETO = "title,read_out,variant,mm2,thesis_mm2,bits_per_pixel\nezPointer,ezPointer,0,1.3201,1.15,14\n\"SiFH, 8-bit counts\",SiFH,1,9.5,,518\n"
SCENES = ("sensor,klux,scene,estimator,pixels,above_3_percent,above_10_percent,relative_rmse\n"
          "thesis,14,room,SiFH,300,0.4,0.1,0.3\nthesis,14,flat 1 m,SiFH,900,0.9,0.9,0.9\nthesis,14,planes,SiFH,100,0,0,0.1\n")
HOSTILE = ("readout,condition,klux,pixels,above_3_percent,above_3_low,above_3_high,above_10_percent,above_10_low,above_10_high\n"
           "poolpointer-lean,fog,50,10,0.5,0.4,0.6,0,0,0.001\nsomething,fog,50,10,1,1,1,1,1,1\n")
REPORTS = ('[report.scenes]\ncommand = "make scenes"\nminutes = 10\npages = ["scenes.md"]\nfiles = ["scenes.csv"]\ninputs = ["a/*"]\n'
           '[report.pareto]\ncommand = "make pareto"\nminutes = 0.1\npages = ["pareto.md"]\ninputs = ["reports/scenes.csv"]\n')


@functools.cache
def plots_here() -> list[plots.Plot]:
    return plots.collect(ROOT)[0]


class Tree(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name, text in {"configurations.toml": (ROOT / "configurations.toml").read_text(encoding="utf-8"), "a/one": "1",
                           "reports/pareto.csv": PARETO, "reports/scenes.csv": SCENES, "reports/reports.toml": REPORTS}.items():
            self.write(name, text)

    def write(self, name: str, text: str) -> None:
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def rows(self, name: str) -> list[plots.Row]:
        return next(plot for plot in plots.collect(self.root)[0] if plot.name == name).rows


class Figures(Tree):
    def record(self, report: str, **figures: str) -> None:
        """Stores figures whose names have __ for dots."""
        store.record(self.root, report, f"make {report}", "1234", {name.replace("__", "."): store.Figure(value) for name, value in figures.items()})

    def test_area_has_the_figures_of_the_file_of_figures(self) -> None:
        self.assertEqual(self.rows("area"), [])
        self.record("pareto", pareto__ezpointer__indoor_above_3_percent="66.89", pareto__ezpointer__indoor_rmse_percent="24.52",
                    pareto__ezpointer__outdoor_above_3_percent="73.29", pareto__ezpointer__outdoor_rmse_percent="25.49",
                    pareto__ezpointer__mm2="1.3201", pareto__ezpointer__bits_per_pixel="14")
        indoor, outdoor = self.rows("area")
        self.assertEqual((indoor.label, indoor.light, indoor.x, indoor.small), ("ezPointer", 14, 1.3201, False))
        self.assertEqual(indoor.values, {plots.ABOVE_3: (66.89, None, None), plots.RMSE: (24.52, None, None)})
        self.assertEqual((indoor.note, outdoor.light), ("1.32 mm2, 14 bits a pixel", 50))
        self.assertEqual(outdoor.figures, {plots.ABOVE_3: "pareto.ezpointer.outdoor_above_3_percent", plots.RMSE: "pareto.ezpointer.outdoor_rmse_percent"})
        # The table says otherwise: the figures count.
        self.record("pareto", pareto__ezpointer__indoor_above_3_percent="12.50", pareto__ezpointer__indoor_rmse_percent="4.00",
                    pareto__ezpointer__mm2="2.5000", pareto__ezpointer__bits_per_pixel="20")
        (changed,) = self.rows("area")
        self.assertEqual((changed.x, changed.note), (2.5, "2.50 mm2, 20 bits a pixel"))
        self.assertEqual(changed.values, {plots.ABOVE_3: (12.5, None, None), plots.RMSE: (4, None, None)})
        self.assertEqual(next(plot for plot in plots.collect(self.root)[0] if plot.name == "area").source, store.FILE)

    def test_a_figure_of_a_scene_counts_instead_of_the_tables_value(self) -> None:
        self.write("reports/scenes.csv", SCENES + "other,14,room,SiFH,300,0.4,0.1,0.3\n")
        self.record("scenes", scenes__sifh__room_14_klux_above_3_percent="41.00")
        for row in self.rows("light"):
            quoted = (row.at["scene"], row.at["sensor"]) == ("room", "thesis")
            self.assertEqual(row.figures, {plots.ABOVE_3: "scenes.sifh.room_14_klux_above_3_percent"} if quoted else {})
            if row.at["scene"] == "room":
                self.assertEqual([row.values[measure][0] for measure in (plots.ABOVE_3, plots.ABOVE_10, plots.RMSE)], [41 if quoted else 40, 10, 30])
        self.assertEqual(next(plot for plot in plots.collect(self.root)[0] if plot.name == "light").source, "reports/scenes.csv")

    def test_figures_and_tables_of_this_tree_agree(self) -> None:
        for table, columns in {"scenes.csv": {"above_3_percent": plots.ABOVE_3, "above_10_percent": plots.ABOVE_10}}.items():
            found = {(row["sensor"], row["scene"], row["klux"], row["estimator"]): row for row in plots.rows_of(ROOT, table)}
            light = next(plot for plot in plots_here() if plot.name == "light")
            quoted = [row for row in light.rows if row.figures]
            self.assertGreater(len(quoted), 4)
            for row in quoted:
                values = found[row.at["sensor"], row.at["scene"], str(row.light), row.label]
                for column, measure in columns.items():
                    self.assertAlmostEqual(row.values[measure][0], 100 * float(values[column]), delta=0.005 + 1e-9, msg=row.figures[measure])

    def test_scenes_together_are_weighted_by_pixels_and_leave_the_flat_targets_out(self) -> None:
        rows = {row.at["scene"]: row for row in self.rows("light")}
        self.assertEqual(len(rows), 4)
        together = rows["all but the flat targets"]
        self.assertAlmostEqual(together.values[plots.ABOVE_3][0], 30)
        self.assertAlmostEqual(together.values[plots.RMSE][0], 100 * ((300 * 0.09 + 100 * 0.01) / 400) ** 0.5)
        self.assertEqual((together.note, rows["room"].values[plots.ABOVE_10][0]), ("all but the flat targets, sensor thesis, 400 pixels", 10))

    def test_conditions_have_intervals_and_titles(self) -> None:
        self.assertEqual(self.rows("hostile"), [])
        self.write("plain.csv", HOSTILE)
        from page.sections import copy_table
        copy_table(self.root / "plain.csv", self.root / "reports/data/hostile_scenes.csv.gz")
        lean, other = self.rows("hostile")
        self.assertEqual((lean.label, lean.x, lean.values[plots.ABOVE_3]), ("poolPointer lean", "fog", (50, 40, 60)))
        found, titles = plots.collect(self.root)
        self.assertEqual((other.label, titles.family(other.label)), ("something", "something"))
        self.assertEqual(titles.marks({"something", "SiFH"})[1]["colour"], plots.UNKNOWN_COLOUR)

    def test_a_variant_has_the_marks_of_its_readout(self) -> None:
        titles = plots.Titles()
        for label, family in {"SiFH, 8-bit counts": "SiFH", "hisPointer v1": "hisPointer v1", "hisPointer pairs": "hisPointer",
                              "matched filter (single pixel)": "matched filter", "poolPointer lean": "poolPointer lean"}.items():
            self.assertEqual(titles.family(label), family)

    def test_a_plot_is_stale_with_the_reports_that_it_reads(self) -> None:
        for name in ("scenes", "pareto"):
            report = load(self.root)[name]
            staleness.begin(self.root, report, SourceTree(self.root))
            staleness.record(self.root, report)
        self.assertEqual(set(plots.stale_lines(self.root).values()), {()})
        self.write("a/one", "2")
        lines = plots.stale_lines(self.root)
        self.assertEqual(lines["pareto"], lines["scenes"])
        self.assertEqual(lines["pareto"], ("scenes: Measured before: changes in a. make scenes (10 minutes) renews these figures.",))

    def test_a_plot_names_the_inputs_and_the_commit_of_its_report(self) -> None:
        report = load(self.root)["scenes"]
        staleness.begin(self.root, report, SourceTree(self.root))
        recorded = staleness.record(self.root, report)
        entry = staleness.measured(self.root)["scenes"]
        found, titles = plots.collect(self.root)
        (written,) = [plot for plot in json.loads(plots.as_script(found, titles).split(" = ", 1)[1].rstrip(";\n"))["plots"] if plot["name"] == "light"]
        self.assertEqual((written["report"], written["command"], written["inputs"], written["commit"]),
                         ("scenes", "make scenes", recorded.digest, entry.commit))
        self.assertEqual(len(recorded.digest), 16)

    def test_every_plot_of_this_tree_names_what_it_was_measured_on(self) -> None:
        known, listed = staleness.measured(ROOT), load(ROOT)
        for plot in plots_here():
            self.assertEqual((plot.command, plot.inputs, plot.commit), (listed[plot.report].command, known[plot.report].digest, known[plot.report].commit))
            self.assertRegex(plot.inputs, r"^[0-9a-f]{16}$")
            self.assertRegex(plot.commit, r"^[0-9a-f]{12}$")
            self.assertTrue(plot.rows)

    def test_the_plots_are_reports_of_the_list(self) -> None:
        listed = load(ROOT)
        for plot, _ in plots.PLOTS:
            self.assertIn(plot.table, listed[plot.report].files)


class Fetching(Tree):
    """With an npm that is none, or another one."""

    def npm(self, script: str) -> Library:
        folder = self.root / "bin"
        folder.mkdir(exist_ok=True)
        (folder / "npm").write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
        (folder / "npm").chmod(0o755)
        with mock.patch.dict(os.environ, {"PATH": f"{folder}:/usr/bin:/bin"}):
            return library.fetch(self.root)

    def install(self, integrity: str) -> str:
        packages = json.dumps({"packages": {"node_modules/chart.js": {"integrity": integrity}}})
        return f"mkdir -p node_modules/chart.js/dist; echo '{packages}' > node_modules/.package-lock.json; touch {library.SCRIPT}"

    def test_without_npm(self) -> None:
        with mock.patch.dict(os.environ, {"PATH": "/nowhere"}):
            self.assertEqual(library.fetch(self.root), Library(None, None, "npm is not installed"))

    def test_npm_that_fails_says_why(self) -> None:
        found = self.npm("echo 'npm error code EINTEGRITY'; exit 1")
        self.assertEqual((found.script, found.why_not), (None, "npm could not fetch it (EINTEGRITY)"))

    def test_another_content_than_the_pinned_one_is_not_taken(self) -> None:
        self.assertIn("could not fetch", self.npm(self.install("sha512-other")).why_not)

    def test_what_is_there_is_not_fetched_again(self) -> None:
        self.assertEqual(self.npm(self.install(library.pinned()["integrity"])).why_not, "")
        self.assertEqual(self.npm("exit 1").script, self.root / library.FOLDER / library.SCRIPT)

    def test_version_and_integrity_are_pinned(self) -> None:
        wanted = json.loads((library.LISTS / "package.json").read_text(encoding="utf-8"))["dependencies"]["chart.js"]
        self.assertRegex(wanted, r"^\d+\.\d+\.\d+$")
        self.assertEqual(library.pinned()["version"], wanted)
        lock = json.loads((library.LISTS / "package-lock.json").read_text(encoding="utf-8"))["packages"]
        for name, package in lock.items():
            if name:
                self.assertTrue(package["integrity"].startswith("sha512-"), name)


class Shown(unittest.TestCase):
    folder: tempfile.TemporaryDirectory[str]
    out: Path
    wrong: list[str]
    browser: Browser

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.out, cls.wrong = moved_page(Path(cls.folder.name), cls.get_library())
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    @classmethod
    def get_library(cls) -> Library:
        return NO_LIBRARY

    def show(self, width: int, height: int) -> None:
        self.browser.complaints.clear()
        self.browser.requests.clear()
        self.browser.window(width, height)
        self.browser.open(self.out / "plots.html")

    def fits(self, width: int) -> None:
        self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), width)


@unittest.skipIf(missing(), missing() or "")
class Pictures(Shown):
    """Where npm is not there."""

    def test_the_page_says_so_and_shows_pictures(self) -> None:
        self.assertEqual(self.wrong, [])
        for width, height in SIZES:
            self.show(width, height)
            self.assertIn("(chart.js) is missing: npm is not installed.", self.browser.evaluate("document.querySelector('main > .missing').textContent"))
            self.assertEqual(self.browser.evaluate("[...document.images].map(i => i.naturalWidth > 0)"), [True])
            self.assertEqual(self.browser.evaluate("document.querySelectorAll('canvas, #filters').length"), 0)
            self.assertEqual(self.browser.complaints, [])
            self.fits(width)


@unittest.skipIf(missing(), missing() or "")
class InTheBrowser(Shown):
    @classmethod
    def get_library(cls) -> Library:
        found = library.fetch(ROOT)
        if "EINTEGRITY" in found.why_not:
            raise AssertionError(found.why_not)
        if found.why_not:
            raise unittest.SkipTest(f"the plots are not live: {found.why_not}")
        return found

    def sets(self, plot: str) -> list[str]:
        return self.browser.evaluate(f"charts.{plot}.data.datasets.map(s => s.label)")

    def check(self, name: str, value: str, on: bool) -> None:
        self.browser.evaluate(f"(box => {{ if (box.checked !== {json.dumps(on)}) box.click(); }})"
                              f"(document.querySelector('#filters [name={name}][value={json.dumps(value)}]'))")

    def choose(self, plot: str, name: str, value: str) -> None:
        self.browser.evaluate(f"(list => {{ list.value = {json.dumps(value)}; list.dispatchEvent(new Event('change')); }})"
                              f"(document.querySelector('#{plot} [name={name}]'))")

    def point_at(self, plot: str, label: str, index: int = 0) -> str:
        """Moves the mouse over a mark; what is shown there."""
        self.browser.evaluate(f"document.querySelector('#{plot} .tip').replaceChildren()")
        x, y = self.browser.evaluate(
            f"(() => {{ const chart = charts.{plot}; chart.canvas.scrollIntoView({{block: 'center'}});"
            f"const set = chart.data.datasets.findIndex(s => s.label === {json.dumps(label)});"
            f"const mark = chart.getDatasetMeta(set).data[{index}], box = chart.canvas.getBoundingClientRect();"
            "return [box.left + mark.x, box.top + mark.y]; })()")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=1, y=1)
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        end = time.monotonic() + 10
        while time.monotonic() < end:
            shown = self.browser.evaluate(f"(tip => tip.hidden ? '' : tip.innerText)(document.querySelector('#{plot} .tip'))")
            if shown:
                return str(shown)
            time.sleep(0.05)
        return ""

    def test_it_fits_and_asks_for_nothing_outside_and_nobody_complains(self) -> None:
        self.assertEqual(self.wrong, [])
        for width, height in SIZES:
            self.show(width, height)
            self.assertEqual(self.browser.complaints, [])
            self.assertEqual([url for url in self.browser.requests if not url.startswith(self.out.as_uri())], [])
            self.fits(width)
            for plot, _ in plots.PLOTS:
                drawn = self.browser.evaluate(f"(c => new Set(new Uint32Array(c.getContext('2d').getImageData(0, 0, c.width, c.height).data"
                                              f".buffer)).size)(charts.{plot.name}.canvas)")
                self.assertGreater(drawn, 20, plot.name)

    def test_the_mouse_over_a_mark_shows_the_figure_and_its_command(self) -> None:
        figure = store.load(ROOT)["pareto.sifh.indoor_above_3_percent"]
        for width, height in SIZES:
            self.show(width, height)
            self.check("readout", "hisPointer", False)  # its variants are near
            shown = self.point_at("area", "SiFH at 14 klux")
            for part in ("SiFH", f"{float(figure.value):.3g} % off by more than 3 %", "14 klux", "mm2", figure.command,
                         "pareto.sifh.indoor_above_3_percent in reports/figures.json"):
                self.assertIn(part, shown)
            left, right = self.browser.evaluate(
                "(r => [r.left, r.right])(document.querySelector('#area .tip').getBoundingClientRect())")
            self.assertGreaterEqual(left, 0)
            self.assertLessEqual(right, width)
            self.fits(width)
            hostile = self.point_at("hostile", "matched filter at 14 klux")
            known = staleness.measured(ROOT)["hostile_scenes"]
            for part in ("make hostile-scenes", "reports/data/hostile_scenes.csv.gz", f"inputs {known.digest}, commit {known.commit}"):
                self.assertIn(part, hostile)

    def test_each_measure_has_its_own_figure(self) -> None:
        self.show(1440, 900)
        self.choose("area", "measure", plots.RMSE)
        figure = store.load(ROOT)["pareto.sifh.indoor_rmse_percent"]
        shown = self.point_at("area", "SiFH at 14 klux")
        for part in (f"{float(figure.value):.3g} % {plots.RMSE}", "pareto.sifh.indoor_rmse_percent in reports/figures.json"):
            self.assertIn(part, shown)
        self.choose("light", "scene", "room")
        shown = self.point_at("light", "histogram", 1)
        self.assertIn("scenes.histogram.room_14_klux_above_3_percent in reports/figures.json", shown)
        self.choose("light", "measure", plots.RMSE)
        self.assertNotIn("reports/figures.json", self.point_at("light", "histogram", 1))

    def test_a_figure_with_an_interval_shows_it(self) -> None:
        self.show(1440, 900)
        self.assertRegex(self.point_at("hostile", "matched filter at 14 klux"), r"[\d.]+ % \[[\d.]+, [\d.]+\] off by more than 3 %")

    def test_a_readout_that_is_not_chosen_has_no_curve(self) -> None:
        for width, height in SIZES:
            self.show(width, height)
            before = self.sets("light")
            self.assertIn("SiFH", before)
            self.check("readout", "SiFH", False)
            self.assertEqual(self.sets("light"), [name for name in before if name != "SiFH"])
            self.assertFalse(any(name.startswith("SiFH") for name in self.sets("area") + self.sets("hostile")))
            self.check("readout", "SiFH", True)
            self.assertEqual(self.sets("light"), before)

    def test_a_light_that_is_not_chosen_has_no_marks(self) -> None:
        self.show(1440, 900)
        self.assertEqual(self.browser.evaluate("charts.light.data.datasets[0].data.map(p => p.x)"), [2, 14, 50, 100])
        self.check("light", "14", False)
        self.assertEqual(self.browser.evaluate("charts.light.data.datasets[0].data.map(p => p.x)"), [2, 50, 100])
        self.assertTrue(all(name.endswith("50 klux") for name in self.sets("area") + self.sets("hostile")))
        self.browser.evaluate("[...document.querySelectorAll('#filters fieldset:nth-of-type(2) button')].find(b => b.textContent === 'none').click()")
        self.assertEqual(self.sets("light"), [])
        self.assertFalse(self.browser.evaluate("document.querySelector('#light .none').hidden"))

    def test_lines_have_intervals_and_the_light_of_the_list(self) -> None:
        self.show(1440, 900)
        self.choose("acquisitions", "light", "50 klux")
        self.choose("acquisitions", "signal", "10 x")
        shown = self.point_at("acquisitions", "hisPointer", 3)
        self.assertRegex(shown, r"hisPointer\n[\d.]+ % \[[\d.]+, [\d.]+\] off by more than 3 %\n50 klux, 1000 acquisitions, signal 10 x, ")
        self.assertIn("make dynamic-range", shown)

    def test_measure_scene_and_axis(self) -> None:
        self.show(1440, 900)
        self.choose("light", "scene", "flat 1 m")
        self.choose("light", "measure", plots.ABOVE_10)
        self.assertIn("flat 1 m", self.point_at("light", "ezPointer"))
        self.assertIn(plots.ABOVE_10, self.point_at("light", "ezPointer"))
        # On the logarithmic axis a figure of 0 stands at the low end, and its text says 0.
        values = self.browser.evaluate("charts.light.data.datasets.flatMap(s => s.data.map(p => [p.y, p.row.values[1][0]]))")
        self.assertTrue(any(value == 0 for _, value in values))
        self.assertTrue(all(y > 0 for y, _ in values))
        self.browser.evaluate("document.querySelector('#light [name=log]').click()")
        for y, value in self.browser.evaluate("charts.light.data.datasets.flatMap(s => s.data.map(p => [p.y, p.row.values[1][0]]))"):
            self.assertEqual(y, value)

    def test_stale_figures_say_so(self) -> None:
        self.show(1440, 900)
        stale = plots.stale_lines(ROOT)
        for plot, _ in plots.PLOTS:
            said = self.browser.evaluate(f"[...document.querySelectorAll('#{plot.name} .stale p')].map(p => p.textContent)")
            self.assertEqual(said, list(stale[plot.report]))
            shown = self.point_at(plot.name, self.sets(plot.name)[0])
            self.assertEqual("Measured before what lies here now." in shown, bool(stale[plot.report]), plot.name)

    def test_keys_go_from_mark_to_mark(self) -> None:
        tip = "(tip => tip.hidden ? '' : tip.innerText.split('\\n')[0])(document.querySelector('#light .tip'))"
        for width, height in SIZES:
            self.show(width, height)
            self.browser.evaluate("charts.light.canvas.focus()")
            seen = []
            for key, code in (("ArrowRight", 39), ("ArrowRight", 39), ("ArrowLeft", 37), ("ArrowLeft", 37)):
                self.browser.call("Input.dispatchKeyEvent", type="rawKeyDown", key=key, windowsVirtualKeyCode=code)
                label, index = self.browser.evaluate("(e => [charts.light.data.datasets[e.datasetIndex].label, e.index])(charts.light.tooltip.getActiveElements()[0])")
                self.assertEqual(self.browser.evaluate(tip), label)
                seen.append((label, index))
            first, last = self.sets("light")[0], self.sets("light")[-1]
            self.assertEqual(seen[:3], [(first, 0), (first, 1), (first, 0)])
            self.assertEqual(seen[3][0], last)
            self.browser.evaluate("charts.light.canvas.blur()")
            self.assertEqual(self.browser.evaluate(tip), "")

    def test_axes_and_marks_are_named(self) -> None:
        self.show(1440, 900)
        titles = self.browser.evaluate("Object.values(charts).map(c => ['x', 'y'].map(a => c.options.scales[a].title?.text ?? ''))")
        above = "pixels off by more than 3 %, in %"
        self.assertEqual(titles, [["area of 200 x 160 pixels, mm2", above], ["background light, klux", above], [above, ""], ["acquisitions of a frame", above]])
        # Each read-out's mark in the list differs from all others.
        chips = self.browser.evaluate("[...document.querySelectorAll('#filters .chip')].map(c => c.toDataURL())")
        self.assertEqual(len(set(chips)), len(chips))
        self.assertGreater(len(chips), 10)
        middles = self.browser.evaluate("Object.fromEntries([...document.querySelectorAll('#filters .chip')].map(c => [c.parentNode.textContent, '#' + "
                                        "[...c.getContext('2d').getImageData(10, 10, 1, 1).data.slice(0, 3)].map(v => v.toString(16).padStart(2, '0')).join('')]))")
        fills = self.browser.evaluate("charts.light.data.datasets.filter(s => !/cross|star/.test(s.pointStyle)).map(s => [s.label, s.pointBackgroundColor])")
        self.assertEqual({label: middles[label] for label, _ in fills if label in middles}, {label: fill for label, fill in fills if label in middles})

    def test_logarithmic_axes_have_round_ticks_whose_labels_do_not_meet(self) -> None:
        expected = {390: ["1", "10", "100"], 1440: ["0.5", "1", "2", "5", "10", "20", "50", "100", "200"]}
        for width, height in SIZES:
            self.show(width, height)
            labels = self.browser.evaluate("Object.values(charts).map(c => ['x', 'y'].filter(a => c.scales[a].type === 'logarithmic')"
                                           ".map(a => c.scales[a].ticks.map(t => [t.label, c.scales[a].getPixelForValue(t.value)])))")
            self.assertEqual([label for label, _ in labels[0][0]], expected[width])
            for axis in (axis for chart in labels for axis in chart):
                self.assertGreaterEqual(len(axis), 2)
                for (label, place), (_, following) in zip(axis, axis[1:]):
                    self.assertRegex(label, r"^(0\.0*)?[125]0*$")
                    self.assertGreater(abs(following - place), 16, axis)

    def test_on_a_phone_what_is_wide_scrolls_and_stays_readable(self) -> None:
        self.show(*SIZES[0])
        self.assertGreaterEqual(self.browser.evaluate("charts.hostile.width"), 560)
        self.browser.open(self.out / "index.html")
        self.assertGreaterEqual(self.browser.evaluate("document.querySelector('.picture img').width"), 700)
        first = "(c => { c.closest('.scroll').scrollLeft = 200; return c.getBoundingClientRect().left; })(document.querySelector('.figures tbody th'))"
        self.assertGreaterEqual(self.browser.evaluate(first), 0)
        self.fits(SIZES[0][0])

    def test_screenshots(self) -> None:
        for width, height in SIZES:
            self.show(width, height)
            self.point_at("area", "poolPointer at 14 klux")
            path = SCREENSHOTS / f"plots_{width}.png"
            self.browser.screenshot(path, whole=False)
            self.assertGreater(path.stat().st_size, 20_000)


if __name__ == "__main__":
    unittest.main()
