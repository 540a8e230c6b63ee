# SPDX-License-Identifier: Apache-2.0
"""Files of the SRAM macros: Liberty, LEF abstract, black boxes, and the technology modules that pick them.

`dtof_sram_1rw` and `dtof_sram_1r1w` are the only technology modules of the RTL. Here their body is a choice among
the sizes of synth/sram_sizes.csv; any other size stops elaboration.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable
from pathlib import Path

from . import sram_model
from .errors import FlowError
from .files import write_if_changed
from .liberty import THRESHOLDS, Group, bus_type, quoted
from .sram_model import Macro, Size
from .standard_cells import CINV_FF, CORNERS, FO4_NS, SLOW, Corner

HEADER = ["ports", "words", "bits", "parts"]
PIN_FF = 2 * CINV_FF  # an address or data pin is one input inverter of drive 2
CLOCK_PIN_FF = 16 * CINV_FF  # the clock pin fans out to every latch and precharge driver
OUTPUT_DRIVE = 4


def read_sizes(path: Path) -> list[Size]:
    """All sizes in use, sorted."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            lines = [line for line in csv.reader(file) if line and not line[0].startswith("#")]
    except OSError as error:
        raise FlowError(f"{path}: cannot read the list of SRAM sizes ({error.strerror})") from None
    if not lines or lines[0] != HEADER:
        raise FlowError(f"{path}: the first line must be '{','.join(HEADER)}'")
    try:
        return sorted({Size(*map(int, line)) for line in lines[1:]})
    except (ValueError, TypeError):
        raise FlowError(f"{path}: every line must be four integers: {','.join(HEADER)}") from None


