#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the results of README.md from the committed reports; --check only compares.

Every figure was printed by a command of this tree: areas and clock by `make synth`, accuracy by `make frames`, why the full histogram is
so bad by `make scenes` and `make reproduce`.
"""

import csv
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "synth"))

from dtof_synth.configuration import load  # noqa: E402

BEGIN = "<!-- results: written by scripts/update_readme.py -->\n"
END = "<!-- end of results -->"


def rows(path: str) -> list[dict[str, str]]:
    with open(ROOT / path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def table() -> str:
    area = {row["configuration"]: row for row in rows("reports/area.csv")}
    slow = {row["configuration"]: row for row in rows("reports/timing.csv") if row["corner"] == "slow"}
    above_3 = {(row["sensor"], row["read-out"]): f"{100 * float(row['above_3_percent']):.2f} %"
               for row in rows("reports/frames.csv")}
    sensors = list(dict.fromkeys(sensor for sensor, _ in above_3))
    lines = [
        "| read-out | mm2, 200 columns | thesis mm2 | bits a pixel | logic um2 a column | fmax slow, MHz "
        f"| pixels off by > 3 %: {' | '.join(sensors)} |",
        "|---|" + "---:|" * (5 + len(sensors)),
    ]
    for name, configuration in load(ROOT / "configurations.toml").items():
        if configuration.variant_of or name not in area:
            continue
        a = area[name]
        array = f"{float(a['total_mm2']):.2f}"
        if int(a["columns"]) * configuration["PIXELS_PER_SRAM"] != 32000:
            array += f" ({a['columns']} x {configuration['PIXELS_PER_SRAM']} pixels)"
        lines.append(
            f"| {configuration.title} | {array} | {a['thesis_mm2'] or '-'} | {a['bits_per_pixel']} "
            f"| {float(a['column_um2']):.0f} | {float(slow[name]['fmax_mhz']):.0f} "
            f"| {' | '.join(above_3.get((sensor, configuration.title), '-') for sensor in sensors)} |"
        )
    return "\n".join(lines) + "\n"


def scene() -> str:
    """What the table's accuracy was measured on: the scene's line of the standard frames."""
    lines = (ROOT / "reports/frames.md").read_text(encoding="utf-8").splitlines()
    first = next(line for line in lines if line.startswith("Scene "))
    return (f"{first.removesuffix('.')}; after each read-out's look-up table from flat targets. Areas: generated 40 nm "
            "libraries, not sign-off.")


def histogram_words() -> str:
    """Why the full histogram's peak is a bad estimate, in figures of the reports."""
    found = {}
    for row in rows("reports/scenes.csv"):
        sensor = next(iter(row.values()))  # the first column
        found[sensor, row["klux"], row["scene"], row["estimator"]] = row

    def share(klux: int, scene_name: str, estimator: str = "histogram", limit: int = 3) -> str:
        return f"{100 * float(found['thesis', str(klux), scene_name, estimator][f'above_{limit}_percent']):.1f} %"

    statements = {row["thesis"]: row for row in rows("reports/reproduction.csv")}
    pile_up = statements["Fig. 2.4"]["here"].split(";")[0].removeprefix("lost: ")
    return (
        "Why is the full histogram, with the most memory, so bad? It reports its fullest bin and nothing else. The pulse is "
        "spread over some 46 bins (2 ns, at 44 ps a bin), none of which has many counts, so which of them is the fullest is "
        f"chance: on a wall at 1 m, {share(14, 'flat 1 m')} of its results are off by more than 3 %, but "
        f"{share(14, 'flat 1 m', limit=10)} by more than 10 %. Farther away single bins of background are fuller than the "
        f"pulse's: at 5 m {share(14, 'flat 5 m', limit=10)} are off by more than 10 %, and "
        f"{share(2, 'flat 5 m', limit=10)} at 2 klux. Very near, pile-up takes {pile_up} of the events (0.2 and 0.5 m) and "
        f"narrows the pulse. The counts themselves are good: a filter matched to the pulse and the light leaves "
        f"{share(14, 'room', 'matched filter (single pixel)')} of the room's pixels above 3 %, on the same "
        f"histograms, instead of "
        f"{share(14, 'room')} ([scenes](reports/scenes.md), [reproduction](reports/reproduction.md)).")


def filled(text: str) -> str:
    return textwrap.fill(text, width=118, break_long_words=False, break_on_hyphens=False) + "\n"


def updated(text: str) -> str:
    head, rest = text.split(BEGIN)
    return head + BEGIN + "\n".join((filled(scene()), table(), filled(histogram_words()))) + END + rest.split(END)[1]


def write(check: bool = False) -> int:
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    if check and updated(text) != text:
        print("error: README.md: the results differ from reports/; run scripts/update_readme.py", file=sys.stderr)
        return 1
    if not check:
        readme.write_text(updated(text), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(write(check="--check" in sys.argv[1:]))
