# SPDX-License-Identifier: Apache-2.0
"""What scripts/generate.py writes from readouts.toml for C++: the enumeration of read-outs, their properties and the table of their models.
Also the translation of an expression of readouts.toml into C++ or SystemVerilog."""

import ast
from collections.abc import Callable

import limits
from dtof_synth.errors import FlowError
from dtof_synth.readouts import Expression, Table

WRITTEN = "Written by scripts/generate.py from readouts.toml."
POINTER = "pointer"
MEMBERS = {"ADVANTAGE_WIDTH": "count_bits"}  # members of C++ that are not called as the parameter
FIXED = ("ACQ_WIDTH", "BROADCAST_STAGES")


def translated(expression: Expression, name: Callable[[str], str], function: Callable[[str], str]) -> str:
    """An expression in SystemVerilog or C++, fully bracketed."""

    def text(node: ast.expr) -> str:
        match node:
            case ast.Constant(value=number):
                return str(number)
            case ast.Name(id=identifier):
                return name(identifier)
            case ast.BinOp(left=left, op=operator, right=right):
                sign = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.LShift: "<<",
                        ast.RShift: ">>"}[type(operator)]  # fmt: skip
                return f"({text(left)} {sign} {text(right)})"
            case ast.Call(func=ast.Name(id=identifier), args=arguments):
                return f"{function(identifier)}({', '.join(map(text, arguments))})"
        raise FlowError(f"readouts.toml: '{expression}' is no expression")

    whole = text(ast.parse(str(expression), mode="eval").body)
    return whole[1:-1] if whole.startswith("(") and matching(whole) == len(whole) - 1 else whole


def matching(text: str) -> int:
    """Index of the bracket that closes the bracket at the beginning of the text."""
    depth = 0
    for i, letter in enumerate(text):
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if depth == 0:
            return i
    return -1


def cpp_header(table: Table) -> str:
    readouts = list(table.readouts.values())
    thesis = [readout for readout in readouts if readout.thesis]
    hardware = [readout for readout in readouts if readout.top]
    array = lambda chosen: ",\n    ".join(f"Readout::k{readout.enumerator}" for readout in chosen)  # noqa: E731
    return f"""// SPDX-License-Identifier: Apache-2.0
// {WRITTEN}
// clang-format off
#pragma once

#include <array>
#include <string_view>

namespace dtof {{

/// The read-outs of the thesis and of this project (docs/reference/readouts.md).
enum class Readout : int {{
{chr(10).join(f"  k{readout.enumerator} = {i}," for i, readout in enumerate(readouts))}
}};

/// All read-outs.
inline constexpr std::array<Readout, {len(readouts)}> kAllReadouts = {{
    {array(readouts)}}};

/// The read-outs of the thesis.
inline constexpr std::array<Readout, {len(thesis)}> kThesisReadouts = {{
    {array(thesis)}}};

/// The read-outs with RTL, in dtof_array or an array of their own.
inline constexpr std::array<Readout, {len(hardware)}> kRtlReadouts = {{
    {array(hardware)}}};

/// Command-line name: {", ".join(readout.name for readout in readouts)}.
std::string_view readout_name(Readout readout);
/// Display name as the thesis writes it, e.g. "hisPointer v1".
std::string_view readout_title(Readout readout);
/// One sentence on what the read-out does.
std::string_view readout_summary(Readout readout);
/// True if the result is a pointer.
bool is_pointer_readout(Readout readout);
/// True for pool read-outs: pixels use the results of other pixels in their engine's columns.
bool is_pool_readout(Readout readout);
/// True if the read-out scans a histogram.
bool has_histogram(Readout readout);
/// True if the read-out has RTL.
bool has_rtl(Readout readout);
/// True if an RTL parameter other than NP and SLOTS can be chosen for the read-out and changes its result;
/// false for an unknown name.
bool has_parameter(Readout readout, std::string_view parameter);
/// Default value of a parameter of readouts.toml for the read-out. Throws std::logic_error for an unknown
/// name.
int default_value(Readout readout, std::string_view parameter, int np);

}}  // namespace dtof
"""


def cpp_source(table: Table) -> str:
    readouts = list(table.readouts.values())
    translate = lambda expression: translated(expression, str.lower, lambda name: f"std::{name}")  # noqa: E731
    rows = ",\n".join(
        f'    {{"{readout.name}", "{readout.title}",\n     "{readout.summary}",\n'
        f"     {str(readout.kind == POINTER).lower()}, {str(readout.kind == 'pool').lower()}, "
        f"{str(readout.bin_width is not None).lower()}, {str(bool(readout.top)).lower()},\n"
        f"     {{{', '.join(quoted(readout.choices))}}}}}"
        for readout in readouts
    )
    most = max(len(readout.choices) for readout in readouts)
    special = "\n".join(
        f'  if (readout == Readout::k{readout.enumerator} && parameter == "{name}") {{\n    return {translate(value)};\n  }}'
        for readout in readouts for name, value in readout.defaults.items()
    )  # fmt: skip
    common = "\n".join(
        f'  if (parameter == "{parameter.name}") {{\n    return {translate(parameter.default)};\n  }}'
        for parameter in table.parameters.values()
    )
    return f"""// SPDX-License-Identifier: Apache-2.0
// {WRITTEN}
// clang-format off
#include "dtof/core/readout.hpp"

#include <algorithm>
#include <stdexcept>

namespace dtof {{
namespace {{

struct Description {{
  std::string_view name;
  std::string_view title;
  std::string_view summary;
  bool pointer;
  bool pool;
  bool histogram;
  bool rtl;
  std::array<std::string_view, {most}> choices;  // empty ones are none
}};

constexpr std::array<Description, kAllReadouts.size()> kDescriptions = {{{{
{rows},
}}}};

const Description& description(Readout readout) {{ return kDescriptions[static_cast<std::size_t>(readout)]; }}

}}  // namespace

std::string_view readout_name(Readout readout) {{ return description(readout).name; }}
std::string_view readout_title(Readout readout) {{ return description(readout).title; }}
std::string_view readout_summary(Readout readout) {{ return description(readout).summary; }}
bool is_pointer_readout(Readout readout) {{ return description(readout).pointer; }}
bool is_pool_readout(Readout readout) {{ return description(readout).pool; }}
bool has_histogram(Readout readout) {{ return description(readout).histogram; }}
bool has_rtl(Readout readout) {{ return description(readout).rtl; }}

bool has_parameter(Readout readout, std::string_view parameter) {{
  const auto& choices = description(readout).choices;
  return !parameter.empty() && std::find(choices.begin(), choices.end(), parameter) != choices.end();
}}

int default_value(Readout readout, std::string_view parameter, int np) {{
{special}
{common}
  throw std::logic_error("no parameter of this name");
}}

}}  // namespace dtof
"""


