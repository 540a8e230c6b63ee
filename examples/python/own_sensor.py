# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # Own sensor
#
# From a sensor file to a table of read-outs (which one serves this sensor in this light, and how sure is that?), and on to a chip: RTL, driver
# and test bench for the sensor.

# %%
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
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
# ## The sensor
#
# A sensor file describes laser, SPADs and TDC (docs/user/sensor_file.md). `dtof.preset_text("thesis")` is one to start from; here is a
# small one. What the file does not name is off or has a default.

# %%
sensor_file = """
name = "mine"

[array]
columns = 34
rows = 32
field_of_view_deg = 40.0

[tdc]
range_ns = 60.0
timestamp_bits = 10

[laser]
acquisitions = 2000
pulse_fwhm_ns = 1.2

[light]
signal_events_at_1m = 0.25
background_events_per_klux = 0.018

[detector]
dark_count_rate_hz = 2e4
dead_time_ns = 8.0
"""
sensor = dtof.Sensor.parse(sensor_file, "mine.toml")
print(sensor)
print(f"range {sensor.range_m:.2f} m, a bin is {sensor.time_resolution_s * 1e12:.0f} ps, "
      f"{sensor.signal_events(2.0):.3f} signal and {sensor.background_events(14.0):.3f} background events a pulse at 2 m and 14 klux")

# %% [markdown]
# ## Read-outs by light
#
# Pixels of a frame are correlated (they share a scene, and pool read-outs combine pixels), frames are independent: the 95 % interval comes
# from the frames. Four frames at each of three light levels.

# %%
READOUTS = ["ezpointer", "hispointer", "sifh", "coarsehistogram", "poolpointer", "poolpointer-lean"]
LIGHTS = [2.0, 14.0, 50.0]
FRAMES = 4
scene = dtof.Scene("room", sensor)
estimates = {}
for klux in LIGHTS:
    frames = [dtof.frame(scene, sensor, READOUTS, klux=klux)]
    tables = {name: frames[0][name].table for name in READOUTS}  # fitted once for each light
    frames += [dtof.frame(scene, sensor, READOUTS, klux=klux, table=tables, frame=number) for number in range(1, FRAMES)]
    pixels = int(np.count_nonzero(~np.isnan(frames[0].truth_m)))
    for name in READOUTS:
        shares = [frame[name].figures["share_above_3_percent"] for frame in frames]
        rmse = [frame[name].figures["rmse_m"] for frame in frames]
        estimates[name, klux] = dtof.estimate_share_of_frames(shares, pixels), dtof.estimate_mean(rmse)

# %%
print("pixels off by more than 3 % of the distance, and rmse in mm, with intervals of 95 %")
print(f"{'':20}" + "".join(f"{f'{klux:g} klux':^36}" for klux in LIGHTS))
for name in READOUTS:
    line = f"{dtof.Readout(name).title:20}"
    for klux in LIGHTS:
        share, rmse_m = estimates[name, klux]
        low, high = share.interval
        line += f"{share.value:7.2%} ({max(low, 0.0):6.2%} to {high:6.2%}) {rmse_m.value * 1e3:6.0f} mm "
    print(line)

# %% [markdown]
# ## Parameters
#
# Every parameter of a read-out is a keyword. Here hisPointer's coarse histogram has other numbers of bins.

# %%
for bits in (3, 4, 5, 6):
    readout = dtof.Readout("hispointer", sensor, nb=bits)
    made = dtof.frame(scene, sensor, readout, klux=14.0)["hispointer"]
    print(f"hisPointer with {1 << bits:2} coarse bins: {made.figures['share_above_3_percent']:6.2%} off by more than 3 %")

# %% [markdown]
# ## What others propose
#
# Rivals read the same photons. `rival.flat_table` is their look-up table, fitted as a read-out's is.

# %%
photons = dtof.photons(scene, sensor, klux=14.0)
for name in ("histogram32", "hedh4", "gray8"):
    rival = dtof.Rival(name, sensor)
    distance = rival.flat_table(klux=14.0).distance(rival.read_out(photons)["position"])
    errors = dtof.error_summary(scene.depth_m, distance)
    print(f"{rival.title:20} {rival.bits_per_pixel:4} bits a pixel: {errors.share_above_3_percent:6.2%} off by more than 3 %")

# %%
if pyplot is not None:
    figure, axis = pyplot.subplots(figsize=(7.5, 4.2), layout="constrained")
    for name in READOUTS:
        values = np.array([[estimates[name, klux][0].value, *estimates[name, klux][0].interval] for klux in LIGHTS]) * 100.0
        below = np.clip(values[:, 0] - values[:, 1], 0.0, values[:, 0])
        axis.errorbar(LIGHTS, values[:, 0], yerr=[below, values[:, 2] - values[:, 0]], marker="o", capsize=3,
                      label=dtof.Readout(name).title)
    axis.set_xscale("log")
    axis.set_xticks(LIGHTS, [f"{klux:g}" for klux in LIGHTS])
    axis.minorticks_off()
    axis.set_xlabel("light, klux")
    axis.set_ylabel("pixels off by more than 3 %, %")
    axis.set_title(f"sensor {sensor.name}, scene {scene.name}, {FRAMES} frames, intervals of 95 %")
    axis.legend()
    figure.savefig(out / "own_sensor.png", dpi=100)
    print(out / "own_sensor.png")

# %% [markdown]
# ## From the sensor to a chip
#
# The program `dtof` goes on from here (docs/user/design.md): `dtof design` recommends a read-out within limits of area, power, frame rate and clock,
# and `dtof product` writes a folder for an integrator. The program is looked for in the folder DTOF_BIN, in PATH and where `make` puts it.

# %%
built = [str(folder / "build" / "cpp" / "bin") for folder in (Path.cwd(), *Path.cwd().parents)]
places = [os.environ.get("DTOF_BIN", ""), os.environ.get("PATH", ""), *built]
program = shutil.which("dtof", path=os.pathsep.join(filter(None, places)))
if program is None:
    print("no chip: the program dtof is not found; build it with make, or put its folder into PATH")
else:
    dtof_program = Path(program).absolute()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "mine.toml").write_text(sensor_file, encoding="utf-8")

        def dtof_says(*arguments):
            """The JSON object that the program prints."""
            done = subprocess.run(arguments, executable=dtof_program, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
            return json.loads(done.stdout)

        design = dtof_says("dtof", "design", "--quick", "--sensor", "mine.toml", "--klux", "14", "--max-mm2", "0.3", "--out", "design", "--json")
        print(f"recommended: {design['readout']}, {design['mm2']:.2f} mm2")
        print(f"its product: {design['product']}")
        product = dtof_says(*shlex.split(design["product"]), "--vector-acquisitions", "4", "--json")
        for entry in sorted((folder / product["out"]).iterdir()):
            if entry.is_dir():
                print(f"  {entry.name + '/':14}{sum(file.is_file() for file in entry.rglob('*')):4} files")
            else:
                print(f"  {entry.name}")
