# SPDX-License-Identifier: Apache-2.0
"""The error that ends the flow with one line for the user."""

from __future__ import annotations

import re
from typing import TypeVar

Found = TypeVar("Found")


class FlowError(Exception):
    """Error with a place and a reason; the command line prints it and exits with status 1."""


def given(value: Found | None, missing: str) -> Found:
    """Returns the value; FlowError that names what is missing if it is None."""
    if value is None:
        raise FlowError(missing)
    return value


def found_in(tool: str, pattern: str, text: str) -> re.Match[str]:
    """First match of the pattern in a tool's output, line by line. FlowError names the tool and the pattern."""
    return given(re.search(pattern, text, re.MULTILINE), f"{tool}: its output has no '{pattern}'; is this another version?")
