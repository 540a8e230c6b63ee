# SPDX-License-Identifier: Apache-2.0
"""Runs Yosys and OpenSTA and turns their failures into one line."""

from __future__ import annotations

import os
import re
import signal
import subprocess
from pathlib import Path

from .errors import FlowError

_CRASHED = f"\nEXIT {-signal.SIGSEGV.value}"
Setting = str | float | int | list | dict | Path


def _tcl(value: Setting) -> str:
    if isinstance(value, dict):
        return " ".join(f"{_tcl(key)} {_tcl(item)}" for key, item in value.items())
    if isinstance(value, list):
        return " ".join(f"{{{_tcl(item)}}}" for item in value)
    return str(value)


def write_settings(path: Path, settings: dict[str, Setting]) -> None:
    """Writes a Tcl file of `set name {value}`; lists and dictionaries become Tcl lists."""
    path.write_text("".join(f"set {name} {{{_tcl(value)}}}\n" for name, value in settings.items()),
                    encoding="utf-8")


def _run(command: list[str], script: Path, settings: Path, log: Path, **more: str) -> str:
    """Runs a tool with a script. The script finds its settings and neighbouring scripts by environment variables, as `more`."""
    environment = {**os.environ, "DTOF_SETTINGS": str(settings), "DTOF_SCRIPTS": str(script.parent), **more}
    try:
        finished = subprocess.run([*command, str(script)], env=environment, check=False, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)
    except FileNotFoundError:
        raise FlowError(f"{command[0]} is not installed; scripts/install_packages.sh installs it") from None
    log.write_text(finished.stdout, encoding="utf-8")
    return finished.stdout if finished.returncode == 0 else f"{finished.stdout}\nEXIT {finished.returncode}"


# Warnings of Yosys that mean broken hardware although it goes on.
_YOSYS_FATAL = re.compile(r"Warning: .*(is used but has no driver|multiple conflicting drivers|"
                          r"found logic loop|Replacing memory|inferred latch)", re.IGNORECASE)


def run_yosys(script: Path, settings: Path, log: Path, name: str) -> None:
    """Runs a Yosys script; FlowError names the step and Yosys's own message."""
    output = _run(["yosys", "-c"], script, settings, log)
    steps = re.findall(r"^DTOF_STEP (\S+)", output, re.MULTILINE)
    broken = _YOSYS_FATAL.search(output)
    error = re.search(r"ERROR: (.*)", output)
    if broken or error or "\nEXIT " in output:
        message = broken.group(0) if broken else error.group(1) if error else "Yosys failed"
        step = steps[-1] if steps else "start"
        raise FlowError(f"{name}: Yosys step {step}: {message.strip()} (see {log})")


def run_sta(script: Path, settings: Path, log: Path, name: str) -> str:
    """Runs OpenSTA; returns its output. Success is judged by its marker and messages, since its exit status is meaningless. After a crash
    it runs once more without the command that crashes (slack_of in timing.tcl)."""
    command = ["sta", "-no_splash", "-exit"]
    output = _run(command, script, settings, log)
    if output.endswith(_CRASHED):
        output = _run(command, script, settings, log, DTOF_SLACK_OF_PATHS="1")
    failed = re.search(r"^DTOF_STA_FAILED (.*)", output, re.MULTILINE)
    error = re.search(r"^Error: (.*)", output, re.MULTILINE)
    warning = re.search(r"^Warning: (.*(?:not found|unresolved|no .*drivers?).*)", output, re.MULTILINE)
    if failed or error or warning or "\nDTOF_STA_OK" not in output:
        found = error or warning or failed
        raise FlowError(f"{name}: OpenSTA: {found.group(1) if found else 'stopped'} (see {log})")
    return output
