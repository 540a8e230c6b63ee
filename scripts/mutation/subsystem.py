# SPDX-License-Identifier: Apache-2.0
"""Mutants of hdl/subsystem. One build of the Verilated subsystems contains all mutants that can become alive when a model starts; the tests run
once for each. Verilator compiles each of the others, constants and the like, into a few subsystems, and into all if the tests of those
pass. What survives the tests is judged by the proofs of its module."""

import subprocess
import sys
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutation import progress, remembered, rtl_operators, rtl_schemata
from mutation.cpp import stable_number
from mutation.mutant import Mutant, Selection
from mutation.subsystem_build import ROOT, Build, Invalid, LiveBuild, OneBuild
from mutation.verdict import MutationError, Verdict

FOLDER = "hdl/subsystem"
# A generated file: the check of generated files (scripts/generate.py --check) refuses every change of it.
GENERATED = "dtof_registers_pkg.sv"
# Modules that no Verilated subsystem contains, and the tests in scripts/tests that simulate them.
ELSEWHERE = {
    "dtof_reset_synchroniser.sv": "test_reset_synchroniser",
    "dtof_synchroniser.sv": "test_async_line_fifo",
    "dtof_gray_pointer.sv": "test_async_line_fifo",
    "dtof_async_line_fifo.sv": "test_async_line_fifo",
}
LEAST_OF_FILE = 2  # mutants of each file, however small
# Tests that notice most mutants, then all others. Frames of 3,333 acquisitions and more say nothing about a subsystem that shorter ones do not.
FIRST = ("*Registers/Subsystem*", "*SubsystemFrames*")
FILTERS = (":".join(FIRST), f"-*Long*:{':'.join(FIRST)}")
# Of each kind one subsystem: SRAM and registers as buffer, APB4 and AXI4-Lite, a source that waits and one that drops, raster order, two targets.
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


