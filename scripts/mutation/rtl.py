# SPDX-License-Identifier: Apache-2.0
"""Mutants of the RTL: each is simulated by Icarus Verilog against the model's results, as `make sim-icarus` does."""

import queue
import re
import shutil
import subprocess
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path

from dtof_synth import simulation
from dtof_synth.configuration import load
from dtof_synth.errors import FlowError
from mutation import equivalence, progress, remembered, rtl_operators
from mutation.mutant import Mutant, Selection
from mutation.verdict import MutationError, Verdict

ROOT = Path(__file__).resolve().parent.parent.parent
PATTERNS = ("common", "thesis", "pool")
BENCHES = "synth/simulation"
# Icarus Verilog 11 waits for more signals than needed.
HARMLESS = "sorry: constant selects in always_* processes are not currently supported (all bits will be included)."
TIMEOUT_FACTOR = 5  # of the time without a mutant, and ten seconds more; what runs longer hangs

# Parameters that no named configuration has, of a read-out's configuration.
MORE_PARAMETERS = {
    "ezpointer": [
        {"NP": 4, "NB": 2, "PIXELS_PER_SRAM": 1, "SRAM_NUM": 1, "SLOTS": 1},
        {"NP": 7, "PIXELS_PER_SRAM": 2, "SRAM_NUM": 2, "SLOTS": 3, "POINTER_STEP": 3, "FRACTION_BITS": 1,
         "POINTER_PORTS": 1},
        {"NP": 8, "PIXELS_PER_SRAM": 1, "SRAM_NUM": 2, "SLOTS": 4, "CONFIDENCE_WIDTH": 8, "FRACTION_BITS": 8},
    ],
    "hispointer": [
        {"NP": 6, "NB": 4, "PIXELS_PER_SRAM": 4, "SRAM_NUM": 2, "SLOTS": 4, "COUNT_WIDTH": 4, "FRACTION_BITS": 4,
         "GUARD": 5},
        {"NP": 5, "NB": 5, "PIXELS_PER_SRAM": 1, "SRAM_NUM": 1, "SLOTS": 1, "COUNT_WIDTH": 1, "GUARD": 0,
         "SIGNALLED_CLEAR": 1},
    ],
    "sifh": [
        {"NP": 5, "NB": 5, "PIXELS_PER_SRAM": 2, "SRAM_NUM": 2, "SLOTS": 3, "COUNT_WIDTH": 3, "WINDOW_CENTRED": 1},
        {"NP": 7, "NB": 4, "PIXELS_PER_SRAM": 1, "SRAM_NUM": 3, "SLOTS": 4, "COUNT_WIDTH": 4, "SIGNALLED_CLEAR": 1},
    ],
    "fifh": [{"NP": 4, "NB": 4, "PIXELS_PER_SRAM": 7, "SRAM_NUM": 4, "SLOTS": 4, "COUNT_WIDTH": 1}],
    "threesteps": [
        {"NP": 4, "NB": 2, "PIXELS_PER_SRAM": 2, "SRAM_NUM": 2, "SLOTS": 1, "COUNT_WIDTH": 2, "SIGNALLED_CLEAR": 1},
        {"NP": 7, "PIXELS_PER_SRAM": 1, "SRAM_NUM": 3, "SLOTS": 3, "COUNT_WIDTH": 6},
    ],
    "pifh": [{"NP": 6, "NB": 3, "PIXELS_PER_SRAM": 3, "SRAM_NUM": 3, "SLOTS": 3, "COUNT_WIDTH": 3}],
    "histogram": [{"NP": 4, "NB": 4, "PIXELS_PER_SRAM": 7, "SRAM_NUM": 3, "SLOTS": 4, "COUNT_WIDTH": 4}],
    "coarsehistogram": [
        {"NP": 8, "PIXELS_PER_SRAM": 9, "SRAM_NUM": 2, "SLOTS": 2, "COUNT_WIDTH": 4},
        {"NP": 8, "PIXELS_PER_SRAM": 3, "SRAM_NUM": 3, "SLOTS": 2, "COUNT_WIDTH": 5, "RAW_HISTOGRAM": 1},
    ],
    "poolpointer": [
        {"PIXELS_PER_SRAM": 11, "SRAM_NUM": 2, "ENGINE_COLUMNS": 2, "SLOTS": 3, "LABELS": 6, "SCORE_BITS": 3,
         "OFFSET_BITS": 0, "POINTER_SHIFT": 2},
        {"PIXELS_PER_SRAM": 3, "SRAM_NUM": 6, "ENGINE_COLUMNS": 4},  # the last engine has fewer columns
        {"NP": 12, "PIXELS_PER_SRAM": 10, "SRAM_NUM": 2, "ENGINE_COLUMNS": 2, "COUNT_WIDTH": 6, "OFFSET_BITS": 4},
    ],
}  # fmt: skip
SMALLEST_GUARD = {"dtof_array": {"GUARD": 0}}  # the default does not fit a short range
# The long frame of `make sim-netlist`, which brings pointers to rest and counters to their ends.
LONG_FRAME = {
    "ezpointer": {"SRAM_NUM": 2, "PIXELS_PER_SRAM": 2},
    "hispointer": {"SRAM_NUM": 2, "PIXELS_PER_SRAM": 2},
    "sifh": {"SRAM_NUM": 2, "PIXELS_PER_SRAM": 2},
    "poolpointer": {"SRAM_NUM": 2, "PIXELS_PER_SRAM": 2, "ENGINE_COLUMNS": 2},
    "poolpointer_lean": {"SRAM_NUM": 2, "PIXELS_PER_SRAM": 2, "ENGINE_COLUMNS": 2},
}
# A frame that ends while poolPointer's pointers have steps that only the dither makes whole.
DITHERED_FRAME = 900
# Quick frames of the pool read-outs, tried first: a group and a pixel, one engine.
FIRST_POOL = {"poolpointer": 5, "poolpointer_lean": 9}


