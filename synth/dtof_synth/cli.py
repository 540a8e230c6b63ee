# SPDX-License-Identifier: Apache-2.0
"""Command line of the synthesis flow."""

from __future__ import annotations

import argparse
import functools
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

from . import batch, budgets, check, configuration, corner_ratios, estimate, estimate_points, gates, goals, growth, namings, \
    part_costs, report, report_inputs, scene_power, signalled_clear, simulation, sram_kit, sram_report, yosys_versions
from . import technology as technologies
from .configuration import Configuration
from .errors import FlowError
from .run import Result, flat
from .technology import TARGET_MHZ, Technology

ROOT = Path(__file__).resolve().parents[2]
BUDGETS = ROOT / "synth" / "budgets.csv"
PDK = ROOT.parent / "shared" / "pdk"
SIMULATION = ROOT / "build" / "simulation"
FLAT = ("ezpointer", "poolpointer", "poolpointer_lean")
FLAT_TOLERANCE_NS = 0.005
Action = Callable[[argparse.Namespace, dict[str, Configuration]], int]


def _say(text: str) -> None:
    print(text, flush=True)


def all_configurations(named: dict[str, Configuration]) -> list[Configuration]:
    """Named configurations and all derived ones, for the list of SRAM sizes."""
    return [*named.values(), *(point for _, _, point in growth.sweep(named)),
            *signalled_clear.configurations(named)]


def _select(named: dict[str, Configuration], names: list[str]) -> dict[str, Configuration]:
    unknown = [name for name in names if name not in named]
    if unknown:
        raise FlowError(f"unknown configuration '{unknown[0]}'; known: {', '.join(named)}")
    return {name: named[name] for name in names} if names else named


