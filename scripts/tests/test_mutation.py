# SPDX-License-Identifier: Apache-2.0
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import mutate
from mutation import cpp, cpp_operators, equivalence, remembered, report, rtl, rtl_operators, subsystem
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


def changes(mutants: list[Mutant]) -> set[str]:
    return {mutant.change for mutant in mutants}


class Operators(unittest.TestCase):
    def test_cpp(self):
        found = changes(cpp_operators.mutants("sample.cpp", CPP_SAMPLE))
        for change in ("3 -> 3 + 1", "a < b -> a <= b", "a < b && b != 0 -> a < b || b != 0", "b != 0 -> b == 0",
                       "a < b && b != 0 -> !(a < b && b != 0)", "std::max(a, b) -> std::min(a, b)",
                       "std::max(a, b) >> 1 -> std::max(a, b) >> ((1) + 1)", "++a; -> ;", "++a; -> --a;",
                       "a = std::max(a, b) >> 1; -> ;", "a + b -> a - b",
                       "a == b ? a + b : b -> a == b ? (b) : (a + b)"):  # fmt: skip
            self.assertIn(change, found)

    def test_cpp_leaves_texts_types_and_checks_alone(self):
        lines = {mutant.line for mutant in cpp_operators.mutants("sample.cpp", CPP_SAMPLE)}
        self.assertFalse(lines & {1, 2, 4, 5, 7, 11}, lines)

    def test_rtl(self):
        found = changes(rtl_operators.mutants("sample.sv", RTL_SAMPLE))
        for change in ("7 -> (7 - 1)", "count_q <= 4'd9 -> count_q < 4'd9", "4'd9 -> 4'd10",
                       "in_i[0] && (count_q <= 4'd9) -> 1'b0", "in_i[0] && (count_q <= 4'd9) -> 1'b1",
                       "count_q <= 4'd3; -> ;", "count_q <= count_q + 1'b1; -> ;", "out_o -> !(out_o)", "out_o -> 1'b1",
                       "'0 -> '1", "count_q + 1'b1 -> count_q - 1'b1",
                       "4'd1: count_q <= count_q + 1'b1; 4'd2 -> 4'd2: count_q <= count_q + 1'b1; 4'd1"):  # fmt: skip
            self.assertIn(change, found)

    def test_rtl_leaves_headers_widths_and_checks_alone(self):
        lines = {mutant.line for mutant in rtl_operators.mutants("sample.sv", RTL_SAMPLE)}
        self.assertFalse(lines & {3, 5, 6, 9, 11, 13, 14}, lines)


