# SPDX-License-Identifier: Apache-2.0
"""Depth maps as point clouds and archives."""

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from dtof._core import Frame

FileName = str | os.PathLike[str]


def point_cloud(depth_m: npt.ArrayLike, degrees_per_pixel: float) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]:
    """Returns the points (n, 3) in m of a depth map (rows, columns) in m, and which pixels have a point (rows, columns): those with a
    distance above 0.

    The projection is equiangular, as in the program's PLY: a pixel's column and row each turn the ray by `degrees_per_pixel` about the
    map's middle. Camera axes: x right, y down, z ahead.
    """
    depth = np.asarray(depth_m, dtype=np.float32)
    if depth.ndim != 2:
        raise ValueError(f"a depth map has two axes (rows, columns), this one has {depth.ndim}")
    rows, columns = depth.shape
    if not 0.0 < degrees_per_pixel * max(rows, columns) < 180.0:
        raise ValueError(f"a point cloud of {columns} x {rows} pixels of {degrees_per_pixel:g} degrees each: "
                         "its sides must be above 0 and below 180 degrees")
    known = np.isfinite(depth) & (depth > 0.0)
    radians = degrees_per_pixel * np.pi / 180.0
    azimuth = ((np.arange(columns) - (columns - 1) / 2.0) * radians)[np.newaxis, :]
    elevation = ((np.arange(rows) - (rows - 1) / 2.0) * radians)[:, np.newaxis]
    distance = depth.astype(np.float64)
    axes = (distance * np.sin(azimuth) * np.cos(elevation), distance * np.sin(elevation), distance * np.cos(azimuth) * np.cos(elevation))
    return np.stack([axis[known] for axis in axes], axis=1).astype(np.float32), known


def _records(depth_m: npt.ArrayLike, degrees_per_pixel: float, fields: dict[str, npt.ArrayLike]) -> npt.NDArray[Any]:
    """One record per point: x, y, z and the value of each further map, as float32."""
    points, known = point_cloud(depth_m, degrees_per_pixel)
    maps = {name: np.asarray(values) for name, values in fields.items()}
    for name, values in maps.items():
        if not name.isidentifier() or name in ("x", "y", "z"):
            raise ValueError(f"'{name}' is no name of a field: letters, digits and _, and not x, y or z")
        if values.shape != known.shape:
            raise ValueError(f"{name}: its shape is {values.shape}, that of the depth map {known.shape}")
    names = ("x", "y", "z", *maps)
    records = np.empty(len(points), dtype=[(name, "<f4") for name in names])
    for axis, name in enumerate(names[:3]):
        records[name] = points[:, axis]
    for name, values in maps.items():
        records[name] = values[known]
    return records


def save_ply(file: FileName, depth_m: npt.ArrayLike, degrees_per_pixel: float, **fields: npt.ArrayLike) -> None:
    """Writes a binary PLY of the pixels with a distance: x, y, z in m. Further maps of the same shape (confidence=...) become properties.
    Raises ValueError for another shape."""
    records = _records(depth_m, degrees_per_pixel, fields)
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(records)}",
             *(f"property float {name}" for name in records.dtype.names or ()), "end_header", ""]
    with open(file, "wb") as stream:
        stream.write("\n".join(lines).encode("ascii"))
        stream.write(records.tobytes())


def save_pcd(file: FileName, depth_m: npt.ArrayLike, degrees_per_pixel: float, **fields: npt.ArrayLike) -> None:
    """Writes a binary PCD 0.7 (Point Cloud Library) of the pixels with a distance: x, y, z in m. Further maps of the same shape
    (confidence=...) become fields. Raises ValueError for another shape."""
    records = _records(depth_m, degrees_per_pixel, fields)
    names = records.dtype.names or ()
    lines = ["# .PCD v0.7 - Point Cloud Data file format", "VERSION 0.7", "FIELDS " + " ".join(names), "SIZE" + " 4" * len(names),
             "TYPE" + " F" * len(names), "COUNT" + " 1" * len(names), f"WIDTH {len(records)}", "HEIGHT 1", "VIEWPOINT 0 0 0 1 0 0 0",
             f"POINTS {len(records)}", "DATA binary", ""]
    with open(file, "wb") as stream:
        stream.write("\n".join(lines).encode("ascii"))
        stream.write(records.tobytes())


def save_npz(file: FileName, frame: Frame) -> None:
    """Writes an archive for numpy.load: truth_m, and for each read-out <name>_depth_m, <name>_error_m, <name>_code, _fraction and
    _confidence."""
    arrays: dict[str, Any] = {"truth_m": frame.truth_m}
    for name in frame:
        made = frame[name]
        arrays |= {f"{name}_depth_m": made.depth_m, f"{name}_error_m": made.error_m, f"{name}_code": made.results.code,
                   f"{name}_fraction": made.results.fraction, f"{name}_confidence": made.results.confidence}
    np.savez_compressed(os.fspath(file), **arrays)
