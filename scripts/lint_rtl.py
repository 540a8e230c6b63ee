#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the RTL of every named configuration with Verilator -Wall, Yosys and Icarus Verilog.

Also checks that illegal parameters stop elaboration with a sentence. Exits non-zero with the tool's message.
"""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
sys.path.insert(0, str(ROOT / "synth"))

from dtof_synth.configuration import Configuration, load  # noqa: E402

SIZE = {  # enough to see every connection between columns, and between engines
    "dtof_array": {"SRAM_NUM": 2},
    "pool_pointer_array": {"SRAM_NUM": 4, "ENGINE_COLUMNS": 2},
}
ILLEGAL = {  # parameters of a top and a word of the sentence that must appear
    ("dtof_array", "NP=2"): "NP must be",
    ("dtof_array", "NB=11"): "NB must be",
    ("dtof_array", "SRAM_NUM=0"): "SRAM_NUM must be",
    ("dtof_array", "COUNT_WIDTH=17"): "COUNT_WIDTH must be",
    ("dtof_array", "POINTER_STEP=512"): "POINTER_STEP must be",
    ("dtof_array", "READOUT=8"): "READOUT must be",
    ("dtof_array", "CONFIDENCE_WIDTH=9"): "CONFIDENCE_WIDTH must be",
    ("dtof_array", "FRACTION_BITS=7"): "FRACTION_BITS must be",
    ("dtof_array", "POINTER_PORTS=3"): "POINTER_PORTS must be",
    ("pool_pointer_array", "NP=7"): "NP must be",
    ("pool_pointer_array", "SLOTS=1"): "SLOTS must be",
    ("pool_pointer_array", "COUNT_WIDTH=9"): "COUNT_WIDTH must be",
    ("pool_pointer_array", "GROUP_SIZE=12"): "GROUP_SIZE must be",
    ("pool_pointer_array", "GROUP_SIZE=4"): "32 bins",
    ("pool_pointer_array", "DARK_LABELS=9"): "DARK_LABELS must be",
    ("pool_pointer_array", "BRIGHT_SCORE_BITS=5"): "BRIGHT_SCORE_BITS 1 to 4",
    ("pool_pointer_array", "BRIGHT_FROM=64"): "BRIGHT_FROM must be",
    ("pool_pointer_array", "OFFSET_BITS=6"): "OFFSET_BITS must be",
    ("pool_pointer_array", "ADVANTAGE_WIDTH=6"): "ADVANTAGE_WIDTH must be",
    ("pool_pointer_array", "POINTER_SHIFT=3"): "POINTER_SHIFT",
    ("pool_pointer_array", "RIVAL_MOVES=2"): "RIVAL_MOVES must be",
    ("pool_pointer_array", "ENGINE_COLUMNS=0"): "ENGINE_COLUMNS must be",
    ("pool_pointer_array", "ENGINE_COLUMNS=3"): "ENGINE_COLUMNS must be",
}


def source_files() -> list[str]:
    """RTL files of the file list, without options and waivers."""
    lines = (HDL / "dtof.f").read_text().split()
    return [line for line in lines if line.endswith(".sv")]


def verilator(top: str, parameters: dict[str, int]) -> list[str]:
    overrides = [f"-G{name}={value}" for name, value in parameters.items()]
    return ["verilator", "--lint-only", "-Wall", "-f", "dtof.f", "--top-module", top, *overrides]


def yosys(top: str, parameters: dict[str, int]) -> list[str]:
    settings = " ".join(f"-set {name} {value}" for name, value in parameters.items())
    script = (
        f"read_verilog -sv -Ipackage {' '.join(source_files())}; chparam {settings} {top}; "
        f"hierarchy -check -top {top}; proc; check -assert"
    )
    return ["yosys", "-q", "-p", script]


def icarus(top: str, parameters: dict[str, int]) -> list[str]:
    overrides = [f"-P{top}.{name}={value}" for name, value in parameters.items()]
    return ["iverilog", "-g2012", "-Ipackage", "-t", "null", "-s", top, *overrides, *source_files()]


def run(command: list[str]) -> subprocess.CompletedProcess:
    return subprocess.run(command, cwd=HDL, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def check_legal(configuration: Configuration) -> list[str]:
    failures = []
    for tool in (verilator, yosys, icarus):
        result = run(tool(configuration.top, configuration.rtl_parameters() | SIZE[configuration.top]))
        if result.returncode != 0:
            failures.append(f"{tool.__name__} refuses configuration {configuration.name}:\n{result.stdout}")
    return failures


def check_illegal(top: str, setting: str, sentence: str) -> list[str]:
    name, value = setting.split("=")
    result = run(verilator(top, SIZE[top] | {name: int(value)}))
    if result.returncode == 0 or sentence not in result.stdout:
        return [f"illegal {setting} of {top} does not stop elaboration with '{sentence}':\n{result.stdout}"]
    return []


def main() -> int:
    configurations = load(ROOT / "configurations.toml").values()
    with ThreadPoolExecutor(max_workers=2) as pool:
        legal = pool.map(check_legal, configurations)
        illegal = pool.map(lambda item: check_illegal(*item[0], item[1]), ILLEGAL.items())
        failures = [text for group in (*legal, *illegal) for text in group]
    for text in failures:
        print(text, file=sys.stderr)
    if not failures:
        print(
            f"RTL lint: {len(configurations)} configurations clean in Verilator, Yosys and Icarus Verilog; "
            f"{len(ILLEGAL)} illegal parameters refused"
        )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
