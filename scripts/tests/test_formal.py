# SPDX-License-Identifier: Apache-2.0
"""What scripts/formal.py reads from the tools: outputs that are constant 0, and the assertion that fails in a replay."""

import tempfile
import unittest
from pathlib import Path

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
