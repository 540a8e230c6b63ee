#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A small sweep through a real Slurm of one node: a job that is killed and a workflow that is killed lose and double nothing,
and the table is that of a local run byte for byte."""

import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import plan  # noqa: E402
from single_node_slurm import SingleNodeSlurm  # noqa: E402

ROOT = HERE.parent.parent
SWEEP = """\
name = "slurm_test"
command = "build/cpp/app/dtof frame --readout {readout} --scene room --klux {klux} --seed {seed} --columns 0-3 --table none \
--engine model --threads 1 --out {out}"
table = "summary.csv"
inputs = ["build/cpp/app/dtof"]
batch = 2
seed_of = ["klux", "repetition"]

[axes]
klux = [14, 50]
repetition = [1, 2, 3]
readout = ["ezpointer", "hispointer", "sifh", "fifh"]
"""
PATIENCE = 300  # seconds


class Sweep(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.description = self.folder / "sweep.toml"
        self.description.write_text(SWEEP, encoding="utf-8")
        (self.folder / "slurm").mkdir()
        self.slurm = SingleNodeSlurm(self.folder / "slurm", os.cpu_count() or 1)
        self.slurm.__enter__()
        self.addCleanup(self.slurm.__exit__)

    def command(self, name: str, *options: str) -> list[str]:
        return [sys.executable, str(HERE / "sweep.py"), str(self.description), "--folder", str(self.folder / name), *options]

    def run_whole(self, name: str, *options: str) -> bytes:
        result = subprocess.run(self.command(name, *options), env=self.slurm.environment, capture_output=True, text=True,
                                check=False)
        self.assertEqual(result.returncode, 0, result.stderr[-2000:])
        return plan.table_file(self.folder / name).read_bytes()

    def batches(self, name: str) -> set[Path]:
        return set((self.folder / name).glob("batches/*/*.json"))

    def wait_for(self, what: str, ready, sweep: subprocess.Popen):
        end = time.monotonic() + PATIENCE
        while not (found := ready()):
            self.assertIsNone(sweep.poll(), f"the sweep ended before {what}")
            self.assertLess(time.monotonic(), end, f"waited too long for {what}")
            time.sleep(0.1)
        return found

    def running_jobs(self) -> list[str]:
        return self.slurm.output("squeue", "--noheader", "--states=RUNNING", "--format=%A").split()

    def test_killed_jobs_and_a_killed_workflow_resume(self) -> None:
        local = self.run_whole("local")
        self.assertEqual(local.count(b"\n"), 1 + 24)

        log = (self.folder / "log").open("w", encoding="utf-8")
        self.addCleanup(log.close)
        sweep = subprocess.Popen(self.command("cluster", "--slurm"), env=self.slurm.environment, stdout=log, stderr=log,
                                 start_new_session=True)
        job = self.wait_for("a job", self.running_jobs, sweep)[0]
        subprocess.run(["scancel", job], env=self.slurm.environment, check=True)
        self.wait_for("two batches", lambda: len(self.batches("cluster")) >= 2, sweep)
        os.killpg(sweep.pid, signal.SIGKILL)
        sweep.wait()
        done = self.batches("cluster")
        self.assertLess(len(done), 12, "killed too late to prove anything")
        self.assertFalse(plan.table_file(self.folder / "cluster").exists())
        self.assertIn("CANCELLED", self.slurm.output("scontrol", "--oneliner", "show", "job", job))
        written = {path: path.stat().st_mtime_ns for path in done}

        self.assertEqual(self.run_whole("cluster", "--slurm"), local)
        self.assertEqual(len(self.batches("cluster")), 12)
        # What was done is not done again.
        self.assertEqual({path: path.stat().st_mtime_ns for path in done}, written)
        self.assertEqual(self.run_whole("cluster", "--slurm"), local)
        print(f"{len(done)} of 12 batches were done when the workflow was killed", file=sys.stderr)


if __name__ == "__main__":
    unittest.main()
