# SPDX-License-Identifier: Apache-2.0
"""Measured figures on pages and what makes a report stale: on a small project of its own, in which faults are planted."""

import argparse
import contextlib
import io
import shutil
import subprocess
import sys
import unittest
from pathlib import Path
from unittest import mock

import reports as command
from figures import closure, hand_typed, references, reports, staleness, store, strip, tables
from figures.source_tree import CommitTree, SourceTree
from tests.figures_project import FILES, LIST, Project

ROOT = Path(__file__).resolve().parent.parent.parent

class Staleness(Project):
    def test_what_was_measured_is_fresh_and_what_was_not_is_stale(self) -> None:
        self.assertEqual(self.stale(), {"area": (), "pareto": ()})
        self.measure()
        self.assertEqual(self.stale(), {})

    def test_a_comment_makes_nothing_stale(self) -> None:
        self.measure()
        self.write("hdl/a.sv", "// a comment\n/* and\n another */ module a;\n\nendmodule // end\n")
        self.write("synth/helper.py", '"""Helps others.\n\nMore."""\n# here\nVALUE = 1  # there\n')
        self.write("models/dtof/core/b_part.cpp", '#include "dtof/core/b.hpp"\n// new\nint b() { return /* one */ 1; }\n')
        self.assertEqual(self.stale(), {})

    def test_a_file_that_moves_makes_nothing_stale_unless_it_changes(self) -> None:
        self.measure()
        (self.root / "models/dtof/core/b_part.cpp").unlink()
        self.write("hdl/z.sv", FILES["hdl/a.sv"])
        (self.root / "hdl/a.sv").unlink()
        self.write("tb_cpp/low/b.hpp", FILES["models/dtof/core/b.hpp"])
        (self.root / "models/dtof/core/b.hpp").unlink()
        self.write("tb_cpp/low/b.cpp", '#include "low/b.hpp"\nint b() { return 1; }\n')
        self.write("models/dtof/core/a.cpp", FILES["models/dtof/core/a.cpp"].replace("dtof/core/b.hpp", "low/b.hpp"))
        self.assertEqual(self.stale(), {})
        self.write("tb_cpp/low/b.hpp", "long b();\n")
        self.assertIn("tb_cpp/low", self.stale()["pareto"])

    def test_a_folder_that_goes_and_whose_file_is_elsewhere_too_is_named(self) -> None:
        for folder in ("twin", "other"):
            self.write(f"tb_cpp/{folder}/b.hpp", FILES["models/dtof/core/b.hpp"])
        own = FILES["models/dtof/core/a.cpp"] + '#include "other/b.hpp"\n'
        self.write("models/dtof/core/a.cpp", own + '#include "twin/b.hpp"\n')
        self.measure()
        self.write("models/dtof/core/a.cpp", own)
        self.assertEqual(self.stale(), {"pareto": ("tb_cpp/twin",)})

    def test_a_change_of_an_input_does_and_names_the_place(self) -> None:
        for name, text, expected in (
                ("hdl/a.sv", "module a; wire w; endmodule\n", {"area": ("hdl",)}),
                ("hdl/b.sv", "module b; endmodule\n", {"area": ("hdl",)}),
                ("synth/parts/adder.py", "ADDED = 3\n", {"area": ("synth/parts",)}),
                ("models/dtof/core/b_part.cpp", '#include "dtof/core/b.hpp"\nint b() { return 2; }\n', {"pareto": ("models/dtof/core",)}),
                ("reports/area.csv", "mm2\n1.2\n", {"pareto": ("reports/area.csv",)})):
            with self.subTest(name=name):
                self.measure()
                self.write(name, text)
                self.assertEqual(self.stale(), expected)

    def test_what_no_report_depends_on_does_not(self) -> None:
        self.measure()
        self.write("synth/unrelated.py", "VALUE = 4\n")
        self.write("models/dtof/core/c.hpp", "int c(int);\n")
        self.write("models/dtof/unused/d.hpp", "int d(int);\n")
        self.write("README.md", "text\n")
        self.assertEqual(self.stale(), {})

    def test_a_change_while_the_command_runs_makes_its_report_stale(self) -> None:
        self.measure()
        staleness.begin(self.root, self.reports()["area"], SourceTree(self.root))
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        staleness.record(self.root, self.reports()["area"])
        self.assertEqual(self.stale(), {"area": ("hdl",)})

    def test_an_archive_without_git_has_the_same_digest(self) -> None:
        before = reports.inputs(self.reports()["area"], SourceTree(self.root)).digest
        shutil.rmtree(self.root / ".git")
        self.assertEqual(reports.inputs(self.reports()["area"], SourceTree(self.root)).digest, before)
        with mock.patch.object(subprocess, "run", side_effect=FileNotFoundError("git")):
            staleness.begin(self.root, self.reports()["area"], SourceTree(self.root))
            staleness.record(self.root, self.reports()["area"])
        self.assertEqual(staleness.measured(self.root)["area"].digest, before)

    def test_an_archive_in_the_repository_of_another_project_has_its_own_files(self) -> None:
        self.write(".gitignore", "build/\n")
        kept = SourceTree(self.root).files
        archive = self.root / "build" / "vendored"
        for name in kept:
            (archive / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.root / name, archive / name)
        (archive / "build").mkdir()
        (archive / "build" / "log.txt").write_text("no source\n", encoding="utf-8")
        self.assertIn("hdl/a.sv", kept)
        self.assertEqual(SourceTree(archive).files, kept)

    def test_a_digest_does_not_depend_on_where_the_project_lies(self) -> None:
        before = reports.inputs(self.reports()["area"], SourceTree(self.root)).digest
        moved = self.root.parent / "elsewhere"
        self.root.rename(moved)
        self.assertEqual(reports.inputs(reports.load(moved)["area"], SourceTree(moved)).digest, before)

    def test_a_commit_has_its_own_inputs(self) -> None:
        old = self.commit_of_old_rtl()
        staleness.record_commit(self.root, self.reports()["area"], old)
        one = staleness.stale(self.root, self.reports(), SourceTree(self.root))["area"]
        self.assertEqual(one.places, ("hdl",))
        self.assertEqual(staleness.changed_files(self.root, one, SourceTree(self.root)), ["hdl/a.sv"])
        self.assertEqual(CommitTree(self.root, old).text("hdl/a.sv"), FILES["hdl/a.sv"])

    def commit_of_old_rtl(self) -> str:
        old = self.git("rev-parse", "HEAD")
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        self.commit()
        return old

    def test_nothing_is_recorded_of_a_measurement_that_nobody_began(self) -> None:
        with self.assertRaisesRegex(reports.ReportsError, "run `make synth`"):
            staleness.record(self.root, self.reports()["area"])

    def test_pages_say_that_they_are_stale_and_only_then(self) -> None:
        self.measure()
        known = self.reports()

        def problems() -> list[str]:
            return staleness.unmarked_pages(self.root, known, staleness.first_lines(self.root, known, SourceTree(self.root)))

        self.assertEqual(problems(), [])
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        self.assertEqual(len(problems()), 1)
        self.assertIn("reports/area.md is stale and its first line does not say so", problems()[0])
        staleness.mark(self.root, known, staleness.first_lines(self.root, known, SourceTree(self.root)))
        self.assertEqual(problems(), [])
        text = (self.root / "reports/area.md").read_text(encoding="utf-8")
        self.assertEqual(text, "> Measured before: changes in hdl. `make synth` (40 minutes) renews this page.\n\n# Area\n\ntext\n")
        self.write("synth/helper.py", "VALUE = 2\n")
        self.assertIn("does not say what changed", problems()[0])
        self.measure()
        self.assertIn("is fresh and its first line says that it is not", problems()[0])
        staleness.mark(self.root, known, {})
        self.assertEqual((self.root / "reports/area.md").read_text(encoding="utf-8"), FILES["reports/area.md"])


