# SPDX-License-Identifier: Apache-2.0
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import fpga
from dtof_synth import readouts
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]
REPORT = {"utilization": {"ICESTORM_LC": {"used": 3762, "available": 7680}, "ICESTORM_RAM": {"used": 30, "available": 32}},
          "fmax": {"clk_i": {"achieved": 68.16, "constraint": 12.0}}}  # fmt: skip
ICETIME = "Total number of logic levels: 7\nTotal path delay: 16.00 ns (62.50 MHz)\n"
CELLS = {"SB_LUT4": 2525, "SB_DFF": 550, "SB_DFFE": 645, "SB_CARRY": 769, "SB_RAM40_4K": 29, "SB_RAM40_4KNR": 1}
FOUND = fpga.Result(fpga.Use(3762, 7680), fpga.Use(30, 32), 68.16, 62.5)


class Fpga(unittest.TestCase):
    def test_results_are_read(self):
        self.assertEqual(fpga.result(REPORT, ICETIME), FOUND)
        for report, icetime in ((REPORT | {"fmax": {}}, ICETIME), (REPORT, "nothing")):
            with self.assertRaisesRegex(FlowError, "how fast"):
                fpga.result(report, icetime)

    def test_what_is_wrong_is_reported(self):
        self.assertEqual(fpga.problems(FOUND, CELLS, 30), [])
        self.assertEqual(fpga.problems(FOUND, CELLS, 31), ["30 block RAMs for 31 memories"])
        self.assertEqual(fpga.problems(FOUND, CELLS, 0), ["the simulation names no memories"])
        slow = fpga.Result(FOUND.cells, FOUND.block_rams, 68.16, 11.9)
        self.assertEqual(fpga.problems(slow, CELLS, 30), ["slower than the board's 12 MHz"])

    def test_the_sources_are_all_of_the_folder_with_the_memories_of_an_fpga(self):
        sources = fpga.sources()
        self.assertIn("technology/fpga/dtof_sram_1rw.sv", sources)
        self.assertFalse([file for file in sources if "behavioural" in file or not (ROOT / "hdl" / file).is_file()])
        self.assertEqual(sum(file.startswith("../fpga/") for file in sources),
                         len(list((ROOT / "fpga").glob("*.sv"))))  # fmt: skip

    def test_the_pins_are_the_tops_ports(self):
        top = (ROOT / "fpga/demonstrator.sv").read_text(encoding="utf-8")
        pins = (ROOT / "fpga/ice40_hx8k.pcf").read_text(encoding="utf-8")
        ports = re.findall(r"^    (?:input|output) +logic (\w+)", top, re.MULTILINE)
        self.assertEqual(sorted(ports), sorted(re.findall(r"^set_io (\w+) ", pins, re.MULTILINE)))

    def test_a_test_that_ran_nothing_is_no_test(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(fpga, "BUILD", Path(folder)):
            program = Path(folder) / "test.sh"
            for text, passes in (("[       OK ] D.DepthsAreTheModels (1 ms)\n[  PASSED  ] 1 tests.\n", True),
                                 ("[  PASSED  ] 0 tests.\n", False), ("", False)):  # fmt: skip
                program.write_text(f"#!/bin/sh\ncat << END\n{text}END\n", encoding="utf-8")
                program.chmod(0o755)
                with mock.patch.object(fpga, "run", lambda command, *_: subprocess.check_output(command, text=True)):
                    if passes:
                        self.assertEqual(fpga.passed(fpga.DESIGNS[0], program), "passed `DepthsAreTheModels`")
                    else:
                        with self.assertRaises(FlowError):
                            fpga.passed(fpga.DESIGNS[0], program)

    def test_the_report_has_what_was_found(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(fpga, "BUILD", Path(folder)):
            (Path(folder) / "demonstrator.bin").write_bytes(bytes(1234))
            (Path(folder) / "demonstrator_pool.bin").write_bytes(bytes(5678))
            text = fpga.report([fpga.Outcome(fpga.DESIGNS[0], FOUND, CELLS, 30, "passed `X`"),
                                fpga.Outcome(fpga.DESIGNS[1], FOUND, CELLS, 13, "passed `Y`")])  # fmt: skip
        for part in ("3,762 of 7,680 (49 %)", "30 of 32 (94 %)", "68.2 MHz", "62.5 MHz", "| 1,195 |", "1,234 bytes | 5,678 bytes",
                     "1,000 kbit/s", "| 30 | 13 |", "| 8 x 8 | 2 x 8 |", "* poolPointer lean: passed `Y`"):  # fmt: skip
            self.assertIn(part, text)

    def test_the_netlists_tests_expect_what_the_designs_are(self):
        expected = (ROOT / "tb_cpp/tests/demonstrator/CMakeLists.txt").read_text(encoding="utf-8")
        package = (ROOT / "hdl/common/dtof_readouts.svh").read_text(encoding="utf-8")
        for design in fpga.DESIGNS:
            name = "".join(word[0].upper() + word[1:] for word in design.readout.split())
            size = ";".join([f"k{name}", *(str(design.parameters[parameter]) for parameter in ("COLUMNS", "ROWS", "CLOCKS_PER_BIT"))])
            arguments = [f'"{size}"', *(f"{parameter}={value}" for parameter, value in design.settings.items())]
            self.assertIn(f"dtof_demonstrator({design.name} {' '.join(arguments)})", expected)
            if "READOUT" in design.settings:
                number = f"READOUT_{design.readout.split()[0].upper()} = {design.settings['READOUT']};"  # lean is poolPointer with other parameters
                self.assertIn(number, package)

    def test_the_pool_readout_is_lean(self):
        lean = readouts.load().readouts["poolpointer-lean"].defaults
        with mock.patch.object(fpga, "TOP", "demonstrator_core"):
            own = fpga.parameters()
        named = ["GROUP_SIZE", "LABELS", "OFFSET_BITS", "ADVANTAGE_WIDTH", "POINTER_SHIFT", "RIVAL_MOVES", "TRACK_SHARE"]
        self.assertEqual({name: own[name] for name in named}, {name: int(lean[name]) for name in named})


if __name__ == "__main__":
    unittest.main()
