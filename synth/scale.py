#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of the arrays of other sizes; see synth.mk for the target."""

from dtof_synth import program
from dtof_synth.scale import main

program.run(main)