class List(Project):
    def test_a_report_stands_behind_those_whose_files_it_reads(self) -> None:
        self.write("reports/reports.toml", "[report.pareto]" + LIST.split("[report.pareto]")[1] + LIST.split("[report.pareto]")[0])
        self.assertEqual(list(self.reports()), ["area", "pareto"])
        self.assertEqual(self.reports()["pareto"].after, ("area",))

    def test_what_is_wrong_with_the_list_is_said_in_one_line(self) -> None:
        for text, sentence in ((LIST.replace('"@rtl"', '"@rlt"'), "there is no group 'rlt'"),
                               (LIST.replace("minutes = 40", "hours = 1"), "unknown key 'hours'"),
                               (LIST.replace("minutes = 40\n", ""), "the key 'minutes' is missing"),
                               (LIST.replace('"@rtl"', '"reports/pareto.md"'), "wait for each other")):
            with self.subTest(sentence=sentence):
                self.write("reports/reports.toml", text)
                with self.assertRaisesRegex(reports.ReportsError, sentence):
                    self.reports()

    def test_sources_of_this_project(self) -> None:
        tree = SourceTree(ROOT)
        found = closure.cpp(tree, "studies/scenes/scenes_command.cpp")
        models = {name for name in tree.files if name.startswith("models/dtof/readout/") and name.endswith(".cpp")}
        self.assertLessEqual({"studies/scenes/scene_study.cpp", *models}, found)
        self.assertFalse({name for name in found if "/tests/" in name or name.endswith("claims_command.cpp")})
        self.assertIn("synth/dtof_synth/netlist.py", closure.python(tree, "synth/dtof_synth/batch.py"))
        self.assertNotIn("synth/dtof_synth/orfs.py", closure.python(tree, "synth/dtof_synth/batch.py"))

    def test_every_file_of_reports_belongs_to_a_report_and_every_input_exists(self) -> None:
        tree, known = SourceTree(ROOT), reports.load(ROOT)
        written = {name for report in known.values() for name in report.written}
        kept = {name for name in tree.files if name.startswith("reports/")}
        values = {f"reports/{reports.page_data(page)}" for report in known.values() for page in report.pages}
        self.assertEqual(kept - written - values, {reports.LIST, staleness.DIGESTS, store.FILE})
        measured = {name for report in staleness.measured(ROOT) for name in known[report].written}
        self.assertEqual(measured - kept, set())
        for report in known.values():
            for pattern in report.inputs:
                kind, _, root = pattern.removeprefix("!").partition(":")
                self.assertTrue(root in tree.files if root else tree.matching(kind), f"{report.name}: {pattern}")

    def test_reports_without_rtl_among_their_inputs_run_none(self) -> None:
        scripts = {name: text for name in SourceTree(ROOT).matching("scripts/*") if name.endswith((".mk", ".sh"))
                   for text in [(ROOT / name).read_text(encoding="utf-8")]}
        running = ["scripts/check_adding_a_readout.sh", "scripts/simulate.sh", "scripts/wave.mk"]
        self.assertEqual([name for name, text in scripts.items() if "--engine" in text], running)
        self.assertEqual([name for name, text in scripts.items() if "--engine subsystem" in text], running[-1:])


