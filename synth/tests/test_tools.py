# SPDX-License-Identifier: Apache-2.0
"""OpenSTA's crashes, with a program in its place."""

import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import tools
from dtof_synth.errors import FlowError

CRASHES = "kill -SEGV $$"
CRASHES_ONCE = f'[ -n "$DTOF_SLACK_OF_PATHS" ] || {CRASHES}\necho begin\necho DTOF_STA_OK'
FAILS = 'echo "$DTOF_SLACK_OF_PATHS" >> "$DTOF_SETTINGS"\necho "DTOF_STA_FAILED no such pin"'


class Crash(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.settings = self.folder / "settings.tcl"
        self.settings.touch()

    def run_sta(self, program: str) -> str:
        sta = self.folder / "sta"
        sta.write_text(f"#!/bin/bash\n{program}\n", encoding="utf-8")
        sta.chmod(0o755)
        with mock.patch.dict(os.environ, PATH=f"{self.folder}:{os.environ['PATH']}"):
            return tools.run_sta(self.folder / "timing.tcl", self.settings, self.folder / "sta.log", "array")

    def test_after_a_crash_the_slack_is_that_of_the_paths(self) -> None:
        self.assertEqual(self.run_sta(CRASHES_ONCE), "begin\nDTOF_STA_OK\n")

    def test_a_second_crash_is_an_error(self) -> None:
        with self.assertRaisesRegex(FlowError, "array: OpenSTA: stopped"):
            self.run_sta(CRASHES)

    def test_an_error_is_no_crash(self) -> None:
        with self.assertRaisesRegex(FlowError, "array: OpenSTA: no such pin"):
            self.run_sta(FAILS)
        self.assertEqual(self.settings.read_text(encoding="utf-8"), "\n")


if __name__ == "__main__":
    unittest.main()
