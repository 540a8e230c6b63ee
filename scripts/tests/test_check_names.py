# SPDX-License-Identifier: Apache-2.0
"""The RTL's names, and the RTL beside a user's modules of the names that it had without its prefix."""

import subprocess
import tempfile
import unittest
from pathlib import Path

import check_names

ROOT = Path(__file__).resolve().parents[2]
HDL = ROOT / "hdl"


def everyday_names() -> list[str]:
    """Module and package names without the prefix."""
    found = [name for path in check_names.sources(ROOT) for _, name in check_names.names(path.read_text(encoding="utf-8"))]
    return [name.removeprefix(check_names.PREFIX) for name in found if name.startswith(check_names.PREFIX)]


class Names(unittest.TestCase):
    def test_all_names_have_the_prefix(self) -> None:
        self.assertEqual(check_names.problems(ROOT), [])
        self.assertGreater(len(everyday_names()), 50)

    def test_each_kind_of_name_is_found(self) -> None:
        for text, name in (("module controller #(\n", "controller"), ("package pkg;\n", "pkg"), ("  `define ASSERT(x) x\n", "ASSERT"),
                           ("interface bus;\n", "bus"),):
            self.assertEqual([found for _, found in check_names.names(text)], [name])
        for text, name in (("typedef struct packed {\n  logic a;\n} command_t;\n", "command_t"), ("typedef logic [3:0] nibble_t;\n", "nibble_t")):
            self.assertEqual(check_names.names(text + "module a;\n  typedef logic b;\nendmodule\n")[0][1], name)
        self.assertEqual(check_names.names("// module controller\nmodule a ();\n  typedef logic b;\nendmodule\n"), [(2, "a")])
        self.assertEqual(check_names.names('`define DTOF_BEGIN "/*"\nmodule a ();\nendmodule\n`define DTOF_END "*/"\n'),
                         [(1, "DTOF_BEGIN"), (2, "a"), (4, "DTOF_END")])

    def test_a_name_and_a_file_without_the_prefix_are_errors(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "hdl" / "common").mkdir(parents=True)
            (root / "hdl" / "dtof.f").write_text("// own\n+incdir+common\ncontroller.sv\n")
            (root / "hdl" / "controller.sv").write_text("\nmodule controller;\nendmodule\n")
            (root / "hdl" / "common" / "dtof_a.svh").write_text("`define DTOF_A\n`define B\n")
            self.assertEqual(check_names.problems(root), ["hdl/controller.sv: the file's name lacks the prefix dtof_",
                                                          "hdl/controller.sv:2: 'controller' lacks the prefix dtof_",
                                                          "hdl/common/dtof_a.svh:2: 'B' lacks the prefix dtof_"])  # fmt: skip


class BesideAUser(unittest.TestCase):
    """A user's modules come first and last in the list of files. Each tool reports a module of two definitions, so a clash does not pass."""

    user: Path
    clashing: Path

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.user = Path(folder.name) / "user.sv"
        cls.clashing = Path(folder.name) / "clashing.sv"
        module = "module {} (input wire clk, output reg q);\n  always @(posedge clk) q <= !q;\nendmodule\n"
        top = "module soc (input wire clk, output wire q);\n  line_buffer u (.clk(clk), .q(q));\nendmodule\n"
        cls.user.write_text("".join(module.format(name) for name in everyday_names()) + top)
        cls.clashing.write_text(cls.user.read_text() + module.format("dtof_line_buffer"))

    def read(self, *command: str) -> str:
        """What is wrong, or an empty text."""
        done = subprocess.run(command, cwd=HDL, capture_output=True, text=True)
        text = done.stdout + done.stderr
        return text if done.returncode != 0 or "MODDUP" in text else ""

    def verilator(self, *files: str, top: str) -> str:
        return self.read("verilator", "--lint-only", "-Wno-fatal", "-Wno-WIDTH", *files, "--top-module", top)

    def icarus(self, user: Path) -> str:
        return self.read("iverilog", "-g2012", "-t", "null", str(user), "-f", "dtof.f", "-s", "dtof_subsystem", "-s", "soc")

    def yosys(self, *files: str) -> str:
        return self.read("yosys", "-q", "-p", f"read_verilog -sv -Icommon {' '.join(files)}; hierarchy -check -top soc")

    def test_verilator(self) -> None:
        self.assertEqual(self.verilator(str(self.user), "-f", "dtof.f", top="dtof_subsystem"), "")
        self.assertEqual(self.verilator("-f", "dtof.f", str(self.user), top="soc"), "")
        self.assertIn("dtof_line_buffer", self.verilator(str(self.clashing), "-f", "dtof.f", top="soc"))

    def test_icarus(self) -> None:
        self.assertEqual(self.icarus(self.user), "")
        self.assertIn("dtof_line_buffer", self.icarus(self.clashing))

    def test_yosys(self) -> None:
        listed = [line for line in (HDL / "dtof.f").read_text(encoding="utf-8").splitlines() if line.endswith(".sv") and line[0] not in "/+"]
        self.assertEqual(self.yosys(str(self.user), *listed), "")
        self.assertEqual(self.yosys(*listed, str(self.user)), "")
        self.assertIn("dtof_line_buffer", self.yosys(*listed, str(self.clashing)))


if __name__ == "__main__":
    unittest.main()
