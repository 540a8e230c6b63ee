# SPDX-License-Identifier: Apache-2.0
"""Vias that the router left where nothing is below them.

qrouter sometimes puts a via to metal1 on a net that goes on in metal2 there. Its lone pad is smaller than the smallest
allowed area. Such a via is taken out of the routed DEF; that it connected nothing is what the comparison of the netlists
shows afterwards.
"""

from __future__ import annotations

import re

RULE = "Metal1 area"
VIA = "M2_M1"
UNITS = 100  # of the DEF in a micrometre


_ENDS_IN_VIA = re.compile(rf"( metal2 )((?:\( \S+ \S+ \) )+){VIA}(?= *(?:;)?\n)")


def _end(path: str) -> tuple[int, int]:
    """The last point of a path of a DEF; a star stands for the coordinate of the point before."""
    x = y = ""
    for across, up in re.findall(r"\( (\S+) (\S+) \)", path):
        x, y = across if across != "*" else x, up if up != "*" else y
    return int(x), int(y)


def drop_lone_vias(definition: str, boxes: dict[str, list[tuple[float, ...]]]) -> tuple[str, int]:
    """The DEF without the vias at the pads that Magic reports, whether they stand alone or end a path, and how many they were."""
    dropped = 0
    for rule, places in boxes.items():
        for left, low, right, high in sorted(set(places)) if rule.startswith(RULE) else ():
            x, y = round((left + right) / 2 * UNITS), round((low + high) / 2 * UNITS)
            alone = re.compile(rf"\n\s*NEW metal1 \( {x} {y} \) {VIA}(?= *(;)?\n)")
            definition, number = alone.subn("", definition, count=1)
            if not number:
                found = next((path for path in _ENDS_IN_VIA.finditer(definition) if _end(path.group(2)) == (x, y)), None)
                if found is not None:
                    definition = definition[:found.end(2)].rstrip() + definition[found.end():]
                    number = 1
            dropped += number
    return definition, dropped
