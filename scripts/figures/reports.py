# SPDX-License-Identifier: Apache-2.0
"""The lists of reports (studies.toml, reports/reports.toml) and the digest of what each depends on."""

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
    """One line that says what is wrong."""


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

    @property
    def written(self) -> tuple[str, ...]:
        return tuple(f"reports/{name}" for name in (*self.pages, *self.files))


@dataclass(frozen=True)
class Inputs:
    """What a report depends on: a digest of everything, and one of each folder's files."""

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
    """studies.toml, by the name of the target of make; none where a tree has no such file."""
    path = root / STUDIES
    if not path.is_file():
        return {}
    found = tomllib.loads(path.read_text(encoding="utf-8"))["study"]
    for name, study in found.items():
        if missing := {"does", "minutes"} - study.keys():
            raise ReportsError(f"{STUDIES}: {name}: the key '{min(missing)}' is missing")
    return found


def _report(name: str, entry: dict, groups: dict[str, list[str]], where: str) -> Report:
    known = {"command", "minutes", "pages", "files", "inputs", "data", "first"}
    if wrong := entry.keys() - known:
        raise ReportsError(f"{where}: unknown key '{min(wrong)}'")
    if missing := {"command", "minutes", "pages", "inputs"} - entry.keys():
        raise ReportsError(f"{where}: the key '{min(missing)}' is missing")
    return Report(name, entry["command"], entry["minutes"], tuple(entry["pages"]), _expanded(entry["inputs"], groups, name),
                  tuple(entry.get("files", ())), tuple(entry.get("data", ())), entry.get("first", False))


def load(root: Path) -> dict[str, Report]:
    """By name, each behind those whose files it reads."""
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
    found: set[str] = set()
    for pattern in report.inputs:
        kind, _, root = pattern.partition(":")
        if kind == "cpp":
            found |= closure.cpp(tree, root)
        elif kind == "python":
            found |= closure.python(tree, root)
        else:
            found.update(tree.matching(pattern))
    return found


def folder(name: str) -> str:
    """The place that a page names for a file: two levels of folders, in models/dtof/ three, or a file of reports/ or of the root itself."""
    parents = PurePosixPath(name).parts[:-1]
    return name if not parents or parents[0] == "reports" else "/".join(parents[:3 if parents[0] == "models" else 2])


def _hash(lines: list[str]) -> str:
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def inputs(report: Report, tree: SourceTree) -> Inputs:
    """The digests are of contents: a file that moves changes none of them."""
    files = {name: tree.digest(name) for name in sorted(input_files(report, tree))}
    by_folder: dict[str, list[str]] = defaultdict(list)
    for name, digest in files.items():
        by_folder[folder(name)].append(digest)
    return Inputs(_hash(sorted(files.values()))[:16],
                  {place: _hash(sorted(digests))[:8] for place, digests in sorted(by_folder.items())}, files)
