#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Proves the properties listed in formal/proofs.toml with Yosys and ABC (docs/reference/formal.md).

Every proof is run for each of its parameter sets, then with each of its planted bugs, which must make it fail, and,
where its harness has a goal, once more to reach that. Writes reports/formal.md unless only some proofs are run.
--quick runs the proofs marked quick, without their long_parameters, each with its first planted bug.
A proof that fails leaves its counterexample in build/formal/<proof>/. A run whose sources and commands are those of an
earlier one is not repeated: its outcome is kept beside it.
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass, field
from pathlib import Path

from dtof_synth import program
from rtl_text import without_comments

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
FORMAL = ROOT / "formal"
BUILD = ROOT / "build" / "formal"
REPORT = ROOT / "reports" / "formal.md"
GATED_FLIP_FLOPS = FORMAL / "gated_clock.v"
# Modules that harnesses instantiate beside the design.
RULES = (
    "arbitrary_value", "axi_stream_rules", "axi_lite_rules", "apb_rules", "ez_pointer_reference", "his_pointer_reference",
    "result_word_rules",
)
ROUND_SECONDS = (1, 2, 5, 10, 20, 30, 60, 90, 120, 180, 240, 300)  # times in the report, rounded up

SEARCH_FRAMES = 180
SIMULATE_SECONDS = 300

# An instance of a module, perhaps by a macro of dtof_array, or something of a package.
USED_NAME = re.compile(r"^\s*(\w+) (?:#\(|u_\w+ \()|(\w+)::|`DTOF_TYPE\((\w+),|^\s*`DTOF_COLUMN\((\w+)\)", re.MULTILINE)
INCLUDED = re.compile(r'^\s*`include "(\w+\.svh)"', re.MULTILINE)

FAILED = re.compile(r"Assert(?:ion)? (\S+)(?: \(.*\))? failed")  # of Yosys 0.23, and of 0.52

YOSYS_SCRIPT = """
read_verilog -formal -sv {defines} -I{hdl}/common -I{formal} -defer {sources}
{parameters}
hierarchy -check -top {harness}
prep -flatten -top {harness}
{arbitrary}
memory_map
{registers}
dffunmap
techmap
opt -full -nodffe -nosdff
{legalize}
opt -fast -nodffe -nosdff
aigmap
check -assert
{initial}write_rtlil model.il
write_aiger -I -B -L -zinit -symbols -map model.aim model.aig
"""
# With a free clock a step of the model is a moment, and clocks are inputs like others.
ONE_CLOCK = {"registers": "chformal -early\nasync2sync", "legalize": "dfflegalize -cell $_DFF_P_ 01"}
FREE_CLOCK = {"registers": "clk2fflogic", "legalize": ""}
# Flip-flops behind a clock gate keep their value in a clock without an edge. All become $ff, as a clock is a step.
GATED_CLOCK = {
    "registers": f"""dffunmap
select -set gated t:$dff t:$adff %u i:clk_i %co1 %d
techmap -map {GATED_FLIP_FLOPS} @gated
opt_clean
{ONE_CLOCK["registers"]}
formalff -clk2ff""",
    "legalize": "",
}
# What a design leaves open: registers before their reset, words of an SRAM before a write, its output after a write.
ANY_START = {"arbitrary": "expose -evert t:arbitrary_bit", "initial": ""}
# Two copies of a design are compared: what the design leaves open is 0 in both, and the assertions inside are left to other proofs.
TWINS = {"arbitrary": "delete t:$assert */u_* %i\ndelete t:arbitrary_bit\nsetundef -undriven -zero", "initial": "setundef -init -zero\n"}
SIMULATE_SCRIPT = """
read_rtlil model.il
sim -q -r counterexample.aiw -map model.aim -vcd counterexample.vcd {clock}
"""


class FormalError(Exception):
    """A fault of a proof itself, not of the design."""


@dataclass(frozen=True)
class Bug:
    """A fault planted in the RTL by replacing a text that occurs exactly once."""

    file: str
    find: str
    replace: str
    title: str
    parameters: dict[str, int] | None = None


