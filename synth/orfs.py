#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of the files for OpenROAD-flow-scripts; see layout.mk for the targets."""

from dtof_synth import program
from dtof_synth.orfs import main

program.run(main)
