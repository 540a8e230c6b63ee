# SPDX-License-Identifier: Apache-2.0
"""The chips in open silicon: inputs of layout flows, what OpenSTA says, and the report. The PDK itself is needed by `make shuttle` alone."""

import gzip
import json
import re
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import shuttle
from dtof_synth.errors import FlowError
from dtof_synth.shuttle import CHIPS, Corner, Result

from .partial import part_of

ROOT = Path(__file__).resolve().parents[2]
RESET = """Group                                  Slack
--------------------------------------------
**async_default**                      {}

"""
CHECKED = """DTOF_CHECK
Warning: There are 2 unconstrained endpoints.
  a/D
  b/D
DTOF_END
DTOF_SLACK 13.5 0.25
DTOF_INSIDE 1.2e+01
Startpoint: x
DTOF_RECOVERY
""" + RESET.format("18.12") + "DTOF_REMOVAL\n" + RESET.format("1.19") + """DTOF_TRANSITION
max_transition

Pin                                    Limit   Trans   Slack
------------------------------------------------------------
a/CLK                                   2.50  167.82 -165.32 (VIOLATED)
gate/GCLK                               2.50  167.82 -165.32 (VIOLATED)

DTOF_END
DTOF_STA_OK
"""
CORNER = Corner(13.5, 12.0, 0.25, 18.12, 1.19, 2)


