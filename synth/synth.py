#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Entry point of the synthesis flow; see synth.mk for the targets."""

import sys

from dtof_synth.cli import main

sys.exit(main())
