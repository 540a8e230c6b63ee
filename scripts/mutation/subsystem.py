# SPDX-License-Identifier: Apache-2.0
"""Mutants of hdl/subsystem. One build of the Verilated subsystems contains all mutants that can become alive when a model starts; the tests run
once for each. Verilator compiles each of the others, constants and the like, into a few subsystems, and into all if the tests of those
pass. What survives the tests is judged by the proofs of its module."""

import hashlib
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutation import progress, remembered, rtl_operators, rtl_schemata
from mutation.cpp import stable_number
from mutation.kept import Kept
from mutation.mutant import Mutant, Selection
from mutation.subsystem_build import ROOT, Build, Invalid, LiveBuild, OneBuild, copy_tree
from mutation.verdict import MutationError, Verdict

FOLDER = "hdl/subsystem"
# A generated file: the check of generated files (scripts/generate.py --check) refuses every change of it.
GENERATED = "dtof_registers_pkg.sv"
# Modules that no Verilated subsystem contains, and the tests in scripts/tests that simulate them as they are. Tests that plant faults of their
# own are left out: these search the module for its text, and a mutant changes this text.
FIFO = tuple(f"test_async_line_fifo.{name}" for name in (
    "Synchroniser.test_a_level_arrives_with_the_second_edge", "AsyncLineFifo.test_eight_lines_pass_a_line_per_clock",
    "AsyncLineFifo.test_every_line_leaves_once_and_in_order", "AsyncLineFifo.test_resets_lose_what_the_header_says_and_no_more"))  # fmt: skip
ELSEWHERE = {
    "dtof_reset_synchroniser.sv": ("test_reset_synchroniser.ResetSynchroniser.test_it_falls_at_once_and_rises_at_the_second_edge",),
    "dtof_synchroniser.sv": FIFO,
    "dtof_gray_pointer.sv": FIFO,
    "dtof_async_line_fifo.sv": FIFO,
}
SIMULATIONS = sorted({test.partition(".")[0] for tests in ELSEWHERE.values() for test in tests})
DECIDING = ("hdl", "tb_cpp", "driver", "models", "formal", "scripts/formal.py", "scripts/tests/async_line_fifo_bench.sv",
            *(f"scripts/tests/{name}.py" for name in SIMULATIONS))  # fmt: skip
REFUSED = "refused"  # by the compiler: kept for a run that goes on, never counted
LEAST_OF_FILE = 2  # mutants of each file, however small
# First all tests but those that take nearly all of the time, then these. Frames of 3,333 acquisitions and more say nothing about a subsystem that
# shorter ones do not.
LONG = ("*Gaps.ChangeNoResult/*", "*RandomStreamFaults.*", "*.AWarningIsNotLostInTheClockInWhichItIsCleared/*", "*.ReportWhichCountersAreFull/*",
        "*.ReportFullCountersOfAnyPass/*", "*Parity.OfAnArrayReportsEachBitThatChangesAResult/*", "*DroppedAcquisitions.AreWholeAndCounted/*")  # fmt: skip
# Tests of models that are not among FEW.
PRODUCTS = ("DriverExampleProducts.*", "GoogleTestVerification.*")
FILTERS = (f"-*Long*:{':'.join(LONG)}", ":".join(LONG))
FILTERS_OF_FEW = (f"{FILTERS[0]}:{':'.join(PRODUCTS)}", FILTERS[1])
# A subsystem of each kind: SRAM and registers as buffer, APB4 and AXI4-Lite, a source that waits and one that drops, raster order, two targets.
FEW = ("subsystem_ez", "subsystem_his", "subsystem_pool_drops", "subsystem_second_raster", "subsystem_prior")


def select(tree: Path, count: int, seed: int) -> Selection:
    """The remembered mutants, and about `count` others: of each file as many as its share of the statements, but at least a few."""
    groups = {}
    for path in sorted((tree / FOLDER).glob("*.sv")):
        if path.name != GENERATED:
            groups[path.name] = rtl_operators.mutants(str(path.relative_to(tree)), path.read_text())
    statements = {name: len({mutant.place for mutant in found}) for name, found in groups.items()}
    whole = sum(statements.values())
    drawn = [(found, max(LEAST_OF_FILE, round(count * statements[name] / whole))) for name, found in groups.items()]
    return Selection(drawn, seed, remembered.load(tree, FOLDER))


