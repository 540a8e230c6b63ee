# SPDX-License-Identifier: Apache-2.0
"""Which reports were measured on other inputs than those that lie here, and the line that says so on their pages.

reports/digests.json has the inputs that each report was measured on. A command notes them when it begins
(build/inputs/<report>.json), so that what changes while it runs makes its report stale. A small run can confirm a report after a change
of its inputs (confirm.py); a confirmed report is not stale."""

import hashlib
import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

from .reports import Inputs, Report, ReportsError, inputs
from .source_tree import CommitTree, SourceTree, git_says

DIGESTS = "reports/digests.json"
BEGUN = "build/inputs"
MARK = "> Measured before: "
CONFIRMED_MARK = "> Confirmed: "
NAMED_PLACES = 6  # on a page


@dataclass(frozen=True)
class Measured:
    """The inputs on which a report was measured. `commit`: the commit on which the files were based, if git knows it. `small`: digest of the
    files of a small run with these inputs. `small_by`: what made it, if the report has a command of its own for that (confirmed_by).
    `confirmed`: digest of the inputs with which a small run wrote the same files."""

    digest: str
    folders: dict[str, str]
    commit: str = ""
    small: str = ""
    small_by: str = ""
    confirmed: str = ""
    confirmed_commit: str = ""


@dataclass(frozen=True)
class Stale:
    report: Report
    places: tuple[str, ...]  # folders and files that changed or came, else those that went; none: nothing is known of the inputs

    @property
    def line(self) -> str:
        """First line of the stale report's pages."""
        what = f"changes in {_named(self.places)}" if self.places else "nobody noted on what"
        return f"{MARK}{what}. `{self.report.command}` ({minutes(self.report)}) renews this page."


def _named(places: tuple[str, ...]) -> str:
    others = len(places) - NAMED_PLACES
    return ", ".join(places[:NAMED_PLACES]) + (f" and {others} more" if others > 0 else "")


def minutes(report: Report) -> str:
    if report.minutes < 1:
        return "seconds"
    return f"{report.minutes:g} minute{'' if report.minutes == 1 else 's'}"


def _read(path: Path) -> dict[str, dict]:
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def measured(root: Path) -> dict[str, Measured]:
    return {name: Measured(**entry) for name, entry in _read(root / DIGESTS).items()}


def write_lines(path: Path, entries: dict[str, dict]) -> None:
    """Writes JSON with one line per entry, so that a change of one entry is one line in a diff."""
    lines = [f"  {json.dumps(name)}: {json.dumps(entry, ensure_ascii=False)}" for name, entry in sorted(entries.items())]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def _entry(found: Inputs, commit: str) -> dict:
    return {"digest": found.digest, "commit": commit, "folders": found.folders}


def _head(root: Path) -> str:
    return (git_says(root, "rev-parse", "--verify", "--quiet", "HEAD") or "").strip()[:12]


def begin(root: Path, report: Report, tree: SourceTree) -> str:
    """Notes the inputs of a measurement that begins; returns their digest."""
    found = inputs(report, tree)
    write_lines(root / BEGUN / f"{report.name}.json", {report.name: _entry(found, _head(root))})
    return found.digest


def begun(root: Path, report: Report) -> Measured | None:
    entry = _read(root / BEGUN / f"{report.name}.json").get(report.name)
    return Measured(**entry) if entry else None


def record(root: Path, report: Report) -> Measured:
    """Records the inputs noted at the start of the measurement as those of the report."""
    found = begun(root, report)
    if found is None:
        raise ReportsError(f"{BEGUN}/{report.name}.json is missing: nothing is known of what {report.name} was measured on; "
                           f"run `{report.command}`")
    _store(root, report, found)
    return found


def record_commit(root: Path, report: Report, commit: str) -> Measured:
    """Records the inputs of a report that was committed with `commit`."""
    tree = CommitTree(root, commit)
    entry = _entry(inputs(report, tree), tree.commit[:12])
    _store(root, report, Measured(**entry))
    return Measured(**entry)


def _store(root: Path, report: Report, found: Measured) -> None:
    entries = _read(root / DIGESTS)
    before = entries.get(report.name, {})
    entries[report.name] = {"digest": found.digest, "commit": found.commit, "folders": found.folders}
    if before.get("digest") == found.digest:
        entries[report.name] |= {key: before[key] for key in ("small", "small_by") if key in before}
    write_lines(root / DIGESTS, entries)


def confirmed_by(report: Report) -> str:
    """Digest of the command that confirms the report and of the inputs it stands for; empty if a small run of the report's command does."""
    return hashlib.sha256("\n".join([report.confirm, *report.confirm_covers]).encode()).hexdigest()[:8] if report.confirm else ""