def model_members(table: Table) -> dict[str, str]:
    """Parameters that change a model's result, and the member that has each: of ReadoutParameters, or of PoolPointerParameters where only
    pool read-outs have the parameter."""
    pool = [top for top in table.tops.values() if top.schedule]
    others = {name for top in table.tops.values() if not top.schedule for name in top.parameters}
    chosen = {"NP", "SLOTS", *(name for readout in table.readouts.values() for name in readout.choices)}
    own = {name for top in pool for name in (*top.parameters, *top.schedule)} - others
    member = lambda name: MEMBERS.get(name, name.lower())  # noqa: E731
    return {name: f"PoolPointerParameters::{member(name)}" if name in own else f"ReadoutParameters::{member(name)}"
            for name in table.parameters if name in own | chosen}  # fmt: skip


def member_lists(table: Table, found: limits.Limits) -> dict[str, list[str]]:
    """Members of ReadoutParameters and PoolPointerParameters. Initial values: defaults of the first read-out that has them."""
    owners = {"ReadoutParameters": "members of all read-outs", "PoolPointerParameters": "members of a pool read-out"}
    first = {"ReadoutParameters": next(name for name, readout in table.readouts.items() if readout.kind != "pool"),
             "PoolPointerParameters": next(name for name, readout in table.readouts.items() if readout.kind == "pool")}  # fmt: skip
    lists = {title: ["// clang-format off"] for title in owners.values()}
    for name, place in model_members(table).items():
        owner, _, member = place.partition("::")
        flag = any(limit.parameter == name and limit.is_flag for limit in found.limits)
        default = table.default(first[owner], name, int(table.parameters["NP"].default))
        value = str(bool(default)).lower() if flag else str(default)
        lists[owners[owner]] += [f"/// {name}: {table.parameters[name].help}", f"{'bool' if flag else 'int'} {member} = {value};"]
    return {title: [*lines, "// clang-format on"] for title, lines in lists.items()}


def parameter_table(table: Table, found: limits.Limits) -> str:
    rows = "\n".join(f'    entry<&{member}>("{name}",\n        "{table.parameters[name].help}",\n'
                     f'        "{limits.legal_text(found, table, name)}"),'
                     for name, member in model_members(table).items())  # fmt: skip
    return f"""// SPDX-License-Identifier: Apache-2.0
// {limits.WRITTEN}
// clang-format off
#include "dtof/core/parameter_entry.hpp"

namespace dtof {{
namespace {{

constexpr auto kEntries = std::to_array<ParameterEntry>({{
{rows}
}});

}}  // namespace

std::span<const ParameterEntry> parameter_entries() {{ return kEntries; }}

}}  // namespace dtof
"""


def rtl_parameters(table: Table) -> str:
    """Parameters of the top modules, as tb_cpp/rtl/settings.cpp writes them. Those of which a compiled array has one value come last."""
    names = list(dict.fromkeys(name for top in table.tops.values() for name in (*top.parameters, *top.schedule)))
    names = [name for name in names if name not in FIXED] + [name for name in names if name in FIXED]
    rows = "\n".join("    {{\"{}\", {}}},".format(name, ", ".join(str(name in top.parameters and name != "ACQ_WIDTH").lower()
                                                                     for top in table.tops.values())) for name in names)
    return f"""// SPDX-License-Identifier: Apache-2.0
// {WRITTEN}
// clang-format off
#include "rtl/rtl_parameters.hpp"

namespace dtof {{
namespace {{

constexpr auto kParameters = std::to_array<RtlParameter>({{
{rows}
}});

}}  // namespace

std::span<const RtlParameter> rtl_parameters() {{ return kParameters; }}

}}  // namespace dtof
"""


def model_table(table: Table) -> str:
    users: dict[str, list[str]] = {}
    for readout in table.readouts.values():
        users.setdefault(readout.model, []).append(readout.enumerator)
    declarations = "\n".join(f"std::unique_ptr<ReadoutModel> make_{model}(const ReadoutParameters& parameters);"
                             for model in users)  # fmt: skip
    cases = "\n".join("\n".join(f"    case Readout::k{name}:" for name in names) + f"\n      return make_{model}(parameters);"
                      for model, names in users.items())  # fmt: skip
    return f"""// SPDX-License-Identifier: Apache-2.0
// {WRITTEN}
// clang-format off
#include "dtof/core/error.hpp"
#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {{

{declarations}

std::unique_ptr<ReadoutModel> make_ungated_model(const ReadoutParameters& parameters) {{
  switch (parameters.readout) {{
{cases}
  }}
  throw InputError("unknown read-out number");
}}

}}  // namespace dtof
"""


def quoted(names: list[str]) -> list[str]:
    return [f'"{name}"' for name in names]