class Inputs(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def test_corners_are_found_by_name_and_uncompressed(self) -> None:
        pdk = self.folder / "pdk/ihp-sg13g2/lib"
        pdk.mkdir(parents=True)
        for corner, suffix in shuttle.CORNERS.items():
            (pdk / f"sg13g2_stdcell_{suffix}.lib.gz").write_bytes(gzip.compress(corner.encode()))
        found = shuttle.liberties(self.folder / "pdk", self.folder)
        self.assertEqual({corner: path.read_text() for corner, path in found.items()}, {corner: corner for corner in shuttle.CORNERS})
        (pdk / "sg13g2_stdcell_typ_1p20V_25C.lib.gz").unlink()
        with self.assertRaisesRegex(FlowError, r"sg13g2_stdcell_typ_1p20V_25C.lib is not here; PDK=<folder>"):
            shuttle.liberties(self.folder / "pdk", self.folder)

    def test_both_layout_flows_read_the_same_files(self) -> None:
        for chip in CHIPS:
            folder = self.folder / "build/shuttle" / chip.name
            folder.mkdir(parents=True)
            # The paths begin three levels below the project.
            for name in ("hdl", "fpga", "shuttle"):
                if not (self.folder / name).exists():
                    (self.folder / name).symlink_to(ROOT / name)
            config = shuttle.librelane(chip, 20.0)
            files = shuttle._own_files(config, folder)
            self.assertIn(ROOT / "hdl/technology/ihp130/dtof_sram_1rw.sv", files)
            self.assertFalse([file for file in files if "behavioural" in str(file)])
            self.assertEqual(len(files), len(set(files)))
            (folder / "config.mk").write_text(shuttle.orfs(chip, 1000), encoding="utf-8")
            shuttle.check_orfs(folder / "config.mk", files)
            self.assertEqual(shuttle.expanded(folder / "config.mk")["VERILOG_TOP_PARAMS"].split()[:2], ["READOUT", str(chip.parameters["READOUT"])])
            with self.assertRaisesRegex(FlowError, "differ from those of LibreLane"):
                shuttle.check_orfs(folder / "config.mk", files[1:])
            (folder / "config.mk").write_text(shuttle.orfs(chip, 1000).replace("dtof_shuttle.sdc", "other.sdc"), encoding="utf-8")
            with self.assertRaisesRegex(FlowError, "SDC_FILE: .*other.sdc is not here"):
                shuttle.check_orfs(folder / "config.mk", files)
            config["VERILOG_FILES"].append("dir::nowhere.sv")
            with self.assertRaisesRegex(FlowError, "nowhere.sv: in the inputs of LibreLane"):
                shuttle._own_files(config, folder)

    def test_the_largest_memory_is_that_of_a_simulation(self) -> None:
        chip = CHIPS[1]
        with mock.patch.object(shuttle, "BUILD", self.folder):
            chip.folder.mkdir()
            self.assertEqual(shuttle.memory_bits(chip), 9 * 128)  # a word of four columns has 128 bits; 16 pixels are two groups, 9 words

    def test_the_period_is_that_of_the_constraints(self) -> None:
        text = (ROOT / "shuttle/dtof_shuttle.sdc").read_text(encoding="utf-8")
        self.assertEqual(shuttle.period(text), 20.833)
        with self.assertRaisesRegex(FlowError, "no line 'set period"):
            shuttle.period(text.replace("set period", "set clock"))

    def test_the_cpp_tests_have_the_same_chips(self) -> None:
        text = (ROOT / "tb_cpp/tests/demonstrator/CMakeLists.txt").read_text(encoding="utf-8")
        defaults = {name: int(value) for name, value in re.findall(
            r"parameter int (\w+) = (\d+)", (ROOT / "shuttle/dtof_shuttle.sv").read_text(encoding="utf-8"))}
        found = {}
        for name, columns, rows, bits, rest in re.findall(r'^dtof_shuttle\((\w+) "\w+;(\d+);(\d+);(\d+)" (.*)\)$', text, re.MULTILINE):
            given = {key: int(value) for key, value in (entry.split("=") for entry in rest.split())}
            found[name] = {"READOUT": given["READOUT"], "COLUMNS": int(columns), "ROWS": int(rows)}
            self.assertEqual((defaults | given)["COLUMNS"], int(columns))
            self.assertEqual((defaults | given)["ROWS"], int(rows))
            self.assertEqual(defaults["CLOCKS_PER_BIT"], int(bits))
        self.assertEqual(found, {chip.name: chip.parameters for chip in CHIPS})


class Timing(unittest.TestCase):
    def test_slacks_are_read(self) -> None:
        self.assertEqual(shuttle.corner(CHECKED), CORNER)

    def test_what_opensta_did_not_time_or_refused_is_an_error(self) -> None:
        for old, new, message in (("gate/GCLK", "gate/Y", "gate/Y: the transition is slower"),
                                  ("Warning: There are 2 unconstrained endpoints.", "Warning: There are 3 unclocked register/latch pins.", "OpenSTA: .*unclocked"),
                                  ("DTOF_SLACK", "SLACK", "printed no slacks"), ("DTOF_INSIDE", "INSIDE", "printed no slacks"), ("DTOF_REMOVAL", "REMOVAL", "printed no slacks"),
                                  ("**async_default**                      1.19", "No paths found.", "no check of the reset")):
            with self.assertRaisesRegex(FlowError, message):
                shuttle.corner(CHECKED.replace(old, new))

    def test_negative_slacks_are_faults(self) -> None:
        result = Result(10, 2, 0.5, 0.8, 20.0, {"slow": CORNER, "fast": replace(CORNER, hold=-0.01, removal=-0.02)})
        self.assertEqual(shuttle.faults(result), ["fast corner: hold slack -0.010 ns", "fast corner: removal slack -0.020 ns"])

    def test_flip_flops_with_a_constant_input_are_counted(self) -> None:
        def flip_flop(net: int) -> dict:
            return {"type": "ff", "connections": {"D": [net]}, "port_directions": {"D": "input"}}

        tie = {"type": "tie", "connections": {"Y": [5]}, "port_directions": {"Y": "output"}}
        cells = part_of(shuttle.Library, tie={"1": ("tie", "Y")}, sequential={"ff"})
        module = {"cells": {"a": flip_flop(5), "b": flip_flop(6), "c": flip_flop(5), "t": tie}}
        self.assertEqual(shuttle.constant_ends(module, cells), 2)


class Report(unittest.TestCase):
    RESULTS = {chip: Result(1000 * number, 10 * number, 0.25 * number, 0.5 * number, 20.0,
                            {name: CORNER for name in shuttle.CORNERS}) for number, chip in enumerate(CHIPS, 1)}

    def test_rows_have_the_results(self) -> None:
        text = shuttle.report(self.RESULTS, {chip: "`DepthsAreTheModels`" for chip in CHIPS})
        for row in ("| cells | 1,000 | 2,000 |", "| area of cells, mm2 | 0.25 | 0.50 |", "| highest clock in the slow corner, MHz | 125 | 125 |",
                    "| hold slack, fast, ns | 0.25 | 0.25 |", "| removal slack, slow, ns | 1.19 | 1.19 |", "| columns x pixels of a column | 16 x 16 | 4 x 16 |",
                    "* poolPointer lean: passed `DepthsAreTheModels`"):
            self.assertIn(row, text)

    def test_results_are_kept_until_the_next_run(self) -> None:
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(shuttle, "BUILD", Path(folder)):
            chip = CHIPS[0]
            with self.assertRaisesRegex(FlowError, "`make shuttle` makes it first"):
                shuttle.kept(chip)
            chip.folder.mkdir()
            (chip.folder / "result.json").write_text(json.dumps(shuttle.asdict(self.RESULTS[chip])), encoding="utf-8")
            self.assertEqual(shuttle.kept(chip), self.RESULTS[chip])

    def test_a_netlist_without_a_passed_test_has_no_report(self) -> None:
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(shuttle, "BUILD", Path(folder)):
            chip = CHIPS[0]
            chip.folder.mkdir()
            program = Path(folder) / "test.sh"
            for text, status, passes in (("[       OK ] D.Depths (1 ms)\n[  PASSED  ] 1 tests.", 0, True), ("[  PASSED  ] 0 tests.", 0, False),
                                         ("[       OK ] D.Depths (1 ms)\n[  FAILED  ] 1 test.", 1, False)):
                program.write_text(f"#!/bin/sh\necho '{text}'\nexit {status}\n", encoding="utf-8")
                program.chmod(0o755)
                if passes:
                    self.assertEqual(shuttle.passed(chip, program), "`Depths`")
                else:
                    with self.assertRaises(FlowError):
                        shuttle.passed(chip, program)


if __name__ == "__main__":
    unittest.main()
