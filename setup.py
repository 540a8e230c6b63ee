# SPDX-License-Identifier: Apache-2.0
"""`pip install .`: CMake builds the Python module, setuptools packs it. Everything else about the package is in pyproject.toml."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
VERSION = re.compile(r"^project\(dtof_readout VERSION ([0-9.]+)", re.MULTILINE)


class CMakeBuild(build_ext):
    """Builds the module in build/pip, where the next call finds what has not changed. DTOF_MODULE: a module that is built already."""

    def build_extension(self, ext: Extension) -> None:
        target = Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        if built := os.environ.get("DTOF_MODULE"):
            self.copy_file(built, str(target))
            return
        build = ROOT / "build" / "pip"
        build.mkdir(parents=True, exist_ok=True)
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL") or str(len(os.sched_getaffinity(0)))
        subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), "--fresh", "-DCMAKE_BUILD_TYPE=Release", "-DDTOF_PROGRAMS=OFF",
                        "-DDTOF_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "dtof_core_module", "--parallel", jobs], check=True)
        self.copy_file(str(build / "python" / "dtof" / target.name), str(target))


work = ROOT / "build" / "setuptools"
shutil.rmtree(work, ignore_errors=True)  # else a file that has gone would be packed again
work.mkdir(parents=True)
version = VERSION.search((ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
assert version is not None, "CMakeLists.txt states no version"
setup(
    version=version[1],
    ext_modules=[Extension("dtof._core", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    options={"egg_info": {"egg_base": "build/setuptools"}, "build": {"build_base": "build/setuptools"}},
)
