# SPDX-License-Identifier: Apache-2.0
"""Clock gates: which registers get one, and that registers behind gates do what they did."""

import json
import random
import subprocess
import tempfile
import unittest
from pathlib import Path

from dtof_synth import cell_models, clock_gating, liberty, library, mapping, netlist, standard_cells, tools
from dtof_synth.library import Library

SYNTH = Path(__file__).resolve().parents[1]
# Registers of every kind: enabled together, by an enable that is active low, reset with or without the clock, too few.
COLUMN = """module gated_column(input wire clk_i, input wire rst_ni, input wire e, input wire f, input wire [23:0] d,
    output reg [23:0] wide, output reg [4:0] low, output reg [4:0] reset, output reg [4:0] cleared, output reg [2:0] few);
  always @(posedge clk_i) if (e) wide <= d;
  always @(posedge clk_i) if (!f) low <= d[4:0];
  always @(posedge clk_i or negedge rst_ni) if (!rst_ni) reset <= 5'd9; else if (e && f) reset <= d[9:5];
  always @(posedge clk_i) if (e || f) begin if (d[0]) cleared <= 5'd0; else cleared <= d[14:10]; end
  always @(posedge clk_i) if (e ^ f) few <= d[2:0];
endmodule
"""
PORTS = ".clk_i(clk), .rst_ni(rst), .e(e), .f(f), .d(d)"
ARRAY = f"""module dtof_array(input wire clk_i, input wire rst_ni, input wire e, input wire f, input wire [23:0] d,
    output wire [41:0] q, output reg [7:0] own, output reg [31:0] line);
  gated_column u_column({PORTS.replace("(clk)", "(clk_i)").replace("(rst)", "(rst_ni)")}, .wide(q[23:0]), .low(q[28:24]),
                        .reset(q[33:29]), .cleared(q[38:34]), .few(q[41:39]));
  always @(posedge clk_i) if (e) own <= d[7:0];
  always @(posedge clk_i) if (f) line <= {{d[15:8] ^ d[7:0], d}};
endmodule
"""


