# SPDX-License-Identifier: Apache-2.0
"""Many configurations at a time: one that fails, and results that are kept."""

import tempfile
import time
import unittest
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import batch, configuration
from dtof_synth.configuration import Configuration
from dtof_synth.errors import FlowError
from dtof_synth.run import Technology

from .partial import part_of
from .small_results import ROOT

JOBS = 20


def work(job, _technology, folder: Path, _key: str) -> str:
    """Fails for the first job; leaves a file for each job that began."""
    folder.mkdir(parents=True)
    if job.name == "job0":
        raise FlowError("job0: broken")
    time.sleep(0.2)
    (folder / "done").touch()
    return job.name


def job(number: int) -> batch.Job:
    return part_of(batch.Job, name=f"job{number}", configuration=part_of(Configuration, is_pool=number == 0))


class Batch(unittest.TestCase):
    def run_all(self, first: int) -> tuple[dict | None, int]:
        """(results, or None where a job failed; jobs that had begun a second later)."""
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(batch, "_work", work), \
                mock.patch.object(batch, "_key", lambda *_: "key"), mock.patch.object(batch, "input_digest", lambda _: "digest"):
            results: dict | None
            try:
                results = batch.run_all([job(number) for number in range(first, JOBS)], part_of(Technology), Path(folder), 2, lambda _: None)
            except FlowError:
                results = None
                running = [path.name for path in Path(folder).iterdir() if path.name != "job0" and not (path / "done").exists()]
                self.assertEqual(running, [])  # the jobs that had begun have ended
            time.sleep(1)
            return results, len(list(Path(folder).iterdir()))

    def test_after_a_failure_no_further_job_begins(self) -> None:
        results, begun = self.run_all(0)
        self.assertIsNone(results)
        self.assertLess(begun, 8)

    def test_results_are_in_the_order_of_the_jobs(self) -> None:
        results, begun = self.run_all(12)
        assert results is not None
        self.assertEqual(list(results), [f"job{number}" for number in range(12, JOBS)])
        self.assertEqual(begun, 8)


class Kept(unittest.TestCase):
    """Results that are reused, with runs that only count themselves."""

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        named = configuration.load(ROOT / "configurations.toml")
        self.jobs = [batch.Job(named[name]) for name in ("ezpointer", "hispointer", "poolpointer")]
        self.ran: list[str] = []
        self.said: list[str] = []

    def run_all(self, jobs: list[batch.Job], digest: str = "digest") -> dict:
        """Runs jobs in this process, one after the other, as they are submitted."""
        self.ran.clear()
        self.said.clear()

        def run(configuration_of_job, _technology, folder: Path, *_) -> str:
            self.ran.append(configuration_of_job.name)
            return f"{configuration_of_job.name} in {folder.name}"

        def submit(function, *arguments) -> Future:
            future: Future = Future()
            future.set_result(function(*arguments))
            return future

        for job in jobs:
            (self.folder / job.name).mkdir(exist_ok=True)
        pool = mock.Mock(submit=submit)
        with mock.patch.object(batch, "run", run), mock.patch.object(batch, "input_digest", lambda _: digest), \
                mock.patch.object(batch, "ProcessPoolExecutor", return_value=pool), \
                mock.patch.object(batch, "as_completed", lambda futures: list(futures)):
            return batch.run_all(jobs, part_of(Technology), self.folder, 2, self.said.append)

    def test_arrays_with_engines_start_first_and_each_end_is_shown(self) -> None:
        results = self.run_all(self.jobs)
        self.assertEqual(self.ran, ["poolpointer", "ezpointer", "hispointer"])
        self.assertEqual(results, {name: f"{name} in {name}" for name in ("ezpointer", "hispointer", "poolpointer")})
        self.assertEqual(self.said, ["[1/3] poolpointer", "[2/3] ezpointer", "[3/3] hispointer"])

    def test_a_result_is_kept_until_an_input_changes(self) -> None:
        first = self.run_all(self.jobs[:2])
        self.assertEqual(self.run_all(self.jobs[:2]), first)
        self.assertEqual(self.ran, [])
        self.run_all(self.jobs)
        self.assertEqual((self.ran, self.said), (["poolpointer"], ["[3/3] poolpointer"]))
        self.run_all(self.jobs, "other inputs")
        self.assertEqual(len(self.ran), 3)
        self.run_all([replace(job, most_attempts=1) for job in self.jobs], "other inputs")
        self.assertEqual(len(self.ran), 3)

    def test_a_damaged_result_is_computed_anew(self) -> None:
        self.run_all(self.jobs[:1])
        (self.folder / "ezpointer" / "result.pickle").write_bytes(b"no pickle")
        self.run_all(self.jobs[:1])
        self.assertEqual(self.ran, ["ezpointer"])

    def test_each_input_has_its_key_and_the_order_of_parameters_has_none(self) -> None:
        job = self.jobs[0]
        others = [job, replace(job, corners=("slow",)), replace(job, most_attempts=1), replace(job, naming=1), self.jobs[1]]
        keys = {batch._key(one, digest) for one in others for digest in ("a", "b")}
        self.assertEqual(len(keys), 10)
        one, other = ({"NP": 8, "NB": 4}, {"NB": 4, "NP": 8})
        keys = {batch._key(replace(job, configuration=mock.Mock(rtl_parameters=lambda found=found: found)), "a") for found in (one, other)}
        self.assertEqual(len(keys), 1)


if __name__ == "__main__":
    unittest.main()
