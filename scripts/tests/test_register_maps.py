# SPDX-License-Identifier: Apache-2.0
"""The maps for others' tools say what the package of the RTL says. Each is read by a few lines here, the XML by xmllint against the
structure of its standard, and each by a reader of others where that is installed."""

import importlib.util
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import NamedTuple

import register_maps
import registers

ROOT = Path(__file__).resolve().parents[2]
SCHEMAS = Path(__file__).parent / "schemas"
MAPS = ROOT / "driver/maps"
RDL, IPXACT, SVD = (MAPS / f"dtof_subsystem.{suffix}" for suffix in ("rdl", "ipxact.xml", "svd"))
NAMESPACE = {"ipxact": register_maps.IPXACT}


class Bits(NamedTuple):
    lowest: int
    width: int
    access: str  # as in XML, and "oneToClear"
    reset: int | None


class Entry(NamedTuple):
    offset: int
    number: int
    fields: dict[str, Bits]


def number(text: str) -> int:
    return int(text.replace("'h", "0x"), 0)


def of_package() -> dict[str, Entry]:
    """Places from the constants of the RTL, access from its description, resets from both."""
    text = (ROOT / "hdl/subsystem/dtof_registers_pkg.sv").read_text(encoding="utf-8")
    constants = {name: int(value.replace("12'h", "0x").replace("32'h", "0x"), 0)
                 for name, value in re.findall(r"localparam (?:int|logic \[\d+:0\]) (\w+) = (\S+);", text)}
    entries = {}
    for register in registers.load().registers:
        name, fields = register.name, {}
        for field in register.fields:
            lowest, width = constants[f"{name}_{field.name}_LSB"], constants[f"{name}_{field.name}_WIDTH"]
            reset = (constants[f"{name}_RESET"] >> lowest) & ((1 << width) - 1)
            access = {"constant": "read-only", "status": "read-only", "setting": "read-write", "command": "write-only",
                      "sticky": "oneToClear"}[field.access]  # fmt: skip
            fields[field.name] = Bits(lowest, width, access, reset if field.reset_value is not None else None)
        entries[name] = Entry(constants[name], constants.get(f"{name}_NUMBER", 1), fields)
    return entries


def of_rdl(text: str) -> dict[str, Entry]:
    entries = {}
    properties = {"sw = r; hw = na;": "read-only", "sw = r; hw = w;": "read-only", "sw = rw; hw = r;": "read-write",
                  "sw = w; hw = r; singlepulse;": "write-only", "sw = rw; hw = w; onwrite = woclr; hwset;": "oneToClear"}
    string = r'"(?:[^"\\]|\\.)*"'
    for body, name, many, offset in re.findall(r"  reg \{\n(.*?)\n  \} (\w+)(?:\[(\d+)\])? ?@0x(\w+)", text, re.DOTALL):
        fields = {field: Bits(int(low), int(high) - int(low) + 1, properties[access], int(reset, 16) if reset else None)
                  for access, field, high, low, reset in re.findall(
                      rf"field \{{ desc = {string}; (.*?) \}} (\w+)\[(\d+):(\d+)\](?: = \d+'h(\w+))?;", body)}
        entries[name] = Entry(int(offset, 16), int(many or 1), fields)
    return entries


def of_ipxact(text: str) -> dict[str, Entry]:
    def get(element: ElementTree.Element, path: str) -> str:
        """Text of an element inside; nothing if there is none."""
        return element.findtext("/".join(f"ipxact:{part}" for part in path.split("/")), "", NAMESPACE)

    entries = {}
    for register in ElementTree.fromstring(text).iterfind(".//ipxact:register", NAMESPACE):
        fields = {}
        for field in register.iterfind("ipxact:field", NAMESPACE):
            reset = get(field, "resets/reset/value")
            fields[get(field, "name")] = Bits(number(get(field, "bitOffset")), number(get(field, "bitWidth")),
                                              get(field, "modifiedWriteValue") or get(field, "access"),
                                              number(reset) if reset else None)  # fmt: skip
        entries[get(register, "name")] = Entry(number(get(register, "addressOffset")), number(get(register, "dim") or "1"), fields)
    return entries


def of_svd(text: str) -> dict[str, Entry]:
    entries = {}
    for register in ElementTree.fromstring(text).iterfind(".//register"):
        value, mask = number(register.findtext("resetValue", "")), number(register.findtext("resetMask", ""))
        fields = {}
        for field in register.iterfind("fields/field"):
            lowest, width = number(field.findtext("bitOffset", "")), number(field.findtext("bitWidth", ""))
            bits = (1 << width) - 1
            access = field.findtext("modifiedWriteValues", "") or field.findtext("access", "")
            fields[field.findtext("name", "")] = Bits(
                lowest, width, access, (value >> lowest) & bits if (mask >> lowest) & bits == bits else None)
        entries[register.findtext("name", "").replace("[%s]", "")] = Entry(
            number(register.findtext("addressOffset", "")), number(register.findtext("dim") or "1"), fields)
    return entries


READERS = {RDL: of_rdl, IPXACT: of_ipxact, SVD: of_svd}


