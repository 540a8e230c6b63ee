# SPDX-License-Identifier: Apache-2.0
"""Registers on long ways: which they are, and where they stand."""

import os
import random
import unittest

from dtof_synth import floorplan, netlist, same_logic
from dtof_synth.broadcast import Registers
from dtof_synth.floorplan import Floorplan

from .test_floorplan import WithLibrary, array, cell

SEQUENTIAL = {"DFF_X1"}


def rows(**registers: tuple[int, int]) -> Registers:
    """Registers by name: (net that it takes, its net)."""
    return Registers({"ports": {}, "cells": {name: cell("DFF_X1", {"D": data, "CK": 1}, {"Q": output})
                                             for name, (data, output) in registers.items()}}, SEQUENTIAL)


class Rows(unittest.TestCase):
    def test_registers_between_the_first_and_the_last_have_numbers(self) -> None:
        row = {f"stage{number}": (10 + number - 1, 10 + number) for number in range(1, 6)}
        self.assertEqual(rows(**row).numbers([15], 5), {14: 4, 13: 3, 12: 2})
        self.assertEqual(rows(**row).numbers([15], 4), {14: 3, 13: 2})  # a register of the shared logic is in front
        self.assertEqual(rows(**row).numbers([15], 2), {})

    def test_a_row_that_begins_late_has_no_number_for_its_first_register(self) -> None:
        self.assertEqual(rows(second=(30, 12), third=(12, 13), fourth=(13, 14)).numbers([14], 5), {13: 4})

    def test_a_register_of_several_rows_has_its_largest_number(self) -> None:
        self.assertEqual(rows(a1=(9, 10), a2=(10, 11), a3=(11, 12), a4=(12, 13), b4=(11, 20)).numbers([13, 20], 4), {11: 3, 12: 3})

    def test_a_last_register_in_another_row_stays_a_last_one(self) -> None:
        self.assertEqual(rows(a1=(9, 10), a2=(10, 11), a3=(11, 12), b2=(12, 13), b3=(13, 14)).numbers([12, 14], 3), {11: 2, 13: 2})

    def test_another_cell_ends_a_row(self) -> None:
        module = {"ports": {}, "cells": {"a": cell("DFF_X1", {"D": 9}, {"Q": 10}), "gate": cell("INV_X1", {"A": 10}, {"Y": 11}),
                                         "b": cell("DFF_X1", {"D": 11}, {"Q": 12}), "c": cell("DFF_X1", {"D": 12}, {"Q": 13})}}
        self.assertEqual(Registers(module, SEQUENTIAL).numbers([13], 4), {})

    def test_a_register_behind_a_clock_gate_is_no_part_of_a_row(self) -> None:
        module = {"ports": {}, "cells": {f"stage{number}": cell("DFF_X1", {"D": 9 + number, "CK": 8 if number == 2 else 1}, {"Q": 10 + number})
                                         for number in range(1, 5)}}
        self.assertEqual(Registers(module, SEQUENTIAL).numbers([14], 4), {13: 3, 12: 2})
        self.assertEqual(Registers(module, SEQUENTIAL, {8}).numbers([14], 4), {})

    def test_results_stand_evenly_on_the_way_back(self) -> None:
        found = rows(r1=(50, 51), r2=(51, 52), kept=(52, 53), other=(60, 61), twice=(60, 62))
        self.assertEqual(found.results({50: 0.0, 60: 300.0}, (), 150.0, 4), {"r1": 50.0, "r2": 100.0, "other": 225.0, "twice": 225.0})
        self.assertEqual(found.results({50: 0.0}, (), 150.0, 3), {"r1": 75.0})

    def test_a_register_that_has_a_place_keeps_it(self) -> None:
        self.assertEqual(rows(line=(50, 51), r1=(60, 61)).results({50: 0.0, 60: 0.0}, {"line": 0.0}, 100.0, 3), {"r1": 50.0})

    def test_a_row_ends_in_front_of_a_register_that_has_a_place(self) -> None:
        self.assertEqual(rows(r1=(50, 51), head=(51, 52)).results({50: 0.0}, {"head"}, 100.0, 5), {"r1": 50.0})

    def test_a_row_of_results_ends_where_it_forks_and_where_it_closes(self) -> None:
        self.assertEqual(rows(r1=(50, 51), r2=(51, 52), r3=(51, 53)).results({50: 0.0}, (), 100.0, 5), {"r1": 50.0})
        self.assertEqual(rows(r1=(50, 51), r2=(51, 50)).results({50: 0.0}, (), 90.0, 8), {"r1": 30.0, "r2": 60.0})


