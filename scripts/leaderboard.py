#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Every read-out, every rival and the model files of examples/leaderboard on the same photons: build/leaderboard/leaderboard.md, .csv and pictures.

`leaderboard.py MODULE_FOLDER [OPTION ...]`: MODULE_FOLDER has the built Python module; options go to `python3 -m dtof.leaderboard`.
"""

import csv
import os
import subprocess
import sys
from pathlib import Path

import rivals
from dtof_synth import program
from figures.small import is_small, written_root

ROOT = Path(__file__).resolve().parent.parent
FOLDER = written_root(ROOT) / "build" / "leaderboard"
MODELS = ROOT / "examples" / "leaderboard"
SMALL = ["--beside", "ezpointer,histogram32", "--klux", "14", "--frames", "2", "--scene", "room", "--rows", "16"]
KINDS = {"read-out": "read-out", "rival": "rival", "model file": "rival"}  # how a row is drawn


def points(file: Path) -> dict[str, list[rivals.Point]]:
    """The rows of leaderboard.csv by light."""
    lights: dict[str, list[rivals.Point]] = {}
    with file.open(newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            share, low, high = (100 * float(row[f"{rivals.SHARE}{end}"]) for end in ("", "_low", "_high"))
            lights.setdefault(row["klux"], []).append(
                rivals.Point(row["readout"], KINDS[row["kind"]], float(row["bits_per_pixel"]) if row["bits_per_pixel"] else None, share, low, high,
                             100 * float(row["above_10_percent"]), None, None))
    return lights


def page(tables: str, lights: list[str]) -> str:
    pictures = "\n\n".join(f"![Errors over memory, bits per pixel, {klux} klux](leaderboard_{klux}klux.svg)" for klux in lights)
    return f"""# Leaderboard

Read-outs, rivals and model files, ranked by the per cent of pixels with a relative error above 3 %. Bold: no row with as few bits has fewer
errors. Bits of the project's read-outs are those of the synthesised arrays, bits of the others are their authors'.

To enter, write a model file in Python and run it beside these rows ([how](../docs/user/leaderboard.md)). A pull request that adds the
file to `examples/leaderboard` puts it into these tables.

{tables}
{pictures}

Command: `make leaderboard`
"""


def main() -> int:
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        raise SystemExit(f"usage: {__doc__}")
    FOLDER.mkdir(parents=True, exist_ok=True)
    bits = [f"{name}={value}" for name, value in rivals.known_bits(rivals.AREA).items()]
    command = [sys.executable, "-m", "dtof.leaderboard", *(str(file) for file in sorted(MODELS.glob("*.py"))), "--beside", "all", "--bits", *bits,
               "--out", str(FOLDER), *(SMALL if is_small() else []), *sys.argv[2:]]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, check=False, env={**os.environ, "PYTHONPATH": sys.argv[1]})
    if done.returncode != 0:
        return done.returncode
    lights = points(FOLDER / "leaderboard.csv")
    for klux, rows in lights.items():
        script = rivals.script(klux, rows, rivals.AXES[0], FOLDER / f"leaderboard_{klux}klux.svg")
        drawn = subprocess.run(["gnuplot"], input=script, text=True, capture_output=True, check=False)
        if drawn.returncode != 0:
            raise SystemExit(f"error: gnuplot failed: {drawn.stderr.strip()}")
    text = page((FOLDER / "leaderboard.md").read_text(encoding="utf-8"), list(lights))
    (FOLDER / "leaderboard.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


if __name__ == "__main__":
    program.run(main)
