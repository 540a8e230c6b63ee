#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of the layout; see layout.mk for the targets."""

import sys

from dtof_synth.layout.command import main

sys.exit(main())
