# SPDX-License-Identifier: Apache-2.0
"""What confirms the reports of the synthesis: changes of the RTL that alter no logic, and changes that do, each planted in a copy of hdl/."""

import shutil
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import configuration, elaborated, library, mapping, standard_cells, subsystem
from dtof_synth.configuration import Configuration
from dtof_synth.sram_model import Size
from dtof_synth.technology import Technology

from .partial import part_of
from .small_results import ROOT

NAMED = configuration.load(ROOT / "configurations.toml")
POINTER = NAMED["ezpointer"].with_parameters("ezpointer", SRAM_NUM=2, PIXELS_PER_SRAM=3)
POOL = NAMED["poolpointer_lean"].with_parameters("poolpointer_lean", SRAM_NUM=4, ENGINE_COLUMNS=4)


class Planted(unittest.TestCase):
    """Changes in a copy of hdl/, elaborated by Yosys."""

    known: dict[str, str] = {}  # digests of hdl/ as it is

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        shutil.copytree(ROOT / "hdl", self.root / "hdl")
        (self.root / "synth").symlink_to(ROOT / "synth")

    def digest(self, item: Configuration = POINTER) -> str:
        return elaborated.digest(elaborated.elaborate(item, self.root, self.root / "elaborated"))

    def plant(self, name: str, old: str, new: str) -> None:
        path = self.root / "hdl" / name
        text = path.read_text(encoding="utf-8")
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1), encoding="utf-8")

    def unchanged(self, item: Configuration = POINTER) -> str:
        if item.name not in self.known:
            with tempfile.TemporaryDirectory() as folder:
                self.known[item.name] = elaborated.digest(elaborated.elaborate(item, ROOT, Path(folder)))
        return self.known[item.name]

    def test_comments_assertions_and_waivers_alter_nothing(self) -> None:
        self.plant("thesis/dtof_pointer_update.sv", "module dtof_pointer_update", "// A comment.\n" * 20 + "module dtof_pointer_update")
        self.plant("thesis/dtof_pointer_update.sv", "  logic low_equal", "  // verilator lint_off WIDTH\n\n  logic low_equal")
        self.plant("thesis/dtof_controller.sv", "  `DTOF_ASSERT(", '  `DTOF_ASSERT(a_new, !stream_o || final_o,\n    "planted")\n  `DTOF_ASSERT(')
        self.assertEqual(self.digest(), self.unchanged())

    def test_an_assertion_before_calls_of_functions_alters_nothing(self) -> None:
        self.plant("pool/dtof_pool_sequencer.sv", "  function automatic", '  `DTOF_ASSERT(a_new, rst_ni,\n    "planted")\n\n  function automatic')
        self.assertEqual(self.digest(POOL), self.unchanged(POOL))

    def plant_parameter(self, default: int) -> None:
        for name in ("dtof_array", "dtof_pointer_update"):
            self.plant(f"thesis/{name}.sv", "    parameter int NP = 10,", f"    parameter int NP = 10,\n    parameter int EXTRA = {default},")
        self.plant("thesis/dtof_pointer_update.sv", "assign up = pointer_i + step;", "assign up = (EXTRA != 0) ? pointer_i : pointer_i + step;")

    def test_a_parameter_whose_default_changes_nothing_alters_nothing(self) -> None:
        self.plant_parameter(0)
        self.assertEqual(self.digest(POINTER.with_parameters("ezpointer", EXTRA=0)), self.unchanged())

    def test_a_further_name_of_an_output_alters_nothing(self) -> None:
        self.plant("thesis/dtof_controller.sv", "assign done_o = done_q;", "logic finished;\n  assign finished = done_q;\n  assign done_o = finished;")
        self.assertEqual(self.digest(), self.unchanged())

    def test_another_name_of_a_register_is_found(self) -> None:  # ABC's result depends on names
        path = self.root / "hdl/thesis/dtof_controller.sv"
        path.write_text(path.read_text(encoding="utf-8").replace("start_q", "began_q"), encoding="utf-8")
        self.assertNotEqual(self.digest(), self.unchanged())

    def test_a_parameter_with_an_effect_is_found(self) -> None:
        self.plant_parameter(1)
        self.assertNotEqual(self.digest(), self.unchanged())

    def test_another_step_is_found(self) -> None:
        self.plant("thesis/dtof_pointer_update.sv", "confidence_i + 1'b1", "confidence_i + 2'd2")
        self.assertNotEqual(self.digest(), self.unchanged())

    def test_another_value_of_a_parameter_is_found(self) -> None:
        self.assertNotEqual(self.digest(POINTER.with_parameters("ezpointer", BROADCAST_STAGES=3)), self.unchanged())

    def test_a_kept_register_is_found(self) -> None:
        self.plant("thesis/dtof_controller.sv", "  logic [ACQ_WIDTH-1:0] acq_num_q;", "  (* keep *) logic [ACQ_WIDTH-1:0] acq_num_q;")
        self.assertNotEqual(self.digest(), self.unchanged())