@dataclass(frozen=True)
class Proof:
    name: str
    module: str
    harness: str
    title: str
    parameters: list[dict[str, int]]
    bugs: list[Bug]
    long_parameters: list[dict[str, int]] = field(default_factory=list)  # more sets, which --quick leaves out
    assumes: str = ""
    frames: int | None = None  # None: unbounded
    why_bounded: str = ""
    goal: str = ""  # what is reached in a run of its own
    goal_parameters: dict[str, int] | None = None
    quick: bool = False
    gated_clock: bool = False  # the design has a clock gate; a step is a clock all the same (formal/dtof_clock_gate.sv)
    free_clock: bool = False  # a step is a moment instead of a clock, and clocks are inputs like any other
    twins: bool = False  # two copies of a design are compared (TWINS)
    search_frames: int = SEARCH_FRAMES  # for a planted bug or a goal where the proof itself has no bound
    timeout: int = 240  # seconds of processor time a tool may take


@dataclass
class Outcome:
    verdict: str  # proved, failed, unknown
    seconds: float
    frame: int | None = None
    assertion: str = ""


@dataclass(frozen=True)
class Job:
    proof: Proof
    kind: str  # prove, bug, goal
    parameters: dict[str, int]
    bug: Bug | None = None

    def label(self) -> str:
        settings = ", ".join(f"{name} {value}" for name, value in self.parameters.items())
        suffix = {"prove": "", "bug": f" with {self.bug.title if self.bug else ''}", "goal": " goal"}[self.kind]
        return f"{self.proof.name}{suffix}{f' ({settings})' if settings else ''}"

    def folder(self) -> Path:
        settings = "_".join(f"{name.lower()}{value}" for name, value in self.parameters.items()) or "defaults"
        tail = f"bug{self.proof.bugs.index(self.bug)}_{settings}" if self.bug else settings
        return BUILD / self.proof.name / (f"goal_{settings}" if self.kind == "goal" else tail)


@dataclass
class Row:
    """A proof's row in the report."""

    proof: Proof
    seconds: float = 0.0
    caught: dict[str, str] = field(default_factory=dict)  # title of a planted bug: the assertion it breaks
    reached: int | None = None


def load_proofs() -> list[Proof]:
    with (FORMAL / "proofs.toml").open("rb") as file:
        entries = tomllib.load(file)["proof"]
    proofs = []
    for entry in entries:
        bugs = [Bug(**bug) for bug in entry.pop("bug", [])]
        plain = entry["module"].removeprefix("dtof_")
        harness = entry.pop("harness", f"{plain}_properties")
        proof = Proof(
            harness=harness, parameters=entry.pop("parameters", [{}]), name=entry.pop("name", plain),
            bugs=bugs, **entry,
        )
        if not bugs:
            raise FormalError(f"{proof.name}: a proof needs a planted bug that makes it fail")
        if (proof.frames is None) != (proof.why_bounded == ""):
            raise FormalError(f"{proof.name}: a bounded proof says why, any other has no bound")
        proofs.append(proof)
    names = [proof.name for proof in proofs]
    if len(set(names)) != len(names):
        raise FormalError("two proofs have the same name")
    return proofs


def design_files() -> list[Path]:
    """RTL of the file list, with the models of SRAMs and synchronisers for proofs and the rules of the interfaces."""
    lines = (HDL / "dtof.f").read_text().splitlines()
    files = [HDL / line for line in lines if line.endswith(".sv") and not line.startswith(("//", "technology/"))]
    stand_ins = sorted(FORMAL.glob("dtof_*.sv"))
    rules = [FORMAL / f"{name}.sv" for name in RULES]
    return [file for file in files if file.name not in {one.name for one in stand_ins}] + stand_ins + rules


def needed_files(harness: Path) -> list[Path]:
    """The harness and the files of all modules below it; a module's file has its name."""
    design = design_files()
    needed = {harness}
    found = {harness}
    while found:
        texts = [file.read_text() for file in found]
        texts += [(HDL / "common" / name).read_text() for text in texts for name in INCLUDED.findall(text)
                  if (HDL / "common" / name).exists()]
        names = {name for text in texts for match in USED_NAME.findall(text) for name in match}
        found = {file for file in design if file.stem in names} - needed
        needed |= found
    return [file for file in design if file in needed] + [harness]


