#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The photon model as a vectorised NumPy script: the side-by-side baseline of the C++ one.

Same work as the exact model of models/dtof/photon: a pixel's signal (Gaussian) and background (flat) events of a
frame, Poisson numbers, sorted in time, at most SLOTS kept per acquisition, TDC codes. Preset "thesis", a plane
from 0.8 to 5 m, 14 klux. Two scripts: "by acquisition" draws Poisson numbers for every acquisition, as the
model is defined; "by frame" knows that a frame's number is Poisson too and spreads its events over the
acquisitions, so that empty ones cost nothing. NumPy draws on one core. Writes its detections per second of
processor time beside the C++ figures of a Google Benchmark JSON file and their ratios to both scripts: of one
core (processor time on both sides) and, for runs of several threads, of the whole run (wall time of all threads
against the script's one core, whatever else the machine did).
"""
import argparse
import json
import time
from pathlib import Path

import numpy as np

from dtof_synth import program

ACQUISITIONS = 3333
NP = 10
SLOTS = 2
T_INT = 45e-9
FWHM = 2e-9
SIGNAL_AT_1M = 0.30
BACKGROUND = 0.15 + 1e4 * T_INT
SPEED_OF_LIGHT = 299792458.0


def by_acquisition(generator, depth):
    """Acquisition and code of every detection of one pixel's frame."""
    signal = generator.poisson(SIGNAL_AT_1M / depth**2, ACQUISITIONS)
    background = generator.poisson(BACKGROUND, ACQUISITIONS)
    index = np.arange(ACQUISITIONS)
    acquisition = np.concatenate([np.repeat(index, signal), np.repeat(index, background)])
    centre = 2 * depth / SPEED_OF_LIGHT + FWHM
    times = np.concatenate([generator.normal(centre, FWHM / 2.354820045, signal.sum()),
                            generator.random(background.sum()) * T_INT])
    inside = (times >= 0) & (times < T_INT)
    acquisition, times = acquisition[inside], times[inside]
    order = np.lexsort((times, acquisition))
    acquisition, times = acquisition[order], times[order]
    keep = np.ones(len(times), dtype=bool)
    keep[SLOTS:] = acquisition[SLOTS:] != acquisition[:-SLOTS]
    code = (times * ((1 << NP) / T_INT)).astype(np.uint16)
    return acquisition[keep], code[keep]


def by_frame(generator, depth):
    """As by_acquisition, but without a loop over acquisitions."""
    signal_count = generator.poisson(SIGNAL_AT_1M / depth**2 * ACQUISITIONS)
    background_count = generator.poisson(BACKGROUND * ACQUISITIONS)
    count = signal_count + background_count
    acquisition = generator.integers(0, ACQUISITIONS, count)
    times = np.empty(count)
    centre = 2 * depth / SPEED_OF_LIGHT + FWHM
    times[:signal_count] = generator.normal(centre, FWHM / 2.354820045, signal_count)
    times[signal_count:] = generator.random(background_count) * T_INT
    inside = (times >= 0) & (times < T_INT)
    position = np.sort(acquisition[inside] + times[inside] / T_INT)
    acquisition = position.astype(np.int64)
    keep = np.ones(len(position), dtype=bool)
    keep[SLOTS:] = acquisition[SLOTS:] != acquisition[:-SLOTS]
    code = ((position - acquisition) * (1 << NP)).astype(np.uint16)
    return acquisition[keep], code[keep]


def measure(pixel_detections, pixels, seed):
    """Detections per second over pixels spread evenly over the plane; best of three."""
    best = 0.0
    for _ in range(3):
        generator = np.random.Generator(np.random.SFC64(seed))
        detections = 0
        start = time.process_time()
        for depth in np.linspace(0.8, 5.0, pixels):
            detections += len(pixel_detections(generator, depth)[0])
        best = max(best, detections / (time.process_time() - start))
    return best


def rows_of(runs, baselines):
    """Table rows: what ran, milliseconds of a whole frame (None: not measured), detections per second (None: not counted)."""
    for name, rate in baselines.items():
        yield f"NumPy {np.__version__}, {name}, a core", None, rate
    for run in runs:
        label = run["name"].removesuffix("/process_time/real_time")
        rate = run.get("detections/s")
        if rate is None:
            yield label, run["real_time"], None
            continue
        if label.endswith("threads:1"):
            yield label, run["real_time"], rate * run["real_time"] / run["cpu_time"]
        else:
            yield label + ", a core", None, rate * run["real_time"] / run["cpu_time"]
            yield label + ", all", run["real_time"], rate


def report(runs, baselines):
    lines = ["# Photon models: speed beside NumPy", "",
             "Wall-clock time of a frame of the benchmark's plane (200 x 160 pixels, 3,333 acquisitions, 14 klux), detections per "
             "second, and the speed as a multiple of two vectorised NumPy scripts. Both scripts do the work of the exact model. One "
             "draws every acquisition, as the model is defined; the other draws a frame's events and spreads them over the acquisitions.", "",
             "`exact` and `fast_stream` draw streams, `fast_sampler` only the photons that a read-out requests, `frame` also runs "
             "hisPointer's model. `a core`: processor time; `all`: all threads of a run together. All figures are from one run on one "
             "machine, which may have done other work: compare the ratios. Command: `make photon-bench`", "",
             "| what | frame, ms | million detections/s | " + " | ".join(f"x {name}" for name in baselines) + " |",
             "|---|--:|--:|" + "--:|" * len(baselines)]
    for label, milliseconds, rate in rows_of(runs, baselines):
        cells = ["-" if milliseconds is None else f"{milliseconds:.0f}", "-" if rate is None else f"{rate / 1e6:.2f}"]
        cells += ["-" if rate is None else f"{rate / value:.1f}" for value in baselines.values()]
        lines.append(f"| {label} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=Path, help="Google Benchmark JSON of photon_bench")
    parser.add_argument("report", type=Path, help="Markdown file to write")
    parser.add_argument("--pixels", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    runs = json.loads(arguments.bench.read_text(encoding="utf-8"))["benchmarks"]
    baselines = {script.__name__.replace("_", " "): measure(script, arguments.pixels, arguments.seed)
                 for script in (by_acquisition, by_frame)}
    text = report(runs, baselines)
    arguments.report.write_text(text, encoding="utf-8")
    print(text, end="")


if __name__ == "__main__":
    program.run(main)
