# SPDX-License-Identifier: Apache-2.0
"""The models of `dtof design`: what they are fitted to, what is held out, and what they say of their error."""

import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import configuration, estimate
from dtof_synth.errors import FlowError

from .small_results import ROOT

PARTS = {"columns": 20.0, "shared": 1.0, "sram": 10.0, "clock": 5.0, "leakage": 4.0}


def point(name: str, readout: str, column: float, note: str = "", power: bool = True, **changes: int) -> estimate.Measured:
    """With logic of a given size; what the columns share grows by 50 um2 a column."""
    described = configuration.load(ROOT / "configurations.toml")[readout]
    item = replace(described.with_parameters(name, **changes), note=note)
    columns = item["SRAM_NUM"]
    shared = 50.0 * columns + item.engines * 5000.0
    srams = estimate._macro_area(configuration.memories(item)) / item.module_columns
    total = ((column + srams) * columns + shared + item.engines * estimate._macro_area(configuration.engine_memories(item))) * 1e-6
    return estimate.Measured(item, column, shared, item.engines * 5000.0 if note else None, total,
                             350.0 if columns <= 200 else 250.0, {light: PARTS for light in estimate.LIGHTS} if power else {})


def points() -> list[estimate.Measured]:
    return [point("sifh", "sifh", 2000.0),
            point("sifh_count12", "sifh", 2100.0, power=False, COUNT_WIDTH=12),
            point("sifh_count8", "sifh", 1900.0, power=False, COUNT_WIDTH=8),
            point("wide", "sifh", 2000.0, "fitted", power=False, SRAM_NUM=400),
            point("poolpointer", "poolpointer", 1800.0),
            point("small", "poolpointer", 1800.0, "fitted", power=False, SRAM_NUM=68),
            point("larger", "poolpointer", 1800.0, "fitted", power=False, SRAM_NUM=136),
            point("held", "sifh", 2050.0, estimate.HELD_OUT, power=False, COUNT_WIDTH=11, SRAM_NUM=100)]


