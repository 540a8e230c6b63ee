#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The installed programs: they start from their new place, and man and bash read the pages and completions that lie beside them.
CTest gives the build folder (DTOF_BUILD)."""

import os
import re
import shutil
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

    def test_the_man_page_is_rendered_with_every_option(self) -> None:
        if shutil.which("groff") is None:
            self.skipTest("groff is absent")
        for program in PROGRAMS:
            page = self.prefix / "share/man/man1" / f"{program}.1"
            # A long option cannot be broken over two lines; every other warning is a fault of the page.
            done = subprocess.run(["groff", "-man", "-Tutf8", "-P-c", "-ww", "-Wbreak", page], capture_output=True, text=True, check=True)
            self.assertEqual(done.stderr, "")
            shown = re.sub(".\b", "", done.stdout)  # bold letters are struck twice
            self.assertRegex(shown, rf"(?m)^ +{program} . (?!{program}:)[A-Za-z]")
            options = set(re.findall(r"--[a-z][a-z0-9-]+", output(BUILD / "bin" / program, "--help")))
            self.assertGreater(len(options), 3)
            self.assertEqual({option for option in options if option not in shown}, set())

    def completed(self, program: str, *words: str) -> list[str]:
        script = self.prefix / "share/bash-completion/completions" / program
        function = program.replace("-", "_")
        return output("bash", "-c", f"source '{script}'; COMP_WORDS=({program} {' '.join(words)}); COMP_CWORD={len(words)}; _{function}; "
                      "echo \"${COMPREPLY[@]}\"").split()

    def test_bash_completes_a_command_an_option_and_a_value(self) -> None:
        for program, words, whole in (("dtof", ["repl"], "replay"), ("dtof", ["frame", "--verif"], "--verify"),
                                      ("dtof", ["frame", "--engine", "mo"], "model"), ("dtof-study", ["wal"], "walk"),
                                      ("dtof-study", ["accuracy", "--sen"], "--sensor"),
                                      ("dtof-study", ["accuracy", "--sensor", "phon"], "phone")):
            self.assertEqual(self.completed(program, *words), [whole], (program, words))

    def test_bash_takes_the_completion_for_the_program(self) -> None:
        for program in PROGRAMS:
            script = self.prefix / "share/bash-completion/completions" / program
            self.assertIn(f"-F _{program.replace('-', '_')} {program}", output("bash", "-c", f"source '{script}'; complete -p {program}"))


if __name__ == "__main__":
    unittest.main()
