# SPDX-License-Identifier: Apache-2.0
"""`pip install .` from the source tree without network, and what CMake says where pybind11 is not.

pip packs the module that these tests import, and what it would compile is listed. DTOF_TEST_LONG=1, as .ci/long has it: pip compiles the module, and
the examples run with it outside of the source tree.
"""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import dtof

from programs import BIN, ROOT

LONG = "DTOF_TEST_LONG" in os.environ
NEEDED = ("pip", "setuptools", "wheel")
PROGRAM = """
import dtof
made = dtof.frame(dtof.Scene("room", columns=4, rows=4), readouts=["sifh"])["sifh"]
print(dtof.__file__, dtof.__version__, made.results.code.tolist())
"""
# An installed module has the texts of the RTL in it; no source tree is beside it.
RTL_PROGRAM = """
import dtof
photons = dtof.event_list([0, 0], [0, 1], [3, 7], [9, 40], columns=1, rows=2, acquisitions=50, np=6)
print(dtof.read_out(photons, dtof.Readout("sifh", np=6), engine="rtl").code.tolist())
"""


def configure(folder: str, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["cmake", "-S", str(ROOT), "-B", folder, "-DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON", *options],
                          capture_output=True, text=True, check=False)


class InstallTest(unittest.TestCase):
    @unittest.skipUnless(all(importlib.util.find_spec(name) for name in NEEDED), "pip, setuptools or wheel is not installed")
    def test_pip_install(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", folder], check=True)
            python = Path(folder) / "bin" / "python"
            done = subprocess.run([sys.executable, "-m", "pip", "--python", str(python), "install", "--no-build-isolation", "--no-index", "."],
                                  cwd=ROOT, capture_output=True, text=True, check=False,
                                  env=os.environ | ({} if LONG else {"DTOF_MODULE": dtof._core.__file__}))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
            said = subprocess.run([python, "-c", PROGRAM], cwd=folder, capture_output=True, text=True, check=True, env=environment).stdout
            if shutil.which("verilator"):
                codes = subprocess.run([python, "-c", RTL_PROGRAM], cwd=folder, capture_output=True, text=True, check=True,
                                       env=environment | {"DTOF_CACHE": folder}).stdout
                photons = dtof.event_list([0, 0], [0, 1], [3, 7], [9, 40], columns=1, rows=2, acquisitions=50, np=6)
                self.assertEqual(codes.strip(), str(dtof.read_out(photons, dtof.Readout("sifh", np=6)).code.tolist()))
            if LONG:
                for example in sorted((ROOT / "examples" / "python").glob("*.py")):
                    done = subprocess.run([python, shutil.copy(example, folder), folder], cwd=folder, capture_output=True, text=True, check=False,
                                          env=environment | {"DTOF_BIN": str(BIN)})
                    self.assertEqual((done.returncode, done.stderr), (0, ""), example.name)
            typed = [path.name for path in Path(said.split()[0]).parent.iterdir()]
        self.assertTrue(said.startswith(folder), said)
        made = dtof.frame(dtof.Scene("room", columns=4, rows=4), readouts=["sifh"])["sifh"]
        self.assertEqual(said.split(maxsplit=1)[1].strip(), f"{dtof.__version__} {made.results.code.tolist()}")
        self.assertLessEqual({"_core.pyi", "py.typed"}, set(typed))

    def test_the_version_is_the_projects(self) -> None:
        found = re.search(r"project\(dtof_readout VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
        assert found is not None
        self.assertEqual(dtof.__version__, found[1])

    def test_without_pybind11_the_programs_are_configured_and_a_line_says_so(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            done = configure(folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(re.findall("-- (No Python module.*)", done.stdout),
                             ["No Python module is built: pybind11 or Python's headers are not here (Debian: pybind11-dev, python3-dev)"])
            self.assertFalse((Path(folder) / "python").exists())

    def test_without_verilator_the_module_is_configured_and_a_line_says_so(self) -> None:
        line = "-- The Python module will run no RTL: verilator is not here (Debian: verilator)\n"
        options = ("-DDTOF_PROGRAMS=OFF", "-DDTOF_PYTHON=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_pybind11=OFF", "-G", "Ninja")
        for verilator in ("-DVERILATOR=OFF", *(["-UVERILATOR"] if shutil.which("verilator") else [])):
            with self.subTest(verilator), tempfile.TemporaryDirectory() as folder:
                done = configure(folder, *options, verilator)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(line in done.stdout, verilator == "-DVERILATOR=OFF", done.stdout)
                self.assertEqual((Path(folder) / "tb_cpp").exists(), verilator != "-DVERILATOR=OFF")
                done = subprocess.run(["ninja", "-C", folder, "-t", "commands", "dtof_core_module"], capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertEqual("libdtof_run.a" in done.stdout, verilator != "-DVERILATOR=OFF", done.stdout)

    def test_the_module_alone_cannot_do_without(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            done = configure(folder, "-DDTOF_PROGRAMS=OFF", "-DDTOF_PYTHON=ON")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("No Python module can be built", done.stderr)


if __name__ == "__main__":
    unittest.main()