MEASURE = """\
import sys
from pathlib import Path
from figures import reports, staleness
from figures.source_tree import SourceTree
name = sys.argv[1]
root = Path.cwd()
with open("log.txt", "a") as log:
    log.write(name + " ")
if Path(name + ".broken").exists():
    sys.exit(1)
staleness.begin(root, reports.load(root)[name], SourceTree(root))
if name == "area":
    Path("reports/area.csv").write_text("mm2\\n1.3\\n")
staleness.record(root, reports.load(root)[name])
"""


class Commands(Project):
    """What `make stale`, `make stale-check` and `make reports` say and do."""

    def setUp(self) -> None:
        super().setUp()
        self.write(".gitignore", "log.txt\n*.broken\nbuild\n")
        self.write("measure.py", MEASURE)
        text = LIST
        for target, name in (("synth", "area"), ("pareto", "pareto")):
            text = text.replace(f'"make {target}"', f'"PYTHONPATH={ROOT / "scripts"} {sys.executable} measure.py {name}"')
        self.write("reports/reports.toml", text)
        self.write("README.md", "text\n")
        self.commit()
        self.measure()
        self.enterContext(mock.patch.object(command, "ROOT", self.root))
        self.enterContext(mock.patch.object(command.update_readme, "quoted_reports", lambda root: set()))

    def run_command(self, action, **options: object) -> tuple[int, str]:
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            status = action(argparse.Namespace(**options), self.reports())
        return status, said.getvalue()

    def log(self) -> list[str]:
        path = self.root / "log.txt"
        return path.read_text(encoding="utf-8").split() if path.is_file() else []

    def test_stale_says_what_changed_and_for_how_long_and_nothing_of_what_is_fresh(self) -> None:
        self.assertEqual(self.run_command(command.stale), (0, ""))
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        status, said = self.run_command(command.stale)
        self.assertIn("area: hdl\n    hdl/a.sv\n", said)
        self.assertIn("40 minutes", said)
        self.assertNotIn("pareto: ", said)
        self.assertEqual(status, 0)

    def test_what_the_first_pages_show_and_what_takes_seconds_must_be_fresh(self) -> None:
        self.assertEqual(self.run_command(command.stale_check), (0, ""))
        self.write("models/dtof/core/a.hpp", "int a(int);\n")
        self.assertIn("pareto is stale, and renewing it takes less than two minutes", self.run_command(command.stale_check)[1])
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        status, said = self.run_command(command.stale_check)
        self.assertEqual((status, len(said.splitlines())), (1, 2))
        self.assertIn("area is stale, and the page of results of `make report` shows it", said)

    def test_a_stale_figure_on_the_readme_is_found(self) -> None:
        self.write("reports/reports.toml", (self.root / "reports/reports.toml").read_text().replace("first = true\n", ""))
        store.record(self.root, "area", "make synth", "", {"area.ez.array_mm2": store.Figure("1.3", "mm2")})
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        self.assertEqual(self.run_command(command.stale_check)[0], 0)
        self.write("README.md", "<!--=area.ez.array_mm2-->1.3<!--/--> mm2\n")
        self.assertIn("area is stale, and README.md shows its figures", self.run_command(command.stale_check)[1])

    def test_reports_are_renewed_in_order_and_only_stale_ones(self) -> None:
        self.assertEqual(self.run_command(command.renew, list=False), (0, ""))
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        self.assertEqual(self.run_command(command.renew, list=False)[0], 0)
        self.assertEqual(self.log(), ["area", "pareto"])  # pareto reads what area wrote anew
        self.assertEqual(self.stale(), {})

    def test_renewing_stops_at_a_failure_and_goes_on_there(self) -> None:
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        self.write("pareto.broken", "")
        status, said = self.run_command(command.renew, list=False)
        self.assertEqual(status, 1)
        self.assertIn("error: pareto: ", said)
        (self.root / "pareto.broken").unlink()
        self.assertEqual(self.run_command(command.renew, list=False)[0], 0)
        self.assertEqual(self.log(), ["area", "pareto", "pareto"])

    def test_data_that_is_not_here_is_named_and_its_report_passed_over(self) -> None:
        self.write("reports/reports.toml", (self.root / "reports/reports.toml").read_text().replace(
            'pages = ["pareto.md"]', 'pages = ["pareto.md"]\ndata = ["photons.mat"]'))
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")
        self.assertIn("pareto: photons.mat is not here", self.run_command(command.renew, list=False)[1])
        self.assertEqual(self.log(), ["area"])


