# SPDX-License-Identifier: Apache-2.0
"""Legal values of parameters, from parameters.toml, and what scripts/generate.py writes from them: the limits of the C++ models, the table
with which lint and a test try RTL and models, and the texts of the page of parameters."""

import ast
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dtof_synth.errors import FlowError
from dtof_synth.readouts import ARRAY, FUNCTIONS, OPERATORS, Expression, Table

NAME = "parameters.toml"
PATH = Path(__file__).resolve().parent.parent / NAME
SUBSYSTEM = "dtof_subsystem"
WRITTEN = f"Written by scripts/generate.py from readouts.toml and {NAME}."
COMPARISONS: dict[type, tuple[str, Callable[[int, int], bool]]] = {
    ast.Eq: ("==", lambda a, b: a == b), ast.LtE: ("<=", lambda a, b: a <= b), ast.GtE: (">=", lambda a, b: a >= b),
}
SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.LShift: "<<", ast.BitAnd: "&"}
AND = {ast.BitAnd: lambda a, b: a & b}


def _walk(expression: Expression, known: Callable[[str], Any], write: Callable[..., Any]) -> Any:
    """Folds an expression: `known` has the value of a name, `write` makes one of an operation and its operands."""

    def fold(node: ast.expr) -> Any:
        match node:
            case ast.Constant(value=int(number)):
                return write("number", number)
            case ast.Name(id=name):
                return known(name)
            case ast.BinOp(left=left, op=operator, right=right) if type(operator) in SIGNS:
                return write(type(operator), fold(left), fold(right))
            case ast.Compare(left=left, ops=[operator], comparators=[right]) if type(operator) in COMPARISONS:
                return write(type(operator), fold(left), fold(right))
            case ast.BoolOp(op=operator, values=parts):
                return write(type(operator), *map(fold, parts))
            case ast.IfExp(test=test, body=body, orelse=other):
                return write("if", fold(test), fold(body), fold(other))
            case ast.Call(func=ast.Name(id=name), args=arguments) if name in FUNCTIONS:
                return write(name, *map(fold, arguments))
        raise FlowError(f"{NAME}: '{expression}' is no expression")

    try:
        return fold(ast.parse(str(expression), mode="eval").body)
    except SyntaxError:
        raise FlowError(f"{NAME}: '{expression}' is no expression") from None


def evaluate(expression: Expression, values: Mapping[str, int]) -> int:
    """Value of an expression; that of a condition is a bool."""

    def known(name: str) -> int:
        if name not in values:
            raise FlowError(f"{NAME}: '{expression}' names {name}, which is no parameter here")
        return values[name]

    def calculated(operation: Any, *operands: int) -> int:
        if operation == "number":
            return operands[0]
        if operation == "if":
            return operands[1] if operands[0] else operands[2]
        if operation in FUNCTIONS:
            return FUNCTIONS[operation](*operands)
        if operation in (ast.And, ast.Or):
            return (all if operation is ast.And else any)(operands)
        if operation in COMPARISONS:
            return COMPARISONS[operation][1](*operands)
        return (OPERATORS | AND)[operation](*operands)

    return _walk(expression, known, calculated)


def cpp(expression: Expression, member: Callable[[str], str]) -> str:
    """The expression in C++, each operation in brackets."""

    def written(operation: Any, *operands: Any) -> str:
        if operation == "number":
            return str(operands[0])
        if operation == "if":
            return "({} ? {} : {})".format(*operands)
        if operation in FUNCTIONS:
            return f"std::{operation}({', '.join(operands)})"
        sign = {ast.And: "&&", ast.Or: "||"}.get(operation) or SIGNS.get(operation) or COMPARISONS[operation][0]
        return f"({f' {sign} '.join(operands)})"

    return _walk(expression, member, written)


