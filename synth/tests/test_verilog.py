# SPDX-License-Identifier: Apache-2.0
"""What is written for OpenSTA is, read back by Yosys, the same netlist."""

import json
import tempfile
import unittest
from pathlib import Path

from dtof_synth import tools, verilog
from dtof_synth.errors import FlowError

CELL = {"hide_name": 0, "parameters": {}, "attributes": {}}


def cell(kind: str, **pins: tuple[str, list]) -> dict:
    return CELL | {"type": kind, "port_directions": {pin: direction for pin, (direction, _) in pins.items()},
                   "connections": {pin: bits for pin, (_, bits) in pins.items()}}


def design() -> dict:
    """A block whose input has bits 5 to 4, in an array that hands an input on and ties a pin low and an output high."""
    block = {"attributes": {}, "netnames": {},
             "ports": {"a_i": {"direction": "input", "bits": [2, 3], "offset": 4}, "y_o": {"direction": "output", "bits": [4]}},
             "cells": {"g": cell("AND", A=("input", [2]), B=("input", [3]), Y=("output", [4]))}}
    array = {"attributes": {"top": "1"}, "netnames": {"wire_9": {"bits": [9], "attributes": {}, "hide_name": 0}},
             "ports": {"x_i": {"direction": "input", "bits": [2, 3]}, "y_o": {"direction": "output", "bits": [5]},
                       "handed_on_o": {"direction": "output", "bits": [3]}, "high_o": {"direction": "output", "bits": ["1"]}},
             "cells": {"u": cell("block", a_i=("input", [3, 9]), y_o=("output", [5])),
                       "t": cell("AND", A=("input", [2]), B=("input", ["0"]), Y=("output", [9]))}}
    return {"modules": {"block": block, "array": array}}


def connections(module: dict) -> set[frozenset]:
    """The nets, each as the set of what is on it, whatever they are called."""
    nets: dict = {}
    for name, port in module["ports"].items():
        for index, bit in enumerate(port["bits"]):
            nets.setdefault(bit, set()).add((name, index))
    for name, one in module["cells"].items():
        for pin, bits in one["connections"].items():
            for index, bit in enumerate(bits):
                nets.setdefault(bit, set()).add((name, pin, index))
    return {frozenset(pins | ({bit} if isinstance(bit, str) else set())) for bit, pins in nets.items()}


class Verilog(unittest.TestCase):
    def test_yosys_reads_the_same_netlist(self) -> None:
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            (folder / "array.v").write_text(
                "(* blackbox *) module AND (input A, input B, output Y); endmodule\n" + verilog.write(design()), encoding="utf-8")
            (folder / "read.tcl").write_text(
                f"yosys -import\nread_verilog {folder}/array.v\nhierarchy -check -top array\nopt_clean\n"
                f"write_json {folder}/array.json\n", encoding="utf-8")
            tools.run_yosys(folder / "read.tcl", folder / "none", folder / "read.log", "test")
            found = json.loads((folder / "array.json").read_text(encoding="utf-8"))
        for name, module in design()["modules"].items():
            with self.subTest(name):
                self.assertEqual(connections(found["modules"][name]), connections(module))
                self.assertEqual(found["modules"][name]["ports"]["a_i" if name == "block" else "x_i"].get("offset", 0),
                                 module["ports"]["a_i" if name == "block" else "x_i"].get("offset", 0))

    def test_the_text(self) -> None:
        self.assertEqual(verilog.write(design()), """module block (a_i, y_o);
  input [5:4] a_i;
  output y_o;
  AND g (.A(a_i[4]), .B(a_i[5]), .Y(y_o));
endmodule

module array (x_i, y_o, handed_on_o, high_o);
  input [1:0] x_i;
  output y_o;
  output handed_on_o;
  output high_o;
  wire wire_9;
  assign handed_on_o = x_i[1];
  assign high_o = 1'b1;
  block u (.a_i({wire_9, x_i[1]}), .y_o(y_o));
  AND t (.A(x_i[0]), .B(1'b0), .Y(wire_9));
endmodule
""")

    def test_only_nets_of_wires_keep_their_names(self) -> None:
        some = design()
        for net, bits, name in (("other", [9], "net_9"), ("wire_9", [9, 10], "net_9"), ("wire_a", [9], "wire_a")):
            some["modules"]["array"]["netnames"] = {net: {"bits": bits}, "wire_port": {"bits": [2]}}
            text = verilog.write(some)
            self.assertIn(f"  wire {name};\n", text)
            self.assertNotIn("wire_port", text)
        some["modules"]["macro"] = {"attributes": {}, "netnames": {}, "ports": {}, "cells": {}}
        some["modules"]["block"]["ports"]["a_i"] = {"direction": "input", "bits": [2], "offset": 3}
        self.assertNotIn("macro", verilog.write(some))
        self.assertIn("  input [3:3] a_i;\n", verilog.write(some))

    def test_a_name_that_needs_an_escape_is_refused(self) -> None:
        bad = design()
        bad["modules"]["array"]["cells"]["u.v"] = bad["modules"]["array"]["cells"].pop("u")
        with self.assertRaisesRegex(FlowError, "u.v"):
            verilog.write(bad)


if __name__ == "__main__":
    unittest.main()