class Strippers(unittest.TestCase):
    def same(self, name: str, one: str, other: str) -> bool:
        return strip.stripped(name, one.encode()) == strip.stripped(name, other.encode())

    def test_strings_are_no_comments(self) -> None:
        for name, one, other in (
                ("a.cpp", 'f("http://a");', 'f("http://b");'), ("a.cpp", "f('\"'); // x\ng(\"//1\");", "f('\"');\ng(\"//2\");"),
                ("a.cpp", 'f(R"x(/* 1 */)x");', 'f(R"x(/* 2 */)x");'), ("a.cpp", "x = 1'000; y = 2'000;", "x = 1'000; y = 3'000;"),
                ("a.sv", "a = 8'h0f; // b\nb = 1'b0;", "a = 8'h0f; // b\nb = 1'b1;"),
                ("a.py", "f('# 1')", "f('# 2')"), ("a.py", 'X = """1"""', 'X = """2"""'),
                ("a.tcl", 'puts "#1"', 'puts "#2"'), ("a.csv", "1 # a", "1 # b"), ("a.py", "if x:\n  f()", "if x:\n    pass\nf()")):
            with self.subTest(name=name, one=one):
                self.assertFalse(self.same(name, one, other))

    def test_comments_are(self) -> None:
        for name, one, other in (
                ("a.cpp", "int a;  // 1\n\n", "int a;"), ("a.sv", "a = 8'h0f; /* one\n two */ b = 1;", "a = 8'h0f; b = 1;"),
                ("a.cpp", "char c = '\\''; // it's", "char c = '\\'';"),
                ("a.py", 'def f():\n    """Says."""\n    return 1  # one', "def f():\n    return 1"),
                ("a.tcl", "# x\nputs 1\n", "puts 1"), ("a.toml", "# x\n\na = 1", "a = 1")):
            with self.subTest(name=name, one=one):
                self.assertTrue(self.same(name, one, other))

    def test_what_a_tool_obeys_is_none(self) -> None:
        self.assertFalse(self.same("a.sv", "wire a; // verilator lint_off WIDTH", "wire a;"))
        self.assertFalse(self.same("a.sv", "wire a; /*verilator public*/", "wire a;"))


