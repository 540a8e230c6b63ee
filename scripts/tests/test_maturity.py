# SPDX-License-Identifier: Apache-2.0
"""Stages of blocks in a small tree."""

import tempfile
import unittest
from pathlib import Path

import maturity

ROOT = Path(__file__).resolve().parents[2]


class Stages(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name in ("formal", "hdl/technology", "hdl/control", "hdl/subsystem", "docs/reference/blocks"):
            (self.root / name).mkdir(parents=True)
        files = {"technology/sram.sv": "sram", "control/a.sv": "a", "control/b.sv": "b", "subsystem/c.sv": "c"}
        for file, module in files.items():
            (self.root / "hdl" / file).write_text(f"// module text\nmodule {module} (\n);\nendmodule\n")
        (self.root / "hdl/dtof.f").write_text("// all\n+incdir+package\n" + "\n".join(files) + "\n")
        (self.root / "docs/reference/blocks/control.md").write_text("# Control\n\n## `a`\n")
        self.prove("a, c")

    def prove(self, modules: str) -> None:
        (self.root / "formal/proofs.toml").write_text(f'[[proof]]\nmodule = "{modules}"\n[[proof.bug]]\n[[proof.bug]]\n')

    def test_a_stage_needs_proof_and_netlist(self) -> None:
        found = {block.name: block for block in maturity.blocks(self.root)}
        self.assertEqual({name: block.stage for name, block in found.items()}, {"a": 3, "b": 2, "c": 1})
        self.assertEqual(found["a"].earned, "1 proof, 2 planted bugs; netlist timed and simulated")
        self.assertEqual(found["c"].earned, "1 proof, 2 planted bugs; no netlist")
        self.assertIn("| [`a`](blocks/control.md#a) | control | 3 |", maturity.text(list(found.values())))
        self.assertIn("3 blocks: 1 of stage 3, 1 of stage 2, 1 of stage 1.", maturity.text(list(found.values())))

    def test_a_shared_module_that_only_the_subsystem_uses_has_no_netlist(self) -> None:
        (self.root / "hdl/common").mkdir()
        for module in ("d", "e"):
            (self.root / f"hdl/common/{module}.sv").write_text(f"module {module} (\n);\nendmodule\n")
        with (self.root / "hdl/dtof.f").open("a") as files:
            files.write("common/d.sv\ncommon/e.sv\n")
        (self.root / "hdl/subsystem/c.sv").write_text("module c (\n);\n  d u_d ();\n  e u_e ();\nendmodule\n")
        (self.root / "hdl/control/b.sv").write_text("module b (\n);\n  // d is not used\n  e u_e ();\nendmodule\n")
        stages = {block.name: block.stage for block in maturity.blocks(self.root)}
        self.assertEqual({name: stages[name] for name in "de"}, {"d": 1, "e": 2})

    def test_a_module_of_assertions_is_no_block(self) -> None:
        (self.root / "hdl/control/b.sv").write_text("// Rules; synthesis leaves it out.\nmodule b (\n);\nendmodule\n")
        self.assertEqual([block.name for block in maturity.blocks(self.root)], ["a", "c"])

    def test_a_proof_of_a_module_that_is_gone_is_an_error(self) -> None:
        self.prove("a, gone")
        with self.assertRaisesRegex(SystemExit, "proves 'gone', which hdl/dtof.f does not have"):
            maturity.blocks(self.root)


if __name__ == "__main__":
    unittest.main()
