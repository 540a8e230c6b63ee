# SPDX-License-Identifier: Apache-2.0
import subprocess
import unittest
from pathlib import Path
from unittest import mock

import timing_diagrams
from dtof_synth.errors import FlowError
from timing_diagrams import Diagram, Lane

ROOT = Path(__file__).resolve().parents[2]

# Three rising edges; `a` and `data` change behind the first one, `a` falls behind the second.
VCD = """$scope module timing_bench $end
$var reg 1 ! clk $end
$var int 32 " diagram [31:0] $end
$scope module inside $end
$var wire 1 # a $end
$var wire 8 $ data [7:0] $end
$upscope $end
$upscope $end
$enddefinitions $end
#0
$dumpvars
b1 "
0!
0#
bx $
$end
#10
1!
#11
1#
b10110 $
#20
0!
#30
1!
#31
0#
#40
0!
#50
1!
"""
DIAGRAM = Diagram(1, "x", "Title", (Lane("a", "inside.a"), Lane("low", "inside.data", 4),
                                    Lane("high", "inside.data", 4, lsb=4, valid="inside.a", hexadecimal=False)))  # fmt: skip


class TimingDiagrams(unittest.TestCase):
    def test_what_is_committed_is_what_a_simulation_shows(self):
        result = subprocess.run([str(ROOT / "scripts/timing_diagrams.py"), "--check"], text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, check=False)  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_a_clock_shows_what_its_edge_samples(self):
        source = timing_diagrams.wavedrom(DIAGRAM, timing_diagrams.waveform(VCD))
        self.assertEqual(source["signal"], [{"name": "clk_i", "wave": "p.."}, {"name": "a", "wave": "010"},
                                            {"name": "low", "wave": "x=.", "data": ["6"]},
                                            {"name": "high", "wave": "x=x", "data": ["1"]}])  # fmt: skip

    def test_what_the_bench_does_not_have_is_reported(self):
        wave = timing_diagrams.waveform(VCD)
        with self.assertRaisesRegex(FlowError, "no diagram 2"):
            timing_diagrams.wavedrom(Diagram(2, "x", "", ()), wave)
        with self.assertRaisesRegex(FlowError, "no signal b"):
            timing_diagrams.wavedrom(Diagram(1, "x", "", (Lane("b", "b"),)), wave)
        with self.assertRaisesRegex(FlowError, "no place"):
            timing_diagrams.page("a page", "a table")

    def test_a_frame_is_not_shorter_than_its_lines(self):
        with mock.patch.object(timing_diagrams, "simulated", return_value="cycles 0 lines 2048\n"):
            with self.assertRaisesRegex(FlowError, "a frame of 0 clocks cannot take 2048 lines"):
                timing_diagrams.frame_clocks()

    def test_a_drawing_has_every_value_and_name(self):
        text = timing_diagrams.svg(timing_diagrams.wavedrom(DIAGRAM, timing_diagrams.waveform(VCD)))
        for part in ("Title", ">low<", ">high<", ">6<", ">1<"):
            self.assertIn(part, text)
        self.assertEqual(text.count("<path"), 4 + 3 + 3 + 2 + 3)  # lines between clocks, clocks, each lane's stretches


if __name__ == "__main__":
    unittest.main()