class AsTheFlow(unittest.TestCase):
    """The netlists are those from which the flow goes on."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        liberty = self.folder / "slow.lib"
        liberty.write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        self.technology = part_of(Technology, root=ROOT, slow=library.read(liberty), target_mhz=330.0)

    def test_of_an_array(self) -> None:
        mapping.elaborate(POINTER, self.technology, self.folder / "flow")
        self.assertEqual(elaborated.elaborate(POINTER, ROOT, self.folder / "own"), (self.folder / "flow/elaborated.il").read_text(encoding="utf-8"))

    def test_of_the_subsystem(self) -> None:
        subsystem.generic(POINTER, self.technology, self.folder / "flow")
        self.assertEqual(elaborated.elaborate(POINTER, ROOT, self.folder / "own", whole_subsystem=True),
                         (self.folder / "flow/elaborated.il").read_text(encoding="utf-8"))


class Described(unittest.TestCase):
    def test_parameters_that_the_flow_reads_are_printed(self) -> None:
        names = elaborated.read_by_the_flow(ROOT, "synth")
        self.assertLessEqual({"NP", "SRAM_NUM", "PIXELS_PER_SRAM", "SLOTS", "ENGINE_COLUMNS", "SIGNALLED_CLEAR"}, set(names))
        self.assertFalse({"POINTER_STEP", "WINDOW_CENTRED"} & set(names))  # which enter by elaboration alone
        line = elaborated.described(POINTER, names)
        self.assertEqual(elaborated.described(POINTER.with_parameters("ezpointer", WINDOW_CENTRED=1), names), line)
        self.assertNotEqual(elaborated.described(POINTER.with_parameters("ezpointer", SLOTS=3), names), line)
        self.assertIn('"memories": {"pointer": "sram_1r1w_3x14"}', line)

    def test_what_the_module_of_configurations_derives_is_printed(self) -> None:
        found = elaborated.derived(POOL)
        self.assertLessEqual({"engines", "column_modules", "pixels", "memories", "engine_memories", "counted_macros", "bits_per_pixel",
                              "pool_word_width"}, set(found))
        self.assertEqual(elaborated.derived(POINTER)["pool_word_width"], "none")
        line = elaborated.described(POOL, [])
        wider = {"messages": Size(1, POOL["PIXELS_PER_SRAM"], 99)}
        with mock.patch.object(configuration, "engine_memories", autospec=True, return_value=wider) as planted:
            planted.__module__ = configuration.__name__
            self.assertNotEqual(elaborated.described(POOL, []), line)
        with mock.patch.object(Configuration, "column_modules", property(lambda item: 7)):
            self.assertNotEqual(elaborated.described(POOL, []), line)

    def test_every_configuration_of_a_report_is_among_its_netlists(self) -> None:
        found = {report: [item.name for item in chosen(NAMED)] for report, chosen in elaborated.REPORTS.items()}
        self.assertLessEqual({*NAMED, "fifh_clear1_pixels4"}, set(found["synth"]))
        self.assertIn("poolpointer_lean_small", found["power"])
        self.assertEqual(found["subsystem"], list(subsystem.CONFIGURATIONS))
        for report, names in found.items():
            self.assertEqual(len(names), len(set(names)), report)


if __name__ == "__main__":
    unittest.main()
