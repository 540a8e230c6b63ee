# SPDX-License-Identifier: Apache-2.0
"""Mutants of hdl/subsystem: how they get into Verilated models, and how they are judged."""

import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path
from unittest import mock

from mutation import rtl_operators, rtl_schemata, subsystem, subsystem_build
from mutation.mutant import Mutant
from mutation.verdict import Verdict

LIVE = """// SPDX-License-Identifier: Apache-2.0
package dtof_pkg;
endpackage
module live #(
    parameter int WIDTH = 8
) (
    input  logic             clk_i,
    input  logic [WIDTH-1:0] in_i,
    output logic [WIDTH-1:0] sum_o,
    output logic [WIDTH-1:0] kept_o,
    output logic [WIDTH-1:0] arm_o
);
  localparam int STEP = 3;
  assign sum_o = in_i + WIDTH'(STEP);
  always_ff @(posedge clk_i) begin
    if (in_i == 8'd5) kept_o <= in_i;
    else kept_o <= 8'd1;
  end
  always_comb begin
    case (in_i)
      8'd5: arm_o = 8'd10;
      8'd6: arm_o = 8'd20;
      default: arm_o = '0;
    endcase
  end
endmodule
"""
LIVE_MAIN = """#include <cstdio>
#include "Vlive.h"
int main() {
  Vlive live;
  live.in_i = 5;
  for (int clock : {0, 1}) { live.clk_i = clock; live.eval(); }
  std::printf("%d %d %d\\n", live.sum_o, live.kept_o, live.arm_o);
}
"""


