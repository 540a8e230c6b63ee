# SPDX-License-Identifier: Apache-2.0
"""Mutants of the synthesis flow: Python that computes its figures, and timing constraints. The tests in synth/tests judge them."""

import ast
import compileall
import hashlib
import os
import queue
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path

from mutation import progress, python_operators, remembered, sdc_operators
from mutation.kept import Kept
from mutation.mutant import Mutant, Selection
from mutation.verdict import MutationError, Verdict

ROOT = Path(__file__).resolve().parent.parent.parent
PYTHON = "/usr/bin/python3"
PACKAGE = "synth/dtof_synth"
TESTS = "synth/tests"
FLOW = ("synth", "constraints", "hdl", "models/dtof/design", "configurations.toml", "readouts.toml")
TREE = (*FLOW, "reports", "scripts")
# Modules from which figures, or judgements on them, come; neither commands, pages and pictures nor runs of the tools, nor what places
# and repairs a layout, which design rules and a comparison of netlists judge.
MODULES = (
    "activity", "area_parts", "batch", "budgets", "canonical", "cell_models", "clock_gating", "configuration", "corner_ratios", "endpoints",
    "estimate", "floorplan", "gates", "goals", "ihp130", "liberty", "library", "loads", "namings", "netlist", "part_costs", "power",
    "rival_area", "run", "same_logic", "scene_power", "spef", "sram_kit", "sram_model", "stand_in", "standard_cells", "statistics",
    "technology", "timing", "verilog", "wide_words", "layout/results", "layout/wires",
)  # fmt: skip
CONSTRAINTS = {"constraints/dtof.sdc": ("test_constraints",), "constraints/margins.sdc": ("test_constraints", "test_margins")}
FILES = (*(f"{PACKAGE}/{name}.py" for name in MODULES), *CONSTRAINTS)
BUILT = ("test_simulation",)  # needs the C++ build
LONG = ("test_batch",)  # seconds: it judges its own file alone
TIMEOUT_FACTOR = 5  # of the time without a mutant, and some seconds more; what runs longer hangs
MORE_TIME_S = 10
MEMORY = 4 << 30  # bytes of address space: a loop without end shall not take the machine's
FAILED = re.compile(r"^(?:FAIL|ERROR): (\S+) \((\S+)\)", re.MULTILINE)


def operators(file: str, text: str) -> list[Mutant]:
    return (python_operators if file.endswith(".py") else sdc_operators).mutants(file, text)


def imported(text: str) -> set[str]:
    """Modules of dtof_synth and of its tests that a test imports, by their last name."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and (node.level or (node.module or "").startswith("dtof_synth")):
            found.add((node.module or "").rpartition(".")[2])
            found.update(alias.name for alias in node.names)
    return found


@cache
def imports_of_tests(tree: Path) -> dict[str, set[str]]:
    return {path.stem: imported(path.read_text(encoding="utf-8")) for path in sorted((tree / TESTS).glob("*.py"))}


def tests_of(file: str, tree: Path) -> list[str]:
    """Test modules that import a file, the file's own first."""
    if file in CONSTRAINTS:
        return list(CONSTRAINTS[file])
    stem = Path(file).stem
    own = "test_layout" if "/layout/" in file else f"test_{stem}"
    found = {name for name, names in imports_of_tests(tree).items()
             if stem in names and name.startswith("test_") and name not in (*BUILT, *LONG)}  # fmt: skip
    return sorted(found | ({own} if own in imports_of_tests(tree) else set()), key=lambda name: (name != own, name))


def digest(tree: Path, tests: Iterable[str]) -> str:
    """Digest of what decides a verdict: the flow, the tests, and what they import from other tests."""
    imports = imports_of_tests(tree)
    names = set(tests)
    while more := {name for test in names for name in imports[test] if name in imports} - names:
        names |= more
    flow = [path for name in FLOW for path in [tree / name, *(tree / name).rglob("*")] if path.suffix != ".pyc" and path.is_file()]
    tested = [tree / TESTS / f"{name}.py" for name in names]
    text = hashlib.sha256()
    for path in sorted([*(path for path in flow if tree / TESTS not in path.parents), *tested]):
        text.update(str(path.relative_to(tree)).encode() + b"\0" + path.read_bytes())
    return text.hexdigest()


