# SPDX-License-Identifier: Apache-2.0
"""The notebooks of the examples are valid and as Jupyter writes them, and a kernel of Jupyter runs every cell within a minute of processor time.

scripts/generate.py --check compares their cells with the scripts'. Skipped where nbformat, nbclient or ipykernel is not installed."""

import importlib.util
import json
import os
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from programs import BIN
from test_examples import EXAMPLES, PICTURES, SECONDS, processor_seconds

NEEDED = ("nbformat", "nbclient", "ipykernel")
KERNEL = "here"  # this Python; VS Code, too, gives the connection as one argument
ARGUMENTS = [sys.executable, "-Xfrozen_modules=off", "-m", "ipykernel_launcher", "--f={connection_file}"]


@unittest.skipUnless(all(importlib.util.find_spec(name) for name in NEEDED), "nbformat, nbclient or ipykernel is not installed")
class NotebooksTest(unittest.TestCase):
    def test_notebooks_are_valid_and_as_jupyter_writes_them(self) -> None:
        import nbformat
        for file in EXAMPLES.glob("*.ipynb"):
            text = file.read_text(encoding="utf-8")
            book = nbformat.reads(text, as_version=nbformat.NO_CONVERT)
            nbformat.validate(book)
            self.assertEqual(nbformat.writes(book) + "\n", text, file.name)

    def run_notebook(self, name: str) -> str:
        """What the cells print, by a kernel that starts in a folder of its own."""
        import nbclient
        import nbformat
        book = nbformat.read(EXAMPLES / f"{name}.ipynb", as_version=nbformat.NO_CONVERT)
        with tempfile.TemporaryDirectory() as folder:
            described = Path(folder) / "jupyter" / "kernels" / KERNEL / "kernel.json"
            described.parent.mkdir(parents=True)
            described.write_text(json.dumps({"argv": ARGUMENTS, "display_name": KERNEL, "language": "python"}), encoding="utf-8")
            work = Path(folder) / "work"
            work.mkdir()
            set_here = {"JUPYTER_PATH": str(described.parents[2]), "JUPYTER_RUNTIME_DIR": folder, "IPYTHONDIR": folder, "DTOF_BIN": str(BIN),
                        "PYTHONPATH": os.pathsep.join(sys.path)}
            begin = processor_seconds()
            with mock.patch.dict(os.environ, set_here):
                nbclient.NotebookClient(book, timeout=600, kernel_name=KERNEL, resources={"metadata": {"path": str(work)}}).execute()
            self.assertLess(processor_seconds() - begin, SECONDS)
            written = [path.relative_to(work).as_posix() for path in work.rglob("*") if path.is_file()]
        self.assertTrue(all(path.startswith("build/python_examples/") for path in written), written)
        outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
        self.assertEqual([output.text for output in outputs if output.output_type == "stream" and output.name == "stderr"], [])
        if importlib.util.find_spec("matplotlib") is not None:
            shown = [output for output in outputs if "image/png" in output.get("data", {})]
            self.assertEqual(len(shown), len(PICTURES[name]))
            self.assertLessEqual({f"build/python_examples/{picture}" for picture in PICTURES[name]}, set(written))
        return "".join(output.text for output in outputs if output.output_type == "stream")

    def test_first_picture(self) -> None:
        self.assertRegex(self.run_notebook("first_picture"), r"poolPointer +rmse +\d+ mm, +[\d.]+% of the pixels off by more than 3 %")

    def test_own_sensor(self) -> None:
        self.assertIn("its product: dtof product --sensor mine.toml --readout ", self.run_notebook("own_sensor"))

    def test_own_data(self) -> None:
        self.assertIn("the same codes: True", self.run_notebook("own_data"))

    def test_point_cloud_mcap(self) -> None:
        self.assertRegex(self.run_notebook("point_cloud_mcap"), r"frame 4: \d+ points, the box at 1\.[67]\d m")


if __name__ == "__main__":
    unittest.main()
