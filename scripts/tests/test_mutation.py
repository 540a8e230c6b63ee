# SPDX-License-Identifier: Apache-2.0
import argparse
import datetime
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import mutate
from mutation import (
    cpp,
    cpp_operators,
    equivalence,
    explained,
    python_operators,
    remembered,
    report,
    rtl,
    rtl_operators,
    sdc_operators,
    synthesis,
)
from mutation.explained import Explanation, explain
from mutation.mutant import Mutant, Selection, draw
from mutation.schemata import with_mutants
from mutation.verdict import Verdict

CPP_SAMPLE = """// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
constexpr int kLimit = 3;  // a < b in a comment
static_assert(kLimit < 4);
template <int kSize = 2>
int sample(int a, int b) {
  const std::array<int, 2> values{a, b};
  if (a < b && b != 0) {
    a = std::max(a, b) >> 1;
  }
  throw Error(fmt::format("{} < 5", a - 1));
  ++a;
  return a == b ? a + b : b;
}
"""

RTL_SAMPLE = """// SPDX-License-Identifier: Apache-2.0
module sample #(
    parameter int WIDTH = 4
) (
    input  logic [WIDTH-1:0] in_i,
    output logic             out_o
);
  localparam int DRAIN_CLOCKS = 7;
  logic [3:0] count_q;
  assign out_o = in_i[0] && (count_q <= 4'd9);
  `DTOF_ASSERT(a_small, count_q < 4'd10, "no < more")
  generate
    if (WIDTH == 4) begin : g_four
      assign unused = ^count_q;
    end
  endgenerate
  always_ff @(posedge clk_i) begin
    case (count_q)
      4'd1: count_q <= count_q + 1'b1;
      4'd2: if (out_o) count_q <= '0;
      default: count_q <= 4'd3;
    endcase
  end
endmodule
"""

PYTHON_SAMPLE = """# SPDX-License-Identifier: Apache-2.0
\"\"\"Not a < b.\"\"\"
import math
LIMIT = 0.5
SLOW, TYPICAL = "slow", "typical"
def sample(a: int, b: int = 2) -> int:
    if a < b and b not in (0, 3):  # a + b
        a += max(a,  # - or +
                 b) - 1
    if a == 7:
        raise ValueError(f"{a - 1} < " + "5")
    values.sort(reverse=True)
    corner = SLOW if a else "typical"
    return [v // 2 for v in values if not v.setup > v.hold]
if __name__ == "__main__":
    sample(1, 2)
"""

SDC_SAMPLE = """# 0.30 of the period
set share 0.30
foreach port [all_inputs] {
  if {$port ne "clk_i"} { set_input_delay [expr {$share * $period}] $port }
}
set_clock_uncertainty -setup 0.1 [get_clocks clk]
"""


def changes(mutants: list[Mutant]) -> set[str]:
    return {mutant.change for mutant in mutants}


