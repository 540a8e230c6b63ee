# SPDX-License-Identifier: Apache-2.0
"""Mutants of hdl/subsystem: Verilator compiles each into the subsystems of the C++ tests, which then run."""

import re
import shutil
import subprocess
import time
from pathlib import Path

from mutation import cpp, progress, remembered, rtl_operators
from mutation.mutant import Mutant, Selection
from mutation.verdict import MutationError, Verdict

ROOT = Path(__file__).resolve().parent.parent.parent
TREE = [*cpp.TREE, "docs/user/registers.md"]
FOLDER = "hdl/subsystem"
TARGET = "subsystem_test"
# Frames of 3,333 acquisitions and more say nothing about a subsystem that shorter ones do not.
TESTS = "-*Long*"
# Modules that no Verilated subsystem contains; scripts/tests/test_reset_synchroniser.py and test_async_line_fifo.py simulate them.
ELSEWHERE = ("dtof_reset_synchroniser.sv", "dtof_synchroniser.sv", "dtof_gray_pointer.sv", "dtof_async_line_fifo.sv")
TIMEOUT_FACTOR = 5  # of the time without a mutant, and ten seconds more; what runs longer hangs
FAILED = re.compile(r"^\[  FAILED  \] (\S+?),? ", re.MULTILINE)


class Invalid(Exception):
    """The mutant does not compile."""


def select(tree: Path, count: int, seed: int) -> Selection:
    found: list[Mutant] = []
    for path in sorted((tree / FOLDER).glob("*.sv")):
        if path.name not in ELSEWHERE:
            found += rtl_operators.mutants(str(path.relative_to(tree)), path.read_text())
    return Selection([(found, count)], seed, remembered.load(tree, FOLDER))


def killer(output: str) -> str:
    """Name of the test that failed first, or how the program ended."""
    failed = FAILED.search(output)
    return f"{TARGET}: {failed.group(1)}" if failed else f"{TARGET} ends early"


class Build:
    """The tests of the subsystem in a folder of their own."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.jobs = jobs
        self.tree = folder / "tree"
        self.binary = folder / "build"
        self.log = folder / "build.log"
        shutil.rmtree(folder, ignore_errors=True)
        for name in TREE:
            source, target = ROOT / name, self.tree / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, target)
        self._run(["cmake", "-S", self.tree, "-B", self.binary, "-G", "Ninja", "-DDTOF_PYTHON=OFF", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O2"])
        self.compile()
        started = time.monotonic()
        by = self.test(None)
        if by is not None:
            raise MutationError(f"the subsystem's tests fail without a mutant: {by}")
        self.timeout_s = TIMEOUT_FACTOR * (time.monotonic() - started) + 10

    def _run(self, command: list[str | Path]) -> None:
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.log.write_text(result.stdout)
        if result.returncode != 0:
            raise Invalid(f"see {self.log}")

    def compile(self) -> None:
        self._run(["ninja", "-j", str(self.jobs), "-C", self.binary, TARGET])

    def test(self, timeout_s: float | None) -> str | None:
        """Name of the failed test, or that the program hangs; None if all pass."""
        program = next(self.binary.rglob(TARGET))
        try:
            result = subprocess.run([program, f"--gtest_filter={TESTS}", "--gtest_fail_fast", "--gtest_brief=1"],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                                    timeout=timeout_s)  # fmt: skip
        except subprocess.TimeoutExpired:
            return f"{TARGET} hangs"
        return None if result.returncode == 0 else killer(result.stdout)

    def judge(self, mutant: Mutant) -> Verdict:
        target = self.tree / mutant.file
        original = target.read_text()
        target.write_text(original[: mutant.begin] + mutant.mutated + original[mutant.end :])
        try:
            self.compile()
            by = self.test(self.timeout_s)
        finally:
            target.write_text(original)
        return Verdict(mutant, "survived", "") if by is None else Verdict(mutant, "killed", by)


def run(count: int, seed: int, folder: Path, jobs: int) -> list[Verdict]:
    """Judges `count` mutants. Stops if a test fails without a mutant."""
    progress.show("subsystem without mutants")
    try:
        build = Build(folder.resolve(), jobs)
    except Invalid as error:
        raise MutationError(f"the subsystem's tests do not compile: {error}") from None
    selection = select(build.tree, count, seed)
    verdicts: dict[Mutant, Verdict] = {}
    while open_mutants := [mutant for mutant in selection.mutants if mutant not in verdicts]:
        refused: set[Mutant] = set()
        for mutant in open_mutants:
            try:
                verdicts[mutant] = build.judge(mutant)
            except Invalid:
                refused.add(mutant)
            progress.show(f"subsystem's mutants: {len(verdicts)} of {len(selection.mutants)} judged")
        selection.refuse(refused)
    progress.done()
    return [verdicts[mutant] for mutant in selection.mutants]
