# SPDX-License-Identifier: Apache-2.0
"""constraints/dtof.sdc: which share of the period each port leaves to the inside, whatever the port's name."""

import re
import tempfile
import unittest
from pathlib import Path

from dtof_synth import standard_cells, tools
from dtof_synth.errors import found_in

ROOT = Path(__file__).resolve().parents[2]
PERIOD_NS = 3.0
INPUTS = ("rst_ni", "tdc_valid_i", "tdc_timestamp_i", "start_i", "acq_num_i", "raw_i", "prior_i", "a_port_that_nobody_knows_i",
          "result_tready_i", "sram_cfg_i")
OUTPUTS = ("tdc_ready_o", "busy_o", "error_o", "another_o", "result_tvalid_o", "result_tdata_o", "result_tlast_o", "sram_cfg_o")


class Constraints(unittest.TestCase):
    """Each input goes to a register, each output comes from one, so that a slack is what the port's budget leaves."""

    output: str

    @classmethod
    def setUpClass(cls) -> None:
        cls.output = cls.timed((ROOT / "constraints" / "dtof.sdc").read_text(encoding="utf-8"))

    @classmethod
    def timed(cls, constraints: str, more: str = "") -> str:
        """What OpenSTA says about the circuit with these constraints, and to `more` commands."""
        registers = [f"  DFF_X1 r_{name} (.D({name}), .CK(clk_i), .Q());" for name in INPUTS if name != "rst_ni"]
        # One register has 20 inverters of drive 8 behind it, a load beyond every table.
        registers += [f"  INV_X8 heavy{index} (.A(q_heavy), .Y());" for index in range(20)]
        registers += ["  DFF_X1 r_heavy (.D(start_i), .CK(clk_i), .Q(q_heavy));"]
        registers += [f"  DFF_X1 r_{name} (.D(q_r), .CK(clk_i), .Q({name}));" for name in OUTPUTS]
        ports = ["clk_i", *INPUTS, *OUTPUTS]
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
            (folder / "dtof.sdc").write_text(constraints, encoding="utf-8")
            (folder / "t.v").write_text("\n".join([
                f"module t ({', '.join(ports)});", *(f"  input {port};" for port in ("clk_i", *INPUTS)),
                *(f"  output {port};" for port in OUTPUTS), "  wire q_r, q_heavy;", *registers,
                "  DFFR_X1 r_rst (.D(start_i), .CK(clk_i), .RN(rst_ni), .Q(q_r));", "endmodule", ""]), encoding="utf-8")
            script = folder / "t.tcl"
            script.write_text(
                f"read_liberty {folder}/slow.lib\nread_verilog {folder}/t.v\nlink_design t\nset period {PERIOD_NS}\n"
                f"source {folder}/dtof.sdc\n{more}\n"
                "foreach mode {max min} {\n  puts \"MODE $mode\"\n"
                "  report_checks -path_delay $mode -group_count 1000 -endpoint_count 1 -digits 4\n}\n"
                "puts EDGES\nreport_check_types -all_violators -max_transition\n"
                "check_setup -verbose -unconstrained_endpoints -no_input_delay\nputs DTOF_STA_OK\nexit\n", encoding="utf-8")
            return tools.run_sta(script, folder / "settings", folder / "log", "constraints")

    def paths(self, mode: str, output: str = "") -> dict[tuple[str, str], str]:
        """Reports by start and end."""
        section = (output or self.output).split(f"MODE {mode}\n")[1].split("MODE ")[0]
        found = {}
        for text in section.split("Startpoint: ")[1:]:
            found[text.split(maxsplit=1)[0], found_in("OpenSTA", r"Endpoint: (\S+)", text)[1]] = text
        return found

    def external(self, start: str, end: str, mode: str = "max", output: str = "") -> float:
        """ns that the port's budget takes of a path."""
        text = self.paths(mode, output)[start, end]
        return abs(float(found_in("OpenSTA", r"(-?[\d.]+) +-?[\d.]+ +[v^]? ?(?:input|output) external delay", text)[1]))

    def test_every_port_leaves_seven_tenths_of_the_period(self) -> None:
        for name in INPUTS:
            if name not in ("rst_ni", "sram_cfg_i", "start_i"):
                self.assertAlmostEqual(self.external(name, f"r_{name}"), 0.9, places=4, msg=name)
        for name in OUTPUTS:
            if name != "sram_cfg_o":
                self.assertAlmostEqual(self.external(f"r_{name}", name), 0.9, places=4, msg=name)

    def test_each_kind_of_port_has_the_share_with_its_name(self) -> None:
        text = (ROOT / "constraints" / "dtof.sdc").read_text(encoding="utf-8")
        for share, value in (("tdc", 0.4), ("stream", 0.5)):
            text, changes = re.subn(rf"(?<=^set {share}_share )\S+$", f"{value}", text, flags=re.MULTILINE)
            self.assertEqual(changes, 1)
        output = self.timed(text)
        for mode in ("max", "min"):
            for name in (*INPUTS, *OUTPUTS):
                if name not in ("rst_ni", "start_i", "sram_cfg_i", "sram_cfg_o"):
                    expected = 1.2 if name.startswith("tdc_") else 1.5 if name.startswith("result_") else 0.9
                    path = (name, f"r_{name}") if name in INPUTS else (f"r_{name}", name)
                    self.assertAlmostEqual(self.external(*path, mode, output), expected, places=4, msg=f"{name} {mode}")

    def test_with_margins_ports_have_a_driver_and_a_load(self) -> None:
        # 0.0321 ns at every input, and 17 fF at every output. Cells are 5 % slower where late paths count.
        constraints = (ROOT / "constraints" / "dtof.sdc").read_text(encoding="utf-8")
        output = self.timed(constraints, f"set slew 0.0321\nset load 17\nsource {ROOT}/constraints/margins.sdc\n"
                            "puts WITH\nreport_checks -from [get_ports raw_i] -fields {slew cap} -digits 4\n"
                            "report_checks -to [get_ports busy_o] -fields {slew cap} -digits 4\nputs MODES")
        section = output.split("WITH\n")[1].split("MODES")[0]
        self.assertRegex(section, r"(?m)^ +\S+ +0\.0321 +0\.0000 +0\.9000 [v^] raw_i \(in\)$")
        self.assertRegex(section, r"(?m)^ +17\.0000 .* r_busy_o/Q \(DFF_X1\)$")
        for mode, uncertainty in (("max", -0.15), ("min", 0.05)):
            text = self.paths(mode, output)["r_rst", "r_busy_o"]
            self.assertAlmostEqual(float(found_in("OpenSTA", r"(-?[\d.]+) +-?[\d.]+ +clock uncertainty", text)[1]), uncertainty, places=4)

    def test_the_reset_leaves_four_fifths(self) -> None:
        self.assertAlmostEqual(self.external("rst_ni", "r_rst"), 0.6, places=4)

    def test_the_side_band_of_the_srams_and_nothing_else_has_no_path(self) -> None:
        ends = {port for pair in self.paths("max") for port in pair}
        self.assertEqual(({*INPUTS} - {"rst_ni"} | {*OUTPUTS}) - ends, {"sram_cfg_i", "sram_cfg_o"})
        self.assertNotIn("missing set_input_delay", self.output)

    def test_uncertainty_is_of_setup_and_of_hold(self) -> None:
        for mode, uncertainty in (("max", -0.1), ("min", 0.05)):
            text = self.paths(mode)["r_rst", "r_busy_o"]
            self.assertAlmostEqual(float(found_in("OpenSTA", r"(-?[\d.]+) +-?[\d.]+ +clock uncertainty", text)[1]), uncertainty, places=4)

    def test_an_edge_may_take_fifteen_hundredths_of_the_period(self) -> None:
        rows = re.findall(r"^(\S+) +(\S+) +(\S+) +\S+ \(VIOLATED\)$", self.output.split("EDGES")[1], re.MULTILINE)
        self.assertIn("r_heavy/Q", [name for name, _, _ in rows])
        self.assertEqual({limit for _, limit, _ in rows}, {"0.45"})

    def test_the_margins_have_their_figures(self) -> None:
        text = (ROOT / "constraints" / "margins.sdc").read_text(encoding="utf-8")
        self.assertIn("set margin_uncertainty 0.15\n", text)
        self.assertIn("set_timing_derate -late 1.05\n", text)
        self.assertIn("set_timing_derate -early 0.95\n", text)


if __name__ == "__main__":
    unittest.main()
