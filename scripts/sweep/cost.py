#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What a sweep costs beside its points' own computing: build/sweep_cost/scaling.md.

Points that only copy a small table measure what a point, a batch and the merged table cost; the figures of larger sweeps
follow from these, and one of them is measured, too.
"""

import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import merge  # noqa: E402
import plan  # noqa: E402
import run_batch  # noqa: E402
from single_node_slurm import SingleNodeSlurm  # noqa: E402

ROOT = HERE.parent.parent
FOLDER = ROOT / "build" / "sweep_cost"
REPETITIONS = 3
POINTS = (1_000, 10_000, 100_000, 1_000_000)
BATCH = 1_000


def description(points: int, batch: int) -> Path:
    path = FOLDER / f"copies_{points}_{batch}.toml"
    path.write_text(f'name = "copies"\ncommand = "/bin/cp build/sweep_cost/one.csv {{out}}/t.csv"\ntable = "t.csv"\n'
                    f'inputs = ["LICENSE"]\nbatch = {batch}\nseed_of = ["x"]\n[axes]\nx = {list(range(points))}\n', encoding="utf-8")
    return path


def seconds(work) -> float:
    start = time.monotonic()
    work()
    return time.monotonic() - start


def whole(points: int, batch: int, slurm: SingleNodeSlurm | None = None) -> float:
    """A sweep of so many copies, one job at a time or through Slurm, its start apart."""
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
    """(jobs, seconds of each) of a Slurm with one processor, whose jobs run one after the other."""
    jobs = 40
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, SingleNodeSlurm(Path(folder), 1) as slurm:
        return jobs, whole(jobs, 1, slurm) / jobs


@dataclass(frozen=True)
class Large:
    """A sweep whose batches were written without computing anything."""

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
    check = (400, 20)
    expected, measured = check[0] * point_s + check[1] * job_s, whole(check[0], check[0] // check[1])
    slurm_jobs, slurm_s = slurm_job()
    sizes = [large(points, BATCH) for points in POINTS[:3]]
    largest = sizes[-1]
    scaled = [(points, next((s for s in sizes if s.points == points), None)) for points in POINTS]
    rows = []
    for points, size in scaled:
        factor = points / largest.points
        plan_s, merge_s, table, used, start = ((size.plan_s, size.merge_s, size.table_mb, size.batches_mb, size.start_s) if size
                                               else (v * factor for v in (largest.plan_s, largest.merge_s, largest.table_mb,
                                                                          largest.batches_mb, largest.start_s)))
        rows.append(f"| {points:,} | {points // BATCH:,} | {'measured' if size else 'extrapolated'} | {plan_s:.2f} | "
                    f"{merge_s:.2f} | {start:.1f} | {table:.2f} | {used:.2f} | {points * point_s / 60:.1f} | "
                    f"{points // BATCH * job_s / 60:.1f} |")
    single = [f"| {points:,} | {points * job_s / 3600:.1f} | {points // BATCH * job_s / 3600:.3f} | "
              f"{points * slurm_s / 3600:.1f} | {points // BATCH * slurm_s / 3600:.3f} |" for points in POINTS]
    text = f"""# Sweeps: what many points cost

Beside their own computing, on this machine with one job at a time. From sweeps of points that copy a table of one row,
{many[0]} points in {many[1]} and in {few[1]} jobs ({times[many]:.1f} s and {times[few]:.1f} s, medians of {REPETITIONS}): a point costs
{1000 * point_s:.0f} ms (a process, a folder, its row) and a job {1000 * job_s:.0f} ms (Snakemake's step, an interpreter, a
file). By these, {check[0]} points in {check[1]} jobs take {expected:.1f} s; they took {measured:.1f} s.

Through Slurm on one node with one processor, {slurm_jobs} jobs of one point took {slurm_s:.1f} s each: each of them starts
Snakemake once more, and the scheduler looks for work once per second.

Batches of {BATCH:,} points. Plan: all batches' names. Merge: reading, checking and writing everything. Start: `sweep.py` when
nothing is left to do, merging included. Points and jobs: minutes of one processor by the two figures above.

| points | jobs | | plan, s | merge, s | start, s | table, MB | batches, MB | points, min | jobs, min |
|---:|---:|---|---:|---:|---:|---:|---:|---:|---:|
{chr(10).join(rows)}

Why batches: processor hours that the jobs alone take.

| points | one point per job | {BATCH:,} points per job | one point per job, Slurm | {BATCH:,} points per job, Slurm |
|---:|---:|---:|---:|---:|
{chr(10).join(single)}

Command: `make sweep-cost`
"""
    (FOLDER / "scaling.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
