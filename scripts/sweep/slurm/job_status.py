#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`job_status.py JOB`: what Snakemake asks of a job of Slurm; prints running, success or failed.

A job that Slurm has forgotten, MinJobAge after its end, counts as failed and is run again. While the controller does not
answer, nothing is known, and the job counts as running.
"""

import subprocess
import sys

FORGOTTEN = "Invalid job id"
RUNNING = {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "SUSPENDED", "REQUEUED", "RESIZING"}


def status(answer: str, error: str = "") -> str:
    """Status from the two outputs of `scontrol --oneliner show job`."""
    states = [word.removeprefix("JobState=") for word in answer.split() if word.startswith("JobState=")]
    if not states:
        return "failed" if FORGOTTEN in error else "running"
    if states[0] in RUNNING:
        return "running"
    return "success" if states[0] == "COMPLETED" else "failed"


if __name__ == "__main__":
    found = subprocess.run(["scontrol", "--oneliner", "show", "job", sys.argv[1]], capture_output=True, text=True, check=False)
    print(status(found.stdout, found.stderr))
