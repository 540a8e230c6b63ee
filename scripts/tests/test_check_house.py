# SPDX-License-Identifier: Apache-2.0
"""The house's rules on small trees, with faults planted."""

import subprocess
import tempfile
import unittest
from pathlib import Path

import check_house

FILES = {
    "models/dtof/core/CMakeLists.txt": "dtof_library(core\n  SOURCES a.cpp\n  DEPENDS fmt::fmt)\n",
    "models/dtof/core/a.hpp": "int a();\n",
    "models/dtof/core/a.cpp": '#include "dtof/core/a.hpp"\n',
    "models/dtof/photon/CMakeLists.txt": "dtof_library(photon SOURCES p.cpp\n  DEPENDS dtof_core)\n",
    "models/dtof/photon/p.hpp": '#include "dtof/core/a.hpp"\n',
    "app/run/CMakeLists.txt": "dtof_library(run SOURCES r.cpp PRIVATE_DEPENDS dtof_photon)\n",
    "app/run/r.cpp": '#include "dtof/photon/p.hpp"\n#include "dtof/core/a.hpp"\n',
    "app/run/r.hpp": "int r();\n",
}

NAME = check_house.PARAMETER.pattern.replace(r"\b", "")  # of the parameter whose files are counted


class House(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = Path(scratch.name)
        subprocess.run(["git", "init", "-q", self.root], check=True)
        for name, text in FILES.items():
            self.write(name, text)

    def write(self, name: str, text: str) -> None:
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def arrows(self) -> list[str]:
        return check_house.arrows(self.root, check_house.listed(self.root))

    def test_arrows_that_are_declared_are_right(self) -> None:
        self.assertEqual(self.arrows(), [])

    def test_an_include_that_no_arrow_allows(self) -> None:
        self.write("models/dtof/core/a.cpp", '#include "dtof/photon/p.hpp"\n')
        self.assertEqual(self.arrows(), ["models/dtof/core/a.cpp: includes dtof/photon/p.hpp of photon, which core does not depend on"])

    def test_a_circle(self) -> None:
        self.write("models/dtof/core/CMakeLists.txt", "dtof_library(core SOURCES a.cpp PRIVATE_DEPENDS dtof_photon)\n")
        self.assertEqual(len([line for line in self.arrows() if "depends on itself" in line]), 2)

    def test_models_depend_on_no_other_room(self) -> None:
        self.write("models/dtof/photon/CMakeLists.txt", "dtof_library(photon SOURCES p.cpp DEPENDS dtof_core dtof_run)\n")
        self.assertIn("models/dtof/photon: a library of models/ depends on run in app/run", self.arrows())

    def test_what_is_counted(self) -> None:
        self.write("app/long.cpp", "int f(int a) {\n" + "  ++a;\n" * 90 + "}\n" + f"// {NAME}\n" * 500)
        self.write("scripts/long.py", "def f():\n" + "    pass\n" * 90)
        self.write("scripts/short.py", "def f():\n" + "    pass\n" * 70)
        self.write("scripts/written.py", "# Written by scripts/generate.py\n" + f"{NAME} = 1\n" * 600)
        self.write("hdl/a.sv", f"parameter int {NAME} = 1;\n")
        self.assertEqual(check_house.counts(self.root, check_house.listed(self.root)),
                         {"files_above_500_lines": 1, "functions_above_80_lines": 2, f"files_that_name_{NAME}": 1, "edits_of_sys_path": 0})

    def test_edits_of_sys_path(self) -> None:
        for line, edits in (("sys.path.insert(0, 'a')", 1), ("sys.path[:0] = ['a']", 1), ("sys.path += ['a']", 1), ("sys.path = []", 1),
                            ("import sys; " + "sys.path.append('a')", 1), ("if a:\n    sys.path.append('a')", 1),
                            ("print(sys.path)", 0), ("names = sys.path[1:]", 0), ("# sys.path.append('a')", 0), ("sys.path == []", 0)):
            for name in ("scripts/a.py", "scripts/sweep/Snakefile"):
                with self.subTest(line=line, name=name):
                    self.write(name, line + "\n")
                    self.assertEqual(check_house.counts(self.root, check_house.listed(self.root))["edits_of_sys_path"], edits)
                    (self.root / name).unlink()

    def test_a_ratchet_holds_both_ways(self) -> None:
        self.assertEqual(check_house.ratchets({"x": 3}, {"x": 3}), [])
        self.assertIn("4 instead of at most 3", check_house.ratchets({"x": 4}, {"x": 3})[0])
        self.assertIn("lower the number", check_house.ratchets({"x": 2}, {"x": 3})[0])
        self.assertIn("no limit for x", check_house.ratchets({"x": 2}, {})[0])
        self.assertIn("nobody counts y", check_house.ratchets({}, {"y": 1})[0])


if __name__ == "__main__":
    unittest.main()
