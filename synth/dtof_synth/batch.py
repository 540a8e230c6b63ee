# SPDX-License-Identifier: Apache-2.0
"""Runs many configurations on all cores. A result is reused until one of its own inputs changes (run_inputs.py), so all configurations are
elaborated first."""

from __future__ import annotations

import gc
import hashlib
import json
import pickle
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path

from . import run_inputs
from .configuration import Configuration
from .run import BOTH_CORNERS, Result, run
from .technology import Technology


NETLISTS = "netlists"  # folder of elaborated netlists


@dataclass(frozen=True)
class Job:
    """A configuration to run. With `most_attempts` 1 the first mapping counts, even if timing fails. `naming`: see mapping.map_to_cells."""

    configuration: Configuration
    corners: tuple[str, ...] = BOTH_CORNERS
    most_attempts: int | None = None  # all
    naming: int = 0

    @property
    def name(self) -> str:
        return self.configuration.name + (f"_naming{self.naming}" if self.naming else "")


def _key(job: Job, digest: str) -> str:
    """`digest`: of run_inputs."""
    return hashlib.sha256(json.dumps([job.corners, job.most_attempts, job.naming, digest]).encode()).hexdigest()


def _keys(jobs: list[Job], technology: Technology, folder: Path, pool: ProcessPoolExecutor) -> dict[str, str]:
    """Keys by the jobs' names. `folder`: of elaborated netlists, one for the jobs of one configuration."""
    inputs = run_inputs.shared(technology)
    items = {job.configuration.name: job.configuration for job in jobs}
    netlists = {name: pool.submit(run_inputs.netlist, item, technology, folder / name) for name, item in items.items()}
    return {job.name: _key(job, inputs.of(job.configuration, netlists[job.configuration.name].result())) for job in jobs}


def _work(job: Job, technology: Technology, folder: Path, key: str) -> Result:
    result = run(job.configuration, technology, folder, job.corners, job.most_attempts, job.naming)
    (folder / "result.pickle").write_bytes(pickle.dumps((key, result)))
    return result


def _kept(folder: Path, key: str, configuration: Configuration) -> Result | None:
    """The kept result, with the configuration of now: its title, for example, is no input of a run."""
    try:
        kept_key, result = pickle.loads((folder / "result.pickle").read_bytes())
    except (OSError, pickle.UnpicklingError, EOFError, AttributeError, TypeError, ValueError):
        return None
    return replace(result, configuration=configuration) if kept_key == key else None


def run_all(jobs: Iterable[Job], technology: Technology, build: Path, workers: int,
            progress: Callable[[str], None]) -> dict[str, Result]:
    """Results by the jobs' names, in the order of the jobs. The longest jobs (with engines) start first. The first failure stops all."""
    jobs = list(jobs)
    results: dict[str, Result] = {}
    waiting = []
    # A run builds large trees without cycles, which the collector would walk again and again.
    pool = ProcessPoolExecutor(workers, initializer=gc.disable)
    try:
        keys = _keys(jobs, technology, build / NETLISTS, pool)
        for job in jobs:
            kept = _kept(build / job.name, keys[job.name], job.configuration)
            if kept is not None:
                results[job.name] = kept
            else:
                waiting.append(job)
        waiting.sort(key=lambda job: not job.configuration.is_pool)
        done = len(results)
        futures = {pool.submit(_work, job, technology, build / job.name, keys[job.name]): job for job in waiting}
        for future in as_completed(futures):
            name = futures[future].name
            results[name] = future.result()
            done += 1
            progress(f"[{done}/{len(jobs)}] {name}")
    finally:
        pool.shutdown(wait=True, cancel_futures=True)  # after a failure no further run begins
    return {job.name: results[job.name] for job in jobs}
