# SPDX-License-Identifier: Apache-2.0
"""Markdown of the tree as HTML: headings as on GitHub, links that stay inside the page's folder."""

import html
import os
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import markdown

HEADING = re.compile(r"^(#+) +(.*)$")
FENCE = re.compile(r"^(```|~~~)")


def slug(text: str, separator: str = "-") -> str:
    """The anchor that GitHub gives a heading."""
    text = re.sub(r"[^\w\- ]", "", text.strip().lower())
    return text.replace(" ", separator)


def unique_slug(text: str, taken: set[str]) -> str:
    base = slug(text)
    found, number = base, 0
    while found in taken:
        number += 1
        found = f"{base}-{number}"
    taken.add(found)
    return found


class Rewriter(HTMLParser):
    """Passes HTML on: links and pictures through `link`, headings with anchors, tables in a box that scrolls.

    `link` takes an address and gives its new one, or None for what the page does not have: then a link's text stays,
    and a picture's title."""

    def __init__(self, link: Callable[[str], str | None], lower_headings: int, prefix: str) -> None:
        super().__init__(convert_charrefs=False)
        self.link, self.lower, self.prefix = link, lower_headings, prefix
        self.out: list[str] = []
        self.open_links: list[bool] = []  # whether each open <a> was kept
        self.heading: tuple[int, str, int] | None = None  # place in `out`, tag, level
        self.taken: set[str] = set()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = dict(attributes)
        if tag == "a" and "href" in values:
            target = self.link(values["href"] or "")
            self.open_links.append(target is not None)
            if target is not None:
                self.out.append(f'<a href="{html.escape(target)}">')
            return
        if tag == "img":
            target = self.link(values.get("src") or "")
            title = html.escape(values.get("alt") or "")
            self.out.append(f'<em>{title}: the picture is not here.</em>' if target is None else
                            f'<a class="picture" href="{html.escape(target)}"><img src="{html.escape(target)}" '
                            f'alt="{title}" loading="lazy"></a>')
            return
        if re.fullmatch(r"h[1-6]", tag):
            level = min(6, int(tag[1]) + self.lower)
            self.heading = (len(self.out), f"h{level}", level)
            self.out.append("")
            return
        if tag == "table":
            self.out.append('<div class="scroll" tabindex="0">')
        self.out.append(self.get_starttag_text() or "")

    def handle_startendtag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.handle_starttag(tag, attributes)
        else:
            self.out.append(self.get_starttag_text() or "")

    def handle_endtag(self, tag: str) -> None:
        if tag == "a" and self.open_links:
            if self.open_links.pop():
                self.out.append("</a>")
            return
        if self.heading and re.fullmatch(r"h[1-6]", tag):
            place, name, _ = self.heading
            text = html.unescape(re.sub(r"<[^>]*>", "", "".join(self.out[place:])))
            self.out[place] = f'<{name} id="{html.escape(self.prefix + unique_slug(text, self.taken))}">'
            self.out.append(f"</{name}>")
            self.heading = None
            return
        self.out.append(f"</{tag}>")
        if tag == "table":
            self.out.append("</div>")

    def handle_data(self, data: str) -> None:
        self.out.append(data)

    def handle_entityref(self, name: str) -> None:
        self.out.append(f"&{name};")

    def handle_charref(self, name: str) -> None:
        self.out.append(f"&#{name};")


def to_html(text: str, link: Callable[[str], str | None], lower_headings: int = 0, prefix: str = "") -> str:
    """Markdown as HTML. `lower_headings`: number of levels by which headings move down; `prefix`: put before each heading's anchor."""
    rewriter = Rewriter(link, lower_headings, prefix)
    # A list may follow its paragraph without a blank line, as on GitHub.
    spaced = re.sub(r"^(?![-*] |\s|\||#|$)(.*)\n(?=[-*] )", r"\1\n\n", text, flags=re.MULTILINE)
    rewriter.feed(markdown.markdown(spaced, extensions=["tables", "fenced_code", "sane_lists"]))
    rewriter.close()
    return "".join(rewriter.out)


def title(text: str, otherwise: str) -> str:
    """The first heading."""
    for line in text.splitlines():
        match = HEADING.match(line)
        if match:
            return match[2].replace("`", "")
    return otherwise


def sections(text: str) -> list[tuple[list[str], list[str]]]:
    """Sections of a page: the path of headings below the title, and the lines. The first section is the text before the first heading."""
    parts: list[tuple[list[str], list[str]]] = [([], [])]
    path: list[str] = []
    fenced = False
    for line in text.splitlines():
        fenced ^= bool(FENCE.match(line))
        match = None if fenced else HEADING.match(line)
        if match and len(match[1]) > 1:
            path = path[:len(match[1]) - 2] + [match[2]]
            parts.append((path, []))
        parts[-1][1].append(line)
    return parts


def excerpt(text: str, headings: tuple[str, ...]) -> str:
    """The text before the first heading below the title and, for each path of patterns "a/b", the sections of that path with their
    headings."""
    parts = sections(text)
    shown = ["\n".join(line for line in parts[0][1] if not HEADING.match(line)).strip()]
    for wanted in headings:
        patterns = wanted.split("/")
        for place, lines in parts:
            if len(place) == len(patterns) and all(map(re.fullmatch, patterns, place)):
                # The headings above it are the excerpt's own.
                shown.append("\n".join(["## " + ": ".join(place), *lines[1:]]).strip())
    return "\n\n".join(shown) + "\n"


def relative(target: str, page: str) -> str:
    """Relative address of a file in the page's folder from another file."""
    return Path(os.path.relpath(target, Path(page).parent)).as_posix()
