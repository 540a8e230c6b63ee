#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What each part of poolPointer costs beside what it brings: build/pool_parts/pool_parts.md and .csv.

`pool_parts.py DTOF_STUDY [--seed N]`: area and power of the parts are those of `synth/synth.py part-costs`, errors those of
`dtof-study pool` with a number changed that takes a part's effect away.
"""

import argparse
import csv
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from dtof_synth import program
from figures.small import is_small, written_root

ROOT = Path(__file__).resolve().parent.parent
FOLDER = written_root(ROOT) / "build" / "pool_parts"
SCENES = ("room", "isolated") if is_small() else ("room", "planes", "clutter", "poles", "isolated")
LIGHTS = ("14", "50")
SEEDS = "2"
WHOLE = "poolPointer"
NO_S1 = ", no S1"


@dataclass(frozen=True)
class Part:
    block: str
    instance: str  # as in part_costs.py
    does: str
    without: tuple[tuple[str, str], ...] = ()  # (what is missing, numbers of `dtof-study pool --design`)


PARTS = (
    Part("quad", "u_timestamp_input", "selects the detections among the timestamps, and delays them"),
    Part("quad", "u_label_match", "track: finds the candidates near a timestamp"),
    Part("quad", "u_track_update", "track: scores, leader, its offset",
         (("an offset of 2 bits instead of 6", "OFFSET_BITS=2"),)),
    Part("quad", "u_pixel_distance", "track and point: distances to the leader and the rival"),
    Part("quad", "u_pointer_update", "point: moves and the advantage"),
    Part("quad", "u_column", "selects the timestamp that counts"),
    Part("quad", "u_pixel_update", "track and point: registers between distance and next word"),
    Part("quad", "", "coarse histogram, words of the SRAM, turns of the columns"),
    Part("quad", "SRAM", "pixels and groups"),
    Part("engine", "u_candidate_decoder", "decode: candidates from five groups' histograms",
         (("the four neighbouring groups (weight 64 for the own group)", "OWN_WEIGHT=64"), ("the cost of later candidates", "LABEL_COST_SLOPE=0"))),
    Part("engine", "u_beside_evidence", "choose: evidence of the neighbouring columns",
         (("the left column", "LEFT_COST=0,LEFT_COST_SLOPE=0"), ("the right column", "RIGHT_LIMIT=0,RIGHT_LIMIT_SLOPE=0"),
          ("both", "LEFT_COST=0,LEFT_COST_SLOPE=0,RIGHT_LIMIT=0,RIGHT_LIMIT_SLOPE=0"))),
    Part("engine", "u_choose", "choose: the chain along the column",
         (("the chain (neighbours may disagree)", "CHOOSE_PENALTY=0,CHOOSE_PENALTY_SLOPE=0"),)),
    Part("engine", "u_decide", "decide: the chain along the column",
         (("the chain (neighbours may disagree)", "DECIDE_PENALTY=0,DECIDE_PENALTY_SLOPE=0"),)),
    Part("engine", "u_smoothing", "S1"),
    Part("engine", "", "the engine's registers and choices"),
    Part("engine", "SRAM", "the engines' scratch"),
)


def costs(path: Path) -> dict[tuple[str, str], dict[str, float]]:
    with path.open(newline="", encoding="utf-8") as file:
        return {(row["block"], row["instance"]): {name: float(row[name]) for name in ("area_um2", "day_mw", "dusk_mw")}
                for row in csv.DictReader(file)}


def errors(path: Path) -> dict[tuple[str, str], tuple[float, float]]:
    """Shares of errors above 3 % and 10 % over all scenes' pixels, by estimator and light level."""
    sums: dict[tuple[str, str], list[float]] = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            total = sums.setdefault((row["estimator"], row["klux"]), [0.0, 0.0, 0.0])
            pixels = int(row["pixels"])
            total[0] += pixels
            total[1] += pixels * float(row["above_3_percent"])
            total[2] += pixels * float(row["above_10_percent"])
    return {key: (above_3 / pixels, above_10 / pixels) for key, (pixels, above_3, above_10) in sums.items()}


def unknown_parts(found: dict[tuple[str, str], dict[str, float]]) -> list[str]:
    """Parts with cells that no row describes."""
    described = {(part.block, part.instance) for part in PARTS}
    return ["/".join(part) for part, figures in found.items() if part not in described and figures["area_um2"] > 0]


def accuracy_rows() -> list[tuple[str, str, str]]:
    """(part, what is missing, estimator)."""
    rows = [("", "nothing", WHOLE), ("u_smoothing", "S1", WHOLE + NO_S1)]
    return rows + [(part.instance, what, f"{WHOLE} {design}") for part in PARTS for what, design in part.without]