def with_bug(files: list[Path], bug: Bug, folder: Path) -> list[Path]:
    """The same files, with the bug planted in a copy of one."""
    source = HDL / bug.file
    text = source.read_text()
    if source not in files:
        raise FormalError(f"{bug.file} is no part of the proof")
    if text.count(bug.find) != 1:
        raise FormalError(f"{bug.file} must contain the text to replace exactly once: {bug.find!r}")
    copy = folder / source.name
    copy.write_text(text.replace(bug.find, bug.replace))
    return [copy if file == source else file for file in files]


def run_tool(command: list[str], folder: Path, log: str, cpu_seconds: int) -> tuple[str, float]:
    """Output and processor time of a command. The command is killed after `cpu_seconds`."""
    with (folder / log).open("w") as file:
        process = subprocess.Popen(
            ["prlimit", f"--cpu={cpu_seconds}", *command], cwd=folder, stdout=file, stderr=subprocess.STDOUT
        )
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    seconds = usage.ru_utime + usage.ru_stime
    text = (folder / log).read_text()
    if process.returncode < 0 and seconds > 0.9 * cpu_seconds:
        return "", seconds
    if process.returncode != 0:
        last = [line for line in text.splitlines() if "ERROR" in line] or text.splitlines()[-3:]
        raise FormalError(f"{command[0]} failed in {folder.relative_to(ROOT)}: {' '.join(last)}")
    return text, seconds


def never_asserted(swept: Path) -> bool:
    """Whether each output of a binary AIGER file is constant 0, so that nothing is left to prove."""
    header, *lines = swept.read_bytes().split(b"\n")
    _, _, _, latches, outputs, *_ = header.split()
    literals = lines[int(latches):int(latches) + int(outputs)]
    return bool(literals) and all(literal == b"0" for literal in literals)


def abc(engine: str) -> list[str]:
    return ["yosys-abc", "-c", f"read_aiger model.aig; fold; strash; {engine}; write_cex -a trace.aiw"]


def failing_assertion(proof: Proof, folder: Path) -> str:
    """Replays the counterexample in Yosys, which writes the waveforms and names the assertion."""
    _, *inputs = (folder / "trace.aiw").read_text().replace("# DONE", "").split()
    # All registers are 0 before the first clock, those that ABC has dropped as well.
    registers = int((folder / "model.aig").read_bytes().split(maxsplit=4)[3])
    (folder / "counterexample.aiw").write_text("\n".join(["1", "b0", "0" * registers, *inputs, "."]) + "\n")
    if proof.gated_clock:  # the simulator needs flip-flops with a clock
        model = (folder / "model.il").read_text()
        (folder / "model.il").write_text(re.sub(r"cell \$_FF_ (\S+)\n", r"cell $_DFF_P_ \1\n    connect \\C \\clk_i\n", model))
    script = SIMULATE_SCRIPT.format(clock="-multiclock" if proof.free_clock else "-clock clk_i")
    log, _ = run_tool(["yosys", "-p", script], folder, "simulate.log", SIMULATE_SECONDS)
    if not log:
        raise FormalError(f"the replay of the counterexample in {folder.relative_to(ROOT)} takes more than {SIMULATE_SECONDS} s")
    failed = FAILED.findall(log)
    if not failed:
        raise FormalError(f"the counterexample in {folder.relative_to(ROOT)} does not fail when it is replayed")
    # Registers of clk2fflogic are unknown in the first step of a replay, in which an assertion may fail that is right.
    return failed[-1 if proof.free_clock else 0].split(".", 1)[1]


def registers_of(proof: Proof) -> dict[str, str]:
    if proof.gated_clock:
        return GATED_CLOCK
    return FREE_CLOCK if proof.free_clock else ONE_CLOCK


