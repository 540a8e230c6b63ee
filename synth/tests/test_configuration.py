# SPDX-License-Identifier: Apache-2.0
import tempfile
import unittest
from pathlib import Path

from dtof_synth import configuration, elaborated, goals, growth, readouts, sram_kit, technology
from dtof_synth.configuration import bits_per_pixel, memories
from dtof_synth.errors import FlowError
from dtof_synth.run import Result
from dtof_synth.signalled_clear import configurations as clear_configurations
from dtof_synth.sram_model import Size

from .partial import part_of

ROOT = Path(__file__).resolve().parents[2]


class Configurations(unittest.TestCase):
    def setUp(self) -> None:
        self.named = configuration.load(ROOT / "configurations.toml")

    def load(self, text: str):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "c.toml"
            path.write_text(text, encoding="utf-8")
            return configuration.load(path)

    def test_all_read_outs_are_there(self) -> None:
        with_rtl = {name for name, readout in readouts.load().readouts.items() if readout.top}
        self.assertEqual({item.readout for item in self.named.values()}, with_rtl)
        self.assertEqual(set(self.load("complete = true")), {name.replace("-", "_") for name in with_rtl})

    def test_bits_of_the_thesis(self) -> None:
        # Spec section 6: 10, 640 and 320 bits per pixel; peak and pointer memories come on top.
        self.assertEqual(bits_per_pixel(self.named["ezpointer_bare"]), 10)
        self.assertEqual(bits_per_pixel(self.named["sifh"]), 640 + 6)
        self.assertEqual(bits_per_pixel(self.named["fifh"]), 320 + 5)
        self.assertEqual(memories(self.named["hispointer"])["pointer"], Size(2, 160, 19))

    def test_an_array_of_several_read_outs_is_told_which_one(self) -> None:
        for name, number in (("ezpointer", readouts.load().readouts["ezpointer"].number), ("poolpointer", None)):
            found = dict(self.named[name].rtl_parameters())
            self.assertEqual(found.pop("READOUT", None), number)
            self.assertEqual(found, self.named[name].parameters)

    def test_bins_of_a_histogram(self) -> None:
        # SiFH: 640 bits a pixel in bins of 10 bits are 2^6 bins; ezPointer has none.
        some = self.named["sifh"]
        self.assertEqual(configuration.bin_width(some), int.bit_length(memories(some)["histogram"].words // some["PIXELS_PER_SRAM"]) - 1)
        with self.assertRaisesRegex(FlowError, "ezpointer: the read-out has no histogram"):
            configuration.bin_width(self.named["ezpointer"])

    def test_the_engines_sram_is_the_one_that_the_rtl_asks_for(self) -> None:
        # Widths of the messages of decide (20), with confidences (28), and of choose (4 for each candidate, cell and offset). Elaboration stops
        # at a size that is not listed.
        lean = self.named["poolpointer_lean"].with_parameters("lean", SRAM_NUM=4, PIXELS_PER_SRAM=8, ENGINE_COLUMNS=4, COUNT_WIDTH=4)
        significances = {"LABELS": 2, "ADVANTAGE_WIDTH": 7, "RIVAL_MOVES": 1, "POINTER_SHIFT": 2}
        for bits, changes in ((20, {"LABELS": 2}), (28, significances), (28, significances | {"PRIOR": 1}), (30, significances | {"PARITY": 1}),
                              (20, significances | {"ADVANTAGE_WIDTH": 4}), (20, significances | {"RIVAL_MOVES": 0}),
                              (31, significances | {"LABELS": 6, "SCORE_BITS": 2})):
            with self.subTest(changes=changes), tempfile.TemporaryDirectory() as folder:
                item = lean.with_parameters("engine", **changes)
                self.assertEqual(configuration.engine_memories(item), {"messages": Size(1, 8, bits)})
                elaborated.elaborate(item, ROOT, Path(folder))

    def test_engines_have_time(self) -> None:
        for name, columns in (("poolpointer", 34), ("poolpointer_lean", 50)):
            self.assertEqual(growth.engine_columns(self.named[name]), columns)
        by_labels = {point["LABELS"]: point for _, _, point in growth.candidates(self.named["poolpointer"])}
        shares = [by_labels[labels]["ENGINE_COLUMNS"] for labels in sorted(by_labels)]
        self.assertEqual(shares, sorted(shares, reverse=True))
        self.assertTrue(all(share % 2 == 0 for share in shares))
        crowded = by_labels[8].with_parameters("crowded", PIXELS_PER_SRAM=20_000)
        with self.assertRaisesRegex(FlowError, "crowded: no engine has time"):
            growth.engine_columns(crowded)

    def test_committed_size_list_is_complete_and_minimal(self) -> None:
        everything = [*self.named.values(), *(point for _, _, point in growth.sweep(self.named)),
                      *clear_configurations(self.named)]
        needed = set(technology.needed_sizes(everything))
        self.assertEqual(set(sram_kit.read_sizes(ROOT / technology.SIZES)), needed)

    def test_simulated_arrays_differ_where_the_file_says(self) -> None:
        self.assertEqual(self.named["sifh"].simulation, {"SRAM_NUM": 10})
        self.assertEqual(self.named["ezpointer_gate"].simulation, {"SRAM_NUM": 20})
        self.assertEqual(self.named["histogram"].simulation, {"SRAM_NUM": 10, "PIXELS_PER_SRAM": 160})

    def test_bad_files_are_refused(self) -> None:
        for text, message in (("x = ", "Invalid value"), ("", "no \\[configuration"),
                              ('[configuration.a]\nreadout = "nine"\n', "unknown read-out 'nine'"),
                              ('[configuration.a]\nvariant_of = "b"\n', "not above it"),
                              ('[configuration.a]\nreadout = "sifh"\nparameters = { NX = 1 }\n',
                               "unknown parameter NX"),
                              ('[simulation]\nNX = 1\n[configuration.a]\nreadout = "sifh"\n',
                               "unknown parameter NX")):
            with self.subTest(text=text), self.assertRaisesRegex(FlowError, message):
                self.load(text)


class Ranks(unittest.TestCase):
    def test_alike_areas_share_a_rank(self) -> None:
        areas = {name: part_of(Result, total_mm2=mm2)
                 for name, mm2 in (("ezpointer", 1.3), ("fifh", 8.5), ("hispointer", 8.9), ("sifh", 14.9))}
        self.assertEqual(goals.ranks(areas), goals.THESIS_RANK)
        areas["hispointer"] = part_of(Result, total_mm2=9.0)  # 1.059 times FiFH's
        self.assertEqual(goals.ranks(areas), {"ezpointer": 1, "fifh": 2, "hispointer": 3, "sifh": 4})


if __name__ == "__main__":
    unittest.main()
