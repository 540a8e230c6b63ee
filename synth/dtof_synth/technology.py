# SPDX-License-Identifier: Apache-2.0
"""Prepares the libraries of a run: the generated ones, or any other Liberty, and the SRAM kit."""

from __future__ import annotations

import gzip
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from . import library, sram_kit, sram_model, standard_cells
from .configuration import Configuration, macro_sizes
from .errors import FlowError, given
from .files import write_if_changed
from .library import Library
from .sram_model import Macro, Size

SIZES = "synth/sram_sizes.csv"
TARGET_MHZ = 330.0


@dataclass(frozen=True)
class Technology:
    """Everything that a run needs besides the RTL. `slow`: library against which logic is mapped; `target_mhz`: clock for which it is
    mapped. Without `fast` nothing is timed with margins."""

    typical: Library
    slow: Library
    kit: Path
    root: Path
    target_mhz: float = TARGET_MHZ
    fast: Library | None = None

    def library(self, corner: str) -> Library:
        return given({"typical": self.typical, "slow": self.slow, "fast": self.fast}[corner], f"no library for the {corner} corner")


def needed_sizes(configurations: list[Configuration]) -> dict[Size, list[str]]:
    """Every SRAM size in use and the configurations that use it."""
    uses: dict[Size, list[str]] = {}
    for configuration in configurations:
        for size in macro_sizes(configuration):
            uses.setdefault(size, []).append(configuration.name)
    return uses


def _plain_liberty(path: Path, folder: Path) -> Path:
    """A Liberty for Yosys and OpenSTA: unpacked if it is gzipped."""
    if path.suffix != ".gz":
        if not path.is_file():
            raise FlowError(f"{path}: no such Liberty file")
        return path
    try:
        text = gzip.decompress(path.read_bytes()).decode("utf-8", "replace")
    except OSError as error:
        raise FlowError(f"{path}: cannot unpack the Liberty file ({error})") from None
    plain = folder / path.stem
    write_if_changed(plain, text)
    return plain


def prepare(root: Path, build: Path, configurations: list[Configuration],
            liberty: Path | None = None, liberty_slow: Path | None = None,
            macro_of: Callable[[Size], Macro] = sram_model.macro, target_mhz: float = TARGET_MHZ,
            more: Sequence[Configuration] = ()) -> Technology:
    """Prepares generated libraries, or `liberty`, which also serves the slow corner unless `liberty_slow` is given. `more`: configurations
    whose SRAMs are made even if the list of sizes lacks them."""
    build.mkdir(parents=True, exist_ok=True)
    listed = sram_kit.read_sizes(root / SIZES)
    for size, users in needed_sizes(configurations).items():
        if size not in listed:
            raise FlowError(f"{users[0]} needs the SRAM {size.name}, which is not in {SIZES}; "
                            "run make synth-sizes")
    listed = [*listed, *(size for size in needed_sizes(list(more)) if size not in listed)]
    kit = build / "technology"
    sram_kit.write_kit(kit, listed, macro_of)
    if liberty is None:
        paths = []
        for corner in standard_cells.CORNERS:
            paths.append(build / f"generic40_{corner.name}.lib")
            write_if_changed(paths[-1], standard_cells.library(corner))
    else:
        paths = [_plain_liberty(liberty, build), _plain_liberty(liberty_slow or liberty, build)]
    typical = library.read(paths[0])
    slow = typical if paths[1] == paths[0] else library.read(paths[1])
    fast = library.read(paths[2]) if len(paths) > 2 else None
    return Technology(typical, slow, kit, root, target_mhz, fast)
