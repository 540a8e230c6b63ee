# SPDX-License-Identifier: Apache-2.0
"""Small runs that confirm reports: in a small project, in which changes are planted; and what the confirming commands of this project cover."""

import unittest
from pathlib import Path

from figures import confirm, reports, staleness
from figures.source_tree import SourceTree
from tests.figures_project import FILES, Project

ROOT = Path(__file__).resolve().parents[2]

SMALL_MEASURE = """\
pareto:
\tmkdir -p build/small/reports
\tif [ -f broken ]; then exit 1; fi
\tif [ -n "$(SMALL)" ]; then sed -n 's/.*return \\(.\\);.*/# Pareto \\1/p' models/dtof/core/b_part.cpp > build/small/reports/pareto.md; fi
"""


class Confirmations(Project):
    """A small run confirms a stale report if it writes the same bytes as a small run made while the report was fresh."""

    def setUp(self) -> None:
        super().setUp()
        self.write(".gitignore", "build\nbroken\n")
        self.write("Makefile", SMALL_MEASURE)
        self.write("scripts/try_targets.toml", "pareto = { minutes = 0.1 }\nsynth = { arguments = 'CONFIGURATIONS=one' }\n")
        self.commit()
        self.measure()

    def confirm(self, name: str = "pareto") -> str:
        return confirm.confirm(self.root, self.reports()[name])

    def line(self, name: str = "pareto") -> str:
        return staleness.first_lines(self.root, self.reports(), SourceTree(self.root)).get(name, "")

    def change(self, returned: str) -> None:
        self.write("models/dtof/core/b_part.cpp", f'#include "dtof/core/b.hpp"\nint b() {{ return {returned}; }}\n')

    def test_a_change_that_alters_no_byte_is_confirmed_and_the_page_says_so(self) -> None:
        self.assertEqual(self.confirm(), "fresh: the digest of its small run is stored")
        self.change("1; int more")
        self.assertEqual(self.stale(), {"pareto": ("models/dtof/core",)})
        self.assertIn("confirmed: ", self.confirm())
        self.assertEqual(self.stale(), {})
        self.assertEqual(self.line(), "> Confirmed: changes in models/dtof/core since this page was measured. `make pareto SMALL=1` writes "
                                      "the same bytes before and after these changes.")
        staleness.mark(self.root, self.reports(), {"pareto": self.line()})
        page = (self.root / "reports/pareto.md").read_text(encoding="utf-8")
        self.assertEqual(staleness.without_mark(page), FILES["reports/pareto.md"])

    def test_where_a_page_is_made_from_data_other_words_change_no_digest(self) -> None:
        report = self.reports()["pareto"]
        before = confirm.digest_of_files(self.root, report)
        self.write("reports/data/pareto.page.json", "{}")
        with_data = confirm.digest_of_files(self.root, report)
        self.assertNotEqual(with_data, before)
        self.write("reports/pareto.md", "# Other words\n")
        self.assertEqual(confirm.digest_of_files(self.root, report), with_data)
        self.write("reports/data/pareto.page.json", "[]")
        self.assertNotEqual(confirm.digest_of_files(self.root, report), with_data)

    def test_a_change_that_alters_a_byte_stays_stale(self) -> None:
        self.confirm()
        self.change("2")
        self.assertIn("stale: `make pareto SMALL=1` writes other bytes", self.confirm())
        self.assertIn("pareto", self.stale())

    def test_what_is_confirmed_is_stale_after_the_next_change_and_is_compared_with_the_measurement(self) -> None:
        self.confirm()
        self.change("1; int more")
        self.confirm()
        self.change("3")
        self.assertIn("pareto", self.stale())
        self.assertIn("other bytes", self.confirm())

    def test_nothing_is_confirmed_without_a_small_run_of_the_measured_inputs(self) -> None:
        self.change("1; int more")
        self.assertIn("no small run was made while it was fresh", self.confirm())
        self.measure("pareto")
        self.confirm()
        self.change("4")
        self.measure("pareto")  # the digest of the small run belongs to other inputs
        self.change("1; int more")
        self.assertIn("no small run was made while it was fresh", self.confirm())

    def test_a_small_run_that_fails_or_leaves_something_out_confirms_nothing(self) -> None:
        self.assertIn("leaves out configurations", self.confirm("area"))
        self.write("broken", "")
        self.assertIn("`make pareto SMALL=1` failed, see build/small/pareto.log", self.confirm())

    def test_a_new_measurement_takes_the_confirmation_away(self) -> None:
        self.confirm()
        self.change("1; int more")
        self.confirm()
        self.measure("pareto")
        self.assertEqual(self.line(), "")
        self.assertEqual(staleness.measured(self.root)["pareto"].confirmed, "")

    def test_another_command_confirms_what_it_stands_for_and_nothing_else(self) -> None:
        text = (self.root / "reports/reports.toml").read_text(encoding="utf-8")
        self.write("reports/reports.toml", text.replace('files = ["area.csv"]', 'files = ["area.csv"]\nconfirm = "cat synth/helper.py"\n'
                                                        'confirm_covers = ["synth/*"]'))
        self.measure()
        self.assertEqual(self.confirm("area"), "fresh: the digest of its small run is stored")
        self.write("synth/flow.py", "import helper\nfrom parts import adder\n\nprint(2)\n")
        self.assertEqual(self.confirm("area"), "confirmed: `cat synth/helper.py` writes the same bytes as before")
        self.assertIn("`cat synth/helper.py` writes the same bytes before and after", self.line("area"))
        self.write("synth/helper.py", "VALUE = 2\n")
        self.assertIn("writes other bytes than before", self.confirm("area"))
        self.write("synth/helper.py", FILES["synth/helper.py"])
        self.write("hdl/a.sv", "module a; wire w; endmodule\n")  # which the command does not stand for
        self.assertIn("writes other bytes than before", self.confirm("area"))

    def test_a_digest_of_another_command_confirms_nothing(self) -> None:
        text = (self.root / "reports/reports.toml").read_text(encoding="utf-8")

        def confirmed_by(command: str, covers: str = "synth/*") -> None:
            self.write("reports/reports.toml", text.replace('files = ["area.csv"]', f'files = ["area.csv"]\nconfirm = "{command}"\n'
                                                            f'confirm_covers = ["{covers}"]'))

        confirmed_by("cat synth/helper.py")
        self.measure()
        self.confirm("area")
        self.write("synth/flow.py", "import helper\nfrom parts import adder\n\nprint(2)\n")
        self.assertIn("confirmed: ", self.confirm("area"))
        confirmed_by("cat synth/helper.py synth/unrelated.py")
        self.assertEqual(self.confirm("area"), "fresh: the digest of its small run is stored")  # for what is confirmed is not stale
        self.write("synth/flow.py", "import helper\nfrom parts import adder\n\nprint(3)\n")
        self.assertIn("confirmed: ", self.confirm("area"))
        self.write("synth/flow.py", "import helper\nfrom parts import adder\n\nprint(4)\n")
        for command, covers in (("cat synth/helper.py", "synth/*"), ("cat synth/helper.py synth/unrelated.py", "synth/**/*")):
            confirmed_by(command, covers)
            self.assertIn("no small run was made while it was fresh", self.confirm("area"))


