#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the lists of read-outs, parameters, their limits and RTL files that SystemVerilog, C++, CMake, FuseSoC, Bender, lint and
docs/user/configuration.md need, from readouts.toml, parameters.toml and hdl/dtof.f, and the registers of dtof_subsystem for RTL, C, others' tools and the page on integration, from
hdl/subsystem/registers.toml, and the table of studies in docs/user/commands.md, from studies.toml, and the version in the files by which
the project is cited, from CMakeLists.txt, and the notebooks of the Python examples, from their scripts. --check only says which are stale."""

import re
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path

import file_lists
import limits
import notebooks
import register_maps
import registers
import release
from dtof_synth import program
from dtof_synth.errors import FlowError
from dtof_synth.readouts import ARRAY, Expression, Readout, Table, Top, evaluate, load
from figures import reports
from readouts_cpp import WRITTEN, cpp_header, cpp_source, member_lists, model_members, model_table, parameter_table, rtl_parameters, translated

ROOT = Path(__file__).resolve().parent.parent
PARAMETERS_BEGIN = "<!-- parameters of {}: written by scripts/generate.py -->\n"
PARAMETERS_END = "<!-- end of parameters -->\n"
PREFIX = "dtof_"  # of every module
COLUMNS_BEGIN = "// Columns of dtof_array: written by scripts/generate.py\n"
COLUMNS_END = "// end of columns\n"
MEMBERS = "models/dtof/core/parameters.hpp"
BENCH = "tb_cpp/subsystem/subsystem_testbench.sv"
SUBSYSTEM, REGISTERS = "docs/user/subsystem.md", "docs/user/registers.md"
COMMANDS = "docs/user/commands.md"
STUDIES_BEGIN, STUDIES_END = "<!-- studies: scripts/generate.py -->\n", "<!-- end of studies -->\n"
CONFIGURATION = "docs/user/configuration.md"
CONNECTIONS_WIDTH = 120  # characters of a line with several connections


def readout_range(table: Table) -> str:
    """The file with the range of READOUT. It is a file of its own because dtof_array uses it outside the compilation unit of dtof_pkg,
    too."""
    last = max(readout.number for readout in table.readouts.values() if readout.number is not None)
    return "\n".join([
        "// SPDX-License-Identifier: Apache-2.0",
        f"// {WRITTEN} The message of dtof_array for a READOUT out of range.",
        "`ifndef DTOF_READOUT_RANGE",
        f'`define DTOF_READOUT_RANGE "dtof_array: READOUT must be 0 to {last}"',
        "`endif",
        "",
    ])


def systemverilog(table: Table) -> str:
    readouts = [readout for readout in table.readouts.values() if readout.number is not None]
    own = {"CONFIDENCE_WIDTH": "pointer_confidence_width"}  # beside the result's
    translate = lambda expression: translated(  # noqa: E731
        expression, lambda name: own.get(name, name.lower()), lambda name: f"{name}_of")  # fmt: skip

    def choice(kind: str, name: str, arguments: str, values: dict[str, Expression], default: str) -> list[str]:
        """A SystemVerilog function of the read-out. Read-outs with equal values share a line."""
        by_text: dict[str, list[str]] = {}
        for constant, expression in values.items():
            by_text.setdefault(translate(expression), []).append(constant)
        return [
            "",
            f"  function automatic {kind} {name}(input int readout{arguments});",
            "    case (readout)",
            *(f"      {', '.join(constants)}: {name} = {text};" for text, constants in by_text.items()),
            f"      default: {name} = {default};",
            "    endcase",
            "  endfunction",
        ]

    def question(name: str, yes: Callable[[Readout], bool]) -> list[str]:
        found = [readout.constant for readout in readouts if yes(readout)]
        lines = choice("bit", name, "", {", ".join(found): 1} if found else {}, "1'b0")
        return [line.replace(f"{name} = 1;", f"{name} = 1'b1;") for line in lines]

    def of(attribute: str, chosen: list[Readout] = readouts) -> dict[str, Expression]:
        values = {readout.constant: getattr(readout, attribute) for readout in chosen}
        return {constant: value for constant, value in values.items() if value is not None}

    sizes = ", input int np, input int nb"
    scanned = {readout.constant: readout.scan_width if readout.scan_width is not None else readout.bin_width or 0
               for readout in readouts}  # fmt: skip
    lines = [
        "// SPDX-License-Identifier: Apache-2.0",
        f"// {WRITTEN} A part of dtof_pkg.",
        "",
        "  // Values of the parameter READOUT.",
        *(f"  localparam int {readout.constant} = {readout.number};" for readout in readouts),
        *(f"  localparam int {top_constant(top)} = {top.readout};  // of dtof_subsystem alone: {top.name}"
          for top in table.tops.values() if top.readout is not None),
        "",
        "  function automatic bit is_readout(input int readout);",
        f"    is_readout = readout >= 0 && readout < {len(readouts)};",
        "  endfunction",
        *question("has_histogram", lambda readout: readout.bin_width is not None),
        "",
        "  // A word a pixel beside its histogram, which timestamps move, or which is read ahead of them.",
        *question("has_word", lambda readout: readout.word != "")[1:],
        *question("is_word_moved", lambda readout: readout.word == "moved"),
        *question("is_word_read_ahead", lambda readout: readout.word in ("moved", "ahead")),
        "",
        "  // Passes over the stream before the final one.",
        *choice("int", "coarse_passes", sizes, of("passes"), "0")[1:],
        "",
        "  // log2 of the bins that the histogram SRAM holds for a pixel; 1 without one.",
        *choice("int", "bin_width", sizes, of("bin_width"), "1")[1:],
        "",
        "  // log2 of the bins that the result is searched in.",
        *choice("int", "scan_width", sizes, scanned, "0")[1:],
        "",
        "  // Clocks between a pixel's last bin and its result, beyond those of the peak search.",
        *choice("int", "decode_clocks", sizes + ", input int fraction_bits",
                {name: value for name, value in of("decode_clocks").items() if value != 0}, "0")[1:],
        "",
        "  // Bits of a result's fields beside its code.",
        *choice("int", "fraction_width", ", input int fraction_bits", of("fraction_width"), "0")[1:],
        *choice("int", "confidence_width", ", input int count_width,\n                                          "
                "input int pointer_confidence_width", of("confidence_width"), "0"),
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def top_constant(top: Top) -> str:
    """Name of a top's number in SystemVerilog."""
    return f"READOUT_{top.name.removeprefix(PREFIX).upper().removesuffix('_ARRAY').replace('_', '')}"


