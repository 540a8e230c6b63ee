# SPDX-License-Identifier: Apache-2.0
"""Figures on pages that people write: `<!--=NAME:FORMAT-->1.14<!--/-->`, of which a reader sees 1.14."""

import re
from pathlib import Path

from . import store
from .reports import ReportsError
from .source_tree import SourceTree

REFERENCE = re.compile(r"<!--=(?P<reference>[^>|]*?)-->(?P<text>.*?)<!--/-->", re.DOTALL)
OPENING = re.compile(r"<!--=")


def rendered(text: str, figures: dict[str, store.Figure], where: str) -> str:
    def replaced(match: re.Match[str]) -> str:
        line = text.count("\n", 0, match.start()) + 1
        if "\n\n" in match["text"] or OPENING.search(match["text"]):
            raise ReportsError(f"{where}:{line}: the reference '{match['reference']}' does not end: <!--/--> is missing")
        try:
            return f"<!--={match['reference']}-->{store.text(match['reference'], figures)}<!--/-->"
        except ReportsError as error:
            raise ReportsError(f"{where}:{line}: {error}") from error

    found = REFERENCE.sub(replaced, text)
    if len(OPENING.findall(text)) != len(REFERENCE.findall(text)):
        lost = next(match for match in OPENING.finditer(text)
                    if not any(whole.start() == match.start() for whole in REFERENCE.finditer(text)))
        raise ReportsError(f"{where}:{text.count(chr(10), 0, lost.start()) + 1}: a reference to a figure does not end")
    return found


def quoted(text: str, figures: dict[str, store.Figure]) -> set[str]:
    """Names of the figures that a page refers to."""
    return {name[0] for match in REFERENCE.finditer(text) for name in re.finditer(store.NAME, match["reference"])
            if name[0] in figures}


def pages(tree: SourceTree) -> list[str]:
    """Markdown pages that are written by hand."""
    return sorted(name for name in tree.files if name == "README.md" or (name.startswith("docs/") and name.endswith(".md")))


def render(root: Path, tree: SourceTree, check: bool) -> list[str]:
    """Writes the figures into the pages and returns the pages that differ. With `check` nothing is written."""
    figures = store.load(root)
    wanted = {name: rendered(tree.text(name), figures, name) for name in pages(tree)}
    changed = [name for name, text in wanted.items() if text != tree.text(name)]
    if not check:
        for name in changed:
            (root / name).write_text(wanted[name], encoding="utf-8")
    return changed
