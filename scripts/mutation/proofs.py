# SPDX-License-Identifier: Apache-2.0
"""Runs the proofs of a module of the tree in which this file is: `python3 -m mutation.proofs dtof_settle` in scripts/ prints the first assertion
that fails."""

import dataclasses
import sys

import formal


SECONDS = 120  # of processor time that a tool may take: a counterexample comes soon, or not at all


def failing(module: str) -> str:
    """The proof and the assertion that a counterexample breaks; nothing if there is none."""
    for proof in formal.load_proofs():
        if module not in proof.module.split(", "):
            continue
        short = dataclasses.replace(proof, timeout=min(proof.timeout, SECONDS))
        for parameters in proof.parameters:
            try:
                outcome = formal.solve(formal.Job(short, "prove", parameters))
            except formal.FormalError:
                continue  # says nothing about the design
            if outcome.verdict == "failed":
                return f"proof {proof.name}: {outcome.assertion}"
    return ""


if __name__ == "__main__":
    print(failing(sys.argv[1]))