class Maps(unittest.TestCase):
    maxDiff = None

    def test_each_says_what_the_package_says(self) -> None:
        expected = of_package()
        self.assertGreater(len(expected), 30)
        for path, read in READERS.items():
            with self.subTest(map=path.name):
                self.assertEqual(read(path.read_text(encoding="utf-8")), expected)

    def test_a_change_in_a_map_is_noticed(self) -> None:
        expected = of_package()
        for path, changes in {
            RDL: (("WATCHDOG @0x06C", "WATCHDOG @0x070"), ("FIRST[11:0]", "FIRST[12:0]"), ("24'hffffff", "24'hfffffe"),
                  ("sw = rw; hw = r; } BITS", "sw = r; hw = w; } BITS"), ("COLUMN_ENABLE[32]", "COLUMN_ENABLE[31]")),
            IPXACT: (("<ipxact:addressOffset>'h6C<", "<ipxact:addressOffset>'h68<"), ("<ipxact:bitWidth>24<", "<ipxact:bitWidth>23<"),
                     ("<ipxact:value>'hFFFFFF<", "<ipxact:value>'hFFFFF<"), ("<ipxact:dim>32<", "<ipxact:dim>31<")),
            SVD: (("<addressOffset>0x06C<", "<addressOffset>0x068<"), ("<modifiedWriteValues>oneToClear</modifiedWriteValues>", ""),
                  ("<resetValue>0x00FFFFFF<", "<resetValue>0x00FFFFFE<"), ("<dim>32<", "<dim>33<")),
        }.items():  # fmt: skip
            text = path.read_text(encoding="utf-8")
            for before, after in changes:
                with self.subTest(map=path.name, change=after):
                    self.assertIn(before, text)
                    self.assertNotEqual(READERS[path](text.replace(before, after, 1)), expected)

    def test_only_registers_with_something_to_write_are_writable_in_the_rtl(self) -> None:
        text = (ROOT / "hdl/subsystem/dtof_registers_pkg.sv").read_text(encoding="utf-8")
        found = re.search(r"is_writable = (.*?);", text, re.DOTALL)
        assert found is not None
        condition = found[1].replace("&&", "and").replace("||", "or")
        condition = " ".join(condition.replace("12'h", "0x").split())
        for name, entry in of_svd(SVD.read_text(encoding="utf-8")).items():
            writable = eval(condition, {"offset": entry.offset})  # noqa: S307  (numbers and comparisons of our own file)
            self.assertEqual(writable, any(bits.access != "read-only" for bits in entry.fields.values()), name)

    @unittest.skipUnless(shutil.which("xmllint"), "xmllint is not installed")
    def test_xmllint_reads_both_xml_against_the_structure_of_their_standards(self) -> None:
        for path, schema in ((IPXACT, "ipxact.rng"), (SVD, "cmsis_svd.rng")):
            with self.subTest(map=path.name):
                command = ["xmllint", "--noout", "--relaxng", str(SCHEMAS / schema)]
                result = subprocess.run([*command, str(path)], capture_output=True, text=True)
                self.assertEqual(result.returncode, 0, result.stderr)
                text = path.read_text(encoding="utf-8")
                swapped = re.sub(r"(<\S*bitOffset>.*?</\S*bitOffset>)(\s*)(<\S*bitWidth>.*?</\S*bitWidth>)", r"\3\2\1", text, count=1)
                self.assertNotEqual(swapped, text)
                refused = subprocess.run([*command, "-"], input=swapped, capture_output=True, text=True)
                self.assertNotEqual(refused.returncode, 0, "another order of elements is legal")

    @unittest.skipUnless(importlib.util.find_spec("systemrdl"), "systemrdl-compiler is not installed")
    def test_systemrdl_compiler_reads_the_map(self) -> None:
        from systemrdl import RDLCompiler
        from systemrdl.node import RegNode

        compiler = RDLCompiler()
        compiler.compile_file(str(RDL))
        found = {}
        for node in compiler.elaborate().top.children(unroll=False):
            self.assertIsInstance(node, RegNode)
            fields = {}
            for field in node.fields():
                access = ("oneToClear" if field.get_property("onwrite") is not None else
                          {(True, False): "read-only", (False, True): "write-only", (True, True): "read-write"}[
                              field.is_sw_readable, field.is_sw_writable])  # fmt: skip
                fields[field.inst_name] = Bits(field.low, field.width, access, field.get_property("reset"))
            found[node.inst_name] = Entry(node.raw_address_offset, node.array_dimensions[0] if node.is_array else 1, fields)
        self.assertEqual(found, of_package())

    @unittest.skipUnless(importlib.util.find_spec("cmsis_svd"), "cmsis-svd is not installed")
    def test_cmsis_svd_reads_the_map(self) -> None:
        from cmsis_svd.parser import SVDParser

        device = SVDParser.for_xml_file(str(SVD)).get_device()
        found = {register.name: register.address_offset for register in device.peripherals[0].registers}
        for name, entry in of_package().items():
            for k in range(entry.number):
                self.assertEqual(found[f"{name}{k}" if entry.number > 1 else name], entry.offset + 4 * k)

    @unittest.skipUnless(importlib.util.find_spec("ipyxact"), "ipyxact is not installed")
    def test_ipyxact_reads_the_map(self) -> None:
        from ipyxact.ipyxact import Component

        component = Component()
        component.load(str(IPXACT))
        block = component.memoryMaps.memoryMap[0].addressBlock[0]
        self.assertEqual({register.name: number(str(register.addressOffset)) for register in block.register},
                         {name: entry.offset for name, entry in of_package().items()})  # fmt: skip


if __name__ == "__main__":
    unittest.main()
