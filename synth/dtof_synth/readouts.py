# SPDX-License-Identifier: Apache-2.0
"""Read-outs and parameters of readouts.toml, from which all other descriptions are generated."""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from .errors import FlowError

PATH = Path(__file__).resolve().parents[2] / "readouts.toml"
KINDS = ("pointer", "histogram", "pool", "code")
WORDS = ("moved", "ahead", "scanned")
ARRAY = "dtof_array"
OPERATORS = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a // b,
    ast.LShift: lambda a, b: a << b,
    ast.RShift: lambda a, b: a >> b,
}
FUNCTIONS = {"max": max, "min": min}

Expression = int | str


def evaluate(expression: Expression, values: Mapping[str, int]) -> int:
    """Value of an expression of readouts.toml. `values`: the parameters that it names."""

    def value(node: ast.expr) -> int:
        match node:
            case ast.Constant(value=int(number)):
                return number
            case ast.Name(id=name) if name in values:
                return values[name]
            case ast.BinOp(left=left, op=operator, right=right) if type(operator) in OPERATORS:
                return OPERATORS[type(operator)](value(left), value(right))
            case ast.Call(func=ast.Name(id=name), args=arguments) if name in FUNCTIONS:
                return FUNCTIONS[name](*map(value, arguments))
        raise FlowError(f"readouts.toml: '{expression}' is no expression of known parameters")

    try:
        return value(ast.parse(str(expression), mode="eval").body)
    except SyntaxError:
        raise FlowError(f"readouts.toml: '{expression}' is no expression") from None


@dataclass(frozen=True)
class Parameter:
    name: str
    default: Expression
    help: str


@dataclass(frozen=True)
class Readout:
    """A read-out as in the file."""

    name: str
    title: str
    enumerator: str
    summary: str
    style: dict[str, str | int]
    model: str
    kind: str
    choices: list[str]
    top: str = ""  # that of a column; none without RTL
    number: int | None = None
    column: str = ""
    thesis: bool = False
    defaults: dict[str, Expression] = field(default_factory=dict)
    fraction_width: Expression = 0
    confidence_width: Expression = 0
    passes: Expression = 0
    bin_width: Expression | None = None
    scan_width: Expression | None = None
    decode_clocks: Expression = 0
    word: str = ""
    memories: dict[str, list[Expression]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.column and not self.top:
            object.__setattr__(self, "top", ARRAY)

    @property
    def constant(self) -> str:
        """Name of the read-out's number in SystemVerilog."""
        return f"READOUT_{self.name.upper().replace('-', '_')}"


@dataclass(frozen=True)
class Top:
    name: str
    parameters: list[str]
    schedule: list[str] = field(default_factory=list)  # what dtof_subsystem recommends to a driver; the array has no such parameters
    readout: int | None = None  # dtof_subsystem's READOUT for the whole top, where its read-outs have none of their own


@dataclass(frozen=True)
class Table:
    parameters: dict[str, Parameter]
    tops: dict[str, Top]
    readouts: dict[str, Readout]

    def default(self, readout: str, parameter: str, np: int) -> int:
        """Default value of a parameter for a read-out. Defaults depend on NP at most."""
        expression = self.readouts[readout].defaults.get(parameter, self.parameters[parameter].default)
        return evaluate(expression, {"NP": np})

    def defaults(self, readout: str) -> dict[str, int]:
        """Default values of all parameters of the read-out's top."""
        np = int(self.parameters["NP"].default)
        return {name: self.default(readout, name, np) for name in self.tops[self.readouts[readout].top].parameters}


def parse(text: str) -> Table:
    try:
        table = tomllib.loads(text)
        parameters = {name: Parameter(name, **entry) for name, entry in table["parameter"].items()}
        tops = {name: Top(name, **entry) for name, entry in table["top"].items()}
        readouts = {name: Readout(name, **entry) for name, entry in table["readout"].items()}
    except (tomllib.TOMLDecodeError, KeyError, TypeError) as error:
        raise FlowError(f"readouts.toml: {error}") from None
    for readout in readouts.values():
        where = f"readouts.toml: {readout.name}"
        if readout.kind not in KINDS:
            raise FlowError(f"{where}: the kind '{readout.kind}' is none of {', '.join(KINDS)}")
        if readout.top and readout.top not in tops:
            raise FlowError(f"{where}: there is no top '{readout.top}'")
        if readout.word and readout.word not in WORDS:
            raise FlowError(f"{where}: the word '{readout.word}' is none of {', '.join(WORDS)}")
        unknown = [name for name in [*readout.choices, *readout.defaults] if name not in parameters]
        if unknown:
            raise FlowError(f"{where}: unknown parameter {unknown[0]}")
        if len({readout.number is not None, bool(readout.column), readout.top == ARRAY}) > 1:
            raise FlowError(f"{where}: read-outs of {ARRAY} have a number and a column, others neither")
    numbers = [readout.number for readout in readouts.values() if readout.number is not None]
    if sorted(numbers) != list(range(len(numbers))):
        raise FlowError("readouts.toml: the numbers must be 0, 1, 2, ..., each once")
    result = Table(parameters, tops, readouts)
    for name in readouts:
        for parameter in parameters:
            result.default(name, parameter, 10)
    return result


@cache
def load(path: Path = PATH) -> Table:
    try:
        return parse(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FlowError(f"{path}: {error}") from None
