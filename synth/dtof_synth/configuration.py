# SPDX-License-Identifier: Apache-2.0
"""The named configurations of configurations.toml."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

from .errors import FlowError
from .sram_model import Size

# Numbers of the RTL parameter READOUT (hdl/package/dtof_pkg.sv).
READOUTS = {"ezpointer": 0, "hispointer1": 1, "hispointer": 2, "sifh": 3, "fifh": 4, "threesteps": 5,
            "pifh": 6, "histogram": 7}
POINTER_READOUTS = ("ezpointer", "hispointer1", "hispointer")
PARAMETERS = ("NP", "NB", "PIXELS_PER_SRAM", "SRAM_NUM", "SLOTS", "COUNT_WIDTH", "POINTER_STEP",
              "FRACTION_BITS", "CONFIDENCE_WIDTH", "GUARD", "WINDOW_CENTRED", "POINTER_PORTS",
              "SIGNALLED_CLEAR", "ACQ_WIDTH")


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

    def __getitem__(self, parameter: str) -> int:
        return self.parameters[parameter]

    @property
    def has_pointer(self) -> bool:
        return self.readout in POINTER_READOUTS

    @property
    def pixels(self) -> int:
        return self["PIXELS_PER_SRAM"] * self["SRAM_NUM"]

    def rtl_parameters(self) -> dict[str, int]:
        return {"READOUT": READOUTS[self.readout], **self.parameters}

    def with_parameters(self, name: str, **changes: int) -> Configuration:
        return replace(self, name=name, parameters={**self.parameters, **changes})


def bin_width(configuration: Configuration) -> int:
    """log2 of the bins the histogram SRAM holds for a pixel (dtof_pkg::bin_width)."""
    np, nb = configuration["NP"], configuration["NB"]
    return {"fifh": max(nb, np - nb), "threesteps": 4, "histogram": np}.get(configuration.readout, nb)


def memories(configuration: Configuration) -> dict[str, Size]:
    """The SRAMs of one column by what they hold. The RTL asks for the same sizes, or elaboration stops."""
    pixels, np, nb = (configuration[name] for name in ("PIXELS_PER_SRAM", "NP", "NB"))
    found: dict[str, Size] = {}
    if configuration.readout != "ezpointer":
        found["histogram"] = Size(2, pixels << bin_width(configuration), configuration["COUNT_WIDTH"])
    if configuration.has_pointer:
        tag = nb if configuration.readout == "hispointer" else 0
        word = np + configuration["FRACTION_BITS"] + configuration["CONFIDENCE_WIDTH"] + tag
        found["pointer"] = Size(configuration["POINTER_PORTS"], pixels, word)
    elif configuration.readout == "pifh" and nb < np:
        found["best peak"] = Size(1, pixels, 2 * configuration["COUNT_WIDTH"] + np)
    elif configuration.readout in ("sifh", "fifh", "threesteps"):
        peak = np - max(np - 9, 0) if configuration.readout == "threesteps" else nb
        found["coarse peak"] = Size(1, pixels, peak)
    return found


def bits_per_pixel(configuration: Configuration) -> float:
    return sum(size.capacity for size in memories(configuration).values()) / configuration["PIXELS_PER_SRAM"]


def load(path: Path) -> dict[str, Configuration]:
    """All configurations in the order of the file."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise FlowError(f"{path}: {error}") from None
    defaults = table.get("parameters", {})
    found: dict[str, Configuration] = {}
    for name, entry in table.get("configuration", {}).items():
        base = found.get(entry.get("variant_of", ""))
        if entry.get("variant_of") and base is None:
            raise FlowError(f"{path}: {name} is a variant of '{entry['variant_of']}', which is not above it")
        readout = entry.get("readout", base.readout if base else "")
        if readout not in READOUTS:
            raise FlowError(f"{path}: {name} has the unknown read-out '{readout}'; known: {', '.join(READOUTS)}")
        parameters = {**(base.parameters if base else defaults), **entry.get("parameters", {})}
        unknown = sorted(set(parameters) - set(PARAMETERS))
        missing = sorted(set(PARAMETERS) - set(parameters))
        if unknown or missing:
            what = f"unknown parameter {unknown[0]}" if unknown else f"no value for {missing[0]}"
            raise FlowError(f"{path}: {name} has {what}")
        found[name] = Configuration(name, readout, entry.get("title", name), parameters,
                                    entry.get("variant_of", ""), float(entry.get("thesis_mm2", 0)),
                                    entry.get("note", ""))
    if not found:
        raise FlowError(f"{path}: no [configuration.<name>] table found")
    return found
