# SPDX-License-Identifier: Apache-2.0
"""Jupyter notebooks of the Python examples: examples/python/<name>.ipynb has the cells of <name>.py, without outputs.

A cell of a script begins with a line `# %%`, a cell of text with `# %% [markdown]`; its text is in comments. The format of a notebook is
nbformat 4.5, as nbformat writes it, so that a notebook that Jupyter has saved differs in its outputs alone."""

import json
from pathlib import Path

from dtof_synth.errors import FlowError

FOLDER = "examples/python"
CODE, TEXT = "# %%", "# %% [markdown]"
METADATA = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}, "language_info": {"name": "python"}}
FORMAT = {"nbformat": 4, "nbformat_minor": 5}


def cells(script: str, name: str) -> list[tuple[str, str]]:
    """Kind and text of each cell. In front of the first one stand comments alone, which no cell has."""
    found: list[tuple[str, list[str]]] = []
    for number, line in enumerate(script.splitlines(), 1):
        if line.startswith(CODE):
            if line not in (CODE, TEXT):
                raise FlowError(f"{name}:{number}: a cell begins with '{CODE}' or '{TEXT}', not with '{line}'")
            found.append(("markdown" if line == TEXT else "code", []))
        elif not found:
            if not line.startswith("#"):
                raise FlowError(f"{name}:{number}: '{line}' is in no cell")
        elif found[-1][0] == "markdown" and line:
            if line != "#" and not line.startswith("# "):
                raise FlowError(f"{name}:{number}: '{line}' is in a cell of text, and no comment")
            found[-1][1].append(line[2:])
        else:
            found[-1][1].append(line)
    return [(kind, "\n".join(lines).strip("\n")) for kind, lines in found]


def notebook(script: str, name: str) -> str:
    """The notebook of a script as a file's text."""
    made = []
    for number, (kind, text) in enumerate(cells(script, name), 1):
        cell: dict[str, object] = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": text.splitlines(keepends=True)}
        if kind == "code":
            cell |= {"execution_count": None, "outputs": []}
        made.append(cell)
    return json.dumps({"cells": made, "metadata": METADATA} | FORMAT, ensure_ascii=False, indent=1, sort_keys=True) + "\n"


def files(root: Path) -> dict[str, str]:
    """All notebooks by their names in the project."""
    return {f"{FOLDER}/{path.stem}.ipynb": notebook(path.read_text(encoding="utf-8"), f"{FOLDER}/{path.name}")
            for path in sorted((root / FOLDER).glob("*.py"))}
