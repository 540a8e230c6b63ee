# SPDX-License-Identifier: Apache-2.0
"""The figures of each report, read from the files that its command wrote. A page can quote these and no others.

The name of a figure is `report.what.figure`; a read-out has its configuration's name there. To add figures of a report, add a
function to MAKERS."""

import csv
import gzip
import io
import re
from collections.abc import Callable
from pathlib import Path

from dtof_synth.configuration import Configuration, load

from .store import Figure

Figures = dict[str, Figure]


class Tables:
    """Tables of one report, and the names of its read-outs."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.configurations: dict[str, Configuration] = load(root / "configurations.toml")
        self.names = {one.title: name for name, one in self.configurations.items()}

    def rows(self, name: str) -> list[dict[str, str]]:
        content = (self.root / "reports" / name).read_bytes()
        text = (gzip.decompress(content) if name.endswith(".gz") else content).decode("utf-8")
        return list(csv.DictReader(io.StringIO(text, newline="")))

    def page(self, name: str) -> str:
        return (self.root / "reports" / name).read_text(encoding="utf-8")

    def name(self, title: str) -> str:
        """A title as part of a figure's name."""
        return self.names.get(title) or re.sub(r"\W+", "_", title.lower()).strip("_")


def table_of(page: str, heading: str) -> list[dict[str, str]]:
    """The first table below a heading of a Markdown page."""
    _, found, text = page.partition(f"\n## {heading}\n")
    if not found:
        raise KeyError(f"no heading '{heading}'")
    lines = []
    for line in text.split("\n## ")[0].splitlines():
        if line.startswith("|"):
            lines.append([cell.strip() for cell in line.strip("|").split("|")])
        elif lines:
            break
    header, _, *rows = lines
    return [dict(zip(header, row)) for row in rows]


def percent(share: str) -> str:
    return f"{100 * float(share):.2f}"


def interval(row: dict[str, str], column: str) -> tuple[str, str] | None:
    low, high = row.get(f"{column}_low"), row.get(f"{column}_high")
    return (percent(low), percent(high)) if low and high else None


def synth(tables: Tables) -> Figures:
    found: Figures = {}
    for row in tables.rows("area.csv"):
        name = f"area.{row['configuration']}"
        found[f"{name}.array_mm2"] = Figure(row["total_mm2"], "mm2")
        found[f"{name}.column_um2"] = Figure(row["column_um2"], "um2")
        found[f"{name}.column_flip_flops"] = Figure(row["column_flip_flops"])
        found[f"{name}.shared_mm2"] = Figure(f"{float(row['shared_um2']) / 1e6:.4f}", "mm2")
        found[f"{name}.bits_per_pixel"] = Figure(row["bits_per_pixel"], "bits")
    area = tables.page("area.md")
    for row in table_of(area, "Placed"):
        name = f"area.{tables.name(row['read-out, mm2'])}"
        found[f"{name}.placed_mm2"] = Figure(row["placed"], "mm2")
        found[f"{name}.placed_with_scan_and_clock_tree_mm2"] = Figure(row["placed with both"], "mm2")
    for row in table_of(area, "What the area is made of"):
        for part, value in list(row.items())[1:-1]:
            found[f"area.{tables.name(row['read-out, mm2'])}.{tables.name(part)}_mm2"] = Figure(value, "mm2")
    for row in table_of(area, "Signalled clear"):
        found[f"area.{tables.name(row['read-out'])}.signalled_clear_mm2"] = Figure(row["with it"].split()[0], "mm2")
    if costs := re.search(r"status bit an address costs ([\d.]+) um2", area):
        found["area.signalled_clear.status_bit_um2"] = Figure(costs[1], "um2")
    for row in tables.rows("timing.csv"):
        name = f"timing.{row['configuration']}"
        corner = row["corner"].replace(" ", "_")
        found[f"{name}.{corner}_slack_ns"] = Figure(row["slack_330_ns"], "ns")
        if row["fmax_mhz"]:
            found[f"{name}.{corner}_fmax_mhz"] = Figure(row["fmax_mhz"], "MHz")
    return found


