# SPDX-License-Identifier: Apache-2.0
"""dtof_async_line_fifo between clocks of many ratios, with pauses and resets; planted faults are found. dtof_synchroniser is simulated as it
stands, and replaced by UNCERTAIN, in which a bit that changes shortly before a clock edge arrives with this edge or with the next."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCES = {name: (ROOT / f"hdl/subsystem/dtof_{name}.sv").read_text(encoding="utf-8") for name in ("async_line_fifo", "gray_pointer", "synchroniser")}
BENCH = Path(__file__).with_name("async_line_fifo_bench.sv")
LINES = 1000
# Half periods of the TDCs' and the read-out's clock: 3:1 to 1:3, equal with any phase, nearly equal, so that the phase moves through all values.
RATIOS = ((30, 10), (34, 20), (22, 20), (20, 20), (100, 98), (98, 100), (20, 26), (14, 36), (10, 30))
UNCERTAIN = """
module dtof_synchroniser #(
    parameter int WIDTH = 1,
    parameter logic [WIDTH-1:0] RESET_VALUE = '0
) (
    input  wire              clk_i,
    input  wire              rst_ni,
    input  wire  [WIDTH-1:0] d_i,
    output logic [WIDTH-1:0] q_o
);
  logic [WIDTH-1:0] meta, now, old;
  integer changed[WIDTH], i, j;
  always @(d_i) begin
    for (i = 0; i < WIDTH; i = i + 1) begin
      if (d_i[i] !== now[i]) begin
        old[i] = now[i];
        now[i] = d_i[i];
        changed[i] = $time;
      end
    end
  end
  always @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {meta, q_o} <= {2{RESET_VALUE}};
    end else begin
      q_o <= meta;
      for (j = 0; j < WIDTH; j = j + 1) meta[j] <= ($time - changed[j] < bench.window && bench.drawn(2) == 0) ? old[j] : d_i[j];
    end
  end
