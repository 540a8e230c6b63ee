# SPDX-License-Identifier: Apache-2.0
"""The netlist that is mapped: what the source merely looks like leaves no trace in it, what the logic does stays."""

import tempfile
import unittest
from pathlib import Path

from dtof_synth import standard_cells, tools
from dtof_synth.canonical import canonical
from dtof_synth.errors import FlowError

SYNTH = Path(__file__).resolve().parents[1]
COLUMN = """module some_column(input wire clk_i, input wire e, input wire [7:0] a, input wire [7:0] b, output reg [7:0] q);
  reg [7:0] sum;
  always @(posedge clk_i) begin
    if (e) sum <= a + b;
    q <= (sum > a) ? sum - b : {sum[3:0], a[7:4]} ^ b;
  end
endmodule
"""
ARRAY = """module dtof_array(input wire clk_i, input wire e, input wire [7:0] a, input wire [7:0] b, output wire [7:0] q);
  some_column u_column(.clk_i(clk_i), .e(e), .a(a), .b(b), .q(q));
endmodule
"""
# As long as real packages: running numbers get another digit, lines as well.
UNUSED = "".join(f"module unused_{i}(input wire [7:0] x, output wire [7:0] y); assign y = x + 8'd{i}; endmodule\n" for i in range(60))


FUNCTION = """module some_column(input wire clk_i, input wire e, input wire [7:0] a, input wire [7:0] b, output reg [7:0] q);
  function automatic [7:0] twice(input [7:0] x); twice = x + x; endfunction
  always @(posedge clk_i) if (e) q <= twice(a) ^ b;
endmodule
"""


class Canonical(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = Path(temporary.name)

    def elaborate(self, name: str, text: str) -> Path:
        """The folder of a source, elaborated."""
        folder = self.root / name
        folder.mkdir()
        (folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        (folder / "design.v").write_text(text, encoding="utf-8")
        (folder / "none.v").write_text("", encoding="utf-8")
        tools.write_settings(folder / "settings.tcl", {
            "scripts": SYNTH / "yosys", "top": "dtof_array", "rtl_files": [folder / "design.v"], "rtl_include": folder,
            "kept_modules": [], "technology_files": [folder / "none.v"], "black_boxes": folder / "none.v",
            "liberty": folder / "slow.lib", "parameters": {}, "elaborated_netlist": folder / "elaborated.il",
            "generic_netlist": folder / "generic.il"})
        tools.run_yosys(SYNTH / "yosys" / "elaborate.tcl", folder / "settings.tcl", folder / "elaborate.log", "test")
        return folder

    def test_only_the_logic_counts(self):
        found = {}
        for name, text in (("plain", COLUMN + ARRAY), ("other", COLUMN.replace("sum > a", "sum >= a") + ARRAY),
                           ("moved", "// A comment.\n" * 12 + UNUSED + COLUMN.replace("\n", "\n\n") + ARRAY)):
            folder = self.elaborate(name, text)
            found[name] = (folder / "elaborated.il").read_text(encoding="utf-8")
        self.assertNotEqual(found["plain"], found["moved"])
        self.assertEqual(canonical(found["plain"], self.root / "plain"), canonical(found["moved"], self.root / "moved"))
        self.assertNotEqual(canonical(found["plain"], self.root / "plain"), canonical(found["other"], self.root / "other"))

    def test_functions_have_no_folder(self):
        found = [(self.elaborate(name, FUNCTION + ARRAY) / "elaborated.il").read_text(encoding="utf-8") for name in ("a", "b")]
        self.assertEqual(canonical(found[0], self.root / "a"), canonical(found[1], self.root / "b"))

    def test_the_logic_stays(self):
        folder = self.elaborate("plain", COLUMN + ARRAY)
        text = (folder / "elaborated.il").read_text(encoding="utf-8")
        wrong = text.replace("cell $gt ", "cell $ge ", 1)
        self.assertNotEqual(text, wrong)

        def compare(edited: str) -> None:
            (folder / "gate.il").write_text(canonical(edited, folder), encoding="utf-8")
            (folder / "compare.tcl").write_text("yosys -import\n" + "".join(
                f"read_rtlil {folder}/{file}\nhierarchy -top dtof_array\nflatten\ndesign -stash {name}\n"
                for file, name in (("elaborated.il", "gold"), ("gate.il", "gate"))) +
                "design -copy-from gold -as gold dtof_array\ndesign -copy-from gate -as gate dtof_array\n"
                "equiv_make gold gate both\nyosys cd both\nequiv_simple\nequiv_induct\nequiv_status -assert\n", encoding="utf-8")
            tools.run_yosys(folder / "compare.tcl", folder / "none.tcl", folder / "compare.log", "test")

        compare(text)
        with self.assertRaisesRegex(FlowError, "unproven"):
            compare(wrong)


if __name__ == "__main__":
    unittest.main()
