#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Every relative link and anchor of the Markdown files leads somewhere, every page of docs/ stands in its index, and who
names a page of docs/ names one that is there. Every module of the RTL has its section on one page of the blocks, which
names only parameters and ports that the module has. The page of formats has the columns of every table of reports/."""

import csv
import gzip
import io
import re
import sys
from pathlib import Path
from urllib.parse import unquote, urlsplit

from dtof_synth import program
from figures.source_tree import SourceTree
from page import links, render

ROOT = Path(__file__).resolve().parent.parent
INDEX = "docs/README.md"
BLOCKS = "docs/reference/blocks/"
FORMATS = "docs/reference/formats.md"
# Folders whose modules are blocks; the others hold proofs, lint waivers and SRAM stand-ins.
BLOCK_FOLDERS = ("hdl/common/", "hdl/thesis/", "hdl/pool/", "hdl/subsystem/", "fpga/")
MODULE = re.compile(r"^module +(\w+)", re.MULTILINE)
SECTION = re.compile(r"^## `(\w+)`$", re.MULTILINE)
OF_A_MODULE = re.compile(r"`([A-Z][A-Z_]+|[a-z]\w*_(?:i|o|ni))`")  # a parameter or a port
TABLE_ROW = re.compile(r"^\| `([\w/]+\.csv(?:\.gz)?)` \|[^|]*\|(.*)\|$", re.MULTILINE)
NAMED_PAGE = re.compile(r"(?<!\]\()\bdocs/[\w/-]+\.md\b")  # a link is checked as one


def read(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")


def parsed(text: str) -> links.Page:
    page = links.Page()
    page.feed(render.to_html(text, lambda address: address))
    return page


def broken_links(root: Path, files: set[str]) -> list[str]:
    """Links that lead nowhere. `files`: the files that git keeps, relative to `root`; built files do not count as targets."""
    pages = {file: parsed(read(root / file)) for file in sorted(files) if file.endswith(".md")}
    folders = {str(parent) for file in files for parent in Path(file).parents}
    found = []
    for file, page in pages.items():
        for address in sorted(set(page.links + page.resources)):
            parts = urlsplit(address)
            if parts.scheme in links.ELSEWHERE:
                continue
            path = (root / file).parent / unquote(parts.path) if parts.path else root / file
            target = path.resolve()
            name = str(target.relative_to(root.resolve())) if target.is_relative_to(root.resolve()) else None
            if parts.scheme or parts.netloc or name is None or parts.path.startswith("/"):
                found.append(f"{file}: {address} leads out of the tree")
            elif name not in files and name not in folders:
                found.append(f"{file}: {address} does not exist")
            elif parts.fragment and (name not in pages or unquote(parts.fragment) not in pages[name].anchors):
                found.append(f"{file}: {address} has no such anchor")
    if INDEX in pages:
        listed = {((root / INDEX).parent / unquote(urlsplit(address).path)).resolve() for address in pages[INDEX].links}
        found += [f"{INDEX}: {file} is not listed" for file in pages
                  if file.startswith("docs/") and file != INDEX and (root / file).resolve() not in listed]
    return found


def missing_pages(root: Path, files: set[str]) -> list[str]:
    """Pages that comments, messages and scripts name but that do not exist. Tests are left out: they name pages of small trees of their
    own."""
    found = []
    for file in sorted(file for file in files if not file.startswith("scripts/tests/")):
        for number, line in enumerate(read(root / file).splitlines(), 1):
            found += [f"{file}:{number}: {name} does not exist" for name in NAMED_PAGE.findall(line)
                      if name not in files]
    return found


def blocks(root: Path, files: set[str]) -> list[str]:
    modules: dict[str, str] = {}
    sections: dict[str, list[tuple[str, str]]] = {}
    for file in sorted(files):
        if file.endswith(".sv") and file.startswith(BLOCK_FOLDERS):
            modules |= dict.fromkeys(MODULE.findall(read(root / file)), file)
        elif file.startswith(BLOCKS) and file.endswith(".md"):
            parts = SECTION.split(read(root / file))
            for name, text in zip(parts[1::2], parts[2::2]):
                sections.setdefault(name, []).append((file, text))
    found = [f"{modules[name]}: no page of {BLOCKS} has a section \"## `{name}`\"" for name in modules
             if name not in sections]
    for name, places in sections.items():
        pages = [page for page, _ in places]
        if name not in modules:
            found.append(f"{pages[0]}: {name} is no module of hdl/")
        elif len(pages) > 1:
            found.append(f"{', '.join(pages)}: {name} has more than one section")
        else:
            has = set(re.findall(r"\w+", read(root / modules[name])))
            found += [f"{pages[0]}: {part} of {name} is not in {modules[name]}"
                      for part in sorted(set(OF_A_MODULE.findall(places[0][1])) - has)]
    return found


def tables(root: Path, files: set[str]) -> list[str]:
    described = {f"reports/{name}": re.findall(r"`([^`]+)`", columns)
                 for name, columns in TABLE_ROW.findall(read(root / FORMATS) if FORMATS in files else "")}
    found = []
    for file in sorted(file for file in files if file.startswith("reports/") and file.endswith((".csv", ".csv.gz"))):
        content = (root / file).read_bytes()
        text = (gzip.decompress(content) if file.endswith(".gz") else content).decode("utf-8")
        header: list[str] = next(csv.reader(io.StringIO(text, newline="")), [])
        if file not in described:
            found.append(f"{FORMATS}: {file} is not described")
        elif described[file] != header:
            found.append(f"{FORMATS}: {file} has the columns {', '.join(header)}, not {', '.join(described[file])}")
    return found


def problems(root: Path, files: list[str]) -> list[str]:
    kept = set(files)
    return broken_links(root, kept) + missing_pages(root, kept) + blocks(root, kept) + tables(root, kept)


def main() -> int:
    found = problems(ROOT, sorted(SourceTree(ROOT).files))
    for sentence in found:
        print(f"error: {sentence}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    program.run(main)
