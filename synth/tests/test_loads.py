# SPDX-License-Identifier: Apache-2.0
"""Loads of every driver by hand, and what is beyond its limit."""

import unittest
from unittest import mock

from dtof_synth import loads, netlist, spef, standard_cells
from dtof_synth.errors import FlowError
from dtof_synth.floorplan import Floorplan

from .small_netlists import cell
from .test_floorplan import WithLibrary, array


class Loads(WithLibrary):
    def design(self, columns: int) -> tuple[dict, Floorplan]:
        design = array(columns)
        inside = netlist.modules(design)["test_column"]["cells"]
        inside["j"] = cell("INV_X4", {"A": 8}, {"Y": 20})
        inside["k"] = cell("INV_X1", {"A": 8}, {"Y": 21})
        plan = Floorplan(design, 1, pitch_um=100.0)
        plan.rename(spef.plain_names(design)["array"])
        return design, plan

    def check(self, design: dict, plan: Floorplan) -> loads.Load:
        return loads.check("some", design, plan, self.library, self.pin_load)

    def test_a_net_inside_has_its_pins_and_their_wires(self) -> None:
        design, _ = self.design(2)
        found = {load.driver: load for load in loads.of_block(design, "test_column", self.library, self.pin_load)}
        # Inverters of four and one inputs, 2 um of 0.2 fF before each.
        load = found["test_column/i"]
        self.assertAlmostEqual(load.ff, 5 * standard_cells.CINV_FF + 2 * self.library.wire_ff_per_sink, places=3)
        self.assertEqual(load.inputs, 2)
        self.assertAlmostEqual(load.limit_ff, 24 * standard_cells.CINV_FF, delta=0.1)

    def test_a_net_between_blocks_has_the_wire_of_the_floorplan(self) -> None:
        design, plan = self.design(4)
        found = {load.driver: load for load in loads.of_top(design, plan, self.library, self.pin_load)}
        # From the first of four columns to the last are 300 um of 0.25 fF; each has an inverter behind its port.
        self.assertAlmostEqual(found["far/Q"].ff, 300 * 0.25 + 4 * (standard_cells.CINV_FF + self.library.wire_ff_per_sink), places=2)
        self.assertEqual(found["far/Q"].inputs, 4)
        self.assertNotIn("clk_i", found)

    def test_a_load_beyond_the_limit_stops_the_flow(self) -> None:
        design, plan = self.design(4)
        with self.assertRaisesRegex(FlowError, r"some: 1 drivers have too much to drive: far/Q drives 8\d\.\d fF of 36\.3 and 4 inputs"):
            self.check(design, plan)
        design, plan = self.design(2)
        self.assertEqual(self.check(design, plan).driver, "far/Q")
        netlist.modules(design)["test_column"]["cells"]["heavy"] = cell("INV_X16", {"A": 8}, {"Y": 22})
        netlist.modules(design)["test_column"]["cells"]["heavy2"] = cell("INV_X8", {"A": 8}, {"Y": 23})
        with self.assertRaisesRegex(FlowError, "test_column/i drives"):
            self.check(design, plan)

    def test_too_many_inputs_stop_the_flow(self) -> None:
        design, plan = self.design(2)
        with mock.patch.object(loads, "MAX_FANOUT", 1), self.assertRaisesRegex(FlowError, "2 inputs of 1"):
            self.check(design, plan)
        self.assertFalse(loads.Load("a", 1.0, 2.0, loads.MAX_FANOUT).is_too_much)
        self.assertTrue(loads.Load("a", 1.0, 2.0, loads.MAX_FANOUT + 1).is_too_much)
        self.assertTrue(loads.Load("a", 2.1, 2.0, 1).is_too_much)

    def test_three_of_the_loads_beyond_their_limits_are_named(self) -> None:
        heavy = [loads.Load(f"d{index}", 9.0, 8.0, 1) for index in range(4)]
        design, plan = self.design(2)
        with mock.patch.object(loads, "of_top", return_value=heavy):
            with self.assertRaisesRegex(FlowError, "4 drivers have too much to drive: d0 [^;]*; d1 [^;]*; d2 [^;]*$"):
                self.check(design, plan)

    def test_the_load_closest_to_its_limit_is_shown(self) -> None:
        near, far = loads.Load("near", 5.0, 6.0, 1), loads.Load("far", 10.0, 20.0, 1)
        design, plan = self.design(2)
        with mock.patch.object(loads, "of_top", return_value=[far, near]), mock.patch.object(loads, "of_block", return_value=[]):
            self.assertEqual(self.check(design, plan), near)

    def test_drivers_without_a_limit_are_not_judged(self) -> None:
        design, plan = self.design(2)
        netlist.modules(design)["test_column"]["cells"]["odd"] = cell("ODD", {"A": 8}, {"Y": 30})
        netlist.top(design)["cells"]["far"]["type"] = "ODD"
        self.assertNotIn("test_column/odd", {load.driver for load in loads.of_block(design, "test_column", self.library, self.pin_load)})
        self.assertNotIn("far/Q", {load.driver for load in loads.of_top(design, plan, self.library, self.pin_load)})

    def test_a_cell_that_is_too_weak_for_its_wire_gets_the_drive_that_suffices(self) -> None:
        design, plan = self.design(4)
        loads.strengthen(design, plan, self.library, self.pin_load)
        cells = netlist.top(design)["cells"]
        # 80 fF are more than half of 36.3 and of 72.5 fF, and than half of 145 fF.
        self.assertEqual(cells["near"]["type"], "DFF_X1")
        self.assertEqual(cells["far"]["type"], self.library.drives[[drives[0] for drives in self.library.drives].index("DFF_X1")][-1])
        design, plan = self.design(2)
        loads.strengthen(design, plan, self.library, self.pin_load)  # 100 um and two inverters are 29.6 fF
        self.assertEqual(netlist.top(design)["cells"]["far"]["type"], "DFF_X2")

    def test_a_block_that_drives_another_carries_the_wire_and_what_hangs_on_it_inside(self) -> None:
        design, plan = self.design(2)
        column, top = netlist.modules(design)["test_column"], netlist.top(design)
        column["ports"]["y"] = {"direction": "output", "bits": [8]}
        names = [name for name, cell in top["cells"].items() if cell["type"] == "test_column"]
        for name, net, told in zip(names, (500, 501), (5, 500)):
            top["cells"][name]["connections"] |= {"y": [net], "told": [told]}
            top["cells"][name]["port_directions"]["y"] = "output"
        top["cells"]["end"] = cell("DFF_X1", {"D": 501, "CK": 2}, {"Q": 502})
        found = loads.between_blocks(design, plan, self.library, self.pin_load)
        # The first column drives the second, 100 um away; the second a register in the middle, 50 um away.
        inverter, wire = standard_cells.CINV_FF, self.library.wire_ff_per_sink
        self.assertAlmostEqual(found["test_column"][8], 100 * 0.25 + (inverter + wire) + (5 * inverter + 2 * wire), places=2)


if __name__ == "__main__":
    unittest.main()
