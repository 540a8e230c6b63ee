# SPDX-License-Identifier: Apache-2.0
"""The save file of a waveform: which signal stands in which group, and what a waveform must have."""

import contextlib
import io
import re
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import wave_groups

HEADER = """\
$scope module array $end
$var wire 1 ! clk_i $end
$var wire 1 " rst_ni $end
$var wire 1 # start_i $end
$var wire 128 $ tdc_timestamp_i [127:0] $end
$var wire 16 % result_code_o [15:0] $end
$scope module u_array $end
$var parameter 32 & width_t1 [31:0] $end
$var logic 1 ' beat_t1 $end
$var logic 1 ( step_t0 [0:0] $end
$scope module g_column[0] $end
$var wire 1 ' beat_t1_i $end
$var logic 10 ) timestamp_t1 [9:0] $end
$var logic 5 * bin_t10_q [4:0] $end
$var wire 5 + bin_s2_i [4:0] $end
$scope module u_builder $end
$scope module u_word_sram $end
$var wire 1 , read_en_i $end
$var wire 1 ! clk_i $end
$scope module u_macro $end
$var wire 1 , re_i $end
$upscope $end
$upscope $end
$upscope $end
$upscope $end
$scope module g_column[10] $end
$var logic 10 - timestamp_t1 [9:0] $end
$upscope $end
$upscope $end
$upscope $end
$enddefinitions $end
$var wire 1 . value_t1 $end
""".splitlines()


def paths(group: list[wave_groups.Signal]) -> list[str]:
    return [signal.path.removeprefix("array.") for signal in group]


class Groups(unittest.TestCase):
    def setUp(self):
        self.groups = wave_groups.groups(wave_groups.read_signals(HEADER))

    def test_order_is_that_of_the_pipeline(self):
        self.assertEqual(list(self.groups), ["Clock and reset", "Frame", "TDC stream", "Stream T0", "Stream T1", "Stream T10", "Scan S2",
                                             "Memory builder.word_sram", "Result stream"])

    def test_a_net_stands_once_in_its_stage_by_its_outermost_name(self):
        self.assertEqual(paths(self.groups["Stream T1"]), ["u_array.beat_t1", "u_array.g_column[0].timestamp_t1[9:0]"])

    def test_a_bus_of_one_bit_has_no_range(self):
        self.assertEqual(paths(self.groups["Stream T0"]), ["u_array.step_t0"])

    def test_only_ports_of_the_memory_itself(self):
        self.assertEqual(paths(self.groups["Memory builder.word_sram"]),
                         ["u_array.g_column[0].u_builder.u_word_sram.read_en_i"])

    def test_save_file(self):
        text = wave_groups.save_file(Path("build/wave/sifh.fst"), self.groups)
        self.assertIn('[dumpfile] "sifh.fst"\n', text)
        self.assertIn("@800200\n-TDC stream\n@22\narray.tdc_timestamp_i[127:0]\n@1000200\n-TDC stream\n", text)
        self.assertIn("@c00200\n-Scan S2\n@22\narray.u_array.g_column[0].bin_s2_i[4:0]\n@1401200\n-Scan S2\n", text)


class Missing(unittest.TestCase):
    def test_nothing_is_missing(self):
        self.assertEqual(wave_groups.missing(wave_groups.groups(wave_groups.read_signals(HEADER))), [])

    def lacking(self, pattern: str) -> list[str]:
        header = [line for line in HEADER if not re.search(pattern, line)]
        return wave_groups.missing(wave_groups.groups(wave_groups.read_signals(header)))

    def test_what_a_waveform_must_have(self):
        self.assertEqual(self.lacking("result_"), ["Result stream"])
        self.assertEqual(self.lacking(r"_t\d"), ["Stream T1"])
        self.assertEqual(self.lacking("read_en_i"), ["Memory"])

    def test_a_waveform_without_streams_is_refused_and_nothing_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            waveform = Path(folder) / "sifh.fst"
            waveform.touch()
            error = io.StringIO()
            with mock.patch.object(wave_groups, "read_header", return_value=[line for line in HEADER if "tdc_" not in line]), \
                    mock.patch("sys.argv", ["wave_groups.py", str(waveform)]), contextlib.redirect_stderr(error):
                self.assertEqual(wave_groups.main(), 1)
            self.assertIn("no signals for TDC stream", error.getvalue())
            self.assertFalse(waveform.with_suffix(".gtkw").exists())

    def test_a_missing_file_is_named(self):
        error = io.StringIO()
        with mock.patch("sys.argv", ["wave_groups.py", "nowhere.fst"]), contextlib.redirect_stderr(error):
            self.assertEqual(wave_groups.main(), 1)
        self.assertIn("nowhere.fst: no waveform", error.getvalue())


if __name__ == "__main__":
    unittest.main()
