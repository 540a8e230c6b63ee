# SPDX-License-Identifier: Apache-2.0
"""A model file of the leaderboard: a histogram of 32 bins for each pixel; its highest bin and the two beside it give the position.

    PYTHONPATH=build/cpp/python python3 -m dtof.leaderboard examples/leaderboard/peak_and_mean.py
"""

import numpy as np
import numpy.typing as npt

import dtof

TITLE = "peak and mean of 32 bins"
BITS_PER_PIXEL = 32 * 10  # 32 counters of 10 bits
BINS = 32


def read_out(photons: dtof.Photons, sensor: dtof.Sensor) -> npt.NDArray[np.float64]:
    events = photons.events()
    width = 2**sensor.np // BINS  # of a bin, in codes
    pixel = events["row"] * photons.columns + events["column"]
    counts = np.bincount(pixel * BINS + events["timestamp"] // width, minlength=photons.rows * photons.columns * BINS)
    counts = np.minimum(counts, 1023).reshape(photons.rows, photons.columns, BINS)
    peak = counts.argmax(axis=2)
    near = np.abs(np.arange(BINS) - peak[..., np.newaxis]) <= 1
    weights = np.where(near, counts - counts.min(axis=2, keepdims=True), 0)  # less the background
    total = weights.sum(axis=2)
    mean = (weights * (np.arange(BINS) + 0.5)).sum(axis=2) / np.maximum(total, 1)
    return np.where(total > 0, width * mean, np.nan)