def growth(tables: Tables) -> Figures:
    """Figures of points in which one parameter differs."""
    return {f"growth.{tables.name(row['readout'])}.{row['parameter'].lower()}_{row['value'].lower()}_mm2":
            Figure(row["total_mm2"], "mm2") for row in tables.rows("growth.csv")}


def subsystem(tables: Tables) -> Figures:
    """Area and power of dtof_subsystem around each array, and its least setup slack."""
    found: Figures = {}
    for row in tables.rows("subsystem.csv"):
        name = f"subsystem.{row['configuration']}"
        found[f"{name}.around_mm2"] = Figure(row["subsystem_mm2"], "mm2")
        found[f"{name}.share_percent"] = Figure(percent(row["share"]), "%")
        found[f"{name}.line_buffer_mm2"] = Figure(row["line_buffer_mm2"], "mm2")
        found[f"{name}.lines_mw"] = Figure(row["lines_mw"], "mW")
        found[f"{name}.idle_mw"] = Figure(row["idle_mw"], "mW")
        found[f"{name}.slow_setup_with_margins_ns"] = Figure(row["slow_margins_setup_ns"], "ns")
    return found


def power(tables: Tables) -> Figures:
    """Power while acquisitions stream in."""
    found: Figures = {}
    for row in tables.rows("power.csv"):
        if row["phase"] != "streaming":
            continue
        name = f"power.{row['configuration']}.{row['light']}"
        found[f"{name}_mw"] = Figure(row["total_mw"], "mW")
        for part in ("columns", "engines", "control", "sram", "clock", "leakage"):
            found[f"{name}_{part}_mw"] = Figure(row[f"{part}_mw"], "mW")
        found[f"{name}_frame_mj"] = Figure(row["frame_mj"], "mJ")
    return found


def frame(tables: Tables) -> Figures:
    found: Figures = {}
    for row in tables.rows("frame/summary.csv"):
        name = f"frame.{tables.name(row['read-out'])}"
        found[f"{name}.above_3_percent"] = Figure(row["above 3 %"].removesuffix(" %"), "%")
        found[f"{name}.above_10_percent"] = Figure(row["above 10 %"].removesuffix(" %"), "%")
        found[f"{name}.rmse_mm"] = Figure(row["rmse mm"], "mm")
        found[f"{name}.cycles"] = Figure(row["cycles"], "clocks")
    return found


def frames(tables: Tables) -> Figures:
    """Figures of the standard frames, by sensor."""
    found: Figures = {}
    for row in tables.rows("frames.csv"):
        for limit in ("3", "10"):
            found[f"frames.{tables.name(row['read-out'])}.{tables.name(row['sensor'])}_above_{limit}_percent"] = Figure(
                percent(row[f"above_{limit}_percent"]), "%",
                (percent(row[f"above_{limit}_low"]), percent(row[f"above_{limit}_high"])))
    return found


def pareto(tables: Tables) -> Figures:
    """Everything that the plot of area against accuracy shows."""
    found: Figures = {}
    for row in tables.rows("pareto.csv"):
        name = f"pareto.{tables.name(row['title'])}"
        found[f"{name}.mm2"] = Figure(row["mm2"], "mm2")
        found[f"{name}.bits_per_pixel"] = Figure(row["bits_per_pixel"], "bits")
        for light in ("indoor", "outdoor"):
            found[f"{name}.{light}_above_3_percent"] = Figure(percent(row[f"{light}_above_3_percent"]), "%")
            found[f"{name}.{light}_rmse_percent"] = Figure(percent(row[f"{light}_relative_rmse"]), "%")
    return found


QUOTED_SCENES = {("room", "14"), ("flat 1 m", "14"), ("flat 5 m", "14"), ("flat 5 m", "2")}
QUOTED_ESTIMATORS = ("histogram", "matched filter (single pixel)")


