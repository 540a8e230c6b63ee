#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the results table of README.md from the committed reports; --check only compares.

Every figure of the table was printed by a command of this tree: areas and clock by `make synth`, accuracy by `make`.
"""

import csv
import sys
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
    accuracy = {row["read-out"]: row for row in rows("reports/frame/summary.csv")}
    lines = [
        "| read-out | mm2, 200 columns | thesis mm2 | bits a pixel | logic um2 a column | fmax slow, MHz "
        "| pixels off by > 3 % | > 10 % |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, configuration in load(ROOT / "configurations.toml").items():
        if configuration.variant_of or name not in area:
            continue
        a = area[name]
        measured = accuracy.get(configuration.title, {})
        array = f"{float(a['total_mm2']):.2f}"
        if int(a["columns"]) * configuration["PIXELS_PER_SRAM"] != 32000:
            array += f" ({a['columns']} x {configuration['PIXELS_PER_SRAM']} pixels)"
        lines.append(
            f"| {configuration.title} | {array} | {a['thesis_mm2'] or '-'} | {a['bits_per_pixel']} "
            f"| {float(a['column_um2']):.0f} | {float(slow[name]['fmax_mhz']):.0f} "
            f"| {measured.get('above 3 %', '-')} | {measured.get('above 10 %', '-')} |"
        )
    return "\n".join(lines) + "\n"


def main() -> int:
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    head, rest = text.split(BEGIN)
    tail = rest.split(END)[1]
    updated = head + BEGIN + table() + END + tail
    if "--check" in sys.argv[1:]:
        if updated != text:
            print("error: README.md: the results table differs from reports/; run scripts/update_readme.py",
                  file=sys.stderr)
            return 1
        return 0
    readme.write_text(updated, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
