# SPDX-License-Identifier: Apache-2.0
"""The tests of the Verilated subsystems, in folders of their own: one build with all mutants, and one for a mutant at a time."""

import hashlib
import os
import re
import resource
import shutil
import signal
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from mutation import cpp, rtl_schemata
from mutation.mutant import Mutant
from mutation.schemata import Schemata
from mutation.verdict import MutationError

ROOT = Path(__file__).resolve().parent.parent.parent
TREE = [*cpp.TREE, "docs/user/registers.md", "formal", "parameters.toml", "CMakePresets.json"]
TARGET = "subsystem_test"
MODELS = "tb_cpp/tests/subsystem/models.cmake"
TESTS = "tb_cpp/tests/subsystem/CMakeLists.txt"
PACKAGES = "hdl/common/dtof_pkg.sv"  # the first file that Verilator reads
LENIENT = ("cmake/verilate.cmake", " -Wall -Wno-SYNCASYNCNET ", " -Wno-lint -Wno-fatal ")
TIMEOUT_FACTOR = 4  # of the processor time without a mutant, and ten seconds more; what runs longer hangs
FAILED = re.compile(r"^\[  FAILED  \] (\S+?),? ", re.MULTILINE)


class Invalid(Exception):
    """The mutant does not compile."""


def copy_tree(tree: Path) -> None:
    for name in TREE:
        source, target = ROOT / name, tree / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, target)


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    if text.count(old) != 1:
        raise MutationError(f"{path.name} has not exactly once: {old}")
    path.write_text(text.replace(old, new))


def fewer_models(text: str, kept: Sequence[str]) -> str:
    """The list of models without those that are not `kept`."""
    loops = re.sub(r"^foreach\(readout .*?^endforeach\(\)\n", "", text, flags=re.MULTILINE | re.DOTALL)
    found = re.findall(r"^dtof_verilate\((\w+)", loops, re.MULTILINE)
    if missing := set(kept) - set(found):
        raise MutationError(f"{MODELS} has no {', '.join(sorted(missing))}")
    for name in set(found) - set(kept):
        loops = re.sub(rf"^dtof_verilate\({name} .*?\)\n", "", loops, flags=re.MULTILINE | re.DOTALL)
    return loops


def killer(output: str) -> str:
    """Name of the test that failed first, or how the program ended."""
    failed = FAILED.search(output)
    return f"{TARGET}: {failed.group(1)}" if failed else f"{TARGET} ends early"


def cpu_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Build:
    """The program with the tests, compiled in `folder`: with all models or with `models` alone, optimised by the compiler or not."""

    def __init__(self, folder: Path, jobs: int, models: Sequence[str] = (), optimise: int = 1) -> None:
        self.jobs = jobs
        self.tree = folder / "tree"
        self.binary = self.tree / "build" / "cpp"  # as in the project: with CCACHE_BASEDIR set, ccache has what the project's own build compiled
        self.log = folder / "build.log"
        self.limits: dict[str, int] = {}  # seconds of processor time, by the filter of the tests, in the order in which they run
        shutil.rmtree(folder, ignore_errors=True)
        copy_tree(self.tree)
        if models:
            (self.tree / MODELS).write_text(fewer_models((self.tree / MODELS).read_text(), models))
        change(self.tree / TESTS, "OPTIONS -O1", f"OPTIONS -O{optimise}")

    def configure(self) -> None:
        self._run(["cmake", "-S", self.tree, "--preset", "release", "-DDTOF_PYTHON=OFF"])

    def _run(self, command: list[str | Path]) -> None:
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.log.write_text(result.stdout)
        if result.returncode != 0:
            raise Invalid(result.stdout)

    def compile(self) -> None:
        self._run(["ninja", "-j", str(self.jobs), "-C", self.binary, TARGET])

    def verilate(self, only: Sequence[str] = ()) -> None:
        """Runs Verilator alone, on all models or some."""
        folder = str(Path(MODELS).parent / "verilated")
        names = only or [path.stem.removesuffix("_maker") for path in sorted((self.binary / folder).glob("*_maker.cpp"))]
        self._run(["ninja", "-k", "0", "-j", str(self.jobs), "-C", self.binary, *(f"{folder}/{name}/model.cpp" for name in names)])

    def program(self) -> Path:
        return self.binary / "bin" / TARGET

    def measure(self, filters: Sequence[str]) -> None:
        """Runs the tests of each filter without a mutant; notes how long they may take with one. MutationError if one fails."""
        for chosen in filters:
            started = cpu_seconds()
            by = self.test(chosen)
            if by is not None:
                raise MutationError(f"the subsystem's tests fail without a mutant: {by}")
            self.limits[chosen] = round(TIMEOUT_FACTOR * (cpu_seconds() - started) + 10)

    def test(self, chosen: str, number: int = 0) -> str | None:
        """Name of the failed test, or that the program hangs; None if all pass. `number`: the mutant that is alive."""
        limit = self.limits.get(chosen)
        command: list[str | Path] = [self.program(), f"--gtest_filter={chosen}", "--gtest_fail_fast", "--gtest_brief=1"]
        if limit is not None:
            command = ["prlimit", f"--cpu={limit}:{limit + 10}", "--core=0", *command]
        environment = {**os.environ, rtl_schemata.VARIABLE: str(number)}
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", env=environment)
        if result.returncode == -signal.SIGXCPU:
            return f"{TARGET} hangs"
        return None if result.returncode == 0 else killer(result.stdout)


