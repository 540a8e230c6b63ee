# SPDX-License-Identifier: Apache-2.0
"""Power on a scene, from counted transitions to the array and to a frame, by hand."""

import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

from dtof_synth import configuration, library, run, scene_power, sram_model, standard_cells
from dtof_synth.activity import OTHER, STREAMING, Activity, Scope
from dtof_synth.power import ClockTree

from .small_netlists import cell, module
from .small_results import ROOT, result

NAMED = configuration.load(ROOT / "configurations.toml")
NO_POWER = scene_power.Parts(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class Frame(unittest.TestCase):
    def test_energy_of_a_frame_is_that_of_its_three_parts(self):
        # 330 MHz, 30 frames/s: 11e6 clocks. 5e6 at 200 mW, 1e6 at 50 mW, 5e6 idle at 10 mW, or at 4 mW gated:
        # (1000 + 50 + 50) / 330 mJ, or (1000 + 50 + 20) / 330 mJ.
        one = scene_power.ScenePower(NAMED["ezpointer"], "day", 0.1, 0.0, replace(NO_POWER, columns=200.0),
                                     replace(NO_POWER, columns=50.0), 10.0, 4.0, 5_000_000, 1_000_000)
        self.assertAlmostEqual(one.frame_mj, 1100 / 330, places=9)
        self.assertAlmostEqual(one.mean_mw, 30 * 1100 / 330, places=9)
        self.assertAlmostEqual(one.gated_mean_mw, 30 * 1070 / 330, places=9)

    def test_every_part_is_in_the_total(self):
        self.assertEqual(scene_power.Parts(1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 5.0).total, 63.0)


class Array(unittest.TestCase):
    """ezPointer: 200 columns of one inverter, whose net toggles; nothing else but control, which is one inverter, too."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        folder = Path(cls.scratch.name)
        (folder / "typical.lib").write_text(standard_cells.library(standard_cells.TYPICAL), encoding="utf-8")
        cls.library = library.read(folder / "typical.lib")
        (folder / run.FINISHED_COLUMN).write_text("{}", encoding="utf-8")
        column = module({"clk_i": ("input", 2), "a": ("input", 3), "y": ("output", 4)}, {
            "r": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 5}), "i": cell("INV_X1", {"A": 5}, {"Y": 4})})
        top = module({"clk_i": ("input", 2), "a": ("input", 3)}, {
            "u_column": cell("a_column_netlist", {"clk_i": 2, "a": 3}, {"y": 4}), "i": cell("INV_X1", {"A": 4}, {"Y": 5})}, top=True)
        design = {"modules": {"a_column_netlist": column, "t": top}}
        # The net between register and inverter toggles in every second streaming clock and never elsewhere.
        counted = Activity({"": Scope("t"), "p0": Scope("a_column_netlist", {STREAMING: {5: 500}})}, {STREAMING: 1000, OTHER: 250})
        cls.configuration = NAMED["ezpointer"]
        some = result("ezpointer")
        some = replace(some, shared=replace(some.shared, area=cls.library.area["INV_X1"], clock_energy_fj=100.0),
                       column_module=replace(some.column_module, clock_energy_fj=7.0), clock_tree=ClockTree(1, 1.0, 1000.0))
        technology = SimpleNamespace(typical=cls.library, slow=cls.library)
        with mock.patch.object(scene_power, "simulate", return_value=(design, counted)), \
                mock.patch.object(scene_power, "uniform_mw", return_value=0.0):
            cls.power = scene_power.power(cls.configuration, "day", some, folder, technology, folder, 1)

    def test_leakage_is_that_of_all_columns_their_srams_and_control(self):
        leakage = {group.name: group.number("cell_leakage_power")
                   for group in scene_power.liberty.read(self.library.path).children("cell")}
        sram_uw = sram_model.macro(sram_model.Size(2, 160, 14)).leakage
        expected = (200 * (leakage["DFF_X1"] + leakage["INV_X1"]) + leakage["INV_X1"]) * 1e-6 + 200 * sram_uw * 1e-3
        self.assertAlmostEqual(self.power.leakage_mw, expected, places=9)
        self.assertAlmostEqual(self.power.streaming.leakage, expected, places=9)

    def test_a_frame_has_a_clock_for_each_slot_of_each_pixel_of_an_acquisition(self):
        self.assertEqual(self.power.streaming_clocks, 33_333 * 160 * 2)
        # What the small frame had beside acquisitions, and a result for each of 200 x 160 pixels.
        self.assertEqual(self.power.other_clocks, 250 + 32_000)

    def test_columns_take_what_their_nets_and_cells_do(self):
        # 500 transitions in 1000 clocks of 200 columns: half of C V^2 of an inverter and 2 um of wire, and the register's energy.
        net_fj = 0.5 * (standard_cells.CINV_FF + self.library.wire_ff_per_sink) * 1.1**2
        cell_fj = standard_cells._path_energy((standard_cells.inverter(),) * 4, 1.1)
        self.assertAlmostEqual(self.power.streaming.columns / (0.5 * 200 * (net_fj + cell_fj) * 330e-6), 1, delta=1e-4)
        self.assertEqual(self.power.other.columns, 0.0)

    def test_the_clock_is_charged_in_every_clock(self):
        # 200 columns of 7 fJ, 100 fJ of control, 1000 fF of tree at 1.1 V.
        expected = (200 * 7.0 + 100.0 + 1000.0 * 1.21) * 330e-6
        self.assertAlmostEqual(self.power.streaming.clock, expected, places=9)
        self.assertAlmostEqual(self.power.idle_mw, expected + self.power.leakage_mw, places=9)


if __name__ == "__main__":
    unittest.main()
