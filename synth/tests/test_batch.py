# SPDX-License-Identifier: Apache-2.0
"""Many configurations at a time, one of which fails."""

import tempfile
import time
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

from dtof_synth import batch
from dtof_synth.errors import FlowError

JOBS = 20


def work(job, _technology, folder: Path, _key: str) -> str:
    """Fails for the first job; leaves a file for each job that began."""
    folder.mkdir(parents=True)
    if job.name == "job0":
        raise FlowError("job0: broken")
    time.sleep(0.2)
    return job.name


def job(number: int) -> SimpleNamespace:
    return SimpleNamespace(name=f"job{number}", configuration=SimpleNamespace(is_pool=number == 0))


class Batch(unittest.TestCase):
    def run_all(self, first: int) -> tuple[dict | None, int]:
        """(results, or None where a job failed; jobs that had begun a second later)."""
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(batch, "_work", work), \
                mock.patch.object(batch, "_key", lambda *_: "key"), mock.patch.object(batch, "input_digest", lambda _: "digest"):
            try:
                results = batch.run_all([job(number) for number in range(first, JOBS)], None, Path(folder), 2, lambda _: None)
            except FlowError:
                results = None
            time.sleep(1)
            return results, len(list(Path(folder).iterdir()))

    def test_after_a_failure_no_further_job_begins(self):
        results, begun = self.run_all(0)
        self.assertIsNone(results)
        self.assertLess(begun, 8)

    def test_results_are_in_the_order_of_the_jobs(self):
        results, begun = self.run_all(12)
        self.assertEqual(list(results), [f"job{number}" for number in range(12, JOBS)])
        self.assertEqual(begun, 8)


if __name__ == "__main__":
    unittest.main()
