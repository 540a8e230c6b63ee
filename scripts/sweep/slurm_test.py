#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A small sweep through a real Slurm of one node: a job that is killed, a workflow that is killed and one that is interrupted
lose and double nothing, and the table is that of a local run byte for byte."""

import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import plan
from single_node_slurm import CannotStart, SingleNodeSlurm

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SWEEP = """\
name = "slurm_test"
command = "build/cpp/bin/dtof frame --readout {{readout}} --scene room --klux {{klux}} --seed {{seed}} --columns 0-3 \
--table none --engine model --threads 1 --out {{out}}"
table = "summary.csv"
inputs = ["build/cpp/bin/dtof", "{note}"]
batch = 2
seed_of = ["klux", "repetition"]

[axes]
klux = [14, 50]
repetition = [1, 2, 3]
readout = ["ezpointer", "hispointer", "sifh", "fifh"]
"""
POINTS, BATCHES = 24, 12
PATIENCE = 300  # seconds
Found = TypeVar("Found")


class Sweep(unittest.TestCase):
    folder: Path
    description: Path
    note: Path
    slurm: SingleNodeSlurm
    local: bytes

    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.description = cls.folder / "a sweep.toml"  # a blank: nothing may take a path apart
        cls.note = cls.folder / "note"
        cls.note.write_text("first\n", encoding="utf-8")
        cls.description.write_text(SWEEP.format(note=cls.note), encoding="utf-8")
        (cls.folder / "slurm").mkdir()
        cls.slurm = SingleNodeSlurm(cls.folder / "slurm", os.cpu_count() or 1)
        try:
            cls.slurm.__enter__()
        except CannotStart as reason:
            print(f"skipped: no Slurm can be started here: {reason}", file=sys.stderr)
            raise unittest.SkipTest(str(reason)) from None
        cls.addClassCleanup(cls.slurm.__exit__)
        cls.local = cls.run_whole("local")[0]

    @classmethod
    def command(cls, name: str, *options: str) -> list[str]:
        return [sys.executable, str(HERE / "sweep.py"), str(cls.description), "--folder", str(cls.folder / name), *options]

    @classmethod
    def run_whole(cls, name: str, *options: str) -> tuple[bytes, str]:
        """Runs a sweep; returns the table and the output."""
        result = subprocess.run(cls.command(name, *options), env=cls.slurm.environment, capture_output=True, text=True,
                                check=False)
        if result.returncode != 0:
            raise AssertionError(result.stderr[-2000:])
        return plan.table_file(cls.folder / name).read_bytes(), result.stdout

    def start(self, name: str) -> subprocess.Popen[bytes]:
        """Starts a sweep through Slurm, in a process group of its own."""
        log = (self.folder / f"{name}.log").open("w", encoding="utf-8")
        self.addCleanup(log.close)
        return subprocess.Popen(self.command(name, "--slurm"), env=self.slurm.environment, stdout=log, stderr=log,
                                start_new_session=True)

    def batches(self, name: str) -> dict[Path, int]:
        """Batch files and the time at which each was written."""
        return {path: path.stat().st_mtime_ns for path in (self.folder / name).glob("batches/*/*.json")}

    def wait_for(self, what: str, ready: Callable[[], Found], sweep: subprocess.Popen[bytes]) -> Found:
        end = time.monotonic() + PATIENCE
        while not (found := ready()):
            self.assertIsNone(sweep.poll(), f"the sweep ended before {what}")
            self.assertLess(time.monotonic(), end, f"waited too long for {what}")
            time.sleep(0.1)
        return found

    def jobs(self, *options: str) -> list[str]:
        return self.slurm.output("squeue", "--noheader", "--format=%A", *options).split()

    def test_the_local_table_has_every_point_once(self) -> None:
        lines = self.local.decode().splitlines()
        self.assertEqual(len(lines), 1 + POINTS)
        self.assertEqual(len({tuple(line.split(",")[:3]) for line in lines[1:]}), POINTS)

    def test_killed_jobs_and_a_killed_workflow_resume(self) -> None:
        sweep = self.start("killed")
        job = self.wait_for("a job", lambda: self.jobs("--states=RUNNING"), sweep)[0]
        subprocess.run(["scancel", job], env=self.slurm.environment, check=True)
        self.wait_for("two batches", lambda: len(self.batches("killed")) >= 2, sweep)
        os.killpg(sweep.pid, signal.SIGKILL)
        sweep.wait()
        self.assertTrue(self.jobs(), "killed too late to leave a job behind")
        self.assertFalse(plan.table_file(self.folder / "killed").exists())
        self.assertIn("CANCELLED", self.slurm.output("scontrol", "--oneliner", "show", "job", job))

        done = self.batches("killed")
        table, printed = self.run_whole("killed", "--slurm")
        self.assertEqual(table, self.local)
        self.assertIn("jobs of a killed workflow are cancelled", printed)
        finished = self.batches("killed")
        self.assertEqual(len(finished), BATCHES)
        self.assertEqual(self.jobs(), [])
        # What was done is not done again.
        self.assertEqual({path: finished[path] for path in done}, done)
        self.assertEqual(self.run_whole("killed", "--slurm")[0], self.local)
        self.assertEqual(self.batches("killed"), finished)

    def test_an_interrupted_workflow_ends_its_jobs_and_resumes(self) -> None:
        sweep = self.start("interrupted")
        self.wait_for("a batch", lambda: self.batches("interrupted"), sweep)
        second = subprocess.run(self.command("interrupted", "--slurm"), env=self.slurm.environment, capture_output=True,
                                text=True, check=False)
        self.assertEqual(second.returncode, 1)
        self.assertIn("another run of this sweep is at work here", second.stderr)
        os.killpg(sweep.pid, signal.SIGINT)
        self.assertEqual(sweep.wait(), 130)
        self.assertLess(len(self.batches("interrupted")), BATCHES, "interrupted too late")
        self.assertEqual(self.jobs("--states=PENDING,RUNNING"), [])
        self.assertEqual(self.run_whole("interrupted", "--slurm")[0], self.local)

    def test_another_input_makes_everything_new(self) -> None:
        first = self.run_whole("changed")[0]
        older = self.batches("changed")
        self.note.write_text("second\n", encoding="utf-8")
        self.addCleanup(self.note.write_text, "first\n", encoding="utf-8")
        self.assertEqual(self.run_whole("changed")[0], first)
        self.assertEqual(len(self.batches("changed").keys() - older.keys()), BATCHES)


if __name__ == "__main__":
    unittest.main()
