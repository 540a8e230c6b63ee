# SPDX-License-Identifier: Apache-2.0
"""The named configurations of configurations.toml."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path

from . import readouts
from .errors import FlowError
from .sram_model import Size

SCRATCH_PARITIES = 2  # dtof_pkg::POOL_SCRATCH_PARITIES
CONFIDENCE_WIDTH = 8  # dtof_pkg::pool_confidence_width of the advantages that significances need


@dataclass(frozen=True)
class Configuration:
    """One row of the table: a read-out and all its RTL parameters."""

    name: str
    readout: str
    title: str
    parameters: dict[str, int]
    variant_of: str = ""
    thesis_mm2: float = 0.0
    note: str = ""
    simulation: dict[str, int] = field(default_factory=dict)  # what the simulated array has instead

    def __getitem__(self, parameter: str) -> int:
        return self.parameters[parameter]

    @property
    def described(self) -> readouts.Readout:
        return readouts.load().readouts[self.readout]

    @property
    def has_pointer(self) -> bool:
        return self.described.kind == "pointer"

    @property
    def is_pool(self) -> bool:
        return self.described.kind == "pool"

    @property
    def top(self) -> str:
        return self.described.top

    @property
    def module_columns(self) -> int:
        """Columns of a column module: 4 in pool read-outs (2 if an engine has only two columns), else 1."""
        return min(4 if self.engine_columns > 2 else 2, self["SRAM_NUM"]) if self.is_pool else 1

    @property
    def column_modules(self) -> int:
        return -(-self["SRAM_NUM"] // self.module_columns)

    @property
    def engine_columns(self) -> int:
        """Columns that share an engine; 0 without engines (all but the pool read-outs)."""
        return self["ENGINE_COLUMNS"] if self.is_pool else 0

    @property
    def engines(self) -> int:
        return -(-self["SRAM_NUM"] // self.engine_columns) if self.is_pool else 0

    @property
    def pixels(self) -> int:
        return self["PIXELS_PER_SRAM"] * self["SRAM_NUM"]

    def rtl_parameters(self) -> dict[str, int]:
        number = self.described.number
        return self.parameters if number is None else {"READOUT": number, **self.parameters}

    def with_parameters(self, name: str, **changes: int) -> Configuration:
        return replace(self, name=name, parameters={**self.parameters, **changes})


def bin_width(configuration: Configuration) -> int:
    """log2 of the bins per pixel in the histogram SRAM; only for read-outs with such an SRAM."""
    width = configuration.described.bin_width
    if width is None:
        raise FlowError(f"{configuration.name}: the read-out has no histogram")
    return readouts.evaluate(width, configuration.parameters)


def memories(configuration: Configuration) -> dict[str, Size]:
    """SRAMs of one column module by content. The RTL must ask for the same sizes, or elaboration stops."""
    if configuration.is_pool:
        groups = -(-configuration["PIXELS_PER_SRAM"] // configuration["GROUP_SIZE"])
        words = groups * (configuration["GROUP_SIZE"] // 2) + -(-groups // 2)
        pairs = -(-configuration.module_columns // 2)
        half = pool_word_width(configuration)
        parts = 4 * pairs if half == 2 * pool_pixel_width(configuration) else 2 * pairs
        return {"pixels and groups": Size(1, words, pairs * 2 * half, parts)}
    sizes = {name: Size(*(readouts.evaluate(part, configuration.parameters) for part in size))
             for name, size in configuration.described.memories.items()}
    return {name: size for name, size in sizes.items() if size.words > 0}


def pool_pixel_width(configuration: Configuration) -> int:
    """Bits of a pixel's word (dtof_pkg::pool_track_width, pool_point_width)."""
    labels = configuration["LABELS"]
    label_width = max(1, (labels - 1).bit_length())
    track = labels * configuration["SCORE_BITS"]
    if configuration["OFFSET_BITS"] > 0:
        track += label_width + configuration["OFFSET_BITS"]
    moves = configuration["RIVAL_MOVES"]
    point = (configuration["ADVANTAGE_WIDTH"] + (16 if moves else 12) - configuration["POINTER_SHIFT"]
             + (7 if moves else 2 * label_width))
    return max(track, point)


def pool_word_width(configuration: Configuration) -> int:
    """Bits of a half of the SRAM word: two pixel words or a group word (dtof_pkg::pool_half_width, pool_group_width)."""
    labels = configuration["LABELS"]
    return max(2 * pool_pixel_width(configuration), 7 * labels + _background_width(configuration))


