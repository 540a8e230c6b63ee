# SPDX-License-Identifier: Apache-2.0
"""Contents of the page: reports, their files, and the commands that make them."""

import gzip
import re
from dataclasses import dataclass
from pathlib import Path

from figures import reports, staleness

from . import render

ROOT = Path(__file__).resolve().parents[2]
# A line that is a picture.
PICTURE_LINE = "!["
TABLE_LINK = re.compile(r"\[[^\]]*\]\((?!http)([^)]+\.csv)\)")
COMPRESSED = ".gz"


@dataclass(frozen=True)
class Report:
    """A Markdown report. `committed` is its copy under reports/, `built` what the command left in build/, where all its
    pictures are; a command without `built` writes to reports/ only. `with_it`: tables and pictures that lie under
    reports/, too, by their names in build/ and there (.gz: compressed); tables that no program reads stay in build/.
    `left_out`, `text_only`: patterns of headings "a/b" whose sections, or whose sections' tables, stay in build/."""

    name: str
    title: str
    target: str  # of make
    committed: str
    built: str | None = None
    says: str = ""  # what it is, for the page that lists it
    excerpt: tuple[str, ...] | None = None  # headings that the page of results shows; (): all before the first one
    pictures: tuple[str, ...] = ()  # beside `built`, not named in its text
    with_it: tuple[tuple[str, str], ...] = ()
    left_out: tuple[str, ...] = ()
    text_only: tuple[str, ...] = ()


def same(*names: str) -> tuple[tuple[str, str], ...]:
    return tuple((name, name) for name in names)


FRAME = Report("frame", "One scene through every read-out", "sim", "frame/summary.md", "frame/summary.md",
               with_it=same("frame/summary.csv", "frame/overview.png"))

# Beside the studies (studies.toml), which stand in front of the others.
HARDWARE = (
    Report("area", "Area", "synth", "area.md", excerpt=()),
    Report("power", "Power on a scene", "power", "power.md", says="from the activity of netlists, by day and at dusk", excerpt=()),
)
OTHERS = (
    Report("formal", "Proofs", "formal", "formal.md", says="the proved properties of the RTL, and the planted bugs that each proof finds"),
    Report("tmf8820", "Measured data: ams TMF8820", "sim", "tmf8820/summary.md", "tmf8820/summary.md",
           "a plane at 159 distances from 5 to 400 mm, through the RTL of every read-out",
           with_it=same("tmf8820/error.svg")),
    Report("scaling", "Sweeps", "sweep-cost", "scaling.md", "sweep_cost/scaling.md",
           "the cost of sweeps with many points, beside the cost of the points"),
    Report("sram", "SRAM macros", "synth", "sram.md", says="sizes, area, access time and energy"),
    Report("timing", "Timing", "synth", "timing.md", says="clock, slacks and slowest paths in each corner"),
    Report("estimate", "Estimates of dtof design", "synth-estimate", "estimate.md",
           says="area, power and clock from models, compared with the synthesis flow"),
    Report("layout", "Layout", "layout", "layout.md",
           says="columns placed and routed in OSU 0.18 um, and their wires compared with the wire-load model"),
    Report("fpga", "FPGA demonstrator", "fpga", "fpga.md", says="an iCE40 with hisPointer and with poolPointer"),
    Report("shuttle", "Chips in open silicon", "shuttle", "shuttle.md", says="two small chips in IHP's 130 nm cells: area, timing in three corners"),
    Report("fpga_check", "Small subsystems on FPGAs", "fpga-check", "fpga_check.md",
           says="block RAMs, look-up tables and flip-flops on four families"),
    Report("mutants", "Mutants", "mutate", "mutants.md", says="whether the tests notice small changes of RTL and models"),
    Report("coverage", "Coverage of the tests", "coverage", "coverage.md",
           says="lines, branches and toggles that the tests reach"),
)

def _studies() -> tuple[Report, ...]:
    """The reports of studies.toml."""
    found = []
    for name, study in reports.studies(ROOT).items():
        for page in study.get("page", []):
            found.append(Report(
                page.get("name", Path(page["file"]).stem), page["title"], name, page["file"], page.get("built"), page.get("says", ""),
                tuple(page["excerpt"]) if "excerpt" in page else None, tuple(page.get("pictures", ())),
                tuple((built, committed) for built, committed in page.get("with_it", ())), tuple(page.get("left_out", ())),
                tuple(page.get("text_only", ()))))
    return tuple(found)


