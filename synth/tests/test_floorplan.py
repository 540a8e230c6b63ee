# SPDX-License-Identifier: Apache-2.0
"""The floorplan's places, trees and repeaters, the check of the borders, and the wires that OpenSTA is told of."""

import os
import random
import re
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import floorplan, library, netlist, spef, standard_cells, tools
from dtof_synth.errors import FlowError
from dtof_synth.floorplan import Floorplan, Wire
from dtof_synth.library import Buffer, Library

from .partial import part_of

ROOT = Path(__file__).resolve().parents[2]
COLUMN_PIN_FF = 3.0


def cell(kind: str, inputs: dict[str, int], outputs: dict[str, int]) -> dict:
    return {"type": kind, "parameters": {}, "attributes": {},
            "port_directions": {**dict.fromkeys(inputs, "input"), **dict.fromkeys(outputs, "output")},
            "connections": {pin: [bit] for pin, bit in {**inputs, **outputs}.items()}}


def array(columns: int, stages: int = 2) -> dict:
    """Registers in a row tell `columns` columns something; each has a timestamp of its own at a port."""
    cells = {"near": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 4})}
    nets = [4, *(2000 + number for number in range(2, stages)), 5]
    cells |= {f"middle{number}": cell("DFF_X1", {"D": nets[number - 2], "CK": 2}, {"Q": nets[number - 1]}) for number in range(2, stages)}
    cells["far"] = cell("DFF_X1", {"D": nets[-2], "CK": 2}, {"Q": 5})
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
    temporary: tempfile.TemporaryDirectory[str]
    folder: Path
    liberty: Path
    library: Library

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

    def test_columns_stand_in_their_order_and_timestamps_above_them(self) -> None:
        plan = Floorplan(array(12), 1, pitch_um=10.0)
        self.assertEqual([plan[f"g_column[{index}].u_column"] for index in (0, 2, 10, 11)], [5.0, 25.0, 105.0, 115.0])
        self.assertEqual(plan.port_um(110, "g_column[10].u_column"), 105.0)
        self.assertEqual(plan.port_um(3, "near"), 60.0)
        self.assertEqual(plan["near"], 60.0)

    def test_a_segment_of_the_line_stands_where_its_words_come_from(self) -> None:
        design = array(12)
        top = netlist.top(design)
        for index, word in ((1, 300), (2, 301)):
            top["cells"][f"g_column[{index}].u_column"]["connections"]["word"] = [word]
            top["cells"][f"g_column[{index}].u_column"]["port_directions"]["word"] = "output"
        top["cells"] |= {"or": cell("OR2_X1", {"A": 300, "B": 301}, {"Y": 302}), "segment": cell("DFF_X1", {"D": 302, "CK": 2}, {"Q": 303}),
                         "line": cell("BUF_X1", {"A": 303}, {"Y": 304}), "other": cell("DFF_X1", {"D": 302, "CK": 2}, {"Q": 305})}
        gate = f"{netlist.CLOCK_GATE_PREFIX}0"
        top["cells"] |= {gate: cell("CLKGATE_X1", {"CK": 2, "E": 4}, {"GCK": 306})}
        top["cells"]["segment"]["connections"]["CK"] = [306]
        top["netnames"] = {"g_engine[0].u_line.words_q[7]": {"bits": [303]}, "u_line_of_another.words_q[7]": {"bits": [305]}}
        plan = Floorplan(design, 1, pitch_um=10.0)
        self.assertEqual([plan[name] for name in ("or", "segment", "line", "other", gate)], [20.0, 20.0, 20.0, 60.0, 20.0])

    def test_every_column_hears_the_register_and_no_driver_is_overloaded_or_far_away(self) -> None:
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

    def test_a_register_far_from_its_columns_is_copied(self) -> None:
        top, _ = self.spread(200)
        self.assertGreater(sum(netlist.COPY_SUFFIX in name and name.startswith("far") for name in top["cells"]), 5)
        self.assertFalse(any(name.startswith(f"near{netlist.COPY_SUFFIX}") for name in top["cells"]))


