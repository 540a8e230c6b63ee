# SPDX-License-Identifier: Apache-2.0
"""Cell models say what the Liberty says."""

import itertools
import subprocess
import tempfile
import unittest
from pathlib import Path

from dtof_synth import cell_models, liberty, standard_cells
from dtof_synth.errors import FlowError


def value(verilog: str, **pins: int) -> int:
    """A Verilog expression of one-bit pins; Python's operators bind alike and every bracket is there."""
    return eval(verilog.replace("1'b", ""), {}, pins) & 1  # pylint: disable=eval-used


class Expressions(unittest.TestCase):
    def test_operators_and_their_order(self) -> None:
        for function, meaning in (
                ("!(A * B)", lambda a, b, c: not (a and b)),
                ("(A B)'", lambda a, b, c: not (a and b)),
                ("A' B + C", lambda a, b, c: (not a and b) or c),
                ("A & B ^ C", lambda a, b, c: a and b != c),
                ("A+B*C", lambda a, b, c: a or (b and c)),
                ("!A | !B&C", lambda a, b, c: not a or (not b and c)),
                ("!A ^ B", lambda a, b, c: (not a) != b),
                ("A !B (C + 0)", lambda a, b, c: a and not b and c),
                ("1", lambda a, b, c: True)):
            for a, b, c in itertools.product((0, 1), repeat=3):
                with self.subTest(function=function, pins=(a, b, c)):
                    self.assertEqual(value(cell_models.expression(function, "x"), A=a, B=b, C=c),
                                     int(meaning(bool(a), bool(b), bool(c))))

    def test_what_cannot_be_read_is_refused(self) -> None:
        for function in ("", "A +", "(A", "A)", "A ? B", "A * * B"):
            with self.subTest(function=function), self.assertRaisesRegex(FlowError, "cell X: "):
                cell_models.expression(function, "cell X")
        with self.assertRaisesRegex(FlowError, "cell X: a bracket of the function .* is not closed"):
            cell_models.expression("(A + B", "cell X")


class Models(unittest.TestCase):
    def parse(self, cell: str) -> liberty.Group:
        return liberty.parse(f"library (l) {{ {cell} }}", "l")

    def simulate(self, verilog: str, bench: str) -> str:
        with tempfile.TemporaryDirectory() as folder:
            source, program = Path(folder) / "t.v", Path(folder) / "t.vvp"
            source.write_text(f"{verilog}\nmodule t;\n{bench}\nendmodule\n", encoding="utf-8")
            subprocess.run(["iverilog", "-g2012", "-s", "t", "-o", str(program), str(source)], check=True)
            return subprocess.run(["vvp", "-n", str(program)], check=True, capture_output=True, text=True).stdout

    def test_registers_clear_preset_and_power_up(self) -> None:
        library = liberty.parse(standard_cells.library(standard_cells.TYPICAL), "generated")
        bench = """reg d, ck, rn; wire q, s;
          DFFR_X1 #(.POWER_UP(1'b1)) r(.D(d), .CK(ck), .RN(rn), .Q(q));
          DFFS_X1 #(.POWER_UP(1'b0)) p(.D(d), .CK(ck), .SN(rn), .Q(s));
          initial begin
            ck = 0; rn = 1; d = 0; #1 $display("up %b%b", q, s);
            #1 rn = 0; #1 $display("reset %b%b", q, s);
            d = 1; #1 ck = 1; #1 ck = 0; $display("held %b%b", q, s);
            rn = 1; #1 $display("still %b%b", q, s);
            ck = 1; #1 ck = 0; $display("one %b%b", q, s);
            d = 0; #1 $display("waits %b%b", q, s); ck = 1; #1 $display("zero %b%b", q, s);
          end"""
        self.assertEqual(self.simulate(cell_models.verilog(library, ["DFFR_X1", "DFFS_X1"]), bench).split(),
                         ["up", "10", "reset", "01", "held", "01", "still", "01", "one", "11", "waits", "11",
                          "zero", "00"])

    def test_falling_clock_inverted_output_enable_and_priority(self) -> None:
        cell = self.parse("""cell (F) { ff (IQ, IQN) { next_state : "(E D) + (!E IQ)"; clocked_on : "!G";
            clear : "R"; preset : "S'"; clear_preset_var1 : H; clear_preset_var2 : L; }
          pin (D) { direction : input; } pin (E) { direction : input; } pin (G) { direction : input; }
          pin (R) { direction : input; } pin (S) { direction : input; }
          pin (Q) { direction : output; function : "IQ"; } pin (QN) { direction : output; function : "IQN"; } }""")
        bench = """reg d, e, g, r, s; wire q, qn; F f(.D(d), .E(e), .G(g), .R(r), .S(s), .Q(q), .QN(qn));
          initial begin
            d = 1; e = 1; g = 1; r = 0; s = 1; #1 g = 0; #1 $display("taken %b%b", q, qn);
            d = 0; e = 0; g = 1; #1 g = 0; #1 $display("kept %b%b", q, qn);
            r = 1; #1 $display("cleared %b%b", q, qn); s = 0; #1 $display("both %b%b", q, qn);
          end"""
        self.assertEqual(self.simulate(cell_models.verilog(cell, ["F"]), bench).split(),
                         ["taken", "10", "kept", "10", "cleared", "01", "both", "10"])

    def test_a_clock_gate_takes_its_enable_while_the_clock_is_low(self) -> None:
        library = liberty.parse(standard_cells.library(standard_cells.TYPICAL), "generated")
        bench = """reg ck, e; wire gck; integer edges = 0; CLKGATE_X1 g(.CK(ck), .E(e), .GCK(gck));
          always @(posedge gck) edges = edges + 1;
          initial begin
            ck = 0; e = 0; #1 ck = 1; #1 e = 1; #1 $display("late %b%0d", gck, edges);
            ck = 0; #1 ck = 1; #1 $display("open %b%0d", gck, edges); e = 0; #1 $display("whole %b%0d", gck, edges);
            ck = 0; #1 ck = 1; #1 $display("shut %b%0d", gck, edges);
            ck = 0; #1 e = 1; #1 e = 0; #1 ck = 1; #1 $display("settled %b%0d", gck, edges);
          end"""
        self.assertEqual(self.simulate(cell_models.verilog(library, ["CLKGATE_X1"]), bench).split(),
                         ["late", "00", "open", "11", "whole", "11", "shut", "01", "settled", "01"])

    def test_cells_that_are_not_modelled_are_refused(self) -> None:
        library = self.parse("""cell (L) { latch (IQ, IQN) { enable : "G"; data_in : "D"; } }
          cell (N) { pin (Y) { direction : output; } }
          cell (T) { pin (Y) { direction : output; function : "A"; three_state : "E"; } }
          cell (C) { ff (IQ, IQN) { next_state : "D"; clocked_on : "A * B"; } }""")
        library.groups.extend(self.parse("""cell (G) { clock_gating_integrated_cell : "latch_posedge";
          pin (CK) { direction : input; clock_gate_clock_pin : true; } pin (Q) { direction : output; clock_gate_out_pin : true; } }""").groups)
        for name, message in (("G", "the clock gate has no enable pin"), ("L", "'latch' group"), ("N", "no function"), ("T", "no function"),
                              ("C", "neither a pin"), ("absent", "no cell absent")):
            with self.subTest(cell=name), self.assertRaisesRegex(FlowError, message):
                cell_models.verilog(library, [name])


if __name__ == "__main__":
    unittest.main()