class Ways(WithLibrary):
    """A command on its way to the columns, through copies and repeaters."""

    def spread(self, columns: int, stages: int) -> tuple[dict, Floorplan, dict]:
        design = array(columns, stages)
        mapped = same_logic.of(design, self.library)
        plan = Floorplan(design, 1)
        floorplan.spread(plan, self.library, self.pin_load, {2}, stages=stages)
        same_logic.check(mapped, same_logic.of(design, self.library))
        return netlist.top(design), plan, design

    def way(self, top: dict, column: str) -> list[str]:
        """Registers in front of a column, the nearest first."""
        driver = {bits[0]: name for name, item in top["cells"].items() for pin, bits in item["connections"].items()
                  if item["port_directions"][pin] == "output"}
        net, found = top["cells"][column]["connections"]["told"][0], []
        while net in driver:
            item = top["cells"][driver[net]]
            if item["type"].startswith("DFF"):
                found.append(driver[net])
            net = item["connections"]["D" if item["type"].startswith("DFF") else "A"][0]
        self.assertEqual(net, 3)
        return found

    def test_each_column_has_its_registers_at_equal_distances(self) -> None:
        seed = int(os.environ.get("DTOF_TEST_SEED", random.randrange(2**31)))
        draw = random.Random(seed)
        for columns, stages in ((320, 3), (640, 6), (1024, 8), (40, 3), *((draw.randrange(1, 900), draw.randrange(3, 9)) for _ in range(3))):
            with self.subTest(columns=columns, stages=stages, seed=seed):
                top, plan, _ = self.spread(columns, stages)
                hop = plan.centre_um / (stages - 1)
                for index in range(columns):
                    column = f"g_column[{index}].u_column"
                    way = self.way(top, column)
                    self.assertEqual(len(way), stages)
                    places = [plan[column], *(plan[name] for name in way)]
                    self.assertEqual(places[-1], plan.centre_um)
                    self.assertLessEqual(abs(places[0] - places[1]), max(floorplan.COPY_UM + floorplan.LEAF_UM, hop))
                    for one, next_one in zip(places[1:], places[2:]):
                        self.assertLessEqual(abs(one - next_one), hop + floorplan.REPEATER_UM)

    def test_no_wire_is_longer_than_between_two_repeaters_and_no_driver_is_overloaded(self) -> None:
        for columns, stages in ((320, 3), (1024, 8)):
            top, plan, _ = self.spread(columns, stages)
            driver = {bits[0]: name for name, item in top["cells"].items() for pin, bits in item["connections"].items()
                      if item["port_directions"][pin] == "output"}
            load: dict[str, float] = {}
            for name, item in top["cells"].items():
                for pin, bits in item["connections"].items():
                    if item["port_directions"][pin] == "input" and bits[0] in driver:
                        source = driver[bits[0]]
                        load[source] = load.get(source, 0.0) + self.pin_load(item["type"], pin)
                        self.assertLessEqual(abs(plan[name] - plan[source]), floorplan.REPEATER_UM + 1e-6, (name, source))
            for name, ff in load.items():
                self.assertLessEqual(ff, next(iter(self.library.max_load_ff[top["cells"][name]["type"]].values())), name)

    def test_a_register_in_front_of_a_port_stays_beside_the_shared_logic(self) -> None:
        for port in (True, False):
            design = array(320, 3)
            top = netlist.top(design)
            column = top["cells"]["g_column[0].u_column"]
            column["connections"]["event"], column["port_directions"]["event"] = [901], "output"
            top["cells"]["head"] = cell("DFF_X1", {"D": 901, "CK": 2}, {"Q": 902})
            if port:
                top["ports"]["event_o"] = {"direction": "output", "bits": [902]}
            else:
                top["cells"]["next"] = cell("DFF_X1", {"D": 902, "CK": 2}, {"Q": 903})
            plan = Floorplan(design, 1)
            floorplan.spread(plan, self.library, self.pin_load, {2}, stages=3)
            self.assertEqual(plan["head"], plan.centre_um if port else (plan["g_column[0].u_column"] + plan.centre_um) / 2)

    def test_few_copies_serve_the_stretches(self) -> None:
        top, _, _ = self.spread(640, 6)
        copies = {number: sum(name.startswith(f"middle{number}{netlist.COPY_SUFFIX}") for name in top["cells"]) for number in range(2, 6)}
        self.assertTrue(all(number <= found <= 2 * number for number, found in copies.items()), copies)
        self.assertFalse(any(name.startswith(f"near{netlist.COPY_SUFFIX}") for name in top["cells"]))

    def test_two_stages_stand_as_if_nobody_counted_them(self) -> None:
        found = []
        for stages in (None, 2):
            design = array(200)
            plan = Floorplan(design, 1)
            if stages is None:
                floorplan.spread(plan, self.library, self.pin_load, {2})
            else:
                floorplan.spread(plan, self.library, self.pin_load, {2}, stages=stages)
            found.append((design, plan.places))
        self.assertEqual(found[0], found[1])

    def test_what_the_shared_logic_hears_of_a_middle_register_stays_beside_it(self) -> None:
        design = array(320, 3)
        top = netlist.top(design)
        top["cells"]["logic"] = cell("INV_X1", {"A": top["cells"]["middle2"]["connections"]["Q"][0]}, {"Y": 900})
        plan = Floorplan(design, 1)
        floorplan.spread(plan, self.library, self.pin_load, {2}, stages=3)
        self.assertEqual(top["cells"]["logic"]["connections"]["A"], top["cells"]["middle2"]["connections"]["Q"])
        self.assertEqual(plan["middle2"], plan.centre_um)


if __name__ == "__main__":
    unittest.main()