def _run(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Runs named configurations. With the generated library and without a selection it also writes reports and checks budgets."""
    started = time.monotonic()
    chosen = _select(named, arguments.configuration)
    foreign = arguments.liberty is not None
    build = ROOT / "build" / "synth"
    more = list(chosen.values()) if arguments.configurations else []
    everything = [] if more else all_configurations(named)
    kit = arguments.liberty.name if foreign else "generic40"
    technology = technologies.prepare(ROOT, build / (f"{kit}_more" if more else kit), everything, arguments.liberty, arguments.liberty_slow,
                                      more=more)
    if foreign and arguments.liberty_slow is None:
        _say("note: no LIBERTY_SLOW: the one library serves both corners")
    full = not foreign and not arguments.configuration
    digest = report_inputs.begin("synth") if full else ""
    jobs = [batch.Job(item) for item in chosen.values()]
    if full:
        jobs += signalled_clear.jobs(named)
    runs = build / (("runs" if not foreign else f"runs_{technology.typical.name}") + ("_more" if more else ""))
    results = batch.run_all(jobs, technology, runs, arguments.jobs, _say)
    main = {name: results[name] for name in chosen}
    _say(report.summary(main))
    if arguments.csv:
        report.write_area_csv(arguments.csv, main)
    for name, result in main.items():
        for corner, timing in result.timing.items():
            if timing.slow_edges:
                _say(f"note: {name}, {corner} corner: {timing.slow_edges} pins beyond max_transition")
    status = 0
    if full:
        status = _write_reports(arguments, named, results, technology, everything, digest)
    elif arguments.strict:
        committed = {name: one for name, one in budgets.read(BUDGETS).items() if name in main}
        status = _gate(arguments, main, goals.check(main), committed, everything=False)
    _say(f"{len(jobs)} configurations in {time.monotonic() - started:.0f} s")
    return status


def _write_reports(arguments: argparse.Namespace, named: dict[str, Configuration], results, technology,
                   everything: list[Configuration], digest: str) -> int:
    reports = ROOT / "reports"
    reports.mkdir(exist_ok=True)
    main = {name: results[name] for name in named}
    found = goals.check(main)
    extra = "\n".join([signalled_clear.section(named, results), report.goals_section(found, gates.read(ROOT / gates.FILE)),
                       "Around the array: [subsystem.md](subsystem.md) (`make synth-subsystem`) has the area of `dtof_subsystem`, and its line "
                       "buffer's share of the array.\n\n"
                       "How cost grows (`make synth-growth`): [growth.csv](growth.csv)\n\n![growth](growth.png)\n"])
    (reports / "area.md").write_text(report.area(main, extra, technology.typical.name, digest), encoding="utf-8")
    (reports / "timing.md").write_text(report.timing(main, technology.typical.name, digest), encoding="utf-8")
    report.write_area_csv(reports / "area.csv", main)
    report.write_timing_csv(reports / "timing.csv", main)
    uses = technologies.needed_sizes(everything)
    (reports / "sram.md").write_text(sram_report.text(uses, set(named), PDK), encoding="utf-8")
    report_inputs.record("synth")
    judged = [*found, *gates.measured(reports / "pool.md")]
    status = _gate(arguments, main, judged, budgets.read(BUDGETS), everything=True)
    _say("reports/area.md, reports/timing.md, reports/sram.md written")
    return status


def _gate(arguments: argparse.Namespace, main: dict[str, Result], found: list[goals.Goal],
          committed: dict[str, budgets.Budget], everything: bool) -> int:
    """Prints failed goals and slacks, and changes against the budgets; returns 1 if they are an error. `everything`: all goals and
    configurations are included."""
    missed, failed = gates.judge([*found, *gates.slacks(main)], gates.read(ROOT / gates.FILE), everything)
    moved = budgets.moved(committed, main)
    for line in [*missed, *(f"budget: {line}" for line in moved)]:
        _say(line)
    if not moved:
        _say("budgets: nothing moved beyond the tolerance")
    return 1 if arguments.strict and (failed or moved) else 0


def _sizes(_: argparse.Namespace, named: dict[str, Configuration]) -> int:
    uses = technologies.needed_sizes(all_configurations(named))
    sram_kit.write_sizes(ROOT / technologies.SIZES, sorted(uses))
    _say(f"{technologies.SIZES}: {len(uses)} sizes")
    return 0


def _growth(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Area over NP, NB, pixels per SRAM and SRAM_NUM."""
    started = time.monotonic()
    build = ROOT / "build" / "synth"
    technology = technologies.prepare(ROOT, build / "generic40", all_configurations(named))
    points = growth.sweep(named)
    bases = {point.name: point for _, _, point in points if point.name in named}
    jobs = [batch.Job(item) for item in bases.values()] + growth.jobs(named)
    results = batch.run_all(jobs, technology, build / "runs", arguments.jobs, _say)
    growth.write(points, results, ROOT / "reports")
    _say(f"reports/growth.csv written: {len(jobs)} configurations in "
         f"{time.monotonic() - started:.0f} s")
    return 0


def _budgets(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Writes the figures of the last run as new budgets."""
    build = ROOT / "build" / "synth"
    technology = technologies.prepare(ROOT, build / "generic40", all_configurations(named))
    results = batch.run_all([batch.Job(item) for item in named.values()], technology, build / "runs",
                            arguments.jobs, _say)
    for line in budgets.moved(budgets.read(BUDGETS), results):
        _say(line)
    budgets.write(BUDGETS, results)
    _say(f"{BUDGETS.relative_to(ROOT)}: review with git diff and commit")
    return 0


def _flat(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Slack with every column real, and with stand-ins."""
    chosen = _select(named, arguments.configuration or list(FLAT))
    build = ROOT / "build" / "synth"
    technology = technologies.prepare(ROOT, build / "generic40", all_configurations(named))
    results = batch.run_all([batch.Job(item) for item in chosen.values()], technology, build / "runs", arguments.jobs, _say)
    differ = 0
    for name, result in results.items():
        found = flat(result, technology, build / "runs" / name)
        agree = abs(found.with_stand_ins - found.all_real) <= FLAT_TOLERANCE_NS
        differ += not agree
        _say(f"{name}: setup with margins, slow corner: {found.with_stand_ins:+.4f} ns with stand-ins, {found.all_real:+.4f} ns with "
             f"every column real: {'the same' if agree else 'ANOTHER'}")
    return 1 if differ else 0


def _namings(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Area and slack over several namings; 1 if some read-out does not close with all of them."""
    chosen = list(_select(named, arguments.configuration or [name for name, item in named.items() if not item.variant_of]).values())
    digest = report_inputs.begin("namings")
    build = ROOT / "build" / "synth"
    technology = technologies.prepare(ROOT, build / "generic40", all_configurations(named))
    results = batch.run_all(namings.jobs(chosen), technology, build / "runs", arguments.jobs, _say)
    found = namings.spreads(chosen, results)
    _say(namings.table(found))
    if not arguments.configuration:
        (ROOT / "reports" / "namings.md").write_text(namings.report(found, digest), encoding="utf-8")
        namings.write_csv(ROOT / "reports" / "namings.csv", found)
        report_inputs.record("namings")
        _say("reports/namings.md, reports/namings.csv written")
    return 0 if all(one.closes for one in found.values()) else 1


def _versions(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Two versions of Yosys side by side; 1 if a difference has no explanation, or an explanation no difference."""
    own, other = yosys_versions.read(ROOT), yosys_versions.read(arguments.checkout)
    found = yosys_versions.differences(own, other, 1e3 / TARGET_MHZ)
    reasons = yosys_versions.explanations(ROOT / yosys_versions.EXPLANATIONS)
    report_inputs.begin("synth-versions")
    (ROOT / "reports" / "yosys_versions.md").write_text(yosys_versions.report(own, other, named, found, reasons), encoding="utf-8")
    yosys_versions.write_csv(ROOT / "reports" / "yosys_versions.csv", own, other)
    report_inputs.record("synth-versions")
    open_points = yosys_versions.open_points(found, reasons)
    for line in open_points:
        _say(line)
    _say("reports/yosys_versions.md, reports/yosys_versions.csv written")
    return 1 if open_points else 0


def _corners(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Slack for each reading of the slow corner."""
    chosen = _select(named, arguments.configuration or list(FLAT))
    build = ROOT / "build" / "synth"
    technology = technologies.prepare(ROOT, build / "generic40", all_configurations(named))
    results = batch.run_all([batch.Job(item) for item in chosen.values()], technology, build / "runs", arguments.jobs, _say)
    _say("setup slack with margins, slow corner, of the same netlist; ratios of slow to typical delay")
    for name, result in results.items():
        for one in corner_ratios.read(result, technology, build / "runs" / name):
            _say(f"{name:<20}{one.name:<28}gates x {one.gates:.2f}  SRAMs x {one.srams:.2f}  {one.slack:+.3f} ns")
    return 0


def _check(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    return check.run(ROOT, PDK, named, all_configurations(named), arguments.jobs, _say)


def _power(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Power from the activity of netlists on a scene; the whole arrays' areas are those of `run`."""
    started = time.monotonic()
    chosen = _select(named, arguments.configuration or list(scene_power.CONFIGURATIONS))
    digest = report_inputs.begin("power")
    build = ROOT / "build" / "synth"
    technology = technologies.prepare(ROOT, build / "generic40", all_configurations(named))
    runs = build / "runs"
    results = batch.run_all([batch.Job(item) for item in chosen.values()], technology, runs, arguments.jobs, _say)
    found = scene_power.run(list(chosen.values()), results, runs, technology, build / "power", arguments.seed, arguments.jobs,
                            _say)
    text = scene_power.report(found, results, digest, arguments.seed)
    _say(text)
    if not arguments.configuration:
        (ROOT / "reports" / "power.md").write_text(text, encoding="utf-8")
        scene_power.write_csv(ROOT / "reports" / "power.csv", found)
        report_inputs.record("power")
        _say("reports/power.md, reports/power.csv written")
    _say(f"{len(found)} simulations, seed {arguments.seed}, {time.monotonic() - started:.0f} s")
    return 0


def _part_costs(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Area and power of the parts of poolPointer."""
    build = ROOT / "build" / "synth"
    technology = technologies.prepare(ROOT, build / "generic40", all_configurations(named))
    parts = part_costs.measure(named[part_costs.CONFIGURATION], technology, build / "part_costs", arguments.seed, _say)
    part_costs.write_csv(arguments.csv, parts)
    _say(f"{arguments.csv} written, seed {arguments.seed}")
    return 0


def _estimate(arguments: argparse.Namespace, _: dict[str, Configuration]) -> int:
    """Fits the models of `dtof design` to figures of make synth, of make power and of their own points."""
    if arguments.points:
        estimate_points.run(ROOT, arguments.seed, arguments.jobs, _say)
    found = estimate.write(ROOT, arguments.out)
    for figure, goal in estimate.GOALS.items():
        for kind in sorted({one.kind for one in found if one.figure == figure}):
            _say(f"{figure}, {kind}: at most {estimate.worst(found, figure, (kind,)):.1%}, root mean square "
                 f"{estimate.rms(found, figure, (kind,)):.1%}; goal {goal:.0%}")
    _say(f"{estimate.COEFFICIENTS}, {estimate.REPORT} written")
    return 0


def _simulation_folder(kind: str, case: simulation.Case) -> Path:
    return SIMULATION / kind / "_".join([case.name, *case.part.split()])


def _simulate_rtl(case: simulation.Case) -> simulation.Outcome:
    return simulation.simulate(case, ROOT, _simulation_folder("rtl", case))


def _simulate_netlist(technology: Technology, case: simulation.Case) -> simulation.Outcome:
    return simulation.simulate_netlist(case, technology, _simulation_folder("netlist", case))


def _simulate_full(technology: Technology, case: simulation.Case) -> simulation.Outcome:
    return simulation.simulate_full(case, technology, _simulation_folder("full", case))


def _prepared(arguments: argparse.Namespace) -> Technology:
    """Libraries for a netlist simulation, which has SRAM sizes of its own."""
    folder = SIMULATION / (arguments.liberty.name if arguments.liberty else "generic40")
    return technologies.prepare(ROOT, folder, [], arguments.liberty, arguments.liberty_slow)


def _sim_icarus(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Simulates the RTL of small arrays and compares it with the model."""
    return _simulate(arguments, list(_select(named, arguments.configuration).values()),
                     lambda *case: [simulation.rtl_case(*case)], _simulate_rtl)


def _sim_netlist(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Simulates netlists of small arrays and compares them with RTL and model."""
    return _simulate(arguments, list(_select(named, arguments.configuration).values()), simulation.netlist_cases,
                     functools.partial(_simulate_netlist, _prepared(arguments)))


def _sim_netlist_full(arguments: argparse.Namespace, named: dict[str, Configuration]) -> int:
    """Simulates netlists of full-width arrays and compares them with the model."""
    chosen = list(_select(named, arguments.configuration or list(simulation.FULL_WIDTH)).values())
    return _simulate(arguments, chosen, lambda item, seed, _: [simulation.full_case(item, seed)],
                     functools.partial(_simulate_full, _prepared(arguments)))


def _simulate(arguments: argparse.Namespace, chosen: list[Configuration], make_cases, work) -> int:
    """Simulates the cases of some configurations; the longest start first."""
    started = time.monotonic()
    if arguments.trace and len(arguments.configuration) != 1:
        raise FlowError("--trace needs the name of one configuration")
    trace = arguments.trace and arguments.trace.resolve()
    chosen = sorted(chosen, key=simulation.expected_rank)
    cases = [case for item in chosen for case in make_cases(item, arguments.seed, trace)]
    again = f"synth/synth.py {arguments.command} {{name}} --seed {{seed}}"
    if arguments.command != "sim-icarus" and arguments.liberty:
        again += f" --liberty {arguments.liberty}"
        again += f" --liberty-slow {arguments.liberty_slow}" if arguments.liberty_slow else ""
    if arguments.action is not _sim_netlist_full:
        again += " --trace {name}.fst"
    failed = simulation.run_all(cases, work, again, arguments.jobs, _say)
    _say(f"{arguments.command}: {len(cases) - failed} of {len(cases)} simulations of {len(chosen)} configurations "
         f"pass, seed {arguments.seed}, {time.monotonic() - started:.0f} s")
    return 1 if failed else 0


def _add_liberty(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--liberty", type=Path, help="standard cells instead of the generated library")
    parser.add_argument("--liberty-slow", type=Path, help="the same cells in the slow corner")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Area, timing and power of the named configurations.")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs at the same time")
    parser.add_argument("--configurations", type=Path, help="a file of more of them, which are then those that are meant")
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("run", help="synthesise, time, report")
    run.add_argument("configuration", nargs="*", help="names from configurations.toml; none: all, with reports")
    _add_liberty(run)
    run.add_argument("--strict", action="store_true", help="fail if a goal is missed, a slack is negative or a figure is not its budget")
    run.add_argument("--csv", type=Path, help="also the areas as this file")
    run.set_defaults(action=_run)
    for name, action, text in (("sim-icarus", _sim_icarus, "RTL against the model, four-state"),
                               ("sim-netlist", _sim_netlist, "netlist against RTL and model, four-state"),
                               ("sim-netlist-full", _sim_netlist_full, "netlist of 200 columns against the model")):
        simulate = commands.add_parser(name, help=text)
        simulate.add_argument("configuration", nargs="*", help="names from configurations.toml; none: all, or "
                              f"{', '.join(simulation.FULL_WIDTH)} in their full width")
        simulate.add_argument("--seed", type=int, default=1, help="of the random frames")
        if action is not _sim_netlist_full:
            simulate.add_argument("--trace", type=Path, help="waveform to write (FST), with one configuration")
        if action is not _sim_icarus:
            _add_liberty(simulate)
        simulate.set_defaults(action=action, trace=None)
    power = commands.add_parser("power", help="power from the activity of netlists on a scene")
    power.add_argument("configuration", nargs="*", help="names from configurations.toml; none: "
                       f"{', '.join(scene_power.CONFIGURATIONS)}, with a report")
    power.add_argument("--seed", type=int, default=1, help="of the photons")
    power.set_defaults(action=_power)
    parts = commands.add_parser("part-costs", help=f"area and power of the parts of {part_costs.CONFIGURATION}")
    parts.add_argument("csv", type=Path, help="file to write")
    parts.add_argument("--seed", type=int, default=1, help="of the photons")
    parts.set_defaults(action=_part_costs)
    models = commands.add_parser("estimate", help="fit the models of area and power of `dtof design`")
    models.add_argument("--points", action="store_true", help=f"measure the points of {estimate.POINTS} anew first")
    models.add_argument("--seed", type=int, default=1, help="of the photons")
    models.add_argument("--out", type=Path, default=ROOT, help="root below which models/ and reports/ are written")
    models.set_defaults(action=_estimate)
    all_real = commands.add_parser("flat", help="the slack with every column real beside that with stand-ins")
    all_real.add_argument("configuration", nargs="*", help=f"names from configurations.toml; none: {', '.join(FLAT)}")
    all_real.set_defaults(action=_flat)
    readings = commands.add_parser("corners", help="the slack for each reading of the slow corner")
    readings.add_argument("configuration", nargs="*", help=f"names from configurations.toml; none: {', '.join(FLAT)}")
    readings.set_defaults(action=_corners)
    several = commands.add_parser("namings", help="area and slack over several namings of the same logic")
    several.add_argument("configuration", nargs="*", help="names from configurations.toml; none: all but variants, with a report")
    several.set_defaults(action=_namings)
    versions = commands.add_parser("versions", help="the results of make synth beside those of another checkout with another Yosys")
    versions.add_argument("checkout", type=Path, help="the other checkout, in which make synth ran")
    versions.set_defaults(action=_versions)
    others: tuple[tuple[str, Action, str], ...] = (
        ("sizes", _sizes, "write the list of SRAM sizes"), ("growth", _growth, "cost over NP, NB, pixels per SRAM and SRAM_NUM"),
        ("budgets", _budgets, "propose new budgets from the current state"), ("check", _check, "compare the generated library with others"))
    for name, other, text in others:
        commands.add_parser(name, help=text).set_defaults(action=other)
    return parser


def main() -> int:
    arguments = _parser().parse_args()
    if arguments.jobs < 1:
        print("error: --jobs must be at least 1", file=sys.stderr)
        return 2
    try:
        named = configuration.load(ROOT / "configurations.toml")
        if arguments.configurations:
            more = configuration.load(arguments.configurations)
            arguments.configuration = getattr(arguments, "configuration", None) or list(more)
            named |= more
        return arguments.action(arguments, named)
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
