# SPDX-License-Identifier: Apache-2.0
"""Vias that the router left where nothing is below them.

qrouter sometimes puts a via to metal1 on a net that goes on in metal2 there; and where it reaches a pin beside its grid, it
sometimes puts the via at the grid's end of the last piece instead of the pin's. The lone pad is smaller than the smallest
allowed area. In the routed DEF a via of the first kind is taken out, one of the second kind goes to the other end of its
piece; that this is right is what the design rules and the comparison of the netlists show afterwards.
"""

from __future__ import annotations

import re

RULE = "Metal1 area"
VIA = "M2_M1"
UNITS = 100  # of the DEF in a micrometre


_ENDS_IN_VIA = re.compile(rf"(?<= metal2 )((?:\( \S+ \S+ \) )+){VIA}(?= *(?:;)?\n)")


def _points(path: str) -> list[tuple[str, str]]:
    """Points of a path in a DEF, where a star stands for the previous point's coordinate."""
    found: list[tuple[str, str]] = []
    for x, y in re.findall(r"\( (\S+) (\S+) \)", path):
        found.append((x if x != "*" else found[-1][0], y if y != "*" else found[-1][1]))
    return found


def mend_lone_vias(definition: str, boxes: dict[str, list[tuple[float, ...]]]) -> tuple[str, int]:
    """The DEF with vias replaced at the pads that Magic reports, and the number of replaced vias."""
    mended = 0
    for rule, places in boxes.items():
        for left, low, right, high in sorted(set(places)) if rule.startswith(RULE) else ():
            x, y = str(round((left + right) / 2 * UNITS)), str(round((low + high) / 2 * UNITS))
            alone = re.compile(rf"\n\s*NEW metal1 \( {x} {y} \) {VIA}(?= *(;)?\n)")
            definition, number = alone.subn("", definition, count=1)
            if not number:
                found = next((path for path in _ENDS_IN_VIA.finditer(definition) if _points(path.group(1))[-1] == (x, y)), None)
                if found is not None:
                    other_way = "".join(f"( {across} {up} ) " for across, up in reversed(_points(found.group(1))))
                    definition = f"{definition[:found.start()]}{other_way}{VIA}{definition[found.end():]}"
                    number = 1
            mended += number
    return definition, mended
