# SPDX-License-Identifier: Apache-2.0
"""Every fault that must stop the flow stops it, with its message."""

import tempfile
import unittest
from pathlib import Path

from dtof_synth import mapping, sram_kit, standard_cells, tools
from dtof_synth.errors import FlowError, found_in
from dtof_synth.sram_model import Size

SYNTH = Path(__file__).resolve().parents[1]
HEAD = "module dtof_array(input wire clk_i, input wire [3:0] a, input wire e, output reg [3:0] q);\n"


class FlowChecks(unittest.TestCase):
    temporary: tempfile.TemporaryDirectory[str]
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        sram_kit.write_kit(cls.folder, [Size(2, 160, 10)])
        for corner in standard_cells.CORNERS:
            (cls.folder / f"{corner.name}.lib").write_text(standard_cells.library(corner), encoding="utf-8")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.temporary.cleanup()

    def elaborate(self, body: str) -> None:
        (self.folder / "design.sv").write_text(HEAD + body + "\nendmodule\n", encoding="utf-8")
        settings = self.folder / "settings.tcl"
        tools.write_settings(settings, {
            "scripts": SYNTH / "yosys", "top": "dtof_array", "rtl_files": [self.folder / "design.sv"],
            "rtl_include": self.folder, "kept_modules": [],
            "technology_files": [self.folder / "dtof_sram_1rw.sv", self.folder / "dtof_sram_1r1w.sv"],
            "black_boxes": self.folder / "sram40_blackbox.v", "liberty": self.folder / "slow.lib",
            "parameters": {}, "elaborated_netlist": self.folder / "elaborated.il", "generic_netlist": self.folder / "generic.il"})
        mapping.to_generic(self.folder, settings, self.folder, "test")

    def sta(self, verilog: str, libraries: list[Path] | None = None) -> str:
        (self.folder / "netlist.v").write_text(verilog, encoding="utf-8")
        (self.folder / "test.sdc").write_text("create_clock -name clk -period $period [get_ports clk_i]\n",
                                              encoding="utf-8")
        settings = self.folder / "sta.tcl"
        tools.write_settings(settings, {
            "liberty_files": libraries or [self.folder / "typical.lib"], "netlist": self.folder / "netlist.v",
            "wires": "", "top": "t", "wire_load": "block_1k", "constraints": self.folder / "test.sdc",
            "target_period": 3.0, "fast_period": 2.0, "activity": 0.1, "measured_column": "x_u_column", "steps": ["closing", "nominal", "power"]})
        return tools.run_sta(SYNTH / "sta" / "timing.tcl", settings, self.folder / "sta.log", "test")

    def test_clean_rtl_passes(self) -> None:
        self.elaborate("always_ff @(posedge clk_i) q <= a;")

    def test_latch(self) -> None:
        with self.assertRaisesRegex(FlowError, "2_check_rtl.*dlatch"):
            self.elaborate("always @* if (e) q = a;")

    def test_inferred_memory(self) -> None:
        with self.assertRaisesRegex(FlowError, "2_check_rtl.*mem"):
            self.elaborate("reg [3:0] m [0:255]; always_ff @(posedge clk_i) begin m[{a, a}] <= a; q <= m[{a, q}]; end")

    def test_undriven_net(self) -> None:
        with self.assertRaisesRegex(FlowError, "no driver"):
            self.elaborate("wire [3:0] w; always_ff @(posedge clk_i) q <= a & w;")

    def test_multiple_drivers(self) -> None:
        with self.assertRaisesRegex(FlowError, "conflicting drivers"):
            self.elaborate("wire [3:0] w; assign w = a; assign w = ~a; always_ff @(posedge clk_i) q <= w;")

    def test_combinational_loop(self) -> None:
        with self.assertRaisesRegex(FlowError, "loop"):
            self.elaborate("wire w; assign w = w ^ e; always_ff @(posedge clk_i) q <= {4{w}};")

    def test_unlisted_sram_size(self) -> None:
        with self.assertRaisesRegex(FlowError, "a size that is not listed"):
            self.elaborate("dtof_sram_1r1w #(.DEPTH(161), .WIDTH(10)) u_macro (.clk_i(clk_i));")

    def test_missing_module_and_syntax_error(self) -> None:
        with self.assertRaisesRegex(FlowError, "nowhere"):
            self.elaborate("nowhere u (.a(a));")
        with self.assertRaisesRegex(FlowError, "syntax error"):
            self.elaborate("always_ff @(posedge clk_i q <= a;")

    def test_opensta_reports_a_clean_design(self) -> None:
        output = self.sta("module t(clk_i, a, q); input clk_i, a; output q; wire n;"
                          " DFF_X1 r(.D(a), .CK(clk_i), .Q(n)); DFF_X1 s(.D(n), .CK(clk_i), .Q(q)); endmodule")
        self.assertIn("DTOF_SLACK", output)

    def test_opensta_times_the_enable_of_a_clock_gate(self) -> None:
        output = self.sta("module t(clk_i, a, q); input clk_i, a; output q; wire n, gck; DFF_X1 r(.D(a), .CK(clk_i), .Q(n));"
                          " CLKGATE_X1 g(.CK(clk_i), .E(n), .GCK(gck)); DFF_X1 s(.D(n), .CK(gck), .Q(q)); endmodule")
        self.assertIn("clock gating-check end-point", output)

    def test_opensta_errors_are_seen_although_it_exits_0(self) -> None:
        good = "module t(clk_i); input clk_i; endmodule"
        for verilog, libraries in (("module t(clk_i; endmodule", None), (good, [self.folder / "absent.lib"]),
                                   ("module other(clk_i); input clk_i; endmodule", None)):
            with self.subTest(verilog=verilog), self.assertRaisesRegex(FlowError, "OpenSTA"):
                self.sta(verilog, libraries)

    def test_opensta_counts_rise_and_fall_for_every_transition(self) -> None:
        # dtof_synth/power.py halves the internal power for this reason.
        output = self.sta("module t(clk_i, a, q); input clk_i, a; output q; wire n;"
                          " DFF_X1 r(.D(a), .CK(clk_i), .Q(n)); DFF_X1 s(.D(n), .CK(clk_i), .Q(q)); endmodule")
        watts = float(found_in("OpenSTA", r"^DTOF_POWER CLOCK shared (\S+)", output)[1])
        per_cycle = 2 * standard_cells.clock_energy_fj(1.1) * 1e-15 / 3e-9
        self.assertAlmostEqual(watts / (2 * 2 * per_cycle), 1, delta=0.01)

    def test_power_counts_one_column_and_no_sram(self) -> None:
        column = "module c(k, a, q); input k, a; output q; DFF_X1 r(.D(a), .CK(k), .Q(q)); endmodule\n"
        output = self.sta(column + "module t(clk_i, a, q); input clk_i, a; output q; wire n, m;"
                          " DFF_X1 r(.D(a), .CK(clk_i), .Q(n)); c x_u_column(.a(n), .k(clk_i), .q(m));"
                          " c y_u_column(.a(m), .k(clk_i), .q(q)); endmodule")
        column_w, shared_w = (float(found_in("OpenSTA", rf"^DTOF_POWER CLOCK {group} (\S+)", output)[1])
                              for group in ("column", "shared"))
        self.assertGreater(column_w, 0)
        self.assertAlmostEqual(column_w / shared_w, 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()