class Operators(unittest.TestCase):
    def test_cpp(self) -> None:
        found = changes(cpp_operators.mutants("sample.cpp", CPP_SAMPLE))
        for change in ("3 -> 3 + 1", "a < b -> a <= b", "a < b && b != 0 -> a < b || b != 0", "b != 0 -> b == 0",
                       "a < b && b != 0 -> !(a < b && b != 0)", "std::max(a, b) -> std::min(a, b)",
                       "std::max(a, b) >> 1 -> std::max(a, b) >> ((1) + 1)", "++a; -> ;", "++a; -> --a;",
                       "a = std::max(a, b) >> 1; -> ;", "a + b -> a - b",
                       "a == b ? a + b : b -> a == b ? (b) : (a + b)"):  # fmt: skip
            self.assertIn(change, found)

    def test_cpp_leaves_texts_types_and_checks_alone(self) -> None:
        lines = {mutant.line for mutant in cpp_operators.mutants("sample.cpp", CPP_SAMPLE)}
        self.assertFalse(lines & {1, 2, 4, 5, 7, 11}, lines)

    def test_rtl(self) -> None:
        found = changes(rtl_operators.mutants("sample.sv", RTL_SAMPLE))
        for change in ("7 -> (7 - 1)", "count_q <= 4'd9 -> count_q < 4'd9", "4'd9 -> 4'd10",
                       "in_i[0] && (count_q <= 4'd9) -> 1'b0", "in_i[0] && (count_q <= 4'd9) -> 1'b1",
                       "count_q <= 4'd3; -> ;", "count_q <= count_q + 1'b1; -> ;", "out_o -> !(out_o)", "out_o -> 1'b1",
                       "'0 -> '1", "count_q + 1'b1 -> count_q - 1'b1",
                       "4'd1: count_q <= count_q + 1'b1; 4'd2 -> 4'd2: count_q <= count_q + 1'b1; 4'd1"):  # fmt: skip
            self.assertIn(change, found)

    def test_rtl_leaves_headers_widths_and_checks_alone(self) -> None:
        lines = {mutant.line for mutant in rtl_operators.mutants("sample.sv", RTL_SAMPLE)}
        self.assertFalse(lines & {3, 5, 6, 9, 11, 13, 14}, lines)

    def test_python(self) -> None:
        mutants = python_operators.mutants("sample.py", PYTHON_SAMPLE)
        found = changes(mutants)
        for change in ("0.5 -> (0.5 * 1.1)", "0.5 -> (0.5 / 2)", "2 -> (2 + 1)", "a < b -> a <= b",
                       "a < b and b not in (0, 3) -> a < b or b not in (0, 3)",
                       "b not in (0, 3) -> b in (0, 3)", "a == 7 -> not (a == 7)", "max -> min", "values.sort(reverse=True) -> pass",
                       "True -> False",
                       "max(a, # - or + b) - 1 -> max(a, # - or + b) + 1", "SLOW -> TYPICAL", '"typical" -> "slow"',
                       'SLOW if a else "typical" -> ("typical") if (a) else (SLOW)', "v // 2 -> v * 2", "v.setup -> v.hold",
                       "not v.setup > v.hold -> (v.setup > v.hold)", "not v.setup > v.hold -> (not (not v.setup > v.hold))",
                       'raise ValueError(f"{a - 1} < " + "5") -> pass'):  # fmt: skip
            self.assertIn(change, found)
        for mutant in mutants:
            compile(PYTHON_SAMPLE[: mutant.begin] + mutant.mutated + PYTHON_SAMPLE[mutant.end :], mutant.change, "exec")

    def test_python_leaves_documentation_messages_types_and_imports_alone(self) -> None:
        mutants = python_operators.mutants("sample.py", PYTHON_SAMPLE)
        self.assertFalse({mutant.line for mutant in mutants} & {1, 2, 3, 15, 16})
        self.assertEqual({mutant.operator for mutant in mutants if mutant.line == 11}, {"statement"})

    def test_names_have_partners_as_they_are_written(self) -> None:
        self.assertEqual(python_operators.other_names("hold_slack"), ["setup_slack"])
        self.assertEqual(python_operators.other_names("SETUP_NS"), ["HOLD_NS"])
        self.assertEqual(set(python_operators.other_names("slow")), {"typical", "fast"})
        self.assertEqual(python_operators.other_names("slower"), [])

    def test_constraints(self) -> None:
        found = {(mutant.line, mutant.change) for mutant in sdc_operators.mutants("sample.sdc", SDC_SAMPLE)}
        self.assertEqual(found, {
            (2, "0.30 -> 0.33"), (2, "0.30 -> 0.15"), (3, "all_inputs -> all_outputs"), (4, "set_input_delay -> set_output_delay"),
            (4, "set_input_delay [expr {$share * $period}] $port -> list"), (6, "-setup -> -hold"), (6, "0.1 -> 0.11"), (6, "0.1 -> 0.05"),
            (6, "set_clock_uncertainty -setup 0.1 [get_clocks clk] -> list")})  # fmt: skip


