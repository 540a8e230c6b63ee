# SPDX-License-Identifier: Apache-2.0
"""Runs many configurations on all cores; results are reused until an input changes."""

from __future__ import annotations

import gc
import hashlib
import json
import pickle
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from .configuration import Configuration
from .run import BOTH_CORNERS, Result, Technology, input_digest, run


@dataclass(frozen=True)
class Job:
    """A configuration to run. With `most_attempts` 1 the first mapping counts, even if timing fails. `naming`: see run.map_to_cells."""

    configuration: Configuration
    corners: tuple[str, ...] = BOTH_CORNERS
    most_attempts: int | None = None  # all
    naming: int = 0

    @property
    def name(self) -> str:
        return self.configuration.name + (f"_naming{self.naming}" if self.naming else "")


def _key(job: Job, digest: str) -> str:
    text = json.dumps([job.configuration.rtl_parameters(), job.corners, job.most_attempts, job.naming, digest], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _work(job: Job, technology: Technology, folder: Path, key: str) -> Result:
    result = run(job.configuration, technology, folder, job.corners, job.most_attempts, job.naming)
    (folder / "result.pickle").write_bytes(pickle.dumps((key, result)))
    return result


def _kept(folder: Path, key: str) -> Result | None:
    try:
        kept_key, result = pickle.loads((folder / "result.pickle").read_bytes())
    except (OSError, pickle.UnpicklingError, EOFError, AttributeError, TypeError, ValueError):
        return None
    return result if kept_key == key else None


def run_all(jobs: Iterable[Job], technology: Technology, build: Path, workers: int,
            progress: Callable[[str], None]) -> dict[str, Result]:
    """Results by the jobs' names, in the order of the jobs. The longest jobs (with engines) start first. The first failure stops all."""
    digest = input_digest(technology)
    jobs = list(jobs)
    results: dict[str, Result] = {}
    waiting = []
    for job in jobs:
        kept = _kept(build / job.name, _key(job, digest))
        if kept is not None:
            results[job.name] = kept
        else:
            waiting.append(job)
    waiting.sort(key=lambda job: not job.configuration.is_pool)
    done = len(results)
    # A run builds large trees without cycles, which the collector would walk again and again.
    pool = ProcessPoolExecutor(workers, initializer=gc.disable)
    try:
        futures = {pool.submit(_work, job, technology, build / job.name, _key(job, digest)): job for job in waiting}
        for future in as_completed(futures):
            name = futures[future].name
            results[name] = future.result()
            done += 1
            progress(f"[{done}/{len(jobs)}] {name}")
    finally:
        pool.shutdown(wait=True, cancel_futures=True)  # after a failure no further run begins
    return {job.name: results[job.name] for job in jobs}
