# SPDX-License-Identifier: Apache-2.0
"""Generated 40 nm-class standard-cell Liberty.

Every constant is a public figure or follows from one; docs/reference/technology.md names the source of each.
Delay of a stage of drive k with input slew s into a load C (logical effort, tau = FO4 / 5):

    delay = STEP * tau * (p + C / (k * CINV)) + RAMP * s        slew = SLEW * tau * (p + C / (k * CINV))

STEP + RAMP * SLEW = 1, so that a chain of inverters with fan-out 4 has exactly the FO4 delay.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .liberty import THRESHOLDS, Group, quoted

# Area: NAND2 at 40 nm is three contacted poly pitches of a row.
NAND2_AREA_UM2 = 0.7056
PITCH_AREA_UM2 = NAND2_AREA_UM2 / 3
# Nangate 45 nm areas in its own pitches (0.266 um2) and the linear shrink against the NAND2's, for
# sequential cells: (40/45)^2 = 0.79 against 0.884.
SEQUENTIAL_SHRINK = 0.79 / 0.884
NANGATE_PITCHES = {"DFF": 17, "DFFR": 20, "DFFS": 20, "DLATCH": 10, "CLKGATE": 13}

# Capacitance, fF: Nangate 45 nm times 40/45.
CINV_FF = 1.70 * 40 / 45
DFF_D_FF = 1.14 * 40 / 45
DFF_CK_FF = 0.95 * 40 / 45
GATE_CK_FF = {drive: ff * 40 / 45 for drive, ff in {1: 1.84, 2: 2.56, 4: 4.25}.items()}  # of a clock gate, by its drive

# Time, ns: FO4 28 ps; registers as Nangate 45 nm in units of its FO4 of 25.8 ps.
FO4_NS = 0.028
FO4_SCALE = 28 / 25.8

# Alpha-power law (Sakurai and Newton 1990) with threshold 0.35 Vdd, alpha 1.3, saturation at 0.55 Vdd.
_THRESHOLD, _ALPHA, _SATURATION = 0.35, 1.3, 0.55
_RAMP_FULL = 0.5 - (1 - _THRESHOLD) / (1 + _ALPHA)
_EDGE_PER_STEP = 2 * (0.9 / 0.8 + _SATURATION / 0.8 * math.log(10 * _SATURATION / math.e))
_MEASURED = 0.6  # slew is measured from 20 to 80 %
STEP = 1 / (1 + _RAMP_FULL * _EDGE_PER_STEP)
RAMP = _RAMP_FULL / _MEASURED
SLEW = STEP * _EDGE_PER_STEP * _MEASURED

# Leakage, nW, typical corner.
NAND2_LEAKAGE_NW = 17.0
DFF_LEAKAGE_NW = 79.0

# Wires inside a block of about a thousand gates, as Nangate's wire load for that size.
WIRE_FF_PER_UM = 0.18
WIRE_UM_PER_FANOUT = 2.0
WIRE_LOAD = "block_1k"

MAX_LOAD_INVERTERS = 24.0  # max_capacitance of drive 1, in inverter inputs


@dataclass(frozen=True)
class Corner:
    """Factors relative to the typical corner; registers have their own."""

    name: str
    voltage: float
    temperature: float
    gate: float
    clock_to_q: float
    setup: float
    hold: float
    leakage: float


# Slow: Nangate's slow over typical (FO4 81/25.8, clk->q 0.361/0.106, setup 0.137/0.029, hold 0.058/0.017).
TYPICAL = Corner("typical", 1.10, 25, 1.0, 1.0, 1.0, 1.0, 1.0)
SLOW = Corner("slow", 0.95, 125, 81 / 25.8, 0.361 / 0.106, 0.137 / 0.029, 0.058 / 0.017, 0.65)
# Fast: likewise (FO4 16/25.8, clk->q 0.061/0.106, setup 0.026/0.029, hold 0.008/0.017, leakage of NAND2 59.1/17.4).
FAST = Corner("fast", 1.25, 0, 16 / 25.8, 0.061 / 0.106, 0.026 / 0.029, 0.008 / 0.017, 59.1 / 17.4)
CORNERS = (TYPICAL, SLOW, FAST)


@dataclass(frozen=True)
class Stage:
    """One CMOS stage: logical effort of the input used, parasitic delay, drive."""

    effort: float
    parasitic: float
    drive: float = 1.0

    @property
    def input_ff(self) -> float:
        return self.effort * self.drive * CINV_FF


@dataclass(frozen=True)
class Output:
    """An output of a combinational cell: function, stages from each input, and sense per input ('' = both edges)."""

    function: str
    paths: dict[str, tuple[Stage, ...]]
    sense: dict[str, str]


@dataclass(frozen=True)
class Gate:
    """A combinational cell. `input_ff`: whole load of a pin, all stages together."""

    name: str
    pitches: int
    input_ff: dict[str, float]
    outputs: dict[str, Output]


def nand(inputs: int, drive: float = 1) -> Stage:
    return Stage((inputs + 2) / 3, inputs, drive)


def nor(inputs: int, drive: float = 1) -> Stage:
    return Stage((2 * inputs + 1) / 3, inputs, drive)


def inverter(drive: float = 1) -> Stage:
    return Stage(1, 1, drive)


def _pins(count: int) -> list[str]:
    return [f"A{index + 1}" for index in range(count)] if count > 1 else ["A"]


def _simple(name: str, pitches: int, function: str, stages: dict[str, tuple[Stage, ...]], sense: str) -> Gate:
    return Gate(name, pitches, {pin: path[0].input_ff for pin, path in stages.items()},
                {"Y": Output(function, stages, dict.fromkeys(stages, sense))})


def _driver_of(drive: int) -> int:
    """Drive of the stage inside a two-stage cell."""
    return max(1, drive // 2)


def _nand_family(drive: int) -> list[Gate]:
    gates = []
    inner = _driver_of(drive)
    for kind, operator, stage in (("NAND", " * ", nand), ("NOR", " + ", nor)):
        for inputs in (2, 3, 4):
            pins = _pins(inputs)
            gates.append(_simple(f"{kind}{inputs}_X{drive}", inputs * drive + 1,
                                 f"!({operator.join(pins)})",
                                 {pin: (stage(inputs, drive),) for pin in pins}, "negative_unate"))
            gates.append(_simple(f"{'AND' if kind == 'NAND' else 'OR'}{inputs}_X{drive}",
                                 inputs * inner + drive + 1, f"({operator.join(pins)})",
                                 {pin: (stage(inputs, inner), inverter(drive)) for pin in pins},
                                 "positive_unate"))
    return gates


# Complex gates: function, and (effort, parasitic) of every pin, transistor by transistor with P = 2 N.
_COMPLEX: dict[str, tuple[str, float, dict[str, float]]] = {
    "AOI21": ("!((A1 * A2) + B)", 7 / 3, {"A1": 2, "A2": 2, "B": 5 / 3}),
    "OAI21": ("!((A1 + A2) * B)", 8 / 3, {"A1": 2, "A2": 2, "B": 4 / 3}),
    "AOI22": ("!((A1 * A2) + (B1 * B2))", 4, {"A1": 2, "A2": 2, "B1": 2, "B2": 2}),
    "OAI22": ("!((A1 + A2) * (B1 + B2))", 4, {"A1": 2, "A2": 2, "B1": 2, "B2": 2}),
    "AOI211": ("!((A1 * A2) + B + C)", 10 / 3, {"A1": 8 / 3, "A2": 8 / 3, "B": 7 / 3, "C": 7 / 3}),
    "OAI211": ("!((A1 + A2) * B * C)", 11 / 3, {"A1": 7 / 3, "A2": 7 / 3, "B": 5 / 3, "C": 5 / 3}),
}


def _complex_family(drive: int) -> list[Gate]:
    return [_simple(f"{name}_X{drive}", len(efforts) * drive + 1, function,
                    {pin: (Stage(effort, parasitic, drive),) for pin, effort in efforts.items()},
                    "negative_unate")
            for name, (function, parasitic, efforts) in _COMPLEX.items()]


def _xor_family(drive: int) -> list[Gate]:
    """XOR2 (NOR2 into AOI21) and XNOR2 (NAND2 into OAI21); the delay is that of the path through both stages."""
    xor_path = (nor(2), Stage(5 / 3, 7 / 3, drive))
    xnor_path = (nand(2), Stage(4 / 3, 8 / 3, drive))
    gates = []
    for name, function, path in (("XOR2", "(A ^ B)", xor_path), ("XNOR2", "!(A ^ B)", xnor_path)):
        load = path[0].input_ff + Stage(2, 0, drive).input_ff
        gates.append(Gate(f"{name}_X{drive}", 2 + 3 * drive + 1, {"A": load, "B": load},
                          {"Y": Output(function, {"A": path, "B": path}, {"A": "", "B": ""})}))
    return gates


def _mux(drive: int) -> Gate:
    """Multiplexer: AOI22 and output inverter, with an inverter for the select."""
    inner = _driver_of(drive)
    core = (Stage(2, 4, inner), inverter(drive))
    select = (inverter(),) + core
    return Gate(f"MUX2_X{drive}", 1 + 4 * inner + drive + 1,
                {"A": core[0].input_ff, "B": core[0].input_ff,
                 "S": core[0].input_ff + inverter().input_ff},
                {"Y": Output("((A * !S) + (B * S))", {"A": core, "B": core, "S": select},
                             {"A": "positive_unate", "B": "positive_unate", "S": ""})})


def _adders() -> list[Gate]:
    """Half adder as XOR2 + AND2, full adder as the 28-transistor mirror adder."""
    xor_path = (nor(2), Stage(5 / 3, 7 / 3))
    and_path = (nand(2), inverter())
    load = nor(2).input_ff + Stage(2, 0).input_ff + nand(2).input_ff
    half = Gate("HA_X1", 10, {"A": load, "B": load},
                {"S": Output("(A ^ B)", {"A": xor_path, "B": xor_path}, {"A": "", "B": ""}),
                 "CO": Output("(A * B)", {"A": and_path, "B": and_path},
                              dict.fromkeys("AB", "positive_unate"))})
    carry = (Stage(2, 4), inverter())
    total = (Stage(2, 4), Stage(2, 4), inverter())
    loads = {"A": 4 * CINV_FF, "B": 4 * CINV_FF, "CI": 3 * CINV_FF}
    full = Gate("FA_X1", 16, loads,
                {"CO": Output("((A * B) + (CI * (A + B)))", dict.fromkeys(loads, carry),
                              dict.fromkeys(loads, "positive_unate")),
                 "S": Output("(A ^ B ^ CI)", dict.fromkeys(loads, total), dict.fromkeys(loads, ""))})
    return [half, full]


def gates() -> list[Gate]:
    cells: list[Gate] = []
    for drive in (1, 2, 4, 8, 16):
        cells.append(_simple(f"INV_X{drive}", drive + 1, "!A", {"A": (inverter(drive),)}, "negative_unate"))
        inner = _driver_of(drive)
        cells.append(_simple(f"BUF_X{drive}", inner + drive + 1, "A",
                             {"A": (inverter(inner), inverter(drive))}, "positive_unate"))
    for drive in (1, 2, 4):
        cells += _nand_family(drive) + _complex_family(drive)
    for drive in (1, 2):
        cells += _xor_family(drive) + [_mux(drive)]
    return cells + _adders()


def stage_step(stage: Stage, load_ff: float) -> float:
    """Parasitic plus electrical effort of a stage, in tau."""
    return stage.parasitic + load_ff / (stage.drive * CINV_FF)


def path_delay(path: tuple[Stage, ...], slew: float, load_ff: float, tau: float) -> tuple[float, float]:
    """(delay, output slew) of a chain of stages, ns."""
    delay = 0.0
    for index, stage in enumerate(path):
        load = path[index + 1].input_ff if index + 1 < len(path) else load_ff
        effort = stage_step(stage, load)
        delay += STEP * tau * effort + RAMP * slew
        slew = SLEW * tau * effort
    return delay, slew


def sequential_pitches(kind: str) -> int:
    return round(NANGATE_PITCHES[kind] * SEQUENTIAL_SHRINK)


def _tau(corner: Corner) -> float:
    return FO4_NS / 5 * corner.gate


def _slew_axis(corner: Corner) -> list[float]:
    return [_tau(corner) * multiple for multiple in (1, 6, 20, 80)]


def _load_axis(drive: float) -> list[float]:
    return [CINV_FF * drive * multiple for multiple in (0.5, 4, 12, MAX_LOAD_INVERTERS)]


def _table(kind: str, rows: list[float], columns: list[float], values: list[list[float]]) -> Group:
    return Group(kind, ["delay_4x4"],
                 [("index_1", [quoted(rows)]), ("index_2", [quoted(columns)]),
                  ("values", [", ".join(quoted(row) for row in values)])])


def _delay_tables(delay, corner: Corner, drive: float) -> list[Group]:
    """Rise and fall tables of `delay(slew, load) -> (delay, slew)`; both edges are equal by construction."""
    slews, loads = _slew_axis(corner), _load_axis(drive)
    points = [[delay(slew, load) for load in loads] for slew in slews]
    delays = [[point[0] for point in row] for row in points]
    edges = [[point[1] for point in row] for row in points]
    return [_table("cell_rise", slews, loads, delays), _table("rise_transition", slews, loads, edges),
            _table("cell_fall", slews, loads, delays), _table("fall_transition", slews, loads, edges)]


def _energy(pin: str, femtojoules: float) -> Group:
    """Internal energy of one edge; both edges are equal."""
    attributes: list[tuple[str, str | list[str]]] = [("related_pin", f'"{pin}"')] if pin else []
    value = [("values", [quoted([femtojoules])])]
    return Group("internal_power", [], attributes,
                 [Group("rise_power", ["scalar"], list(value)), Group("fall_power", ["scalar"], list(value))])


def _path_energy(path: tuple[Stage, ...], voltage: float) -> float:
    """Half of C V^2 over the parasitics of all stages and the inputs of the inner ones, fJ."""
    farads = sum(stage.parasitic * stage.drive * CINV_FF for stage in path)
    farads += sum(stage.input_ff for stage in path[1:])
    return 0.5 * farads * voltage**2


def _input_pin(name: str, femtofarads: float, **attributes: str) -> Group:
    return Group("pin", [name], [("direction", "input"), ("capacitance", f"{femtofarads:.4f}"),
                                 *attributes.items()])


def _output_pin(name: str, drive: float, function: str) -> Group:
    return Group("pin", [name], [("direction", "output"), ("function", f'"{function}"'),
                                 ("max_capacitance", f"{MAX_LOAD_INVERTERS * drive * CINV_FF:.4f}")])


def _cell(name: str, pitches: int, leakage: float) -> Group:
    return Group("cell", [name], [("area", f"{pitches * PITCH_AREA_UM2:.4f}"),
                                  ("cell_leakage_power", f"{leakage:.3f}")])


def gate_cell(gate: Gate, corner: Corner) -> Group:
    leakage = NAND2_LEAKAGE_NW / 3 * gate.pitches * corner.leakage
    cell = _cell(gate.name, gate.pitches, leakage)
    for pin, load in gate.input_ff.items():
        cell.add(_input_pin(pin, load))
    for name, output in gate.outputs.items():
        drive = next(iter(output.paths.values()))[-1].drive
        output_pin = cell.add(_output_pin(name, drive, output.function))
        for source, path in output.paths.items():
            sense = output.sense[source] or "non_unate"
            timing = output_pin.add(Group("timing", [], [("related_pin", f'"{source}"'), ("timing_sense", sense)]))
            timing.groups = _delay_tables(
                lambda slew, load, path=path: path_delay(path, slew, load, _tau(corner)), corner, drive)
            output_pin.add(_energy(source, _path_energy(path, corner.voltage)))
    return cell


def tie_cells(corner: Corner) -> list[Group]:
    cells = []
    for name, function in (("TIE0_X1", "0"), ("TIE1_X1", "1")):
        cell = _cell(name, 2, NAND2_LEAKAGE_NW / 3 * 2 * corner.leakage)
        cell.add(_output_pin("Y", 1, function))
        cells.append(cell)
    return cells


def _constraint(clock: str, kind: str, nanoseconds: float) -> Group:
    value = [("values", [quoted([nanoseconds])])]
    return Group("timing", [], [("related_pin", f'"{clock}"'), ("timing_type", kind)],
                 [Group("rise_constraint", ["scalar"], list(value)),
                  Group("fall_constraint", ["scalar"], list(value))])


def setup_ns(corner: Corner) -> float:
    return 0.029 * FO4_SCALE * corner.setup


def hold_ns(corner: Corner) -> float:
    return 0.017 * FO4_SCALE * corner.hold


def clock_to_q(corner: Corner, drive: float, load_ff: float) -> tuple[float, float]:
    """(delay, slew) of clk->q: Nangate's into a fan-out of 4, with an inverter of this drive as output stage."""
    fixed = 0.106 * FO4_SCALE * corner.clock_to_q - STEP * _tau(corner) * stage_step(inverter(), 4 * CINV_FF)
    effort = stage_step(inverter(drive), load_ff)
    return fixed + STEP * _tau(corner) * effort, SLEW * _tau(corner) * effort