class Estimate(unittest.TestCase):
    def test_defaults_are_what_the_flow_measured(self):
        model = estimate.fit(points(), [])
        for one in points():
            if not one.configuration.note and one.power:
                self.assertAlmostEqual(model.total_mm2(one.configuration), one.total_mm2, places=6)
                self.assertAlmostEqual(model.mw(one.configuration, "day"), sum(PARTS.values()), places=6)

    def test_a_parameters_slope_and_what_columns_share_are_found(self):
        model = estimate.fit(points(), [])
        self.assertAlmostEqual(model.slopes["histogram"][estimate.FEATURES.index("COUNT_WIDTH")], 50.0, delta=2.0)
        self.assertAlmostEqual(model.control_slopes["histogram"], 50.0, places=6)
        self.assertAlmostEqual(model.control_slopes["pool"], 50.0, places=6)
        self.assertAlmostEqual(model.references["poolpointer"].engine, 5000.0, places=3)

    def test_candidates_cost_area_in_columns_and_in_engines(self):
        base = point("fewer", "poolpointer", 1800.0, "fitted", power=False, SRAM_NUM=68)
        more = point("more", "poolpointer", 1900.0, "fitted", power=False, SRAM_NUM=68, LABELS=6)
        more = replace(more, engines=more.configuration.engines * 5700.0,
                       shared=50.0 * 68 + more.configuration.engines * 5700.0)
        model = estimate.fit([*points(), base, more], [])
        self.assertAlmostEqual(model.engine_um2_a_label, 700.0, places=3)
        self.assertAlmostEqual(model.slopes["pool"][estimate.FEATURES.index("LABELS")], 100.0, delta=10.0)
        self.assertAlmostEqual(model.engine_um2(more.configuration), 5700.0, places=3)

    def test_an_sram_that_is_slower_than_the_logic_limits_the_clock(self):
        model = estimate.fit(points(), [])
        base = points()[0].configuration
        self.assertEqual(model.fmax_mhz(base), 350.0)
        larger = base.with_parameters("larger", PIXELS_PER_SRAM=2560)
        access = max(estimate.sram_model.macro(size).access_slow for size in configuration.memories(larger).values())
        self.assertAlmostEqual(model.fmax_mhz(larger), 1e3 / (access + estimate.AFTER_ACCESS_NS["histogram"]))
        self.assertLess(model.fmax_mhz(larger), 300.0)

    def test_the_line_of_an_engine_limits_the_clock(self):
        model = estimate.fit(points(), [])
        base = next(one.configuration for one in points() if one.configuration.name == "poolpointer")
        self.assertEqual(model.fmax_mhz(base.with_parameters("wide", ENGINE_COLUMNS=100)), 350.0)
        self.assertAlmostEqual(model.fmax_mhz(base.with_parameters("whole", ENGINE_COLUMNS=200)), 1e3 / (1e3 / 350 + 1.96))
        self.assertEqual(model.fmax_mhz(base.with_parameters("narrow", ENGINE_COLUMNS=200, SRAM_NUM=100)), 350.0)

    def test_a_step_of_the_sweeps_is_followed(self):
        base = points()[0].configuration
        steps = [estimate.Step(base.with_parameters("np", NP=12), base, 80.0)] * 5
        model = estimate.fit(points(), steps)
        self.assertAlmostEqual(model.slopes["histogram"][estimate.FEATURES.index("NP")], 40.0, delta=1.0)

    def test_data_power_follows_the_bits_of_fitted_points(self):
        more = {light: {**PARTS, "columns": 4 * PARTS["columns"]} for light in estimate.LIGHTS}
        fitted = replace(point("bits", "sifh", 2000.0, "fitted", NP=5, NB=6), power={})
        self.assertAlmostEqual(estimate.fit([*points(), fitted], []).data_exponent, 0.0)
        doubled = replace(point("bits", "sifh", 2000.0, "fitted", NP=20, NB=6), power=more)
        self.assertAlmostEqual(estimate.fit([*points(), doubled], []).data_exponent, 2.0, delta=0.01)

    def test_a_held_out_point_changes_no_coefficient(self):
        changed = [replace(one, column=9 * one.column, total_mm2=9 * one.total_mm2) if one.held_out else one for one in points()]
        self.assertEqual(estimate.fit(points(), []), estimate.fit(changed, []))

    def test_an_error_of_a_held_out_point_is_said_as_it_is(self):
        self.assertLess(estimate.worst(estimate.errors(points(), []), "area"), 0.002)
        wrong = [replace(one, total_mm2=1.25 * one.total_mm2) if one.held_out else one for one in points()]
        self.assertAlmostEqual(estimate.worst(estimate.errors(wrong, []), "area"), 0.2, delta=0.002)

    def test_a_figure_that_nothing_was_held_out_for_has_no_error_of_zero(self):
        with self.assertRaisesRegex(FlowError, "nothing is held out for the power"):
            estimate.checked(estimate.errors(points(), []))

    def test_goals_are_five_per_cent_of_area_and_ten_of_power(self):
        for figure, goal, at, above in (("area", "5%", 1.0499, 1.0501), ("power", "10%", 0.9001, 0.8999), ("fmax", "-", 2.0, 2.0)):
            for estimated, met in ((at, "yes"), (above, "**no**")):
                error = estimate.Error("some", figure, estimate.HELD_OUT, 1.0, estimated)
                with mock.patch.object(estimate, "digest", return_value="0"):
                    text = estimate.report(ROOT, [error])
                size = f"{abs(estimated - 1):.1%}"
                self.assertIn(f"| {figure} | {estimate.HELD_OUT} | 1 | {size} | {size} | {goal} | {met if goal != '-' else '-'} |", text)

    def test_wide_arrays_are_slower(self):
        model = estimate.fit(points(), [])
        wide = point("other", "sifh", 2000.0, SRAM_NUM=300).configuration
        self.assertLess(model.fmax_mhz(wide), 310.0)
        self.assertAlmostEqual(model.fmax_mhz(point("same", "sifh", 2000.0).configuration), 350.0)

    def test_power_grows_with_columns_and_with_the_memory(self):
        model = estimate.fit(points(), [])
        base = points()[0].configuration
        self.assertGreater(model.mw(base.with_parameters("more", SRAM_NUM=400), "day"), 1.9 * model.mw(base, "day"))
        self.assertGreater(model.mw(base.with_parameters("bins", NB=7), "day"), model.mw(base, "day"))

    def test_a_readout_without_measured_power_is_refused(self):
        with self.assertRaisesRegex(FlowError, "no power of "):
            estimate.fit([replace(one, power={}) for one in points()], [])

    def test_what_is_committed_follows_from_the_committed_figures(self):
        text = (ROOT / estimate.COEFFICIENTS).read_text(encoding="utf-8")
        self.assertIn(f'digest = "{estimate.digest(ROOT)}"', text, "run synth/synth.py estimate")
        measured, steps = estimate.read(ROOT), estimate.read_steps(ROOT)
        self.assertEqual(text, estimate.coefficients(ROOT, estimate.fit(measured, steps), estimate.errors(measured, steps)))

    def test_another_root_gets_the_same_files(self):
        with tempfile.TemporaryDirectory() as temporary:
            estimate.write(ROOT, Path(temporary))
            self.assertEqual((Path(temporary) / estimate.COEFFICIENTS).read_text(encoding="utf-8"), (ROOT / estimate.COEFFICIENTS).read_text(encoding="utf-8"))
            written = {str(path.relative_to(temporary)) for path in Path(temporary).rglob("*.*")}
            self.assertEqual(written, {estimate.COEFFICIENTS, estimate.REPORT})

    def test_every_point_has_figures_and_a_note(self):
        known = {one.configuration.name for one in estimate.read(ROOT)}
        for name, item in configuration.load(ROOT / estimate.POINTS).items():
            self.assertIn(item.note, ("fitted", estimate.HELD_OUT))
            self.assertIn(name, known)
        self.assertGreater(len(estimate.read_steps(ROOT)), 10)


if __name__ == "__main__":
    unittest.main()