class Drawing(unittest.TestCase):
    def test_one_mutant_per_statement_and_the_same_for_a_seed(self) -> None:
        mutants = cpp_operators.mutants("sample.cpp", CPP_SAMPLE)
        first, again = (list(draw(mutants, 7)) for _ in range(2))
        self.assertEqual(first, again)
        self.assertEqual(len({mutant.place for mutant in first}), len(first))

    def test_other_statements_may_change(self) -> None:
        changed = CPP_SAMPLE.replace("++a;", "++a; b = 0;")
        first, second = (
            {mutant.change for mutant in draw(cpp_operators.mutants("sample.cpp", text), 7)}
            for text in (CPP_SAMPLE, changed)
        )
        self.assertLess(first, second)

    def test_refused_mutants_are_replaced(self) -> None:
        selection = Selection([(cpp_operators.mutants("sample.cpp", CPP_SAMPLE), 3)], 7)
        before = selection.mutants
        selection.refuse({before[0]})
        self.assertEqual(len(selection.mutants), 3)
        self.assertNotIn(before[0], selection.mutants)

    def test_refused_mutants_are_found_where_the_compiler_writes_whole_paths(self) -> None:
        mutants = cpp_operators.mutants("sample.cpp", CPP_SAMPLE)
        schemata = with_mutants(CPP_SAMPLE, {mutants[0]: 1})
        line = min(schemata.lines[mutants[0]])
        build = object.__new__(cpp.Build)
        build.tree = Path("/some/where/tree")
        for folder in ("..", "/some/where"):
            said = f"{folder}/tree/sample.cpp:{line}:9: error: expected ';'"
            self.assertEqual(build._refused(said, {"sample.cpp": schemata}), {mutants[0]}, folder)


TESTED = """// SPDX-License-Identifier: Apache-2.0
constexpr int kStep = 2;
constexpr int twice(int value) { return value * kStep; }
int unchecked(int value) { return value + 1; }
int main() { return unchecked(0) == 5 || twice(3) != 6 ? 1 : 0; }
"""


class ReportOfCpp(unittest.TestCase):
    """A test program that checks one function and not the other: the report must say so."""

    def test_survivor_is_reported_as_survivor(self) -> None:
        mutants = cpp_operators.mutants("models/dtof/core/tested.cpp", TESTED)
        chosen = [self.find(mutants, change) for change in ("2 -> 2 + 1", "value * kStep -> value / kStep",
                                                            "value + 1 -> value - 1")]  # fmt: skip
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            source, program = folder / "tested.cpp", folder / "tested"
            source.write_text(with_mutants(TESTED, {mutant: i for i, mutant in enumerate(chosen, 1)}).text)
            header = Path(cpp.__file__).parent / "live_mutant.hpp"
            subprocess.run(["g++", "-std=c++20", "-include", header, source, "-o", program], check=True)
            build = mock.Mock(test_program=lambda library: program)
            with mock.patch.dict(cpp.PROGRAMS, {"core": ["core"]}):
                seconds = {"core": cpp.unharmed(build, "core")}
                verdicts = [cpp.judge(build, mutant, number, seconds) for number, mutant in enumerate(chosen, 1)]
            self.assertEqual([verdict.state for verdict in verdicts], ["killed", "killed", "survived"])
            table = folder / "mutants.csv"
            report.write_table({"C++": verdicts}, {"C++": report.Run(1, "2026-01-02")}, table)
            parts, runs = report.read_table(table)
            self.assertEqual(runs, {"C++": report.Run(1, "2026-01-02")})
            text = report.markdown(parts, runs)
            self.assertIn("- models/dtof/core/tested.cpp:4 `value + 1 -> value - 1`: NOT EXPLAINED", text)
            self.assertIn("| **C++** | 3 | 2 | 0 | 0 | 1 | 66.7 % |", text)
            self.assertEqual([verdict.state for verdict in parts["C++"]], ["killed", "killed", "survived"])
            self.assertEqual(len(mutate.failures(parts)), 2)

    @staticmethod
    def find(mutants: list[Mutant], change: str) -> Mutant:
        return next(mutant for mutant in mutants if mutant.change == change)

    def test_explanation_needs_the_same_line_and_changes_no_killed_mutant(self) -> None:
        mutant = cpp_operators.mutants("tested.cpp", TESTED)[0]
        survived, killed = (Verdict(mutant, state, "") for state in ("survived", "killed"))
        for source, above, state in ((mutant.source, None, "argued equivalent"),
                                     (mutant.source, mutant.above, "argued equivalent"),
                                     (mutant.source, "another line", "survived"),
                                     ("another line", None, "survived")):  # fmt: skip
            known = [Explanation("tested.cpp", mutant.change, source, "because", above, equivalent=True)]
            self.assertEqual(explain(survived, known).state, state)
            self.assertEqual(explain(killed, known), killed)

    def test_an_explanation_outlives_the_line_that_it_is_about_but_no_line_that_is_there(self) -> None:
        mutant = cpp_operators.mutants("tested.cpp", TESTED)[0]
        argued = Verdict(mutant, "argued equivalent", "because")
        with tempfile.TemporaryDirectory() as name:
            self.assertEqual(explain(argued, [], Path(name)), argued)
            (Path(name) / "tested.cpp").write_text(TESTED)
            self.assertEqual(explain(argued, [], Path(name)), Verdict(mutant, "survived", ""))


