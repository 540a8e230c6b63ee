# SPDX-License-Identifier: Apache-2.0
"""The index that the pages' search reads: the text of every page by its headings.

A browser reads no file beside a page that was opened from a disk, but it runs a script there: the index is one."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path

FILE = "search_index.js"
HEADINGS = ("h1", "h2", "h3", "h4", "h5", "h6")
CELLS = ("td", "th")
BREAKS = (*HEADINGS, *CELLS, "p", "li", "pre", "tr", "figcaption", "summary")  # words on both sides are two words
WORD = re.compile(r"[^\W\d_]")


class Place:
    """A heading, or a table row with an anchor, and the text below it."""

    def __init__(self, anchor: str) -> None:
        self.anchor = anchor
        self.heading: list[str] = []
        self.text: list[str] = []


class Places(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found = [Place("")]
        self.row: Place | None = None
        self.section = ""  # anchor of the section whose heading is next
        self.heading: str | None = None  # the tag of the heading that is open
        self.cell: list[str] | None = None
        self.skipped = 0

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        anchor = dict(attributes).get("id") or ""
        if tag in ("script", "style"):
            self.skipped += 1
        elif tag == "section":
            self.section = anchor
        elif tag in HEADINGS:
            self.found.append(Place(anchor or self.section))
            self.heading, self.section = tag, ""
        elif tag == "tr" and anchor:
            self.row = Place(anchor)
        elif tag in CELLS:
            self.cell = []

    def handle_endtag(self, tag: str) -> None:
        if tag in ("script", "style"):
            self.skipped -= 1
        elif tag == self.heading:
            self.heading = None
        elif tag == "tr" and self.row:
            self.found.insert(len(self.found) - 1, self.row)
            self.row = None
        elif tag in CELLS and self.cell is not None:
            self.close_cell("".join(self.cell))
        elif tag in BREAKS:
            self.found[-1].text.append(" ")

    def close_cell(self, text: str) -> None:
        """Drops a cell without a word: nobody searches for the digits of a figure."""
        self.cell = None
        if not WORD.search(text):
            return
        if self.row is None:
            self.found[-1].text += [text, " "]
        elif self.row.heading:
            self.row.text += [text, " "]
        else:
            self.row.heading.append(text)

    def handle_data(self, data: str) -> None:
        if self.skipped:
            return
        if self.heading:
            self.found[-1].heading.append(data)
        elif self.cell is not None:
            self.cell.append(data)
        else:
            self.found[-1].text.append(data)


def words(parts: list[str]) -> str:
    return " ".join("".join(parts).split())


class Index:
    def __init__(self) -> None:
        self.pages: list[tuple[str, str]] = []  # address from the folder of the pages, title
        self.places: list[tuple[int, str, str, str]] = []  # page, anchor, heading, text

    def add(self, page: str, title: str, body: str) -> None:
        reader = Places()
        reader.feed(body)
        reader.close()
        for place in reader.found:
            heading, text = words(place.heading), words(place.text)
            if heading or text:
                self.places.append((len(self.pages), place.anchor, heading, text))
        self.pages.append((page, title))

    def write(self, folder: Path) -> None:
        content = json.dumps({"pages": self.pages, "places": self.places}, ensure_ascii=False, separators=(",", ":"))
        (folder / FILE).write_text(f"window.searchIndex = {content};\n", encoding="utf-8")
