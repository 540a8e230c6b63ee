#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What every program of the project says of itself: version, help, completion, man page. A program that a CMake file names and no list here
fails. CTest gives the build folder (DTOF_BUILD)."""

import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BUILD = Path(os.environ.get("DTOF_BUILD", ROOT / "build" / "cpp"))
PROGRAMS = ("dtof", "dtof-study", "dtof-faults", "dtof-fault-metrics", "dtof-random", "dtof-vectors")
SAME_TEXTS = {"dtof-full", "dtof-wave", "dtof-wave-pool"}  # the program `dtof` with other arrays: its main.cpp, its texts
FOR_THE_PROJECT = {"train-enlarger"}  # `make train-enlarger` alone builds and runs it, and it is not installed
INSTALLED = re.compile(r"foreach\(program ([^)]*)\)")


def said(program: str, *arguments: str) -> str:
    done = subprocess.run([BUILD / "bin" / program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{program} {' '.join(arguments)}: exit code {done.returncode}: {done.stdout}")
    return done.stdout


def named_by_the_build() -> set[str]:
    """The programs that the CMake files make, without tests and examples."""
    files = [ROOT / "CMakeLists.txt", *(file for room in ("app", "driver", "models", "python", "studies", "tb_cpp")
                                        for file in (ROOT / room).rglob("CMakeLists.txt"))]
    found = {name for file in files for name in re.findall(r"add_executable\(([^ )]+)", file.read_text(encoding="utf-8"))}
    return {name for name in found if not name.endswith("_test")} - {"playground_module"}  # a page's module


class Texts(unittest.TestCase):
    def test_every_program_is_in_the_list(self) -> None:
        self.assertEqual(named_by_the_build(), {*PROGRAMS, *SAME_TEXTS, *FOR_THE_PROJECT})
        installed = INSTALLED.findall((ROOT / "cmake" / "install_programs.cmake").read_text(encoding="utf-8"))
        self.assertEqual(len(installed), 1)
        self.assertLessEqual(set(installed[0].split()), set(PROGRAMS))

    def test_version(self) -> None:
        versions = set()
        for program in PROGRAMS:
            with self.subTest(program=program):
                line = said(program, "--version")
                self.assertRegex(line, rf"\A{program} \d+\.\d+\.\d+\n\Z")
                for order in (("--version", "--json"), ("--json", "--version")):
                    found = json.loads(said(program, *order))
                    self.assertEqual(f"{found['program']} {found['version']}\n", line)
                    self.assertLessEqual({"compiler", "build_type", "system", "machine"}, set(found))
                versions.add(line.split()[1])
        self.assertEqual(len(versions), 1)

    def test_help(self) -> None:
        for program in PROGRAMS:
            with self.subTest(program=program):
                text = said(program, "--help")
                self.assertIn(f"\nUsage: {program} ", text)
                for word in ("--version", "--json", "--completion", "--man", "Exit codes:"):
                    self.assertIn(word, text)

    def test_completion_has_every_option(self) -> None:
        for program in PROGRAMS:
            with self.subTest(program=program):
                function = "_" + program.replace("-", "_")
                offered = subprocess.run(["bash", "-c", f"set -eu; source <('{BUILD / 'bin' / program}' --completion bash); complete -p {program}; "
                                          f"COMP_WORDS=({program} -); COMP_CWORD=1; {function}; printf '%s\\n' \"${{COMPREPLY[@]}}\""],
                                         capture_output=True, text=True, check=True).stdout.splitlines()
                self.assertIn(f"-F {function} {program}", offered[0])
                self.assertLessEqual(set(re.findall(r"(?m)^ {2}(?:-\w,)?(--[a-z][a-z-]+)", said(program, "--help"))), set(offered[1:]))

    def test_man_page_has_every_option(self) -> None:
        for program in PROGRAMS:
            with self.subTest(program=program):
                page = said(program, "--man")
                self.assertTrue(page.startswith(f".TH {program.upper()} 1 "), page[:80])
                options = set(re.findall(r"--[a-z][a-z0-9-]+", said(program, "--help")))
                self.assertEqual({option for option in options if option.replace("-", r"\-") not in page}, set())
                if shutil.which("groff") is not None:
                    done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-Wbreak"], input=page, capture_output=True, text=True, check=True)
                    self.assertEqual(done.stderr, "")

    def test_a_result_of_vectors(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            found = json.loads(said("dtof-vectors", "--readout", "sifh", "--acquisitions", "5", "6", "--parameters", "PIXELS_PER_SRAM=4", "SRAM_NUM=2",
                                    "--out", folder, "--json"))
            frames = (Path(folder) / "frames.txt").read_text(encoding="ascii").splitlines()
        self.assertEqual((found["command"], found["out"], found["files"]), ("dtof-vectors", folder, ["frames.txt", "results.hex", "timestamps.hex"]))
        self.assertEqual([line.split()[0] for line in frames], ["5", "6"])


if __name__ == "__main__":
    unittest.main()
