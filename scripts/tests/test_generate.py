# SPDX-License-Identifier: Apache-2.0
import re
import unittest
from pathlib import Path

import generate
import limits
import readouts_cpp
from dtof_synth import readouts
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]
LIMITS = limits.load()
FIRST_PHOTON = (ROOT / "docs/user/adding_a_readout/readouts.toml").read_text(encoding="utf-8")
TEXT = readouts.PATH.read_text(encoding="utf-8").replace(FIRST_PHOTON, "")  # make test-adding adds it


class Expressions(unittest.TestCase):
    def test_values(self):
        self.assertEqual(readouts.evaluate("(1 << (NP - NB)) - 1", {"NP": 10, "NB": 6}), 15)
        self.assertEqual(readouts.evaluate("max(NB, NP - NB) * 2 + 7 / 2", {"NP": 10, "NB": 3}), 17)
        self.assertEqual(readouts.evaluate(4, {}), 4)

    def test_refusals(self):
        for text in ("NX + 1", "NP +", "__import__(1)", "NP ** 2", "'a'"):
            with self.subTest(text=text), self.assertRaisesRegex(FlowError, "no expression"):
                readouts.evaluate(text, {"NP": 10})

    def test_translations_mean_the_same(self):
        names = (str.lower, lambda name: f"{name}_of")
        self.assertEqual(readouts_cpp.translated("(1 << (NP - NB)) - 1", *names), "(1 << (np - nb)) - 1")
        self.assertEqual(readouts_cpp.translated("max(NB, NP / 2)", *names), "max_of(nb, (np / 2))")
        self.assertEqual(readouts_cpp.translated("(NP - 1) * (NB - 1)", *names), "(np - 1) * (nb - 1)")


