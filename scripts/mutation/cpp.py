# SPDX-License-Identifier: Apache-2.0
"""Mutants of the C++ models: all are compiled into one build of the tests, which then run once for each."""

import os
import re
import resource
import shutil
import subprocess
import tempfile
import time
import zlib
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutation import cpp_operators, progress, remembered
from mutation.mutant import Mutant, Selection
from mutation.schemata import Schemata, with_mutants
from mutation.verdict import MutationError, Verdict

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MODELS = Path("models/dtof")
TREE = ["CMakeLists.txt", "CITATION.cff", "cmake", "models", "tb_cpp", "app", "studies", "tests", "examples", "driver", "hdl", "fpga", "scripts",
        "synth", "configurations.toml", "readouts.toml"]  # what CMake reads
READOUT_SHARE = 0.6
# Other libraries on whose figures the models rest; of io, the readers and what writes results.
OTHERS = [
    "core/detection.*", "core/parallel.cpp", "core/parameters.*", "core/pixel_sampler.hpp", "core/random.*",
    "core/row_region.cpp", "core/select_columns.cpp", "metrics/*", "host/*", "photon/*", "io/csv_fields.cpp",
    "io/depth_image.cpp", "io/input_file.cpp", "io/json_file.cpp", "io/npy.cpp", "io/npy_header.cpp",
    "io/npy_reader.cpp", "io/result_csv.cpp",
    "recording/histogram_stream.*", "recording/photon_times_mat.cpp", "recording/resampling.*",
    "recording/stream_csv.cpp", "recording/tmf8820_json.*", "recording/tmf8829_json.*",
]  # fmt: skip
# The test programs that link a library, its own first.
PROGRAMS = {
    "core": ["core", "readout", "metrics", "host", "io", "recording", "photon", "analytic"],
    "readout": ["readout", "analytic"],
    "metrics": ["metrics", "host", "analytic"],
    "host": ["host"],
    "photon": ["photon", "analytic"],
    "io": ["io", "recording"],
    "recording": ["recording"],
}
LIBRARIES = sorted({program for programs in PROGRAMS.values() for program in programs})
TIMEOUT_FACTOR = 5  # of a program's time without a mutant, and ten seconds more; a mutant that hangs is killed
MEMORY_BYTES = 8 << 30  # a mutant that asks for more is killed


def sources(folder: Path, patterns: Sequence[str]) -> list[Path]:
    return sorted(path for pattern in patterns for path in folder.glob(pattern) if path.suffix in (".cpp", ".hpp"))


def select(tree: Path, count: int, seed: int) -> Selection:
    """The remembered mutants, and `count` others of the sources in `tree`, mostly of the read-out models."""
    groups = []
    readout = round(READOUT_SHARE * count)
    for patterns, share in ((["readout/*"], readout), (OTHERS, count - readout)):
        found: list[Mutant] = []
        for path in sources(tree / MODELS, patterns):
            found += cpp_operators.mutants(str(path.relative_to(tree)), path.read_text())
        groups.append((found, share))
    return Selection(groups, seed, remembered.load(tree, str(MODELS)))


def stable_number(mutant: Mutant) -> int:
    """Number that depends on the mutant alone, so that a compiler cache recognises sources with the same mutants."""
    return zlib.crc32(f"{mutant.file} {mutant.begin} {mutant.mutated}".encode()) & 0x7FFFFFFF


class Build:
    """The project's tests with mutants, in a folder of their own."""

    def __init__(self, folder: Path, jobs: int) -> None:
        self.jobs = jobs
        self.original = folder / "original"  # whatever happens to the project meanwhile
        self.tree = folder / "tree"
        self.binary = folder / "build"
        self.log = folder / "build.log"
        shutil.rmtree(folder, ignore_errors=True)
        for name in TREE:
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(source, self.original / name, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, self.original / name)
        shutil.copytree(self.original, self.tree)
        flags = f"-O1 -include {HERE / 'live_mutant.hpp'} -w -Wno-error -Wno-narrowing"
        command: list[str | Path] = ["cmake", "-S", self.tree, "-B", self.binary, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None", "-DDTOF_PYTHON=OFF",
                                    f"-DCMAKE_CXX_FLAGS={flags}"]  # fmt: skip
        self._run(command, "CMake refuses the copy with mutants")

    def _run(self, command: Sequence[str | Path], failure: str) -> None:
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.log.write_text(result.stdout)
        if result.returncode != 0:
            raise MutationError(f"{failure}: see {self.log}")

    def compile(self, selection: Selection) -> dict[Mutant, int]:
        """Compiles all mutants and replaces those that the compiler rejects; returns their numbers."""
        written: dict[str, str] = {}
        while True:
            numbered = {mutant: stable_number(mutant) for mutant in selection.mutants}
            assert len(set(numbered.values())) == len(numbered)
            schemata = self._schemata(numbered, set(written))
            for file, new in schemata.items():
                if written.get(file) != new.text:
                    (self.tree / file).write_text(new.text)
                    written[file] = new.text
            progress.show(f"compiling {len(numbered)} mutants")
            # The libraries first: what they refuse need not be tried in every test.
            result = self._ninja([f"dtof_{library}" for library in LIBRARIES])
            if result.returncode == 0:
                result = self._ninja([f"{library}_test" for library in LIBRARIES])
            if result.returncode == 0:
                return numbered
            refused = self._refused(result.stdout, schemata)
            if not refused:
                raise MutationError(f"the copy with mutants does not compile: see {self.log}")
            selection.refuse(refused)

    def _ninja(self, targets: Sequence[str]) -> subprocess.CompletedProcess:
        command: list[str | Path] = ["ninja", "-k", "0", "-j", str(self.jobs), "-C", self.binary, *targets]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.log.write_text(result.stdout)
        return result

    def _schemata(self, numbered: Mapping[Mutant, int], more: set[str]) -> dict[str, Schemata]:
        by_file: dict[str, dict[Mutant, int]] = {file: {} for file in more}
        for mutant, number in numbered.items():
            by_file.setdefault(mutant.file, {})[mutant] = number
        return {file: with_mutants((self.original / file).read_text(), own) for file, own in by_file.items()}

    def _refused(self, output: str, schemata: Mapping[str, Schemata]) -> set[Mutant]:
        """The mutants that the compiler's errors name; those in its notes if no error names one."""
        # Sources that are compiled together (unity builds) have whole paths.
        place = re.compile(rf"(?:\.\.|{re.escape(str(self.tree.parent))})/tree/([^:\s]+):(\d+)(?::\d+)?:?( error)?")
        named: dict[bool, set[Mutant]] = {True: set(), False: set()}
        for match in place.finditer(output):
            file, line, error = match.groups()
            if file in schemata:
                named[error is not None] |= schemata[file].mutants_at(int(line))
        return named[True] or named[False]

    def test_program(self, library: str) -> Path:
        return self.binary / "bin" / f"{library}_test"


