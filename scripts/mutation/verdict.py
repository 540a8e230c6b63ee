# SPDX-License-Identifier: Apache-2.0
from dataclasses import dataclass

from mutation.mutant import Mutant

STATES = ("killed", "proved equivalent", "argued equivalent", "survived")


class MutationError(Exception):
    """Mutants cannot be judged; the message gives the reason in one line."""


@dataclass(frozen=True)
class Verdict:
    mutant: Mutant
    state: str  # one of STATES
    by: str  # the test that kills it, the proof or the explanation; nothing if there is none
