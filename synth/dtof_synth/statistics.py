# SPDX-License-Identifier: Apache-2.0
"""Numbers of cells in what Yosys's `stat` prints: up to Yosys 0.5x a type and then its number under "Number of cells:", in newer
versions the number and then the type under "N cells"."""

import re

from .errors import FlowError

_TITLE = re.compile(r"^=== .* ===$", re.MULTILINE)
_TOTAL = re.compile(r"^ *(?:Number of cells: +(\d+)|(\d+)(?: +[\d.eE+-]+)? cells)$", re.MULTILINE)
_TYPE_FIRST = re.compile(r"^ +(\S+) +(\d+)$", re.MULTILINE)
_NUMBER_FIRST = re.compile(r"^ +(\d+)(?: +[\d.eE+-]+)? +(\S+)$", re.MULTILINE)
_NO_TYPES = {"wires", "ports", "memories", "processes", "cells", "submodules"}


def last(text: str) -> str:
    """Statistics of the last module in the text."""
    titles = [found.start() for found in _TITLE.finditer(text)]
    return text[titles[-1]:] if titles else text


def cells(text: str) -> dict[str, int]:
    """Numbers of cells by type for the last module. FlowError if there are none, or their sum differs from Yosys's total."""
    statistics = last(text)
    total = _TOTAL.search(statistics)
    if total is None:
        raise FlowError("Yosys printed no number of cells")
    if total.group(1) is not None:
        found = {kind: int(number) for kind, number in _TYPE_FIRST.findall(statistics[total.end():])}
    else:
        found = {kind: int(number) for number, kind in _NUMBER_FIRST.findall(statistics) if kind not in _NO_TYPES}
    expected = int(total.group(1) or total.group(2))
    if sum(found.values()) != expected:
        raise FlowError(f"Yosys printed {expected} cells, whose types add up to {sum(found.values())}")
    return found
