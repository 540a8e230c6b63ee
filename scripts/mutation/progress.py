# SPDX-License-Identifier: Apache-2.0
import sys


def show(text: str) -> None:
    """Shows a line that the next one overwrites; on a terminal only."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


def done() -> None:
    show("")
