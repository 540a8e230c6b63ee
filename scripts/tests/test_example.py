# SPDX-License-Identifier: Apache-2.0
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BENCH = (ROOT / "examples/example_bench.sv").read_text(encoding="utf-8")


def run(*arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([str(ROOT / "scripts/example.sh"), *arguments], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)  # fmt: skip


class Example(unittest.TestCase):
    def test_the_frame_is_right(self):
        result = run("hispointer")
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertEqual(result.stdout.count("wall at"), 24)

    def test_it_notices_what_is_wrong(self):
        for old, new, message in (
            ("wall(row, column) + $dist", "wall(row, column) + 20 + $dist", "this code is not the wall's"),
            ("row == ROWS - 1 && slot", "row == ROWS - 2 && slot", "ERROR is not 0"),
            ("if (result_valid && result_ready) take", "if (result_valid) take", "the frame is not whole"),
            ("dtof_registers_pkg::IRQ_ENABLE_FRAME_LSB", "dtof_registers_pkg::IRQ_ENABLE_ERROR_LSB", "does not end"),
        ):  # fmt: skip
            with self.subTest(new=new), tempfile.TemporaryDirectory() as folder:
                self.assertEqual(BENCH.count(old), 1)
                bench = Path(folder) / "bench.sv"
                bench.write_text(BENCH.replace(old, new), encoding="utf-8")
                result = run("hispointer", str(bench))
                self.assertEqual(result.returncode, 1)
                self.assertIn(message, result.stdout)

    def test_an_unknown_read_out_is_refused(self):
        result = run("hipointer")
        self.assertEqual(result.returncode, 1)
        self.assertIn("error: no read-out with RTL is called 'hipointer'", result.stdout)


if __name__ == "__main__":
    unittest.main()
