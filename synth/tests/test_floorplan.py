# SPDX-License-Identifier: Apache-2.0
"""The floorplan's places, trees and repeaters, the check of the borders, and the wires that OpenSTA is told of."""

import os
import random
import re
import tempfile
import unittest
from pathlib import Path

from dtof_synth import floorplan, library, netlist, spef, standard_cells, tools
from dtof_synth.errors import FlowError
from dtof_synth.floorplan import Floorplan, Wire

ROOT = Path(__file__).resolve().parents[2]
COLUMN_PIN_FF = 3.0


def cell(kind: str, inputs: dict[str, int], outputs: dict[str, int]) -> dict:
    return {"type": kind, "parameters": {}, "attributes": {},
            "port_directions": {**dict.fromkeys(inputs, "input"), **dict.fromkeys(outputs, "output")},
            "connections": {pin: [bit] for pin, bit in {**inputs, **outputs}.items()}}


def array(columns: int) -> dict:
    """Two registers in a row tell `columns` columns something; each has a timestamp of its own at a port."""
    cells = {"near": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 4}), "far": cell("DFF_X1", {"D": 4, "CK": 2}, {"Q": 5})}
    ports = {"clk_i": {"direction": "input", "bits": [2]}, "told_i": {"direction": "input", "bits": [3]},
             floorplan.TIMESTAMP_PORT: {"direction": "input", "bits": [100 + index for index in range(columns)]}}
    for index in range(columns):
        cells[f"g_column[{index}].u_column"] = cell("test_column", {"told": 5, "timestamp_i": 100 + index, "clk_i": 2}, {})
    column = {"attributes": {}, "netnames": {}, "cells": {"i": cell("INV_X1", {"A": 7}, {"Y": 8})}, "ports": {
        "told": {"direction": "input", "bits": [7]}, "timestamp_i": {"direction": "input", "bits": [9]},
        "clk_i": {"direction": "input", "bits": [10]}}}
    top = {"attributes": {"top": "1"}, "netnames": {}, "cells": cells, "ports": ports}
    return {"modules": {"array": top, "test_column": column}}