class ClockGating(unittest.TestCase):
    temporary: tempfile.TemporaryDirectory[str]
    folder: Path
    library: Library
    gates: int
    design: dict

    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        (cls.folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        cls.library = library.read(cls.folder / "slow.lib")
        (cls.folder / "design.v").write_text(COLUMN + ARRAY, encoding="utf-8")
        (cls.folder / "none.v").write_text("", encoding="utf-8")
        settings = cls.folder / "settings.tcl"
        tools.write_settings(settings, {
            "scripts": SYNTH / "yosys", "top": "dtof_array", "rtl_files": [cls.folder / "design.v"],
            "rtl_include": cls.folder, "kept_modules": [], "technology_files": [cls.folder / "none.v"], "black_boxes": cls.folder / "none.v",
            "liberty": cls.folder / "slow.lib", "parameters": {},
            "elaborated_netlist": cls.folder / "elaborated.il", "generic_netlist": cls.folder / "generic.il"})
        mapping.to_generic(cls.folder, settings, cls.folder, "test")
        cls.gates = clock_gating.insert(cls.folder / "generic.il", cls.library)
        (cls.folder / "abc.constr").write_text("set_driving_cell INV_X1\nset_load 6 [all_outputs]\n", encoding="utf-8")
        tools.write_settings(settings, {
            "scripts": SYNTH / "yosys", "generic_netlist": cls.folder / "generic.il", "liberty": cls.folder / "slow.lib",
            "abc_constraints": cls.folder / "abc.constr", "abc_period_ps": "2000",
            "column_script": "+strash;map", "shared_script": "+strash;map", "naming": "0", "tie_low": ["TIE0_X1", "Y"], "tie_high": ["TIE1_X1", "Y"],
            "netlist_json": cls.folder / "mapped.json"})
        tools.run_yosys(SYNTH / "yosys" / "map.tcl", settings, cls.folder / "map.log", "test")
        cls.design = json.loads((cls.folder / "mapped.json").read_text(encoding="utf-8"))
        netlist.rename_parts(cls.design)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.temporary.cleanup()

    def test_the_library_has_its_gate(self) -> None:
        self.assertEqual([(gate.name, gate.clock_pin, gate.enable_pin, gate.output_pin) for gate in self.library.clock_gates],
                         [(f"CLKGATE_X{drive}", "CK", "E", "GCK") for drive in (1, 2, 4)])
        self.assertFalse([name for name in self.library.sequential if name.startswith("CLKGATE")])

    def test_every_large_enough_group_has_its_gates_and_nothing_else(self) -> None:
        # 24 bits need a gate of drive 2 for the load, three groups of five bits have one of drive 1 each, and three bits have none. Of the
        # top's registers only the 32 with the same enable have a gate, of drive 4.
        self.assertEqual(self.gates, 4 + 1)
        column = self.design["modules"]["gated_column"]
        clocks = netlist.clock_nets(column) - netlist.port_clock_nets(column)
        self.assertEqual(len(clocks), 4)
        behind = [sum(cell["connections"].get("CK") == [clock] for cell in column["cells"].values()) for clock in clocks]
        self.assertEqual(sorted(behind), [5, 5, 5, 24])
        found = netlist.count(column, self.library)
        self.assertEqual((found.flip_flops, found.clock_sinks), (42, 3 + 4))
        self.assertAlmostEqual(found.clock_ff, 3 * standard_cells.DFF_CK_FF + 3 * standard_cells.GATE_CK_FF[1] + standard_cells.GATE_CK_FF[2], places=3)
        array = self.design["modules"]["dtof_array"]
        gated = netlist.clock_nets(array) - netlist.port_clock_nets(array)
        self.assertEqual(sorted(sum(cell["connections"].get("CK") == [clock] for cell in array["cells"].values()) for clock in gated), [32])
        self.assertEqual(netlist.count(array, self.library).clock_sinks, 8 + 1)
        kinds = [cell["type"] for module in (column, array) for name, cell in module["cells"].items() if name.startswith(netlist.CLOCK_GATE_PREFIX)]
        self.assertEqual(sorted(kinds), ["CLKGATE_X1"] * 3 + ["CLKGATE_X2", "CLKGATE_X4"])

    def test_no_gate_is_overloaded(self) -> None:
        column = self.design["modules"]["gated_column"]
        for gate in (cell for name, cell in column["cells"].items() if name.startswith(netlist.CLOCK_GATE_PREFIX)):
            most = self.library.max_load_ff[gate["type"]]["GCK"] * netlist.TREE_LOAD_SHARE
            clock, = gate["connections"]["GCK"]
            sinks = sum(cell["connections"].get("CK") == [clock] for cell in column["cells"].values())
            self.assertLessEqual(sinks * (standard_cells.DFF_CK_FF + self.library.wire_ff_per_sink), most)

    def test_registers_behind_gates_do_what_they_did(self) -> None:
        seed = random.randrange(2**31)
        design = json.loads(json.dumps(self.design))
        kinds = netlist.cell_kinds(design, self.library)
        netlist.prepare_simulation(design, self.library, "_netlist", cell_models.POWER_UP, lambda: False)
        (self.folder / "simulation.json").write_text(json.dumps(design), encoding="utf-8")
        settings = self.folder / "write.tcl"
        tools.write_settings(settings, {"netlist_json": self.folder / "simulation.json",
                                        "netlist": self.folder / "netlist.v"})
        tools.run_yosys(SYNTH / "yosys" / "write_verilog.tcl", settings, self.folder / "write.log", "test")
        (self.folder / "cells.v").write_text(cell_models.verilog(liberty.read(self.library.path), kinds), encoding="utf-8")
        (self.folder / "bench.v").write_text(f"""module bench; reg clk = 0, rst = 1, e = 0, f = 0; reg [23:0] d = 0;
  wire [41:0] q, n; wire [7:0] q_own, n_own; wire [31:0] q_line, n_line; integer loaded = 0, number = {seed};
  dtof_array r({PORTS}, .q(q), .own(q_own), .line(q_line)); dtof_array_netlist g({PORTS}, .q(n), .own(n_own), .line(n_line));
  always #5 clk = !clk;
  always @(posedge clk) begin
    {{e, f}} <= $random(number); d <= $random(number); rst <= ($random(number) & 15) != 0;
    if (^q !== 1'bx) loaded <= loaded + 1;
    if ((^q !== 1'bx && n !== q) || (^q_own !== 1'bx && n_own !== q_own)
        || (^q_line !== 1'bx && n_line !== q_line)) $display("differs at %0t", $time);
  end
  initial begin #1 rst = 0; #20000 $display("compared %0d", loaded); $finish(0); end
endmodule
""", encoding="utf-8")
        program = self.folder / "bench.vvp"
        subprocess.run(["iverilog", "-g2012", "-s", "bench", "-o", str(program),
                        *(str(self.folder / name) for name in ("design.v", "netlist.v", "cells.v", "bench.v"))], check=True)
        said = subprocess.run(["vvp", "-n", str(program)], check=True, capture_output=True, text=True).stdout
        self.assertNotIn("differs", said, f"seed {seed}")
        self.assertGreater(int(said.split()[-1]), 1900, f"seed {seed}")

    def test_four_registers_are_worth_a_gate_and_three_are_not(self) -> None:
        for number, gates in ((3, 0), (4, 1)):
            text = "".join(["module \\column\n", *(f"  cell $_DFFE_PP_ $r{index}\n    connect \\C \\clk\n    connect \\D \\d\n"
                                                  f"    connect \\E \\e\n    connect \\Q \\q{index}\n  end\n"
                                                  for index in range(number)), "end\n"])
            gated, found = clock_gating.gated(text, self.library)
            self.assertEqual((found, gated.count("cell $_DFF_P_ "), gated == text), (gates, number * gates, not gates))

    def test_without_a_gate_in_the_library_nothing_changes(self) -> None:
        text = (self.folder / "generic.il").read_text(encoding="utf-8")
        self.library.clock_gates, kept = [], self.library.clock_gates
        try:
            self.assertEqual(clock_gating.insert(self.folder / "generic.il", self.library), 0)
        finally:
            self.library.clock_gates = kept
        self.assertEqual((self.folder / "generic.il").read_text(encoding="utf-8"), text)


if __name__ == "__main__":
    unittest.main()