class Figures(Project):
    def setUp(self) -> None:
        super().setUp()
        store.record(self.root, "synth", "make synth", "12ab", {
            "area.ez.array_mm2": store.Figure("1.3208", "mm2"), "area.his.array_mm2": store.Figure("9.6177", "mm2", ("9.5", "9.7"))})

    def render(self, text: str, check: bool = False) -> tuple[list[str], str]:
        self.write("docs/a.md", text)
        changed = references.render(self.root, SourceTree(self.root), check)
        return changed, (self.root / "docs/a.md").read_text(encoding="utf-8")

    def test_a_page_shows_the_figure(self) -> None:
        for reference, shown in (("area.ez.array_mm2", "1.3208"), ("area.ez.array_mm2:.2f", "1.32"),
                                 ("area.his.array_mm2 - area.ez.array_mm2:.1f", "8.3"),
                                 ("(area.his.array_mm2 / area.ez.array_mm2 - 1) * 100:+.0f", "+628")):
            changed, text = self.render(f"It has <!--={reference}-->9<!--/--> mm2.\n")
            self.assertEqual(changed, ["docs/a.md"])
            self.assertEqual(text, f"It has <!--={reference}-->{shown}<!--/--> mm2.\n")
            self.assertEqual(self.render(text, check=True)[0], [])

    def test_a_page_that_differs_is_found(self) -> None:
        text = "It has <!--=area.ez.array_mm2:.2f-->1.33<!--/--> mm2.\n"
        self.assertEqual(self.render(text, check=True), (["docs/a.md"], text))

    def test_a_reference_that_leads_nowhere_is_refused_with_its_place(self) -> None:
        for text, sentence in (("\n<!--=area.no.array_mm2-->1<!--/-->", "docs/a.md:2: there is no figure 'area.no.array_mm2'"),
                               ("<!--=area.ez.array_mm2:.q-->1<!--/-->", "docs/a.md:1: .* is no reference"),
                               ("<!--=print(1):.2f-->1<!--/-->", "there is no figure"),
                               ("a\n<!--=area.ez.array_mm2-->1\n", "docs/a.md:2: a reference to a figure does not end"),
                               ("<!--=area.ez.array_mm2-->1\n\nlater <!--/-->", "docs/a.md:1: .* does not end")):
            with self.subTest(text=text), self.assertRaisesRegex(reports.ReportsError, sentence):
                self.render(text)

    def test_the_file_keeps_all_that_is_known_of_a_figure(self) -> None:
        one = store.load(self.root)["area.his.array_mm2"]
        self.assertEqual((one.value, one.unit, one.interval, one.report, one.command, one.inputs),
                         ("9.6177", "mm2", ("9.5", "9.7"), "synth", "make synth", "12ab"))
        store.record(self.root, "synth", "make synth", "34cd", {"area.ez.array_mm2": store.Figure("1.4", "mm2")})
        self.assertEqual({name: one.inputs for name, one in store.load(self.root).items()}, {"area.ez.array_mm2": "34cd"})
        with self.assertRaisesRegex(reports.ReportsError, "is a figure of synth, too"):
            store.record(self.root, "power", "make power", "", {"area.ez.array_mm2": store.Figure("1")})
        with self.assertRaisesRegex(reports.ReportsError, "is no name"):
            store.record(self.root, "power", "make power", "", {"area": store.Figure("1")})

    def test_the_figures_of_this_project_are_those_of_its_tables(self) -> None:
        known = store.load(ROOT)
        for report in tables.MAKERS.keys() & staleness.measured(ROOT).keys():
            for name, figure in tables.figures(ROOT, report).items():
                self.assertEqual((known[name].value, known[name].report), (figure.value, report), name)