class OneChanged(SourceTree):
    """The project with another content of one file."""

    def __init__(self, name: str) -> None:
        super().__init__(ROOT)
        if name not in self.files:
            raise FileNotFoundError(name)
        self.known = {name: "changed"}


class Covers(unittest.TestCase):
    """What `synth/elaborated.py` stands for in the reports of this project, and what it does not."""

    FLOW = ("constraints/dtof.sdc", "constraints/margins.sdc", "synth/yosys/4_map.tcl", "synth/sta/timing.tcl", "synth/sram_sizes.csv",
            "synth/dtof_synth/run.py", "synth/dtof_synth/standard_cells.py", "synth/dtof_synth/sram_model.py", "synth/dtof_synth/canonical.py")
    ELABORATED = ("hdl/common/dtof_pkg.sv", "hdl/common/dtof_macros.svh", "hdl/thesis/dtof_controller.sv", "hdl/pool/dtof_pool_pair.sv",
                  "configurations.toml", "readouts.toml", "synth/dtof_synth/configuration.py")

    def test_what_enters_by_elaboration_is_covered_and_nothing_of_the_flow(self) -> None:
        known = {name: report for name, report in reports.load(ROOT).items() if "synth/elaborated.py" in report.confirm}
        self.assertEqual(set(known), {"synth", "power", "layout", "subsystem", "growth", "namings", "scale"})
        # The simulation's time, which the page of `scale` has, depends on the RTL's text.
        timed = {"scale": [file for file in self.ELABORATED if file.startswith("hdl/")]}
        before = {name: (reports.not_covered(report, SourceTree(ROOT)), reports.inputs(report, SourceTree(ROOT)).digest)
                  for name, report in known.items()}
        for file in (*self.FLOW, *self.ELABORATED):
            tree = OneChanged(file)
            for name, report in known.items():
                with self.subTest(file=file, report=name):
                    self.assertNotEqual(reports.inputs(report, tree).digest, before[name][1])
                    self.assertEqual(reports.not_covered(report, tree) == before[name][0],
                                     file in self.ELABORATED and file not in timed.get(name, ()))

    def test_each_report_is_confirmed_by_its_own_netlists_and_stimuli(self) -> None:
        for name, report in reports.load(ROOT).items():
            for command in filter(None, report.confirm.split(" && ")):
                program, argument = command.split()
                self.assertTrue((ROOT / program).is_file())
                self.assertEqual(argument, name)
            self.assertEqual("scripts/stimuli.py" in report.confirm, any("tb_cpp/vectors" in pattern for pattern in report.confirm_covers))

    def test_what_is_simulated_and_not_elaborated_is_not_covered(self) -> None:
        known, before = reports.load(ROOT), SourceTree(ROOT)
        for name, file in (("power", "hdl/technology/behavioural/dtof_sram_1rw.sv"), ("power", "synth/simulation/stream_bench.sv"),
                           ("subsystem", "synth/subsystem/dtof_subsystem_bench.sv"), ("layout", "reports/area.csv")):
            self.assertNotEqual(reports.not_covered(known[name], OneChanged(file)), reports.not_covered(known[name], before))
