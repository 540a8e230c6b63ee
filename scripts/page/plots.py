# SPDX-License-Identifier: Apache-2.0
"""Data of the live plots: figures of reports/figures.json, and for what is not a figure there, the tables under reports/.

plots.js draws what is written here. A plot has rows; a row is a read-out at a light, with a value of each measure. Every plot names the report
that measured it: command, digest of the inputs, commit (reports/digests.json)."""

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import plot_style
from dtof_synth import readouts
from figures import staleness, store
from figures.reports import LIST, inputs, load
from figures.source_tree import SourceTree
from figures.tables import Tables

FILE = "plots_data.js"
ABOVE_3, ABOVE_10, RMSE = "off by more than 3 %", "off by more than 10 %", "relative rmse"
LIGHTS = {"indoor": 14, "outdoor": 50}  # klux, as scripts/pareto.py has them
TOGETHER = "all but the flat targets"
QUOTED_SENSOR = "thesis"  # the sensor of the figures of scenes
UNKNOWN_COLOUR, UNKNOWN_MARKER = "#555555", 7  # a title that no list of styles has

Value = tuple[float, float | None, float | None]  # in per cent, and the ends of its interval at 95 %


@dataclass
class Row:
    label: str  # title of the read-out, or of its variant
    light: int  # klux
    x: float | str
    values: dict[str, Value]  # by measure
    at: dict[str, str] = field(default_factory=dict)  # by choice
    note: str = ""  # what else the plot says of it
    figures: dict[str, str] = field(default_factory=dict)  # by measure, the name in reports/figures.json
    small: bool = False  # a variant


@dataclass
class Plot:
    name: str
    title: str
    says: str
    report: str  # name of the report, whose command made the figures
    table: str  # under reports/
    kind: str  # points: x is a number; lines: over light; rows: x is a word
    x_title: str
    measures: tuple[str, ...]
    picture: str = ""  # under reports/, shown where the plot is not live
    command: str = ""
    inputs: str = ""  # digest of what the report was measured on
    commit: str = ""
    stale: tuple[str, ...] = ()
    rows: list[Row] = field(default_factory=list)

    @property
    def source(self) -> str:
        """The file that has every point of the plot."""
        return store.FILE if self.rows and all(set(self.measures) <= row.figures.keys() for row in self.rows) else f"reports/{self.table}"


class Titles:
    """Titles of the read-outs by their names in tables, and the marker of each title."""

    def __init__(self) -> None:
        self.styles = plot_style.load()
        self.titles = {re.sub(r"\W", "", style.title.lower()): style.title for style in self.styles}
        self.titles |= {name: readout.title for name, readout in readouts.load().readouts.items()}

    def title(self, name: str) -> str:
        return self.titles.get(name, name)

    def family(self, label: str) -> str:
        try:
            return plot_style.style(label, self.styles).title
        except SystemExit:
            return label

    def marks(self, families: set[str]) -> list[dict[str, object]]:
        known = [{"title": style.title, "colour": style.colour, "marker": style.marker} for style in self.styles if style.title in families]
        others = sorted(families - {style.title for style in self.styles})
        return known + [{"title": title, "colour": UNKNOWN_COLOUR, "marker": UNKNOWN_MARKER} for title in others]


def rows_of(root: Path, name: str) -> list[dict[str, str]]:
    return Tables(root).rows(name) if (root / "reports" / name).is_file() else []


class Figures:
    """reports/figures.json, where a page's value stands once."""

    def __init__(self, root: Path) -> None:
        self.known, self.tables = store.load(root), Tables(root)

    def number(self, name: str) -> float:
        return float(self.known[name].value)

    def values(self, names: dict[str, str]) -> tuple[dict[str, Value], dict[str, str]]:
        """Value and name of each measure that has a figure."""
        found = {measure: name for measure, name in names.items() if name in self.known}
        return {measure: (self.number(name), None, None) for measure, name in found.items()}, found


# ---- Plots -----------------------------------------------------------------------------------------------