@dataclass(frozen=True)
class Limit:
    """An entry of parameters.toml. Its head explains the keys."""

    top: str
    parameter: str
    lowest: Expression | None = None
    highest: Expression | None = None
    text: str = ""
    condition: str = ""
    message: str = ""
    readout: str = ""
    beside: str = ""
    unknown: str = ""
    required: bool = True
    refused: list[str] = field(default_factory=list)
    untried: list[str] = field(default_factory=list)
    used_by: str = ""
    meaning: str = ""
    default: str = ""
    page: str = ""

    @property
    def legal(self) -> str:
        """The legal values as a page says them."""
        if self.is_flag and not self.text:
            return "0 or 1"
        return self.page or self.text or (f"at least {self.lowest}" if self.highest is None else f"{self.lowest} to {self.highest}")

    @property
    def sentence(self) -> str:
        """The message for an illegal value, without the module's name."""
        return self.message or f"{self.parameter} must be {self.legal}"

    @property
    def expression(self) -> str:
        """The condition of a legal value; empty if no expression says it."""
        if self.condition or self.unknown:
            return self.condition
        ends = [f"{self.parameter} >= ({self.lowest})"]
        if self.highest is not None:
            ends.append(f"{self.parameter} <= ({self.highest})")
        return " and ".join(ends)

    @property
    def is_flag(self) -> bool:
        return (self.lowest, self.highest) == (0, 1)

    def settings(self, defaults: Mapping[str, int], number: Mapping[str, int]) -> Iterator[str]:
        """Settings that the limit refuses: the values just outside, and those of the entry."""
        before = f"READOUT={number[self.readout]} " if self.readout else f"{self.beside} " if self.beside else ""
        if self.lowest is not None:
            yield f"{before}{self.parameter}={evaluate(self.lowest, defaults) - 1}"
        if self.highest is not None:
            yield f"{before}{self.parameter}={evaluate(self.highest, defaults) + 1}"
        yield from self.refused


@dataclass(frozen=True)
class Limits:
    limits: list[Limit]
    units: dict[str, str]
    legal: dict[str, list[str]]  # by top: settings that no limit refuses

    def of(self, top: str, parameter: str = "") -> list[Limit]:
        return [limit for limit in self.limits if limit.top == top and parameter in ("", limit.parameter)]

    def of_model(self, table: Table, pool: bool) -> list[Limit]:
        """Limits that a model has: those of its array, and of the schedule that dtof_subsystem recommends."""
        schedules = {name for top in table.tops.values() if pool for name in top.schedule}
        (top,) = (top.name for top in table.tops.values() if (top.name != ARRAY) == pool)
        return [*self.of(top), *(limit for limit in self.of(SUBSYSTEM) if limit.parameter in schedules)]


KEYS = {"from": "lowest", "to": "highest", "legal": "condition", "sentence": "message", "with": "beside", "is": "unknown", "of": "parameter"}


def parse(text: str) -> Limits:
    try:
        table = tomllib.loads(text)
        limits = []
        for top, entries in table["limit"].items():
            for name, entry in entries.items():
                limits.append(Limit(top, **({"parameter": name} | {KEYS.get(key, key): value for key, value in entry.items()})))
        found = Limits(limits, table["unit"], table["legal"])
    except (tomllib.TOMLDecodeError, KeyError, TypeError, AttributeError) as error:
        raise FlowError(f"{NAME}: {error}") from None
    for limit in limits:
        if limit.lowest is None and not limit.condition and not limit.unknown:
            raise FlowError(f"{NAME}: {limit.top}: {limit.parameter} has no limit")
        if limit.lowest is None and not limit.message:
            raise FlowError(f"{NAME}: {limit.top}: {limit.parameter}: without `from` the entry needs a sentence")
    return found


def load() -> Limits:
    try:
        return parse(PATH.read_text(encoding="utf-8"))
    except OSError as error:
        raise FlowError(f"{PATH}: {error}") from None


def check(limits: Limits, table: Table) -> None:
    """Each parameter of an array has limits, each limit a parameter."""
    for top in table.tops.values():
        names = {limit.parameter for limit in limits.of(top.name)}
        if missing := [name for name in top.parameters if name not in names]:
            raise FlowError(f"{NAME}: {top.name}: {missing[0]} has no limit")
        if extra := names - set(top.parameters):
            raise FlowError(f"{NAME}: {top.name} has no parameter {min(extra)}")
    if extra := limits.units.keys() - table.parameters.keys():
        raise FlowError(f"{NAME}: a unit of {min(extra)}, which is no parameter")


def numbers(table: Table) -> dict[str, int]:
    return {name: readout.number for name, readout in table.readouts.items() if readout.number is not None}


def csv(limits: Limits, table: Table) -> str:
    """Settings on either side of every limit."""
    first = {readout.top: readout.name for readout in reversed(table.readouts.values()) if readout.top}
    lines = [
        "# SPDX-License-Identifier: Apache-2.0",
        f"# {WRITTEN}",
        "# Parameters on either side of every limit. With a sentence they are illegal: RTL (scripts/lint_rtl.py) and model",
        "# (models/tests/core/parameter_limits_test.cpp) must refuse them with it. Without one they are legal and must be taken.",
        "# READOUT's limits follow from readouts.toml (scripts/lint_rtl.py).",
        "top,settings,sentence",
    ]
    for top in dict.fromkeys(limit.top for limit in limits.limits):
        defaults = {name: table.default(first.get(top, next(iter(table.readouts))), name, 10) for name in table.parameters}
        for limit in limits.of(top):
            if limit.required:
                lines += dict.fromkeys(f"{top},{settings},{limit.sentence}" for settings in limit.settings(defaults, numbers(table))
                                       if settings not in limit.untried)
        lines += [f"{top},{settings}," for settings in limits.legal[top]]
    return "\n".join(lines) + "\n"


