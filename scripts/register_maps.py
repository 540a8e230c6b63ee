# SPDX-License-Identifier: Apache-2.0
"""The registers of dtof_subsystem for others' tools: SystemRDL 2.0, IP-XACT (IEEE 1685-2014) and CMSIS-SVD 1.3.
scripts/generate.py writes them into driver/maps/."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

from registers import ADDRESS_BITS, READ_ONLY, REGISTER_BITS, WRITTEN, Field, Map, Register

NAME = "dtof_subsystem"
VENDOR, LIBRARY = "dtof", "readout"
DESCRIPTION = "Registers of dtof_subsystem, a read-out of dToF sensors"
IPXACT = "http://www.accellera.org/XMLSchema/IPXACT/1685-2014"
SCHEMA_INSTANCE = "http://www.w3.org/2001/XMLSchema-instance"
# What software and hardware do with a field, by its access in registers.toml.
RDL_ACCESS = {"constant": "sw = r; hw = na;", "status": "sw = r; hw = w;", "setting": "sw = rw; hw = r;",
              "command": "sw = w; hw = r; singlepulse;", "sticky": "sw = rw; hw = w; onwrite = woclr; hwset;"}  # fmt: skip
XML_ACCESS = {"constant": "read-only", "status": "read-only", "setting": "read-write", "command": "write-only",
              "sticky": "read-write"}  # fmt: skip


def version(whole: Map) -> str:
    return f"{whole.major}.{whole.minor}"


def register_access(register: Register) -> str:
    """Access of the whole register: the fields' access, or read-write if they differ."""
    accesses = {XML_ACCESS[field.access] for field in register.fields}
    return accesses.pop() if len(accesses) == 1 else "read-write"


def quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def rdl_field(field: Field) -> str:
    # A constant that the parameters decide has no value here: hardware drives it.
    access = RDL_ACCESS["status" if field.access == "constant" and field.reset_value is None else field.access]
    reset = f" = {field.width}'h{field.reset_value:x}" if field.reset_value is not None else ""
    return f"    field {{ desc = {quoted(field.help)}; {access} }} {field.name}[{field.bits[1]}:{field.bits[0]}]{reset};"


def systemrdl(whole: Map) -> str:
    lines = [
        "// SPDX-License-Identifier: Apache-2.0",
        f"// {WRITTEN}",
        "// SystemRDL 2.0. A field without a reset value has one that the parameters of dtof_subsystem decide.",
        f"addrmap {NAME} {{",
        f"  name = {quoted(NAME)};",
        f"  desc = {quoted(f'{DESCRIPTION}, version {version(whole)}')};",
        f"  default regwidth = {REGISTER_BITS};",
    ]
    for register in whole.registers:
        place = f"[{register.number}] @0x{register.offset:03X} += 0x4" if register.number > 1 else f" @0x{register.offset:03X}"
        lines += ["", "  reg {", f"    desc = {quoted(register.help)};",
                  *(rdl_field(field) for field in register.fields), f"  }} {register.name}{place};"]  # fmt: skip
    return "\n".join([*lines, "};"]) + "\n"


def add(parent: ElementTree.Element, tag: str, text: object = None) -> ElementTree.Element:
    element = ElementTree.SubElement(parent, tag)
    if text is not None:
        element.text = str(text)
    return element


def written(root: ElementTree.Element) -> str:
    ElementTree.indent(root)
    head = f'<?xml version="1.0" encoding="UTF-8"?>\n<!-- SPDX-License-Identifier: Apache-2.0\n     {WRITTEN} -->\n'
    return head + ElementTree.tostring(root, encoding="unicode") + "\n"


