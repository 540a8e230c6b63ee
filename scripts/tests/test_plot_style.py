# SPDX-License-Identifier: Apache-2.0
"""Read-outs can be told apart in every picture, with colours and without."""

import itertools
import unittest
from pathlib import Path

import growth_plot
import pareto
import plot_style
from dtof_synth.configuration import load

ROOT = Path(__file__).resolve().parent.parent.parent


class Styles(unittest.TestCase):
    def setUp(self) -> None:
        self.styles = plot_style.load()

    def test_every_readout_and_reference_has_its_own(self) -> None:
        titles = {configuration.title for configuration in load(ROOT / "configurations.toml").values()
                  if not configuration.variant_of} | set(pareto.REFERENCES)
        found = [plot_style.style(title, self.styles).title for title in titles]
        self.assertEqual(len(set(found)), len(titles))
        self.assertEqual(set(found), {style.title for style in self.styles})

    def test_markers_and_colours_differ(self) -> None:
        for one, other in itertools.combinations(self.styles, 2):
            self.assertNotEqual(one.marker, other.marker, f"{one.title}, {other.title}")
            channels = zip(bytes.fromhex(one.colour[1:]), bytes.fromhex(other.colour[1:]))
            self.assertGreater(sum(abs(a - b) for a, b in channels), 60, f"{one.title}, {other.title}")
        self.assertNotIn(pareto.THESIS_MARKER, {style.marker for style in self.styles if style.title not in pareto.REFERENCES
                                                and style.title != "matched filter"})

    def test_every_line_stands_out_from_white(self) -> None:
        def luminance(colour: str) -> float:  # of WCAG 2
            channels = [value / 255 for value in bytes.fromhex(colour[1:])]
            linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
            return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

        for style in self.styles:
            self.assertGreaterEqual(1.05 / (luminance(style.colour) + 0.05), 3.0, style.title)

    def test_a_label_has_the_style_of_the_longest_title(self) -> None:
        for label, title in {"hisPointer v1": "hisPointer v1", "hisPointer": "hisPointer",
                             "hisPointer, corrected": "hisPointer", "hisPointer FRACTION_BITS=4": "hisPointer",
                             "poolPointer lean: rmse": "poolPointer lean",
                             "matched filter (single pixel)": "matched filter"}.items():
            self.assertEqual(plot_style.style(label, self.styles).title, title)
        for label in ("hisPointers", "exact", ""):
            with self.assertRaises(SystemExit):
                plot_style.style(label, self.styles)

    def test_growth_draws_a_readout_in_its_style(self) -> None:
        row = {"readout": "sifh", "parameter": "NP", "value": "8", **dict.fromkeys(growth_plot.METRICS, "1")}
        rows = [{**row, "parameter": parameter} for parameter in growth_plot.PARAMETERS]
        self.assertIn(f"{plot_style.style('SiFH', self.styles).lines()} title 'SiFH'",
                      growth_plot.script(rows, Path("growth.png")))


if __name__ == "__main__":
    unittest.main()
