# SPDX-License-Identifier: Apache-2.0
"""Fan-out trees keep the function and relieve every driver."""

import random
import os
import unittest
from dataclasses import replace
from pathlib import Path

from dtof_synth import netlist
from dtof_synth.library import Buffer, Library

from .partial import part_of
from .small_netlists import cell


def library() -> Library:
    buffers = [Buffer("BUF_X1", "A", "Y", 1.0, 1.0, 20.0), Buffer("BUF_X4", "A", "Y", 3.0, 2.0, 80.0)]
    return Library(Path("x"), "x", {"BUF_X1": 1.0, "BUF_X4": 3.0, "DFF": 5.0, "INV": 0.5}, {"DFF"}, set(),
                   {"BUF_X1": {"A": 1.0}, "BUF_X4": {"A": 2.0}, "DFF": {"D": 1.0, "CK": 1.0}, "DFF_X2": {"D": 1.0, "CK": 1.0},
                    "INV": {"A": 1.0}},
                   {"BUF_X1": {"Y": 20.0}, "BUF_X4": {"Y": 80.0}, "DFF": {"Q": 20.0}, "INV": {"Y": 20.0}},
                   buffers, "INV", {}, 0.7, 1.5, 1.1, "", 0.5, {"DFF": 1.0}, {"DFF": 2.0})


def fan(sinks: int) -> dict:
    """A register that drives `sinks` inverters."""
    cells = {"q": cell("DFF", {"D": 3, "CK": 2}, {"Q": 4})}
    cells |= {f"sink{index}": cell("INV", {"A": 4}, {"Y": 5 + index}) for index in range(sinks)}
    return {"attributes": {"top": "1"}, "cells": cells,
            "ports": {"clk_i": {"direction": "input", "bits": [2]}, "d": {"direction": "input", "bits": [3]}}}


def pin_load(kind: str, pin: str) -> float:
    return 3.0 if kind == "col" else library().input_ff[kind].get(pin, 0.0)


def source(module: dict, bit: int) -> str:
    """The register input net behind a net, through buffers and copies."""
    for item in module["cells"].values():
        for pin, bits in item["connections"].items():
            if item["port_directions"][pin] == "output" and bits == [bit]:
                if item["type"] == "DFF":
                    return f"D{item['connections']['D'][0]}"
                return source(module, item["connections"]["A"][0])
    return f"port{bit}"


def loads_of(module: dict) -> dict[int, float]:
    loads: dict[int, float] = {}
    for item in module["cells"].values():
        for pin, bits in item["connections"].items():
            if item["port_directions"][pin] == "input":
                loads[bits[0]] = loads.get(bits[0], 0) + pin_load(item["type"], pin) + 0.5
    return loads


