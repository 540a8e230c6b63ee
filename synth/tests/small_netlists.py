# SPDX-License-Identifier: Apache-2.0
"""Netlists of a few cells, as Yosys writes them in JSON, for tests."""


def cell(kind: str, inputs: dict[str, int | str], outputs: dict[str, int]) -> dict:
    """Pins of one bit each: the net's number, or a constant."""
    return {"type": kind, "attributes": {}, "parameters": {},
            "connections": {pin: [net] for pin, net in {**inputs, **outputs}.items()},
            "port_directions": {**dict.fromkeys(inputs, "input"), **dict.fromkeys(outputs, "output")}}


def module(ports: dict[str, tuple[str, int]], cells: dict[str, dict], top: bool = False) -> dict:
    """`ports`: direction and net."""
    return {"attributes": {"top": "1"} if top else {}, "cells": cells, "netnames": {},
            "ports": {name: {"direction": direction, "bits": [net]} for name, (direction, net) in ports.items()}}
