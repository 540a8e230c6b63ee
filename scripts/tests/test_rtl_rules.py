# SPDX-License-Identifier: Apache-2.0
"""The rules of the RTL's text find what is planted, and nothing else."""

import subprocess
import tempfile
import unittest
from pathlib import Path

import lint_rtl
import rtl_rules

ROOT = Path(__file__).resolve().parents[2]

MODULE = """
module m #(
    parameter int N = 2
) (
    input  logic         clk_i,
    input  logic [N-1:0] a_i,
    output logic         b_o
);
  // late is a word of this comment
  logic [N-1:0] early, other;
  assign early = a_i;
BEFORE
  logic late;
  assign late = early[0] && other[1];
  assign b_o = late;
endmodule
"""


INCLUDED = {
    "m.svh": '`include "inner.svh"\n`define OUTER `INNER\n',
    "inner.svh": "// `define NEVER\n`define INNER 1\n",
    "shared.svh": "typedef logic [1:0] shared_t;\n",
    "part.svh": "  localparam int PART = 1;\n",
}


def check(text: str) -> list[str]:
    return rtl_rules.check({"hdl/m.sv": text}, INCLUDED)


class Rules(unittest.TestCase):
    def test_what_is_right_passes(self) -> None:
        for line in ("", '  initial $display("late");', "  leaf u_leaf (.late(early[0]));", "  assign other = entry.late;",
                     "  function automatic logic f(input logic late);\n    f = !late;\n  endfunction", "`define USE \\\n  assign early[0] = late;",
                     "  assign other = dtof_pkg::late;"):  # fmt: skip
            self.assertEqual(check(MODULE.replace("BEFORE", line)), [], line)

    def test_a_use_in_front_of_the_declaration_is_found(self) -> None:
        for line in ("  assign other[1] = late;", "  leaf u_leaf (.a_i(late));", "  always_ff @(posedge clk_i) begin\n    if (late) x <= 1;\n  end"):
            found = check(MODULE.replace("BEFORE", line))
            self.assertEqual(len(found), 1, line)
            self.assertRegex(found[0], r"hdl/m\.sv:1[23]: 'late' is used in front of its declaration in line 1[35]")

    def test_every_name_of_a_declaration_counts(self) -> None:
        for declaration in ("logic [N-1:0] first, late;", "dtof_state_t late;", "`DTOF_TYPE(dtof_pkg, state_t) late, last;", "integer late;",
                            "logic signed [3:0][1:0] late;", "logic late [0:3];", "wire late = a_i[0];", "localparam late = 1;",
                            "localparam int late = N - 1, last = 2;", "localparam logic [N-1:0] late = 1;", "dtof_pkg::state_t late;", "bit late;",
                            "typedef enum logic {\n    A,\n    B\n  } late;"):  # fmt: skip
            text = MODULE.replace("BEFORE", "  assign other[1] = late;").replace("logic late;", declaration)
            self.assertEqual(len(check("`define DTOF_TYPE(PACKAGE, NAME) NAME" + text)), 1, declaration)

    def test_a_header_that_includes_is_found(self) -> None:
        found = check(MODULE.replace("BEFORE", "").replace("    input  logic         clk_i,", '    `include "dtof_ports.svh"'))
        self.assertEqual(found, ['hdl/m.sv:5: the header of m includes "dtof_ports.svh"'])
        self.assertEqual(check(MODULE.replace("BEFORE", '  `include "dtof_columns.svh"')), [])

    def test_a_type_of_the_compilation_unit_is_found(self) -> None:
        text = MODULE.replace("BEFORE", "")
        self.assertEqual(check("typedef struct packed {\n  logic a;\n} t;\n" + text), ["hdl/m.sv:1: a type outside of modules and packages"])
        self.assertEqual(check("package p;\n  typedef logic [1:0] t;\nendpackage\n" + text), [])
        self.assertEqual(check('`include "shared.svh"\n' + text), ["shared.svh:1: a type outside of modules and packages"])
        self.assertEqual(check(text.replace("  logic late;", '  `include "part.svh"\n  logic late;')), [])

    def test_other_declarations_of_the_compilation_unit_are_found(self) -> None:
        for line, kind in (("import p::*;", "import"), ("localparam int A = 1;", "declaration"), ("function int f();\nendfunction", "function"),
                           ("wire w;", "declaration")):  # fmt: skip
            for text in (line + MODULE.replace("BEFORE", ""), MODULE.replace("BEFORE", "") + line + "\n"):
                self.assertRegex("".join(check(text)), rf"^hdl/m\.sv:\d+: a {kind} outside of modules and packages$")
        self.assertEqual(check("`define F(x) \\\n  localparam int A = x;\n" + MODULE.replace("BEFORE", "")), [])

    def test_a_macro_that_another_file_defines_is_found(self) -> None:
        text = MODULE.replace("BEFORE", "  assign other[1] = `INNER;")
        self.assertEqual(check(text), ["hdl/m.sv:12: neither this file nor one that it includes defines `INNER"])
        self.assertEqual(len(check('`include "shared.svh"\n' + text)), 2)
        for head in ('`include "inner.svh"', '`include "m.svh"', "`define INNER 0", "`ifdef INNER\n`endif"):
            self.assertEqual(check(head + text), [], head)
        self.assertEqual(len(check('// `include "m.svh"' + text)), 1)
        self.assertEqual(check("`resetall\n" + MODULE.replace("BEFORE", '  initial $display("`NEVER", `__LINE__);')), [])

    def test_a_long_concatenation_is_found(self) -> None:
        names = ", ".join(f"a_{i}" for i in range(17))
        for line in (f"  assign {{{names}}} = 0;", f"  leaf u_leaf (.a_i({{{names}}}));", f"  assign other = |{{{names}}};"):
            self.assertEqual(check(MODULE.replace("BEFORE", line)),
                             ["hdl/m.sv:12: a concatenation of 17 names, where 16 are the most: use a struct"], line)
        for line in (f"  assign unused = ^{{{names}}};", f"  leaf u_leaf (.a_i({{{names.removesuffix(', a_16')}}}));"):
            self.assertEqual(check(MODULE.replace("BEFORE", line)), [], line)

    def test_the_arrays_file_needs_its_include(self) -> None:
        hdl = ROOT / "hdl"
        included = {path.name: path.read_text(encoding="utf-8") for path in hdl.rglob("*.svh")}
        text = (hdl / "thesis/dtof_array.sv").read_text(encoding="utf-8")
        self.assertEqual(rtl_rules.check({"a": text}, included), [])
        include = '`include "dtof_readout_range.svh"\n'
        self.assertEqual(text.count(include), 1)
        (found,) = rtl_rules.check({"a": text.replace(include, "")}, included)
        self.assertRegex(found, "defines `DTOF_READOUT_RANGE$")


class Warnings(unittest.TestCase):
    def test_a_port_of_another_width_is_found(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "top.sv").write_text("module leaf (input logic a_i);\nendmodule\n"
                                                 "module top;\n  logic [62:0] wide;\n  leaf u_leaf (.a_i(wide));\nendmodule\n")  # fmt: skip
            said = subprocess.run(["iverilog", "-g2012", "-t", "null", "-s", "top", "top.sv"], cwd=folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, check=False)  # fmt: skip
        self.assertEqual(said.returncode, 0, said.stdout)
        self.assertRegex("".join(lint_rtl.sorry(said.stdout)), "expects 1 bits?, got 63")


if __name__ == "__main__":
    unittest.main()
