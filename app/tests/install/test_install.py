#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The installed programs: they start from their new place, and man pages and completions lie where man and bash look for them.
CTest gives the build folder (DTOF_BUILD)."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BUILD = Path(os.environ.get("DTOF_BUILD", ROOT / "build" / "cpp"))
PROGRAMS = ("dtof", "dtof-study")


def output(*command: str | Path) -> str:
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=True).stdout


class Install(unittest.TestCase):
    prefix: Path

    @classmethod
    def setUpClass(cls) -> None:
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.prefix = Path(scratch.name) / "a prefix"
        output("cmake", "--install", BUILD, "--component", "programs", "--prefix", cls.prefix)

    def test_nothing_else_is_installed(self) -> None:
        files = {str(file.relative_to(self.prefix)) for file in self.prefix.rglob("*") if file.is_file()}
        self.assertEqual(files, {place.format(program) for program in PROGRAMS
                                 for place in ("bin/{}", "share/man/man1/{}.1", "share/bash-completion/completions/{}")})

    def test_programs_start_from_their_new_place(self) -> None:
        for program in PROGRAMS:
            self.assertEqual(output(self.prefix / "bin" / program, "--version"), output(BUILD / "bin" / program, "--version"))

    def test_the_man_page_is_the_programs_own(self) -> None:
        for program in PROGRAMS:
            page = (self.prefix / "share/man/man1" / f"{program}.1").read_text(encoding="utf-8")
            self.assertEqual(page, output(BUILD / "bin" / program, "--man"))

    def test_bash_completes_a_command(self) -> None:
        for program, word, completed in (("dtof", "repl", "replay"), ("dtof-study", "wal", "walk")):
            script = self.prefix / "share/bash-completion/completions" / program
            function = program.replace("-", "_")
            said = output("bash", "-c", f"source '{script}'; COMP_WORDS=({program} {word}); COMP_CWORD=1; _{function}; echo \"${{COMPREPLY[@]}}\"")
            self.assertIn(completed, said.split())


if __name__ == "__main__":
    unittest.main()
