#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of the chips for open silicon; see shuttle.mk for the target."""

from dtof_synth import program
from dtof_synth.shuttle import main

program.run(main)
