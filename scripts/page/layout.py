# SPDX-License-Identifier: Apache-2.0
"""The frame of all pages: navigation bar with search, and the list of a page's headings."""

import html
import re
from dataclasses import dataclass

from . import render

NAME = "dtof-readout"
HEADING = re.compile(r'<h2 id="(?P<anchor>[^"]+)">(?P<text>.*?)</h2>|<section id="(?P<section>[^"]+)"><h2>(?P<title>.*?)</h2>', re.DOTALL)
TAG = re.compile(r"<[^>]*>")
FEWEST_LISTED = 3  # headings: a page with fewer has no list of them


@dataclass(frozen=True)
class Entry:
    """An entry of the navigation bar. `folder`: pages below it also belong to the entry."""

    title: str
    page: str
    folder: str = ""


def bar(page: str, entries: list[Entry]) -> str:
    """The navigation bar with the page's entry marked: the entry of the page itself, else the one whose folder contains the page."""
    here = next((entry for entry in entries if entry.page == page), None) or \
        next((entry for entry in entries if entry.folder and page.startswith(entry.folder)), None)
    links = "".join(f'<a href="{html.escape(render.relative(entry.page, page))}"{" aria-current=page" if entry is here else ""}>'
                    f"{html.escape(entry.title)}</a>" for entry in entries)
    return (f'<header><a class="name" href="{render.relative("index.html", page)}">{NAME}</a><nav aria-label="Pages">{links}</nav>'
            '<form role="search" hidden><input type="search" placeholder="Search" aria-label="Search all pages" autocomplete="off" '
            'spellcheck="false"></form></header>\n<div id="found" role="region" aria-label="Found" aria-live="polite" hidden></div>')


def contents(body: str) -> str:
    """List of links to the headings of the second level."""
    found = [(match["anchor"] or match["section"], TAG.sub("", match["text"] or match["title"])) for match in HEADING.finditer(body)]
    if len(found) < FEWEST_LISTED:
        return ""
    items = "".join(f'<li><a href="#{anchor}">{text}</a></li>' for anchor, text in found)
    return f'<nav class="contents" aria-label="On this page"><details><summary>On this page</summary><ul>{items}</ul></details></nav>\n'


def whole(page: str, title: str, body: str, entries: list[Entry], scripts: tuple[str, ...] = ()) -> str:
    """A complete page. On the start page, its three doors replace the list of headings."""
    root = render.relative("index.html", page).removesuffix("index.html")
    listed = "" if page == "index.html" else contents(body)
    loaded = "".join(f'<script src="{root}{name}" defer></script>\n' for name in ("page.js", *scripts))
    return ('<!DOCTYPE html>\n'
            f'<html lang="en" data-root="{root}">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            '<meta name="color-scheme" content="light dark">\n'
            f'<title>{html.escape(title)}</title>\n<link rel="stylesheet" href="{root}style.css">\n{loaded}'
            f"</head>\n<body>\n{bar(page, entries)}\n{listed}<main>\n{body}\n</main>\n</body>\n</html>\n")
