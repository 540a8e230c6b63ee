#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What a sweep costs: build/sweep_cost/scaling.md.

Points that only copy a small table measure what a point, a job and the merged table cost beside the points' own computing; two
further sweeps tell how well this predicts. A few points of scripts/sweep/readouts.toml tell what real ones take.
"""

import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import merge
import plan
import run_batch
from single_node_slurm import SingleNodeSlurm

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FOLDER = ROOT / "build" / "sweep_cost"
REPETITIONS = 3
POINTS = (1_000, 10_000, 100_000, 1_000_000)
BATCH = 1_000
REAL = HERE / "readouts.toml"
CHECKS = ((400, 20), (1_000, 1_000))  # points, jobs
EVERY = 13  # of REAL's points one in so many is timed: all read-outs, scenes and lights are among them


def description(points: int, batch: int) -> Path:
    path = FOLDER / f"copies_{points}_{batch}.toml"
    text = (f'name = "copies"\ncommand = "/bin/cp build/sweep_cost/one.csv {{out}}/t.csv"\ntable = "t.csv"\n'
            f'inputs = ["LICENSE"]\nbatch = {batch}\nseed_of = ["x"]\n[axes]\nx = {list(range(points))}\n')
    path.write_text(text, encoding="utf-8")
    return path


def seconds(work) -> float:
    start = time.monotonic()
    work()
    return time.monotonic() - start


def whole(points: int, batch: int, slurm: SingleNodeSlurm | None = None) -> float:
    """Seconds of a sweep with this number of copies, one job at a time or through Slurm, without its start."""
    path = description(points, batch)
    folder = FOLDER / path.stem
    shutil.rmtree(folder, ignore_errors=True)
    command = [sys.executable, str(HERE / "sweep.py"), str(path), "--folder", str(folder),
               *(["--slurm"] if slurm else ["--jobs", "1"])]
    environment = slurm.environment if slurm else None
    first = seconds(lambda: subprocess.run(command, env=environment, check=True, capture_output=True))
    again = seconds(lambda: subprocess.run(command, env=environment, check=True, capture_output=True))
    return first - again


def slurm_job() -> tuple[int, float]:
    """(jobs, seconds per job) of a Slurm with one processor, whose jobs run one after the other."""
    jobs = 40
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, SingleNodeSlurm(Path(folder), 1) as slurm:
        return jobs, whole(jobs, 1, slurm) / jobs


@dataclass(frozen=True)
class Large:
    """A sweep whose batches are written without computing."""

    points: int
    plan_s: float
    merge_s: float
    table_mb: float
    batches_mb: float
    start_s: float  # of sweep.py when nothing is left to do, merging included


def large(points: int, batch_size: int) -> Large:
    path = description(points, batch_size)
    folder = FOLDER / path.stem
    shutil.rmtree(folder, ignore_errors=True)
    sweep = plan.load(path, ROOT)
    header, row = ["read-out", "rmse mm", "above 3 %"], ["hisPointer", "442", "15.31 %"]

    def walk() -> None:
        for number in range(sweep.batches):
            sweep.batch(number)

    plan_s = seconds(walk)
    for number in range(sweep.batches):
        batch = sweep.batch(number)
        run_batch.write(plan.batch_file(folder, batch), batch, header,
                        [{"coordinates": point.coordinates, "seed": point.seed, "rows": [row]} for point in batch.points])
    table = ""

    def merged() -> None:
        nonlocal table
        table = merge.merged(sweep, folder)

    merge_s = seconds(merged)
    used = sum(file.stat().st_size for file in folder.glob("batches/*/*.json"))
    command = [sys.executable, str(HERE / "sweep.py"), str(path), "--folder", str(folder), "--jobs", "1"]
    start_s = seconds(lambda: subprocess.run(command, check=True, capture_output=True))
    return Large(points, plan_s, merge_s, len(table.encode()) / 1e6, used / 1e6, start_s)


def real_point() -> tuple[int, float]:
    """(points, seconds per point) of REAL on one processor."""
    sweep = plan.load(REAL, ROOT)
    numbers = range(0, sweep.points, EVERY)
    return len(numbers), seconds(lambda: [run_batch.compute(sweep, sweep.point(i)) for i in numbers]) / len(numbers)


def solve(one: tuple[int, int, float], other: tuple[int, int, float]) -> tuple[float, float]:
    """Seconds per point and per job from two sweeps (points, jobs, seconds)."""
    determinant = one[0] * other[1] - other[0] * one[1]
    return ((one[2] * other[1] - other[2] * one[1]) / determinant, (one[0] * other[2] - other[0] * one[2]) / determinant)


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "one.csv").write_text("read-out,rmse mm,above 3 %\nhisPointer,442,15.31 %\n", encoding="utf-8")
    many, few = (200, 40), (200, 4)  # points, jobs
    times = {(points, jobs): sorted(whole(points, points // jobs) for _ in range(REPETITIONS))[REPETITIONS // 2]
             for points, jobs in (many, few)}
    point_s, job_s = solve((*many, times[many]), (*few, times[few]))
    checks = [f"{points} points in {jobs} jobs should take {points * point_s + jobs * job_s:.1f} s by this, and took "
              f"{whole(points, points // jobs):.1f} s" for points, jobs in CHECKS]
    slurm_jobs, slurm_s = slurm_job()
    real_points, real_s = real_point()
    rows = [f"| {size.points:,} | {size.points // BATCH:,} | {size.plan_s:.2f} | {size.merge_s:.2f} | {size.start_s:.1f} | "
            f"{size.table_mb:.2f} | {size.batches_mb:.2f} |" for size in (large(points, BATCH) for points in POINTS)]
    hours = [f"| {points:,} | {points * real_s / 3600:.1f} | {points * point_s / 3600:.3f} | {points * job_s / 3600:.2f} | "
             f"{points // BATCH * job_s / 3600:.4f} | {points * slurm_s / 3600:.1f} | {points // BATCH * slurm_s / 3600:.3f} |"
             for points in POINTS]
    text = f"""# Sweeps: what many points cost

On this machine, one job at a time.

## Measured

Beside their own computing, from sweeps of points that copy a table of one row: {many[0]} points in {many[1]} and in {few[1]} jobs
took {times[many]:.1f} s and {times[few]:.1f} s (medians of {REPETITIONS}), thus a point {1000 * point_s:.0f} ms (a process, a folder, its row)
and a job {1000 * job_s:.0f} ms (Snakemake's step, an interpreter, a file).
{"; ".join(checks)}.

Through Slurm on one node with one processor, {slurm_jobs} jobs of one point took {slurm_s:.1f} s each: each of them starts
Snakemake once more, and the scheduler looks for work once per second.

A point of `{REAL.relative_to(ROOT)}` takes {real_s:.2f} s of one processor, in the mean of {real_points}.

Batches of {BATCH:,} points that are all done. Plan: all batches' names. Merge: reading, checking and writing everything. Start:
`sweep.py` when nothing is left to do, merging included.

| points | jobs | plan, s | merge, s | start, s | table, MB | batches, MB |
|---:|---:|---:|---:|---:|---:|---:|
{chr(10).join(rows)}

## Extrapolated

Processor hours: what the points of `{REAL.relative_to(ROOT)}` compute, and what is added by points and jobs, from the
figures above.

| points | computing | points | jobs of one point | jobs of {BATCH:,} | the same, Slurm: of one point | of {BATCH:,} |
|---:|---:|---:|---:|---:|---:|---:|
{chr(10).join(hours)}

Command: `make sweep-cost`
"""
    (FOLDER / "scaling.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
