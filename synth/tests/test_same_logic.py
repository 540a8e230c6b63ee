# SPDX-License-Identifier: Apache-2.0
"""Buffers, copies and drives leave the logic as it was mapped; anything else is found."""

import copy
import tempfile
import unittest
from pathlib import Path

from dtof_synth import library, netlist, same_logic, spef, standard_cells
from dtof_synth.errors import FlowError
from dtof_synth.library import Library

from .small_netlists import cell, module

PAIRS = 5


def mapped() -> dict:
    """Pairs that a register of the top drives, and in each a gate between two registers."""
    pair = module({"clk_i": ("input", 2), "a": ("input", 3), "q": ("output", 6)}, {
        "first": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 4}), "buffer": cell("BUF_X1", {"A": 4}, {"Y": 8}),
        "gate": cell("NAND2_X1", {"A1": 8, "A2": 3}, {"Y": 5}),
        "g_array[0].last": cell("DFF_X1", {"D": 5, "CK": 2}, {"Q": 6}), "tied": cell("NAND2_X1", {"A1": 4, "A2": "1"}, {"Y": 7})})
    array = module({"clk_i": ("input", 2), "d": ("input", 3), "q": ("output", 10)}, {
        "told": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 4}),
        **{f"g_quad[{index}].u_quad": cell("a_quad", {"clk_i": 2, "a": 4}, {"q": 10 + index}) for index in range(PAIRS)}}, top=True)
    return {"modules": {"a_quad": pair, "t": array}}


class SameLogic(unittest.TestCase):
    library: Library

    @classmethod
    def setUpClass(cls) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "slow.lib"
            path.write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
            cls.library = library.read(path)

    def load(self, kind: str, pin: str) -> float:
        return self.library.input_ff[kind].get(pin, 0.0) if kind in self.library.input_ff else 5.0

    def finished(self) -> tuple[dict, dict[str, dict[str, str]]]:
        """What the flow makes of it, step by step."""
        design = mapped()
        array = netlist.top(design)
        builder = netlist.TreeBuilder(array, self.library, self.load)
        leaf = builder.buffer(4, builder.nets[4][:3])
        builder.copy_register(4, [leaf])
        netlist.insert_fanout_trees(array, self.library, self.load, {2})
        called = spef.plain_names(design)
        netlist.resize(design, self.library, [("a_quad", "gate", "NAND2_X4"), (netlist.TOP, "told", "DFF_X2")])
        netlist.drop_buffers(design, self.library, [("a_quad", "buffer")])
        netlist.delay_pins(design, {("a_quad", "g_array_0__last", "D"): 2, ("", "g_quad_0__u_quad", "a"): 1}, self.library)
        return design, called

    def refusal(self, change) -> str:
        design, called = self.finished()
        change(design["modules"]["a_quad"]["cells"], netlist.top(design)["cells"])
        before = same_logic.of(mapped(), self.library)
        try:
            same_logic.check(before, same_logic.of(design, self.library, called))
        except FlowError as error:
            return str(error)
        return ""

    def test_what_the_steps_do_is_no_difference(self) -> None:
        design, called = self.finished()
        kinds = {gate["type"] for kind in design["modules"].values() for gate in kind["cells"].values()}
        self.assertTrue({"BUF_X1", "NAND2_X4", "DFF_X2"} <= kinds, kinds)
        self.assertTrue(any(netlist.COPY_SUFFIX in name for name in netlist.top(design)["cells"]))
        same_logic.check(same_logic.of(mapped(), self.library), same_logic.of(design, self.library, called))

    def test_another_function_is_found(self) -> None:
        self.assertIn("a_quad: gate is no longer what was mapped", self.refusal(lambda pair, top: pair["gate"].update(type="NOR2_X4")))

    def test_a_crossed_wire_is_found(self) -> None:
        def cross(pair, top):
            pair["gate"]["connections"]["A1"] = [3]
        self.assertIn("a_quad: gate is no longer", self.refusal(cross))

    def test_a_hold_buffer_of_another_net_is_found(self) -> None:
        def other(pair, top):
            first = min(name for name in pair if name.startswith(netlist.HOLD_PREFIX))
            pair[first]["connections"]["A"] = [4]
        self.assertIn("a_quad: g_array[0].last is no longer", self.refusal(other))

    def test_what_a_lost_buffer_drove_is_found(self) -> None:
        def leave(pair, top):
            pair["gate"]["connections"]["A1"] = [8]
        self.assertIn("a_quad: gate is no longer", self.refusal(leave))

    def test_an_inverter_in_place_of_a_buffer_is_found(self) -> None:
        def invert(pair, top):
            name = next(name for name in pair if name.startswith(netlist.HOLD_PREFIX))
            pair[name]["type"] = "INV_X1"
        self.assertRegex(self.refusal(invert), "a_quad: (hold_|g_array)")

    def test_a_copy_that_hears_something_else_is_found(self) -> None:
        def deafen(pair, top):
            name = next(name for name in top if netlist.COPY_SUFFIX in name)
            top[name] = copy.deepcopy(top[name])
            top[name]["connections"]["D"] = [2]
        self.assertIn("told and its copy", self.refusal(deafen))

    def test_a_lost_cell_and_a_new_one_are_found(self) -> None:
        self.assertEqual(self.refusal(lambda pair, top: pair.pop("tied")), "a_quad: tied is gone")
        self.assertEqual(self.refusal(lambda pair, top: pair.update(extra=cell("INV_X1", {"A": 4}, {"Y": 90}))), "a_quad: extra is new")

    def test_a_module_that_only_one_of_them_has_is_found(self) -> None:
        nothing: same_logic.Logic = {}
        one: same_logic.Logic = {"a": {"x": (1,)}}
        for before, after, said in ((one, nothing, "a: x is gone"), (nothing, one, "a: x is new")):
            with self.assertRaisesRegex(FlowError, said):
                same_logic.check(before, after)

    def test_another_constant_and_another_output_are_found(self) -> None:
        def tie(pair, top):
            pair["tied"]["connections"]["A2"] = ["0"]
        self.assertIn("a_quad: tied is no longer", self.refusal(tie))
        design, called = self.finished()
        design["modules"]["a_quad"]["ports"]["q"]["bits"] = [5]
        with self.assertRaisesRegex(FlowError, "a_quad: output q is no longer"):
            same_logic.check(same_logic.of(mapped(), self.library), same_logic.of(design, self.library, called))


if __name__ == "__main__":
    unittest.main()