class Descriptions(unittest.TestCase):
    def test_a_new_read_out_is_in_every_list(self):
        table = readouts.parse(TEXT + FIRST_PHOTON)
        self.assertIn("localparam int READOUT_FIRSTPHOTON = 9;", generate.systemverilog(table))
        self.assertIn("READOUT must be 0 to 9", generate.readout_range(table))
        self.assertIn("READOUT_HISTOGRAM, READOUT_COARSEHISTOGRAM, READOUT_FIRSTPHOTON: coarse_passes = 0;", generate.systemverilog(table))
        self.assertIn("READOUT_FIRSTPHOTON: is_word_moved = 1'b1;", generate.systemverilog(table))
        self.assertIn("READOUT_FIRSTPHOTON: begin : g_first_photon\n          `DTOF_COLUMN(dtof_first_photon_column)",
                      generate.columns(table))
        self.assertIn("thesis/dtof_first_photon_column.sv\n", generate.column_files((ROOT / "hdl/dtof.f").read_text(), table))
        self.assertIn("case Readout::kFirstPhoton:\n      return make_first_photon(parameters);",
                      readouts_cpp.model_table(table))
        self.assertIn("partitioned_histogram coarse_histogram pool_pointer first_photon)", generate.cmake(table, LIMITS))
        self.assertIn("kFirstPhoton = 11,", readouts_cpp.cpp_header(table))
        self.assertIn('"first photon"', readouts_cpp.cpp_source(table))
        self.assertIn("set(DTOF_NUMBER_firstphoton 9)", generate.cmake(table, LIMITS))
        self.assertIn("9 first photon |", generate.defaults((ROOT / generate.CONFIGURATION).read_text(), table, LIMITS))

    def test_a_read_out_without_rtl_is_in_the_lists_of_models_alone(self):
        model_only = "\n".join(line for line in FIRST_PHOTON.splitlines() if not line.startswith(("number", "column")))
        table = readouts.parse(TEXT + model_only)
        self.assertIn("return make_first_photon(parameters);", readouts_cpp.model_table(table))
        self.assertIn("kFirstPhoton = 11,", readouts_cpp.cpp_header(table))
        everything, thesis, hardware = re.split("k(?:Thesis|Rtl)Readouts", readouts_cpp.cpp_header(table).split("kAllReadouts")[1])
        self.assertIn("kFirstPhoton", everything)
        self.assertNotIn("kFirstPhoton", thesis)
        self.assertNotIn("kFirstPhoton", hardware)
        for text in (generate.systemverilog(table), generate.columns(table)):
            self.assertNotIn("FIRSTPHOTON", text)
        self.assertNotIn("DTOF_TOP_firstphoton", generate.cmake(table, LIMITS))
        self.assertNotIn("first photon", generate.defaults((ROOT / generate.CONFIGURATION).read_text(), table, LIMITS))

    def test_a_changed_default_is_in_every_list(self):
        table = readouts.parse(TEXT.replace('defaults.NB = "min(NP, 6)"', 'defaults.NB = "min(NP, 7)"'))
        self.assertIn("return std::min(np, 7);", readouts_cpp.cpp_source(table))
        self.assertIn("set(DTOF_DEFAULT_NB_pifh 3 4 5 6 7 7", generate.cmake(table, LIMITS))

    def test_a_new_parameter_is_in_the_lists_of_c_plus_plus(self):
        new = 'SPREAD = { default = 3, help = "bins of the spread" }\nSPREAD_PORTS = { default = 1, help = "ports" }\nTIME_GATE = {'
        text = TEXT.replace("TIME_GATE = {", new, 1).replace('"WINDOW_CENTRED", "POINTER_PORTS"', '"WINDOW_CENTRED", "SPREAD", "SPREAD_PORTS", "POINTER_PORTS"')
        text = text.replace('"COUNT_WIDTH", "WINDOW_CENTRED"]', '"COUNT_WIDTH", "WINDOW_CENTRED", "SPREAD"]')
        table = readouts.parse(text)
        self.assertIn('entry<&ReadoutParameters::spread>("SPREAD",\n        "bins of the spread",\n        ""),', readouts_cpp.parameter_table(table, LIMITS))
        self.assertNotIn("spread_ports", readouts_cpp.parameter_table(table, LIMITS))  # changes no result
        self.assertIn('{"SPREAD", true, false},\n    {"SPREAD_PORTS", true, false},', readouts_cpp.rtl_parameters(table))

    def test_members_of_the_models(self):
        members = readouts_cpp.model_members(readouts.parse(TEXT))
        self.assertEqual(members["NP"], "ReadoutParameters::np")
        self.assertEqual(members["COUNT_WIDTH"], "ReadoutParameters::count_width")
        self.assertEqual(members["CELL_SHIFT"], "PoolPointerParameters::cell_shift")
        self.assertEqual(members["ADVANTAGE_WIDTH"], "PoolPointerParameters::count_bits")
        for name in ("SRAM_NUM", "POINTER_PORTS", "TIME_GATE", "ACQ_WIDTH", "BROADCAST_STAGES"):
            self.assertNotIn(name, members)

    def test_bad_descriptions_are_refused(self):
        for change, message in (
            (("number = 6", "number = 5"), "each once"),
            (("number = 6", "number = 9"), "numbers must be"),
            (('kind = "pool"', 'kind = "puddle"'), "kind 'puddle'"),
            (('choices = ["COUNT_WIDTH"]', 'choices = ["COUNTS"]'), "unknown parameter COUNTS"),
            (('top = "dtof_pool_pointer_array"', 'top = "nowhere"'), "no top 'nowhere'"),
            (('column = "dtof_ez_pointer_column"\n', ""), "have a number and a column"),
            (("number = 0\n", ""), "have a number and a column"),
            (('word = "moved"', 'word = "stirred"'), "the word 'stirred'"),
            (("passes = 0", "passages = 0"), "passages"),
            (('"NP / 2"', '"NQ / 2"'), "no expression"),
        ):
            with self.subTest(change=change), self.assertRaisesRegex(FlowError, message):
                readouts.parse(TEXT.replace(*change, 1))

    def test_parameters_of_the_tops_are_compared(self):
        table = readouts.load()
        text = (ROOT / "hdl/thesis/dtof_array.sv").read_text()
        self.assertEqual(generate.check_top("dtof_array", text, table), [])
        self.assertEqual(
            generate.check_top("dtof_array", text.replace("COUNT_WIDTH = 10,", "COUNT_WIDTH = 11,"), table),
            ["COUNT_WIDTH is 11 in hdl/thesis/dtof_array.sv, 10 in readouts.toml"],
        )
        self.assertEqual(
            generate.check_top("dtof_array", text.replace("parameter int SLOTS", "parameter int SLOT"), table),
            ["SLOT is only in hdl/thesis/dtof_array.sv", "SLOTS is only in readouts.toml"],
        )


class Guide(unittest.TestCase):
    def test_the_guide_shows_the_files_that_are_added(self):
        guide = (ROOT / "docs/user/adding_a_readout.md").read_text(encoding="utf-8")
        files = sorted((ROOT / "docs/user/adding_a_readout").iterdir())
        self.assertEqual(len(files), 3)
        for file in files:
            self.assertIn("\n" + file.read_text(encoding="utf-8").strip("\n") + "\n```\n", guide, file.name)


if __name__ == "__main__":
    unittest.main()
