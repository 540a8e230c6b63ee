# SPDX-License-Identifier: Apache-2.0
"""What the page shows: reports, where they lie, the commands that make them."""

from dataclasses import dataclass
from pathlib import Path

# A line that is a picture.
PICTURE_LINE = "!["


@dataclass(frozen=True)
class Report:
    """A Markdown report. `committed` is its copy under reports/, `built` what the command left in build/, where all its
    pictures are; a command without `built` writes to reports/ only. `with_it`: tables and pictures that lie under
    reports/, too, by their names in build/ and there."""

    name: str
    title: str
    target: str  # of make
    committed: str
    built: str | None = None
    says: str = ""  # what it is, for the page that lists it
    excerpt: tuple[str, ...] | None = None  # headings that the first page shows; (): all before the first one
    pictures: tuple[str, ...] = ()  # beside `built`, not named in its text
    with_it: tuple[tuple[str, str], ...] = ()


def same(*names: str) -> tuple[tuple[str, str], ...]:
    return tuple((name, name) for name in names)


FRAME = Report("frame", "One scene through every read-out", "sim", "frame/summary.md", "frame/summary.md",
               with_it=same("frame/summary.csv", "frame/overview.png"))

# Shown on the first page, in this order.
SHOWN = (
    Report("pareto", "Area against accuracy", "pareto", "pareto.md", excerpt=()),
    Report("area", "Area", "synth", "area.md", excerpt=()),
    Report("timing", "Timing and power", "synth", "timing.md", excerpt=("Power",)),
    Report("scenes", "Accuracy on scenes", "scenes", "scenes.md", "scenes/scenes.md",
           excerpt=(r"14 klux, (preset|sensor) thesis/All pixels.*", r"50 klux, (preset|sensor) thesis/All pixels.*"),
           pictures=("room_50klux_thesis.png", "disparity_map_50klux_thesis.png", "held_disparity_map_50klux_thesis.png",
                     "clutter_14klux_thesis.png", "confidence_14klux_thesis.svg", "confidence_50klux_thesis.svg"),
           with_it=(("scenes/scenes.csv", "scenes.csv"), ("scenes_variants/scenes.csv", "scenes_variants.csv"))),
    Report("reproduction", "The thesis's statements, measured", "reproduce", "reproduction.md",
           "reproduce/reproduction.md", excerpt=(),
           with_it=(("reproduce/reproduction.csv", "reproduction.csv"),
                    ("reproduce/reproduction/accuracy.csv", "reproduction/accuracy.csv"))),
    Report("formal", "Proofs", "formal", "formal.md", excerpt=()),
    Report("faults", "Faults", "faults", "faults.md", "faults/faults.md", excerpt=(),
           with_it=(("faults/faults.csv", "faults.csv"),)),
)