def by_tests(build: Build, number: int = 0) -> str | None:
    """The first test that notices a mutant."""
    return next((by for chosen in build.limits if (by := build.test(chosen, number)) is not None), None)


class Judge:
    """Judges mutants by tests and proofs. The builds that few mutants need are made when the first needs them."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.folder = folder
        self.jobs = jobs
        self._passed: set[str] = set()  # tests elsewhere that pass without a mutant
        self._builds: dict[str, OneBuild] = {}

    def _build(self, name: str, models: Sequence[str], filters: Sequence[str]) -> OneBuild:
        if name not in self._builds:
            self._builds[name] = OneBuild(self.folder / name, self.jobs, models, filters)
        return self._builds[name]

    def few(self) -> OneBuild:
        return self._build("few", FEW, FILTERS_OF_FEW)

    def all(self) -> OneBuild:
        return self._build("all", (), FILTERS)

    def compiled(self, mutant: Mutant) -> Verdict:
        """Judges a mutant that needs models of its own. Invalid if it does not compile."""
        for build in (self.few, self.all):
            by = self.by_build(build(), mutant)
            if by is not None:
                return Verdict(mutant, "killed", by)
        return self.survivor(mutant)

    def by_build(self, build: OneBuild, mutant: Mutant) -> str | None:
        """The first test of a build that notices a mutant."""
        if build.same_circuit(mutant):
            return None
        build.prepare()
        with build.planted(mutant):
            build.compile()
            return by_tests(build)

    def survivor(self, mutant: Mutant) -> Verdict:
        """Judges a mutant that the tests pass: is it another circuit at all, and do the module's proofs notice?"""
        if self.all().same_circuit(mutant):
            return Verdict(mutant, "proved equivalent", "the same compiled circuit in every configuration")
        by = self.proofs(mutant)
        return Verdict(mutant, "killed", by) if by else Verdict(mutant, "survived", "")

    def proofs(self, mutant: Mutant) -> str:
        return self.in_tree(mutant, ["-m", "mutation.proofs", Path(mutant.file).stem]).stdout.strip()

    def elsewhere(self, mutant: Mutant) -> Verdict:
        """Judges a mutant of a module that no Verilated subsystem contains."""
        if refused_by_icarus(mutant):
            raise Invalid
        for test in ELSEWHERE[Path(mutant.file).name]:
            if test not in self._passed:
                if self.in_tree(None, ["-m", "unittest", f"tests.{test}"]).returncode != 0:
                    raise MutationError(f"scripts/tests fail without a mutant: {test}")
                self._passed.add(test)
            if self.in_tree(mutant, ["-m", "unittest", "-f", f"tests.{test}"]).returncode != 0:
                return Verdict(mutant, "killed", f"scripts/tests: {test}")
        by = self.proofs(mutant)
        return Verdict(mutant, "killed", by) if by else Verdict(mutant, "survived", "")

    def in_tree(self, mutant: Mutant | None, command: Sequence[str]) -> subprocess.CompletedProcess[str]:
        """Runs Python in the folder scripts of a tree with the mutant, or without any."""
        tree = self.folder / "sources"
        if not tree.exists():
            copy_tree(tree)
        arguments = [sys.executable, "-B", *command]
        if mutant is None:
            return subprocess.run(arguments, cwd=tree / "scripts", text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        target = tree / mutant.file
        original = target.read_text()
        target.write_text(mutant.planted(original))
        try:
            return subprocess.run(arguments, cwd=tree / "scripts", text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        finally:
            target.write_text(original)


def refused_by_icarus(mutant: Mutant, tree: Path = ROOT) -> bool:
    """True if the mutant does not compile where its module is simulated."""
    changed = mutant.planted((tree / mutant.file).read_text())
    others = [str(tree / FOLDER / name) for name in ELSEWHERE if name != Path(mutant.file).name]
    command = ["iverilog", "-g2012", f"-I{tree}/hdl/common", "-t", "null", *others, "/dev/stdin"]
    return subprocess.run(command, input=changed, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0


def digest(tree: Path) -> str:
    """Digest of what decides a verdict: RTL, models, tests, proofs."""
    found = hashlib.sha256()
    for name in DECIDING:
        for path in sorted(path for path in [tree / name, *(tree / name).rglob("*")] if path.is_file() and path.suffix != ".pyc"):
            found.update(str(path.relative_to(tree)).encode() + b"\0" + path.read_bytes())
    return found.hexdigest()


class Run:
    """Judges mutants; goes on where an interrupted run ended."""

    def __init__(self, folder: Path, jobs: int) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        shutil.rmtree(folder / "sources", ignore_errors=True)  # of an earlier run
        self.judge = Judge(folder, jobs)
        self.kept = Kept(folder / "verdicts.json")
        self.digest = digest(ROOT)
        self.verdicts: dict[Mutant, Verdict] = {}

    def note(self, verdict: Verdict) -> None:
        self.verdicts[verdict.mutant] = verdict
        self.kept.put(verdict, self.digest)
        progress.show(f"subsystem's mutants: {len(self.verdicts)} judged")

    def judged(self, mutants: Sequence[Mutant]) -> set[Mutant]:
        """Judges those that have no verdict yet; returns those that do not compile."""
        known = {mutant: found for mutant in mutants if (found := self.kept.get(mutant, self.digest))}
        refused = {mutant for mutant, found in known.items() if found.state == REFUSED}
        self.verdicts |= {mutant: found for mutant, found in known.items() if mutant not in refused}
        waiting = [mutant for mutant in mutants if mutant not in self.verdicts and mutant not in refused]
        elsewhere = [mutant for mutant in waiting if Path(mutant.file).name in ELSEWHERE]
        inside = [mutant for mutant in waiting if mutant not in elsewhere]
        constants = {mutant for file in {mutant.file for mutant in inside}
                     for mutant in rtl_schemata.apart((ROOT / file).read_text(), [one for one in inside if one.file == file])}  # fmt: skip
        constants |= self.together({mutant: stable_number(mutant) for mutant in inside if mutant not in constants})
        for mutant in waiting:
            if mutant in elsewhere or mutant in constants:
                try:
                    self.note(self.judge.elsewhere(mutant) if mutant in elsewhere else self.judge.compiled(mutant))
                except Invalid:
                    refused.add(mutant)
                    self.kept.put(Verdict(mutant, REFUSED, ""), self.digest)
        return refused

    def together(self, numbered: Mapping[Mutant, int]) -> set[Mutant]:
        """Judges mutants in one build of a few subsystems, and what survives there in one of all; returns those that no such build can contain."""
        left_out: set[Mutant] = set()
        for name, models, filters in (("live_few", FEW, FILTERS_OF_FEW), ("live_all", (), FILTERS)):
            numbered = {mutant: number for mutant, number in numbered.items() if mutant not in left_out and mutant not in self.verdicts}
            if not numbered:
                return left_out
            progress.show(f"compiling {len(numbered)} of the subsystem's mutants into one build")
            build = LiveBuild(self.judge.folder / name, self.judge.jobs, models)
            left_out |= build.add(numbered, FEW[:1])
            build.measure(filters)
            live = [mutant for mutant in numbered if mutant not in left_out]
            with ThreadPoolExecutor(self.judge.jobs) as pool:
                for mutant, by in zip(live, pool.map(lambda mutant: by_tests(build, numbered[mutant]), live)):
                    if by:
                        self.note(Verdict(mutant, "killed", by))
        for mutant in numbered:
            if mutant not in left_out and mutant not in self.verdicts:
                self.note(self.judge.survivor(mutant))
        return left_out


def run(count: int, seed: int, folder: Path, jobs: int) -> list[Verdict]:
    """Judges about `count` mutants. Stops if a test fails without a mutant."""
    selection = select(ROOT, count, seed)
    try:
        whole = Run(folder.resolve(), jobs)
        while refused := whole.judged(selection.mutants):
            selection.refuse(refused)
    except Invalid as error:
        log = folder / "refused.log"
        log.write_text(str(error))
        raise MutationError(f"the subsystem's tests do not compile without a mutant: see {log}") from None
    progress.done()
    return [whole.verdicts[mutant] for mutant in selection.mutants]
