# SPDX-License-Identifier: Apache-2.0
"""The rules of the RTL's text find what is planted, and nothing else."""

import unittest

import rtl_rules

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


def check(text: str) -> list[str]:
    return rtl_rules.check({"hdl/m.sv": text})


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
                            "logic signed [3:0][1:0] late;", "logic late [0:3];", "wire late = a_i[0];"):
            text = MODULE.replace("BEFORE", "  assign other[1] = late;").replace("logic late;", declaration)
            self.assertEqual(len(check(text)), 1, declaration)

    def test_a_header_that_includes_is_found(self) -> None:
        found = check(MODULE.replace("BEFORE", "").replace("    input  logic         clk_i,", '    `include "dtof_ports.svh"'))
        self.assertEqual(found, ['hdl/m.sv:5: the header of m includes "dtof_ports.svh"'])
        self.assertEqual(check(MODULE.replace("BEFORE", '  `include "dtof_columns.svh"')), [])

    def test_a_type_of_the_compilation_unit_is_found(self) -> None:
        text = MODULE.replace("BEFORE", "")
        self.assertEqual(check("typedef struct packed {\n  logic a;\n} t;\n" + text), ["hdl/m.sv:1: a type outside of modules and packages"])
        self.assertEqual(check("package p;\n  typedef logic [1:0] t;\nendpackage\n" + text), [])


if __name__ == "__main__":
    unittest.main()
