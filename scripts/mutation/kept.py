# SPDX-License-Identifier: Apache-2.0
"""Verdicts that outlive an interrupted run."""

import json
from pathlib import Path

from mutation.mutant import Mutant
from mutation.verdict import Verdict


class Kept:
    """Verdicts of earlier runs on the same sources with the same tests."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._found: dict[str, list[str]] = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}

    @staticmethod
    def _key(mutant: Mutant, digest_of_all: str) -> str:
        return f"{digest_of_all} {mutant.file} {mutant.begin} {mutant.end} {mutant.mutated}"

    def get(self, mutant: Mutant, digest_of_all: str) -> Verdict | None:
        found = self._found.get(self._key(mutant, digest_of_all))
        return Verdict(mutant, *found) if found else None

    def put(self, verdict: Verdict, digest_of_all: str) -> None:
        self._found[self._key(verdict.mutant, digest_of_all)] = [verdict.state, verdict.by]
        written = self._path.with_suffix(".new")
        written.write_text(json.dumps(self._found), encoding="utf-8")
        written.replace(self._path)
