# SPDX-License-Identifier: Apache-2.0
"""Where the block's pins are on its edge: the SRAM's below, the others above, each near the cells of its net.

qflow's own arrangement moves pins that a full edge has no room for round the corner, onto a layer that the router cannot
reach there; this one keeps to the two edges.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from statistics import mean

from ..errors import FlowError
from .block import SUPPLIES, Block

# Pins come from above and below in metal2, wherever graywolf had them. In the DEF's units, hundredths of a micrometre: the
# layer's tracks, and what a stripe's vias keep free to either side.
LAYER = "metal2"
TRACK = 80
STRIPE = 320
_COMPONENT = re.compile(r"^- (\S+) \S+ \+ PLACED \( (-?\d+) (-?\d+) \)", re.MULTILINE)
_PIN = re.compile(r"^- (\S+) \+ NET (\S+)\n(.*\n)  \+ PLACED \( (-?\d+) (-?\d+) \) \w+ ;$", re.MULTILINE)


def _slots(left: int, right: int, stripes: list[int], wanted: int) -> list[int]:
    """Tracks for pins; every second one if there are enough."""
    for step in (2 * TRACK, TRACK):
        first = -(-left // step) * step + step
        free = [x for x in range(first, right - step, step) if all(abs(x - stripe) > STRIPE for stripe in stripes)]
        if len(free) >= wanted:
            return free
    raise FlowError(f"{wanted} pins do not fit on an edge of {(right - left) / 100:.0f} um")


def spread(wanted: list[tuple[float, str]], slots: list[int]) -> dict[str, int]:
    """A slot for each pin near the position that it wants; the order of the positions is kept."""
    found = {}
    lowest = 0
    for index, (place, pin) in enumerate(sorted(wanted)):
        highest = len(slots) - (len(wanted) - index)
        nearest = bisect_left(slots, place)
        found[pin] = slots[min(max(nearest, lowest), highest)]
        lowest = min(max(nearest, lowest), highest) + 1
    return found


def arrange(definition: str, block: Block) -> str:
    """The unrouted DEF with the block's pins on its lower and upper edge."""
    places = {name: int(x) for name, x, _ in _COMPONENT.findall(definition)}
    pins = {net: (int(x), int(y)) for net, _, _, x, y in _PIN.findall(definition)}
    missing = set(block.ports) - set(pins)
    if missing or not places:
        raise FlowError(f"{block.name}: the placement has no pin {min(missing, default='')} or no cells")
    near: dict[str, list[int]] = {}
    for cell in block.cells:
        for net in cell.pins.values():
            if net in block.ports:
                near.setdefault(net, []).append(places[cell.name])
    rows = [y for net, (_, y) in pins.items() if net not in SUPPLIES]
    below, above = min(rows), max(rows)
    stripes = [x for net, (x, _) in pins.items() if net in SUPPLIES]
    at: dict[str, tuple[int, int]] = {}
    sram = set(block.sram_ports)
    for y, ports in ((below, block.sram_ports), (above, [port for port in block.ports if port not in sram])):
        slots = _slots(min(places.values()), max(places.values()), stripes, len(ports))
        at |= {port: (x, y) for port, x in spread([(mean(near[port]), port) for port in ports], slots).items()}

    def placed(match: re.Match) -> str:
        if match[2] not in at:
            return match[0]
        x, y = at[match[2]]
        return f"- {match[1]} + NET {match[2]}\n  + LAYER {LAYER} ( -15 -15 ) ( 15 15 )\n  + PLACED ( {x} {y} ) N ;"

    return _PIN.sub(placed, definition)