def area(root: Path, _titles: Titles) -> Iterator[Row]:
    """Rows of figures alone; the table has the titles."""
    figures = Figures(root)
    for row in rows_of(root, "pareto.csv"):
        name = f"pareto.{figures.tables.name(row['title'])}"
        for light, klux in LIGHTS.items():
            values, names = figures.values({ABOVE_3: f"{name}.{light}_above_3_percent", RMSE: f"{name}.{light}_rmse_percent"})
            if not values or f"{name}.mm2" not in figures.known:
                continue
            mm2 = figures.number(f"{name}.mm2")
            yield Row(row["title"], klux, mm2, values, note=f"{mm2:.2f} mm2, {figures.known[f'{name}.bits_per_pixel'].value} bits a pixel",
                      figures=names, small=row["variant"] == "1")


def scenes(root: Path, _titles: Titles) -> Iterator[Row]:
    """Rows for each scene, and for all scenes except the flat ones, weighted by pixels."""
    measured = rows_of(root, "scenes.csv")
    columns = {ABOVE_3: "above_3_percent", ABOVE_10: "above_10_percent"}
    together: dict[tuple[str, str, str], list[dict[str, str]]] = {}
    for row in measured:
        if not row["scene"].startswith("flat"):
            together.setdefault((row["sensor"], row["klux"], row["estimator"]), []).append(row)
    values: dict[str, Value]
    for (sensor, klux, estimator), rows in together.items():
        pixels = sum(int(row["pixels"]) for row in rows)
        values = {measure: (100 * sum(int(row["pixels"]) * float(row[column]) for row in rows) / pixels, None, None)
                  for measure, column in columns.items()}
        square = sum(int(row["pixels"]) * float(row["relative_rmse"]) ** 2 for row in rows) / pixels
        yield Row(estimator, int(klux), int(klux), values | {RMSE: (100 * square ** 0.5, None, None)},
                  {"scene": TOGETHER, "sensor": sensor}, f"{TOGETHER}, sensor {sensor}, {pixels} pixels")
    figures = Figures(root)
    for row in measured:
        values = {measure: (100 * float(row[column]), None, None) for measure, column in (columns | {RMSE: "relative_rmse"}).items()}
        name = f"scenes.{figures.tables.name(row['estimator'])}.{figures.tables.name(row['scene'])}_{row['klux']}_klux"
        quoted, names = figures.values({measure: f"{name}_{column}" for measure, column in (
            (ABOVE_3, "above_3_percent"), (ABOVE_10, "above_10_percent"))} if row["sensor"] == QUOTED_SENSOR else {})
        yield Row(row["estimator"], int(row["klux"]), int(row["klux"]), values | quoted, {"scene": row["scene"], "sensor": row["sensor"]},
                  f"{row['scene']}, sensor {row['sensor']}, {row['pixels']} pixels", names)


def hostile(root: Path, titles: Titles) -> Iterator[Row]:
    for row in rows_of(root, "data/hostile_scenes.csv.gz"):
        yield Row(titles.title(row["readout"]), int(row["klux"]), row["condition"],
                  {ABOVE_3: interval(row, "above_3"), ABOVE_10: interval(row, "above_10")}, note=f"{row['pixels']} pixels with a target")


def dynamic_range(root: Path, titles: Titles) -> Iterator[Row]:
    """Rows for one signal and one light level at a time; first the thesis's by day."""
    rows = [row for row in rows_of(root, "data/dynamic_range.csv.gz") if row["part"] == "grid"]
    rows.sort(key=lambda row: (row["signal"] != "1", float(row["signal"]), row["klux"] != "14", int(row["klux"]), int(row["acquisitions"])))
    for row in rows:
        yield Row(titles.title(row["readout"]), int(row["klux"]), int(row["acquisitions"]),
                  {ABOVE_3: interval(row, "above_3"), ABOVE_10: interval(row, "above_10")},
                  {"signal": f"{row['signal']} x", "light": f"{row['klux']} klux"},
                  f"{row['acquisitions']} acquisitions, signal {row['signal']} x, {row['pixels']} pixels")


def interval(row: dict[str, str], name: str) -> Value:
    return 100 * float(row[f"{name}_percent"]), 100 * float(row[f"{name}_low"]), 100 * float(row[f"{name}_high"])


