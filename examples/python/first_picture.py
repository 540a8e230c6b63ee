# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # First picture
#
# A room, the sensor of the thesis, three read-outs. `first_picture.ipynb` is the notebook; `python3 first_picture.py` runs the same cells as
# a script. Pictures are drawn where matplotlib is installed. Files go to the folder of the script's first argument, or else to
# `build/python_examples`.

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
# ## One frame
#
# `dtof.frame` does what the command `dtof frame` does: it draws the photons, quantises their times as the TDC does, reads them out by the
# bit-exact models, and makes distances of the codes by a look-up table that a flat target gave.

# %%
frame = dtof.frame("room", "thesis", ["sifh", "hispointer", "poolpointer"], klux=14.0, seed=1)
for name in frame:
    made = frame[name]
    print(f"{made.readout.title:14} rmse {made.figures['rmse_m'] * 1e3:4.0f} mm, "
          f"{made.figures['share_above_3_percent']:6.2%} of the pixels off by more than 3 %")

# %% [markdown]
# ## Its maps
#
# Every map is an array (rows, columns): `depth_m` and `error_m` in m with NaN where a pixel has no distance, `confidence` on the
# read-out's own scale.

# %%
if pyplot is not None:
    figure, axes = pyplot.subplots(2, 4, figsize=(13, 5.6), layout="constrained")
    depth_scale = {"cmap": "viridis", "vmin": float(np.nanmin(frame.truth_m)), "vmax": float(np.nanmax(frame.truth_m))}
    depths = axes[0][0].imshow(frame.truth_m, **depth_scale)
    axes[0][0].set_title("truth")
    axes[1][0].set_axis_off()
    errors = None
    for column, name in enumerate(frame, 1):
        axes[0][column].imshow(frame[name].depth_m, **depth_scale)
        axes[0][column].set_title(frame[name].readout.title)
        errors = axes[1][column].imshow(frame[name].error_m * 1e3, cmap="coolwarm", vmin=-250, vmax=250)
    figure.colorbar(depths, ax=axes[0], label="depth, m")
    figure.colorbar(errors, ax=axes[1], label="error, mm")
    for one in axes.flat:
        one.set_xticks([])
        one.set_yticks([])
    figure.savefig(out / "first_picture.png", dpi=100)
    print(out / "first_picture.png")

# %% [markdown]
# ## What a pixel saw
#
# The photons themselves are at hand, too: here those of one pixel, and where each read-out says that its target is.

# %%
column, row = 120, 80
photons = dtof.photons(dtof.Scene("room"), dtof.Sensor("thesis"))
events = photons.column(column)
seen = events.timestamp[events.row_bounds[row]:events.row_bounds[row + 1]]
print(f"pixel ({column}, {row}): {len(seen)} events, true distance {frame.truth_m[row, column]:.3f} m")
for name in frame:
    print(f"  {frame[name].readout.title:14} code {frame[name].results.code[row, column]:4}, {frame[name].depth_m[row, column]:.3f} m")

# %%
if pyplot is not None:
    figure, axis = pyplot.subplots(figsize=(9, 3.2), layout="constrained")
    axis.hist(seen, bins=128, range=(0, 1024), color="0.7")
    for name, colour in zip(frame, ("tab:green", "tab:red", "tab:blue")):
        axis.axvline(frame[name].results.position[row, column], color=colour, label=frame[name].readout.title)
    axis.set_xlabel("TDC code")
    axis.set_ylabel("events in 8 codes")
    axis.set_title(f"pixel ({column}, {row})")
    axis.legend()
    figure.savefig(out / "first_picture_pixel.png", dpi=100)
    print(out / "first_picture_pixel.png")