def subsystem_number(table: Table, readout: Readout) -> int | None:
    """Value of dtof_subsystem's READOUT for a read-out; None if the subsystem does not support it."""
    return readout.number if readout.number is not None else table.tops[readout.top].readout


def subsystem_names(table: Table) -> list[str]:
    """Parameters of dtof_subsystem: those of all arrays, and the recommended schedules, which a register shows."""
    return list(dict.fromkeys([*(name for top in table.tops.values() for name in top.parameters),
                               *(name for top in table.tops.values() for name in top.schedule)]))  # fmt: skip


def array_names(table: Table) -> list[str]:
    """Parameters of dtof_gated_array: those of all arrays, without the time gate, which is in front of the array."""
    return list(dict.fromkeys(name for top in table.tops.values() for name in top.parameters if name != "TIME_GATE"))


def subsystem_parameters(table: Table, names: list[str]) -> list[str]:
    """Declarations of these parameters, with the defaults of the chosen read-out. A default of several lines has its comment in front."""
    translate = lambda expression: translated(expression, str, lambda name: f"dtof_pkg::{name}_of")  # noqa: E731
    tops = table.tops.values()
    declared: dict[str, str] = {}
    for name in names:
        parameter = table.parameters[name]
        values: dict[str, list[str]] = {}  # by expression, those that have it
        for top in tops:
            users = [readout for readout in table.readouts.values() if readout.top == top.name]
            for readout in users if top.readout is None else users[:1]:
                if name in readout.defaults and name in (*top.parameters, *top.schedule):
                    constant = readout.constant if top.readout is None else top_constant(top)
                    values.setdefault(translate(readout.defaults[name]), []).append(constant)
        choices = [f"({' || '.join(f'READOUT == dtof_pkg::{constant}' for constant in constants)}) ? {text}"
                   for text, constants in values.items()]  # fmt: skip
        default = "\n        : ".join([*choices, translate(parameter.default)])
        declared[name] = f"parameter int {name} = {default},"
    width = max(len(text) for text in declared.values() if "\n" not in text)
    lines = ["// verilator lint_off UNUSEDPARAM"]  # every array uses its own part
    for name, text in declared.items():
        comment = f"// {table.parameters[name].help}"
        lines += [comment, text] if "\n" in text else [f"{text:<{width}}  {comment}"]
    return [*lines, "// verilator lint_on UNUSEDPARAM"]


def connections(names: list[str]) -> list[str]:
    """Connections of a module's parameters to parameters of the same names."""
    return [f".{name}({name})," for name in names[:-1]] + [f".{names[-1]}({names[-1]})"]