def _limit_memory() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def killer(build: Build, library: str, number: int, timeout_s: float | None) -> str | None:
    """Test of a program that notices the mutant, or how the program ended; None if all tests pass."""
    with tempfile.TemporaryDirectory() as scratch:
        environment = {**os.environ, "DTOF_LIVE_MUTANT": str(number), "TMPDIR": scratch, "TEST_TMPDIR": scratch}
        try:
            result = subprocess.run(
                [build.test_program(library), "--gtest_brief=1", "--gtest_fail_fast"],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                env=environment,
                cwd=scratch,
                timeout=timeout_s,
                preexec_fn=_limit_memory,
            )
        except subprocess.TimeoutExpired:
            return f"{library}: hangs"
    if result.returncode == 0:
        return None
    failed = re.search(r"^\[  FAILED  \] (\S+?),? ", result.stdout, re.MULTILINE)
    return f"{library}: {failed.group(1)}" if failed else f"{library}: crash"


def unharmed(build: Build, library: str) -> float:
    """Seconds that a program takes without a mutant. MutationError if it fails."""
    started = time.monotonic()
    by = killer(build, library, 0, None)
    if by is not None:
        raise MutationError(f"the tests fail without a mutant: {by}")
    return time.monotonic() - started


def judge(build: Build, mutant: Mutant, number: int, seconds: Mapping[str, float]) -> Verdict:
    """`seconds`: what each program takes without a mutant."""
    for library in PROGRAMS[Path(mutant.file).parent.name]:
        by = killer(build, library, number, TIMEOUT_FACTOR * seconds[library] + 10)
        if by is not None:
            return Verdict(mutant, "killed", by)
    return Verdict(mutant, "survived", "")


def same_object(build: Build, mutant: Mutant) -> bool:
    """True if the compiler produces the same code with and without the mutant, which is then equivalent."""
    if not mutant.file.endswith(".cpp"):
        return False
    text = (build.original / mutant.file).read_text()
    changed = text[: mutant.begin] + mutant.mutated + text[mutant.end :]
    includes = build.original / "models"
    objects = []
    with tempfile.TemporaryDirectory() as scratch:
        for variant in (text, changed):
            source = Path(scratch) / "source.cpp"
            source.write_text(variant)
            command: list[str | Path] = ["g++", "-std=c++20", "-O2", "-w", "-I", includes, "-c", source, "-o", f"{scratch}/object"]
            if subprocess.run(command, stderr=subprocess.DEVNULL).returncode != 0:
                return False
            objects.append(Path(scratch, "object").read_bytes())
    return objects[0] == objects[1]


def run(count: int, seed: int, folder: Path, jobs: int) -> list[Verdict]:
    """Compiles and judges `count` mutants. Stops if the tests fail without a mutant."""
    build = Build(folder.resolve(), jobs)
    selection = select(build.original, count, seed)
    numbered = build.compile(selection)
    with ThreadPoolExecutor(jobs) as pool:
        seconds = dict(zip(LIBRARIES, pool.map(lambda library: unharmed(build, library), LIBRARIES)))
        verdicts = []
        for verdict in pool.map(lambda item: judge(build, item[0], item[1], seconds), numbered.items()):
            verdicts.append(verdict)
            progress.show(f"C++ mutants: {len(verdicts)} of {len(numbered)} judged")
    progress.done()
    return [
        Verdict(verdict.mutant, "proved equivalent", "the same object code")
        if verdict.state == "survived" and same_object(build, verdict.mutant)
        else verdict
        for verdict in verdicts
    ]