class FanoutTrees(unittest.TestCase):
    def setUp(self) -> None:
        self.seed = int(os.environ.get("DTOF_TEST_SEED", random.randrange(2**31)))
        self.random = random.Random(self.seed)

    def test_every_sink_keeps_its_source_and_no_driver_is_overloaded(self) -> None:
        for _ in range(20):
            sinks = self.random.randint(1, 400)
            with self.subTest(sinks=sinks, seed=self.seed):
                module = fan(sinks)
                netlist.insert_fanout_trees(module, library(), pin_load, {2})
                loads = loads_of(module)
                for name, item in module["cells"].items():
                    if name.startswith("sink"):
                        self.assertEqual(source(module, item["connections"]["A"][0]), "D3")
                    for pin, bits in item["connections"].items():
                        if item["port_directions"][pin] == "output" and bits[0] in loads:
                            limit = library().max_load_ff[item["type"]][pin]
                            self.assertLessEqual(loads[bits[0]], limit, f"{name} of {sinks} sinks")

    def test_small_nets_and_clocks_are_left_alone(self) -> None:
        module = fan(2)
        netlist.insert_fanout_trees(module, library(), pin_load, {2})
        self.assertEqual(netlist.count(module, library()).buffers, 0)
        module = fan(200)
        netlist.insert_fanout_trees(module, library(), pin_load, {2, 4})
        self.assertEqual(netlist.count(module, library()).buffers, 0)

    def test_a_driver_that_may_be_stronger_needs_no_buffer(self) -> None:
        weak = library()
        for dearer, buffers in ((0.9, 0), (1.1, 1)):  # than the weak register, whose buffer is 1.0
            strong = replace(weak, drives=[["DFF", "DFF_X2"]], area=weak.area | {"DFF_X2": weak.area["DFF"] + dearer},
                             max_load_ff=weak.max_load_ff | {"DFF_X2": {"Q": 40.0}})
            module = fan(13)  # 13 x 1.5 fF, of 40 fF the half
            netlist.insert_fanout_trees(module, strong, pin_load, {2})
            self.assertEqual(module["cells"]["q"]["type"], "DFF" if buffers else "DFF_X2")
            self.assertEqual(netlist.count(module, strong).buffers, buffers)

    def test_a_pin_that_is_reached_too_early_gets_a_buffer(self) -> None:
        block = {"attributes": {}, "ports": {}, "cells": {"r": cell("DFF", {"D": 7, "CK": 2}, {"Q": 8})}}
        module = fan(3)
        module["cells"] |= {"a": cell("block", {}, {}), "b": cell("block", {}, {})}
        design = {"modules": {"top": module, "block": block}}
        pins = {netlist.local_pin(design, name): 1 for name in ("a/r/D", "b/r/D")}
        beside = netlist.delay_pins(design, {("", "sink1", "A"): 2, **pins}, library())
        self.assertEqual(list(beside.values()), ["sink1", "sink1"])
        first, last = (module["cells"][name]["connections"] for name in beside)
        self.assertEqual([first["A"], last["A"]], [[4], first["Y"]])
        self.assertEqual(module["cells"]["sink1"]["connections"]["A"], last["Y"])
        self.assertEqual(source(module, last["Y"][0]), "D3")
        self.assertNotEqual(module["cells"]["sink1"]["connections"]["A"], [4])
        self.assertEqual(module["cells"]["sink0"]["connections"]["A"], [4])
        self.assertEqual(netlist.count(block, library()).cells, 2)

    def test_pins_of_one_net_share_their_buffers(self) -> None:
        module = fan(3)
        netlist.delay_pins({"modules": {"top": module}}, {("", "sink0", "A"): 2, ("", "sink1", "A"): 1, ("", "sink2", "A"): 2}, library())
        nets = [module["cells"][f"sink{index}"]["connections"]["A"] for index in range(3)]
        self.assertEqual(nets[0], nets[2])
        buffers = {tuple(one["connections"]["Y"]): one["connections"]["A"] for name, one in module["cells"].items()
                   if name.startswith(netlist.HOLD_PREFIX)}
        self.assertEqual(len(buffers), 2)
        self.assertEqual(buffers[tuple(nets[0])], nets[1])
        self.assertEqual(buffers[tuple(nets[1])], [4])

    def test_a_net_has_no_more_inputs_than_the_limit_however_light_they_are(self) -> None:
        module = fan(2 * netlist.MAX_FANOUT + 1)
        netlist.insert_fanout_trees(module, replace(library(), wire_ff_per_sink=0.0), lambda *_: 1e-3, set())
        inputs: dict[int, int] = {}
        for item in module["cells"].values():
            for pin, bits in item["connections"].items():
                if item["port_directions"][pin] == "input":
                    inputs[bits[0]] = inputs.get(bits[0], 0) + 1
        self.assertEqual(max(inputs.values()), netlist.MAX_FANOUT)
        self.assertEqual({source(module, module["cells"][f"sink{index}"]["connections"]["A"][0])
                          for index in range(2 * netlist.MAX_FANOUT + 1)}, {"D3"})

    def test_two_hundred_inputs_are_the_most(self) -> None:
        for inputs, buffers in ((200, 0), (201, 2)):  # two nearly equal clusters
            module = fan(inputs)
            netlist.insert_fanout_trees(module, replace(library(), wire_ff_per_sink=0.0), lambda *_: 1e-3, set())
            self.assertEqual(netlist.count(module, library()).buffers, buffers)

    def test_the_builder_knows_what_the_driver_has_left(self) -> None:
        # 30 inverters of 1.5 fF are 45 fF. Half of 80 fF are 40 fF: two buffers with 15 each, of 2.5 fF; 5 fF are what is left.
        module = fan(30)
        builder = netlist.TreeBuilder(module, library(), pin_load)
        builder.relieve(4, 20.0)
        self.assertEqual([sink.load for sink in builder.nets[4]], [2.5, 2.5])
        self.assertEqual({sink.cell for sink in builder.nets[4]},
                         {name for name, item in module["cells"].items() if item["connections"].get("A") == [4]})

    def test_a_cell_with_two_outputs_becomes_as_strong_as_both_need(self) -> None:
        weak = library()
        most = weak.max_load_ff | {"DFF": {"Q": 20.0, "QN": 20.0}, "DFF_X2": {"Q": 40.0, "QN": 20.0}, "DFF_X4": {"Q": 40.0, "QN": 40.0}}
        strong = replace(weak, drives=[["DFF", "DFF_X2", "DFF_X4"]], area=weak.area | {"DFF_X2": 5.2, "DFF_X4": 5.4}, max_load_ff=most)
        for inverted, kind in ((6, "DFF_X2"), (7, "DFF_X4")):  # of 20 fF the half are 6 inverters of 1.5 fF
            module = fan(12)
            module["cells"]["q"] = cell("DFF", {"D": 3, "CK": 2}, {"Q": 4, "QN": 900})
            module["cells"] |= {f"n{index}": cell("INV", {"A": 900}, {"Y": 901 + index}) for index in range(inverted)}
            netlist.strengthen(module, strong, pin_load, {2})
            self.assertEqual(module["cells"]["q"]["type"], kind)

    def test_a_columns_share_of_its_module(self) -> None:
        counts = netlist.Counts(10, 4, 8.0, 2, 1.0, 6.0, 5.0, 3)
        self.assertEqual(counts.share(1), counts)
        self.assertEqual(counts.share(4), netlist.Counts(2, 1, 2.0, 0, 0.25, 1.5, 1.25, 1))
        self.assertEqual(netlist.Counts(0, 0, 0.0, 0, 0.0, 0.0, 0.0).clock_sinks, 0)

    def test_engines_count_as_often_as_they_are_there(self) -> None:
        engine = {"attributes": {}, "ports": {"clk_i": {"direction": "input", "bits": [2]}},
                  "cells": {"r": cell("DFF", {"D": 7, "CK": 2}, {"Q": 8}), "i": cell("INV", {"A": 8}, {"Y": 9})}}
        module = fan(3)
        one = netlist.count_shared({"modules": {"top": module}}, library())
        self.assertEqual(one, netlist.Counts(4, 1, 6.5, 0, 0.0, 1.0, 2.0, 1))
        module["cells"] |= {name: cell("an_engine", {"clk_i": 2}, {}) for name in ("a", "b")}
        design = {"modules": {"top": module, "an_engine": engine}}
        self.assertEqual(netlist.count_engines(design, library()), netlist.Counts(4, 2, 11.0, 0, 0.0, 2.0, 4.0, 2))
        self.assertEqual(netlist.count_shared(design, library()), netlist.Counts(8, 3, 17.5, 0, 0.0, 3.0, 6.0, 3))

    def test_derived_modules_get_plain_names_with_their_instances(self) -> None:
        column, engine = "$paramod$12\\a_column", "$paramod$34\\an_engine"
        module = fan(1)
        module["cells"] |= {"a": cell(column, {}, {}), "b": cell(column, {}, {}), "e": cell(engine, {}, {})}
        design = {"modules": {"top": module, column: {"attributes": {}, "cells": {}}, engine: {"attributes": {}, "cells": {}}}}
        netlist.rename_parts(design)
        self.assertEqual(list(design["modules"]), ["top", "a_column", "an_engine"])
        self.assertEqual([module["cells"][name]["type"] for name in ("a", "b", "e", "q")], ["a_column", "a_column", "an_engine", "DFF"])
        self.assertEqual((netlist.columns(design), netlist.engine_module(design)), (["a", "b"], "an_engine"))

    def test_cells_that_nobody_knows_are_foreign(self) -> None:
        module = fan(1)
        module["cells"] |= {"a": cell("own", {}, {}), "e": cell("empty", {}, {}), "m": cell("sram", {}, {}), "x": cell("LATCH", {}, {})}
        design = {"modules": {"top": module, "own": {"cells": {"i": cell("INV", {"A": 1}, {"Y": 2})}}, "empty": {"cells": {}}}}
        self.assertEqual(netlist.foreign_cells(design, library(), {"sram"}), {"empty", "LATCH"})

    def test_names_of_a_pin(self) -> None:
        block = {"attributes": {}, "ports": {"d": {"direction": "input", "bits": [6, 7]}},
                 "cells": {"r": cell("DFF", {"D": 7, "CK": 2}, {"Q": 8}), "s": cell("DFF", {"D": 8, "CK": 2}, {"Q": 9}),
                           "m": {**cell("macro", {"wdata_i": 8}, {}), "connections": {"wdata_i": [8, 6]}}}}
        module = fan(3)
        module["cells"] |= {"a": cell("block", {}, {}), "b": cell("block", {}, {})}
        design = {"modules": {"top": module, "block": block}}
        self.assertEqual(netlist.in_all_blocks(design, ("block", "m", "wdata_i[1]")), ["a/m/wdata_i[1]", "b/m/wdata_i[1]"])
        self.assertEqual(netlist.in_all_blocks(design, ("", "sink1", "A")), ["sink1/A"])
        self.assertEqual([netlist._bits_of(block, "m", pin) for pin in ("wdata_i", "wdata_i[1]")], [([8, 6], 0), ([8, 6], 1)])
        for pin, there in (("sink1/A", True), ("a/m/wdata_i[1]", True), ("b/r/D", True), ("b/r/SI", False), ("a/t/D", False), ("t/D", False)):
            self.assertEqual(netlist.has_pin(design, pin), there, pin)

    def test_registers_draw_their_first_state_in_the_order_of_the_modules(self) -> None:
        modules: dict[str, dict] = {f"m{number}": {"cells": {"r": {"type": "DFF"}}} for number in range(8)}
        kinds = part_of(Library, sequential={"DFF"})
        drawn = iter([False, True, True, False, True, False, False, True])
        netlist.prepare_simulation({"modules": modules}, kinds, "_netlist", "POWER_UP", lambda: next(drawn))
        self.assertEqual([module["cells"]["r"]["parameters"]["POWER_UP"] for module in modules.values()], list("01101001"))
        self.assertEqual(list(modules), [f"m{number}_netlist" for number in range(8)])


if __name__ == "__main__":
    unittest.main()
