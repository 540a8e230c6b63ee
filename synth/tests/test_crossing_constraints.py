# SPDX-License-Identifier: Apache-2.0
"""constraints/crossing/async_line_fifo.sdc: OpenSTA takes the file; paths between the two clocks have the limits, paths inside a clock do not."""

import re
import tempfile
import unittest
from pathlib import Path

from dtof_synth import standard_cells, tools

ROOT = Path(__file__).resolve().parents[2]
TDC_NS, READ_NS = 5.0, 3.0
# The registers of the crossing: source, target, their clocks.
PATHS = {
    ("shown", "stored"): READ_NS, ("pointer", "freed"): READ_NS, ("memory_0", "line"): READ_NS,
    ("shown", "shown_2"): TDC_NS, ("stored", "stored_2"): READ_NS,
}
CLOCKS = {"shown": "clk_tdc_i", "shown_2": "clk_tdc_i", "freed": "clk_tdc_i", "memory_0": "clk_tdc_i", "stored": "clk_i", "stored_2": "clk_i",
          "pointer": "clk_i", "line": "clk_i"}


def sta(tdc_ns: float, read_ns: float) -> str:
    """OpenSTA's reports of all paths from register to register."""
    starts = {end: start for start, end in PATHS}
    cells = [f"  DFF_X1 {name} (.D({f'q_{starts[name]}' if name in starts else 'd_i'}), .CK({clock}), .Q(q_{name}));" for name, clock in CLOCKS.items()]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        (folder / "t.v").write_text("\n".join([
            "module t (clk_tdc_i, clk_i, d_i);", "  input clk_tdc_i, clk_i, d_i;", *(f"  wire q_{name};" for name in CLOCKS), *cells, "endmodule", ""]),
            encoding="utf-8")
        script = folder / "t.tcl"
        script.write_text(
            f"read_liberty {folder}/slow.lib\nread_verilog {folder}/t.v\nlink_design t\n"
            f"create_clock -name tdc -period {tdc_ns} [get_ports clk_tdc_i]\ncreate_clock -name clk -period {read_ns} [get_ports clk_i]\n"
            f"set tdc_clock tdc\nset tdc_period {tdc_ns}\nset read_clock clk\nset read_period {read_ns}\nset fifo_memory memory*\n"
            f"source {ROOT}/constraints/crossing/async_line_fifo.sdc\n"
            "foreach mode {max min} {\n  puts \"MODE $mode\"\n  report_checks -path_delay $mode -group_count 1000 -endpoint_count 1 -digits 4\n}\n"
            "puts DTOF_STA_OK\nexit\n", encoding="utf-8")
        return tools.run_sta(script, folder / "settings", folder / "log", "crossing")


def limits(output: str) -> dict[tuple[str, str], float]:
    """What a path may take at most, by its ends: the limit, or the period."""
    found = {}
    for text in output.split("MODE max\n")[1].split("MODE min\n")[0].split("Startpoint: ")[1:]:
        ends = text.split(maxsplit=1)[0], re.findall(r"Endpoint: (\S+)", text)[0]
        limit = re.findall(r"(-?[\d.]+) +-?[\d.]+ +max_delay", text) or re.findall(r"(-?[\d.]+) +-?[\d.]+ +clock \w+ \(rise edge\)", text)
        found[ends] = float(limit[-1])
    return found


class Crossing(unittest.TestCase):
    def test_paths_between_the_clocks_have_their_limits(self) -> None:
        output = sta(TDC_NS, READ_NS)
        found = limits(output)
        self.assertEqual({ends: found.get(ends) for ends in PATHS}, PATHS)
        hold = {tuple(pair) for pair in re.findall(r"Startpoint: (\S+).*?Endpoint: (\S+)", output.split("MODE min\n")[1], re.DOTALL)}
        self.assertEqual(hold & PATHS.keys(), {("shown", "shown_2"), ("stored", "stored_2")})

    def test_a_line_has_the_whole_period_where_the_tdcs_are_faster(self) -> None:
        found = limits(sta(READ_NS, TDC_NS))
        self.assertEqual({ends: found.get(ends) for ends in (("shown", "stored"), ("pointer", "freed"), ("memory_0", "line"))},
                         {("shown", "stored"): READ_NS, ("pointer", "freed"): READ_NS, ("memory_0", "line"): TDC_NS})


if __name__ == "__main__":
    unittest.main()
