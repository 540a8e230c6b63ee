# SPDX-License-Identifier: Apache-2.0
"""Results of a configuration with figures of choice, for tests."""

from dataclasses import replace
from pathlib import Path

from dtof_synth import configuration
from dtof_synth.netlist import Counts
from dtof_synth.power import ClockTree, Power
from dtof_synth.run import Result
from dtof_synth.timing import Margin, Timing

ROOT = Path(__file__).resolve().parents[2]
NONE = Counts(0, 0, 0.0, 0, 0.0, 0.0, 0.0)
TIMING = Timing(0.3, 0.1, 0.2, 400.0, "a", "b", 5, 0)
MARGIN = Margin(0.2, 0.1, 0.3, "a", "b")


def result(name: str, logic_um2: float = 500.0, shared_um2: float = 0.0) -> Result:
    """All slacks are positive, and the array's columns have `logic_um2` of cells each."""
    chosen = configuration.load(ROOT / "configurations.toml")[name]
    return Result(chosen, replace(NONE, area=logic_um2 * chosen.module_columns), replace(NONE, area=shared_um2), NONE,
                  ClockTree(1, 1.0, 0.0), 0.8, 2.0, {"slow": TIMING, "typical": TIMING}, Power(1.0, 2.0, 3.0),
                  {"slow": MARGIN, "fast": MARGIN})
