#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a sweep, what of it has not been computed yet, and merges its table."""

import argparse
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import merge  # noqa: E402
import plan  # noqa: E402

ROOT = HERE.parent.parent
SUBMITTED_AT_ONCE = 100  # by a cluster's profile


def snakemake(sweep: Path, folder: Path, arguments: argparse.Namespace, *options: str) -> list[str]:
    command = ["snakemake", "--snakefile", str(HERE / "Snakefile"), "--directory", str(folder), "--config",
               f"sweep={sweep}", f"folder={folder}", "--rerun-triggers", "mtime", "--rerun-incomplete", "--keep-going",
               "--scheduler", "greedy", "--quiet", "rules"]
    if arguments.slurm:
        command += ["--profile", str(HERE / "slurm"), "--jobs", str(arguments.jobs or SUBMITTED_AT_ONCE)]
    else:
        command += ["--cores", str(arguments.jobs or os.cpu_count() or 1)]
    return [*command, *options]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sweep", type=Path, help="description (TOML)")
    parser.add_argument("--folder", type=Path, help="for batches and table (default: build/sweep/<name>)")
    parser.add_argument("--slurm", action="store_true", help="as jobs of Slurm, by scripts/sweep/slurm/config.yaml")
    parser.add_argument("--jobs", type=int, help=f"at the same time (default: processors; with --slurm {SUBMITTED_AT_ONCE})")
    arguments = parser.parse_args()
    path = arguments.sweep.resolve()
    try:
        sweep = plan.load(path, ROOT)
        folder = (arguments.folder or ROOT / "build" / "sweep" / sweep.name).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        print(f"{sweep.name}: {sweep.points} points in {sweep.batches} batches, {folder}")
        # A workflow that was killed leaves its lock behind.
        subprocess.run(snakemake(path, folder, arguments, "--unlock"), check=False, capture_output=True)
        if subprocess.run(snakemake(path, folder, arguments), check=False).returncode != 0:
            raise plan.SweepError(f"sweep {sweep.name}: jobs failed; what is done is kept, run it again for the rest")
        text = merge.merged(sweep, folder)
    except plan.SweepError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("error: interrupted; what is done is kept, run it again for the rest", file=sys.stderr)
        return 130
    part = folder / ".table.part"
    part.write_text(text, encoding="utf-8")
    part.replace(plan.table_file(folder))
    print(f"{plan.table_file(folder)} written")
    return 0


if __name__ == "__main__":
    sys.exit(main())
