# SPDX-License-Identifier: Apache-2.0
"""Which libraries and memories a run gets."""

import gzip
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import configuration, sram_kit, sram_model, standard_cells, technology
from dtof_synth.errors import FlowError
from dtof_synth.sram_model import Size

from .small_results import ROOT

NAMED = configuration.load(ROOT / "configurations.toml")


class Sizes(unittest.TestCase):
    def test_every_memory_of_columns_and_engines_is_needed_by_name(self) -> None:
        found = technology.needed_sizes([NAMED[name] for name in ("ezpointer", "ezpointer_bare", "poolpointer")])
        self.assertEqual(found[Size(2, 160, 14)], ["ezpointer"])
        self.assertEqual((found[Size(1, 100, 232, 8)], found[Size(1, 160, 33)]), (["poolpointer"], ["poolpointer"]))
        twice = technology.needed_sizes([NAMED["ezpointer"], NAMED["ezpointer"]])
        self.assertEqual(twice, {Size(2, 160, 14): ["ezpointer", "ezpointer"]})


class Prepared(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / "a" / "b"  # made by prepare
        self.texts = {corner.name: standard_cells.library(corner) for corner in standard_cells.CORNERS}

    def prepare(self, **more) -> technology.Technology:
        with mock.patch.object(sram_kit, "write_kit") as self.kit:
            return technology.prepare(ROOT, self.folder, [NAMED["ezpointer"]], **more)

    def test_generated_libraries_have_three_corners(self) -> None:
        found = self.prepare()
        assert found.fast is not None
        for corner, cells in (("typical", found.typical), ("slow", found.slow), ("fast", found.fast)):
            self.assertEqual(cells.path, self.folder / f"generic40_{corner}.lib")
            self.assertEqual(cells.path.read_text(encoding="utf-8"), self.texts[corner])
            self.assertEqual(found.library(corner), cells)
        self.assertEqual((found.kit, found.root, found.target_mhz), (self.folder / "technology", ROOT, 330.0))
        folder, sizes, macro_of = self.kit.call_args.args
        self.assertEqual((folder, sizes, macro_of), (found.kit, sram_kit.read_sizes(ROOT / "synth/sram_sizes.csv"), sram_model.macro))

    def test_a_clock_and_memories_may_be_others(self) -> None:
        found = self.prepare(target_mhz=100.0, macro_of=len, more=[NAMED["ezpointer"].with_parameters("odd", PIXELS_PER_SRAM=77)])
        _, sizes, macro_of = self.kit.call_args.args
        self.assertEqual((found.target_mhz, macro_of), (100.0, len))
        self.assertEqual(sizes, [*sram_kit.read_sizes(ROOT / "synth/sram_sizes.csv"), Size(2, 77, 14)])

    def test_a_size_that_is_not_listed_stops_the_flow(self) -> None:
        odd = NAMED["ezpointer"].with_parameters("odd", PIXELS_PER_SRAM=77)
        with self.assertRaisesRegex(FlowError, "odd needs the SRAM sram_1r1w_77x14, which is not in synth/sram_sizes.csv"):
            technology.prepare(ROOT, self.folder, [odd])

    def test_a_library_from_elsewhere_serves_both_corners_and_no_fast_one(self) -> None:
        plain, packed = self.folder.parent.parent / "plain.lib", self.folder.parent.parent / "packed.lib.gz"
        plain.write_text(self.texts["typical"], encoding="utf-8")
        packed.write_bytes(gzip.compress(self.texts["slow"].encode()))
        found = self.prepare(liberty=plain)
        self.assertEqual((found.typical.path, found.fast), (plain, None))
        self.assertIs(found.slow, found.typical)
        with self.assertRaisesRegex(FlowError, "no library for the fast corner"):
            found.library("fast")
        found = self.prepare(liberty=plain, liberty_slow=packed)
        self.assertEqual((found.typical.path, found.slow.path), (plain, self.folder / "packed.lib"))
        self.assertEqual(found.slow.path.read_text(encoding="utf-8"), self.texts["slow"])

    def test_a_library_that_cannot_be_read_stops_the_flow(self) -> None:
        damaged = self.folder.parent.parent / "damaged.lib.gz"
        damaged.write_bytes(b"no gzip")
        for path, said in ((damaged, "cannot unpack"), (self.folder / "absent.lib", "no such Liberty file")):
            with self.assertRaisesRegex(FlowError, said):
                self.prepare(liberty=path)


if __name__ == "__main__":
    unittest.main()
