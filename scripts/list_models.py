#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the models of a top module to Verilate, one per line: name, then names and values for dtof_verilate() of CMake.

`list_models.py readouts dtof_array`: the read-outs of configurations.toml, with many columns.
`list_models.py waveforms dtof_array`: the same to look at: with one column and waveforms.
`list_models.py variants dtof_array`: its variants, with one column.
`list_models.py readouts|waveforms dtof_pool_pointer_array`: the engines that the read-outs' columns cut into: the columns of one
depend on each other, so that an array of other columns reads something else. Those without waveforms also have an engine of
few columns.
"""

import sys
from pathlib import Path

from dtof_synth import program
from dtof_synth.configuration import Configuration, load
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parent.parent
SMALL_COLUMNS = [3]  # of an engine for small sensors
HARNESS_ACQ_WIDTH = 16  # of tb_cpp/rtl/*_testbench.sv


def line(name: str, configuration: Configuration, **size: int) -> str:
    if configuration["ACQ_WIDTH"] != HARNESS_ACQ_WIDTH:
        raise FlowError(f"{configuration.name}: the simulation harness drives ACQ_WIDTH = {HARNESS_ACQ_WIDTH} only")
    parameters = configuration.parameters | configuration.simulation | size
    del parameters["ACQ_WIDTH"]
    words = [f"{key} {value}" for key, value in parameters.items()]
    return f"{name} READOUT {configuration.readout} {' '.join(words)}"


def engine_widths(configuration: Configuration) -> list[int]:
    """Widths of an array's engines: all ENGINE_COLUMNS, except perhaps the last one."""
    columns, together = configuration["SRAM_NUM"], configuration["ENGINE_COLUMNS"]
    return sorted({min(columns, together), columns % together or together}, reverse=True)


def main() -> int:
    if len(sys.argv) != 3 or sys.argv[1] not in ("readouts", "waveforms", "variants"):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        for name, configuration in load(ROOT / "configurations.toml").items():
            if configuration.top != sys.argv[2]:
                continue
            if sys.argv[1] == "variants":
                if configuration.variant_of:
                    print(line(f"variant_{name}", configuration, SRAM_NUM=1))
                continue
            if configuration.variant_of:
                continue
            waveforms = sys.argv[1] == "waveforms"
            if configuration.is_pool:
                for columns in engine_widths(configuration) + ([] if waveforms else SMALL_COLUMNS):
                    print(line(f"{name}_{columns}{'_waveform' if waveforms else ''}", configuration, SRAM_NUM=columns),
                          "WAVEFORM" if waveforms else "")
            elif waveforms:
                print(line(f"{name}_waveform", configuration, SRAM_NUM=1), "WAVEFORM")  # one column shows everything
            else:
                print(line(name, configuration))
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    program.run(main)
