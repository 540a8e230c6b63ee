# SPDX-License-Identifier: Apache-2.0
"""Explanations of surviving mutants: explained.toml."""

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

from mutation.mutant import Mutant
from mutation.verdict import MutationError, Verdict

ROOT = Path(__file__).resolve().parent.parent.parent
EXPLAINED = ROOT / "scripts" / "mutation" / "explained.toml"


@dataclass(frozen=True)
class Explanation:
    """Explains every mutant that changes one text of a file to another text."""

    file: str
    change: str
    source: str  # the line of the source on which the change begins, without blanks at its ends
    reason: str
    above: str | None = None  # the line above that one, if the line alone stands in several places
    equivalent: bool = False  # argued: no input can tell the mutant from the original

    def fits(self, mutant: Mutant) -> bool:
        here = (self.file, self.change, self.source) == (mutant.file, mutant.change, mutant.source)
        return here and self.above in (None, mutant.above)


def load(path: Path = EXPLAINED) -> list[Explanation]:
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8")).get("mutant", [])
        return [Explanation(**entry) for entry in entries]
    except (OSError, TypeError, tomllib.TOMLDecodeError) as error:
        raise MutationError(f"{path}: {error}") from None


def still_there(mutant: Mutant, root: Path) -> bool:
    """True if the source still has the line that the mutant changes."""
    try:
        lines = (root / mutant.file).read_text(encoding="utf-8").splitlines()
    except OSError:
        return False
    return mutant.source in map(str.strip, lines)


def explain(verdict: Verdict, known: list[Explanation], root: Path = ROOT) -> Verdict:
    """Adds the explanation to a survivor; a mutant argued to be equivalent is counted as such. Verdicts without an explanation stay
    unchanged, and so do those whose line has left the source."""
    if verdict.state not in ("survived", "argued equivalent"):
        return verdict
    for explanation in known:
        if explanation.fits(verdict.mutant):
            state = "argued equivalent" if explanation.equivalent else "survived"
            return replace(verdict, state=state, by=explanation.reason)
    if verdict.by and not still_there(verdict.mutant, root):
        return verdict
    return replace(verdict, state="survived", by="")
