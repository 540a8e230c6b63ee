# SPDX-License-Identifier: Apache-2.0
"""Many configurations at a time: one that fails, and results that are kept."""

import tempfile
import time
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import batch, configuration, run_inputs
from dtof_synth.configuration import Configuration
from dtof_synth.errors import FlowError
from dtof_synth.technology import Technology

from . import counted_runs
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
                mock.patch.object(batch, "_keys", lambda jobs, *_: {job.name: "key" for job in jobs}):
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
        """Runs jobs whose inputs have this digest, and another one for each configuration."""
        self.said.clear()
        shared = part_of(run_inputs.Inputs, of=lambda item, netlist: f"{digest} {item['NP']} {netlist}")
        with mock.patch.object(run_inputs, "shared", lambda _: shared), \
                mock.patch.object(run_inputs, "netlist", lambda item, _, folder: f"{item.name} in {folder.name}"):
            results, self.ran = counted_runs.run_all(jobs, part_of(Technology), self.folder, self.said.append)
        return results

    def test_arrays_with_engines_start_first_and_each_end_is_shown(self) -> None:
        results = self.run_all(self.jobs)
        self.assertEqual(self.ran, ["poolpointer", "ezpointer", "hispointer"])
        self.assertEqual({name: one.column.area for name, one in results.items()}, {"ezpointer": 502.0, "hispointer": 503.0, "poolpointer": 501.0})
        self.assertEqual(list(results), ["ezpointer", "hispointer", "poolpointer"])
        self.assertEqual(self.said, ["[1/3] poolpointer", "[2/3] ezpointer", "[3/3] hispointer"])

    def test_a_result_is_kept_until_an_input_changes(self) -> None:
        first = self.run_all(self.jobs[:2])
        self.assertEqual(self.figures(self.run_all(self.jobs[:2])), self.figures(first))
        self.assertEqual(self.ran, [])
        self.run_all(self.jobs)
        self.assertEqual((self.ran, self.said), (["poolpointer"], ["[3/3] poolpointer"]))
        self.run_all(self.jobs, "other inputs")
        self.assertEqual(len(self.ran), 3)
        self.run_all([replace(job, most_attempts=1) for job in self.jobs], "other inputs")
        self.assertEqual(len(self.ran), 3)

    @staticmethod
    def figures(results: dict) -> dict:
        return {name: one.column.area for name, one in results.items()}

    def test_a_kept_result_has_the_configuration_of_now(self) -> None:
        self.run_all(self.jobs[:1])
        now = replace(self.jobs[0].configuration, title="another title")
        found = self.run_all([replace(self.jobs[0], configuration=now)])
        self.assertEqual((self.ran, found["ezpointer"].configuration.title), ([], "another title"))

    def test_a_damaged_result_is_computed_anew(self) -> None:
        self.run_all(self.jobs[:1])
        (self.folder / "ezpointer" / "result.pickle").write_bytes(b"no pickle")
        self.run_all(self.jobs[:1])
        self.assertEqual(self.ran, ["ezpointer"])

    def test_a_netlist_of_each_configuration_serves_all_its_namings(self) -> None:
        jobs = [replace(job, naming=naming) for job in self.jobs[:2] for naming in (0, 1)]
        with mock.patch.object(run_inputs, "shared", lambda _: part_of(run_inputs.Inputs, of=lambda item, netlist: netlist)), \
                mock.patch.object(run_inputs, "netlist", side_effect=lambda item, _, folder: item.name) as elaborated:
            counted_runs.run_all(jobs, part_of(Technology), self.folder, self.said.append)
        self.assertEqual([call.args[2] for call in elaborated.call_args_list],
                         [self.folder / batch.NETLISTS / name for name in ("ezpointer", "hispointer")])

    def test_each_input_has_its_key(self) -> None:
        job = self.jobs[0]
        others = [job, replace(job, corners=("slow",)), replace(job, most_attempts=1), replace(job, naming=1)]
        keys = {batch._key(one, digest) for one in others for digest in ("a", "b")}
        self.assertEqual(len(keys), 8)


if __name__ == "__main__":
    unittest.main()
