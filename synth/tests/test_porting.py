# SPDX-License-Identifier: Apache-2.0
"""The example of docs/user/porting.md: an array on a compiled single-port SRAM gives the behavioural one's results."""

import subprocess
import tempfile
import unittest
from pathlib import Path

from dtof_synth.mapping import rtl_files

ROOT = Path(__file__).resolve().parents[2]
PORTING = ROOT / "synth" / "porting"
BEHAVIOURAL = ROOT / "hdl" / "technology" / "behavioural"


def simulate(memory: list[Path], folder: Path) -> list[str]:
    program = folder / "array.vvp"
    command = ["iverilog", "-g2012", f"-I{ROOT / 'hdl' / 'common'}", "-s", "porting_tb", "-o", str(program),
               *map(str, memory), *map(str, rtl_files(ROOT)), str(PORTING / "porting_tb.sv")]
    built = subprocess.run(command, check=False, capture_output=True, text=True)
    if built.returncode != 0:
        raise AssertionError(built.stderr)
    run = subprocess.run(["vvp", "-n", str(program)], check=True, capture_output=True, text=True)
    return [line for line in run.stdout.splitlines() if line.startswith(("result", "timeout"))]


class Porting(unittest.TestCase):
    def test_results_do_not_depend_on_the_technology_folder(self):
        two_ports = BEHAVIOURAL / "dtof_sram_1r1w.sv"
        with tempfile.TemporaryDirectory() as folder:
            behavioural = simulate([two_ports, BEHAVIOURAL / "dtof_sram_1rw.sv"], Path(folder))
            compiled = simulate([two_ports, PORTING / "dtof_sram_1rw.sv", PORTING / "sp_ram_160x14.v"], Path(folder))
        self.assertEqual(behavioural[-1], "results 320")
        self.assertGreater(len(set(behavioural)), 100)
        self.assertNotIn("x", "".join(line.split()[1] for line in behavioural))
        self.assertEqual(compiled, behavioural)


if __name__ == "__main__":
    unittest.main()
