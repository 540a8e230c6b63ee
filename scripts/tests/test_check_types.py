# SPDX-License-Identifier: Apache-2.0
"""mypy sees every Python file of the project."""

import re
import shutil
import tempfile
import unittest
from pathlib import Path

import check_types
from figures.source_tree import SourceTree

ROOT = check_types.ROOT
WRONG = "#!/usr/bin/python3\nnumber: int = 'text'\n"
# What would take a file, or a line with no reason, out of the check.
OPT_OUT = re.compile(r"^# mypy: *ignore-errors|^# type: *ignore|# type: *ignore(?!\[)|^ignore_errors|^exclude|^follow_imports = \"s(?!kip)", re.MULTILINE)


class EveryFile(unittest.TestCase):
    def setUp(self) -> None:
        self.root = Path(self.enterContext(tempfile.TemporaryDirectory()))
        shutil.copy(ROOT / "pyproject.toml", self.root)

    def plant(self, name: str, text: str) -> None:
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def test_each_is_in_one_group(self) -> None:
        tree = SourceTree(ROOT)
        grouped = [name for group in check_types.groups(check_types.python_files(tree)) for name in group]
        self.assertEqual(len(grouped), len(set(grouped)))
        wanted = {name for name in tree.files if name.endswith((".py", ".pyi")) or re.match(rb"#!.*python", tree.read(name))}
        self.assertEqual(set(grouped), wanted)
        self.assertLessEqual({".ci/long", "setup.py", "scripts/mutation/cpp.py", "synth/synth.py", "tb_cpp/sources/embed.py"}, wanted)

    def test_no_file_leaves_the_check(self) -> None:
        tree = SourceTree(ROOT)
        out = [name for name in [*check_types.python_files(tree), "pyproject.toml"]
               if name != "scripts/tests/test_check_types.py" and OPT_OUT.search(tree.text(name))]
        self.assertEqual(out, [])
        self.assertTrue(OPT_OUT.search("a = b  # type: ignore\n"))

    def test_names_that_stand_twice_are_in_different_groups(self) -> None:
        files = ["a/tests/__init__.py", "a/tests/test_x.py", "b/tests/__init__.py", "b/tests/test_y.py", "c/test_x.py", "d/test_x.py"]
        self.assertEqual(check_types.groups(files), [["a/tests/__init__.py", "a/tests/test_x.py", "c/test_x.py"],
                                                     ["b/tests/__init__.py", "b/tests/test_y.py", "d/test_x.py"]])

    @unittest.skipUnless(Path(check_types.MYPY).is_file(), "mypy is not installed")
    def test_a_planted_error_is_found(self) -> None:
        names = [".ci/planted", "synth/planted.py", "new_folder/tests/planted.py", "scripts/mutation/planted_too.py"]
        for name in names:
            self.plant(name, WRONG)
        found = "".join(check_types.failures(self.root, check_types.python_files(SourceTree(self.root))))
        self.assertEqual(sorted(set(re.findall(r"^(\S+):2: error: ", found, re.MULTILINE))), sorted(names))


if __name__ == "__main__":
    unittest.main()
