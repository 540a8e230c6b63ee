# SPDX-License-Identifier: Apache-2.0
"""scripts/install_packages.sh: each purpose has a target that asks for it, and its packages are not in the common list."""

import re
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "install_packages.sh"
RARE = {"clang", "clang-tidy", "chromium", "emscripten", "gcovr", "gtkwave", "libdlib-dev", "nextpnr-ice40", "npm", "qflow", "qflow-tech-osu018", "snakemake"}


class Packages(unittest.TestCase):
    def setUp(self) -> None:
        text = re.sub(r" +#.*", "", SCRIPT.read_text(encoding="utf-8"))
        (common,) = re.findall(r"^packages=\((.*?)^\)", text, re.MULTILINE | re.DOTALL)
        self.common = set(common.split())
        self.purposes = {name: set(packages.split())
                         for name, packages in re.findall(r"^ +(\w+)\)\s+(?:packages|optional)\+=\(([^)]*)\)", text, re.MULTILINE)}

    def test_what_only_rare_targets_need_is_not_common(self) -> None:
        self.assertIn("verilator", self.common)
        self.assertFalse(self.common & RARE)
        self.assertLessEqual(RARE, set().union(*self.purposes.values()))
        for purpose, packages in self.purposes.items():
            self.assertFalse(self.common & packages, purpose)

    def test_each_purpose_is_asked_for(self) -> None:
        files = [ROOT / "Makefile", *ROOT.glob("scripts/*.mk"), *ROOT.glob("synth/*.mk"), *ROOT.glob(".ci/*")]
        asked = {word for file in files for words in re.findall(r"install_packages\.sh ([\w ]+)", file.read_text(encoding="utf-8")) for word in words.split()}
        self.assertEqual(asked, set(self.purposes))

    def test_an_unknown_purpose_names_the_known_ones(self) -> None:
        done = subprocess.run([SCRIPT, "unheard"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        for purpose in self.purposes:
            self.assertRegex(done.stderr, rf"\b{purpose}\b")


if __name__ == "__main__":
    unittest.main()