class Spread(unittest.TestCase):
    """Trees by hand: sinks of 3 fF with 0.5 fF of wire each, 0.1 fF of wire per um, a largest buffer of 200 fF that is filled to 100 fF."""

    LIBRARY = part_of(Library, buffers=[Buffer("BUF_X1", "A", "Y", 1.0, 1.0, 50.0), Buffer("BUF_X4", "A", "Y", 2.0, 1.5, 200.0)],
                      wire_ff_per_sink=0.5)

    def spread(self, places: dict[str, float], maximum_ff: float, copy: bool = False, heavy: str = "", driver: str | None = "r",
               timestamps: bool = False, wire_ff: float = 0.1) -> dict[str, tuple[float, set[str]]]:
        """What the register `r` at 0 um, and each buffer or copy, drives: (place, names). `heavy`: a sink of 5 fF."""
        cells = {"r": cell("DFF", {"D": 1}, {"Q": 2}), **{name: cell("LOAD", {"A": 2}, {}) for name in places}}
        plan = Floorplan.__new__(Floorplan)
        plan.places, plan.centre_um, plan.module_um = {"r": 0.0, **places}, 0.0, 50.0
        plan.timestamps = {2} if timestamps else set()
        cells |= {heavy: cell("HEAVY", {"A": 2}, {})} if heavy else {}
        module = {"ports": {}, "cells": cells}
        builder = netlist.TreeBuilder(module, self.LIBRARY, lambda kind, pin: 5.0 if kind == "HEAVY" else 3.0)
        floorplan._Spreader(plan, builder, self.LIBRARY, Wire(1.0, wire_ff)).spread(2, driver, maximum_ff, copy)
        behind: dict[int, set[str]] = {}
        for name, item in cells.items():
            for pin, bits in item["connections"].items():
                if item["port_directions"][pin] == "input":
                    behind.setdefault(bits[0], set()).add(name)
        outputs = {name: bits[0] for name, item in cells.items() for pin, bits in item["connections"].items()
                   if item["port_directions"][pin] == "output"}
        self.called = {name: plan[name] for name in outputs}
        return {name: (plan[name], behind[net]) for name, net in outputs.items() if net in behind}

    def named(self, found: dict[str, tuple[float, set[str]]]) -> set[tuple[float, frozenset]]:
        """(place, what it drives) of each driver; drivers that are driven stand for themselves by their place."""
        return {(place, frozenset(self.called.get(name, name) for name in names)) for place, names in found.values()}

    def test_a_net_stays_as_it_is_up_to_its_limits(self) -> None:
        # Two sinks are 7 fF, 100 um of wire between register and sinks 10 fF: the driver may have twice that.
        near = {"a": 0.0, "b": 100.0}
        self.assertEqual(self.spread(near, 34.0), {"r": (0.0, {"a", "b"})})
        self.assertNotEqual(self.spread(near, 33.8), {"r": (0.0, {"a", "b"})})
        cases: list[tuple[float, set[str | float]]] = [(400.0, {"a"}), (401.0, {400.0})]
        for place, driven in cases:
            found = self.named(self.spread({"a": place}, 1000.0))
            self.assertIn((0.0, frozenset(driven)), found)
            self.assertEqual(len(found), 1 if place == 400.0 else 2)

    def test_a_wire_to_both_sides_has_repeaters_every_400_um(self) -> None:
        found = self.named(self.spread({"left": -900.0, "right": 500.0, "here": 0.0}, 1000.0))
        self.assertEqual(found, {(0.0, frozenset({-400.0, 400.0, "here"})), (-400.0, frozenset({-800.0})), (-800.0, frozenset({"left"})),
                                 (400.0, frozenset({"right"}))})

    def test_neighbours_share_a_buffer_in_their_middle(self) -> None:
        # 1,000 and 1,200 um lie within 200 um, 1,201 does not; alone, a sink of 3.5 fF needs no buffer and one of 5.5 fF does.
        places = {"a": 1000.0, "b": 1200.0, "c": 1201.0}
        for heavy, last in (("", "c"), ("c", 1201.0)):
            found = self.named(self.spread(places, 1000.0, heavy=heavy))
            self.assertIn((1100.0, frozenset({"a", "b"})), found)
            self.assertIn((1200.0, frozenset({last})), found)
            self.assertIn((800.0, frozenset({1100.0, 1200.0})), found)
            self.assertEqual((1201.0, frozenset({"c"})) in found, bool(heavy))

    def test_light_neighbours_of_the_register_stay_with_it_and_many_do_not(self) -> None:
        # Within a column's width of 50 um: 3 sinks are 10.5 fF. Half of the driver's 21 fF is 10.5 fF, half of 20.8 fF is less.
        near = {f"near{index}": 50.0 for index in range(3)}
        cases: list[tuple[float, set[str | float]]] = [(42.0, {*near, 400.0}), (41.6, {50.0, 400.0})]
        for maximum_ff, driven in cases:
            self.assertIn((0.0, frozenset(driven)), self.named(self.spread({**near, "far": 450.0}, maximum_ff, wire_ff=0.0)))
        found = self.named(self.spread({**near, "far": 450.0}, 400.0))
        self.assertIn((0.0, frozenset({*near, 400.0})), found)
        found = self.named(self.spread({**near, "near3": 51.0, "far": 450.0}, 400.0))
        self.assertIn((0.0, frozenset({*near, "near3", 400.0})), found)  # 51 um: alone and light, on the wire's first hop
        with mock.patch.object(netlist, "MAX_FANOUT", 5):
            found = self.named(self.spread({**near, "far": 450.0}, 400.0))
            self.assertIn((0.0, frozenset({50.0, 400.0})), found)  # three are more than half of five

    def test_a_register_is_copied_for_the_buffers_within_400_um(self) -> None:
        found = self.named(self.spread({"a": 1000.0, "b": 1100.0, "c": 1350.0, "d": 1850.0}, 400.0, copy=True))
        # Buffer of a and b at 1,050; with c within 400 um: a copy at 1,200. d: a copy of its own.
        self.assertEqual(found, {(1050.0, frozenset({"a", "b"})), (1200.0, frozenset({1050.0, "c"})), (1850.0, frozenset({"d"}))})

    def test_a_weak_driver_has_as_few_buffers_beside_it_as_carry_the_load(self) -> None:
        # Sinks within a column's width: 200 um of wire leave a buffer 80 fF, 22 sinks. One sink that is left needs no buffer.
        self.assertEqual(self.named(self.spread({"a": 0.0, "b": 0.0, "c": 0.0}, 21.0)), {(0.0, frozenset("abc"))})
        for number, maximum_ff, sizes in ((3, 20.8, [1, 3]), (22, 20.0, [1, 22]), (23, 20.0, [2, 22]), (24, 20.0, [2, 2, 22])):
            found = self.spread({f"s{index}": 0.0 for index in range(number)}, maximum_ff)
            self.assertEqual(sorted(len(names) for _, names in found.values()), sizes)

    def test_buffers_beside_a_driver_leave_room_for_a_wire_to_the_next_repeater(self) -> None:
        # 400 um of wire leave a buffer 60 fF, 17 sinks of 3.5 fF; it is a pin of 2 fF. Three of them are 6 fF.
        for number, limit, begun in ((17, 10.0, [17]), (18, 10.0, [1, 17]), (34, 4.0, [17, 17]), (51, 6.0, [17] * 3), (51, 5.9, [3])):
            builder = netlist.TreeBuilder({"ports": {}, "cells": {
                "r": cell("DFF", {"D": 1}, {"Q": 2}), **{f"s{index}": cell("LOAD", {"A": 2}, {}) for index in range(number)}}},
                self.LIBRARY, lambda kind, pin: 3.0)
            plan = Floorplan.__new__(Floorplan)
            plan.places, plan.centre_um = {}, 0.0
            spreader = floorplan._Spreader(plan, builder, self.LIBRARY, Wire(1.0, 0.1))
            with mock.patch.object(spreader, "_buffer", side_effect=spreader._buffer) as buffer:
                left = spreader._relieve(2, 0.0, builder.nets[2], limit)
            self.assertEqual(sorted(len(call.args[1]) for call in buffer.call_args_list[-len(left):]), begun)

    def test_a_port_of_a_timestamp_stands_above_its_first_sink(self) -> None:
        places = {"a": 1000.0, "b": 700.0, "c": 1300.0}
        self.assertEqual(self.spread(places, 1000.0, driver=None, timestamps=True), {"r": (0.0, {"a", "b", "c"})})
        self.assertNotEqual(self.spread(places, 1000.0, driver=None), {"r": (0.0, {"a", "b", "c"})})  # from the middle, at 0 um

    def test_pins_of_cells_and_of_macros(self) -> None:
        load = floorplan.pin_load(part_of(Library, input_ff={"INV": {"A": 1.2}}), 7.0)
        self.assertEqual([load("INV", "A"), load("INV", "Y"), load("sram_1rw_2x3", "en_i")], [1.2, 0.0, 7.0])


