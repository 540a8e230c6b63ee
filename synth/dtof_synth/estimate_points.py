# SPDX-License-Identifier: Apache-2.0
"""Measures the points of models/dtof/design/estimate_points.toml: area and clock of all, power of some."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from . import batch, configuration, estimate, scene_power
from . import technology as technologies
from .run import Result

# Their netlists are simulated with a scene's photons, which takes a minute each.
WITH_POWER = ("estimate_hispointer_64x48", "estimate_fifh_100x80", "estimate_poolpointer_64x48", "estimate_lean_64x48",
              "estimate_ezpointer_25x1280", "estimate_poolpointer_labels4")


def _power(part: scene_power.Parts) -> dict[str, float]:
    return {"columns": part.columns, "shared": part.engines + part.control, "sram": part.sram, "clock": part.clock,
            "leakage": part.leakage}


def measured(result: Result, powers: list[scene_power.ScenePower]) -> estimate.Measured:
    name = result.configuration.name
    lights = {one.light: _power(one.streaming) for one in powers if one.configuration.name == name}
    return estimate.Measured(result.configuration, result.column.area, result.shared.area, result.engines.area, result.total_mm2,
                             result.timing["slow"].fmax_mhz, lights)


def run(root: Path, seed: int, jobs: int, say: Callable[[str], None]) -> None:
    """Synthesises all points, simulates some, and writes estimate.MEASURED."""
    points = configuration.load(root / estimate.POINTS)
    build = root / "build" / "synth"
    technology = technologies.prepare(root, build / "estimate", [], more=list(points.values()))
    runs = build / "runs_estimate"
    results = batch.run_all([batch.Job(item) for item in points.values()], technology, runs, jobs, say)
    chosen = [points[name] for name in WITH_POWER]
    powers = scene_power.run(chosen, results, runs, technology, build / "power_estimate", seed, jobs, say)
    estimate.write_points(root, [measured(result, powers) for result in results.values()])