def short_connections(names: list[str]) -> list[str]:
    """The same, several in a line, for a module that passes most of its parameters on."""
    return textwrap.wrap(", ".join(f".{name}({name})" for name in names) + ",", CONNECTIONS_WIDTH)


def column_header(what: str, rule: str) -> list[str]:
    """Header with the parameters or ports common to all columns; each column uses some of them."""
    text = (ROOT / "scripts" / "templates" / f"column_{what}.svh").read_text(encoding="utf-8")
    return [f"// verilator lint_off {rule}", *text.split("\n\n", 1)[1].splitlines(), f"// verilator lint_on {rule}"]


def inlined(name: str, text: str, lists: dict[str, list[str]]) -> str:
    """A module in which generated lists replace the text between their marks, with the marks' indentation."""
    for title, lines in lists.items():
        mark = re.compile(rf"^( +)// {title}: written by scripts/generate.py from \S+\n(?:.*\n)*?\1// end of {title}\n", re.MULTILINE)
        found = mark.findall(text)
        if len(found) != 1:
            raise FlowError(f"{name} has {len(found)} places for the {title}, not 1")
        begin = mark.search(text)
        assert begin is not None
        first, *_, last = begin[0].splitlines(keepends=True)
        body = "".join((line if line.startswith(found[0]) else found[0] + line) + "\n" for line in lines)
        text = text[: begin.start()] + first + body + last + text[begin.end() :]
    return text


def modules(table: Table, found: limits.Limits) -> dict[str, str]:
    """Generated texts: the columns of dtof_array; dtof_subsystem, which has one time gate for all arrays, and the module in it that has the
    array; its bench; and the C++ structures that have the parameters."""
    column = {"parameters of a column": column_header("parameters", "UNUSEDPARAM"),
              "ports of a column": column_header("ports", "UNUSEDSIGNAL")}  # fmt: skip
    arrays = {"parameters of the arrays": subsystem_parameters(table, subsystem_names(table))}
    lists: dict[str, dict[str, list[str]]] = {name: column for readout in table.readouts.values()
             if readout.column and (ROOT / (name := f"hdl/thesis/{readout.column}.sv")).is_file()}  # fmt: skip
    lists[rtl_of("dtof_subsystem")] = arrays | {"parameters of dtof_gated_array": short_connections(array_names(table))}
    lists[rtl_of("dtof_gated_array")] = {"parameters of the arrays": subsystem_parameters(table, array_names(table))} | {
        f"parameters of {top.name}": connections([name for name in top.parameters if name != "TIME_GATE"]) for top in table.tops.values()
    }
    lists[BENCH] = arrays | {"parameters of dtof_subsystem": connections(subsystem_names(table))}
    lists[MEMBERS] = member_lists(table, found)
    return {name: inlined(name, (ROOT / name).read_text(encoding="utf-8"), places) for name, places in lists.items()}


def columns(table: Table) -> str:
    """The column of each read-out of dtof_array."""
    users: dict[str, list[str]] = {}
    for readout in table.readouts.values():
        if readout.column:
            users.setdefault(readout.column, []).append(f"dtof_pkg::{readout.constant}")
    lines = [
        "// SPDX-License-Identifier: Apache-2.0",
        f"// {WRITTEN} A part of dtof_array: column c.",
        "      case (READOUT)",
    ]
    for column, constants in users.items():
        lines += [f"        {', '.join(constants)}: begin : g_{column.removeprefix(PREFIX).removesuffix('_column')}",
                  f"          `DTOF_COLUMN({column})",
                  "        end"]  # fmt: skip
    lines += ["        default: begin : g_no_readout", "        end", "      endcase"]
    return "\n".join(lines) + "\n"


