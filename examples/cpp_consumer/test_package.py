#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The C++ package of the models as other projects meet it: installed and moved, in a program, a shared library and a test for it by
name, and the source tree as a subfolder, as a copy without a repository and as a folder that moves. CTest gives the build folder
(DTOF_BUILD), the flags that the models were built with (DTOF_FLAGS) and the compiler (CXX)."""

import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BUILD = Path(os.environ.get("DTOF_BUILD", ROOT / "build" / "cpp"))
FLAGS = os.environ.get("DTOF_FLAGS", "")
LONG = "DTOF_TEST_LONG" in os.environ  # what takes long (docs/reference/testplan.md)

# Debian's package clang has the name without a version.
CLANG = next(filter(None, (shutil.which(name) for name in ("clang++", *(f"clang++-{version}" for version in range(24, 13, -1))))), None)

FIND = "cmake_minimum_required(VERSION 3.25)\nproject(consumer LANGUAGES CXX)\nfind_package(dtof 0.3 {how})\n"
PLUGIN = """\
#include "dtof/readout/model.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
bool has_model() {
  return dtof::make_readout_model(dtof::default_parameters(dtof::Readout::kHisPointer, dtof::parse_preset("thesis"))) != nullptr;
}
"""
SUBFOLDER = f"""\
cmake_minimum_required(VERSION 3.25)
project(parent LANGUAGES CXX)
add_subdirectory({ROOT} dtof)
add_executable(own own.cpp)
target_link_libraries(own PRIVATE dtof::core)
"""


def run(*command: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                          env={**os.environ, **environment})


class Package(unittest.TestCase):
    folder: Path
    prefix: Path

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        done = run("cmake", "--install", BUILD, "--component", "models", "--prefix", cls.folder / "first")
        if done.returncode != 0:
            raise AssertionError(done.stdout)
        cls.prefix = cls.folder / "moved"  # a package does not depend on where it was installed first
        (cls.folder / "first").rename(cls.prefix)

    def configure(self, source: Path, *options: str, **environment: str) -> tuple[Path, subprocess.CompletedProcess[str]]:
        binary = source / "build"
        done = run("cmake", "-S", source, "-B", binary, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
                   *([f"-DCMAKE_CXX_FLAGS={FLAGS}"] if FLAGS else []), *options, **environment)
        return binary, done

    def build(self, source: Path, *options: str, target: str = "all") -> Path:
        binary, done = self.configure(source, *options)
        self.assertEqual(done.returncode, 0, done.stdout)
        done = run("cmake", "--build", binary, "--target", target)
        self.assertEqual(done.returncode, 0, done.stdout)
        return binary

    def project(self, name: str, text: str, **files: str) -> Path:
        source = self.folder / name
        source.mkdir()
        (source / "CMakeLists.txt").write_text(text, encoding="utf-8")
        for file, content in files.items():
            (source / f"{file}.cpp").write_text(content, encoding="utf-8")
        return source

    def test_the_example_finds_its_wall(self) -> None:
        """It asks for no C++ standard: the package does."""
        shutil.copytree(HERE / "project", self.folder / "example")
        self.assertNotIn("STANDARD", (self.folder / "example" / "CMakeLists.txt").read_text(encoding="utf-8"))
        done = run(self.build(self.folder / "example") / "consumer")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("wall at 2 m", done.stdout)

    def test_a_shared_library_takes_the_models_in(self) -> None:
        self.build(self.project("plugin", FIND.format(how="REQUIRED") + "add_library(plugin SHARED plugin.cpp)\n"
                                "target_link_libraries(plugin PRIVATE dtof::readout dtof::sensor)\n", plugin=PLUGIN))

    def test_every_installed_header_compiles_with_a_newer_standard(self) -> None:
        """In one file, and in a long run each header alone."""
        headers = sorted(str(path.relative_to(self.prefix / "include")) for path in (self.prefix / "include").rglob("*.hpp"))
        self.assertGreater(len(headers), 50)
        self.assertTrue(all(name.startswith("dtof/") for name in headers), headers)
        internal = [f"dtof/{file.parent.name}/{name}" for file in sorted((ROOT / "models/dtof").glob("*/CMakeLists.txt"))
                    for names in re.findall(r"\bINTERNAL ([\w. ]+)", file.read_text(encoding="utf-8")) for name in names.split()]  # fmt: skip
        self.assertIn("dtof/core/philox.hpp", internal)
        self.assertEqual(set(internal) & set(headers), set())
        files = [[name] for name in headers] if LONG else [headers]
        command = (os.environ.get("CXX", "c++"), "-std=c++23", "-fsyntax-only", f"-I{self.prefix / 'include'}", "-x", "c++", "/dev/null")
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            done = list(pool.map(lambda names: run(*command, *(part for name in names for part in ("-include", name))), files))
        for names, one in zip(files, done):
            self.assertEqual(one.returncode, 0, f"{names}: {one.stdout}")

    @unittest.skipUnless(LONG or CLANG is None, "clang++ builds with it, and g++ in a long run")
    def test_a_release_build_takes_a_newer_standard(self) -> None:
        source = self.project("newer", SUBFOLDER, own='#include "dtof/core/random.hpp"\nstatic_assert(__cplusplus > 202002L);\nint main() {}\n')
        self.build(source, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_STANDARD=23", "-DDTOF_WERROR=ON", target="own")

    def test_a_package_that_is_not_there_is_told_and_is_no_error_where_it_is_optional(self) -> None:
        source = self.project("quiet", FIND.format(how="QUIET") + 'message(STATUS "found: ${dtof_FOUND}")\n')
        _, done = self.configure(source, PKG_CONFIG_LIBDIR="/nonexistent", PKG_CONFIG_PATH="")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("found: 0", done.stdout)
        source = self.project("required", FIND.format(how="REQUIRED"))
        _, done = self.configure(source, PKG_CONFIG_LIBDIR="/nonexistent", PKG_CONFIG_PATH="")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("libtomlplusplus-dev", done.stdout)

    def test_a_parent_project_keeps_its_flags_its_launcher_and_its_tests(self) -> None:
        source = self.project("parent", SUBFOLDER, own='#include "dtof/core/random.hpp"\nint main() {}\n')
        binary, done = self.configure(source, "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -DOWN", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_COMPILER_LAUNCHER=env",
                                      "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
        self.assertEqual(done.returncode, 0, done.stdout)
        if LONG or CLANG is None:  # else clang++ builds in such a subfolder
            done = run("cmake", "--build", binary, "--target", "own")
            self.assertEqual(done.returncode, 0, done.stdout)
        commands = [one["command"] for one in json.loads((binary / "compile_commands.json").read_text(encoding="utf-8"))]
        self.assertGreater(len(commands), 5)
        # CMake 3.25 writes the launcher into the rule, 3.31 into a variable of each object.
        rules = (binary / "CMakeFiles" / "rules.ninja").read_text(encoding="utf-8").splitlines()
        objects = (binary / "build.ninja").read_text(encoding="utf-8").splitlines()
        launchers = {line.split("c++")[0] for line in rules if "$FLAGS" in line} | {line for line in objects if line.startswith("  LAUNCHER =")}
        self.assertTrue(any("env " in line for line in launchers), launchers)
        self.assertFalse(any("ccache" in line for line in launchers), launchers)
        for command in commands:
            self.assertIn("-DOWN", command)
            self.assertNotIn("-Werror", command)
            self.assertNotIn("-O2", command)
        self.assertNotIn("dtof_report", (binary / "build.ninja").read_text(encoding="utf-8"), "pictures need cairo and Python")
        self.assertNotRegex((binary / "build.ninja").read_text(encoding="utf-8"), r"(?m)^build \S*_test:", "a parent's build has no test of the project")

    @unittest.skipIf(CLANG is None, "clang++ is not here")
    def test_clang_builds_the_core_with_a_newer_standard(self) -> None:
        source = self.project("clang", SUBFOLDER, own='#include "dtof/core/random.hpp"\nint main() {}\n')
        self.build(source, f"-DCMAKE_CXX_COMPILER={CLANG}", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_STANDARD=23", "-DDTOF_WERROR=ON",
                   target="own")


class SourceTree(unittest.TestCase):
    """The project itself, configured from outside."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def succeed(self, *command: str | Path, **environment: str) -> str:
        done = run(*command, **environment)
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def commands(self, binary: Path) -> list[str]:
        """How the models are compiled."""
        commands = [one["command"] for one in json.loads((binary / "compile_commands.json").read_text(encoding="utf-8"))]
        models = [command for command in commands if " -o models/dtof/" in command]
        self.assertGreater(len(models), 10)
        return models

    def test_flags_and_launcher_of_the_caller_stay(self) -> None:
        own = self.folder / "own"
        self.succeed("cmake", "-S", ROOT, "-B", own, "-G", "Ninja", "-DDTOF_PROGRAMS=OFF", "-DDTOF_PYTHON=OFF", "-DCMAKE_BUILD_TYPE=Release",
                     "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -DOWN", "-DCMAKE_CXX_COMPILER_LAUNCHER=env")  # fmt: skip
        for command in self.commands(own):
            self.assertIn("-O3 -DOWN", command)
            self.assertNotIn("-O2", command)
            self.assertNotIn("-Werror", command)
        self.assertNotIn("ccache", "".join((own / name).read_text(encoding="utf-8") for name in ("build.ninja", "CMakeFiles/rules.ninja")))

    def test_warnings_are_errors_in_the_presets(self) -> None:
        preset = self.folder / "preset"
        self.succeed("cmake", "-S", ROOT, "--preset", "models", "-B", preset, "-DDTOF_PYTHON=OFF")
        for command in self.commands(preset):
            self.assertIn("-Werror", command)
            self.assertIn("-O2", command)

    def test_an_archive_is_configured_and_may_move(self) -> None:
        """A copy of the project's files has no repository, and is not in one."""
        first, second = self.folder / "first", self.folder / "second"
        alone = {"GIT_CEILING_DIRECTORIES": str(self.folder), "MAKEFLAGS": ""}  # nor has it the options of the make that runs the tests
        shutil.copytree(ROOT, first, symlinks=True, ignore=lambda folder, _: {".git", "build"} if Path(folder) == ROOT else {"__pycache__"})
        listed = [set(self.succeed(folder / "scripts/list_files.py", ".cpp", ".py", **alone).splitlines()) for folder in (first, ROOT)]
        self.assertGreater(len(listed[1]), 500)
        self.assertLessEqual(listed[1], listed[0])
        self.succeed("make", "-C", first, "configure", **alone)
        first.rename(second)
        self.succeed("make", "-C", second, "configure", **alone)
        cache = (second / "build/cpp/CMakeCache.txt").read_text(encoding="utf-8")
        self.assertIn(f"CMAKE_HOME_DIRECTORY:INTERNAL={second}\n", cache)
        self.assertNotIn(str(first), cache)


if __name__ == "__main__":
    unittest.main()