def store_small(root: Path, report: Report, digest: str) -> None:
    """Stores the digest of a small run that was made with the inputs on which the report was measured, or with which it was confirmed."""
    entries = _read(root / DIGESTS)
    entries[report.name]["small"] = digest
    if report.confirm:
        entries[report.name]["small_by"] = confirmed_by(report)
    write_lines(root / DIGESTS, entries)


def store_confirmed(root: Path, report: Report, now: Inputs) -> None:
    """Stores that a small run with the inputs `now` wrote the same files as the one of `store_small`."""
    entries = _read(root / DIGESTS)
    entries[report.name] |= {"confirmed": now.digest, "confirmed_commit": _head(root)}
    write_lines(root / DIGESTS, entries)


def compared(report: Report, known: Measured | None, now: Inputs) -> Stale | None:
    if known is None:
        return Stale(report, ())
    if now.digest in (known.digest, known.confirmed):
        return None
    return Stale(report, _changed_places(known, now))


def _changed_places(known: Measured, now: Inputs) -> tuple[str, ...]:
    changed = {place for place, digest in now.folders.items() if digest not in known.folders.values()}
    gone = {place for place, digest in known.folders.items() if digest not in now.folders.values()} - now.folders.keys()
    # A folder may have gone whose files lie in another one, too.
    return tuple(sorted(changed or gone or known.folders.keys() ^ now.folders.keys()))


def stale(root: Path, reports: dict[str, Report], tree: SourceTree) -> dict[str, Stale]:
    """Stale reports by name: their present inputs differ from those on which they were measured."""
    known = measured(root)
    found: dict[str, Stale] = {}
    for name, report in reports.items():
        if one := compared(report, known.get(name), inputs(report, tree)):
            found[name] = one
    return found


def changed_files(root: Path, one: Stale, tree: SourceTree) -> list[str]:
    """Changed files of a stale report, if git has the commit on which the report was measured."""
    known = measured(root).get(one.report.name)
    if known is None or not known.commit:
        return []
    try:
        before = inputs(one.report, CommitTree(root, known.commit)).files
    except (subprocess.CalledProcessError, FileNotFoundError):
        return []
    now = inputs(one.report, tree).files
    return sorted({name for name, digest in before.items() ^ now.items()
                   if digest not in before.values() or digest not in now.values()})


# ---- Pages -----------------------------------------------------------------------------------------------

def confirming(report: Report) -> str:
    """Command whose output confirms the report."""
    return report.confirm or f"{report.command} SMALL=1"


def first_lines(root: Path, reports: dict[str, Report], tree: SourceTree) -> dict[str, str]:
    """First line of the pages of each report that is stale or confirmed."""
    known = measured(root)
    lines = {}
    for name, report in reports.items():
        now = inputs(report, tree)
        if one := compared(report, known.get(name), now):
            lines[name] = one.line
        elif now.digest != known[name].digest:
            lines[name] = (f"{CONFIRMED_MARK}changes in {_named(_changed_places(known[name], now))} since this page was measured. "
                           f"`{confirming(report)}` writes the same bytes before and after these changes.")
    return lines


def without_mark(text: str) -> str:
    if not text.startswith((MARK, CONFIRMED_MARK)):
        return text
    _, _, rest = text.partition("\n")
    return rest.removeprefix("\n")


def with_mark(text: str, line: str | None) -> str:
    body = without_mark(text)
    return body if line is None else f"{line}\n\n{body}"


def _pages(root: Path, reports: dict[str, Report]) -> list[tuple[str, str, Path]]:
    """Report, name and path of each page that exists."""
    return [(name, page, root / "reports" / page) for name, report in reports.items() for page in report.pages
            if (root / "reports" / page).is_file()]


def unmarked_pages(root: Path, reports: dict[str, Report], lines: dict[str, str]) -> list[str]:
    """A sentence for each page whose first line is wrong: a missing or outdated mark."""
    wrong = []
    for name, page, path in _pages(root, reports):
        text = path.read_text(encoding="utf-8")
        line = lines.get(name)
        if with_mark(text, line) == text:
            continue
        says = "is fresh and its first line says that it is not" if line is None else \
            "is confirmed and its first line does not say so" if line.startswith(CONFIRMED_MARK) else \
            "does not say what changed" if text.startswith(MARK) else "is stale and its first line does not say so"
        wrong.append(f"reports/{page} {says}: run `make figures`")
    return wrong


def mark(root: Path, reports: dict[str, Report], lines: dict[str, str]) -> list[str]:
    """Writes first lines into the pages of stale and confirmed reports and removes them from others; returns the changed pages."""
    changed = []
    for name, page, path in _pages(root, reports):
        text = path.read_text(encoding="utf-8")
        wanted = with_mark(text, lines.get(name))
        if wanted != text:
            path.write_text(wanted, encoding="utf-8")
            changed.append(f"reports/{page}")
    return changed
