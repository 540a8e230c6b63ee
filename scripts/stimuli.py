#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`stimuli.py REPORT`: prints a digest of each file that dtof-vectors writes for `make power` (REPORT power) or `make synth-subsystem`
(subsystem): photons of the scene, and the results that the models expect. While they are the same, a change of the models changes no figure
of that report (scripts/reports.py confirm)."""

import hashlib
import subprocess
import sys
import tempfile
from pathlib import Path

from dtof_synth import configuration, program, scene_power, simulation, subsystem, subsystem_power

ROOT = Path(__file__).resolve().parent.parent
SEED = 1  # of the Makefile


def cases(report: str) -> list[tuple[simulation.Case, str, float]]:
    """Cases of a report, each with its scene and light."""
    known = configuration.load(ROOT / "configurations.toml")
    if report == "power":
        return [(scene_power.small_case(known[name], SEED), scene_power.SCENE, klux) for name in scene_power.CONFIGURATIONS
                for klux in scene_power.KLUX.values()]
    return [(subsystem_power.case(known[name], subsystem.SEED), subsystem_power.SCENE, subsystem_power.KLUX)
            for name in subsystem.CONFIGURATIONS]


def lines(case: simulation.Case, scene: str, klux: float) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        simulation.write_vectors(case, ROOT, Path(folder), ("--scene", scene, "--klux", f"{klux:g}"))
        return [f"{case.name} {klux:g} {file.name} {hashlib.sha256(file.read_bytes()).hexdigest()}" for file in sorted(Path(folder).iterdir())]


def main() -> int:
    if sys.argv[1:] not in (["power"], ["subsystem"]):
        print(f"usage: {__doc__}", file=sys.stderr)
        return 2
    subprocess.run(["make", "--silent", "vectors"], cwd=ROOT, check=True, stdout=sys.stderr)
    for case in cases(sys.argv[1]):
        print("\n".join(lines(*case)))
    return 0


if __name__ == "__main__":
    program.run(main)