def clock_energy_fj(voltage: float) -> float:
    """One clock edge inside a flip-flop: two clock inverters, the second one's gate, eight clocked
    transistors of half a pin each: 7 times the CK pin."""
    return 0.5 * 7 * DFF_CK_FF * voltage**2


def flip_flop(kind: str, drive: int, corner: Corner) -> Group:
    """Rising-edge D flip-flop; DFFR has an asynchronous low reset RN, DFFS an asynchronous low set SN."""
    pitches = sequential_pitches(kind) + drive - 1
    cell = _cell(f"{kind}_X{drive}", pitches,
                 DFF_LEAKAGE_NW * pitches / sequential_pitches("DFF") * corner.leakage)
    state = cell.add(Group("ff", ["IQ", "IQN"], [("next_state", '"D"'), ("clocked_on", '"CK"')]))
    asynchronous = {"DFFR": ("RN", "clear"), "DFFS": ("SN", "preset")}.get(kind)
    data = cell.add(_input_pin("D", DFF_D_FF))
    data.groups = [_constraint("CK", "setup_rising", setup_ns(corner)),
                   _constraint("CK", "hold_rising", hold_ns(corner))]
    clock = cell.add(_input_pin("CK", DFF_CK_FF, clock="true"))
    clock.add(_energy("", clock_energy_fj(corner.voltage)))
    if asynchronous:
        pin, action = asynchronous
        state.attributes.append((action, f'"!{pin}"'))
        reset = cell.add(_input_pin(pin, DFF_D_FF))
        reset.groups = [_constraint("CK", "recovery_rising", setup_ns(corner)),
                        _constraint("CK", "removal_rising", hold_ns(corner))]
    output = cell.add(_output_pin("Q", drive, "IQ"))
    arc = output.add(Group("timing", [], [("related_pin", '"CK"'), ("timing_type", "rising_edge"),
                                          ("timing_sense", "non_unate")]))
    arc.groups = _delay_tables(lambda _slew, load: clock_to_q(corner, drive, load), corner, drive)
    if asynchronous:
        pin, action = asynchronous
        edge = output.add(Group("timing", [], [("related_pin", f'"{pin}"'), ("timing_type", action),
                                               ("timing_sense", "positive_unate" if action == "clear"
                                                else "negative_unate")]))
        edge.groups = _delay_tables(lambda _slew, load: clock_to_q(corner, drive, load), corner, drive)
    # Master, slave and output stage switch with the data: as many parasitics as four inverters.
    output.add(_energy("CK", _path_energy((inverter(),) * 4, corner.voltage)))
    return cell


