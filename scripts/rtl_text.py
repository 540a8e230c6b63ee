# SPDX-License-Identifier: Apache-2.0
"""RTL as text for checks by patterns, without a parser."""

import re

_APART = re.compile(r"(?P<comment>//[^\n]*|/\*.*?\*/)|\"(?:\\.|[^\"\\\n])*\"", re.DOTALL)


def blank(found: re.Match[str]) -> str:
    """Blanks in place of what was found; its ends of lines stay."""
    return re.sub(r"[^\n]", " ", found.group())


def without_comments(text: str, strings: bool = True) -> str:
    """The text with blanks in place of comments, and in place of strings, too, unless `strings`. Lines and columns stay. A // or /* in a
    string begins no comment."""
    return _APART.sub(lambda found: blank(found) if found["comment"] or not strings else found.group(), text)
