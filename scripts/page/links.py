# SPDX-License-Identifier: Apache-2.0
"""Checks that every link in a folder of pages resolves inside the folder."""

from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ELSEWHERE = ("http", "https", "mailto")
INSIDE = "data"  # the address is the content
RESOURCES = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src", "object": "data"}


class Page(HTMLParser):
    """Links of a page, and its anchors."""

    def __init__(self) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.resources: list[str] = []
        self.twice: set[str] = set()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attributes}
        if "id" in values:
            (self.twice if values["id"] in self.anchors else self.anchors).add(values["id"])
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        elif tag in RESOURCES and RESOURCES[tag] in values:
            self.resources.append(values[RESOURCES[tag]])


def problems(folder: Path) -> list[str]:
    """A sentence for each link or resource that leads nowhere or out of the folder, and for each anchor that occurs twice."""
    pages = {}
    for path in sorted(folder.rglob("*.html")):
        pages[path] = Page()
        pages[path].feed(path.read_text(encoding="utf-8"))
    found = []
    for path, page in pages.items():
        here = path.relative_to(folder)
        found += [f"{here}: the anchor {anchor} is there twice" for anchor in sorted(page.twice)]
        for address in page.links + page.resources:
            parts = urlsplit(address)
            if parts.scheme == INSIDE or parts.scheme in ELSEWHERE and address in page.links:
                continue
            if parts.scheme or parts.netloc or parts.path.startswith("/"):
                found.append(f"{here}: {address} is outside of the page's folder")
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path.resolve()
            if not target.is_relative_to(folder.resolve()):
                found.append(f"{here}: {address} is outside of the page's folder")
            elif not target.is_file():
                found.append(f"{here}: {address} does not exist")
            elif parts.fragment and folder / target.relative_to(folder.resolve()) in pages:
                if unquote(parts.fragment) not in pages[folder / target.relative_to(folder.resolve())].anchors:
                    found.append(f"{here}: {address} has no such anchor")
    return found