TOY = """// SPDX-License-Identifier: Apache-2.0
module toy #(
    parameter int MODE = 0
) (
    input  logic [3:0] in_i,
    output logic       seen_o,
    output logic       unseen_o
);
  assign seen_o = (in_i == 4'd3);
  assign unseen_o = (in_i != 4'd5);
  generate
    if (MODE != 0) begin : g_other
      logic other;
      assign other = (in_i > 4'd9);
    end
  endgenerate
endmodule
"""

TOY_BENCH = """// SPDX-License-Identifier: Apache-2.0
module toy_bench;
  logic [3:0] value;
  logic seen, unseen;
  toy u_toy (.in_i(value), .seen_o(seen), .unseen_o(unseen));
  initial begin
    value = 4'd3;
    #1 if (seen !== 1'b1) $display("DTOF_FAIL");
    else $display("DTOF_PASS frames 1 results 1 clocks 1");
  end
endmodule
"""


class ReportOfRtl(unittest.TestCase):
    def test_survivor_dead_code_and_killed(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            tree = Path(name)
            file = "hdl/control/toy.sv"
            (tree / file).parent.mkdir(parents=True)
            (tree / file).write_text(TOY)
            (tree / "bench.sv").write_text(TOY_BENCH)
            case = mock.Mock(frames=(1,), title="toy")
            bench = rtl.Bench(case, tree, ("iverilog", "-g2012", "-s", "toy_bench", "bench.sv", file))
            bench = rtl.measured(bench, tree)
            self.assertEqual(bench.parameters["toy"], {frozenset({("MODE", 0)})})
            mutants = rtl_operators.mutants(file, TOY)
            wanted = {"in_i == 4'd3 -> in_i != 4'd3": "killed", "in_i != 4'd5 -> in_i == 4'd5": "survived",
                      "in_i > 4'd9 -> in_i <= 4'd9": "proved equivalent"}  # fmt: skip
            for change, state in wanted.items():
                mutant = next(mutant for mutant in mutants if mutant.change == change)
                self.assertEqual(rtl.judge(mutant, TOY, [bench], tree).state, state, change)
            self.assertEqual((tree / file).read_text(), TOY)

    def test_proof_of_equivalence(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            tree = Path(name)
            file = "hdl/control/toy.sv"
            (tree / file).parent.mkdir(parents=True)
            (tree / file).write_text(TOY)
            for mutated, same in ((TOY.replace("in_i == 4'd3", "!(in_i != 4'd3)"), True),
                                  (TOY.replace("in_i == 4'd3", "in_i == 4'd2"), False)):  # fmt: skip
                proved = equivalence.proved(tree, [file], file, mutated, frozenset({("MODE", 0)}))
                self.assertEqual(proved, same)


class RunOfOnePart(unittest.TestCase):
    """`--only` renews a part of a table whose other parts are older."""

    OLD = ("language,seed,file,line,operator,original,mutated,verdict,by,source,above\n"
           "RTL,7,hdl/common/gone.sv,3,constant,0,1,killed,bench,assign gone = 0;,\n"
           "subsystem,7,hdl/subsystem/gone.sv,3,constant,0,1,survived,,assign gone = 0;,\n")  # fmt: skip

    def run_of(self, reports: Path, verdicts: list[Verdict], status: int) -> tuple[str, str]:
        table = reports / "mutants.csv"
        arguments = argparse.Namespace(only="subsystem", explain=False, seed=2, count=None, jobs=1)
        with mock.patch.object(mutate, "TABLE", table), mock.patch.object(mutate, "judged", return_value=verdicts), \
                mock.patch("builtins.print"):  # fmt: skip
            self.assertEqual(mutate.run(arguments), status)
        return table.read_text(), table.with_suffix(".md").read_text()

    def test_other_parts_and_the_mark_of_a_stale_page_stay(self) -> None:
        file = "hdl/subsystem/dtof_settle.sv"
        mutants = rtl_operators.mutants(file, (mutate.ROOT / file).read_text())
        verdicts = [Verdict(mutants[0], "killed", "subsystem_test: T")]
        with tempfile.TemporaryDirectory() as name:
            reports = Path(name)
            (reports / "mutants.csv").write_text(self.OLD)
            (reports / "mutants.md").write_text("> Measured before: changes in hdl.\n\n# Mutants\n\nold\n")
            table, page = self.run_of(reports, verdicts, 0)
            self.assertTrue(page.startswith("> Measured before: changes in hdl.\n\n# Mutants\n\nWhat "))
            today = datetime.date.today().isoformat()
            self.assertIn("- RTL: seed 7, date unknown; **measured before**: 1 of the 1 changed lines are no longer in the sources\n", page)
            self.assertIn(f"- subsystem: seed 2, measured on {today}; all 1 changed lines are in the sources\n", page)
            self.assertIn("RTL,7,,hdl/common/gone.sv,3,", table)
            self.assertNotIn("hdl/subsystem/gone.sv", table)
            self.assertIn(f"subsystem,2,{today},{file},", table)

    def test_less_than_97_percent_of_the_subsystem_fail(self) -> None:
        file = "hdl/subsystem/dtof_settle.sv"
        mutants = rtl_operators.mutants(file, (mutate.ROOT / file).read_text())[:34]
        for survivors, status in ((1, 0), (2, 1)):  # 97.1 % and 94.1 %
            verdicts = [Verdict(mutant, "survived" if i < survivors else "killed", "because") for i, mutant in enumerate(mutants)]
            with tempfile.TemporaryDirectory() as name, mock.patch.object(mutate, "explain", lambda verdict, _: verdict), \
                    mock.patch.object(mutate, "load"):  # fmt: skip
                self.assertNotIn("Measured before", self.run_of(Path(name), verdicts, status)[1])


class Explained(unittest.TestCase):
    def test_every_explained_line_is_in_its_source(self) -> None:
        for one in explained.load():
            lines = list(map(str.strip, (explained.ROOT / one.file).read_text(encoding="utf-8").splitlines()))
            places = [index for index, line in enumerate(lines) if line == one.source and one.above in (None, lines[index - 1])]
            self.assertTrue(places, f"scripts/mutation/explained.toml: {one.file} no longer has the line {one.source!r}")


class Remembered(unittest.TestCase):
    def test_every_one_is_still_in_its_source(self) -> None:
        for folder in ("models", "hdl", synthesis.PACKAGE):
            self.assertTrue(remembered.load(mutate.ROOT, folder), folder)


FLOW = """def both(a, b):
    return a + b
def twice(a):
    return a * 2
def down(a):
    while a > 0:
        a -= 1
    return a
"""
FLOW_TESTS = """import unittest
from dtof_synth import power
class Figures(unittest.TestCase):
    def test_both(self) -> None:
        self.assertEqual(power.both(1, 2), 3)
    def test_down(self) -> None:
        self.assertEqual(power.down(2), 0)
"""


class Synthesis(unittest.TestCase):
    """A flow of one file, whose function twice() no test checks."""

    FILE = f"{synthesis.PACKAGE}/power.py"

    def judged(self, root: Path, count: int = 100) -> dict[str, Verdict]:
        with mock.patch.object(synthesis, "ROOT", root), mock.patch.object(synthesis.remembered, "load", return_value=[]), \
                mock.patch.object(synthesis, "TREE", ("synth",)), mock.patch.object(synthesis, "FLOW", ("synth",)), \
                mock.patch.object(synthesis, "MORE_TIME_S", 1):  # fmt: skip
            synthesis.imports_of_tests.cache_clear()
            verdicts = synthesis.run(count, 1, root / "work", 1, [self.FILE])
        return {verdict.mutant.change: verdict for verdict in verdicts}

    def test_survivors_are_reported_and_an_interrupted_run_goes_on(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            root = Path(name)
            for folder in (synthesis.PACKAGE, synthesis.TESTS):
                (root / folder).mkdir(parents=True)
                (root / folder / "__init__.py").touch()
            (root / self.FILE).write_text(FLOW)
            tests = root / synthesis.TESTS / "test_power.py"
            tests.write_text(FLOW_TESTS)
            found = self.judged(root)
            self.assertEqual({verdict.mutant.line for verdict in found.values() if verdict.state == "survived"}, {4})
            self.assertIn("test_power.Figures.test_both", {verdict.by for verdict in found.values()})
            with mock.patch.object(synthesis.Trees, "judge", side_effect=AssertionError):
                self.assertEqual(self.judged(root), found)
            tests.write_text(FLOW_TESTS + "    def test_twice(self):\n        self.assertEqual(power.twice(3), 6)\n")
            self.assertEqual({verdict.state for verdict in self.judged(root).values()}, {"killed"})
            tests.write_text(FLOW_TESTS.replace("3)", "4)"))
            with self.assertRaisesRegex(synthesis.MutationError, "test_power fails without a mutant: test_power.Figures.test_both"):
                self.judged(root)

    def test_every_file_has_mutants_and_tests(self) -> None:
        synthesis.imports_of_tests.cache_clear()
        for file in synthesis.FILES:
            self.assertTrue(synthesis.operators(file, (mutate.ROOT / file).read_text(encoding="utf-8")), file)
            self.assertTrue(synthesis.tests_of(file, mutate.ROOT), file)
        self.assertEqual(synthesis.tests_of(f"{synthesis.PACKAGE}/part_costs.py", mutate.ROOT), ["test_part_costs"])

    def test_another_test_makes_verdicts_old_if_it_judges_the_file(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            root = Path(name)
            (root / synthesis.TESTS).mkdir(parents=True)
            for test, text in (("test_a", "from .small import x"), ("test_b", ""), ("small", "")):
                (root / synthesis.TESTS / f"{test}.py").write_text(text)
            synthesis.imports_of_tests.cache_clear()
            before = synthesis.digest(root, ["test_a"])
            (root / synthesis.TESTS / "test_b.py").write_text("b = 1")
            self.assertEqual(synthesis.digest(root, ["test_a"]), before)
            (root / synthesis.TESTS / "small.py").write_text("x = 1")
            self.assertNotEqual(synthesis.digest(root, ["test_a"]), before)

    def test_each_file_has_to_reach_nine_tenths(self) -> None:
        mutants = [Mutant(file=f"{file}.py", line=1, begin=0, end=1, original="a", mutated=str(number), operator="x", source="", above="",
                          place=0) for file in "ab" for number in range(20)]  # fmt: skip
        killed = [mutant.file == "a.py" or int(mutant.mutated) < 17 for mutant in mutants]
        verdicts = [Verdict(mutant, "killed" if one else "survived", "because") for mutant, one in zip(mutants, killed)]
        self.assertEqual(mutate.failures({"synthesis": verdicts}), ["b.py: 85.0 % killed, less than 90 %"])
        self.assertIn("| b.py | 20 | 17 | 0 | 0 | 3 | 85.0 % | 64 to 95 % |", report.summary({"synthesis": verdicts}))

    def test_interval_of_a_share(self) -> None:
        # Wilson's: (p + z2/2n -+ z sqrt(p(1-p)/n + z2/4n2)) / (1 + z2/n); with all of n killed it begins at n / (n + z2).
        for killed, judged, low, high in ((20, 20, 20 / 23.8415, 1), (0, 0, 0, 1), (5, 10, 0.2366, 0.7634)):
            for found, wanted in zip(report.interval(killed, judged), (low, high)):
                self.assertAlmostEqual(found, wanted, places=4)


if __name__ == "__main__":
    unittest.main()
