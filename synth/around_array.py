#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of make synth-subsystem (synth.mk)."""

from dtof_synth import program
from dtof_synth.subsystem_command import main

program.run(main)
