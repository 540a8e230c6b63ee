# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # Own data
#
# Measured histograms, lists of events and recordings through the read-outs: what would the chip have made of them?

# %%
import sys
from pathlib import Path

import numpy as np

import dtof

as_script = "ipykernel" not in sys.modules  # a notebook's arguments and pictures are those of Jupyter
try:
    import matplotlib
    matplotlib.use("Agg" if as_script else matplotlib.get_backend())
    from matplotlib import pyplot
except ImportError:  # figures are printed, pictures are not drawn
    pyplot = None

out = Path(sys.argv[1] if as_script and len(sys.argv) == 2 else "build/python_examples")
out.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## A histogram
#
# Any array (rows, columns, bins) of counts, from a file or another simulator. Here it is made up: a sensor of 24 x 32 pixels with bins of
# 250 ps sees a ramp from 1 to 4 m before a flat background.

# %%
random = np.random.default_rng(7)
ROWS, COLUMNS, BINS, BIN_S = 24, 32, 180, 250e-12
LIGHT_M_PER_S = 299_792_458.0
distance_m = np.broadcast_to(np.linspace(1.0, 4.0, COLUMNS), (ROWS, COLUMNS))
middle_of_bin_s = (np.arange(BINS) + 0.5) * BIN_S
arrival_s = 2.0 * distance_m / LIGHT_M_PER_S
pulse = np.exp(-0.5 * ((middle_of_bin_s - arrival_s[..., np.newaxis]) / 0.6e-9) ** 2)
counts = random.poisson(1.5 + 90.0 * pulse / distance_m[..., np.newaxis] ** 2)
print(counts.shape, counts.sum(axis=2).mean(), "photons a pixel")

# %% [markdown]
# `histogram_photons` makes the stream of a frame of it: every photon goes to a random laser pulse, and the TDC keeps the first two of a
# pulse. The zero of the distances is the measurement's own, so `dtof.depth` is given no pulse width.

# %%
photons = dtof.histogram_photons(counts, BIN_S, acquisitions=3333)
maps = {}
for name in ("histogram", "hispointer", "sifh"):
    results = dtof.read_out(photons, name)
    maps[name] = np.where(results.has_distance, dtof.depth(results.position), np.nan)
    errors = dtof.error_summary(distance_m, maps[name])
    print(f"{results.readout.title:12} rmse {errors.rmse_m * 1e3:5.0f} mm, bias {errors.bias_m * 1e3:4.0f} mm, "
          f"{errors.share_above_3_percent:6.2%} off by more than 3 %")

# %% [markdown]
# With `photons=` a frame has that mean number of a pixel, drawn from its histogram: as many frames as one likes of one capture, at less
# light.

# %%
for budget in (400, 100, 25):
    shares = []
    for number in range(8):
        thinned = dtof.histogram_photons(counts, BIN_S, photons=budget, frame=number)
        results = dtof.read_out(thinned, "hispointer")
        shares.append(dtof.error_summary(distance_m, dtof.depth(results.position)).share_above_3_percent)
    estimate = dtof.estimate_share_of_frames(shares, distance_m.size)
    low, high = estimate.interval
    print(f"hisPointer, {budget:3} photons a pixel: {estimate.value:6.2%} off by more than 3 % ({max(low, 0.0):.2%} to {high:.2%})")

# %% [markdown]
# ## A list of events
#
# What a time tagger delivers: of each event its pixel, its laser pulse and its TDC code. The order does not matter.

# %%
PULSES = 2000
events = 60 * COLUMNS * ROWS
column = random.integers(0, COLUMNS, events)
row = random.integers(0, ROWS, events)
pulse_number = random.integers(0, PULSES, events)
signal = random.random(events) < 0.6
time_s = np.where(signal, random.normal(arrival_s[row, column], 0.6e-9), random.uniform(0.0, 45e-9, events))
code = np.floor(time_s / 45e-9 * 1024).astype(int)
kept = (code >= 0) & (code < 1023)  # the last code means no detection
stream = dtof.event_list(column[kept], row[kept], pulse_number[kept], code[kept], columns=COLUMNS, rows=ROWS, acquisitions=PULSES, slots=4)
results = dtof.read_out(stream, dtof.Readout("hispointer", slots=4))
errors = dtof.error_summary(distance_m, dtof.depth(results.position))
print(f"{kept.sum()} events: {errors.share_above_3_percent:.2%} off by more than 3 %")

# %% [markdown]
# ## A recording
#
# `read_recording` takes the files that `dtof replay` takes (docs/reference/formats.md): streams as CSV, histograms as NPY, logs of TMF8820
# and TMF8829, photon times of a MAT file. Here the stream from above goes to a file and comes back.

# %%
stream.write_csv(str(out / "own_data.csv"))
recording = dtof.read_recording(str(out / "own_data.csv"), slots=4, columns=COLUMNS, rows=ROWS, acquisitions=PULSES)
again = dtof.read_out(recording.photons, dtof.Readout("hispointer", slots=4))
print(f"{recording.description}: the same codes: {np.array_equal(again.code, results.code)}")

# %% [markdown]
# ## Files for others

# %%
depth_m = maps["hispointer"]
dtof.save_ply(out / "own_data.ply", depth_m, 0.5, photons=counts.sum(axis=2))
dtof.save_pcd(out / "own_data.pcd", depth_m, 0.5, photons=counts.sum(axis=2))
np.savez_compressed(out / "own_data.npz", depth_m=depth_m, counts=counts)
with np.load(out / "own_data.npz") as archive:  # and an archive's map is a scene again
    frame = dtof.frame(dtof.Scene.from_depth(archive["depth_m"]), "thesis", "poolpointer")
print(f"the map, seen by the thesis's sensor: {frame['poolpointer'].figures['share_above_3_percent']:.2%} off by more than 3 %")

# %%
if pyplot is not None:
    figure, axes = pyplot.subplots(1, 4, figsize=(13, 2.9), layout="constrained")
    shown = axes[0].imshow(distance_m, vmin=0.8, vmax=4.2)
    axes[0].set_title("made up")
    for axis, (name, made) in zip(axes[1:], maps.items()):
        axis.imshow(made, vmin=0.8, vmax=4.2)
        axis.set_title(dtof.Readout(name).title)
    for axis in axes:
        axis.set_xticks([])
        axis.set_yticks([])
    figure.colorbar(shown, ax=axes, label="depth, m")
    figure.savefig(out / "own_data.png", dpi=100)
    print(out / "own_data.png")
