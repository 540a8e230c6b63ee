# SPDX-License-Identifier: Apache-2.0
"""Simulation models of the standard cells that a netlist uses, generated from their Liberty.

Zero delay; the one parameter POWER_UP is a register's state at time 0. A clock gate is closed until its enable was first
known while the clock was low. Netlists are simulated with the functions of
the library that they were mapped to, whichever it is.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from .errors import FlowError
from .liberty import Group

POWER_UP = "POWER_UP"
_TOKEN = re.compile(r"[A-Za-z_]\w*|[01]|[()!'^*&+|]")
_UNSUPPORTED = ("latch", "latch_bank", "ff_bank", "statetable", "bus", "bundle")


def expression(function: str, where: str) -> str:
    """A Liberty function in Verilog, with all brackets. In Liberty XOR binds tighter than AND, a quote inverts the operand before it, and a
    blank is an AND."""
    tokens = _TOKEN.findall(function)
    if "".join(tokens) != re.sub(r"\s", "", function):
        raise FlowError(f"{where}: cannot read the function '{function}'")
    position = 0

    def peek() -> str:
        return tokens[position] if position < len(tokens) else ""

    def take() -> str:
        nonlocal position
        token = peek()
        position += 1
        return token

    def chain(operators: str, symbol: str, operand) -> str:
        parts = [operand()]
        while peek() and peek() in operators:
            take()
            parts.append(operand())
        return parts[0] if len(parts) == 1 else f"({f' {symbol} '.join(parts)})"

    def either() -> str:
        return chain("+|", "|", both)

    def both() -> str:
        parts = [differ()]
        while peek() and (peek() in "*&!(" or peek()[0].isalnum() or peek()[0] == "_"):
            if peek() in "*&":
                take()
            parts.append(differ())
        return parts[0] if len(parts) == 1 else f"({' & '.join(parts)})"

    def differ() -> str:
        return chain("^", "^", inverted)

    def inverted() -> str:
        if peek() == "!":
            take()
            return f"(~{inverted()})"
        token = take()
        if token == "(":
            found = either()
            if take() != ")":
                raise FlowError(f"{where}: a bracket of the function '{function}' is not closed")
        elif token in ("0", "1"):
            found = f"1'b{token}"
        elif re.fullmatch(r"[A-Za-z_]\w*", token):
            found = token
        else:
            raise FlowError(f"{where}: cannot read the function '{function}'")
        while peek() == "'":
            take()
            found = f"(~{found})"
        return found

    result = either()
    if position != len(tokens):
        raise FlowError(f"{where}: cannot read the function '{function}'")
    return result


def _edge(function: str, where: str) -> str:
    """Verilog event of a clock, clear or preset, which is a pin or an inverted pin."""
    found = re.fullmatch(r"\(~(\w+)\)|(\w+)", expression(function, where))
    if not found:
        raise FlowError(f"{where}: '{function}' is neither a pin nor an inverted pin")
    return f"negedge {found.group(1)}" if found.group(1) else f"posedge {found.group(2)}"


def _register(state: Group, where: str) -> list[str]:
    """Verilog of a Liberty ff group: state and inverted state, asynchronous clear and preset."""
    name, inverse = state.args
    clock, clear, preset = (state.get(key) for key in ("clocked_on", "clear", "preset"))
    both = {state.get(key) for key in ("clear_preset_var1", "clear_preset_var2") if state.get(key)}
    if clear and preset and len(both) != 2 or state.get("clocked_on_also"):
        raise FlowError(f"{where}: only registers with one clock are modelled, whose clear and preset at once make "
                        "opposite outputs")
    events = [_edge(clock, where), *(_edge(function, where) for function in (clear, preset) if function)]
    first = state.get("clear_preset_var1")
    lines = [f"  reg {name} = {POWER_UP};", f"  wire {inverse} = ~{name};",
             f"  always @({' or '.join(events)}) begin"]
    actions = [(preset, "1'b1"), (clear, "1'b0")] if first == "H" else [(clear, "1'b0"), (preset, "1'b1")]
    keyword = "if"
    for function, value in actions:
        if function:
            lines.append(f"    {keyword} ({expression(function, where)}) {name} <= {value};")
            keyword = "else if"
    following = f"{name} <= {expression(state.get('next_state'), where)};"
    lines += [f"    else {following}" if keyword != "if" else f"    {following}", "  end"]
    return lines


def _clock_gate(cell: Group, where: str) -> str:
    """Verilog of a clock gate: a latch that is open while the clock is low, and an AND. Liberty describes such a cell by the roles of its
    pins, without a function."""
    pins = {}
    for role in ("clock", "enable", "out"):
        found = [pin.name for pin in cell.children("pin") if pin.get(f"clock_gate_{role}_pin").strip('"') == "true"]
        if len(found) != 1:
            raise FlowError(f"{where}: the clock gate has no {role} pin")
        pins[role] = found[0]
    clock, enable, output = pins.values()
    return "\n".join([f"module {cell.name} (", f"    input wire {clock},\n    input wire {enable},\n    output wire {output}",
                      ");", "  reg held = 1'b0;", "  always @* begin", f"    if (!{clock}) held = {enable};", "  end",
                      f"  assign {output} = {clock} & held;", "endmodule", ""])


def model(cell: Group) -> str:
    """Verilog of one cell. FlowError for a cell without a function, or with a state that is not modelled."""
    where = f"cell {cell.name}"
    if cell.get("clock_gating_integrated_cell").strip('"') == "latch_posedge":
        return _clock_gate(cell, where)
    unsupported = [kind for kind in _UNSUPPORTED if cell.children(kind)]
    if unsupported:
        raise FlowError(f"{where}: a '{unsupported[0]}' group is not modelled")
    pins = [pin for pin in cell.children("pin") if pin.get("direction") in ("input", "output")]
    registers = cell.children("ff")
    lines = [f"module {cell.name} (" if not registers else f"module {cell.name} #(parameter {POWER_UP} = 1'b0) (",
             ",\n".join(f"    {pin.get('direction')} wire {pin.name}" for pin in pins), ");"]
    for register in registers:
        lines += _register(register, where)
    for pin in pins:
        if pin.get("direction") == "output":
            if not pin.get("function") or pin.get("three_state"):
                raise FlowError(f"{where}: output {pin.name} has no function that can be modelled")
            lines.append(f"  assign {pin.name} = {expression(pin.get('function'), where)};")
    return "\n".join([*lines, "endmodule", ""])


def verilog(library: Group, kinds: Iterable[str]) -> str:
    """Models of these cells. FlowError if the library lacks one."""
    cells = {cell.name: cell for cell in library.children("cell")}
    wanted = sorted(kinds)
    missing = [kind for kind in wanted if kind not in cells]
    if missing:
        raise FlowError(f"{library.name}: the library has no cell {missing[0]}")
    return "\n".join(["// SPDX-License-Identifier: Apache-2.0", f"// Generated from the Liberty {library.name}.",
                      *(model(cells[kind]) for kind in wanted)])
