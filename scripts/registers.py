# SPDX-License-Identifier: Apache-2.0
"""hdl/subsystem/registers.toml: the registers of dtof_subsystem and its result words, as the constants of the RTL, a C
header and tables of Markdown. scripts/generate.py writes them; register_maps.py has the formats of others' tools."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path

from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parent.parent
PATH = ROOT / "hdl/subsystem/registers.toml"
WRITTEN = "Written by scripts/generate.py from hdl/subsystem/registers.toml."
ACCESS = {"constant": "read", "status": "read", "setting": "read, write", "command": "write 1",
          "sticky": "read, write 1 clears"}  # fmt: skip
READ_ONLY = ("constant", "status")
BY_PARAMETERS = "parameters"  # a reset value that they decide
REGISTER_BITS, RESULT_BITS, SHORT_RESULT_BITS, ADDRESS_BITS = 32, 64, 32, 12


@dataclass(frozen=True)
class Field:
    name: str
    bits: list[int]  # lowest, highest
    help: str
    access: str = ""
    reset: int | str | None = None  # as given

    @property
    def lowest(self) -> int:
        return self.bits[0]

    @property
    def width(self) -> int:
        return self.bits[1] - self.bits[0] + 1

    @property
    def mask(self) -> int:
        return ((1 << self.width) - 1) << self.lowest

    @property
    def reset_value(self) -> int | None:
        """Value after a reset; None if it depends on parameters."""
        if isinstance(self.reset, int):
            return self.reset
        return None if self.reset == BY_PARAMETERS or self.access == "constant" else 0

    @property
    def place(self) -> str:
        return str(self.bits[0]) if self.width == 1 else f"{self.bits[1]}:{self.bits[0]}"


@dataclass(frozen=True)
class Register:
    name: str
    offset: int
    help: str
    fields: list[Field]
    number: int = 1

    @property
    def last(self) -> int:
        return self.offset + 4 * (self.number - 1)

    @property
    def writable(self) -> bool:
        return any(field.access not in READ_ONLY for field in self.fields)

    @property
    def reset_mask(self) -> int:
        """Bits whose value after a reset is the same for all parameters; bits without a field read as 0."""
        return ((1 << REGISTER_BITS) - 1) & ~sum(field.mask for field in self.fields if field.reset_value is None)

    @property
    def reset_value(self) -> int:
        return sum((field.reset_value or 0) << field.lowest for field in self.fields)

    @property
    def place(self) -> str:
        return f"0x{self.offset:03X}" if self.number == 1 else f"0x{self.offset:03X} to 0x{self.last:03X}"


@dataclass(frozen=True)
class Map:
    id: int
    major: int
    minor: int
    registers: list[Register]
    result: list[Field]
    amplitude_result: list[Field]
    short_result: list[Field]


def checked_fields(where: str, entries: dict, bits: int, access: bool) -> list[Field]:
    fields = [Field(name, **entry) for name, entry in entries.items()]
    taken: set[int] = set()
    for field in fields:
        place = f"{where}.{field.name}"
        if len(field.bits) != 2 or not 0 <= field.lowest <= field.bits[1] < bits:
            raise FlowError(f"{place}: bits must be the lowest and the highest of 0 to {bits - 1}")
        mine = set(range(field.lowest, field.bits[1] + 1))
        if taken & mine:
            raise FlowError(f"{place}: another field has its bits")
        taken |= mine
        if access != (field.access in ACCESS):
            raise FlowError(f"{place}: access must be one of {', '.join(ACCESS)}" if access else f"{place}: has no access")
        if not (field.reset in (None, BY_PARAMETERS) if not isinstance(field.reset, int) else 0 <= field.reset < 1 << field.width):
            raise FlowError(f"{place}: reset must be a number of its bits, or '{BY_PARAMETERS}'")
        if field.access in ("command", "sticky") and field.width != 1:
            raise FlowError(f"{place}: a {field.access} has one bit")
    return fields


def parse(text: str) -> Map:
    where = "registers.toml"
    try:
        table = tomllib.loads(text)
        registers = []
        for name, entry in table["register"].items():
            fields = checked_fields(f"{where}: {name}", entry.pop("fields"), REGISTER_BITS, access=True)
            registers.append(Register(name, fields=fields, **entry))
        result = checked_fields(f"{where}: result", table["result"], RESULT_BITS, access=False)
        amplitude_result = checked_fields(f"{where}: amplitude_result", table["amplitude_result"], RESULT_BITS, access=False)
        short_result = checked_fields(f"{where}: short_result", table["short_result"], SHORT_RESULT_BITS, access=False)
        known = {"ID": {"VALUE": table["id"]}, "VERSION": {"MAJOR": table["major"], "MINOR": table["minor"]}}
        registers = [replace(register, fields=[replace(field, reset=known.get(register.name, {}).get(field.name, field.reset))
                                               for field in register.fields]) for register in registers]
        whole = Map(table["id"], table["major"], table["minor"], registers, result, amplitude_result, short_result)
    except (tomllib.TOMLDecodeError, KeyError, TypeError) as error:
        raise FlowError(f"{where}: {error}") from None
    taken: dict[int, str] = {}
    for register in registers:
        if register.offset % 4 or not 0 <= register.offset <= register.last < 1 << ADDRESS_BITS:
            raise FlowError(f"{where}: {register.name}: the offset must be a multiple of 4 below {1 << ADDRESS_BITS}")
        for offset in range(register.offset, register.last + 4, 4):
            if offset in taken:
                raise FlowError(f"{where}: {register.name} has the offset of {taken[offset]}")
            taken[offset] = register.name
    return whole


def load() -> Map:
    return parse(PATH.read_text(encoding="utf-8"))


def systemverilog(whole: Map) -> str:
    def within(registers: list[Register]) -> str:
        """Condition on `offset` that is true for these registers; neighbours share a comparison."""
        spans: list[list[int]] = []
        for register in sorted(registers, key=lambda register: register.offset):
            if spans and spans[-1][1] + 4 == register.offset:
                spans[-1][1] = register.last
            else:
                spans.append([register.offset, register.last])
        texts = [f"offset == 12'h{first:03x}" if first == last
                 else f"(offset >= 12'h{first:03x} && offset <= 12'h{last:03x})" for first, last in spans]  # fmt: skip
        return "\n        || ".join(texts).replace("(offset >= 12'h000 && ", "(")

    lines = [
        "// SPDX-License-Identifier: Apache-2.0",
        f"// {WRITTEN}",
        "// Offsets of the registers, their values behind a reset (0 where the parameters decide), and for each field its lowest bit and",
        "// its number of bits.",
        "",
        "// verilator lint_off TIMESCALEMOD",
        "`default_nettype none",
        "",
        "package dtof_registers_pkg;",
        "",
        f"  localparam logic [31:0] ID_VALUE = 32'h{whole.id:08x};",
        f"  localparam logic [31:0] VERSION_VALUE = 32'h{whole.major:04x}{whole.minor:04x};",
    ]
    for register in whole.registers:
        lines += ["", f"  // {register.help}", f"  localparam logic [11:0] {register.name} = 12'h{register.offset:03x};"]
        if register.number > 1:
            lines.append(f"  localparam int {register.name}_NUMBER = {register.number};")
        lines.append(f"  localparam logic [31:0] {register.name}_RESET = 32'h{register.reset_value:08x};")
        for field in register.fields:
            lines.append(f"  localparam int {register.name}_{field.name}_LSB = {field.lowest};")
            lines.append(f"  localparam int {register.name}_{field.name}_WIDTH = {field.width};")
    for title, prefix, bits, fields in (("A result.", "RESULT", RESULT_BITS, whole.result),
                                        ("Fields of a result with amplitude.", "AMPLITUDE_RESULT", RESULT_BITS, whole.amplitude_result),
                                        ("A short result.", "SHORT_RESULT", SHORT_RESULT_BITS, whole.short_result)):  # fmt: skip
        lines += ["", f"  // {title}", f"  localparam int {prefix}_WIDTH = {bits};"]
        for field in fields:
            lines.append(f"  localparam int {prefix}_{field.name}_LSB = {field.lowest};")
            lines.append(f"  localparam int {prefix}_{field.name}_WIDTH = {field.width};")
    for name, chosen in (("is_register", whole.registers),
                         ("is_writable", [register for register in whole.registers if register.writable])):  # fmt: skip
        lines += ["", f"  function automatic bit {name}(input logic [11:0] offset);",
                  f"    {name} = {within(chosen)};", "  endfunction"]  # fmt: skip
    return "\n".join([*lines, "", "endpackage", "", "`default_nettype wire"]) + "\n"


def c_header(whole: Map) -> str:
    lines = [
        "/* SPDX-License-Identifier: Apache-2.0",
        f" * {WRITTEN}",
        " * Register offsets are in bytes. Each field has its lowest bit (LSB) and the mask of its bits in the register. */",
        "#ifndef DTOF_REGISTERS_H",
        "#define DTOF_REGISTERS_H",
        "",
        f"#define DTOF_ID_EXPECTED UINT32_C(0x{whole.id:08X})",
        f"#define DTOF_VERSION_MAJOR_EXPECTED UINT32_C({whole.major})",
        f"#define DTOF_VERSION_MINOR_EXPECTED UINT32_C({whole.minor})",
    ]

    def field_lines(prefix: str, field: Field, bits: int) -> list[str]:
        mask = ((1 << field.width) - 1) << field.lowest
        return [f"#define {prefix}_{field.name}_LSB {field.lowest}",
                f"#define {prefix}_{field.name}_MASK UINT{bits}_C(0x{mask:0{bits // 4}X})"]  # fmt: skip

    for register in whole.registers:
        lines += ["", f"/* {register.help} */", f"#define DTOF_{register.name} UINT32_C(0x{register.offset:03X})"]
        if register.number > 1:
            lines.append(f"#define DTOF_{register.name}_NUMBER {register.number}")
        for field in register.fields:
            lines += field_lines(f"DTOF_{register.name}", field, REGISTER_BITS)
    lines += ["", "/* X(offset, registers, value after a reset, bits of it that do not depend on parameters) for each register. */",
              "#define DTOF_FOR_EACH_REGISTER(X) \\"]  # fmt: skip
    for register in whole.registers:
        end = "" if register is whole.registers[-1] else " \\"
        lines.append(f"  X(DTOF_{register.name}, {register.number}, UINT32_C(0x{register.reset_value:08X}), "
                     f"UINT32_C(0x{register.reset_mask:08X})){end}")
    lines += ["", "/* A result: a word of 64 bits. */"]
    for field in whole.result:
        lines += field_lines("DTOF_RESULT", field, RESULT_BITS)
    lines += ["", "/* Fields of a result in a frame with OUTPUT.AMPLITUDE, in place of row and column. */"]
    for field in whole.amplitude_result:
        lines += field_lines("DTOF_AMPLITUDE_RESULT", field, RESULT_BITS)
    lines += ["", "/* A short result: half a beat of 64 bits. */"]
    for field in whole.short_result:
        lines += field_lines("DTOF_SHORT_RESULT", field, SHORT_RESULT_BITS)
    return "\n".join([*lines, "", "#endif"]) + "\n"


def register_table(whole: Map) -> str:
    lines = ["| offset | register | bits | field | access | meaning |", "|---|---|---|---|---|---|"]
    for register in whole.registers:
        lines.append(f"| {register.place} | `{register.name}` | | | | {register.help} |")
        for field in register.fields:
            lines.append(f"| | | {field.place} | `{field.name}` | {ACCESS[field.access]} | {field.help} |")
    return "\n".join(lines) + "\n"


def result_table(fields: list[Field]) -> str:
    lines = ["| bits | field | meaning |", "|---|---|---|"]
    lines += [f"| {field.place} | `{field.name}` | {field.help} |" for field in fields]
    return "\n".join(lines) + "\n"


def result_tables(whole: Map) -> dict[str, str]:
    return {"result word": result_table(whole.result), "amplitude result word": result_table(whole.amplitude_result),
            "short result word": result_table(whole.short_result)}  # fmt: skip


def page(text: str, file: str, tables: dict[str, str]) -> str:
    """The page `file` with each table between its marks."""
    for name, table in tables.items():
        begin = f"<!-- {name}: written by scripts/generate.py -->\n"
        end = f"<!-- end of {name} -->\n"
        if text.count(begin) != 1 or text.count(end) != 1:
            raise FlowError(f"{file} has no place for the table of {name}")
        head, rest = text.split(begin)
        text = head + begin + "\n" + table + "\n" + end + rest.split(end)[1]
    return text
