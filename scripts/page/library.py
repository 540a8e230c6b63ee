# SPDX-License-Identifier: Apache-2.0
"""The plotting library of the live plots, Chart.js: fetched by npm once, and put beside the pages.

scripts/page/library/package.json names the version, package-lock.json has the integrity that npm compares. Without npm, or
without its registry, the pages have pictures instead."""

import json
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

LISTS = Path(__file__).resolve().parent / "library"
NAME = "chart.js"
FOLDER = Path("build/page_library")
SCRIPT = Path("node_modules", NAME, "dist/chart.umd.min.js")
LICENCE = Path("node_modules", NAME, "LICENSE.md")
SECONDS = 120  # for a registry that does not answer


@dataclass(frozen=True)
class Library:
    script: Path | None
    licence: Path | None
    why_not: str = ""  # the reason, where there is none


def pinned() -> dict[str, str]:
    """Version and integrity of the library, from package-lock.json."""
    lock = json.loads((LISTS / "package-lock.json").read_text(encoding="utf-8"))
    return lock["packages"][f"node_modules/{NAME}"]


def is_installed(folder: Path) -> bool:
    installed = folder / "node_modules/.package-lock.json"
    if not installed.is_file() or not (folder / SCRIPT).is_file():
        return False
    packages = json.loads(installed.read_text(encoding="utf-8"))["packages"]
    return packages.get(f"node_modules/{NAME}", {}).get("integrity") == pinned()["integrity"]


def fetch(root: Path) -> Library:
    folder = root / FOLDER
    why = "" if is_installed(folder) else install(folder)
    return Library(None, None, why) if why else Library(folder / SCRIPT, folder / LICENCE)


def install(folder: Path) -> str:
    """Installs the library; returns the fault, or an empty text."""
    if shutil.which("npm") is None:
        return "npm is not installed"
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copyfile(LISTS / name, folder / name)
    command = ["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--fetch-retries=0"]
    try:
        said = subprocess.run(command, cwd=folder, text=True, check=False, timeout=SECONDS, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired:
        return f"npm did not fetch it in {SECONDS} s"
    if said.returncode == 0 and is_installed(folder):
        return ""
    lines = [line for line in said.stdout.splitlines() if "error code" in line or "ERR! code" in line]
    return f"npm could not fetch it ({lines[0].split('code', 1)[1].strip() if lines else 'no reason given'})"
