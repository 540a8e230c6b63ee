# SPDX-License-Identifier: Apache-2.0
"""The slow corner's readings: ratios by hand, and that each reaches the libraries that are timed."""

import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from unittest import mock

from dtof_synth import corner_ratios, liberty, sram_model, standard_cells
from dtof_synth.run import Result
from dtof_synth.sram_model import Size
from dtof_synth.technology import Technology

from .partial import part_of
from .small_results import ROOT


class Ratios(unittest.TestCase):
    def test_the_ratios_are_those_of_their_sources(self) -> None:
        self.assertAlmostEqual(corner_ratios.GATES, 81 / 25.8)
        self.assertAlmostEqual(corner_ratios.SRAMS, 2.2 / 1.2)

    def test_registers_follow_the_gates(self) -> None:
        slow = standard_cells.SLOW
        half = corner_ratios.corner(slow.gate / 2)
        for name in ("gate", "clock_to_q", "setup", "hold"):
            self.assertAlmostEqual(getattr(half, name), getattr(slow, name) / 2)
        self.assertEqual((half.voltage, half.leakage), (slow.voltage, slow.leakage))
        self.assertEqual(corner_ratios.corner(slow.gate), slow)

    def test_an_access_takes_so_many_times_the_typical_one(self) -> None:
        one, = corner_ratios.macros([Size(2, 10240, 10)], 3.0)
        self.assertAlmostEqual(one.access_slow, 3.6)
        self.assertEqual(one.access_typical, sram_model.ACCESS_TYPICAL_NS)

    def test_each_reading_is_timed_with_its_libraries(self) -> None:
        seen = []

        def retimed(_result, _technology, _folder, cells, srams, *_):
            macro = next(cell for cell in liberty.read(srams).children("cell") if cell.name == "sram_1r1w_160x14")
            clock = next(pin for pin in macro.children("pin") if pin.name == "clk_i")
            register = next(cell for cell in liberty.read(cells).children("cell") if cell.name == "DFF_X1")
            setup = next(pin for pin in register.children("pin") if pin.name == "D").children("timing")[0].groups[0]
            seen.append((clock.number("min_period"), float(dict(setup.attributes)["values"][0])))
            return SimpleNamespace(margin=lambda: SimpleNamespace(slack=0.1 * len(seen)))

        with TemporaryDirectory() as folder, mock.patch.object(corner_ratios, "retimed", retimed):
            found = corner_ratios.read(part_of(Result), part_of(Technology, root=ROOT), Path(folder))
        self.assertEqual([round(one.slack, 1) for one in found], [0.1, 0.2, 0.3])
        access, setup = sram_model.macro(Size(2, 160, 14)).access_typical, 0.137 * 28 / 25.8
        gates, srams = 81 / 25.8, 2.2 / 1.2
        for (period, time), (of_srams, of_gates) in zip(seen, ((srams, gates), (srams, srams), (gates, gates))):
            self.assertAlmostEqual(period, access * of_srams, places=3)
            self.assertAlmostEqual(time, setup * of_gates / gates, places=4)


if __name__ == "__main__":
    unittest.main()