class LiveMutants(unittest.TestCase):
    """Many mutants in one Verilated model."""

    WANTED = {  # sum, kept and arm for 5
        "in_i + WIDTH'(STEP) -> in_i - WIDTH'(STEP)": "2 5 10",
        "in_i == 8'd5 -> !(in_i == 8'd5)": "8 1 10",
        "kept_o <= in_i; -> ;": "8 0 10",
        "8'd5: arm_o = 8'd10; 8'd6 -> 8'd6: arm_o = 8'd10; 8'd5": "8 5 20",
    }

    def test_each_does_what_its_text_says_and_none_is_the_original(self) -> None:
        mutants = rtl_operators.mutants("hdl/subsystem/live.sv", LIVE)
        chosen = [next(mutant for mutant in mutants if mutant.change == change) for change in self.WANTED]
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            schemata = rtl_schemata.with_mutants(LIVE, {mutant: number for number, mutant in enumerate(chosen, 1)})
            (folder / "live.sv").write_text(rtl_schemata.DEFINITION + schemata.text)
            (folder / "main.cpp").write_text(LIVE_MAIN)
            subprocess.run(["verilator", "--cc", "--exe", "--build", "-O3", "-Wno-lint", "-Wno-fatal", "--x-initial", "0", "--top-module", "live",
                            "--Mdir", "model", "-CFLAGS", "-O0", "live.sv", "main.cpp"],
                           cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
            seen = [subprocess.run([folder / "model/Vlive"], env={"DTOF_LIVE_MUTANT": str(number)}, check=True, capture_output=True, text=True)
                    .stdout.strip() for number in range(len(chosen) + 1)]  # fmt: skip
        self.assertEqual(seen, ["8 5 10", *self.WANTED.values()])

    def test_what_is_computed_before_the_simulation_is_left_out(self) -> None:
        mutants = rtl_operators.mutants("hdl/subsystem/live.sv", LIVE)
        self.assertEqual({mutant.source for mutant in rtl_schemata.apart(LIVE, mutants)}, {"localparam int STEP = 3;"})

    def test_errors_name_mutants(self) -> None:
        mutants = rtl_operators.mutants("hdl/subsystem/live.sv", LIVE)
        mutant = next(mutant for mutant in mutants if mutant.operator == "swapped arms")
        made = {mutant.file: rtl_schemata.with_mutants(LIVE, {mutant: 1})}
        for line in (mutant.line, mutant.line + 1):
            said = f"%Error: ../../hdl/subsystem/live.sv:{line}:9: no constant\n%Warning-WIDTH: ../../hdl/subsystem/live.sv:1:1: x\n"
            self.assertEqual(subsystem_build.named(said, made), {mutant})
        self.assertEqual(subsystem_build.named("%Error: ../../hdl/common/other.sv:20:9: no constant\n", made), set())


# A program in place of the tests: fails by name, hangs, or crashes for some mutants.
PROGRAM = """#!/bin/sh
case "$DTOF_LIVE_MUTANT $1" in
  "1 "*=first) echo "[  FAILED  ] All/First.Test/ez_3x3, where GetParam() = ez (5 ms)"; exit 1 ;;
  "2 "*=-first) echo "[  FAILED  ] Second.Test (5 ms)"; exit 1 ;;
  "3 "*=first) while :; do :; done ;;
  "4 "*=first) exit 134 ;;
esac
"""


class Subsystem(unittest.TestCase):
    def test_every_module_has_mutants_but_the_generated_package(self) -> None:
        selection = subsystem.select(subsystem.ROOT, 100, 1)
        found = Counter(Path(mutant.file).name for mutant in selection.mutants)
        there = {path.name for path in (subsystem.ROOT / subsystem.FOLDER).glob("*.sv")}
        self.assertEqual(there - set(found), {subsystem.GENERATED})
        self.assertEqual(min(found.values()), subsystem.LEAST_OF_FILE)
        self.assertGreaterEqual(len(selection.mutants), 100)
        self.assertEqual(selection.mutants, subsystem.select(subsystem.ROOT, 100, 1).mutants)
        self.assertNotEqual(selection.mutants, subsystem.select(subsystem.ROOT, 100, 2).mutants)

    def test_the_generated_package_is_checked_as_a_whole(self) -> None:
        text = (subsystem.ROOT / subsystem.FOLDER / subsystem.GENERATED).read_text()
        self.assertIn("scripts/generate.py", text)

    def test_mutants_elsewhere_are_judged_by_simulations_and_proofs(self) -> None:
        file = "hdl/subsystem/dtof_reset_synchroniser.sv"
        text = (subsystem.ROOT / file).read_text()
        mutants = rtl_operators.mutants(file, text)
        with tempfile.TemporaryDirectory() as folder:
            judge = subsystem.Judge(Path(folder), 1)
            killed = judge.elsewhere(next(mutant for mutant in mutants if mutant.change == "!rst_ni -> 1'b0"))
            self.assertEqual(killed.by, f"scripts/tests: {subsystem.ELSEWHERE[Path(file).name][0]}")
            same = Mutant(file=file, line=1, begin=text.index("// "), end=text.index("// ") + 3, original="// ", mutated="//  ", operator="x", source="",
                          above="", place=0)  # fmt: skip
            self.assertEqual(judge.elsewhere(same).state, "survived")
            source = Path(folder) / "sources" / file
            source.write_text(text.replace("or negedge rst_ni", ""))
            judge = subsystem.Judge(Path(folder), 1)
            with self.assertRaisesRegex(subsystem.MutationError, "fail without a mutant: test_reset_synchroniser"):
                judge.elsewhere(same)

    def test_tests_elsewhere_are_there(self) -> None:
        for name in {name for tests in subsystem.ELSEWHERE.values() for name in tests}:
            module, _, test = name.partition(".")
            self.assertIn(f"def {test.partition('.')[2]}(self)", (subsystem.ROOT / f"scripts/tests/{module}.py").read_text(), name)

    def test_the_first_test_that_fails_kills(self) -> None:
        output = "x.cpp:3: Failure\n[  FAILED  ] All/Faults.End/ez_3x3, where GetParam() = ez (5 ms)\n[  FAILED  ] 1 test\n"
        self.assertEqual(subsystem_build.killer(output), "subsystem_test: All/Faults.End/ez_3x3")
        self.assertEqual(subsystem_build.killer("Aborted\n"), "subsystem_test ends early")

    def test_mutants_fail_hang_crash_or_survive(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            build = subsystem_build.Build.__new__(subsystem_build.Build)
            build.binary, build.limits = Path(name), {"first": 1, "-first": 1}
            build.program().parent.mkdir()
            build.program().write_text(PROGRAM)
            build.program().chmod(0o755)
            found = [subsystem.by_tests(build, number) for number in range(5)]
            self.assertEqual(found, [None, "subsystem_test: All/First.Test/ez_3x3", "subsystem_test: Second.Test", "subsystem_test hangs",
                                     "subsystem_test ends early"])  # fmt: skip
            build.program().write_text(PROGRAM.replace('"1 ', '"0 '))
            with self.assertRaisesRegex(subsystem_build.MutationError, "fail without a mutant: subsystem_test: All/First.Test"):
                build.measure(("first",))

    def test_a_few_models(self) -> None:
        text = (subsystem.ROOT / subsystem_build.MODELS).read_text()
        found = subsystem_build.fewer_models(text, subsystem.FEW)
        self.assertEqual(tuple(sorted(re.findall(r"^dtof_verilate\((\w+)", found, re.MULTILINE))), tuple(sorted(subsystem.FEW)))
        self.assertNotIn("foreach", found)
        self.assertEqual((subsystem.ROOT / subsystem_build.TESTS).read_text().count("OPTIONS -O1"), 1)
        with self.assertRaisesRegex(subsystem_build.MutationError, "has no subsystem_none"):
            subsystem_build.fewer_models(text, ["subsystem_none"])

    def test_a_mutant_is_planted_and_taken_back(self) -> None:
        mutant = Mutant(file="hdl/subsystem/a.sv", line=1, begin=11, end=12, original="b", mutated="c", operator="x", source="",
                        above="", place=0)  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            tree = Path(folder)
            (tree / "hdl/subsystem").mkdir(parents=True)
            (tree / mutant.file).write_text("assign a = b;\n")
            build = subsystem_build.OneBuild.__new__(subsystem_build.OneBuild)
            build.tree, build.limits, build.original = tree, {"all": 1}, "assign a = b;\n"
            judge = subsystem.Judge(tree, 1)
            seen: list[str] = []
            with mock.patch.object(build, "verilate"), mock.patch.object(build, "digest", lambda: (tree / mutant.file).read_text()), \
                    mock.patch.object(build, "compile", lambda: seen.append((tree / mutant.file).read_text())):
                for by in ("subsystem_test: T", None):
                    with mock.patch.object(build, "test", return_value=by):
                        self.assertEqual(judge.by_build(build, mutant), by)
                self.assertEqual(seen, ["assign a = c;\n"] * 2)
                build.original = "assign a = c;\n"  # the mutant is the same circuit: no test runs
                with mock.patch.object(build, "test", side_effect=AssertionError):
                    self.assertIsNone(judge.by_build(build, mutant))
            self.assertEqual((tree / mutant.file).read_text(), "assign a = b;\n")

    def test_a_survivor_is_equivalent_or_killed_by_a_proof_or_survives(self) -> None:
        mutant = subsystem.select(subsystem.ROOT, 1, 1).mutants[0]
        judge = subsystem.Judge(Path("unused"), 1)
        for same, proof, state in ((True, "", "proved equivalent"), (False, "proof settle: a_ends", "killed"), (False, "", "survived")):
            build = mock.Mock(same_circuit=lambda _, same=same: same)
            with mock.patch.object(judge, "all", return_value=build), mock.patch.object(judge, "proofs", return_value=proof):
                verdict = judge.survivor(mutant)
            self.assertEqual(verdict.state, state)
            self.assertIn(proof, verdict.by)

    def test_an_interrupted_run_goes_on_and_replaces_what_does_not_compile(self) -> None:
        def compiled(mutant: Mutant) -> Verdict:
            judged.append(mutant)
            if mutant == first[0]:
                raise subsystem_build.Invalid
            return Verdict(mutant, "killed", "subsystem_test: T")

        first = subsystem.select(subsystem.ROOT, 1, 1).mutants
        judged: list[Mutant] = []
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(subsystem, "digest", return_value="same"), \
                mock.patch.object(subsystem.Run, "together", lambda _, numbered: set(numbered)), \
                mock.patch.object(subsystem.Judge, "compiled", side_effect=compiled), \
                mock.patch.object(subsystem.Judge, "elsewhere", side_effect=compiled):  # fmt: skip
            found = subsystem.run(1, 1, Path(folder), 1)
            self.assertEqual((len(found), len(judged)), (len(first), len(first) + 1))
            self.assertNotIn(first[0], [verdict.mutant for verdict in found])
            judged.clear()
            self.assertEqual(subsystem.run(1, 1, Path(folder), 1), found)
            self.assertEqual(judged, [])
            with mock.patch.object(subsystem, "digest", return_value="other tests"):
                subsystem.run(1, 1, Path(folder), 1)
            self.assertEqual(len(judged), len(first) + 1)

    def test_a_proof_kills(self) -> None:
        """In a tree of its own, whose dtof_saturating_counter does not saturate."""
        with tempfile.TemporaryDirectory() as name:
            tree = Path(name)
            for part in ("hdl", "formal", "scripts", "synth/dtof_synth"):
                shutil.copytree(subsystem.ROOT / part, tree / part, ignore=shutil.ignore_patterns("__pycache__", "tests"))
            module = tree / "hdl/subsystem/dtof_saturating_counter.sv"

            def failing() -> str:
                command = [sys.executable, "-m", "mutation.proofs", module.stem]
                return subprocess.run(command, cwd=tree / "scripts", capture_output=True, text=True, check=True).stdout.strip()

            self.assertEqual(failing(), "")
            subsystem_build.change(module, "sum[WIDTH] ? {WIDTH{1'b1}}", "sum[WIDTH] ? {WIDTH{1'b0}}")
            self.assertIn("proof saturating_counter: ", failing())


if __name__ == "__main__":
    unittest.main()