def ipxact(whole: Map) -> str:
    root = ElementTree.Element("ipxact:component", {
        "xmlns:ipxact": IPXACT, "xmlns:xsi": SCHEMA_INSTANCE, "xsi:schemaLocation": f"{IPXACT} {IPXACT}/index.xsd"})  # fmt: skip
    for tag, text in (("vendor", VENDOR), ("library", LIBRARY), ("name", NAME), ("version", version(whole))):
        add(root, f"ipxact:{tag}", text)
    memory_map = add(add(root, "ipxact:memoryMaps"), "ipxact:memoryMap")
    add(memory_map, "ipxact:name", "registers")
    block = add(memory_map, "ipxact:addressBlock")
    for tag, text in (("name", NAME), ("baseAddress", "'h0"), ("range", f"'h{1 << ADDRESS_BITS:X}"),
                      ("width", str(REGISTER_BITS)), ("usage", "register")):  # fmt: skip
        add(block, f"ipxact:{tag}", text)
    for register in whole.registers:
        element = add(block, "ipxact:register")
        add(element, "ipxact:name", register.name)
        add(element, "ipxact:description", register.help)
        if register.number > 1:
            add(element, "ipxact:dim", register.number)
        add(element, "ipxact:addressOffset", f"'h{register.offset:X}")
        add(element, "ipxact:size", REGISTER_BITS)
        add(element, "ipxact:access", register_access(register))
        for field in register.fields:
            ipxact_field(element, field)
    add(memory_map, "ipxact:addressUnitBits", 8)
    add(root, "ipxact:description", DESCRIPTION)
    return written(root)


def ipxact_field(register: ElementTree.Element, field: Field) -> None:
    element = add(register, "ipxact:field")
    add(element, "ipxact:name", field.name)
    add(element, "ipxact:description", field.help)
    add(element, "ipxact:bitOffset", field.lowest)
    if field.reset_value is not None:
        add(add(add(element, "ipxact:resets"), "ipxact:reset"), "ipxact:value", f"'h{field.reset_value:X}")
    add(element, "ipxact:bitWidth", field.width)
    if field.access in ("status", "sticky"):
        add(element, "ipxact:volatile", "true")
    add(element, "ipxact:access", XML_ACCESS[field.access])
    if field.access == "sticky":
        add(element, "ipxact:modifiedWriteValue", "oneToClear")


def svd(whole: Map) -> str:
    root = ElementTree.Element("device", {
        "schemaVersion": "1.3", "xmlns:xs": SCHEMA_INSTANCE, "xs:noNamespaceSchemaLocation": "CMSIS-SVD.xsd"})  # fmt: skip
    for tag, text in (("vendor", VENDOR), ("name", NAME), ("version", version(whole)), ("description", DESCRIPTION),
                      ("addressUnitBits", "8"), ("width", str(REGISTER_BITS)), ("size", str(REGISTER_BITS))):  # fmt: skip
        add(root, tag, text)
    peripheral = add(add(root, "peripherals"), "peripheral")
    add(peripheral, "name", "DTOF")
    add(peripheral, "description", "Offsets begin at 0: set the base address of your chip")
    add(peripheral, "baseAddress", "0x0")
    block = add(peripheral, "addressBlock")
    for tag, text in (("offset", "0x0"), ("size", f"0x{1 << ADDRESS_BITS:X}"), ("usage", "registers")):
        add(block, tag, text)
    registers = add(peripheral, "registers")
    for register in whole.registers:
        element = add(registers, "register")
        if register.number > 1:
            add(element, "dim", register.number)
            add(element, "dimIncrement", "0x4")
        add(element, "name", register.name + ("[%s]" if register.number > 1 else ""))
        add(element, "description", register.help)
        add(element, "addressOffset", f"0x{register.offset:03X}")
        add(element, "access", register_access(register))
        add(element, "resetValue", f"0x{register.reset_value:08X}")
        add(element, "resetMask", f"0x{register.reset_mask:08X}")
        fields = add(element, "fields")
        for field in register.fields:
            place = add(fields, "field")
            add(place, "name", field.name)
            add(place, "description", field.help)
            add(place, "bitOffset", field.lowest)
            add(place, "bitWidth", field.width)
            add(place, "access", XML_ACCESS[field.access])
            if field.access == "sticky":
                add(place, "modifiedWriteValues", "oneToClear")
    return written(root)


def files(whole: Map) -> dict[str, str]:
    """All register maps by file name."""
    return {f"driver/maps/{NAME}.rdl": systemrdl(whole), f"driver/maps/{NAME}.ipxact.xml": ipxact(whole),
            f"driver/maps/{NAME}.svd": svd(whole)}  # fmt: skip


assert set(RDL_ACCESS) == set(XML_ACCESS) and set(READ_ONLY) <= set(XML_ACCESS)