def cases(seed: int) -> list[simulation.Case]:
    named = load(ROOT / "configurations.toml")
    found = []
    for name, pixels in FIRST_POOL.items():
        small = named[name].with_parameters(name, PIXELS_PER_SRAM=pixels, SRAM_NUM=2, ENGINE_COLUMNS=2)
        found.append(simulation.Case(small, (60, 2), seed, part="two columns"))
    found += [simulation.rtl_case(configuration, seed) for configuration in named.values()]
    for name, variants in MORE_PARAMETERS.items():
        for number, parameters in enumerate(variants, 1):
            other = named[name].with_parameters(name, **{**SMALLEST_GUARD.get(named[name].top, {}), **parameters})
            found.append(simulation.Case(other, (60, 0, 1, 2, 90), seed, part=f"other parameters {number}"))
    dithered = named["poolpointer"].with_parameters("poolpointer", SRAM_NUM=2, PIXELS_PER_SRAM=3, ENGINE_COLUMNS=2)
    found.append(simulation.Case(dithered, (DITHERED_FRAME,), seed, part="dithered steps"))
    for name, size in LONG_FRAME.items():
        long = named[name].with_parameters(name, **size)
        found.append(simulation.Case(long, (simulation.LONG_FRAME,), seed, part="long frame"))
    return found


@dataclass(frozen=True)
class Bench:
    """A case with written vectors; its run time and its modules without a mutant."""

    case: simulation.Case
    vectors: Path  # the folder where it runs
    command: tuple[str, ...]  # iverilog, in a copy of the sources
    compiled: str = ""  # canonical
    parameters: Mapping[str, frozenset[equivalence.Parameters]] = field(default_factory=dict)  # of each module
    seconds: float = 0.0


class Invalid(Exception):
    """The mutant does not compile."""


def copy_sources(tree: Path) -> None:
    for name in ("hdl", BENCHES):
        shutil.copytree(ROOT / name, tree / name)


def prepare(case: simulation.Case, tree: Path, folder: Path) -> Bench:
    """Writes a case's vectors and runs it without a mutant. MutationError if it fails."""
    folder.mkdir(parents=True)
    simulation.write_vectors(case, ROOT, folder)
    bench = f"{case.configuration.top}_bench"
    overrides = [f"-P{bench}.{name}={value}" for name, value in simulation.bench_parameters(case, folder).items()]
    files = [str(path.relative_to(tree)) for path in simulation.bench_files(case, tree)]
    return measured(Bench(case, folder, ("iverilog", "-g2012", "-Ihdl/common", "-s", bench, *overrides, *files)), tree)


def measured(bench: Bench, tree: Path) -> Bench:
    """Runs a bench without a mutant; notes its run time and modules. MutationError if it fails."""
    compiled = compile_bench(bench, tree)
    started = time.monotonic()
    by = simulate(bench, tree, None)
    if by is not None:
        raise MutationError(f"{bench.case.title} fails without a mutant: {by}")
    seconds = time.monotonic() - started
    return replace(bench, compiled=canonical(compiled), parameters=equivalence.instances(compiled), seconds=seconds)


def compile_bench(bench: Bench, tree: Path) -> str:
    """Compiles a bench in `tree`; returns the program for vvp."""
    output = tree / "bench.vvp"
    said = subprocess.run([*bench.command, "-o", "bench.vvp"], cwd=tree, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)  # fmt: skip
    warnings = [line for line in said.stdout.splitlines() if not line.endswith(HARMLESS)]
    if said.returncode != 0 or warnings:
        raise Invalid(said.stdout)
    return output.read_text()