class HandTyped(unittest.TestCase):
    NAMES = hand_typed.titles(ROOT)

    def found(self, text: str, of_readouts: bool = False) -> list[tuple[int, str]]:
        return [(piece.line, piece.figures[0]) for piece in hand_typed.in_page(text, self.NAMES, of_readouts)]

    def test_planted_figures(self) -> None:
        for text, line, figure in (
                ("poolPointer has 1.14 mm2.", 1, "1.14 mm2"),
                ("Text.\nThe array of\nhisPointer takes 104 mW.", 2, "104 mW"),
                ("one port halves ezPointer's array (0.584 instead of 1.291 mm2)", 1, "0.584 instead of 1.291 mm2"),
                ("* lean: 43 % of the pixels", 1, "43 %"), ("SiFH runs at 351 MHz.", 1, "351 MHz"), ("FiFH misses by 3.4 per cent", 1, "3.4 per cent"),
                ("gains 12.1 +-0.6 % with poolPointer", 1, "12.1 +-0.6 %"),
                ("| read-out | mm2 |\n|---|---:|\n| ezPointer | 1.3 |", 3, "1.3 (mm2)"),
                ("| a | read-out |\n|---|---|\n| 1.2 mm2 | PiFH |", 3, "1.2 mm2"),
                ("Of the array, in mm2 unless said otherwise.\n\n| change | from |\n|---|---|\n| ezPointer, one port | 1.3 |", 5, "1.3 (from)"),
                ("# poolPointer\n\nIt takes 5 % more.", 3, "5 %"), ("## The three steps\n\n| x | mW |\n|---|---|\n| a | 3 |", 5, "3 (mW)")):
            with self.subTest(text=text):
                self.assertEqual(self.found(text), [(line, figure)])

    def test_a_page_of_the_blocks_is_about_readouts(self) -> None:
        self.assertEqual(self.found("**Cost.** 493 um2 of logic."), [])
        self.assertEqual(self.found("**Cost.** 493 um2 of logic.", of_readouts=True), [(1, "493 um2")])

    def test_what_is_none(self) -> None:
        for text in ("poolPointer has <!--=area.poolpointer.array_mm2:.2f-->1.14<!--/--> mm2.", "The cell has 0.7 mm2. ezPointer is small.",
                     "Pixels of hisPointer that are off by more than 3 % and 10 %, at 95 %, 330 MHz", "SiFH has 3 bins.",
                     "the histogram's 10 mm2", "    poolPointer printed 1.14 mm2\n", "```\nSiFH 3 mm2\n```\n",
                     "<!-- results: written by scripts/x.py -->\n| SiFH | 3 mm2 |\n<!-- end of results -->",
                     "`make x` of SiFH says `3 mm2`", "## SiFH\n\ntext\n\n## Other\n\n3 mm2"):
            with self.subTest(text=text):
                self.assertEqual(self.found(text), [])

    def test_this_project_has_none_but_in_dated_notes(self) -> None:
        tree = SourceTree(ROOT)
        self.assertEqual(hand_typed.check(ROOT, tree), [])
        self.assertTrue(hand_typed.in_page(tree.text("docs/notes/poolpointer.md"), self.NAMES))


if __name__ == "__main__":
    unittest.main()
