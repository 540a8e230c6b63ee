#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of what confirms reports of the synthesis (studies.toml, reports/reports.toml)."""

from dtof_synth import program
from dtof_synth.elaborated import main

program.run(main)