def latch(corner: Corner) -> Group:
    """Transparent-high latch, for users who port the RTL. The RTL infers none (the flow stops if it does)."""
    pitches = sequential_pitches("DLATCH")
    cell = _cell("DLATCH_X1", pitches, DFF_LEAKAGE_NW * pitches / sequential_pitches("DFF") * corner.leakage)
    cell.add(Group("latch", ["IQ", "IQN"], [("data_in", '"D"'), ("enable", '"G"')]))
    data = cell.add(_input_pin("D", DFF_D_FF))
    data.groups = [_constraint("G", "setup_falling", setup_ns(corner)),
                   _constraint("G", "hold_falling", hold_ns(corner))]
    cell.add(_input_pin("G", DFF_CK_FF, clock="true"))
    output = cell.add(_output_pin("Q", 1, "IQ"))
    for source, kind in (("D", ""), ("G", "rising_edge")):
        arc = output.add(Group("timing", [], [("related_pin", f'"{source}"')]))
        arc.attributes.append(("timing_type", kind) if kind else ("timing_sense", "positive_unate"))
        arc.groups = _delay_tables(lambda _slew, load: clock_to_q(corner, 1, load), corner, 1)
    return cell


def gate_clock_energy_fj(voltage: float) -> float:
    """One clock edge inside a clock gate, enabled or not: a clock inverter and what it drives, the latch's four clocked
    transistors of half a pin each: 4 times the CK pin."""
    return 0.5 * 4 * DFF_CK_FF * voltage**2


