# SPDX-License-Identifier: Apache-2.0
"""What the page shows: reports, where they lie, the commands that make them."""

import gzip
import re
from dataclasses import dataclass
from pathlib import Path

from figures import staleness

from . import render

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
    excerpt: tuple[str, ...] | None = None  # headings that the first page shows; (): all before the first one
    pictures: tuple[str, ...] = ()  # beside `built`, not named in its text
    with_it: tuple[tuple[str, str], ...] = ()
    left_out: tuple[str, ...] = ()
    text_only: tuple[str, ...] = ()


def same(*names: str) -> tuple[tuple[str, str], ...]:
    return tuple((name, name) for name in names)


FRAME = Report("frame", "One scene through every read-out", "sim", "frame/summary.md", "frame/summary.md",
               with_it=same("frame/summary.csv", "frame/overview.png"))

# Shown on the first page, in this order.
SHOWN = (
    Report("pareto", "Area against accuracy", "pareto", "pareto.md", excerpt=()),
    Report("frames", "Standard frames", "frames", "frames.md", "frames/frames.md",
           "the room scene with 3,333 pulses, and with 33,333 of a tenth of the energy and of the same",
           excerpt=(r"Pixels above 3 %.*",),
           with_it=(("frames/frames.csv", "frames.csv"),)),
    Report("area", "Area", "synth", "area.md", excerpt=()),
    Report("power", "Power on a scene", "power", "power.md", says="from the activity of netlists, by day and at dusk", excerpt=()),
)

# Listed, each on a page of its own.
LISTED = (
    Report("scenes", "Accuracy on scenes", "scenes", "scenes.md", "scenes/scenes.md", "every read-out on twelve scenes, by light",
           pictures=("room_50klux_thesis.png", "disparity_map_50klux_thesis.png", "held_disparity_map_50klux_thesis.png",
                     "clutter_14klux_thesis.png", "confidence_14klux_thesis.svg", "confidence_50klux_thesis.svg"),
           with_it=(("scenes/scenes.csv", "scenes.csv"), ("scenes_variants/scenes.csv", "scenes_variants.csv")),
           left_out=(r"[^/]*/(?!All pixels).*",)),
    Report("reproduction", "The thesis's statements, measured", "reproduce", "reproduction.md",
           "reproduce/reproduction.md", "each statement of the thesis beside what is measured here",
           with_it=(("reproduce/reproduction.csv", "reproduction.csv"),),
           left_out=("Other assumptions", "Other readings", "What relative precision hides", "Future work: .*")),
    Report("formal", "Proofs", "formal", "formal.md", says="what is proved of the RTL, and the planted bugs that break each proof"),
    Report("faults", "Faults", "faults", "faults.md", "faults/faults.md", "what one fault does to a frame and to the next one"),
    Report("tmf8820", "Measured data: ams TMF8820", "sim", "tmf8820/summary.md", "tmf8820/summary.md",
           "a plane at 159 distances from 5 to 400 mm, through the RTL of every read-out",
           with_it=same("tmf8820/error.svg")),
    Report("tmf8829", "Measured data: ams TMF8829", "real-data", "tmf8829/summary.md", "tmf8829/summary.md",
           "26 frames of 16 x 16 pixels", pictures=("depth.png", "error.png")),
    Report("photon_times", "Measured data: photon times", "real-data", "photon_times/summary.md",
           "photon_times/summary.md", "100 x 100 pixels that see two surfaces", pictures=("depth.png", "error.png")),
    Report("photon_times_behind", "Measured data: photon times, rear surface", "real-data",
           "photon_times_behind/summary.md", "photon_times_behind/summary.md",
           "the same without the photons of the front surface", pictures=("depth.png", "error.png")),
    Report("trade", "poolPointer 2's colliding goals", "trade", "trade.md",
           says="shares of the frame and number of candidates as curves"),
    Report("pool", "poolPointer 2 on scenes", "pool", "pool.md", "pool/pool.md",
           says="with and without its last smoothing, beside full histograms, over four seeds",
           with_it=(("pool/pool.csv", "pool.csv"),), left_out=(r"[^/]*/(?!All scenes).*",)),
    Report("pool_without_table", "poolPointer 2 on scenes, without look-up tables", "pool", "pool_without_table.md",
           "pool_without_table/pool.md", says="the same by Eq. 3.11 alone", left_out=(r"[^/]*/(?!All scenes).*",)),
    Report("rivals", "Read-outs and their rivals", "rivals", "rivals.md", "rivals/report.md",
           "what others have proposed on the same photons: accuracy over memory, area and host work, and which read-out for "
           "which sensor", with_it=(("rivals/rivals.csv", "data/rivals.csv.gz"),),
           left_out=(r"Area and host work/(?!14 klux).*", r"[^/]*/All (scenes|pixels).*")),
    Report("claims", "What the rivals' papers claim", "claims", "claims.md", "claims/claims.md",
           "the models beside their papers, on photons without pile-up"),
    Report("video", "Videos", "video", "video/video.md", "video/video.md",
           "accuracy from frame to frame, and what poolPointer 2 gains from the last one",
           with_it=same("video/room_light.svg")),
    Report("enlarge", "Small arrays, enlarged", "enlarge", "enlarge.md", "enlarge/enlarge.md",
           "small arrays' maps brought to the large array's pixels, at equal laser power"),
    Report("pulse_widths", "Pulses of other widths", "pulse-widths", "pulse_widths.md", "pulse_widths/pulse_widths.md",
           "read-outs beside the matched filter for pulses of 8 to 90 bins"),
    Report("pool_parts", "poolPointer 2, part by part", "pool-parts", "pool_parts.md", "pool_parts/pool_parts.md",
           "area and power of each part beside the errors without it"),
    Report("dynamic_range", "Dynamic range", "dynamic-range", "dynamic_range.md", "dynamic_range/dynamic_range.md",
           "read-outs from 8 to 65,535 acquisitions, in the dark and in the sun, with weak and strong signal",
           with_it=(("dynamic_range/data/dynamic_range.csv.gz", "data/dynamic_range.csv.gz"),)),
    Report("walk_error", "Walk error", "walk-error", "walk_error.md", "walk/walk_error.md",
           "bias over reflectivity, and what the host corrects",
           with_it=(("walk/walk_error.svg", "walk_error.svg"),)),
    Report("sensor_effects", "Effects of real sensors", "sensor-effects", "sensor_effects.md",
           "sensor_effects/sensor_effects.md",
           "measured TDC code widths, a measured pulse, dead time, hot pixels", text_only=(".+",)),
    Report("scaling", "Sweeps", "sweep-cost", "scaling.md", "sweep_cost/scaling.md",
           "what many points cost beside their own computing"),
    Report("sram", "SRAM macros", "synth", "sram.md", says="sizes, area, access time and energy"),
    Report("namings", "Namings", "synth-namings", "namings.md", says="how far area and slack depend on names alone"),
    Report("timing", "Timing", "synth", "timing.md", says="clock, slacks and slowest paths in each corner"),
    Report("coverage_study", "Confidence intervals", "coverage-study", "coverage_study.md", "coverage_study/coverage_study.md",
           "whether they hold over 40 seeds"),
    Report("coverage_study_long", "Confidence intervals of long runs", "coverage-study", "coverage_study_long.md",
           "coverage_study/coverage_study_long.md", "the same with 10,000 frames"),
    Report("coverage_study_pool", "Confidence intervals: poolPointer 2", "coverage-study", "coverage_study_pool.md",
           "coverage_study/coverage_study_pool.md", "the same for poolPointer 2, at one light"),
    Report("speed_error", "Photon models: speed against error", "photon-report", "speed_error.md", "photon_models/speed_error.md",
           "the cheapest model for a stream, a sampler and a sweep",
           with_it=(("photon_models/speed_error.svg", "speed_error.svg"),)),
    Report("fidelity", "Photon models: what the fast one changes", "photon-report", "fidelity.md", "photon_models/fidelity.md",
           "figures that `--fidelity auto` chooses by"),
    Report("photon_speed", "Photon models: speed beside NumPy", "photon-bench", "photon_speed.md",
           says="detections per second, as multiples of two NumPy scripts"),
    Report("layout", "Layout", "layout", "layout.md",
           says="columns placed and routed in OSU 0.18 um, their wires beside the wire-load model"),
    Report("fpga", "FPGA demonstrator", "fpga", "fpga.md", says="an iCE40 with hisPointer and with poolPointer 2"),
    Report("fpga_check", "Small subsystems on FPGAs", "fpga-check", "fpga_check.md",
           says="block RAMs, look-up tables and flip-flops on four families"),
    Report("mutants", "Mutants", "mutate", "mutants.md", says="whether the tests notice small changes"),
    Report("coverage", "Coverage of the tests", "coverage", "coverage.md",
           says="lines, branches and toggles that the tests reach"),
)