def _background_width(configuration: Configuration) -> int:
    """Bits of the background in a group's word (dtof_pkg::pool_background_width)."""
    return min(max(2 * pool_pixel_width(configuration) - 7 * configuration["LABELS"], 4), 6)


def _has_significances(configuration: Configuration) -> bool:
    """Whether a group's word has the candidates' significances (dtof_pkg::pool_significance_width)."""
    labels = configuration["LABELS"]
    used = 7 * labels + _background_width(configuration) + 1 + (labels if configuration["PRIOR"] else 0)
    room = 2 * pool_pixel_width(configuration) - used
    return room >= 2 * labels and configuration["ADVANTAGE_WIDTH"] == 7 and configuration["RIVAL_MOVES"] == 1


def engine_memories(configuration: Configuration) -> dict[str, Size]:
    """The SRAMs of one engine."""
    if not configuration.is_pool:
        return {}
    # Messages of choose with cell and offset chosen in the column to the left, or of decide with the winner there: its position, and its
    # confidence if a group's word has significances (dtof_pool_engine).
    choose = 4 * configuration["LABELS"] + 7 + configuration["OFFSET_BITS"]
    decide = 2 * 2 + 16 + (CONFIDENCE_WIDTH if _has_significances(configuration) else 0)
    return {"messages": Size(1, configuration["PIXELS_PER_SRAM"], max(choose, decide) + SCRATCH_PARITIES * configuration["PARITY"])}


def shared_memories(configuration: Configuration) -> dict[str, Size]:
    """The SRAMs of the shared logic: the parities of all words that the columns' SRAMs of a pool read-out hold."""
    if not configuration.is_pool or configuration["PARITY"] == 0:
        return {}
    (words,) = memories(configuration).values()
    return {"parities": Size(1, words.words, configuration.column_modules)}


def counted_macros(configuration: Configuration) -> list[tuple[int, Size]]:
    """(number in the array, size) for each kind of SRAM."""
    return [*((configuration.column_modules, size) for size in memories(configuration).values()),
            *((configuration.engines, size) for size in engine_memories(configuration).values()),
            *((1, size) for size in shared_memories(configuration).values())]


def macro_sizes(configuration: Configuration) -> list[Size]:
    return [size for _, size in counted_macros(configuration)]


def bits_per_pixel(configuration: Configuration) -> float:
    """Bits of the SRAMs for a pixel, without those of the engines."""
    pixels = configuration["PIXELS_PER_SRAM"] * configuration.module_columns
    shared = sum(size.capacity for size in shared_memories(configuration).values()) / configuration.pixels
    return sum(size.capacity for size in memories(configuration).values()) / pixels + shared


def load(path: Path) -> dict[str, Configuration]:
    """All configurations in the order of the file. If it is `complete`, default configurations of missing read-outs follow."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise FlowError(f"{path}: {error}") from None
    found: dict[str, Configuration] = {}
    entries = dict(table.get("configuration", {}))
    if table.get("complete", False):
        named = {entry.get("readout") for entry in entries.values()}
        entries |= {name.replace("-", "_"): {"readout": name} for name, readout in readouts.load().readouts.items()
                    if readout.top and name not in named}
    for name, entry in entries.items():
        base = found.get(entry.get("variant_of", ""))
        if entry.get("variant_of") and base is None:
            raise FlowError(f"{path}: {name} is a variant of '{entry['variant_of']}', which is not above it")
        readout = entry.get("readout", base.readout if base else "")
        known_readouts = readouts.load().readouts
        if readout not in known_readouts:
            raise FlowError(f"{path}: {name} has the unknown read-out '{readout}'; known: {', '.join(known_readouts)}")
        if not known_readouts[readout].top:
            raise FlowError(f"{path}: {name}: there is no RTL of {readout}")
        defaults = readouts.load().defaults(readout)
        parameters = {**(base.parameters if base else defaults), **entry.get("parameters", {})}
        simulation = {**(base.simulation if base else table.get("simulation", {})), **entry.get("simulation", {})}
        unknown = sorted((set(parameters) | set(simulation)) - set(defaults))
        if unknown:
            raise FlowError(f"{path}: {name} has unknown parameter {unknown[0]}")
        found[name] = Configuration(name, readout, entry.get("title", known_readouts[readout].title), parameters,
                                    entry.get("variant_of", ""), float(entry.get("thesis_mm2", 0)),
                                    entry.get("note", ""), simulation)
    if not found:
        raise FlowError(f"{path}: no [configuration.<name>] table found")
    return found