def gate_path(drive: int) -> tuple[Stage, ...]:
    """The AND of a clock gate."""
    return nand(2, _driver_of(drive)), inverter(drive)


def clock_gate(drive: int, corner: Corner) -> Group:
    """Integrated clock gate: latch and AND. Its clock must arrive earlier than that of the registers behind it by the gate's own delay.
    Clocks are ideal in this flow, so the setup time of the enable includes this delay."""
    early, _ = path_delay(gate_path(drive), 0.0, MAX_LOAD_INVERTERS / 2 * drive * CINV_FF, _tau(corner))
    pitches = sequential_pitches("CLKGATE") + 2 * (_driver_of(drive) - 1) + drive - 1
    cell = _cell(f"CLKGATE_X{drive}", pitches, DFF_LEAKAGE_NW * pitches / sequential_pitches("DFF") * corner.leakage)
    cell.attributes.append(("clock_gating_integrated_cell", "latch_posedge"))
    clock = cell.add(_input_pin("CK", GATE_CK_FF[drive], clock="true"))
    clock.attributes.append(("clock_gate_clock_pin", "true"))
    clock.add(_energy("", gate_clock_energy_fj(corner.voltage)))
    enable = cell.add(_input_pin("E", DFF_D_FF))
    enable.attributes.append(("clock_gate_enable_pin", "true"))
    enable.groups = [_constraint("CK", "setup_rising", setup_ns(corner) + early),
                     _constraint("CK", "hold_rising", hold_ns(corner))]
    output = cell.add(Group("pin", ["GCK"], [("direction", "output"), ("clock_gate_out_pin", "true"),
                                             ("state_function", '"CK * E"'),
                                             ("max_capacitance", f"{MAX_LOAD_INVERTERS * drive * CINV_FF:.4f}")]))
    arc = output.add(Group("timing", [], [("related_pin", '"CK"'), ("timing_sense", "positive_unate")]))
    arc.groups = _delay_tables(lambda slew, load: path_delay(gate_path(drive), slew, load, _tau(corner)), corner, drive)
    output.add(_energy("CK", _path_energy(gate_path(drive), corner.voltage)))
    return cell


