#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a sweep, what of it has not been computed yet, and merges its table."""

import argparse
import contextlib
import fcntl
import getpass
import hashlib
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

import merge
import plan

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SUBMITTED_AT_ONCE = 100  # by a cluster's profile
PROGRESS = re.compile(r"\d+ of \d+ steps .* done")


@contextlib.contextmanager
def alone(folder: Path) -> Iterator[int]:
    """Locks the folder against a second run. The lock lasts as long as any process with the descriptor."""
    with (folder / ".lock").open("w", encoding="utf-8") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise plan.SweepError(f"{folder}: another run of this sweep is at work here") from None
        yield file.fileno()


def job_name(folder: Path) -> str:
    """The name that all Slurm jobs of this sweep share."""
    return f"sweep-{hashlib.sha256(str(folder).encode()).hexdigest()[:12]}"


def _slurm(*command: str) -> str:
    try:
        result = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise plan.SweepError(f"{command[0]}: {error.strerror}: Slurm's programs are not here") from None
    if result.returncode != 0:
        raise plan.SweepError(f"{command[0]}: {''.join(result.stderr.strip().splitlines()[-1:])}")
    return result.stdout


def cancel_jobs(name: str) -> None:
    """Cancels jobs that a killed workflow left in Slurm; they would repeat the next workflow's work."""
    chosen = f"--name={name}", f"--user={getpass.getuser()}"
    queue = "squeue", "--noheader", "--format=%A", *chosen
    left = _slurm(*queue).split()
    if left:
        print(f"{len(left)} jobs of a killed workflow are cancelled", flush=True)
        _slurm("scancel", *chosen)
    while _slurm(*queue):
        time.sleep(0.5)


def list_batches(sweep: plan.Sweep, folder: Path) -> Path:
    """Writes the results of all batches, one per line, for the Snakefile."""
    path = folder / "batches.txt"
    path.write_text("".join(f"{plan.batch_file(folder, sweep.batch(number))}\n" for number in range(sweep.batches)), encoding="utf-8")
    return path


def snakemake(sweep: Path, folder: Path, batches: Path, arguments: argparse.Namespace) -> list[str]:
    # Snakemake would write a file about the origin of each result; the names of our files say that already.
    command = ["snakemake", "--snakefile", str(HERE / "Snakefile"), "--directory", str(folder), "--config",
               f"sweep={sweep}", f"folder={folder}", f"batches={batches}", "--rerun-triggers", "mtime", "--rerun-incomplete", "--keep-going",
               "--drop-metadata", "--scheduler", "greedy", "--nocolor"]
    if arguments.slurm:
        return [*command, "--profile", str(HERE / "slurm"), "--jobs", str(arguments.jobs or SUBMITTED_AT_ONCE)]
    return [*command, "--cores", str(arguments.jobs or os.cpu_count() or 1)]


def show(lines: Iterable[str]) -> None:
    """Shows the progress in Snakemake's output on a terminal, and its errors; everything is in Snakemake's log."""
    terminal = sys.stderr.isatty()
    shown = False
    for line in lines:
        if PROGRESS.match(line):
            if terminal:
                print(f"\r{line.strip()}", end="", file=sys.stderr, flush=True)
                shown = True
        elif "error" in line.lower():
            print(("\n" if shown else "") + line, end="", file=sys.stderr, flush=True)
            shown = False
    if shown:
        print(file=sys.stderr)


def run(command: list[str], folder: Path, lock: int) -> int:
    """Runs a workflow. A killed workflow leaves Snakemake's lock behind; our own lock shows that nobody else is running."""
    environment = {**os.environ, "SBATCH_JOB_NAME": job_name(folder)}
    try:
        subprocess.run([*command, "--unlock"], check=False, capture_output=True)
        workflow = subprocess.Popen(command, env=environment, pass_fds=[lock], stderr=subprocess.PIPE, text=True)
    except OSError as error:
        raise plan.SweepError(f"snakemake: {error.strerror}: scripts/install_packages.sh sweep installs it") from None
    assert workflow.stderr is not None
    try:
        show(workflow.stderr)
    except KeyboardInterrupt:
        for _ in workflow.stderr:
            pass  # It was interrupted, too, and ends its jobs.
        workflow.wait()
        raise
    return workflow.wait()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sweep", type=Path, help="description (TOML)")
    parser.add_argument("--folder", type=Path, help="for batches and table (default: build/sweep/<name>)")
    parser.add_argument("--slurm", action="store_true", help="as jobs of Slurm, by scripts/sweep/slurm/config.yaml")
    parser.add_argument("--jobs", type=int, help=f"at the same time (default: processors; with --slurm {SUBMITTED_AT_ONCE})")
    arguments = parser.parse_args()
    path = arguments.sweep.resolve()
    logs = "slurm_logs" if arguments.slurm else ".snakemake/log"
    try:
        sweep = plan.load(path, ROOT)
        folder = (arguments.folder or ROOT / "build" / "sweep" / sweep.name).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        with alone(folder) as lock:
            print(f"{sweep.name}: {sweep.points} points in {sweep.batches} batches, {folder}", flush=True)
            if arguments.slurm:
                cancel_jobs(job_name(folder))
            if run(snakemake(path, folder, list_batches(sweep, folder), arguments), folder, lock) != 0:
                raise plan.SweepError(f"sweep {sweep.name}: jobs failed ({folder / logs} has more); what is done is kept, run it "
                                      "again for the rest")
            text = merge.merged(sweep, folder)
            part = folder / ".table.part"
            part.write_text(text, encoding="utf-8")
            part.replace(plan.table_file(folder))
    except plan.SweepError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("error: interrupted; what is done is kept, run it again for the rest", file=sys.stderr)
        return 130
    print(f"{plan.table_file(folder)} written")
    return 0


if __name__ == "__main__":
    sys.exit(main())