def cmake(table: Table, found: limits.Limits) -> str:
    (bits,) = found.of("dtof_array", "NP")
    fewest, most = int(bits.lowest or 0), int(bits.highest or 0)

    def values(expression: Expression) -> str:
        by_np = [evaluate(expression, {"NP": np}) for np in range(fewest, most + 1)]
        return str(by_np[0]) if len(set(by_np)) == 1 else " ".join(map(str, by_np))

    lines = [
        "# SPDX-License-Identifier: Apache-2.0",
        f"# {WRITTEN}",
        f"# Defaults: one value, or one for each NP from {fewest} to {most}.",
        f"set(DTOF_READOUTS {' '.join(table.readouts)})",
        f"set(DTOF_PARAMETERS {' '.join(name for name in table.parameters if name != 'ACQ_WIDTH')})",
        *(f"set(DTOF_PARAMETERS_{top.name} {' '.join(name for name in top.parameters if name != 'ACQ_WIDTH')})"
          for top in table.tops.values()),
        *(f"set(DTOF_NUMBER_{readout.name} {readout.number})" for readout in table.readouts.values()
          if readout.number is not None),
        *(f"set(DTOF_SUBSYSTEM_NUMBER_{readout.name} {subsystem_number(table, readout)})"
          for readout in table.readouts.values() if readout.top),
        *(f"set(DTOF_TOP_{readout.name} {readout.top})" for readout in table.readouts.values() if readout.top),
        f"set(DTOF_MODELS {' '.join(dict.fromkeys(readout.model for readout in table.readouts.values()))})  # of readout/",
        *(f"set(DTOF_DEFAULT_{name} {values(parameter.default)})" for name, parameter in table.parameters.items()),
        *(f"set(DTOF_DEFAULT_{name}_{readout.name} {values(value)})" for readout in table.readouts.values()
          for name, value in readout.defaults.items()),
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def column_files(text: str, table: Table) -> str:
    """hdl/dtof.f with the columns of dtof_array between their marks."""
    columns = dict.fromkeys(f"thesis/{readout.column}.sv" for readout in table.readouts.values() if readout.column)
    if text.count(COLUMNS_BEGIN) != 1 or text.count(COLUMNS_END) != 1:
        raise FlowError("hdl/dtof.f has no place for the columns of dtof_array")
    head, rest = text.split(COLUMNS_BEGIN)
    return head + COLUMNS_BEGIN + "".join(f"{column}\n" for column in columns) + COLUMNS_END + rest.split(COLUMNS_END)[1]


def defaults(text: str, table: Table, found: limits.Limits) -> str:
    """The page of parameters with a table for each array and one for dtof_subsystem."""
    for top in table.tops.values():
        begin = PARAMETERS_BEGIN.format(top.name)
        if text.count(begin) != 1:
            raise FlowError(f"{CONFIGURATION} has no place for the parameters of {top.name}")
        head, rest = text.split(begin)
        users = [name for name, readout in table.readouts.items() if readout.top == top.name]
        own = " used by |" if top.name == ARRAY else ""
        lines = [f"| parameter | legal | default | unit |{own} meaning |", f"|---|---|---|---|{'---|' if own else ''}---|"]
        if top.name == ARRAY:
            numbers = ", ".join(f"{table.readouts[name].number} {table.readouts[name].title}" for name in users)
            lines.append(f"| `READOUT` | 0 to {len(users) - 1} | 0 | - | all | {numbers} |")
        for name in top.parameters:
            values: dict[int, list[str]] = {}
            for user in users:
                values.setdefault(table.defaults(user)[name], []).append(table.readouts[user].title)
            usual = max(values, key=lambda value: len(values[value]))
            others = [f"{value} for {' and '.join(titles)}" for value, titles in values.items() if value != usual]
            lines.append(limits.page_row(found, table, top.name, name, "; ".join([str(usual), *others])))
        text = head + begin + "\n".join(lines) + "\n" + PARAMETERS_END + rest.split(PARAMETERS_END, 1)[1]
    lines = ["| parameter | legal | default | meaning |", "|---|---|---|---|", *limits.subsystem_rows(found)]
    head, rest = text.split(PARAMETERS_BEGIN.format(limits.SUBSYSTEM))
    return head + PARAMETERS_BEGIN.format(limits.SUBSYSTEM) + "\n".join(lines) + "\n" + PARAMETERS_END + rest.split(PARAMETERS_END, 1)[1]


def rtl_of(module: str) -> str:
    """The file of a module of hdl/."""
    (path,) = (ROOT / "hdl").glob(f"*/{module}.sv")
    return str(path.relative_to(ROOT))


def studies_table(text: str) -> str:
    """The page of the commands with a table of studies.toml between its marks."""
    if text.count(STUDIES_BEGIN) != 1 or text.count(STUDIES_END) != 1:
        raise FlowError(f"{COMMANDS} has no place for the table of studies")
    lines = ["| study | minutes | what it answers | pages |", "|---|---:|---|---|"]
    for name, study in reports.studies(ROOT).items():
        pages = ", ".join(f"[{page['title']}](../../reports/{page['file']})" if (ROOT / "reports" / page["file"]).is_file() else page["title"]
                          for page in study.get("page", []))
        minutes = f"{study['minutes']:g}" if study["minutes"] >= 1 else "< 1"
        lines.append(f"| `{name}` | {minutes} | {study['does']} | {pages or '-'} |")
    head, rest = text.split(STUDIES_BEGIN)
    return head + STUDIES_BEGIN + "\n".join(lines) + "\n" + STUDIES_END + rest.split(STUDIES_END)[1]


def check_top(name: str, text: str, table: Table) -> list[str]:
    """Differences between the parameters of a top module, which is written by hand, and those of the table."""
    declared = re.findall(r"^    parameter int (\w+) = (\w+(?:::\w+)?),", text, re.MULTILINE)
    own = {parameter: value for parameter, value in declared if parameter != "READOUT"}
    np = int(table.parameters["NP"].default)
    described = {parameter: str(evaluate(table.parameters[parameter].default, {"NP": np}))
                 for parameter in table.tops[name].parameters}  # fmt: skip
    failures = [f"{parameter} is only in {place}" for place, here, there in
                ((rtl_of(name), own, described), ("readouts.toml", described, own))
                for parameter in here if parameter not in there]  # fmt: skip
    # A default may be that of one of the top's read-outs.
    for parameter in own.keys() & described.keys():
        legal = {described[parameter]} | {
            str(table.default(readout.name, parameter, np)) for readout in table.readouts.values() if readout.top == name
        }
        if own[parameter] not in legal:
            failures.append(f"{parameter} is {own[parameter]} in {rtl_of(name)}, {described[parameter]} in readouts.toml")
    return failures


def main() -> int:
    if sys.argv[1:] not in ([], ["--check"]):
        print(f"{__doc__}\nusage: generate.py [--check]", file=sys.stderr)
        return 2
    check = "--check" in sys.argv
    try:
        table = load()
        found = limits.load()
        limits.check(found, table)
        current = {name: (ROOT / name).read_text(encoding="utf-8") for name in
                   ("hdl/dtof.f", CONFIGURATION, SUBSYSTEM, REGISTERS, COMMANDS, release.CITATION)}
        whole = registers.load()
        listing = column_files(current["hdl/dtof.f"], table)
        citation = release.citation(current[release.CITATION], file_lists.version())
        files = {
            "hdl/dtof.f": listing,
            "hdl/common/dtof_readouts.svh": systemverilog(table),
            "hdl/common/dtof_readout_range.svh": readout_range(table),
            "hdl/common/dtof_columns.svh": columns(table),
            "models/dtof/core/readout.hpp": cpp_header(table),
            "models/dtof/core/readout.cpp": cpp_source(table),
            "models/dtof/core/parameter_table.cpp": parameter_table(table, found),
            "models/dtof/core/parameter_limits.cpp": limits.cpp_limits(found, table, model_members(table)),
            "hdl/lint/parameter_limits.csv": limits.csv(found, table),
            "models/dtof/readout/model_table.cpp": model_table(table),
            "tb_cpp/rtl/rtl_parameters.cpp": rtl_parameters(table),
            "cmake/readouts.cmake": cmake(table, found),
            "hdl/dtof_no_srams.f": file_lists.without_srams(listing),
            "dtof.core": file_lists.fusesoc(table, listing, file_lists.included(ROOT / "hdl")),
            "Bender.yml": file_lists.bender(listing),
            CONFIGURATION: defaults(current[CONFIGURATION], table, found),
            **modules(table, found),
            "hdl/subsystem/dtof_registers_pkg.sv": registers.systemverilog(whole),
            "driver/dtof_registers.h": registers.c_header(whole),
            **register_maps.files(whole),
            SUBSYSTEM: registers.page(current[SUBSYSTEM], SUBSYSTEM, registers.result_tables(whole)),
            REGISTERS: registers.page(current[REGISTERS], REGISTERS, {"registers": registers.register_table(whole)}),
            COMMANDS: studies_table(current[COMMANDS]),
            release.CITATION: citation,
            release.ZENODO: release.zenodo(citation),
            **notebooks.files(ROOT),
        }
        differences = [difference for top in table.tops
                       for difference in check_top(top, (ROOT / rtl_of(top)).read_text(encoding="utf-8"), table)]
    except (FlowError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    for difference in differences:
        print(f"error: {difference}", file=sys.stderr)
    if differences:
        return 1
    stale = [name for name, text in files.items()
             if not (ROOT / name).exists() or (ROOT / name).read_text(encoding="utf-8") != text]  # fmt: skip
    if check:
        for name in stale:
            print(f"error: {name} is stale: run scripts/generate.py", file=sys.stderr)
        return 1 if stale else 0
    for name in stale:
        (ROOT / name).write_text(files[name], encoding="utf-8")
        print(f"{name} written")
    return 0


if __name__ == "__main__":
    program.run(main)
