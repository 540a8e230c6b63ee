# SPDX-License-Identifier: Apache-2.0
"""hdl/technology/mbist in Icarus Verilog. The memory self-test finds every drawn fault, lets good memories pass, and reaches all memories of
an array over the side band; changed tests must miss some of the faults. The scan bypass shows each input of a macro, and keeps its words."""

import random
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HDL = ROOT / "hdl"
BENCH = ROOT / "scripts" / "tests" / "march_test_bench.sv"
DEPTH, WIDTH = 12, 5
STUCK, TRANSITION, INVERTED, SET, STATE, DECODER = range(1, 7)


def faults(number: int, seed: int) -> list[dict[str, int]]:
    """Faults of all kinds. A change of a bit disturbs bits of other words; a state also bits of its own word."""
    draw = random.Random(seed)
    found = []
    for index in range(number):
        kind = 1 + index % 6
        address, other = draw.sample(range(DEPTH), 2)
        fault = {"kind": kind, "address": address, "bit": draw.randrange(WIDTH), "other_address": other, "other_bit": draw.randrange(WIDTH),
                 "value": draw.randrange(2), "other_value": draw.randrange(2)}  # fmt: skip
        if kind == STATE and draw.randrange(2):
            fault["other_address"] = address
            fault["other_bit"] = draw.choice([bit for bit in range(WIDTH) if bit != fault["bit"]])
        found.append(fault)
    return found


class MarchTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.mbist = self.folder / "mbist"
        shutil.copytree(HDL / "technology" / "mbist", self.mbist)

    def build(self, top: str, **parameters: int) -> None:
        files = [str(HDL / line) for line in (HDL / "dtof.f").read_text(encoding="utf-8").splitlines()
                 if line.endswith(".sv") and not line.startswith(("//", "technology/dtof_sram", "technology/behavioural/dtof_sram"))]
        result = subprocess.run(["iverilog", "-g2012", "-DDTOF_SRAM_CFG_WIDTH=2", f"-I{HDL / 'common'}", "-s", top,
                                 *(f"-P{top}.{name}={value}" for name, value in parameters.items()), "-o", str(self.folder / "bench.vvp"), *files,
                                 *map(str, sorted(self.mbist.glob("*.sv"))), str(BENCH)], capture_output=True, text=True, check=False)  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def verdict(self, fault: dict[str, int] | None = None) -> str:
        result = subprocess.run(["vvp", "-n", str(self.folder / "bench.vvp"), *(f"+{name}={value}" for name, value in (fault or {}).items())],
                                capture_output=True, text=True, check=True)  # fmt: skip
        return result.stdout.strip()

    def missed(self, drawn: list[dict[str, int]]) -> list[dict[str, int]]:
        return [fault for fault in drawn if self.verdict(fault).startswith("good")]

    def test_all_faults_are_found_in_the_clocks_of_the_header(self) -> None:
        clocks = 10 * DEPTH * 4 + 1  # four backgrounds of five bits
        for ports in (1, 2):
            self.build("march_test_bench", DEPTH=DEPTH, WIDTH=WIDTH, PORTS=ports)
            self.assertEqual(self.verdict(), f"good after {clocks} clocks")
            self.assertEqual(self.missed(faults(60, seed=ports)), [])

    def test_small_memories(self) -> None:
        for depth, width, backgrounds in ((1, 1, 1), (2, 1, 1), (3, 2, 2), (16, 8, 4), (5, 33, 7)):  # depth, width, backgrounds
            with self.subTest(depth=depth, width=width):
                self.build("march_test_bench", DEPTH=depth, WIDTH=width, PORTS=1)
                self.assertEqual(self.verdict(), f"good after {10 * depth * backgrounds + 1} clocks")
                for value in (0, 1):
                    fault = {"kind": STUCK, "address": depth - 1, "bit": width - 1, "value": value}
                    self.assertTrue(self.verdict(fault).startswith("bad"), fault)

    def test_a_write_mask_that_the_test_does_not_open_is_found(self) -> None:
        path = self.mbist / "dtof_sram_1rw.sv"
        text = path.read_text(encoding="utf-8")
        self.assertEqual(text.count("wparts_i | {PARTS{test}}"), 1)
        path.write_text(text.replace("wparts_i | {PARTS{test}}", "wparts_i"), encoding="utf-8")
        self.build("march_test_bench", DEPTH=DEPTH, WIDTH=WIDTH, PORTS=1)
        self.assertTrue(self.verdict().startswith("bad"))

    def test_changed_tests_miss_faults(self) -> None:
        drawn = faults(60, seed=3)
        up = (("assign down = (element_q == 3'd3) || (element_q == 3'd4);", "assign down = 1'b0;"),
              ("assign next_down = (element_q == 3'd2) || (element_q == 3'd3);", "assign next_down = 1'b0;"))
        for changes, kinds in (((("(WIDTH > 1) ? $clog2(WIDTH) + 1 : 1", "1"),), {STATE}),  # one background
                               (up, None),  # one order of addresses
                               ((("if (compared_q) begin", "if (compared_q && element_q < 3'd3) begin"),), None),
                               ((("done_o = run_i && ended_q", "done_o = run_i && (element_q == 3'd3 || ended_q)"),), None)):  # fmt: skip
            with self.subTest(changes=changes):
                path = self.mbist / "dtof_march_test.sv"
                text = changed = path.read_text(encoding="utf-8")
                for old, new in changes:
                    self.assertEqual(text.count(old), 1)
                    changed = changed.replace(old, new)
                path.write_text(changed, encoding="utf-8")
                self.build("march_test_bench", DEPTH=DEPTH, WIDTH=WIDTH, PORTS=1)
                missed = self.missed(drawn) if self.verdict().startswith("good") else []
                path.write_text(text, encoding="utf-8")
                self.assertTrue(missed)
                if kinds:
                    self.assertEqual({fault["kind"] for fault in missed}, kinds)

    def test_all_memories_of_an_array_are_tested_together(self) -> None:
        for readout, depths in ((0, (5,)), (2, (5, 40))):  # ezPointer; hisPointer, with a histogram of eight bins
            self.build("march_array_bench", READOUT=readout)
            self.assertTrue(self.verdict().startswith("good"), self.verdict())
            for depth in depths:
                fault = {"kind": STUCK, "address": depth - 1, "bit": 0, "value": 1, "depth": depth}
                self.assertTrue(self.verdict(fault).startswith("bad"), f"READOUT {readout}, memories of {depth} words")

    def test_the_scan_bypass_shows_every_input_and_keeps_the_words(self) -> None:
        for ports in (1, 2):
            for depth, width in ((12, 5), (2, 1), (16, 33)):
                with self.subTest(ports=ports, depth=depth, width=width):
                    self.build("scan_bypass_bench", DEPTH=depth, WIDTH=width, PORTS=ports)
                    self.assertEqual(self.verdict(), "good, 0 wrong")

    def test_a_changed_scan_bypass_is_found(self) -> None:
        for name, ports, old, new in (
                ("dtof_scan_bypass.sv", 1, "(INPUTS + WIDTH - 1) / WIDTH", "INPUTS / WIDTH"),
                ("dtof_scan_bypass.sv", 2, "folded = folded ^ filled", "folded = folded | filled"),
                ("dtof_scan_bypass.sv", 1, "scan_i ? folded_q : macro_rdata_i", "macro_rdata_i"),
                ("dtof_sram_1rw.sv", 1, "{en_i, we_i, addr_i, wparts_i, wdata_i}", "{en_i, en_i, addr_i, wparts_i, wdata_i}"),
                ("dtof_sram_1rw.sv", 1, "en_i && !scan", "en_i"),
                ("dtof_sram_1r1w.sv", 2, "we_i && !scan", "we_i"),
                ("dtof_sram_1r1w.sv", 2, "{re_i, we_i, raddr_i, waddr_i, wdata_i}", "{re_i, we_i, waddr_i, waddr_i, wdata_i}")):  # fmt: skip
            with self.subTest(name=name, new=new):
                path = self.mbist / name
                text = path.read_text(encoding="utf-8")
                self.assertEqual(text.count(old), 1)
                path.write_text(text.replace(old, new), encoding="utf-8")
                self.build("scan_bypass_bench", DEPTH=DEPTH, WIDTH=WIDTH, PORTS=ports)
                verdict = self.verdict()
                path.write_text(text, encoding="utf-8")
                self.assertNotEqual(verdict, "good, 0 wrong")


if __name__ == "__main__":
    unittest.main()