ALL = (FRAME, *SHOWN, *LISTED)


def without_pictures(text: str, kept: list[str]) -> str:
    """A report's text for reports/: pictures that are not kept there leave a sentence."""
    lines = []
    for line in text.splitlines():
        if line.startswith(PICTURE_LINE) and not any(f"]({name})" in line for name in kept):
            title = line[len(PICTURE_LINE):line.index("](")]
            line = f"*{title}: this report's command draws the picture in build/, and `make report` shows it.*"
        lines.append(line)
    return "\n".join(lines) + "\n"


def without_tables(lines: list[str]) -> list[str]:
    """Lines without tables and what announces them, a paragraph of one line that ends with a colon."""
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
    """The text without what `left_out` and `text_only` name, and with a sentence that says where that is."""
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
    """The text of what lies in build/ as it is under reports/."""
    return as_committed(report, (root / "build" / report.built).read_text(encoding="utf-8"))


def as_committed(report: Report, text: str) -> str:
    folder = Path(report.committed).parent
    kept = [Path(name).relative_to(folder).as_posix() for _, name in report.with_it
            if Path(name).is_relative_to(folder) and not name.endswith(COMPRESSED)]
    built = Path("build", report.built).parent

    def link(match: re.Match[str]) -> str:
        return match[0] if match[1] in kept or match[1].startswith("../") else f"`{built / match[1]}`"

    text = TABLE_LINK.sub(link, without_pictures(text, kept))
    return shortened(report, text) if report.left_out or report.text_only else text


def copy_table(source: Path, target: Path) -> None:
    """As it is, or compressed unless it is so already, always to the same bytes."""
    target.parent.mkdir(parents=True, exist_ok=True)
    content = source.read_bytes()
    compress = target.suffix == COMPRESSED and source.suffix != COMPRESSED
    target.write_bytes(gzip.compress(content, mtime=0) if compress else content)


def chosen(report: Report, root: Path) -> Path | None:
    """The report to show: what lies in build/, which has the pictures, unless reports/ has a newer one."""
    committed = root / "reports" / report.committed
    built = root / "build" / report.built if report.built else None
    if built is None or not built.is_file():
        return committed if committed.is_file() else None
    if not committed.is_file() or built.stat().st_mtime >= committed.stat().st_mtime:
        return built
    return built if for_reports(report, root) == staleness.without_mark(committed.read_text(encoding="utf-8")) else committed