def report(found: dict[tuple[str, str], dict[str, float]], shares: dict[tuple[str, str], tuple[float, float]], seed: int) -> str:
    total = {name: sum(figures[name] for figures in found.values()) for name in ("area_um2", "day_mw", "dusk_mw")}
    lines = ["# What the parts of poolPointer cost and bring", "",
             f"Written by `make pool-parts`, seed {seed}. Area and power are for the whole array of 200 columns, while acquisitions "
             "stream in. An engine and the four columns of an SRAM are synthesised with their modules kept apart, and simulated on the "
             "scene `room` by day (50 klux) and at dusk (2 klux), as in [power.md](power.md). Use the figures to compare parts. Their sum "
             "differs from [area.md](area.md): modules share no logic, and trees, repeaters, hold buffers, border registers and control "
             "are left out.", "",
             "| part | does | um2 | share | mW, day | mW, dusk |", "|---|---|---:|---:|---:|---:|"]
    for part in PARTS:
        figures = found.get((part.block, part.instance))
        if figures is not None:
            lines.append(f"| {part.block}: {part.instance.removeprefix('u_') or 'the rest'} | {part.does} | {figures['area_um2']:.0f} | "
                         f"{figures['area_um2'] / total['area_um2']:.1%} | {figures['day_mw']:.1f} | {figures['dusk_mw']:.1f} |")
    lines += [f"| sum | | {total['area_um2']:.0f} | | {total['day_mw']:.1f} | {total['dusk_mw']:.1f} |", "",
              f"Pixels above 3 % / above 10 %, in %, if a part has no effect: scenes {', '.join(SCENES)}, sensor thesis, "
              f"{SEEDS} seeds, no look-up table; S1 is on, except in its own row.", "",
              "| part | without | " + " | ".join(f"{klux} klux" for klux in LIGHTS) + " |", "|---|---|" + "---:|" * len(LIGHTS)]
    for instance, what, estimator in accuracy_rows():
        cells = (f"{100 * above_3:.2f} / {100 * above_10:.2f}" for above_3, above_10 in (shares[estimator, klux] for klux in LIGHTS))
        lines.append(f"| {instance.removeprefix('u_')} | {what} | " + " | ".join(cells) + " |")
    return "\n".join([*lines, ""])


def table_csv(found: dict[tuple[str, str], dict[str, float]], shares: dict[tuple[str, str], tuple[float, float]]) -> str:
    lines = ["kind,block,part,without,area_um2,day_mw,dusk_mw,klux,above_3_percent,above_10_percent"]
    lines += [f"cost,{block},{instance.removeprefix('u_')},,{figures['area_um2']:.0f},{figures['day_mw']:.3f},{figures['dusk_mw']:.3f},,,"
              for (block, instance), figures in found.items()]
    for part, what, estimator in accuracy_rows():
        lines += [f"error,,{part.removeprefix('u_')},{what},,,,{klux},{shares[estimator, klux][0]:.6f},{shares[estimator, klux][1]:.6f}"
                  for klux in LIGHTS]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dtof_study")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    study = [options.dtof_study, "pool", "--no-references", "--scene", *SCENES, "--klux", *LIGHTS, "--seeds", SEEDS,
             "--seed", str(options.seed), "--table", "none"]
    designs = [design for part in PARTS for _, design in part.without]
    try:
        subprocess.run([ROOT / "synth" / "synth.py", "part-costs", FOLDER / "costs.csv", "--seed", str(options.seed)], check=True)
        subprocess.run([*study, "--out", FOLDER / "whole"], check=True)
        subprocess.run([*study, "--out", FOLDER / "without", "--design", *designs], check=True)
    except subprocess.CalledProcessError as error:
        return error.returncode if error.returncode > 0 else 130
    found = costs(FOLDER / "costs.csv")
    if unknown := unknown_parts(found):
        print(f"error: {Path(__file__).name} has no row for {', '.join(unknown)}", file=sys.stderr)
        return 1
    shares = errors(FOLDER / "whole" / "pool.csv") | errors(FOLDER / "without" / "pool.csv")
    (FOLDER / "pool_parts.md").write_text(report(found, shares, options.seed), encoding="utf-8")
    (FOLDER / "pool_parts.csv").write_text(table_csv(found, shares), encoding="utf-8")
    print(f"{(FOLDER / 'pool_parts.md').relative_to(ROOT)} written")
    return 0


if __name__ == "__main__":
    program.run(main)