def canonical(compiled: str) -> str:
    """The program with its labels numbered in order: Icarus makes them from addresses, which differ between runs."""
    numbers: dict[str, str] = {}
    return re.sub(r"0x[0-9a-f]+", lambda match: numbers.setdefault(match.group(), f"0x{len(numbers):x}"), compiled)


def simulate(bench: Bench, tree: Path, timeout_s: float | None) -> str | None:
    """Runs the program compiled last. Returns the report of the bench or of an assertion, or that it hangs; None if it passes."""
    try:
        ran = subprocess.run(["vvp", "-n", tree / "bench.vvp"], cwd=bench.vectors, text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, errors="replace", timeout=timeout_s)  # fmt: skip
        simulation.outcome(ran.stdout, bench.case, 0.0)
    except subprocess.TimeoutExpired:
        return f"{bench.case.title}: hangs"
    except FlowError as error:
        return str(error)
    return None


def module_of(file: str) -> str:
    return Path(file).stem


def judge(mutant: Mutant, original: str, benches: list[Bench], tree: Path) -> Verdict:
    """Runs the benches that contain the mutant's module, the cheapest first. Invalid if one does not compile."""
    target = tree / mutant.file
    target.write_text(original[: mutant.begin] + mutant.mutated + original[mutant.end :])
    try:
        reached = False
        for bench in benches:
            if module_of(mutant.file) not in bench.parameters:
                continue
            compiled = compile_bench(bench, tree)
            if canonical(compiled) == bench.compiled:
                continue
            reached = True
            by = simulate(bench, tree, TIMEOUT_FACTOR * bench.seconds + 10)
            if by is not None:
                return Verdict(mutant, "killed", by)
    finally:
        target.write_text(original)
    if not reached:
        return Verdict(mutant, "proved equivalent", "the same compiled circuit in every configuration")
    return Verdict(mutant, "survived", "")


def proved(mutant: Mutant, original: str, benches: list[Bench], tree: Path) -> bool:
    """True if the mutant is equivalent with the parameters of every instance of its module."""
    module = module_of(mutant.file)
    files = [name for bench in benches if module in bench.parameters for name in bench.command if name[:4] == "hdl/"]
    mutated = original[: mutant.begin] + mutant.mutated + original[mutant.end :]
    instances = {one for bench in benches for one in bench.parameters.get(module, ())}
    return all(equivalence.proved(tree, list(dict.fromkeys(files)), mutant.file, mutated, one) for one in instances)


def select(tree: Path, count: int, seed: int) -> Selection:
    found: list[Mutant] = []
    for pattern in PATTERNS:
        for path in sorted((tree / "hdl" / pattern).glob("*.sv")):
            found += rtl_operators.mutants(str(path.relative_to(tree)), path.read_text())
    return Selection([(found, count)], seed, remembered.load(tree, "hdl"))


def run(count: int, seed: int, folder: Path, jobs: int) -> list[Verdict]:
    """Judges `count` mutants. Stops if a bench fails without a mutant."""
    folder = folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    trees: queue.Queue[Path] = queue.Queue()
    for number in range(jobs):
        copy_sources(folder / f"tree{number}")
        trees.put(folder / f"tree{number}")

    def in_tree(work, *arguments):
        tree = trees.get()
        try:
            return work(tree, *arguments)
        finally:
            trees.put(tree)

    def prepared(tree: Path, number: int, case: simulation.Case) -> Bench:
        return prepare(case, tree, folder / "vectors" / str(number))

    first = folder / "tree0"
    originals = {str(path.relative_to(first)): path.read_text() for path in first.glob("hdl/*/*.sv")}
    selection = select(first, count, seed)
    verdicts: dict[Mutant, Verdict] = {}
    with ThreadPoolExecutor(jobs) as pool:
        progress.show("RTL without mutants")
        planned = cases(seed)
        benches = list(pool.map(lambda item: in_tree(prepared, *item), enumerate(planned)))
        benches.sort(key=lambda bench: bench.seconds)

        def judged(tree: Path, mutant: Mutant) -> Verdict | None:
            try:
                verdict = judge(mutant, originals[mutant.file], benches, tree)
            except Invalid:
                return None
            if verdict.state == "survived" and proved(mutant, originals[mutant.file], benches, tree):
                return Verdict(mutant, "proved equivalent", "Yosys and ABC: no input tells it from the original")
            return verdict

        while open_mutants := [mutant for mutant in selection.mutants if mutant not in verdicts]:
            refused: set[Mutant] = set()
            for mutant, verdict in zip(open_mutants, pool.map(lambda item: in_tree(judged, item), open_mutants)):
                if verdict is None:
                    refused.add(mutant)
                else:
                    verdicts[mutant] = verdict
                progress.show(f"RTL mutants: {len(verdicts)} of {len(selection.mutants)} judged")
            selection.refuse(refused)
    progress.done()
    return [verdicts[mutant] for mutant in selection.mutants]
