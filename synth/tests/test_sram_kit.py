# SPDX-License-Identifier: Apache-2.0
"""The macros' Liberty in each corner against figures by hand."""

import unittest

from dtof_synth import liberty, sram_kit
from dtof_synth.sram_model import Size, macro
from dtof_synth.standard_cells import FAST, SLOW, TYPICAL

LARGEST = Size(2, 10240, 10)  # the access times are anchored here: 1.2 ns typical, 2.2 ns slow


class Liberty(unittest.TestCase):
    def pins(self, corner) -> dict[str, liberty.Group]:
        cell, = liberty.parse(sram_kit.liberty([macro(LARGEST)], corner), "macro").children("cell")
        return {pin.name: pin for pin in cell.groups if pin.kind in ("pin", "bus")}

    def test_access_and_cycle_of_each_corner(self):
        # The fast corner's gates take 16 / 25.8 of the typical ones' time.
        for corner, access in ((TYPICAL, 1.2), (SLOW, 2.2), (FAST, 1.2 * 16 / 25.8)):
            pins = self.pins(corner)
            self.assertAlmostEqual(pins["clk_i"].number("min_period"), access, places=3, msg=corner.name)
            arc, = pins["rdata_o"].children("timing")
            delays = [float(text) for text in dict(arc.children("cell_rise")[0].attributes)["values"][0].split(",")]
            self.assertAlmostEqual(delays[1], access, places=3, msg=corner.name)  # with a fan-out of four

    def test_setup_and_hold_of_every_input(self):
        for corner in (TYPICAL, SLOW, FAST):
            for name, pin in self.pins(corner).items():
                if pin.get("direction") != "input" or name == "clk_i":
                    continue
                found = {timing.get("timing_type"): [dict(edge.attributes)["values"][0] for edge in timing.groups]
                         for timing in pin.children("timing")}
                self.assertEqual(found, {"setup_rising": ["0.15", "0.15"], "hold_rising": ["0.05", "0.05"]}, f"{corner.name} {name}")


if __name__ == "__main__":
    unittest.main()