def solve(job: Job) -> Outcome:
    """The outcome of a run. Reused if an earlier run had the same sources and commands."""
    proof, folder = job.proof, job.folder()
    folder.mkdir(parents=True, exist_ok=True)
    files = needed_files(FORMAL / f"{proof.harness}.sv")
    if job.bug is not None:
        files = with_bug(files, job.bug, folder)
    script = YOSYS_SCRIPT.format(
        defines="-DFIND_GOAL" if job.kind == "goal" else "", hdl=HDL, formal=FORMAL, sources=" ".join(map(str, files)),
        harness=proof.harness, **registers_of(proof), **(TWINS if proof.twins else ANY_START),
        parameters="".join(f"chparam -set {name} {value} {proof.harness}; " for name, value in job.parameters.items()),
    )
    unbounded = job.kind == "prove" and proof.frames is None
    frames = proof.search_frames if proof.frames is None else proof.frames
    # Equal registers and gates are merged first where there should be no counterexample.
    swept = job.kind == "prove"
    engine = f"{'scorr; write_aiger swept.aig; ' if swept else ''}{'pdr' if unbounded else f'bmc3 -F {frames}'}"

    headers = (*HDL.glob("common/*.svh"), *FORMAL.glob("*.svh"), *((GATED_FLIP_FLOPS,) if proof.gated_clock else ()))
    texts = [script, engine, *(" ".join(without_comments(file.read_text()).split()) for file in (*files, *headers))]
    key = hashlib.sha256("\0".join(texts).encode()).hexdigest()
    kept = folder / "outcome.json"
    if kept.exists():
        earlier = json.loads(kept.read_text())
        if earlier.pop("key") == key:
            return Outcome(**earlier)

    (folder / "model.ys").write_text(script)
    _, seconds = run_tool(["yosys", "-q", "-s", "model.ys"], folder, "yosys.log", proof.timeout)
    log, solver_seconds = run_tool(abc(engine), folder, "abc.log", proof.timeout)
    seconds += solver_seconds
    failed = re.search(r"was asserted in frame (\d+)", log)
    if failed:
        if swept:  # its trace lacks inputs
            run_tool(abc(f"bmc3 -F {int(failed[1]) + 1}"), folder, "trace.log", proof.timeout)
        outcome = Outcome("failed", seconds, int(failed[1]), failing_assertion(proof, folder))
    else:
        done = ("Property proved" if unbounded else f"No output asserted in {frames} frames") in log
        # ABC of Yosys 0.52 calls a property undecided of which scorr leaves nothing.
        done = done or (unbounded and "All outputs solved" in log and never_asserted(folder / "swept.aig"))
        outcome = Outcome("proved" if done else "unknown", seconds)
    if outcome.verdict != "unknown":
        kept.write_text(json.dumps({"key": key} | asdict(outcome)))
    return outcome


def judge(job: Job, outcome: Outcome, row: Row) -> str:
    """Notes the outcome in the report. Returns a sentence if it is unexpected."""
    proof = job.proof
    place = job.folder().relative_to(ROOT)
    if job.kind == "prove":
        row.seconds += outcome.seconds
        if outcome.verdict == "failed":
            return (f"FAIL {job.label()}: {outcome.assertion} fails in clock {outcome.frame}, "
                    f"counterexample in {place}/counterexample.vcd")
        decided = outcome.verdict == "proved"
        return "" if decided else f"FAIL {job.label()}: undecided after {proof.timeout} s, see {place}"
    if job.bug is None:
        row.reached = outcome.frame
        reached = outcome.verdict == "failed"
        return "" if reached else f"FAIL {job.label()}: not reached, so the proof may be empty, see {place}"
    if outcome.verdict != "failed":
        return f"FAIL {job.label()}: the planted bug passes, see {place}"
    row.caught[job.bug.title] = outcome.assertion
    return ""


def jobs_of(proof: Proof, quick: bool = False) -> list[Job]:
    sets = proof.parameters if quick else [*proof.parameters, *proof.long_parameters]
    jobs = [Job(proof, "prove", parameters) for parameters in sets]
    for bug in proof.bugs[:1] if quick else proof.bugs:
        jobs.append(Job(proof, "bug", proof.parameters[0] if bug.parameters is None else bug.parameters, bug))
    if proof.goal:
        parameters = proof.parameters[0] if proof.goal_parameters is None else proof.goal_parameters
        jobs.append(Job(proof, "goal", parameters))
    return jobs