PLOTS: tuple[tuple[Plot, Callable[[Path, Titles], Iterator[Row]]], ...] = (
    (Plot("area", "Area against accuracy", "All scenes except flat targets, sensor thesis. Small marks are variants of a read-out.",
          "pareto", "pareto.csv", "points", "area of 200 x 160 pixels, mm2", (ABOVE_3, RMSE), "pareto.svg"), area),
    (Plot("light", "Errors over light", "Each read-out on all scenes together or on one of them, from dusk to bright sun.",
          "scenes", "scenes.csv", "lines", "background light, klux", (ABOVE_3, ABOVE_10, RMSE)), scenes),
    (Plot("hostile", "Hostile conditions", "Glass, fog, other lasers, motion and skew; bars are intervals at 95 %. \"told\" in a label: the user has "
          "set the read-out's parameters for the sensor and its surroundings.",
          "hostile_scenes", "data/hostile_scenes.csv.gz", "rows", "", (ABOVE_3, ABOVE_10)), hostile),
    (Plot("acquisitions", "Errors over acquisitions", "Does a longer frame, or more light, make a read-out worse? The signal is a "
          "multiple of the thesis's signal.",
          "dynamic_range", "data/dynamic_range.csv.gz", "lines", "acquisitions of a frame", (ABOVE_3, ABOVE_10)), dynamic_range),
)


def stale_lines(root: Path) -> dict[str, tuple[str, ...]]:
    """For each report, the marks of stale reports among it and the reports whose files it reads."""
    if not (root / LIST).is_file():
        return {}
    listed, tree, known = load(root), SourceTree(root), staleness.measured(root)
    own = {name: staleness.compared(report, known.get(name), inputs(report, tree)) for name, report in listed.items()}

    def chain(name: str) -> list[str]:
        above = [one for other in listed[name].after for one in chain(other)]
        return list(dict.fromkeys([*above, name]))

    def said(name: str, one: staleness.Stale) -> str:
        return f"{name}: {one.line.removeprefix('> ')}".replace("this page", "these figures").replace("`", "")

    return {name: tuple(said(one, stale) for one in chain(name) if (stale := own[one])) for name in listed}


def collect(root: Path) -> tuple[list[Plot], Titles]:
    titles, stale, measured = Titles(), stale_lines(root), staleness.measured(root)
    commands = {name: report.command for name, report in load(root).items()} if (root / LIST).is_file() else {}
    found = []
    for plot, rows in PLOTS:
        known = measured.get(plot.report, staleness.Measured("", {}))
        found.append(replace(plot, command=commands.get(plot.report, ""), inputs=known.digest, commit=known.commit,
                             stale=stale.get(plot.report, ()), rows=list(rows(root, titles))))
    return found, titles


def as_script(plots: list[Plot], titles: Titles) -> str:
    """The data as a script, because a page opened from a disk can load scripts but no other files."""
    families = {titles.family(row.label) for plot in plots for row in plot.rows}
    data = {"readouts": titles.marks(families), "lights": sorted({row.light for plot in plots for row in plot.rows}), "plots": [
        {"name": plot.name, "title": plot.title, "kind": plot.kind, "xTitle": plot.x_title, "report": plot.report, "command": plot.command,
         "inputs": plot.inputs, "commit": plot.commit, "stale": plot.stale, "table": f"reports/{plot.table}", "measures": plot.measures, "choices": choices(plot),
         "rows": [as_entry(plot, row, titles) for row in plot.rows]} for plot in plots]}
    return f"window.plotsData = {json.dumps(data, ensure_ascii=False, separators=(',', ':'))};\n"


def as_entry(plot: Plot, row: Row, titles: Titles) -> dict[str, object]:
    """A row as JSON, without empty values."""
    entry = {"label": row.label, "readout": titles.family(row.label), "light": row.light, "x": row.x, "at": row.at, "note": row.note,
             "figures": [row.figures.get(measure, "") for measure in plot.measures] if row.figures else [], "small": row.small,
             "values": [[None if end is None else round(end, 6) for end in row.values[measure]] for measure in plot.measures]}
    return {key: value for key, value in entry.items() if value not in ("", {}, [], False) or key == "x"}


def choices(plot: Plot) -> dict[str, list[str]]:
    found: dict[str, dict[str, None]] = {}
    for row in plot.rows:
        for name, value in row.at.items():
            found.setdefault(name, {})[value] = None
    return {name: list(values) for name, values in found.items()}