def scenes(tables: Tables) -> Figures:
    """Figures of the preset `thesis` from the table of scenes."""
    found: Figures = {}
    for row in tables.rows("scenes.csv"):
        if next(iter(row.values())) == "thesis" and (row["scene"], row["klux"]) in QUOTED_SCENES \
                and row["estimator"] in QUOTED_ESTIMATORS:
            name = f"scenes.{tables.name(row['estimator'])}.{tables.name(row['scene'])}_{row['klux']}_klux"
            for limit in ("3", "10"):
                found[f"{name}_above_{limit}_percent"] = Figure(percent(row[f"above_{limit}_percent"]), "%")
    return found


def reproduction(tables: Tables) -> Figures:
    """Share of events lost to pile-up at near targets."""
    here = {row["thesis"]: row["here"] for row in tables.rows("reproduction.csv")}["Fig. 2.4"]
    lost = re.match(r"lost: ([\d.]+) % and ([\d.]+) %", here)
    if lost is None:
        raise KeyError(f"reports/reproduction.csv: Fig. 2.4 says '{here}', not what pile-up takes")
    return {"reproduction.pile_up.lost_at_0_2_m_percent": Figure(lost[1], "%"),
            "reproduction.pile_up.lost_at_0_5_m_percent": Figure(lost[2], "%")}


QUOTED_RIVALS = {"32-bin histogram": "histogram_of_32_bins"}  # and their names as figures
POOL_COLUMNS = {("held surface", "50"): ("edge_above_3_percent",), ("flat 5 m", "100"): ("above_10_percent",)}


def rivals(tables: Tables) -> Figures:
    """Figures over all scenes except the flat ones, for the read-outs and the references."""
    found: Figures = {}
    for row in tables.rows("data/rivals.csv.gz"):
        if row["scene"] == "all" and (row["kind"] != "rival" or row["estimator"] in QUOTED_RIVALS):
            name = QUOTED_RIVALS.get(row["estimator"]) or tables.name(row["estimator"])
            for column in ("above_3_percent", "above_10_percent", "single_above_10_percent"):
                found[f"rivals.{name}.at_{row['klux']}_klux_{column}"] = \
                    Figure(percent(row[column]), "%", interval(row, column))
    return found


def pool(tables: Tables) -> Figures:
    """Figures of the scenes with most errors."""
    found: Figures = {}
    for row in tables.rows("pool.csv"):
        name = f"pool.{tables.name(row['estimator'])}.{tables.name(row['scene'])}_at_{row['klux']}_klux"
        columns = POOL_COLUMNS.get((row["scene"], row["klux"]), ())
        found |= {f"{name}_{column}": Figure(percent(row[column]), "%", interval(row, column)) for column in columns}
    return found


def fault_metrics(tables: Tables) -> Figures:
    """Shares of detected faults and the metrics of ISO 26262, of single events and of stuck-at faults."""
    found: Figures = {}
    columns = {"harmful, %": "harmful", "detected of them, %": "detected", "of those in logic, %": "detected_in_logic",
               "beyond 3 %, %": "detected_beyond_3", "SPFM, %": "spfm", "LFM, %": "lfm"}
    for row in table_of(tables.page("fault_metrics.md"), "Metrics"):
        name = tables.name(row["read-out"]) + ("_parity" if row["parity"] == "yes" else "")
        life = "event" if row["fault"] == "single event" else "stuck"
        for column, figure in columns.items():
            if cell := re.fullmatch(r"([\d.]+) \(([\d.]+) to ([\d.]+)\)", row[column]):
                found[f"fault_metrics.{name}.{life}_{figure}"] = Figure(cell[1], "%", (cell[2], cell[3]))
    return found


MAKERS: dict[str, Callable[[Tables], Figures]] = {
    "synth": synth, "growth": growth, "subsystem": subsystem, "power": power, "frame": frame, "frames": frames, "pareto": pareto, "scenes": scenes,
    "reproduction": reproduction, "rivals": rivals, "pool": pool,
    "fault_metrics": fault_metrics}


def figures(root: Path, report: str) -> Figures:
    """The figures in the report's present files; empty if no page quotes them."""
    make = MAKERS.get(report)
    return make(Tables(root)) if make else {}
