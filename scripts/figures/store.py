# SPDX-License-Identifier: Apache-2.0
"""reports/figures.json: every measured figure that a page quotes, once."""

import ast
import json
import operator
import re
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

from .reports import ReportsError
from .staleness import write_lines

FILE = "reports/figures.json"
UNKNOWN = "unknown"
NAME = re.compile(r"[a-z]\w*(\.[a-z]\w*)+")
OPERATIONS: dict[type, Callable[[float, float], float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}


@dataclass(frozen=True)
class Figure:
    """A figure. `value`: as the command printed it; `interval`: ends of the 95 % interval, as printed, if there is one."""

    value: str
    unit: str = ""
    interval: tuple[str, str] | None = None
    report: str = ""
    command: str = ""
    inputs: str = UNKNOWN  # digest of what it was measured on

    def __post_init__(self) -> None:
        if not self.value:
            raise ReportsError("a figure without a value")


def load(root: Path) -> dict[str, Figure]:
    path = root / FILE
    if not path.is_file():
        return {}
    table = json.loads(path.read_text(encoding="utf-8"))
    for entry in table.values():
        entry["interval"] = tuple(entry["interval"]) if "interval" in entry else None
    return {name: Figure(**entry) for name, entry in table.items()}


def record(root: Path, report: str, command: str, inputs: str, figures: dict[str, Figure]) -> None:
    """Stores the figures of a report and removes its former figures that no longer exist."""
    known = {name: figure for name, figure in load(root).items() if figure.report != report}
    for name, figure in figures.items():
        if not NAME.fullmatch(name):
            raise ReportsError(f"{FILE}: '{name}' is no name of a figure: words of small letters, digits and _ with dots between")
        if name in known:
            raise ReportsError(f"{FILE}: {name} is a figure of {known[name].report}, too")
        known[name] = Figure(figure.value, figure.unit, figure.interval, report, command, inputs)
    write_lines(root / FILE, {name: {key: value for key, value in asdict(figure).items() if value not in ("", None)}
                              for name, figure in known.items()})


def _number(node: ast.expr, figures: dict[str, Figure]) -> float:
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATIONS:
        return OPERATIONS[type(node.op)](_number(node.left, figures), _number(node.right, figures))
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        return float(node.value)
    name = ast.unparse(node)
    if name not in figures:
        raise ReportsError(f"there is no figure '{name}' in {FILE}")
    return float(figures[name].value)


def text(reference: str, figures: dict[str, Figure]) -> str:
    """Text that a page shows for a reference `NAME`, `NAME:FORMAT` or `EXPRESSION:FORMAT`. FORMAT is a Python format such as .2f; an
    expression has figures, numbers and + - * /."""
    expression, _, form = reference.partition(":")
    expression = expression.strip()
    if not form:
        if expression not in figures:
            raise ReportsError(f"there is no figure '{expression}' in {FILE}")
        return figures[expression].value
    try:
        return format(_number(ast.parse(expression, mode="eval").body, figures), form.strip())
    except (SyntaxError, ValueError, ZeroDivisionError) as error:
        raise ReportsError(f"'{reference}' is no reference to a figure: {error}") from error