# Listed, each on a page of its own.
LISTED = (
    Report("tmf8820", "Measured data: ams TMF8820", "sim", "tmf8820/summary.md", "tmf8820/summary.md",
           "a plane at 159 distances from 5 to 400 mm, through the RTL of every read-out",
           with_it=same("tmf8820/summary.csv", "tmf8820/error.svg")),
    Report("tmf8829", "Measured data: ams TMF8829", "real-data", "tmf8829/summary.md", "tmf8829/summary.md",
           "26 frames of 16 x 16 pixels", pictures=("depth.png", "error.png"), with_it=same("tmf8829/summary.csv")),
    Report("photon_times", "Measured data: photon times", "real-data", "photon_times/summary.md",
           "photon_times/summary.md", "100 x 100 pixels that see two surfaces", pictures=("depth.png", "error.png"),
           with_it=same("photon_times/summary.csv")),
    Report("photon_times_behind", "Measured data: photon times, rear surface", "real-data",
           "photon_times_behind/summary.md", "photon_times_behind/summary.md",
           "the same without the photons of the front surface", pictures=("depth.png", "error.png"),
           with_it=same("photon_times_behind/summary.csv")),
    Report("trade", "poolPointer 2's colliding goals", "trade", "trade.md",
           says="shares of the frame and number of candidates as curves"),
    Report("pool", "poolPointer 2 on scenes", "pool", "pool.md", "pool/pool.md",
           says="with and without its last smoothing, beside full histograms, over four seeds",
           with_it=(("pool/pool.csv", "pool.csv"),)),
    Report("pool_without_table", "poolPointer 2 on scenes, without look-up tables", "pool", "pool_without_table.md",
           "pool_without_table/pool.md", says="the same by Eq. 3.11 alone"),
    Report("rivals", "Read-outs and their rivals", "rivals", "rivals.md", "rivals/report.md",
           "what others have proposed on the same photons: accuracy over memory, area and host work, and which read-out for "
           "which sensor", with_it=(("rivals/rivals.csv", "rivals.csv"), ("rivals/rival_hardware.csv", "rival_hardware.csv"))),
    Report("claims", "What the rivals' papers claim", "claims", "claims.md", "claims/claims.md",
           "the models beside their papers, on photons without pile-up", with_it=(("claims/claims.csv", "claims.csv"),)),
    Report("video", "Videos", "video", "video/video.md", "video/video.md",
           "accuracy from frame to frame, and what poolPointer 2 gains from the last one",
           with_it=same("video/video.csv", "video/room_light.svg")),
    Report("enlarge", "Small arrays, enlarged", "enlarge", "enlarge.md", "enlarge/enlarge.md",
           "small arrays' maps brought to the large array's pixels, at equal laser power",
           with_it=(("enlarge/enlarge.csv", "enlarge.csv"),)),
    Report("pulse_widths", "Pulses of other widths", "pulse-widths", "pulse_widths.md", "pulse_widths/pulse_widths.md",
           "read-outs beside the matched filter for pulses of 8 to 90 bins",
           with_it=(("pulse_widths/pulse_widths.csv", "pulse_widths.csv"),)),
    Report("pool_parts", "poolPointer 2, part by part", "pool-parts", "pool_parts.md", "pool_parts/pool_parts.md",
           "area and power of each part beside the errors without it",
           with_it=(("pool_parts/pool_parts.csv", "pool_parts.csv"),)),
    Report("frames", "Standard frames", "frames", "frames.md", "frames/frames.md",
           "the room scene with 3,333 pulses, and with 33,333 of a tenth of the energy and of the same",
           with_it=(("frames/frames.csv", "frames.csv"),)),
    Report("dynamic_range", "Dynamic range", "dynamic-range", "dynamic_range.md", "dynamic_range/dynamic_range.md",
           "read-outs from 8 to 65,535 acquisitions, in the dark and in the sun, with weak and strong signal",
           with_it=(("dynamic_range/data/dynamic_range.csv.gz", "data/dynamic_range.csv.gz"),)),
    Report("walk_error", "Walk error", "walk-error", "walk_error.md", "walk/walk_error.md",
           "bias over reflectivity, and what the host corrects",
           with_it=(("walk/walk_error.csv", "walk_error.csv"), ("walk/walk_error.svg", "walk_error.svg"))),
    Report("sensor_effects", "Effects of real sensors", "sensor-effects", "sensor_effects.md",
           "sensor_effects/sensor_effects.md",
           "measured TDC code widths, a measured pulse, dead time, hot pixels",
           with_it=(("sensor_effects/sensor_effects.csv", "sensor_effects.csv"),)),
    Report("sensor_effects_pool", "Effects of real sensors: poolPointer 2", "sensor-effects", "sensor_effects_pool.md",
           "sensor_effects_pool/sensor_effects.md", "the same for poolPointer 2, at one light",
           with_it=(("sensor_effects_pool/sensor_effects.csv", "sensor_effects_pool.csv"),)),
    Report("scaling", "Sweeps", "sweep-cost", "scaling.md", "sweep_cost/scaling.md",
           "what many points cost beside their own computing"),
    Report("sram", "SRAM macros", "synth", "sram.md", says="sizes, area, access time and energy"),
    Report("power", "Power on a scene", "power", "power.md", says="from the activity of netlists, by day and at dusk"),
    Report("coverage_study", "Confidence intervals", "coverage-study", "coverage_study.md",
           says="whether they hold over 40 seeds"),
    Report("speed_error", "Photon models: speed against error", "photon-report", "speed_error.md",
           says="the cheapest model for a stream, a sampler and a sweep"),
    Report("fidelity", "Photon models: what the fast one changes", "photon-report", "fidelity.md",
           says="figures that `--fidelity auto` chooses by"),
    Report("photon_speed", "Photon models: speed beside NumPy", "photon-bench", "photon_speed.md",
           says="detections per second, as multiples of two NumPy scripts"),
    Report("layout", "Layout", "layout", "layout.md",
           says="columns placed and routed in OSU 0.18 um, their wires beside the wire-load model"),
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


def for_reports(report: Report, root: Path) -> str:
    """The text of what lies in build/ as it is under reports/."""
    folder = Path(report.committed).parent
    kept = [Path(name).relative_to(folder).as_posix() for _, name in report.with_it if name.endswith((".png", ".svg"))]
    return without_pictures((root / "build" / report.built).read_text(encoding="utf-8"), kept)


def chosen(report: Report, root: Path) -> Path | None:
    """The report to show: what lies in build/, which has the pictures, unless reports/ has a newer one."""
    committed = root / "reports" / report.committed
    built = root / "build" / report.built if report.built else None
    if built is None or not built.is_file():
        return committed if committed.is_file() else None
    if not committed.is_file() or built.stat().st_mtime >= committed.stat().st_mtime:
        return built
    return built if for_reports(report, root) == committed.read_text(encoding="utf-8") else committed
