#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`stimuli.py power`: prints a digest of each file that dtof-vectors writes for `make power`: photons of the scene, and the results that the
models expect. While they are the same, a change of the models changes no figure of that report (scripts/reports.py confirm)."""

import hashlib
import subprocess
import sys
import tempfile
from pathlib import Path

from dtof_synth import configuration, program, scene_power, simulation

ROOT = Path(__file__).resolve().parent.parent
SEED = 1  # of the Makefile


def power_lines() -> list[str]:
    known = configuration.load(ROOT / "configurations.toml")
    lines = []
    for name in scene_power.CONFIGURATIONS:
        for klux in scene_power.KLUX.values():
            with tempfile.TemporaryDirectory() as folder:
                simulation.write_vectors(scene_power.small_case(known[name], SEED), ROOT, Path(folder),
                                         ("--scene", scene_power.SCENE, "--klux", f"{klux:g}"))
                lines += [f"{name} {klux:g} {file.name} {hashlib.sha256(file.read_bytes()).hexdigest()}"
                          for file in sorted(Path(folder).iterdir())]
    return lines


def main() -> int:
    if sys.argv[1:] != ["power"]:
        print(f"usage: {__doc__}", file=sys.stderr)
        return 2
    subprocess.run(["make", "--silent", "vectors"], cwd=ROOT, check=True, stdout=sys.stderr)
    print("\n".join(power_lines()))
    return 0


if __name__ == "__main__":
    program.run(main)