class Borders(WithLibrary):
    def test_registers_and_constants_pass(self) -> None:
        design = array(3)
        floorplan.check_borders(design, self.library)
        netlist.top(design)["cells"]["g_column[1].u_column"]["connections"]["told"] = ["0"]
        floorplan.check_borders(design, self.library)

    def test_a_gate_or_a_port_in_front_of_a_column_stops_the_flow(self) -> None:
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

    def test_a_timestamp_that_passes_a_gate_on_its_way_stops_the_flow(self) -> None:
        design = array(3)
        top = netlist.top(design)
        top["cells"]["gate"] = cell("INV_X1", {"A": 4}, {"Y": 3000})
        top["cells"]["late"] = cell("NAND2_X1", {"A1": 102, "A2": 3000}, {"Y": 3001})
        top["cells"]["g_column[2].u_column"]["connections"]["timestamp_i"] = [3001]
        with self.assertRaisesRegex(FlowError, r"timestamp_i\[0\] does not come from a register but from NAND2_X1"):
            floorplan.check_borders(design, self.library)

    def test_a_port_is_registered_if_its_bits_come_from_registers_and_constants(self) -> None:
        module = {"ports": {"word_o": {"direction": "output", "bits": [3, 5]}, "gated_o": {"direction": "output", "bits": [3, 6]}},
                  "cells": {"r": cell("DFF_X1", {"D": 2}, {"Q": 3}), "zero": cell("TIE0_X1", {}, {"Y": 4}),
                            "b": cell("BUF_X1", {"A": 4}, {"Y": 5}), "g": cell("NAND2_X1", {"A1": 3, "A2": 2}, {"Y": 6})}}
        self.assertEqual(floorplan._registered_ports(module, {"DFF_X1", "TIE0_X1"}, {"BUF_X1"}), {"word_o"})


