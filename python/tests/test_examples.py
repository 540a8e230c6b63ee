# SPDX-License-Identifier: Apache-2.0
"""The examples run, each within a minute of processor time, and their pictures are drawn where matplotlib is installed; the pages' code runs, too."""

import importlib.util
import os
import re
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from programs import BIN, ROOT

EXAMPLES = ROOT / "examples" / "python"
PICTURES: dict[str, list[str]] = {"first_picture": ["first_picture.png", "first_picture_pixel.png"], "own_sensor": ["own_sensor.png"],
                                 "own_data": ["own_data.png"], "point_cloud_mcap": []}  # what it writes: test_mcap.py
PAGE = ROOT / "docs" / "user" / "python.md"
SECONDS = 60.0


def run(code: str | Path, folder: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-W", "error::DeprecationWarning:__main__"] + (["-c", code] if isinstance(code, str) else [str(code)])
    return subprocess.run([*command, *arguments], capture_output=True, text=True, check=False, cwd=folder, timeout=600,
                          env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path), "DTOF_BIN": str(BIN)} | environment)


def processor_seconds() -> float:
    """What the programs that were run have taken; how busy the machine is does not matter."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class ExamplesTest(unittest.TestCase):
    def test_every_example_is_tried(self) -> None:
        self.assertEqual({file.stem for file in EXAMPLES.glob("*.py")}, set(PICTURES))

    def try_example(self, name: str) -> str:
        with tempfile.TemporaryDirectory() as folder:
            begin = processor_seconds()
            done = run(EXAMPLES / f"{name}.py", folder, folder)
            seconds = processor_seconds() - begin
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertLess(seconds, SECONDS)
            if importlib.util.find_spec("matplotlib") is not None:
                for picture in PICTURES[name]:
                    self.assertGreater((Path(folder) / picture).stat().st_size, 10_000, picture)
        return done.stdout

    def test_first_picture(self) -> None:
        said = self.try_example("first_picture")
        shares = [float(share) for share in re.findall(r"([\d.]+)% of the pixels", said)]
        self.assertEqual(len(shares), 3)
        self.assertEqual(shares, sorted(shares, reverse=True))  # SiFH, hisPointer, poolPointer

    def test_own_sensor(self) -> None:
        said = self.try_example("own_sensor")
        self.assertRegex(said, r"(?m)^hisPointer {2,}[\d.]+% \( *[\d.]+% to +[\d.]+%\) +\d+ mm")
        self.assertRegex(said, r"HEDH-4 +30 bits a pixel: [\d.]+%")
        recommended = re.search(r"(?m)^recommended: ([a-z-]+), 0\.[012]\d mm2$", said)  # --max-mm2 0.3
        assert recommended is not None, said
        self.assertIn(f"its product: dtof product --sensor mine.toml --readout {recommended[1]} ", said)
        for file in ("rtl/ ", "driver/ ", "bench/ ", "vectors/ ", "Makefile\n", "product.f\n", "sensor.toml\n", "README.md\n"):
            self.assertIn(f"\n  {file}", said)

    def test_own_sensor_without_the_program(self) -> None:
        cells = (EXAMPLES / "own_sensor.py").read_text(encoding="utf-8").split("# %%\n")
        with tempfile.TemporaryDirectory() as folder:
            done = run("\n".join([cells[1], 'sensor_file = ""', cells[-1]]), folder, DTOF_BIN="", PATH="")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout, "no chip: the program dtof is not found; build it with make, or put its folder into PATH\n")

    def test_own_data(self) -> None:
        said = self.try_example("own_data")
        self.assertIn("the same codes: True", said)
        self.assertRegex(said, r"hisPointer, 400 photons a pixel: +[\d.]+%")

    def test_point_cloud_mcap(self) -> None:
        said = self.try_example("point_cloud_mcap")
        distances = [float(distance) for distance in re.findall(r"the box at ([\d.]+) m", said)]
        for found, expected in zip(distances, (2.5, 2.3, 2.1, 1.9, 1.7), strict=True):
            self.assertAlmostEqual(found, expected, delta=0.05)

    def test_the_pages_code(self) -> None:
        text = PAGE.read_text(encoding="utf-8")
        blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertGreater(len(blocks), 3)
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, {"DTOF_CACHE": folder}):
            done = run("\n".join(blocks), folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"\A(Builds the RTL of .*\n)?\Z")


if __name__ == "__main__":
    unittest.main()