class Drawing(unittest.TestCase):
    def test_one_mutant_per_statement_and_the_same_for_a_seed(self):
        mutants = cpp_operators.mutants("sample.cpp", CPP_SAMPLE)
        first, again = (list(draw(mutants, 7)) for _ in range(2))
        self.assertEqual(first, again)
        self.assertEqual(len({mutant.place for mutant in first}), len(first))

    def test_other_statements_may_change(self):
        changed = CPP_SAMPLE.replace("++a;", "++a; b = 0;")
        first, second = (
            {mutant.change for mutant in draw(cpp_operators.mutants("sample.cpp", text), 7)}
            for text in (CPP_SAMPLE, changed)
        )
        self.assertLess(first, second)

    def test_refused_mutants_are_replaced(self):
        selection = Selection([(cpp_operators.mutants("sample.cpp", CPP_SAMPLE), 3)], 7)
        before = selection.mutants
        selection.refuse({before[0]})
        self.assertEqual(len(selection.mutants), 3)
        self.assertNotIn(before[0], selection.mutants)

    def test_refused_mutants_are_found_where_the_compiler_writes_whole_paths(self):
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

    def test_survivor_is_reported_as_survivor(self):
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
            report.write_table({"C++": verdicts}, {"C++": 1}, table)
            parts, seeds = report.read_table(table)
            text = report.markdown(parts, seeds)
            self.assertIn("- models/dtof/core/tested.cpp:4 `value + 1 -> value - 1`: NOT EXPLAINED", text)
            self.assertIn("| **C++** | 3 | 2 | 0 | 0 | 1 | 66.7 % |", text)
            self.assertEqual([verdict.state for verdict in parts["C++"]], ["killed", "killed", "survived"])
            self.assertEqual(len(mutate.failures(parts)), 2)

    @staticmethod
    def find(mutants: list[Mutant], change: str) -> Mutant:
        return next(mutant for mutant in mutants if mutant.change == change)

    def test_explanation_needs_the_same_line_and_changes_no_killed_mutant(self):
        mutant = cpp_operators.mutants("tested.cpp", TESTED)[0]
        survived, killed = (Verdict(mutant, state, "") for state in ("survived", "killed"))
        for source, above, state in ((mutant.source, None, "argued equivalent"),
                                     (mutant.source, mutant.above, "argued equivalent"),
                                     (mutant.source, "another line", "survived"),
                                     ("another line", None, "survived")):  # fmt: skip
            known = [Explanation("tested.cpp", mutant.change, source, "because", above, equivalent=True)]
            self.assertEqual(explain(survived, known).state, state)
            self.assertEqual(explain(killed, known), killed)

    def test_an_explanation_outlives_the_line_that_it_is_about_but_no_line_that_is_there(self):
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
    def test_survivor_dead_code_and_killed(self):
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

    def test_proof_of_equivalence(self):
        with tempfile.TemporaryDirectory() as name:
            tree = Path(name)
            file = "hdl/control/toy.sv"
            (tree / file).parent.mkdir(parents=True)
            (tree / file).write_text(TOY)
            for mutated, same in ((TOY.replace("in_i == 4'd3", "!(in_i != 4'd3)"), True),
                                  (TOY.replace("in_i == 4'd3", "in_i == 4'd2"), False)):  # fmt: skip
                proved = equivalence.proved(tree, [file], file, mutated, frozenset({("MODE", 0)}))
                self.assertEqual(proved, same)


class Remembered(unittest.TestCase):
    def test_every_one_is_still_in_its_source(self):
        for folder in ("models", "hdl"):
            self.assertTrue(remembered.load(mutate.ROOT, folder), folder)


class Subsystem(unittest.TestCase):
    def test_every_module_has_mutants_but_those_that_are_tested_elsewhere(self):
        selection = subsystem.select(subsystem.ROOT, 10000, 1)
        found = {Path(mutant.file).name for mutant in selection.mutants}
        there = {path.name for path in (subsystem.ROOT / subsystem.FOLDER).glob("*.sv")}
        self.assertEqual(there - found, set(subsystem.ELSEWHERE))
        self.assertGreater(len(selection.mutants), 200)

    def test_the_first_test_that_fails_kills(self):
        output = "x.cpp:3: Failure\n[  FAILED  ] All/Faults.End/ez_3x3, where GetParam() = ez (5 ms)\n[  FAILED  ] 1 test\n"
        self.assertEqual(subsystem.killer(output), "subsystem_test: All/Faults.End/ez_3x3")
        self.assertEqual(subsystem.killer("Aborted\n"), "subsystem_test ends early")

    def test_a_mutant_is_judged_by_the_tests_and_taken_back(self):
        mutant = Mutant(file="hdl/subsystem/a.sv", line=1, begin=11, end=12, original="b", mutated="c", operator="x", source="",
                        above="", place=0)  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            tree = Path(folder)
            (tree / "hdl/subsystem").mkdir(parents=True)
            (tree / mutant.file).write_text("assign a = b;\n")
            build = subsystem.Build.__new__(subsystem.Build)
            build.tree, build.timeout_s = tree, 1.0
            seen = []
            build.compile = lambda: seen.append((tree / mutant.file).read_text())
            for by, state in (("subsystem_test: T", "killed"), (None, "survived")):
                build.test = lambda timeout_s, by=by: by
                self.assertEqual(build.judge(mutant).state, state)
            self.assertEqual(seen, ["assign a = c;\n"] * 2)
            self.assertEqual((tree / mutant.file).read_text(), "assign a = b;\n")


if __name__ == "__main__":
    unittest.main()
