# SPDX-License-Identifier: Apache-2.0
"""The lists of reports (studies.toml, reports/reports.toml), and digests of each report's inputs."""

import hashlib
import tomllib
from collections import defaultdict
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from . import closure
from .source_tree import SourceTree

LIST = "reports/reports.toml"
STUDIES = "studies.toml"


class ReportsError(Exception):
    """An error with a one-line message."""


@dataclass(frozen=True)
class Report:
    name: str
    command: str
    minutes: float
    pages: tuple[str, ...]  # names under reports/, of these and of `files`
    inputs: tuple[str, ...]
    files: tuple[str, ...] = ()
    data: tuple[str, ...] = ()
    first: bool = False  # the page of results of `make report` shows it
    after: tuple[str, ...] = ()  # reports whose files it reads
    confirm: str = ""  # a command that prints all that the report takes from `confirm_covers`; without it the small run confirms
    confirm_covers: tuple[str, ...] = ()

    @property
    def written(self) -> tuple[str, ...]:
        return tuple(f"reports/{name}" for name in (*self.pages, *self.files))


def page_data(page: str) -> str:
    """The file of reports/ with the values of a page of reports/, from which a template makes the page."""
    return f"data/{page.removesuffix('.md').replace('/', '_')}.page.json"


@dataclass(frozen=True)
class Inputs:
    """Inputs of a report: a digest of all files, and one for the files of each folder."""

    digest: str
    folders: dict[str, str]
    files: dict[str, str] = field(default_factory=dict)


def _expanded(patterns: list[str], groups: dict[str, list[str]], where: str) -> tuple[str, ...]:
    found: list[str] = []
    for pattern in patterns:
        if pattern.startswith("@"):
            if pattern[1:] not in groups:
                raise ReportsError(f"{LIST}: {where}: there is no group '{pattern[1:]}' in [inputs]")
            found += _expanded(groups[pattern[1:]], groups, where)
        else:
            found.append(pattern)
    return tuple(dict.fromkeys(found))


def group(root: Path, name: str, tree: SourceTree) -> Inputs:
    """The files of a group of [inputs]."""
    groups = tomllib.loads((root / LIST).read_text(encoding="utf-8"))["inputs"]
    return inputs(Report(name, "", 0, (), _expanded([f"@{name}"], groups, name)), tree)


def studies(root: Path) -> dict[str, dict]:
    """Entries of studies.toml by make target; empty in a tree without this file."""
    path = root / STUDIES
    if not path.is_file():
        return {}
    found = tomllib.loads(path.read_text(encoding="utf-8"))["study"]
    for name, study in found.items():
        if missing := {"does", "minutes"} - study.keys():
            raise ReportsError(f"{STUDIES}: {name}: the key '{min(missing)}' is missing")
    return found


def _report(name: str, entry: dict, groups: dict[str, list[str]], where: str) -> Report:
    known = {"command", "minutes", "pages", "files", "inputs", "data", "first", "confirm", "confirm_covers"}
    if wrong := entry.keys() - known:
        raise ReportsError(f"{where}: unknown key '{min(wrong)}'")
    if missing := {"command", "minutes", "pages", "inputs"} - entry.keys():
        raise ReportsError(f"{where}: the key '{min(missing)}' is missing")
    return Report(name, entry["command"], entry["minutes"], tuple(entry["pages"]), _expanded(entry["inputs"], groups, name),
                  tuple(entry.get("files", ())), tuple(entry.get("data", ())), entry.get("first", False), confirm=entry.get("confirm", ""),
                  confirm_covers=_expanded(entry.get("confirm_covers", []), groups, name))


def load(root: Path) -> dict[str, Report]:
    """Reports by name. A report comes after the reports whose files it reads."""
    table = tomllib.loads((root / LIST).read_text(encoding="utf-8"))
    groups = table.get("inputs", {})
    found = {}
    for name, study in studies(root).items():
        if "inputs" in study:
            pages = [page["file"] for page in study.get("page", [])]
            report = study.get("report", name.replace("-", "_"))
            entry = {key: study[key] for key in study.keys() - {"page", "report", "does"}}
            found[report] = _report(report, entry | {"command": f"make {name}", "pages": pages}, groups, f"{STUDIES}: {name}")
    for name, entry in table["report"].items():
        found[name] = _report(name, entry, groups, f"{LIST}: {name}")
    writers = {file: report.name for report in found.values() for file in report.written}
    ordered: dict[str, Report] = {}

    def add(name: str, above: tuple[str, ...]) -> None:
        if name in above:
            raise ReportsError(f"{LIST}: {' -> '.join((*above, name))}: reports that wait for each other")
        report = found[name]
        after = tuple(dict.fromkeys(writers[pattern] for pattern in report.inputs if pattern in writers))
        for other in after:
            add(other, (*above, name))
        ordered.setdefault(name, replace(report, after=after))

    for name in found:
        add(name, ())
    return ordered


def input_files(report: Report, tree: SourceTree) -> set[str]:
    return _files(report.inputs, tree)


def not_covered(report: Report, tree: SourceTree) -> str:
    """Digest of the inputs that `confirm_covers` leaves out."""
    return _hash(sorted(tree.digest(name) for name in _files(report.inputs, tree) - _files(report.confirm_covers, tree)))[:16]


def _files(patterns: tuple[str, ...], tree: SourceTree) -> set[str]:
    found: set[str] = set()
    left_out: set[str] = set()
    for pattern in patterns:
        if pattern.startswith("!"):
            left_out.update(tree.matching(pattern[1:]))
            continue
        kind, _, root = pattern.partition(":")
        if kind == "cpp":
            found |= closure.cpp(tree, root)
        elif kind == "python":
            found |= closure.python(tree, root)
        else:
            found.update(tree.matching(pattern))
    return found - left_out


def folder(name: str) -> str:
    """Folder name of a file as pages show it: two levels, in models/dtof/ three; for files in reports/ or the root, the file itself."""
    parents = PurePosixPath(name).parts[:-1]
    return name if not parents or parents[0] == "reports" else "/".join(parents[:3 if parents[0] == "models" else 2])


def _hash(lines: list[str]) -> str:
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def inputs(report: Report, tree: SourceTree) -> Inputs:
    """Digests of a report's inputs. They cover contents only: moving a file does not change them."""
    files = {name: tree.digest(name) for name in sorted(input_files(report, tree))}
    by_folder: dict[str, list[str]] = defaultdict(list)
    for name, digest in files.items():
        by_folder[folder(name)].append(digest)
    return Inputs(_hash(sorted(files.values()))[:16],
                  {place: _hash(sorted(digests))[:8] for place, digests in sorted(by_folder.items())}, files)