STUDIES = _studies()
# Shown on the page of results, in this order.
SHOWN = (*(report for report in STUDIES if report.excerpt is not None), *HARDWARE)
# Listed, each on a page of its own.
LISTED = (*(report for report in STUDIES if report.excerpt is None), *OTHERS)

ALL = (FRAME, *SHOWN, *LISTED)


def without_pictures(text: str, kept: list[str]) -> str:
    """Text of a report for reports/: pictures that are not stored there are replaced by a sentence."""
    lines = []
    for line in text.splitlines():
        if line.startswith(PICTURE_LINE) and not any(f"]({name})" in line for name in kept):
            title = line[len(PICTURE_LINE):line.index("](")]
            line = f"*{title}: this report's command draws the picture in build/, and `make report` shows it.*"
        lines.append(line)
    return "\n".join(lines) + "\n"


def without_tables(lines: list[str]) -> list[str]:
    """Lines without tables and without their announcements (paragraphs of one line that end with a colon)."""
    kept: list[str] = []
    for line in lines:
        if line.startswith("|"):
            while kept and not kept[-1]:
                kept.pop()
            if kept and kept[-1].endswith(":"):
                kept.pop()
            continue
        kept.append(line)
    return kept


def shortened(report: Report, text: str) -> str:
    """The text without the parts in `left_out` and `text_only`, and with a sentence that says where these are."""
    note = f"*The whole report, with {{}} more lines of tables, is what `make {report.target}` writes to build/{report.built}; " \
        "`make report` shows it.*"
    pattern = re.compile(re.escape(note).replace(re.escape("{}"), r"(\d+)") + r"\n*$")
    before = pattern.search(text)
    parts = render.sections(pattern.sub("", text))
    kept: list[str] = []
    for path, lines in parts:
        here = "/".join(path)
        if not any(re.fullmatch(wanted, here) for wanted in report.left_out):
            kept += without_tables(lines) if any(re.fullmatch(wanted, here) for wanted in report.text_only) else lines
    left = sum(len(lines) for _, lines in parts) - len(kept) + (int(before[1]) if before else 0)
    short = re.sub(r"\n{3,}", "\n\n", "\n".join(kept)).strip()
    return f"{short}\n" if left <= 0 else f"{short}\n\n{note.format(left)}\n"


def for_reports(report: Report, root: Path) -> str:
    """Converts the text of a report in build/ to its form in reports/."""
    assert report.built is not None
    return as_committed(report, (root / "build" / report.built).read_text(encoding="utf-8"))


def as_committed(report: Report, text: str) -> str:
    folder = Path(report.committed).parent
    kept = [Path(name).relative_to(folder).as_posix() for _, name in report.with_it
            if Path(name).is_relative_to(folder) and not name.endswith(COMPRESSED)]
    built = Path("build", report.built or "").parent

    def link(match: re.Match[str]) -> str:
        return match[0] if match[1] in kept or match[1].startswith("../") else f"`{built / match[1]}`"

    text = TABLE_LINK.sub(link, without_pictures(text, kept))
    return shortened(report, text) if report.left_out or report.text_only else text


def page_data_built(report: Report, root: Path) -> Path:
    """The values of the report's page, from which its template makes the page, as the report's command leaves them."""
    assert report.built is not None
    return (root / "build" / report.built).with_suffix(".page.json")


def copy_table(source: Path, target: Path) -> None:
    """Copies a table, compressed if it is not yet. Equal tables give equal bytes."""
    target.parent.mkdir(parents=True, exist_ok=True)
    content = source.read_bytes()
    compress = target.suffix == COMPRESSED and source.suffix != COMPRESSED
    target.write_bytes(gzip.compress(content, mtime=0) if compress else content)


def chosen(report: Report, root: Path) -> Path | None:
    """File of the report to show: the one in build/, which has the pictures, unless the one in reports/ is newer."""
    committed = root / "reports" / report.committed
    built = root / "build" / report.built if report.built else None
    if built is None or not built.is_file():
        return committed if committed.is_file() else None
    if not committed.is_file() or built.stat().st_mtime >= committed.stat().st_mtime:
        return built
    return built if for_reports(report, root) == staleness.without_mark(committed.read_text(encoding="utf-8")) else committed