def killer(output: str) -> str:
    """Name of the test that failed first, or how the tests ended."""
    failed = FAILED.search(output)
    if failed is None:
        return "the tests end early"
    test, where = failed.groups()
    return f"{where.removeprefix('tests.').removesuffix('.' + test)}.{test}"


def run_tests(tests: Iterable[str], tree: Path, timeout_s: float | None) -> str | None:
    """Name of the failed test, or that the tests hang; None if all pass."""
    command = ["prlimit", f"--as={MEMORY}", PYTHON, "-B", "-m", "unittest", "-f", *(f"tests.{name}" for name in tests)]
    with subprocess.Popen(
        command, cwd=tree / "synth", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True
    ) as process:
        try:
            output, _ = process.communicate(timeout=timeout_s)
        except BaseException as error:  # too long, or interrupted
            os.killpg(process.pid, signal.SIGKILL)  # with the tools that it started
            process.communicate()
            if not isinstance(error, subprocess.TimeoutExpired):
                raise
            return "the tests hang"
    return None if process.returncode == 0 else killer(output.decode("utf-8", "replace"))


class Trees:
    """Copies of the flow, one for each job, and the time that each test module takes without a mutant."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.free: queue.Queue[Path] = queue.Queue()
        for number in range(jobs):
            tree = folder / f"tree{number}"
            shutil.rmtree(tree, ignore_errors=True)
            for name in TREE:
                source = ROOT / name
                if source.is_dir():
                    shutil.copytree(source, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
                else:
                    shutil.copy(source, tree / name)
            compileall.compile_dir(str(tree / "synth"), quiet=1)
            self.free.put(tree)
        self.first = folder / "tree0"
        self.seconds: dict[str, float] = {}

    def measure(self, tests: Iterable[str]) -> None:
        """Runs tests without a mutant. MutationError if one fails."""
        for name in tests:
            if name not in self.seconds:
                progress.show(f"synthesis without mutants: {name}")
                started = time.monotonic()
                by = run_tests([name], self.first, None)
                if by is not None:
                    raise MutationError(f"{name} fails without a mutant: {by}")
                self.seconds[name] = time.monotonic() - started

    def judge(self, mutant: Mutant) -> Verdict:
        tests = tests_of(mutant.file, self.first)
        tree = self.free.get()
        target = tree / mutant.file
        original = target.read_text(encoding="utf-8")
        for compiled in (target.parent / "__pycache__").glob(f"{target.stem}.*.pyc"):
            compiled.unlink()
        target.write_text(original[: mutant.begin] + mutant.mutated + original[mutant.end :], encoding="utf-8")
        try:
            by = run_tests(tests, tree, TIMEOUT_FACTOR * sum(self.seconds[name] for name in tests) + MORE_TIME_S) if tests else None
        finally:
            target.write_text(original, encoding="utf-8")
            self.free.put(tree)
        return Verdict(mutant, "survived", "") if by is None else Verdict(mutant, "killed", by)


def select(tree: Path, count: int, seed: int, files: Iterable[str] = FILES) -> Selection:
    """`count` mutants of each file."""
    groups = [(operators(file, (tree / file).read_text(encoding="utf-8")), count) for file in files]
    always = [mutant for folder in (PACKAGE, "constraints") for mutant in remembered.load(tree, folder) if mutant.file in files]
    return Selection(groups, seed, always)


def run(count: int, seed: int, folder: Path, jobs: int, files: Iterable[str] = FILES) -> list[Verdict]:
    """Judges `count` mutants of each file; goes on where an interrupted run ended. Stops if a test fails without a mutant."""
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    trees = Trees(folder, jobs)
    kept = Kept(folder / "verdicts.json")
    mutants = select(trees.first, count, seed, files).mutants
    digests = {file: digest(trees.first, tests_of(file, trees.first)) for file in files}
    verdicts = {mutant: found for mutant in mutants if (found := kept.get(mutant, digests[mutant.file]))}
    open_mutants = [mutant for mutant in mutants if mutant not in verdicts]
    trees.measure(name for file in sorted({mutant.file for mutant in open_mutants}) for name in tests_of(file, trees.first))
    with ThreadPoolExecutor(jobs) as pool:
        for verdict in pool.map(trees.judge, open_mutants):
            verdicts[verdict.mutant] = verdict
            kept.put(verdict, digests[verdict.mutant.file])
            progress.show(f"synthesis' mutants: {len(verdicts)} of {len(mutants)} judged")
    progress.done()
    return [verdicts[mutant] for mutant in mutants]