class Judge:
    """Judges mutants by tests and proofs. The builds that few mutants need are made when the first needs them."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.folder = folder
        self.jobs = jobs
        self.live = LiveBuild(folder / "live", jobs)
        self._ones: dict[str, OneBuild] = {}
        self._digest = ""

    def _one(self, name: str, models: Iterable[str]) -> OneBuild:
        if name not in self._ones:
            build = OneBuild(self.folder / name, self.jobs, tuple(models), optimise=0)
            build.configure()
            build.compile()
            build.measure(FILTERS)
            self._ones[name] = build
        return self._ones[name]

    def few(self) -> OneBuild:
        return self._one("few", FEW)

    def all(self) -> OneBuild:
        return self._one("all", ())

    def by_tests(self, build: Build, number: int = 0) -> str | None:
        return next((by for chosen in FILTERS if (by := build.test(chosen, number)) is not None), None)

    def compiled(self, mutant: Mutant) -> Verdict:
        """Judges a mutant that needs models of its own. Invalid if it does not compile."""
        for build in (self.few, self.all):
            by = self.planted(build(), mutant)
            if by is not None:
                return Verdict(mutant, "killed", by)
        return self.survivor(mutant)

    def planted(self, build: OneBuild, mutant: Mutant) -> str | None:
        original = build.plant(mutant)
        try:
            build.compile()
            return self.by_tests(build)
        finally:
            (build.tree / mutant.file).write_text(original)

    def survivor(self, mutant: Mutant) -> Verdict:
        """Judges a mutant that the tests pass: is it another circuit at all, and do the module's proofs notice?"""
        if self.same_circuit(mutant):
            return Verdict(mutant, "proved equivalent", "the same compiled circuit in every configuration")
        by = self.proofs(mutant)
        return Verdict(mutant, "killed", by) if by else Verdict(mutant, "survived", "")

    def same_circuit(self, mutant: Mutant) -> bool:
        build = self.all()
        if not self._digest:
            build.verilate()
            self._digest = build.digest()
        original = build.plant(mutant)
        try:
            build.verilate()
            return build.digest() == self._digest
        except Invalid:
            return False
        finally:
            (build.tree / mutant.file).write_text(original)
            build.verilate()

    def proofs(self, mutant: Mutant) -> str:
        return self.in_tree(mutant, ["scripts/mutation/proofs.py", Path(mutant.file).stem]).stdout.strip()

    def elsewhere(self, mutant: Mutant) -> Verdict:
        """Judges a mutant of a module that no Verilated subsystem contains."""
        test = ELSEWHERE[Path(mutant.file).name]
        if lint(self.live.tree, mutant):
            raise Invalid
        ran = self.in_tree(mutant, ["-m", "unittest", "-f", f"tests.{test}"], "scripts")
        if ran.returncode != 0:
            return Verdict(mutant, "killed", f"scripts/tests/{test}.py")
        by = self.proofs(mutant)
        return Verdict(mutant, "killed", by) if by else Verdict(mutant, "survived", "")

    def in_tree(self, mutant: Mutant | None, command: list[str], folder: str = ".") -> subprocess.CompletedProcess[str]:
        """Runs Python in a tree with the mutant."""
        tree = self.few().tree
        original = self.few().plant(mutant) if mutant else ""
        try:
            return subprocess.run([sys.executable, *command], cwd=tree / folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        finally:
            if mutant:
                (tree / mutant.file).write_text(original)


def lint(tree: Path, mutant: Mutant) -> bool:
    """True if Icarus Verilog refuses the module with the mutant."""
    text = (tree / mutant.file).read_text()
    changed = text[: mutant.begin] + mutant.mutated + text[mutant.end :]
    others = [str(tree / FOLDER / name) for name in ELSEWHERE if name != Path(mutant.file).name]
    command = ["iverilog", "-g2012", f"-I{tree}/hdl/common", "-t", "null", *others, "/dev/stdin"]
    return subprocess.run(command, input=changed, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0


def first_pass(judge: Judge, mutants: Iterable[Mutant]) -> tuple[dict[Mutant, Verdict], list[Mutant], set[Mutant]]:
    """Judges mutants; returns the verdicts, those that a build with all mutants cannot contain, and those that do not compile."""
    by_file: dict[str, list[Mutant]] = {}
    for mutant in mutants:
        by_file.setdefault(mutant.file, []).append(mutant)
    elsewhere = [mutant for file, some in by_file.items() if Path(file).name in ELSEWHERE for mutant in some]
    apart = {mutant for file, some in by_file.items() for mutant in rtl_schemata.apart((ROOT / file).read_text(), some)} - set(elsewhere)
    numbered = {mutant: stable_number(mutant) for some in by_file.values() for mutant in some if mutant not in apart | set(elsewhere)}
    assert len(set(numbered.values())) == len(numbered)
    progress.show(f"compiling {len(numbered)} of the subsystem's mutants into one build")
    apart |= judge.live.add(numbered, FEW)
    judge.live.measure(FILTERS)
    live = [mutant for mutant in numbered if mutant not in apart]
    verdicts: dict[Mutant, Verdict] = {}
    with ThreadPoolExecutor(judge.jobs) as pool:
        for mutant, by in zip(live, pool.map(lambda mutant: judge.by_tests(judge.live, numbered[mutant]), live)):
            verdicts[mutant] = Verdict(mutant, "killed", by) if by else judge.survivor(mutant)
            progress.show(f"subsystem's mutants: {len(verdicts)} of {len(live)} judged in one build")
    refused: set[Mutant] = set()
    ordered = sorted(apart, key=lambda mutant: (mutant.file, mutant.begin))
    for mutant in [*ordered, *elsewhere]:
        try:
            verdicts[mutant] = judge.elsewhere(mutant) if mutant in elsewhere else judge.compiled(mutant)
        except Invalid:
            refused.add(mutant)
        progress.show(f"subsystem's mutants: {len(verdicts)} judged")
    return verdicts, ordered, refused


def run(count: int, seed: int, folder: Path, jobs: int) -> list[Verdict]:
    """Judges about `count` mutants. Stops if a test fails without a mutant."""
    progress.show("subsystem without mutants")
    selection = select(ROOT, count, seed)
    verdicts: dict[Mutant, Verdict] = {}
    try:
        judge = Judge(folder.resolve(), jobs)
        while waiting := [mutant for mutant in selection.mutants if mutant not in verdicts]:
            found, _, refused = first_pass(judge, waiting)
            verdicts |= found
            selection.refuse(refused)
    except Invalid as error:
        judge_log = folder / "refused.log"
        judge_log.write_text(str(error))
        raise MutationError(f"the subsystem's tests do not compile: see {judge_log}") from None
    progress.done()
    return [verdicts[mutant] for mutant in selection.mutants]