class LiveBuild(Build):
    """A build with all mutants, of which an environment variable makes one alive."""

    def __init__(self, folder: Path, jobs: int, models: Sequence[str] = ()) -> None:
        super().__init__(folder, jobs, models)
        change(self.tree / LENIENT[0], LENIENT[1], LENIENT[2])
        packages = self.tree / PACKAGES
        packages.write_text(rtl_schemata.DEFINITION + packages.read_text())
        self.written: set[str] = set()
        self.configure()

    def write(self, numbered: Mapping[Mutant, int]) -> dict[str, Schemata]:
        by_file: dict[str, dict[Mutant, int]] = {file: {} for file in self.written}
        for mutant, number in numbered.items():
            by_file.setdefault(mutant.file, {})[mutant] = number
        made = {file: rtl_schemata.with_mutants((ROOT / file).read_text(), own) for file, own in by_file.items()}
        for file, schemata in made.items():
            target = self.tree / file
            if target.read_text() != schemata.text:
                target.write_text(schemata.text)
        self.written = set(made)
        return made

    def add(self, numbered: Mapping[Mutant, int], first: Sequence[str]) -> set[Mutant]:
        """Compiles the mutants; returns those that Verilator refuses, which are left out. Models of which it refuses most come `first`."""
        refused: set[Mutant] = set()
        while True:
            made = self.write({mutant: number for mutant, number in numbered.items() if mutant not in refused})
            try:
                self.verilate(first)
                self.verilate()
                self.compile()
                return refused
            except Invalid as error:
                found = named(str(error), made)
                if not found:
                    raise MutationError(f"the subsystems with mutants do not compile: see {self.log}") from None
                refused |= found


def named(output: str, made: Mapping[str, Schemata]) -> set[Mutant]:
    """The mutants on the lines that Verilator's errors name."""
    found: set[Mutant] = set()
    for file, line in re.findall(r"^%Error[^:]*: \S*?(hdl/\w+/\w+\.sv):(\d+):", output, re.MULTILINE):
        if file in made:
            found |= made[file].mutants_at(int(line))
    return found


class OneBuild(Build):
    """A build that compiles one mutant after the other, fast, for tests that are short."""

    def __init__(self, folder: Path, jobs: int, models: Sequence[str], filters: Sequence[str]) -> None:
        super().__init__(folder, jobs, models, optimise=0)
        self.filters = filters
        self.configure()
        self.verilate()
        self.original = self.digest()

    def prepare(self) -> None:
        """Compiles and measures the build without a mutant, once."""
        if not self.limits:
            self.compile()
            self.measure(self.filters)

    @contextmanager
    def planted(self, mutant: Mutant) -> Iterator[None]:
        """The sources have the mutant inside."""
        target = self.tree / mutant.file
        original = target.read_text()
        target.write_text(mutant.planted(original))
        try:
            yield
        finally:
            target.write_text(original)

    def digest(self) -> str:
        """Digest of the C++ that Verilator made from all models."""
        found = hashlib.sha256()
        for path in sorted(self.binary.rglob("verilated/*/V*.*")):
            if path.suffix in (".cpp", ".h"):
                found.update(path.name.encode() + path.read_bytes())
        return found.hexdigest()

    def same_circuit(self, mutant: Mutant) -> bool:
        """True if no model differs. Invalid if Verilator refuses the mutant."""
        with self.planted(mutant):
            self.verilate()
            return self.digest() == self.original
