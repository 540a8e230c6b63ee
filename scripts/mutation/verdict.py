# SPDX-License-Identifier: Apache-2.0
from dataclasses import dataclass

from mutation.mutant import Mutant


class MutationError(Exception):
    """A reason why mutants cannot be judged, in one line."""


@dataclass(frozen=True)
class Verdict:
    mutant: Mutant
    state: str  # killed, equivalent or survived
    by: str  # the test that kills it, the proof of equivalence, or nothing