class WithLibrary(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.liberty = cls.folder / "slow.lib"
        cls.liberty.write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        cls.library = library.read(cls.liberty)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.temporary.cleanup()

    def pin_load(self, kind: str, pin: str) -> float:
        return self.library.input_ff[kind].get(pin, 0.0) if kind in self.library.input_ff else COLUMN_PIN_FF


class Trees(WithLibrary):
    def spread(self, columns: int) -> tuple[dict, Floorplan]:
        design = array(columns)
        plan = Floorplan(design, 1)
        floorplan.spread(plan, self.library, self.pin_load, {2})
        return netlist.top(design), plan

    def test_columns_stand_in_their_order_and_timestamps_above_them(self):
        plan = Floorplan(array(12), 1, pitch_um=10.0)
        self.assertEqual([plan[f"g_column[{index}].u_column"] for index in (0, 2, 10, 11)], [5.0, 25.0, 105.0, 115.0])
        self.assertEqual(plan.port_um(110, "g_column[10].u_column"), 105.0)
        self.assertEqual(plan.port_um(3, "near"), 60.0)
        self.assertEqual(plan["near"], 60.0)

    def test_a_segment_of_the_line_stands_where_its_words_come_from(self):
        design = array(12)
        top = netlist.top(design)
        for index, word in ((1, 300), (2, 301)):
            top["cells"][f"g_column[{index}].u_column"]["connections"]["word"] = [word]
            top["cells"][f"g_column[{index}].u_column"]["port_directions"]["word"] = "output"
        top["cells"] |= {"or": cell("OR2_X1", {"A": 300, "B": 301}, {"Y": 302}), "segment": cell("DFF_X1", {"D": 302, "CK": 2}, {"Q": 303}),
                         "line": cell("BUF_X1", {"A": 303}, {"Y": 304}), "other": cell("DFF_X1", {"D": 302, "CK": 2}, {"Q": 305})}
        top["netnames"] = {"g_engine[0].u_line.words_q[7]": {"bits": [303]}, "u_line_of_another.words_q[7]": {"bits": [305]}}
        plan = Floorplan(design, 1, pitch_um=10.0)
        self.assertEqual([plan[name] for name in ("or", "segment", "line", "other")], [20.0, 20.0, 20.0, 60.0])

    def test_every_column_hears_the_register_and_no_driver_is_overloaded_or_far_away(self):
        seed = int(os.environ.get("DTOF_TEST_SEED", random.randrange(2**31)))
        for columns in (1, 2, 200, *random.Random(seed).sample(range(3, 400), 4)):
            with self.subTest(columns=columns, seed=seed):
                top, plan = self.spread(columns)
                driver = {bits[0]: name for name, item in top["cells"].items() for pin, bits in item["connections"].items()
                          if item["port_directions"][pin] == "output"}

                def registers(bit: int) -> int:
                    """How many registers are between the port and a net, through buffers."""
                    if bit not in driver:
                        self.assertEqual(bit, 3)
                        return 0
                    item = top["cells"][driver[bit]]
                    if item["type"].startswith("DFF"):
                        return 1 + registers(item["connections"]["D"][0])
                    return registers(next(bits[0] for pin, bits in item["connections"].items()
                                          if item["port_directions"][pin] == "input"))

                load: dict[int, float] = {}
                for name, item in top["cells"].items():
                    if item["type"] == "test_column":
                        self.assertEqual(registers(item["connections"]["told"][0]), 2)
                    for pin, bits in item["connections"].items():
                        if item["port_directions"][pin] == "input" and bits[0] in driver:
                            load[bits[0]] = load.get(bits[0], 0.0) + self.pin_load(item["type"], pin)
                            self.assertLessEqual(abs(plan[name] - plan[driver[bits[0]]]), floorplan.REPEATER_UM + 1e-6, name)
                for net, name in driver.items():
                    item = top["cells"][name]
                    limit = next(iter(self.library.max_load_ff[item["type"]].values()))
                    self.assertLessEqual(load.get(net, 0.0), limit, name)

    def test_a_register_far_from_its_columns_is_copied(self):
        top, _ = self.spread(200)
        self.assertGreater(sum(netlist.COPY_SUFFIX in name and name.startswith("far") for name in top["cells"]), 5)
        self.assertFalse(any(name.startswith(f"near{netlist.COPY_SUFFIX}") for name in top["cells"]))


class Borders(WithLibrary):
    def test_registers_and_constants_pass(self):
        design = array(3)
        floorplan.check_borders(design, self.library)
        netlist.top(design)["cells"]["g_column[1].u_column"]["connections"]["told"] = ["0"]
        floorplan.check_borders(design, self.library)

    def test_a_gate_or_a_port_in_front_of_a_column_stops_the_flow(self):
        design = array(3)
        top = netlist.top(design)
        top["cells"]["gate"] = cell("NAND2_X1", {"A1": 4, "A2": 5}, {"Y": 3000})
        top["cells"]["buffer"] = cell("BUF_X1", {"A": 3000}, {"Y": 3001})
        top["cells"]["g_column[2].u_column"]["connections"]["told"] = [3001]
        with self.assertRaisesRegex(FlowError, r"g_column\[2\]\.u_column\.told\[0\] does not come from a register but from NAND2_X1"):
            floorplan.check_borders(design, self.library)
        top["cells"]["g_column[2].u_column"]["connections"]["told"] = [3]
        with self.assertRaisesRegex(FlowError, "from a port of the array"):
            floorplan.check_borders(design, self.library)

    def test_a_timestamp_that_passes_a_gate_on_its_way_stops_the_flow(self):
        design = array(3)
        top = netlist.top(design)
        top["cells"]["gate"] = cell("INV_X1", {"A": 4}, {"Y": 3000})
        top["cells"]["late"] = cell("NAND2_X1", {"A1": 102, "A2": 3000}, {"Y": 3001})
        top["cells"]["g_column[2].u_column"]["connections"]["timestamp_i"] = [3001]
        with self.assertRaisesRegex(FlowError, r"timestamp_i\[0\] does not come from a register but from NAND2_X1"):
            floorplan.check_borders(design, self.library)

    def test_a_port_is_registered_if_its_bits_come_from_registers_and_constants(self):
        module = {"ports": {"word_o": {"direction": "output", "bits": [3, 5]}, "gated_o": {"direction": "output", "bits": [3, 6]}},
                  "cells": {"r": cell("DFF_X1", {"D": 2}, {"Q": 3}), "zero": cell("TIE0_X1", {}, {"Y": 4}),
                            "b": cell("BUF_X1", {"A": 4}, {"Y": 5}), "g": cell("NAND2_X1", {"A1": 3, "A2": 2}, {"Y": 6})}}
        self.assertEqual(floorplan._registered_ports(module, {"DFF_X1", "TIE0_X1"}, {"BUF_X1"}), {"word_o"})


class Wires(WithLibrary):
    def test_a_wire_has_the_resistance_and_capacitance_of_its_length(self):
        design = array(4)
        plan = Floorplan(design, 1, pitch_um=100.0)
        spef.plain_names(design)
        plan.places = {re.sub(r"\W", "_", name): place for name, place in plan.places.items()}
        text, = spef.write(design, plan, self.library, [Wire(2.0, 0.5)], {2})
        net = next(part for part in text.split("*D_NET ") if "far:Q" in part)
        ohm = [float(line.split()[3]) for line in net.split("*RES\n")[1].split("*END")[0].splitlines()]
        ff = sum(float(line.split()[2]) for line in net.split("*CAP\n")[1].split("*RES")[0].splitlines())
        self.assertAlmostEqual(sum(ohm), 300.0 * 2.0, places=2)  # from the first column to the last
        self.assertAlmostEqual(ff, 300.0 * 0.5 + 4 * self.library.wire_ff_per_sink, places=2)
        self.assertNotIn(f"*D_NET {floorplan.TIMESTAMP_PORT}", text)  # the timestamps' ports stand above their columns

    def test_opensta_finds_the_delay_of_a_long_wire(self):
        """A register, 1 mm of wire, a register: behind a strong driver the wire adds between half of its Elmore delay and
        all of it (the 50 % point of a distributed line is at 0.38 R C)."""
        wire, length = Wire(3.0, 0.3), 1000.0
        (self.folder / "t.v").write_text(
            "module t (clk_i, a); input clk_i, a; wire n, m, q;\n  DFF_X1 r (.D(a), .CK(clk_i), .Q(n));\n"
            "  BUF_X16 b (.A(n), .Y(m));\n  DFF_X1 s (.D(m), .CK(clk_i), .Q(q));\nendmodule\n", encoding="utf-8")
        (self.folder / "t.sdc").write_text("create_clock -name clk -period $period [get_ports clk_i]\n", encoding="utf-8")
        (self.folder / "none.sdc").write_text("", encoding="utf-8")
        pins = [spef._Pin("b/Y", True, 0.0, 0.0), spef._Pin("s/D", False, length, 0.0)]

        def arrival(of: Wire) -> float:
            (self.folder / "t.spef").write_text(
                spef._HEADER.format(design="t") + "\n".join(spef._wire("m", pins, of)), encoding="utf-8")
            tools.write_settings(self.folder / "t.tcl", {
                "liberty_files": [self.liberty], "netlist": self.folder / "t.v", "wires": self.folder / "t.spef", "top": "t",
                "wire_load": "", "constraints": self.folder / "t.sdc", "margins": self.folder / "none.sdc", "target_period": "9",
                "steps": ["margins"]})
            output = tools.run_sta(ROOT / "synth/sta/timing.tcl", self.folder / "t.tcl", self.folder / "log", "t")
            rows = re.findall(r"([\d.]+) +[\d.]+ [v^] s/D", output.split("DTOF_MARGIN_PATH_MAX")[1])
            return float(rows[0])  # of the wire alone

        elmore_ns = wire.ohm_per_um * length * (wire.ff_per_um * length / 2 + self.library.input_ff["DFF_X1"]["D"]) * 1e-6
        self.assertGreater(arrival(wire), 0.5 * elmore_ns)
        self.assertLess(arrival(wire), 1.1 * elmore_ns)
        self.assertLess(arrival(Wire(0.001, 0.3)), 0.05 * elmore_ns)


if __name__ == "__main__":
    unittest.main()
