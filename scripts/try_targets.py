#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`try_targets.py [TARGET ...]`: runs every target of the makefiles on little work, in a copy of the last commit.

The targets are those that the makefiles call .PHONY; scripts/try_targets.toml says how little work each can do. A target that the
list does not have is an error before anything runs. Each target runs as `make TARGET SMALL=1 ...` in build/try/tree and writes
build/try/TARGET.log. A target passes if make succeeds and no file of the project has changed, but for those that the list allows.
A target that passed is passed over in the next run of the same commit. With --here the targets run in this folder, with what is built in
it, which must have no change that is not committed.
"""

import argparse
import fnmatch
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dtof_synth import program
from page.commands import targets

ROOT = Path(__file__).resolve().parent.parent
LIST = "scripts/try_targets.toml"
LIMIT_MINUTES = 30
QUICK_MINUTES = 1.0


class TryError(Exception):
    """An error with a one-line message."""


@dataclass(frozen=True)
class Plan:
    """How a target is tried. `arguments`: of make, beside SMALL=1. `after`: targets whose files it reads. `needs`: programs, and
    files if there is a slash in the name. `writes`: patterns of files that it may change. `fails_with`: a line with these words
    is an honest end, too. `fresh`: in a copy of its own. `long`: why it is not tried here."""

    target: str
    minutes: float = 1
    arguments: str = ""
    after: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    writes: tuple[str, ...] = ()
    fails_with: str = ""
    fresh: bool = False
    long: str = ""


def plan_of(name: str, entry: dict[str, Any]) -> Plan:
    """The plan of an entry in TOML."""
    values: dict[str, Any] = {key: tuple(value) if isinstance(value, list) else value for key, value in entry.items()}
    return Plan(name, **values)


def load(root: Path) -> dict[str, Plan]:
    """The list, with exactly the targets of the makefiles."""
    path = root / LIST
    if not path.is_file():
        raise TryError(f"{LIST} is missing")
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        plans = {name: plan_of(name, entry) for name, entry in table.items()}
    except (tomllib.TOMLDecodeError, TypeError) as error:
        raise TryError(f"{LIST}: {error}") from error
    known = targets(root)
    for name in known.keys() - plans.keys():
        raise TryError(f"{known[name]}: nobody tries the target '{name}': say in {LIST} how")
    for name in plans.keys() - known.keys():
        raise TryError(f"{LIST}: no makefile has the target '{name}'")
    for plan in plans.values():
        for name in plan.after:
            if list(plans).index(name) >= list(plans).index(plan.target):
                raise TryError(f"{LIST}: '{plan.target}' reads what '{name}' leaves: '{name}' must stand before it")
    return plans


def git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(["git", "-C", folder, *arguments], capture_output=True, text=True)
    if done.returncode:
        raise TryError(f"git {arguments[0]} in {folder}: {done.stderr.strip()}")
    return done.stdout


def copy(root: Path, tree: Path) -> str:
    """Copies the last commit to `tree`, which keeps its build/; returns the commit."""
    commit = git(root, "rev-parse", "HEAD").strip()
    if not (tree / ".git").exists():
        shutil.rmtree(tree, ignore_errors=True)
        tree.parent.mkdir(parents=True, exist_ok=True)
        git(root, "clone", "--quiet", "--local", "--no-checkout", ".", str(tree))
    git(tree, "fetch", "--quiet", str(root), "HEAD")
    git(tree, "checkout", "--quiet", "--force", "--detach", commit)
    git(tree, "clean", "--quiet", "-fd")
    shared = tree.parent / "shared"  # measured data and libraries lie beside the project's folder
    if not shared.exists() and (root.parent / "shared").is_dir():
        shared.unlink(missing_ok=True)
        shared.symlink_to((root.parent / "shared").resolve())
    return commit


def absent(plan: Plan, tree: Path) -> list[str]:
    return [name for name in plan.needs if not ((tree / name).exists() if "/" in name else shutil.which(name))]


def changed_files(tree: Path) -> list[str]:
    return [line[3:] for line in git(tree, "status", "--porcelain", "--untracked-files=all").splitlines()]


def run_make(plan: Plan, tree: Path, log: Path, limit_minutes: float) -> str:
    """Runs a target; returns why it failed, or an empty text."""
    command = ["make", plan.target, "SMALL=1", *shlex.split(plan.arguments)]
    environment = {key: value for key, value in os.environ.items() if key not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MAKEOVERRIDES")}
    with log.open("w", encoding="utf-8") as output:
        output.write(f"$ {shlex.join(command)}\n")
        output.flush()
        process = subprocess.Popen(command, cwd=tree, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                                   env=environment, start_new_session=True)
        try:
            status = process.wait(limit_minutes * 60)
        except subprocess.TimeoutExpired:
            return f"still ran after {limit_minutes:g} minutes"
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
    if status and not (plan.fails_with and plan.fails_with in log.read_text(encoding="utf-8", errors="replace")):
        return f"status {status}"
    return ""


def attempt(plan: Plan, tree: Path, log: Path, limit_minutes: float) -> str:
    problem = run_make(plan, tree, log, limit_minutes)
    changed = [name for name in changed_files(tree) if not any(fnmatch.fnmatch(name, pattern) for pattern in plan.writes)]
    if changed:
        log.open("a", encoding="utf-8").write("".join(f"changed: {name}\n" for name in changed))
        problem = problem or f"it changed {changed[0]}" + (f" and {len(changed) - 1} more files" if len(changed) > 1 else "")
    git(tree, "checkout", "--quiet", "--force", ".")
    git(tree, "clean", "--quiet", "-fd")
    return problem


def chosen(plans: dict[str, Plan], names: list[str], quick: bool) -> list[Plan]:
    for name in names:
        if name not in plans:
            raise TryError(f"there is no target '{name}'")
    wanted = set(names) if names else {name for name, plan in plans.items() if not quick or plan.minutes <= QUICK_MINUTES}
    for plan in reversed(plans.values()):
        if plan.target in wanted and not plan.long:
            wanted |= set(plan.after)
    return [plan for plan in plans.values() if plan.target in wanted]


def try_all(root: Path, arguments: argparse.Namespace) -> int:
    folder = root / "build" / "try"
    tree = folder / "tree"
    changed = changed_files(root)
    if arguments.here and changed:
        raise TryError(f"--here: {changed[0]} is not committed, and would be lost")
    if arguments.here:
        tree, commit = root, git(root, "rev-parse", "HEAD").strip()
        folder.mkdir(parents=True, exist_ok=True)
    else:
        if changed:
            print("note: changes that are not committed are not tried", file=sys.stderr)
        commit = copy(root, tree)
    plans = load(tree)
    results = folder / "results.json"
    known: dict[str, dict] = {}
    if results.is_file():
        known = {name: entry for name, entry in json.loads(results.read_text(encoding="utf-8")).items() if entry["commit"] == commit}
    failed: list[str] = []
    skipped: list[str] = []
    counts = {"passed": 0, "long": 0}
    started = time.monotonic()
    for plan in chosen(plans, arguments.target, arguments.quick):
        def say(outcome: str, seconds: float | None = None) -> None:
            print(f"{plan.target:<20}{'' if seconds is None else f'{seconds:.0f} s':>8}  {outcome}", flush=True)

        lost = [name for name in plan.after if name in failed]
        missing = absent(plan, tree) + [f"what `make {name}` leaves" for name in plan.after if name in skipped]
        if plan.long:
            counts["long"] += 1
            say(f"not tried: {plan.long}")
        elif missing:
            skipped.append(plan.target)
            say(f"skipped: {missing[0]} is not here")
        elif lost:
            failed.append(plan.target)
            say(f"FAILED: it reads what `make {lost[0]}` leaves")
        elif plan.target in known and not arguments.again:
            counts["passed"] += 1
            say("passed before", known[plan.target]["seconds"])
        else:
            here = tree
            if plan.fresh:
                here = folder / "fresh"
                shutil.rmtree(here, ignore_errors=True)
                copy(root, here)
            begun = time.monotonic()
            log = folder / f"{plan.target}.log"
            problem = attempt(plan, here, log, arguments.minutes)
            seconds = round(time.monotonic() - begun, 1)
            known.pop(plan.target, None)
            if problem:
                failed.append(plan.target)
                say(f"FAILED: {problem}, see {log.relative_to(root)}", seconds)
            else:
                counts["passed"] += 1
                say("passed", seconds)
                known[plan.target] = {"commit": commit, "seconds": seconds}
            results.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")
    print(f"{counts['passed']} targets passed, {len(failed)} failed, {len(skipped)} skipped, {counts['long']} not tried, in "
          f"{time.monotonic() - started:.0f} s")
    if failed:
        print(f"error: these targets failed: {' '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("target", nargs="*", help="some targets, and those whose files they read; none: all")
    parser.add_argument("--quick", action="store_true", help="only those that take about a minute or less")
    parser.add_argument("--here", action="store_true", help="in this folder instead of a copy")
    parser.add_argument("--again", action="store_true", help="also those that passed with this commit")
    parser.add_argument("--minutes", type=float, default=LIMIT_MINUTES, help=f"that a target may take ({LIMIT_MINUTES})")
    parser.add_argument("--root", type=Path, default=ROOT, help="another project")
    arguments = parser.parse_args()
    try:
        return try_all(arguments.root.resolve(), arguments)
    except (TryError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted: what passed is passed over in the next run", file=sys.stderr)
        return 130


if __name__ == "__main__":
    program.run(main)
