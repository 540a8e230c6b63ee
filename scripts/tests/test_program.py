# SPDX-License-Identifier: Apache-2.0
"""A closed pipe ends the project's programs quietly."""

import re
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
ENDS = re.compile(r"^ *program\.run\(", re.MULTILINE)


class ClosedPipe(unittest.TestCase):
    def assert_ends_quietly(self, command: list[str]) -> None:
        """Reads the command's first line alone."""
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None and process.stderr is not None
            process.stdout.readline()
            process.stdout.close()
            said = process.stderr.read()
        self.assertEqual((said, process.returncode), ("", -signal.SIGPIPE))

    def run_body(self, body: str) -> "subprocess.CompletedProcess[str]":
        return subprocess.run([sys.executable, "-c", self.text(body)], capture_output=True, text=True)

    @staticmethod
    def text(body: str) -> str:
        return (f"import subprocess, sys, time\nsys.path.insert(0, {str(ROOT / 'synth')!r})\nfrom dtof_synth import program\n"
                f"def main():\n    {body}\nprogram.run(main)\n")

    def test_a_reader_that_has_gone_ends_the_program(self) -> None:
        for body in ("print('line\\n' * 100000)",  # the pipe breaks at once
                     "print('line', flush=True); time.sleep(0.5); print('more')",  # when the program ends
                     "print('line', flush=True); time.sleep(0.5); print('more'); sys.exit(0)"):
            with self.subTest(body=body):
                self.assert_ends_quietly([sys.executable, "-c", self.text(body)])

    def test_a_program_of_the_project(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            script = Path(folder) / "head.sh"
            script.write_text(f"set -o pipefail\n{ROOT}/scripts/list_files.py .cpp | (exec < /dev/null; sleep 1)\n", encoding="utf-8")
            done = subprocess.run(["bash", str(script)], capture_output=True, text=True)
        self.assertEqual((done.stderr, done.returncode), ("", 128 + signal.SIGPIPE))

    def test_exit_status(self) -> None:
        for body, status in (("return 3", 3), ("pass", 0), ("sys.exit(4)", 4), ("return 'no'", 1)):
            with self.subTest(body=body):
                self.assertEqual(self.run_body(body).returncode, status)

    def test_the_broken_pipe_of_a_child_is_an_error(self) -> None:
        done = self.run_body("child = subprocess.Popen(['true'], stdin=subprocess.PIPE, bufsize=0); child.wait(); child.stdin.write(b'text')")
        self.assertEqual(done.returncode, 1)
        self.assertIn("BrokenPipeError", done.stderr)

    def test_every_program_ends_so(self) -> None:
        programs = [path for folder in ("scripts", "synth") for path in sorted((ROOT / folder).glob("*.py"))
                    if path.read_text(encoding="utf-8").startswith("#!")]
        self.assertGreater(len(programs), 30)
        self.assertEqual([path.name for path in programs if not ENDS.search(path.read_text(encoding="utf-8"))], ["playground_test.py"])


if __name__ == "__main__":
    unittest.main()
