# SPDX-License-Identifier: Apache-2.0
"""What scripts/formal.py reads from the tools: outputs that are constant 0, and the assertion that fails in a replay. And what twins leave out."""

import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import formal

# Binary AIGER: one input (literal 2), one latch (literal 4, next state 2), then the outputs.
AIGER = "aig 2 1 1 {count} 0\n2\n{outputs}\nc\na comment\n"


class Outputs(unittest.TestCase):
    def never_asserted(self, *outputs: int) -> bool:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "swept.aig"
            file.write_text(AIGER.format(count=len(outputs), outputs="\n".join(map(str, outputs))), encoding="ascii")
            return formal.never_asserted(file)

    def test_only_constant_0_leaves_nothing_to_prove(self) -> None:
        self.assertTrue(self.never_asserted(0))
        self.assertTrue(self.never_asserted(0, 0))
        for outputs in ((1,), (2,), (4,), (0, 1), (4, 0)):  # constant 1, the input, the latch, one of two
            with self.subTest(outputs=outputs):
                self.assertFalse(self.never_asserted(*outputs))

    def test_a_file_without_outputs_proves_nothing(self) -> None:
        self.assertFalse(self.never_asserted())


class Replay(unittest.TestCase):
    def test_both_versions_of_yosys_name_the_assertion(self) -> None:
        for said in ("Warning: Assert minimum_properties.a_smaller (minimum.sv:33.43-33.83) failed.",
                     "Warning: Assertion minimum_properties.a_smaller (minimum.sv:33.43-33.83) failed."):
            self.assertEqual(formal.FAILED.findall(said), ["minimum_properties.a_smaller"])

    def replay(self, log: str) -> str:
        (formal.ROOT / "build").mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(dir=formal.ROOT / "build") as name:
            folder = Path(name)
            (folder / "trace.aiw").write_text("1\n0\n# DONE", encoding="ascii")
            (folder / "model.aig").write_text("aig 2 1 1 1 0\n", encoding="ascii")
            with mock.patch.object(formal, "run_tool", return_value=(log, 1.0)):
                return formal.failing_assertion(mock.Mock(gated_clock=False, free_clock=False), folder)

    def test_a_replay_that_was_stopped_is_no_replay_that_passes(self) -> None:
        self.assertEqual(self.replay("Warning: Assert minimum_properties.a_smaller (minimum.sv:33.43-33.83) failed."), "a_smaller")
        with self.assertRaisesRegex(formal.FormalError, "the replay of the counterexample in build/.* takes more than 300 s"):
            self.replay("")
        with self.assertRaisesRegex(formal.FormalError, "does not fail when it is replayed"):
            self.replay("Executing SIM pass.")


# Two registers beside each other. The assertion inside fails, and each register may begin with another value.
TWIN = """
module part (input logic clk_i, input logic d_i, output logic q_o);
  always_ff @(posedge clk_i) q_o <= q_o ^ d_i;
  always_ff @(posedge clk_i) a_inside: assert (!d_i);
endmodule
module twin (input logic clk_i, input logic d_i);
  logic first, second;
  part u_first (.clk_i(clk_i), .d_i(d_i), .q_o(first));
  part u_second (.clk_i(clk_i), .d_i({other}), .q_o(second));
  always_comb a_same: assert (first == second);
endmodule
"""


class Twins(unittest.TestCase):
    def proved(self, left_open: dict[str, str], other: str = "d_i") -> bool:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "twin.sv").write_text(TWIN.replace("{other}", other), encoding="ascii")
            script = formal.YOSYS_SCRIPT.format(defines="", hdl=formal.HDL, formal=formal.FORMAL, sources="twin.sv", harness="twin", parameters="",
                                                **formal.ONE_CLOCK, **left_open)
            subprocess.run(["yosys", "-q", "-p", script.strip().replace("\n", "; ")], cwd=folder, check=True)
            log = subprocess.run(formal.abc("scorr; write_aiger swept.aig; pdr"), cwd=folder, check=True, capture_output=True, text=True).stdout
            return "Property proved" in log or ("All outputs solved" in log and formal.never_asserted(folder / "swept.aig"))

    def test_twins_begin_alike_and_leave_their_own_assertions_to_others(self) -> None:
        self.assertTrue(self.proved(formal.TWINS))
        self.assertFalse(self.proved(formal.ANY_START))
        self.assertFalse(self.proved({**formal.TWINS, "initial": ""}))
        self.assertFalse(self.proved({**formal.TWINS, "arbitrary": ""}))

    def test_a_difference_between_twins_is_found(self) -> None:
        self.assertFalse(self.proved(formal.TWINS, "!d_i"))


class Quick(unittest.TestCase):
    """What --quick leaves out, and that it leaves out nothing else."""

    def test_a_quick_run_has_each_quick_proof_its_goal_and_its_first_bug(self) -> None:
        for proof in filter(lambda one: one.quick, formal.load_proofs()):
            with self.subTest(proof.name):
                quick, every = formal.jobs_of(proof, True), formal.jobs_of(proof)
                self.assertEqual([job for job in every if job.kind == "bug"][:1], [job for job in quick if job.kind == "bug"])
                self.assertEqual([job for job in every if job.kind == "goal"], [job for job in quick if job.kind == "goal"])
                self.assertEqual([job.parameters for job in quick if job.kind == "prove"], proof.parameters)
                self.assertEqual([job.parameters for job in every if job.kind == "prove"], [*proof.parameters, *proof.long_parameters])

    def test_each_planted_bug_replaces_one_place_of_the_rtl(self) -> None:
        """A quick run plants the first one alone, and only a run of all would miss the place of another."""
        for proof in formal.load_proofs():
            for bug in proof.bugs:
                with self.subTest(proof.name, bug=bug.title):
                    self.assertEqual((formal.HDL / bug.file).read_text(encoding="utf-8").count(bug.find), 1)


if __name__ == "__main__":
    unittest.main()
