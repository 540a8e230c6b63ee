# SPDX-License-Identifier: Apache-2.0
"""The netlists that dtof-fault-metrics damages: their arrays, and what Yosys says in one line."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import fault_netlists
from dtof_synth.configuration import load
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]

PROGRAM = ROOT / "scripts" / "fault_netlists.py"


class FaultNetlists(unittest.TestCase):
    def setUp(self) -> None:
        self.configurations = load(ROOT / "configurations.toml")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_the_array_is_small_and_has_one_engine(self) -> None:
        array = fault_netlists.small_array(self.configurations["poolpointer"], 1)
        self.assertEqual(array.name, "poolpointer_parity")
        self.assertEqual((array["SRAM_NUM"], array["PIXELS_PER_SRAM"], array["PARITY"]), (4, 16, 1))
        self.assertEqual(array.engines, 1)
        self.assertEqual(fault_netlists.small_array(self.configurations["ezpointer"], 0)["PARITY"], 0)

    def test_refusals_are_one_line(self) -> None:
        for arguments, path, says in ((["nothing"], os.environ["PATH"], "no configuration 'nothing'"),
                                      (["ezpointer"], "/nowhere", "yosys is not installed")):
            with self.subTest(says=says):
                ran = subprocess.run(["/usr/bin/python3", PROGRAM, self.folder, *arguments], env={**os.environ, "PATH": path},
                                     stderr=subprocess.PIPE, text=True)
                self.assertEqual(ran.returncode, 1)
                self.assertIn(says, ran.stderr)
                self.assertEqual(ran.stderr.count("\n"), 1)

    @unittest.skipUnless(shutil.which("yosys"), "yosys is not installed")
    def test_the_netlist_names_its_array_and_its_memories(self) -> None:
        array = fault_netlists.small_array(self.configurations["ezpointer"], 1)
        netlist = json.loads(fault_netlists.write(array, self.folder).read_text(encoding="utf-8"))
        top = netlist["modules"]["dtof_array"]
        self.assertEqual(top["attributes"]["dtof_readout"], "ezpointer")
        self.assertEqual(int(top["attributes"]["dtof_columns"], 2), 4)
        memories = [cell["type"] for cell in top["cells"].values() if "dtof_sram" in cell["type"]]
        self.assertEqual(len(memories), 4)
        sizes = netlist["modules"][memories[0]]["parameter_default_values"]
        self.assertEqual((int(sizes["DEPTH"], 2), int(sizes["WIDTH"], 2)), (16, 15))

    @unittest.skipUnless(shutil.which("yosys"), "yosys is not installed")
    def test_what_yosys_refuses_is_said(self) -> None:
        array = fault_netlists.small_array(self.configurations["ezpointer"], 1).with_parameters("wrong", PARITY=2)
        with self.assertRaisesRegex(FlowError, "wrong: Yosys: .*ERROR"):
            fault_netlists.write(array, self.folder)


if __name__ == "__main__":
    unittest.main()
