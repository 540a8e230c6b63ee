# SPDX-License-Identifier: Apache-2.0
"""The notebooks of the Python examples: their cells are the scripts', and what is no cell is refused."""

import json
import tempfile
import unittest
from pathlib import Path

import notebooks
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ('# SPDX-License-Identifier: Apache-2.0\n# %% [markdown]\n# # Title\n#\n# A text with `code` and 5 °.\n\n'
          '# %%\nimport sys  # %% stays\n\n\ndef one():\n    return 1\n\n\n# %% [markdown]\n# More\n\n# %%\none()\n')


class Cells(unittest.TestCase):
    def test_cells_of_a_script(self) -> None:
        self.assertEqual(notebooks.cells(SCRIPT, "a.py"), [
            ("markdown", "# Title\n\nA text with `code` and 5 °."), ("code", "import sys  # %% stays\n\n\ndef one():\n    return 1"),
            ("markdown", "More"), ("code", "one()")])

    def test_what_is_in_no_cell_is_refused(self) -> None:
        for script, says in {"import sys\n# %%\n": r"a\.py:1: 'import sys' is in no cell",
                             "# %%\n# %% [md]\n": r"a\.py:2: a cell begins with .*, not with '# %% \[md\]'",
                             "# %%\n# %% Title\n": "a cell begins with",
                             "# %% [markdown]\n# text\nimport sys\n": r"a\.py:3: 'import sys' is in a cell of text, and no comment",
                             "# %% [markdown]\n#text\n": "is in a cell of text"}.items():
            with self.subTest(script), self.assertRaisesRegex(FlowError, says):
                notebooks.cells(script, "a.py")

    def test_the_notebook_has_the_cells_and_no_outputs(self) -> None:
        made = json.loads(notebooks.notebook(SCRIPT, "a.py"))
        self.assertEqual((made["nbformat"], made["nbformat_minor"], made["metadata"]["kernelspec"]["name"]), (4, 5, "python3"))
        self.assertEqual([(cell["cell_type"], "".join(cell["source"])) for cell in made["cells"]], notebooks.cells(SCRIPT, "a.py"))
        self.assertEqual([cell["id"] for cell in made["cells"]], ["cell-1", "cell-2", "cell-3", "cell-4"])
        for cell in made["cells"]:
            self.assertEqual("outputs" in cell, cell["cell_type"] == "code")
            self.assertEqual((cell.get("outputs", []), cell.get("execution_count")), ([], None))

    def test_a_notebook_for_each_script(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / notebooks.FOLDER).mkdir(parents=True)
            for name in ("two.py", "one.py"):
                (root / notebooks.FOLDER / name).write_text(SCRIPT, encoding="utf-8")
            self.assertEqual(list(notebooks.files(root)), ["examples/python/one.ipynb", "examples/python/two.ipynb"])

    def test_no_notebook_without_a_script(self) -> None:
        folder = ROOT / notebooks.FOLDER
        self.assertEqual({path.stem for path in folder.glob("*.ipynb")}, {path.stem for path in folder.glob("*.py")})


if __name__ == "__main__":
    unittest.main()