def rounded(seconds: float) -> str:
    for limit in ROUND_SECONDS:
        if seconds <= limit:
            return f"{limit} s"
    return f"{round(seconds / 60)} min"


def settings_of(proof: Proof) -> str:
    sets = [" ".join(f"{name} {value}" for name, value in parameters.items()) for parameters in (*proof.parameters, *proof.long_parameters)]
    return "; ".join(entry or "defaults" for entry in sets)


def write_report(rows: list[Row]) -> None:
    lines = [
        "# Proofs",
        "",
        "From `make formal`; how it works, and what a bound leaves open, is in "
        "[docs/reference/formal.md](../docs/reference/formal.md).",
        "Every planted bug was seen to break its proof; the assertion that failed is named beside it.",
        "Times are processor time of all parameter sets together, rounded up.",
        "",
        "| module | property | method | bounded | time | planted bugs and the assertions that they break |",
        "|---|---|---|---|---:|---|",
    ]
    for row in rows:
        proof = row.proof
        method = "`pdr`" if proof.frames is None else "`bmc3`"
        bounded = "no" if proof.frames is None else f"{proof.frames} clocks: {proof.why_bounded}"
        bugs = "; ".join(f"{bug.title}: `{row.caught[bug.title]}`" for bug in proof.bugs)
        lines.append(f"| {proof.module} | {proof.title} | {method} | {bounded} | {rounded(row.seconds)} | {bugs} |")
    lines += [
        "",
        "## Parameters, assumptions, and what was reached",
        "",
        "An assumption is the documented contract of an input.",
        "A reached situation shows that the assumptions allow it.",
        "",
        "| module | parameters | assumed of the inputs | reached |",
        "|---|---|---|---|",
    ]
    for row in rows:
        proof = row.proof
        reached = f"{proof.goal}, in clock {row.reached}" if proof.goal else "-"
        lines.append(f"| {proof.name} | {settings_of(proof)} | {proof.assumes or 'nothing'} | {reached} |")
    REPORT.write_text("\n".join(lines) + "\n")


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("proofs", nargs="*", help="names of proofs; all if none is given")
    parser.add_argument("--quick", action="store_true", help="only those marked quick, with fewer parameter sets and bugs")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="proofs at a time")
    arguments = parser.parse_args()

    proofs = load_proofs()
    unknown = set(arguments.proofs) - {proof.name for proof in proofs}
    if unknown:
        raise FormalError(f"no proof is called {', '.join(sorted(unknown))}")
    chosen = [
        proof for proof in proofs
        if (not arguments.proofs or proof.name in arguments.proofs) and (proof.quick or not arguments.quick)
    ]
    begin = time.monotonic()
    rows = {proof.name: Row(proof) for proof in chosen}
    jobs = [job for proof in chosen for job in jobs_of(proof, arguments.quick)]
    failures = []
    with ThreadPoolExecutor(max_workers=arguments.jobs) as pool:
        pending = {pool.submit(solve, job): job for job in jobs}
        for number, future in enumerate(as_completed(pending), 1):
            job = pending[future]
            try:
                outcome = future.result()
                sentence = judge(job, outcome, rows[job.proof.name])
            except FormalError as error:
                sentence = f"FAIL {job.label()}: {error}"
            if sentence:
                failures.append(sentence)
                print(sentence, file=sys.stderr, flush=True)
            if sys.stdout.isatty():
                print(f"\r{number} of {len(jobs)}", end="", flush=True)
    if sys.stdout.isatty():
        print("\r", end="")
    if failures:
        print(f"formal: {len(failures)} of {len(jobs)} runs failed", file=sys.stderr)
        return 1
    runs, bugs, goals = (sum(job.kind == kind for job in jobs) for kind in ("prove", "bug", "goal"))
    print(f"formal: {len(chosen)} proofs over {runs} parameter sets hold, {bugs} planted bugs break them, "
          f"{goals} goals are reached, {time.monotonic() - begin:.0f} s")
    if len(chosen) == len(proofs) and not arguments.quick:
        write_report(list(rows.values()))
        print(f"wrote {REPORT.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    try:
        program.run(main)
    except FormalError as error:
        print(f"formal: {error}", file=sys.stderr)
        sys.exit(1)