def write_sizes(path: Path, sizes: list[Size]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        file.write("# Every SRAM size in use; written by `make synth-sizes` from configurations.toml.\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows((size.ports, size.words, size.bits, size.parts) for size in sorted(sizes))


def pins(size: Size) -> list[tuple[str, str, int]]:
    """(name, direction, bits) of every pin, clock first; 0 bits: a scalar."""
    address = ("input", size.address_bits)
    data = size.bits
    if size.ports == 1:
        mask = [("wparts_i", "input", size.parts)] if size.parts > 1 else []
        return [("clk_i", "input", 0), ("en_i", "input", 0), ("we_i", "input", 0), ("addr_i", *address),
                *mask, ("wdata_i", "input", data), ("rdata_o", "output", data)]
    return [("clk_i", "input", 0), ("re_i", "input", 0), ("raddr_i", *address),
            ("we_i", "input", 0), ("waddr_i", *address), ("wdata_i", "input", data),
            ("rdata_o", "output", data)]


def _scalar(kind: str, value: float) -> Group:
    return Group(kind, ["scalar"], [("values", [quoted([value])])])


def _constraints(macro: Macro) -> list[Group]:
    return [Group("timing", [], [("related_pin", '"clk_i"'), ("timing_type", kind)],
                  [_scalar("rise_constraint", value), _scalar("fall_constraint", value)])
            for kind, value in (("setup_rising", macro.setup), ("hold_rising", macro.hold))]


def _access_energy(macro: Macro) -> list[Group]:
    """Energy of an access at the rising clock edge, fJ, under the port's condition."""
    read, write = ("en_i * !we_i", "en_i * we_i") if macro.size.ports == 1 else ("re_i", "we_i")
    return [Group("internal_power", [], [("when", f'"{when}"')],
                  [_scalar("rise_power", picojoules * 1000), _scalar("fall_power", 0)])
            for when, picojoules in ((read, macro.read_energy), (write, macro.write_energy))]


def _read_arc(access: float, corner: Corner) -> Group:
    """Timing arc from clock to data: the access time with a fan-out of 4, with an output driver of drive 4."""
    tau = FO4_NS / 5 * corner.gate
    loads = [OUTPUT_DRIVE * CINV_FF * multiple for multiple in (1, 4, 12, 24)]
    delays = [access + tau * (load / (OUTPUT_DRIVE * CINV_FF) - 4) for load in loads]
    slews = [tau * (1 + load / (OUTPUT_DRIVE * CINV_FF)) for load in loads]
    arc = Group("timing", [], [("related_pin", '"clk_i"'), ("timing_type", "rising_edge"),
                               ("timing_sense", "non_unate")])
    for kind, values in (("cell_rise", delays), ("rise_transition", slews),
                         ("cell_fall", delays), ("fall_transition", slews)):
        arc.add(Group(kind, ["load_4"], [("index_1", [quoted(loads)]), ("values", [quoted(values)])]))
    return arc


def _cell(macro: Macro, corner: Corner) -> Group:
    size = macro.size
    # In the fast corner an access is faster as the gates are.
    access = macro.access_slow if corner is SLOW else macro.access_typical * corner.gate
    cell = Group("cell", [size.name], [
        ("area", f"{macro.area:.2f}"), ("interface_timing", "true"), ("dont_touch", "true"),
        ("dont_use", "true"), ("cell_leakage_power", f"{macro.leakage * 1000:.4f}")])
    cell.add(Group("memory", [], [("type", "ram"), ("address_width", str(size.address_bits)),
                                  ("word_width", str(size.bits))]))
    for name, direction, bits in pins(size):
        kind = "bus" if bits else "pin"
        pin = cell.add(Group(kind, [name], [("direction", direction)]))
        if bits:
            pin.attributes.insert(0, ("bus_type", f"bits_{bits}_0"))
        if name == "clk_i":
            # The array is ready again when the data is out; CACTI's cycle is shorter than its access.
            pin.attributes += [("clock", "true"), ("capacitance", f"{CLOCK_PIN_FF:.4f}"),
                               ("min_period", f"{access:.4f}")]
            pin.groups = _access_energy(macro)
        elif direction == "input":
            pin.attributes.append(("capacitance", f"{PIN_FF:.4f}"))
            pin.groups = _constraints(macro)
        else:
            pin.attributes.append(("max_capacitance", f"{24 * OUTPUT_DRIVE * CINV_FF:.4f}"))
            address = "addr_i" if size.ports == 1 else "raddr_i"
            pin.add(Group("memory_read", [], [("address", address)]))
            pin.add(_read_arc(access, corner))
    return cell


def liberty(macros: list[Macro], corner: Corner) -> str:
    library = Group("library", [f"sram40_{corner.name}"], [
        ("comment", '"Generated by synth/dtof_synth/sram_kit.py from a physical model. Not sign-off."'),
        ("technology", ["cmos"]), ("delay_model", "table_lookup"), ("time_unit", '"1ns"'),
        ("voltage_unit", '"1V"'), ("current_unit", '"1mA"'), ("leakage_power_unit", '"1nW"'),
        ("pulling_resistance_unit", '"1kohm"'), ("capacitive_load_unit", ["1", "ff"]),
        ("nom_process", "1"), ("nom_voltage", f"{corner.voltage}"),
        ("nom_temperature", f"{corner.temperature:g}"),
        *THRESHOLDS])
    library.add(Group("lu_table_template", ["load_4"], [("variable_1", "total_output_net_capacitance"),
                                                        ("index_1", ['"1, 2, 3, 4"'])]))
    widths = {bits for macro in macros for _, _, bits in pins(macro.size) if bits}
    library.groups += [bus_type(bits) for bits in sorted(widths)]
    library.groups += [_cell(macro, corner) for macro in macros]
    return library.write() + "\n"


PIN_PITCH_UM = 0.28  # two tracks of an intermediate metal at 0.14 um
PIN_SIZE_UM = 0.14


def lef(macros: list[Macro]) -> str:
    """LEF abstracts: size, pins along the lower edge on metal4, obstructions below."""
    lines = ["VERSION 5.7 ;", 'BUSBITCHARS "[]" ;', 'DIVIDERCHAR "/" ;']
    for macro in macros:
        name = macro.size.name
        lines += [f"MACRO {name}", "  CLASS BLOCK ;", "  ORIGIN 0 0 ;", "  SYMMETRY X Y R90 ;",
                  f"  SIZE {macro.width:.3f} BY {macro.height:.3f} ;"]
        x = PIN_PITCH_UM
        for pin, direction, bits in pins(macro.size):
            for bit in [f"{pin}[{index}]" for index in range(bits)] if bits else [pin]:
                use = "CLOCK" if pin == "clk_i" else "SIGNAL"
                lines += [f"  PIN {bit}", f"    DIRECTION {direction.upper()} ;", f"    USE {use} ;",
                          "    PORT", "      LAYER metal4 ;",
                          f"      RECT {x:.3f} 0.000 {x + PIN_SIZE_UM:.3f} {PIN_SIZE_UM:.3f} ;",
                          "    END", f"  END {bit}"]
                x += PIN_PITCH_UM
        lines.append("  OBS")
        for layer in ("metal1", "metal2", "metal3"):
            lines += [f"    LAYER {layer} ;", f"    RECT 0.000 0.000 {macro.width:.3f} {macro.height:.3f} ;"]
        lines += ["  END", f"END {name}"]
    return "\n".join([*lines, "END LIBRARY", ""])


def _ports(size: Size, width_of) -> list[str]:
    return [f"{direction} wire {width_of(bits)}{name}" if direction == "input"
            else f"output wire {width_of(bits)}{name}" for name, direction, bits in pins(size)]


def black_boxes(macros: list[Macro]) -> str:
    lines = ["// SPDX-License-Identifier: Apache-2.0", "// Generated: one black box a macro."]
    for macro in macros:
        ports = _ports(macro.size, lambda bits: f"[{bits - 1}:0] " if bits else "")
        lines += ["", "(* blackbox *)", f"module {macro.size.name} ("]
        lines += [f"    {port}," for port in ports[:-1]] + [f"    {ports[-1]}", ");", "endmodule"]
    return "\n".join([*lines, ""])


def behavioural_models(sizes: Iterable[Size]) -> str:
    """Simulation models of the macros: each is the technology folder's stand-in with this size."""
    lines = ["// SPDX-License-Identifier: Apache-2.0", "// Generated: every macro is a behavioural SRAM of its size."]
    for size in sorted(set(sizes)):
        connections = ", ".join(f".{name}({name})" for name, _, _ in pins(size))
        parts = f", .PARTS({size.parts})" if size.parts > 1 else ""
        all_parts = ", .wparts_i(1'b1)" if size.ports == 1 and size.parts == 1 else ""
        lines += ["", f"module {size.name} (",
                  ",\n".join(f"    {port}" for port in _ports(size, lambda bits: f"[{bits - 1}:0] " if bits else "")),
                  ");", f"  {sram_model.KINDS[size.ports].module} #(.DEPTH({size.words}), .WIDTH({size.bits}){parts}) "
                  f"u_memory ({connections}{all_parts}, .cfg_i(1'b0), .cfg_o());", "endmodule"]
    return "\n".join([*lines, ""])


def technology_module(ports: int, sizes: list[Size]) -> str:
    """Technology module of a port kind, which selects among the listed sizes."""
    module = sram_model.KINDS[ports].module
    names = {"addr_i": "A", "raddr_i": "A", "waddr_i": "A", "wdata_i": "W", "rdata_o": "W", "wparts_i": "P"}
    reference = pins(Size(ports, 16, 2, 2))
    lines = ["// SPDX-License-Identifier: Apache-2.0",
             "// Generated from a list of SRAM sizes; any other size stops elaboration.",
             f"module {module} #(", "    parameter DEPTH = 1,", "    parameter WIDTH = 1,",
             *(["    parameter PARTS = 1,"] if ports == 1 else []), "    parameter CFG_WIDTH = 1", ") (",
             "    input wire [CFG_WIDTH-1:0] cfg_i,", "    output wire [CFG_WIDTH-1:0] cfg_o,"]
    for index, (name, direction, _) in enumerate(reference):
        span = {"A": "[(DEPTH > 1 ? $clog2(DEPTH) : 1)-1:0] ", "W": "[WIDTH-1:0] ", "P": "[PARTS-1:0] "}.get(names.get(name, ""), "")
        lines.append(f"    {direction} wire {span}{name}{',' if index < len(reference) - 1 else ''}")
    lines += [");", "  assign cfg_o = cfg_i;  // these macros have no side band", "  generate"]
    keyword = "if"
    for size in [size for size in sizes if size.ports == ports]:
        connections = ", ".join(f".{name}({name})" for name, _, _ in pins(size))
        parts = f" && PARTS == {size.parts}" if ports == 1 else ""
        label = f"g_{size.words}x{size.bits}" + (f"_{size.parts}p" if size.parts > 1 else "")
        lines += [f"    {keyword} (DEPTH == {size.words} && WIDTH == {size.bits}{parts}) begin : {label}",
                  f"      {size.name} u_macro ({connections});"]
        keyword = "end else if"
    # The first argument is the sentence, as Yosys 0.23 takes it.
    fatal = f'$fatal("{module}: the RTL asks for a size that is not listed (synth/sram_sizes.csv, dtof_synth/configuration.py)");'
    lines += ["    end else begin : g_unlisted", f"      {fatal}", "    end"] if keyword != "if" \
        else [f"    {fatal}"]
    return "\n".join([*lines, "  endgenerate", "endmodule", ""])


def write_kit(folder: Path, sizes: list[Size], macro_of: Callable[[Size], Macro] = sram_model.macro) -> list[Macro]:
    """Writes the whole kit; returns the macros."""
    folder.mkdir(parents=True, exist_ok=True)
    macros = [macro_of(size) for size in sorted(sizes)]
    for corner in CORNERS:
        write_if_changed(folder / f"sram40_{corner.name}.lib", liberty(macros, corner))
    write_if_changed(folder / "sram40.lef", lef(macros))
    write_rtl_views(folder, sizes)
    return macros


def write_rtl_views(folder: Path, sizes: Iterable[Size]) -> list[Path]:
    """Writes black boxes of these sizes and the technology modules that select them; returns the files."""
    sizes = sorted(set(sizes))
    files = {"sram40_blackbox.v": black_boxes([sram_model.macro(size) for size in sizes])}
    for ports, kind in sram_model.KINDS.items():
        files[f"{kind.module}.sv"] = technology_module(ports, sizes)
    for name, text in files.items():
        write_if_changed(folder / name, text)
    return [folder / name for name in files]
