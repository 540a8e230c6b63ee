# SPDX-License-Identifier: Apache-2.0
"""One configuration from RTL to numbers: synthesis, fan-out trees, timing in both corners, power."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable
from dataclasses import astuple, dataclass, field, replace
from pathlib import Path

from . import (endpoints, floorplan, loads, netlist, power, same_logic, spef, sram_kit, sram_model, stand_in,
               standard_cells, timing, tools, verilog)
from .configuration import Configuration, bits_per_pixel, counted_macros, engine_memories, memories, shared_memories
from .errors import FlowError, given
from .library import Library
from .mapping import efforts, elaborate, map_to_cells
from .netlist import Counts
from .power import ClockTree, Power
from .technology import TARGET_MHZ, Technology
from .timing import Margin, Timing

RESIZED_COLUMNS = 10  # that resizing looks at where there are no engines
KEPT_COLUMNS = 3  # the first, its neighbour and the last
RESIZE_ROUNDS = 3  # a stand-in's load cells weigh what they did before resizing
POOL_RESIZE_ROUNDS = 6  # each examines one engine
RESIZE_GUARD_NS = 0.004  # of slack that resizing leaves for that
HOLD_ROUNDS = 4  # in which paths that are too early get buffers
CLOSING_ROUNDS = 2  # hold buffers may take more than what resizing has left
HOLD_BUFFER_NS = 0.0169  # what one of them adds in the fast corner, 0.014 to 0.021; too little adds a round
HOLD_BUFFER_SLOW_NS = 0.12  # at most, in the slow corner with margins
DEMANDED_SLACK_NS = 0.1  # of a mapping in the slow corner: wires and a clock tree are still to come
FINISHED_COLUMN = "finished_column.json"  # in the folder of a run
BOTH_CORNERS = ("typical", "slow")
WIRES = {"typical": floorplan.TYPICAL, "slow": floorplan.PESSIMISTIC, "fast": floorplan.TYPICAL}


def _area(used: dict[str, sram_model.Size]) -> float:
    return sum(sram_model.macro(size).area for size in used.values())


@dataclass(frozen=True)
class Result:
    """Figures of one configuration. Areas in um2."""

    configuration: Configuration
    column_module: Counts
    shared: Counts  # engines included
    engines: Counts  # all of them
    clock_tree: ClockTree
    nand2_area: float
    mux2_area: float
    timing: dict[str, Timing]
    power: Power | None = None
    margins: dict[str, Margin] = field(default_factory=dict)
    effort: int = 0  # the number of the effort that was taken
    ends: endpoints.Endpoints | None = None  # of paths, in the netlist that was timed
    fullest_load: loads.Load | None = None  # the nearest to its limit
    sram_area: float = field(init=False)  # of a column
    engine_sram_area: float = field(init=False)  # of all engines
    shared_sram_area: float = field(init=False)  # beside columns and engines

    def __post_init__(self) -> None:
        object.__setattr__(self, "sram_area",
                           _area(memories(self.configuration)) / self.configuration.module_columns)
        object.__setattr__(self, "engine_sram_area",
                           self.configuration.engines * _area(engine_memories(self.configuration)))
        object.__setattr__(self, "shared_sram_area", _area(shared_memories(self.configuration)))

    @property
    def columns(self) -> int:
        return self.configuration["SRAM_NUM"]

    @property
    def column(self) -> Counts:
        return self.column_module.share(self.configuration.module_columns)

    @property
    def total_mm2(self) -> float:
        """Area of columns, shared logic and engines, mm2. The clock tree is an estimate and reported separately."""
        return ((self.column.area + self.sram_area) * self.columns + self.shared.area + self.engine_sram_area + self.shared_sram_area) / 1e6

    @property
    def bits_per_pixel(self) -> float:
        return bits_per_pixel(self.configuration)

    def kge(self, area: float) -> float:
        return area / self.nand2_area / 1000


def _resize_settings(folder: Path, library: Library, guard_ns: float = RESIZE_GUARD_NS,
                     shrinkable: Iterable[tuple[str, str]] = (), dispensable: Iterable[netlist.Dispensable] = ()) -> dict[str, tools.Setting]:
    """Settings for the step `resize` of synth/sta/timing.tcl."""
    return {**json.loads((folder / timing.BLOCKS).read_text(encoding="utf-8")), "drives": library.drives,
            "cell_areas": library.area, "guard": f"{guard_ns}", "shrinkable": [list(gate) for gate in shrinkable],
            "buffer_pins": [library.buffers[0].input_pin, library.buffers[0].output_pin],
            "dispensable": [list(astuple(one)) for one in dispensable]}


@dataclass(frozen=True)
class Resized:
    """Result of resizing."""

    changed: bool
    slack: float  # with margins, of the engine that was examined and its columns, ns


_PLACE = re.compile(r"\bg_(quad|engine)\[(\d+)\]")  # in the name of an end of a path
STAND_IN_LIBERTY = "stand_in.lib"  # in the folder of a netlist


@dataclass(frozen=True)
class _Netlist:
    """A netlist to be timed: the design, the positions of its cells, and the folder of its files. OpenSTA reads it with stand-ins for all
    columns except `real`."""

    design: dict
    plan: floorplan.Floorplan
    configuration: Configuration
    technology: Technology
    folder: Path
    mapped: same_logic.Logic  # before trees, copies, hold buffers and other drives
    called: dict[str, dict[str, str]] = field(default_factory=dict)  # what cells were called before `prepare`
    real: list[str] = field(default_factory=list)
    written: dict = field(default_factory=dict)  # the design as OpenSTA reads it
    cut: set[str] = field(default_factory=set)  # pins in it of which real columns have the paths

    def prepare(self) -> None:
        """Gives cells plain names, gives them enough drive for the wires between blocks, and selects the real columns: the first ones and
        the last. Writes the cells' previous names."""
        self.folder.mkdir(exist_ok=True)
        self.called.update(spef.plain_names(self.design))
        self.plan.rename(self.called[self.configuration.top])
        names = {plain: name for before in self.called.values() for plain, name in before.items()}
        (self.folder / timing.NAMES).write_text(json.dumps(names), encoding="utf-8")
        library = self.technology.slow
        loads.strengthen(self.design, self.plan, library, floorplan.pin_load(library, sram_kit.PIN_FF))
        columns = sorted(netlist.columns(self.design), key=lambda name: self.plan[name])
        self.real.extend(columns if len(columns) <= KEPT_COLUMNS else [*columns[:KEPT_COLUMNS - 1], columns[-1]])
        self.write()

    def write(self) -> None:
        """Writes the files that OpenSTA reads. The wires between blocks name nets, so the netlist is written after them."""
        timed, stand = self._write(None)
        self.written.clear()
        self.written.update(timed)
        self.cut.clear()
        self.cut.update(f"{name}/{pin}" for name in netlist.columns(self.design) if name not in self.real for pin in stand.cut)

    def _write(self, bordered: list[str] | None) -> tuple[dict, stand_in.StandIn]:
        """Writes the netlist with stand-ins by stand_in.timed."""
        library = self.technology.slow
        timed, stand = stand_in.timed(self.design, self.real, library, floorplan.pin_load(library, sram_kit.PIN_FF), bordered)
        (self.folder / STAND_IN_LIBERTY).write_text(stand_in.liberty(stand, self.technology.typical.voltage), encoding="utf-8")
        self.write_wires(timed)
        (self.folder / "timing.v").write_text(verilog.write(timed), encoding="utf-8")
        copies = dict(zip(self._kinds(), (self.configuration.column_modules, self.configuration.engines)))
        instances: dict[str, list[str]] = {}
        for name, cell in netlist.top(timed)["cells"].items():
            instances.setdefault(cell["type"], []).append(name)
        column = netlist.column_module(self.design)
        (self.folder / timing.BLOCKS).write_text(json.dumps({
            "blocks": [item for kind in self._kinds() for item in (kind, instances[kind], copies[kind])],
            "stand_ins": [column, instances.get(netlist.STUB, []), list(stand.module["cells"])]}), encoding="utf-8")
        return timed, stand

    def _kinds(self) -> list[str]:
        """Modules of the blocks: the column's, and the engine's if there are engines."""
        return [kind for kind in (netlist.column_module(self.design), netlist.engine_module(self.design)) if kind]

    def _columns_of(self, engine: int) -> list[str]:
        """Column modules with columns that share an engine; without engines the first ones."""
        first = engine * self.configuration.engine_columns
        end = first + (self.configuration.engine_columns or RESIZED_COLUMNS)
        modules = slice(first // self.configuration.module_columns, -(-end // self.configuration.module_columns))
        return sorted(netlist.columns(self.design), key=lambda name: self.plan[name])[modules]

    def engine_of(self, margin: Margin) -> int:
        """Engine at the slowest path, by the names of its ends; 0 if neither says one."""
        for end in (margin.end, margin.start):
            if place := _PLACE.search(end):
                return int(place[2]) if place[1] == "engine" else int(place[2]) * self.configuration.module_columns // self.configuration.engine_columns
        return 0

    def write_wires(self, timed: dict) -> None:
        """Writes the wires between blocks for all corners."""
        clocks = netlist.clock_nets(netlist.top(timed))
        kinds = list(dict.fromkeys(WIRES.values()))
        texts = dict(zip(kinds, spef.write(timed, self.plan, self.technology.slow, kinds, clocks)))
        for corner, kind in WIRES.items():
            (self.folder / f"wires_{corner}.spef").write_text(texts[kind], encoding="utf-8")

    def time(self, corner: str, *steps: str, **settings: tools.Setting) -> timing.Report:
        """Runs the steps of synth/sta/timing.tcl in one corner, with their settings. FlowError if an end of a path is not timed for none of
        the reasons in endpoints.py."""
        library = self.technology.library(corner)
        files = timing.Netlist(
            f"{self.configuration.name}, {corner} corner", self.folder / "timing.v", self.folder / f"wires_{corner}.spef",
            [library.path, self.technology.kit / f"sram40_{corner}.lib", self.folder / STAND_IN_LIBERTY],
            library.wire_load, self.configuration.top)
        if "nominal" in steps:
            steps = ("check", *steps)
        report = timing.measure(files, self.technology.root, self.technology.target_mhz,
                                self.folder / f"sta_{'resize' if 'resize' in steps else corner}.log", steps,
                                {"measured_column": self.real[0], **settings})
        if "check" in steps:
            self.endpoints(report)
        return report

    def endpoints(self, report: timing.Report) -> endpoints.Endpoints:
        """Judges the ends of paths in a report that includes the step `check`."""
        return endpoints.judge(self.configuration.name, report.unchecked, self.written, self.technology.slow, self.cut)

    def resize(self, again: bool, guard_ns: float = RESIZE_GUARD_NS, engine: int = 0) -> Resized:
        """Resizes gates in the slow corner with margins. Gates on failing paths get more drive. Except with `again`, other gates get less
        drive, and mapping buffers that no path needs are removed. Only one engine with its columns is examined, because each trial is
        timed anew. `guard_ns`: target slack there, since other engines may have less."""
        library = self.technology.slow
        self._write(self._columns_of(engine))
        kinds = self._kinds()
        pin_load = floorplan.pin_load(library, sram_kit.PIN_FF)
        shrinkable: list[tuple[str, str]] = []
        dispensable: list[netlist.Dispensable] = []
        if not again:
            dispensable, carried = netlist.dispensable_buffers(self.design, library, kinds, pin_load)
            for kind, nets in loads.between_blocks(self.design, self.plan, library, pin_load).items():
                module = netlist.top(self.design) if kind == netlist.TOP else netlist.modules(self.design)[kind]
                inside = carried.setdefault(kind, {net: netlist.load_of(sinks) for net, sinks in netlist.sinks_of(
                    module, pin_load, library.wire_ff_per_sink).items()})
                inside |= {net: max(ff, inside.get(net, 0.0)) for net, ff in nets.items()}
            shrinkable = netlist.shrinkable(self.design, library, [*kinds, netlist.TOP], pin_load, carried)
        report = self.time("slow", "resize", **_resize_settings(self.folder, library, guard_ns, shrinkable, dispensable))
        netlist.resize(self.design, library, report.resized)
        netlist.drop_buffers(self.design, library, report.dropped)
        self.write()
        return Resized(bool(report.resized or report.dropped), report.resized_slack)

    def early_pins(self, report: timing.Report) -> list[str]:
        """Pins of paths that are too early, in all blocks of a kind."""
        pins = {netlist.local_pin(self.design, pin) for path in report.early for pin in path.pins}
        return [name for pin in sorted(pins) for name in netlist.in_all_blocks(self.design, pin)
                if netlist.has_pin(self.written, name)]

    def fix_hold(self, report: timing.Report, slacks: dict[str, float]) -> Margin:
        """Delays paths that are too early in the fast corner with margins, in at most HOLD_ROUNDS rounds; returns that corner. `report`:
        report of that corner before; `slacks`: slacks of pins in the slow corner."""
        spare: dict[Pin, float] = {}
        for name, slack in slacks.items():
            pin = netlist.local_pin(self.design, name)
            spare[pin] = min(slack, spare.get(pin, math.inf))
        for _ in range(HOLD_ROUNDS):
            if not report.early:
                break
            buffers: dict[Pin, int] = {}
            for path in report.early:
                needed = math.ceil(-path.slack / HOLD_BUFFER_NS)
                pin = _last_free_pin([netlist.local_pin(self.design, pin) for pin in path.pins], spare, needed)
                buffers[pin] = max(buffers.get(pin, 1), needed)
            for pin, added in buffers.items():
                spare[pin] = spare.get(pin, 0.0) - added * HOLD_BUFFER_SLOW_NS
            beside = netlist.delay_pins(self.design, buffers, self.technology.slow)
            self.plan.places |= {name: self.plan[cell] for name, cell in beside.items()}
            self.write()
            report = self.time("fast", "margins", "early")
        return report.margin()

    def check_logic(self) -> None:
        """FlowError unless the design computes the mapped logic."""
        try:
            same_logic.check(self.mapped, same_logic.of(self.design, self.technology.slow, self.called))
        except FlowError as error:
            raise FlowError(f"{self.configuration.name}: {error}") from None

    def finished_column(self) -> dict:
        """The column module of the array with its final gates and hold buffers."""
        return netlist.modules(self.design)[netlist.column_module(self.design)]

    def counts(self) -> tuple[Counts, Counts, Counts]:
        """Cells of a column module, of everything shared, and of the engines in the shared part."""
        library = self.technology.slow
        return (netlist.count(self.finished_column(), library),
                netlist.count_shared(self.design, library), netlist.count_engines(self.design, library))

    def cell_area(self) -> float:
        """Area of the whole array's cells in um2, without macros."""
        column, shared, _ = self.counts()
        return column.area * self.configuration.column_modules + shared.area


Pin = tuple[str, str, str]  # kind of block, cell, pin


def _last_free_pin(path: list[Pin], spare: dict[Pin, float], buffers: int) -> Pin:
    """The last pin of an early path whose slack allows the delay of `buffers` buffers; if none does, the pin with the largest slack. An
    unknown pin has no slack."""
    return next((pin for pin in reversed(path) if spare.get(pin, 0.0) >= buffers * HOLD_BUFFER_SLOW_NS),
                max(path, key=lambda pin: spare.get(pin, 0.0)))


@dataclass(frozen=True)
class _Attempt:
    """A design mapped with one effort and timed in the slow corner."""

    netlist: _Netlist
    effort: int
    slack: float
    margin: Margin | None  # where the technology has a fast corner, too
    early: timing.Report | None = None  # of the fast corner
    spare: dict[str, float] = field(default_factory=dict)  # what the pins of paths that are too early there have in the slow one
    overloaded: int = 0  # drivers whose load exceeds its limit

    @property
    def closes_with_margins(self) -> bool:
        return self.rank >= 0 and not self.overloaded

    @property
    def rank(self) -> float:
        """The smaller of slack - DEMANDED_SLACK_NS and the slack with margins, ns. Timing closes if it is at least 0."""
        return min(self.slack - DEMANDED_SLACK_NS, self.margin.slack if self.margin is not None else math.inf)


def _timed(timed: _Netlist, effort: int, rounds: int = RESIZE_ROUNDS) -> _Attempt:
    if timed.technology.fast is None:
        return _Attempt(timed, effort, timed.time("slow", "nominal").slack, None)
    guard_ns, engine = RESIZE_GUARD_NS, 0
    for number in range(rounds):
        resized = timed.resize(number > 0, guard_ns, engine)
        if number > 0 and not resized.changed:
            break
        early = timed.time("fast", "margins", "early")
        report = timed.time("slow", "nominal", "margins", "spare", pins=timed.early_pins(early))
        if report.margin().slack >= 0:
            break
        late = timed.engine_of(report.margin())
        # The whole array may have less slack at this engine than the part that was examined.
        guard_ns = RESIZE_GUARD_NS + (max(resized.slack - report.margin().slack, 0.0) if late == engine else -report.margin().slack)
        engine = late
    return _Attempt(timed, effort, report.slack, report.margin(), early, report.spare)


def _attempt(configuration: Configuration, technology: Technology, folder: Path, number: int, naming: int) -> _Attempt:
    design = map_to_cells(configuration, technology, folder, efforts(configuration)[number], naming)
    library = technology.slow
    mapped = same_logic.of(design, library)
    plan = floorplan.finish(design, library, sram_kit.PIN_FF, configuration)
    try:
        floorplan.check_borders(design, library)
    except FlowError as error:
        raise FlowError(f"{configuration.name}: {error}") from None
    timed = _Netlist(design, plan, configuration, technology, folder / f"effort{number}", mapped)
    timed.prepare()
    attempt = _timed(timed, number, POOL_RESIZE_ROUNDS if configuration.is_pool else RESIZE_ROUNDS)
    all_loads = loads.of_all(timed.design, timed.plan, library, floorplan.pin_load(library, sram_kit.PIN_FF))
    return replace(attempt, overloaded=sum(load.is_too_much for load in all_loads))


def _attempts(configuration: Configuration, technology: Technology, folder: Path, most: int | None, naming: int) -> list[_Attempt]:
    """Attempts with increasing effort until one closes and has no overloaded driver."""
    attempts: list[_Attempt] = []
    for number in range(len(efforts(configuration)[:most])):
        attempts.append(_attempt(configuration, technology, folder, number, naming))
        if attempts[-1].closes_with_margins:
            break
    return attempts


def _best(attempts: list[_Attempt]) -> _Attempt:
    """The smallest attempt that closes, else the one that misses by least, of those without an overloaded driver if there are such."""
    closing = [attempt for attempt in attempts if attempt.closes_with_margins]
    return min(closing, key=lambda attempt: attempt.netlist.cell_area()) if closing \
        else max(attempts, key=lambda attempt: (not attempt.overloaded, attempt.rank))


def run(configuration: Configuration, technology: Technology, folder: Path,
        corners: Iterable[str] = BOTH_CORNERS, most_attempts: int | None = None, naming: int = 0) -> Result:
    """Runs the whole flow of one configuration. FlowError at the first step that fails. The slow corner is always timed. Efforts increase
    until it closes with DEMANDED_SLACK_NS and with margins; if none does, the best attempt counts."""
    elaborate(configuration, technology, folder)
    best = _best(_attempts(configuration, technology, folder, most_attempts, naming))
    timed = best.netlist
    margins: dict[str, Margin] = {}
    if "typical" in corners and best.margin is not None:
        fast = timed.fix_hold(given(best.early, "the fast corner was not timed"), best.spare)
        slow = timed.time("slow", "nominal", "closing", "margins")
        for _ in range(CLOSING_ROUNDS):
            if slow.margin().slack >= 0 or not timed.resize(
                    True, RESIZE_GUARD_NS - slow.margin().slack, timed.engine_of(slow.margin())).changed:
                break
            fast = timed.fix_hold(timed.time("fast", "margins", "early"), best.spare)
            slow = timed.time("slow", "nominal", "closing", "margins")
        margins = {"slow": slow.margin(), "fast": fast}
    else:
        slow = timed.time("slow", "nominal", "closing")
    timed.check_logic()
    fullest = loads.check(configuration.name, timed.design, timed.plan, technology.slow,
                          floorplan.pin_load(technology.slow, sram_kit.PIN_FF))
    (folder / FINISHED_COLUMN).write_text(json.dumps(timed.finished_column()), encoding="utf-8")
    column_module, shared, engines = timed.counts()
    modules = configuration.column_modules
    macros = sum(number for number, _ in counted_macros(configuration))
    tree = power.clock_tree(
        modules * column_module.clock_sinks + shared.clock_sinks + macros,
        modules * column_module.clock_ff + shared.clock_ff + macros * sram_kit.CLOCK_PIN_FF, technology.slow)
    corner_timing = {"slow": slow.timing()}
    figures: Power | None = None
    if "typical" in corners:
        typical = timed.time("typical", "nominal", "closing", "power")
        corner_timing["typical"] = typical.timing()
        figures = Power(power.logic_mw(typical.output, modules), power.sram_mw(configuration, TARGET_MHZ),
                        power.clock_mw(typical.output, modules, tree, technology.typical, TARGET_MHZ))
    return Result(configuration, column_module, shared, engines, tree, technology.slow.nand2_area,
                  technology.slow.mux2_area, corner_timing, figures, margins, best.effort, timed.endpoints(slow), fullest)


def retimed(result: Result, technology: Technology, folder: Path, cells: Path, srams: Path, log: str, steps: tuple[str, ...], how: str,
            netlist_file: str = "timing.v", settings: dict[str, tools.Setting] | None = None) -> timing.Report:
    """Times the netlist that `run` left in `folder`, in the slow corner with other libraries. `how`: description for error messages."""
    effort = folder / f"effort{result.effort}"
    files = timing.Netlist(f"{result.configuration.name}, slow corner, {how}", effort / netlist_file, effort / "wires_slow.spef",
                           [cells, srams, effort / STAND_IN_LIBERTY], technology.slow.wire_load, result.configuration.top)
    return timing.measure(files, technology.root, technology.target_mhz, effort / log, steps, settings)


@dataclass(frozen=True)
class Flat:
    """Setup slacks with margins in the slow corner, ns: from `run`, and with every column real."""

    with_stand_ins: float
    all_real: float


def flat(result: Result, technology: Technology, folder: Path) -> Flat:
    """Computes the slack of the netlist that `run` left in `folder` in a second way, with every column real. Stand-ins have the names of
    the columns' cells, so the wires are the same."""
    configuration = result.configuration
    effort = folder / f"effort{result.effort}"
    text = (effort / "timing.v").read_text(encoding="utf-8")
    column = json.loads((effort / timing.BLOCKS).read_text(encoding="utf-8"))["blocks"][0]
    real = re.sub(rf"^  {netlist.STUB} (?=\w+ \()", f"  {column} ", text, flags=re.MULTILINE)
    if real == text:
        raise FlowError(f"{configuration.name}: no column has a stand-in")
    (effort / "flat.v").write_text(real, encoding="utf-8")
    report = retimed(result, technology, folder, technology.slow.path, technology.kit / "sram40_slow.lib", "sta_flat.log",
                     ("nominal", "margins"), "all columns real", "flat.v")
    return Flat(result.margins["slow"].slack, report.margin().slack)


@dataclass(frozen=True)
class OtherWires:
    """Setup slacks in the slow corner, ns, with another wire length inside columns, engines and control. For the array as it is: without
    and with margins. For gates resized for these wires: with margins; resizing adds `added_mm2`."""

    slack: float
    with_margins: float
    resized: float
    added_mm2: float


def with_wires(result: Result, technology: Technology, folder: Path, um_per_sink: float) -> OtherWires:
    """Times and resizes the netlist that `run` left in `folder` with wires of this length."""
    effort = folder / f"effort{result.effort}"
    liberty = effort / "slow_wires.lib"
    liberty.write_text(standard_cells.library(standard_cells.SLOW, um_per_sink), encoding="utf-8")

    def time(log: str, steps: tuple[str, ...], **settings: tools.Setting) -> timing.Report:
        return retimed(result, technology, folder, liberty, technology.kit / "sram40_slow.lib", log, steps,
                       f"{um_per_sink:.2f} um of wire per sink", settings=settings)

    report = time("sta_slow_wires.log", ("nominal", "margins"))
    resized = time("sta_resize_wires.log", ("resize",), **_resize_settings(effort, technology.slow))
    return OtherWires(report.slack, report.margin().slack, resized.resized_slack, resized.resized_area / 1e6)