class Spef(WithLibrary):
    """SPEF of small nets, by hand: 2 ohm and 0.5 fF per um."""

    def write(self, places: dict[str, float], port: bool = False) -> str:
        cells = {"r": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 4}), **{name: cell("INV_X1", {"A": 3 if port else 4}, {"Y": 20 + index})
                                                                      for index, name in enumerate(places)}}
        cells["c.u_column"] = cell("a_column", {"clk_i": 2}, {})
        ports = {"clk_i": {"direction": "input", "bits": [2]}, "told_i": {"direction": "input", "bits": [3]},
                 "q_o": {"direction": "output", "bits": [4]}}
        inner = {"attributes": {}, "netnames": {}, "ports": {"clk_i": {"direction": "input", "bits": [2]}},
                 "cells": {"i": cell("INV_X1", {"A": 2}, {"Y": 3})}}
        top = {"attributes": {"top": "1"}, "netnames": {"old": {"bits": [9]}}, "cells": cells, "ports": ports}
        design = {"modules": {"a_column": inner, "the_array": top}}
        plan = Floorplan(design, 1)
        plan.places, plan.centre_um = {"r": 0.0, **places}, 0.0
        return spef.write(design, plan, self.library, [Wire(2.0, 0.5)], {2})[0]

    def test_a_net_and_its_port(self) -> None:
        text = self.write({"a": 10.0, "b": 30.0}, port=True)
        self.assertIn('*DESIGN "the_array"', text)
        wire = self.library.wire_ff_per_sink  # at each input of a cell
        body = text.split("*D_NET ")[1].splitlines()
        self.assertEqual(body[:7], [f"told_i {15 + 3 * wire:.4f}", "*CONN", "*I r:D I", "*P told_i I", "*I a:A I", "*I b:A I", "*CAP"])
        # Half of each piece of wire at either end: 0, 10 and 20 um.
        self.assertEqual(body[7:11], [f"1 r:D {wire:.4f}", "2 told_i 2.5000", f"3 a:A {7.5 + wire:.4f}", f"4 b:A {5 + wire:.4f}"])
        self.assertEqual(body[11:], ["*RES", "1 r:D told_i 0.0100", "2 told_i a:A 20.0000", "3 a:A b:A 40.0000", "*END"])

    def test_the_driver_and_an_output_port(self) -> None:
        body = self.write({"a": 30.0}).split("*D_NET ")[1].splitlines()
        self.assertEqual((body[0].split()[0], body[2:5]), ("q_o", ["*P q_o O", "*I r:Q O", "*I a:A I"]))

    def test_short_nets_are_left_to_the_wire_load(self) -> None:
        for place, described in ((19.0, 0), (20.0, 1), (21.0, 1)):
            self.assertEqual(self.write({"a": place}).count("*D_NET"), described, place)

    def test_names_that_become_alike_are_told_apart(self) -> None:
        design: dict = {"modules": {"m": {"cells": {"a[1]": {}, "a_1_": {}, "a.1.": {}}}}}
        self.assertEqual(spef.plain_names(design), {"m": {"a_1_": "a[1]", "a_1__": "a_1_", "a_1___": "a.1."}})
        self.assertEqual(list(design["modules"]["m"]["cells"]), ["a_1_", "a_1__", "a_1___"])

    def test_constants_are_no_nets(self) -> None:
        design = array(2)
        netlist.top(design)["cells"]["far"]["connections"]["D"] = ["0"]
        pins = spef.Nets(design, Floorplan(design, 1), self.library).pins()
        self.assertTrue(all(isinstance(bit, int) for bit in pins))


class Wires(WithLibrary):
    def test_a_wire_has_the_resistance_and_capacitance_of_its_length(self) -> None:
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

    def test_opensta_finds_the_delay_of_a_long_wire(self) -> None:
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