def legal_text(limits: Limits, table: Table, parameter: str) -> str:
    """Legal values of a parameter for an option's help, where the arrays differ with poolPointer's behind."""
    texts = {pool: "; ".join(limit.legal for limit in limits.of_model(table, pool) if limit.parameter == parameter and limit.lowest is not None)
             for pool in (False, True)}
    unit = limits.units.get(parameter, "")
    plain, pool = (f"{text} {unit}".strip() if re.fullmatch(r"\d+ to \d+", text) else text
                   for text in texts.values())
    if not plain or not pool or plain == pool:
        return plain or pool
    return f"{plain}; poolPointer: {pool}"


def cpp_limits(limits: Limits, table: Table, members: Mapping[str, str]) -> str:
    """Limits of the models. A member that is a bool, and what the RTL alone has, needs none."""
    def member(name: str) -> str:
        owner, _, field_name = members[name].partition("::")
        return f"p.{field_name}" if owner == "ReadoutParameters" else f"p.pool.{field_name}"

    def rows(pool: bool) -> str:
        lines = []
        for limit in limits.of_model(table, pool):
            if limit.parameter not in members or limit.is_flag or not limit.expression:
                continue
            condition = cpp(limit.expression, member)
            if limit.readout:
                condition = f"p.readout != Readout::k{table.readouts[limit.readout].enumerator} || {condition}"
            lines.append(f'    {{"{limit.parameter}", "{limit.sentence}",\n     [](const ReadoutParameters& p) {{ return {condition}; }},\n'
                         f"     [](const ReadoutParameters& p) {{ return static_cast<int>({member(limit.parameter)}); }}}},")
        return "\n".join(lines)

    return f"""// SPDX-License-Identifier: Apache-2.0
// {WRITTEN}
// clang-format off
#include "dtof/core/parameter_limits.hpp"

#include <algorithm>
#include <array>

namespace dtof {{
namespace {{

constexpr auto kArrayLimits = std::to_array<ParameterLimit>({{
{rows(False)}
}});

constexpr auto kPoolLimits = std::to_array<ParameterLimit>({{
{rows(True)}
}});

}}  // namespace

std::span<const ParameterLimit> parameter_limits(bool pool) {{
  return pool ? std::span<const ParameterLimit>(kPoolLimits) : std::span<const ParameterLimit>(kArrayLimits);
}}

}}  // namespace dtof
"""


def users(limits: Limits, table: Table, top: str, parameter: str) -> str:
    """Numbers of the read-outs that use a parameter of dtof_array."""
    for limit in limits.of(top, parameter):
        if limit.used_by:
            return limit.used_by
    found = [readout.number for readout in table.readouts.values() if parameter in readout.choices and readout.number is not None]
    if len(found) > 3 and found == list(range(found[0], found[-1] + 1)):
        return f"{found[0]} to {found[-1]}"
    return ", ".join(map(str, found)) if found else "all"


def page_row(limits: Limits, table: Table, top: str, parameter: str, default: str) -> str:
    """A parameter's row in the table of the page."""
    found = limits.of(top, parameter)
    legal = "; ".join(limit.legal for limit in found if limit.lowest is not None or limit.page)
    meaning = next((limit.meaning for limit in found if limit.meaning), table.parameters[parameter].help)
    used = f" {users(limits, table, top, parameter)} |" if top == ARRAY else ""
    return f"| `{parameter}` | {legal} | {default} | {limits.units.get(parameter, '-')} |{used} {meaning} |"


def subsystem_rows(limits: Limits) -> list[str]:
    """The rows of the page for dtof_subsystem: its own parameters, then those of the arrays that have narrower limits there."""
    by_parameter: dict[str, list[Limit]] = {}
    for limit in limits.of(SUBSYSTEM):
        by_parameter.setdefault(limit.parameter, []).append(limit)
    rows = []
    for parameter, found in by_parameter.items():
        default = found[0].default or "the array's"
        rows.append(f"| `{parameter}` | {'; '.join(limit.legal for limit in found)} | {default} | {found[0].meaning or 'as in the array'} |")
    return rows
