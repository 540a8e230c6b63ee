# SPDX-License-Identifier: Apache-2.0
"""batch.run_all in this process, with runs that only count themselves, for tests."""

from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from unittest import mock

from dtof_synth import batch
from dtof_synth.run import Result
from dtof_synth.technology import Technology

from .small_results import result


def run_all(jobs: list[batch.Job], technology: Technology, folder: Path, say: Callable[[str], None]) -> tuple[dict[str, Result], list[str]]:
    """(results; configurations that ran). Jobs run one after the other, as they are submitted."""
    ran: list[str] = []

    def run(configuration, _technology, _folder: Path, *_) -> Result:
        ran.append(configuration.name)
        return result("ezpointer", logic_um2=500.0 + len(ran))

    def submit(function, *arguments) -> Future:
        future: Future = Future()
        future.set_result(function(*arguments))
        return future

    for job in jobs:
        (folder / job.name).mkdir(parents=True, exist_ok=True)
    with mock.patch.object(batch, "run", run), mock.patch.object(batch, "ProcessPoolExecutor", return_value=mock.Mock(submit=submit)), \
            mock.patch.object(batch, "as_completed", list):
        return batch.run_all(jobs, technology, folder, 2, say), ran
