# SPDX-License-Identifier: Apache-2.0
"""Parts of an array's area, and the area of its macros and cells after placement.

reports/area.md's total is the sum of cells and macros. A placed array is larger: rows are not filled, a macro keeps
its neighbours at a distance, and flip-flops in a scan chain are larger.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from . import sram_model, wide_words
from .configuration import counted_macros
from .run import Result
from .sram_model import Macro, Size

UTILISATION = 0.75  # cells over the area of their rows
HALO_UM = 2.0  # around a macro
OTHER_MUX = 2


@dataclass(frozen=True)
class Parts:
    """Areas of the whole array's parts in um2; their sum is the total."""

    column_logic: float
    column_sram: float
    engines: float  # logic
    scratch_sram: float  # of the engines and of the shared logic
    control: float  # shared logic without engines
    fan_out: float  # trees of buffers in front of columns and engines

    @property
    def total(self) -> float:
        return (self.column_logic + self.column_sram + self.engines + self.scratch_sram + self.control
                + self.fan_out)


def parts(result: Result) -> Parts:
    engines = result.engines.area - result.engines.buffer_area
    return Parts(result.column.area * result.columns, result.sram_area * result.columns, engines,
                 result.engine_sram_area + result.shared_sram_area, result.shared.area - result.shared.buffer_area - engines,
                 result.shared.buffer_area)


def _macro_total(result: Result, area: Callable[[Macro], float]) -> float:
    return sum(number * area(sram_model.macro(size)) for number, size in counted_macros(result.configuration))


def _with_halo(macro: Macro) -> float:
    return (macro.width + 2 * HALO_UM) * (macro.height + 2 * HALO_UM)


def flip_flops(result: Result) -> int:
    return result.column_module.flip_flops * result.configuration.column_modules + result.shared.flip_flops


def scan(result: Result) -> float:
    """Additional area in um2 if every flip-flop has a multiplexer in front of it."""
    return flip_flops(result) * result.mux2_area


def placed(result: Result) -> float:
    """Area in um2 of cells at UTILISATION and macros with halos, without scan and clock tree."""
    cells = result.column.area * result.columns + result.shared.area
    return cells / UTILISATION + _macro_total(result, _with_halo)


def placed_with_all(result: Result) -> float:
    """Area in um2 as in `placed`, with scan and the estimated clock tree."""
    return placed(result) + (scan(result) + result.clock_tree.area) / UTILISATION


def doubtful_macros(results: Iterable[Result]) -> list[Size]:
    """Sizes of macros without a column multiplexer, or with words wider than the points of the fits."""
    sizes = {size for result in results for _, size in counted_macros(result.configuration)}
    return sorted(size for size in sizes if sram_model.macro(size).mux == 1 or size.bits > wide_words.FITTED_BITS)


def lacks_mux(result: Result) -> bool:
    return any(sram_model.macro(size).mux == 1 for _, size in counted_macros(result.configuration))


def total_with_other_mux(result: Result) -> float:
    """Area of the array in um2 if macros without a column multiplexer had one of OTHER_MUX."""
    def area(macro: Macro) -> float:
        return sram_model.macro(macro.size, OTHER_MUX).area if macro.mux == 1 else macro.area

    return parts(result).total + _macro_total(result, area) - _macro_total(result, lambda macro: macro.area)