endmodule
"""
BINARY = (  # pointers in binary, consistently, and without the assertion that would tell
    ("gray_pointer", "^code_q[WIDTH-1:i]", "code_q[i]"),
    ("gray_pointer", "(count + WIDTH'(1)) ^ ((count + WIDTH'(1)) >> 1)", "count + WIDTH'(1)"),
    ("gray_pointer", "`DTOF_ASSERT(a_one_bit, !step_i ||", "`DTOF_ASSERT(a_one_bit, 1'b1 ||"),
    ("async_line_fifo", "POINTER_WIDTH'(3 << (POINTER_WIDTH - 2))", "POINTER_WIDTH'(1 << (POINTER_WIDTH - 1))"),
)
FAULTS = {
    "a full memory is written": (("async_line_fifo", " && (write_pointer != (freed ^ WHOLE_DEPTH))", ""),),
    "a place is never used": (("async_line_fifo", "POINTER_WIDTH'(3 << (POINTER_WIDTH - 2))", "POINTER_WIDTH'(0)"),),
    "a taken line stays": (("async_line_fifo", ".step_i   (take && !empty)", ".step_i   (take && !empty && s_tdata_i[1:0] != '1)"),),
    "a reset of the TDC side takes an offered line away": (("async_line_fifo", "reader_q[1] &&", "(reader_q == LIVE) &&"),),
    "a line that a reset may have cut is delivered": (("async_line_fifo", "end else if (on_q) begin\n      shown_q", "end else begin\n      shown_q"),),
    "an acquisition that a reset has cut has no end": (("async_line_fifo", "(empty && !open_q)", "(empty)"),),
    "behind a reset the read-out begins inside an acquisition": (("async_line_fifo", "skip_q <= inside_q", "skip_q <= 1'b0"),),
    "the rest that is dropped has no end": (("async_line_fifo", "end else if (accepted && s_tlast_i) begin", "end else if (1'b0) begin"),),
    "the memory is cleared while the reader drains it": (("async_line_fifo", "(reader == WAITS)", "(reader != LIVE)"),),
    "the TDC side never sees a reset of the read-out": (("async_line_fifo", "on_q ? reader[0] : begins", "on_q || begins"),),
    "the reader does not wait for the pointers to be cleared": (("async_line_fifo", "WAITS: if (on)", "WAITS: if (1'b1)"),),
}


class Simulation:
    """The FIFO in its bench, with some texts of its files replaced."""

    def __init__(self, folder: Path, depth: int, uncertain: bool, changes: tuple[tuple[str, str, str], ...] = ()) -> None:
        texts = dict(SOURCES)
        if uncertain:
            texts["synchroniser"] = UNCERTAIN
        for name, old, new in changes:
            if texts[name].count(old) != 1:
                raise AssertionError(f"dtof_{name}.sv must have exactly once: {old}")
            texts[name] = texts[name].replace(old, new)
        files = []
        for name, text in texts.items():
            files.append(folder / f"{name}.sv")
            files[-1].write_text(text, encoding="utf-8")
        self.program = folder / "bench.vvp"
        subprocess.run(["iverilog", "-g2012", f"-I{ROOT}/hdl/common", "-s", "bench", f"-Pbench.DEPTH={depth}", "-o", self.program, *files, BENCH],
                       check=True)

    def run(self, **options: int) -> str:
        """The verdict."""
        arguments = [f"+{name}={value}" for name, value in options.items()]
        done = subprocess.run(["vvp", "-n", self.program, *arguments], capture_output=True, text=True, timeout=600)
        return done.stdout.strip().splitlines()[-1] if done.stdout.strip() else "no output"


def window(ratio: tuple[int, int]) -> int:
    """Nearly a period of the faster clock: what the constraints leave to the way of a bit."""
    return 2 * min(ratio) - 1


def counts(verdict: str) -> dict[str, int]:
    return {name: int(value) for name, value in re.findall(r"(\w+)=(\d+)", verdict)}


class AsyncLineFifo(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def test_every_line_leaves_once_and_in_order(self) -> None:
        for depth in (2, 8):
            for uncertain in (False, True):
                simulation = Simulation(self.folder, depth, uncertain)
                for number, ratio in enumerate(RATIOS):
                    options = {"seed": number + 1, "half_tdc": ratio[0], "half_read": ratio[1], "lines": LINES, "gap": 5 * (number % 3),
                               "stall": 12 - 6 * (number % 3), "window": window(ratio)}
                    with self.subTest(depth=depth, uncertain=uncertain, **options):
                        verdict = simulation.run(**options)
                        self.assertTrue(verdict.startswith("PASS"), verdict)
                        seen = counts(verdict)
                        self.assertEqual((seen["sent"], seen["taken"]), (LINES, LINES))

    def test_resets_lose_what_the_header_says_and_no_more(self) -> None:
        total: dict[str, int] = {}
        for depth in (2, 4):
            simulation = Simulation(self.folder, depth, True)
            for number, ratio in enumerate(RATIOS):
                options = {"seed": 100 + number, "half_tdc": ratio[0], "half_read": ratio[1], "lines": LINES, "gap": 2 + 4 * (number % 2),
                           "stall": 10 - 4 * (number % 3), "window": window(ratio), "resets": 40 * max(ratio)}
                with self.subTest(depth=depth, **options):
                    verdict = simulation.run(**options)
                    self.assertTrue(verdict.startswith("PASS"), verdict)
                    for name, value in counts(verdict).items():
                        total[name] = total.get(name, 0) + value
        # Each situation came, or the list of expected lines proves nothing.
        self.assertGreater(min(total[name] for name in ("full", "empty", "ends", "skipped", "lost", "tdc_resets", "read_resets")), 50, total)

    def test_eight_lines_pass_a_line_per_clock(self) -> None:
        simulation = Simulation(self.folder, 8, True)
        for ratio in RATIOS:
            seen = counts(simulation.run(seed=7, half_tdc=ratio[0], half_read=ratio[1], lines=LINES, gap=0, stall=0, window=window(ratio)))
            with self.subTest(ratio=ratio):
                self.assertLess(seen["clocks"], 1.01 * LINES + 50)

    def found(self, changes: tuple[tuple[str, str, str], ...], uncertain: bool) -> str:
        """What the first of a few runs, with and without resets, says against changed RTL."""
        simulation = Simulation(self.folder, 4, uncertain, changes)
        for seed, (resets, ratio) in enumerate(((resets, ratio) for resets in (40, 0) for ratio in RATIOS[::2]), 1):
            verdict = simulation.run(seed=seed, half_tdc=ratio[0], half_read=ratio[1], lines=LINES, resets=resets * max(ratio),
                                     window=window(ratio) if uncertain else 0)
            if not verdict.startswith("PASS"):
                return verdict
        return ""

    def test_illegal_parameters_stop_with_a_sentence(self) -> None:
        for old, sentence in ((".DEPTH(DEPTH)", "DEPTH must be a power of two, at least 2"), (".WIDTH(WIDTH)", "WIDTH must be at least 1")):
            for value in (3, 1, 0) if "DEPTH" in old else (0,):
                with self.subTest(old=old, value=value):
                    top = f"module top; dtof_async_line_fifo #({old.split('(')[0]}({value})) u_fifo (); endmodule\n"
                    (self.folder / "top.sv").write_text("".join(SOURCES.values()) + top, encoding="utf-8")
                    built = subprocess.run(["verilator", "--lint-only", "-Wno-lint", "-Wno-PINMISSING", f"-I{ROOT}/hdl/common", self.folder / "top.sv", "--top-module", "top"],
                                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                    self.assertNotEqual(built.returncode, 0)
                    self.assertIn(f"dtof_async_line_fifo: {sentence}", built.stdout)

    def test_planted_faults_are_found(self) -> None:
        for fault, changes in FAULTS.items():
            with self.subTest(fault=fault):
                self.assertTrue(self.found(changes, True))

    def test_only_the_uncertain_synchroniser_finds_binary_pointers(self) -> None:
        self.assertEqual(self.found(BINARY, False), "")
        self.assertTrue(self.found(BINARY, True))


SYNCHRONISER_BENCH = """
module bench;
  logic clk = 1'b0, rst_n = 1'b0;
  logic [1:0] level = 2'b00;
  wire [1:0] out;
  dtof_synchroniser #(.WIDTH(2), .RESET_VALUE(2'b10)) u_dut (.clk_i(clk), .rst_ni(rst_n), .d_i(level), .q_o(out));
  always @(out) $display("%0d %b", $time, out);
  initial begin
    #11 rst_n = 1'b1;      // before the edge at 15
    #1 level = 2'b01;      // 12: at the edge at 25
    #20 level = 2'b11;     // 32: edges at 35 and 45
    #20 rst_n = 1'b0;      // 52: at once
    #1 $finish;
  end
  always #5 clk = !clk;
