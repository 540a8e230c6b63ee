#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of the synthesis flow; see synth.mk for the targets."""

from dtof_synth import program
from dtof_synth.cli import main

program.run(main)
