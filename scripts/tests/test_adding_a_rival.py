# SPDX-License-Identifier: Apache-2.0
"""The rival of docs/user/adding_a_rival.md compiles as the page says, without a warning, and so does the list with it."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs" / "user" / "adding_a_rival.md"
LIST = ROOT / "models" / "dtof" / "rival" / "rival_list.cpp"
DECLARED_HERE = "// A rival whose file has no header is declared here.\n"
LIST_BEGINS = "std::to_array<RivalEntry>({\n"
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror")


class Page(unittest.TestCase):
    def test_the_example_compiles(self) -> None:
        rival, declaration, entry = re.findall(r"```cpp\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
        text = LIST.read_text(encoding="utf-8")
        for place in (DECLARED_HERE, LIST_BEGINS):
            self.assertEqual(text.count(place), 1, place)
        text = text.replace(DECLARED_HERE, DECLARED_HERE + declaration).replace(LIST_BEGINS, LIST_BEGINS + entry)
        with tempfile.TemporaryDirectory() as folder:
            for name, content in (("first_photon.cpp", rival), ("rival_list.cpp", text)):
                file = Path(folder) / name
                file.write_text(content, encoding="utf-8")
                compiler = [os.environ.get("CXX", "c++"), "-std=c++20", "-fsyntax-only", *WARNINGS, f"-I{ROOT / 'models'}"]
                result = subprocess.run([*compiler, str(file)], capture_output=True, text=True, check=False)
                self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    unittest.main()
