#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of the layout; see layout.mk for the targets."""

from dtof_synth import program
from dtof_synth.layout.command import main

program.run(main)