def _header(corner: Corner, axis: int, wire_um_per_fanout: float = WIRE_UM_PER_FANOUT) -> Group:
    points = ", ".join(str(1000 + index) for index in range(axis))
    library = Group("library", [f"generic40_{corner.name}"], [
        ("comment", '"Generated by synth/dtof_synth/standard_cells.py from public figures. Not sign-off."'),
        ("technology", ["cmos"]), ("delay_model", "table_lookup"),
        ("time_unit", '"1ns"'), ("voltage_unit", '"1V"'), ("current_unit", '"1mA"'),
        ("leakage_power_unit", '"1nW"'), ("pulling_resistance_unit", '"1kohm"'),
        ("capacitive_load_unit", ["1", "ff"]),
        ("nom_process", "1"), ("nom_voltage", f"{corner.voltage}"),
        ("nom_temperature", f"{corner.temperature:g}"),
        *THRESHOLDS,
        ("default_max_transition", f"{_slew_axis(corner)[-1]:.4f}"),
        ("default_fanout_load", "1"), ("default_input_pin_cap", f"{CINV_FF:.4f}"),
        ("default_output_pin_cap", "0"), ("default_inout_pin_cap", f"{CINV_FF:.4f}"),
    ])
    # OpenSTA resolves these names as it reads them: after the groups they name.
    library.trailing = [("default_operating_conditions", corner.name),
                        ("default_wire_load", f'"{WIRE_LOAD}"')]
    library.add(Group("operating_conditions", [corner.name],
                      [("process", "1"), ("voltage", f"{corner.voltage}"),
                       ("temperature", f"{corner.temperature:g}"), ("tree_type", "balanced_tree")]))
    library.add(Group("wire_load", [f'"{WIRE_LOAD}"'],
                      [("capacitance", f"{WIRE_FF_PER_UM}"), ("resistance", "0"),
                       ("slope", f"{wire_um_per_fanout}"),
                       ("fanout_length", ["1", f"{wire_um_per_fanout}"])]))
    library.add(Group("lu_table_template", ["delay_4x4"],
                      [("variable_1", "input_net_transition"), ("variable_2", "total_output_net_capacitance"),
                       ("index_1", [f'"{points}"']), ("index_2", [f'"{points}"'])]))
    return library


def library(corner: Corner, wire_um_per_fanout: float = WIRE_UM_PER_FANOUT) -> str:
    """Liberty text of a corner. Its wire-load model has `wire_um_per_fanout` of wire per sink."""
    root = _header(corner, 4, wire_um_per_fanout)
    root.groups += [gate_cell(gate, corner) for gate in gates()]
    root.groups += [flip_flop(kind, drive, corner)
                    for kind in ("DFF", "DFFR", "DFFS") for drive in (1, 2)]
    root.groups += [latch(corner), *(clock_gate(drive, corner) for drive in GATE_CK_FF), *tie_cells(corner)]
    return root.write() + "\n"