endmodule
"""


class Synchroniser(unittest.TestCase):
    def changes(self, text: str) -> list[str]:
        with tempfile.TemporaryDirectory() as folder:
            source, program = Path(folder) / "bench.sv", Path(folder) / "bench.vvp"
            source.write_text(text + SYNCHRONISER_BENCH, encoding="utf-8")
            subprocess.run(["iverilog", "-g2012", "-s", "bench", "-o", program, source], check=True)
            output = subprocess.run(["vvp", "-n", program], check=True, capture_output=True, text=True).stdout
            return [line for line in output.splitlines() if re.fullmatch(r"\d+ [01x]+", line)]

    EXPECTED = ["5 10", "25 01", "45 11", "52 10"]

    def test_a_level_arrives_with_the_second_edge(self) -> None:
        self.assertEqual(self.changes(SOURCES["synchroniser"]), self.EXPECTED)

    def test_what_is_wrong_is_seen(self) -> None:
        text = SOURCES["synchroniser"]
        for old, new in (("= stable_q;", "= meta_q;"), (" or negedge rst_ni", ""), ("stable_q <= RESET_VALUE", "stable_q <= '0")):
            with self.subTest(old=old):
                self.assertEqual(text.count(old), 1)
                self.assertNotEqual(self.changes(text.replace(old, new)), self.EXPECTED)


if __name__ == "__main__":
    unittest.main()
