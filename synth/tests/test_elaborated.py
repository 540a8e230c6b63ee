# SPDX-License-Identifier: Apache-2.0
"""What confirms the reports of the synthesis: changes of the RTL that alter no logic, and changes that do, each planted in a copy of hdl/."""

import shutil
import tempfile
import unittest
from pathlib import Path

from dtof_synth import configuration, elaborated, library, run, standard_cells, subsystem
from dtof_synth.configuration import Configuration
from dtof_synth.errors import FlowError
from dtof_synth.run import Technology

from .partial import part_of
from .small_results import ROOT

NAMED = configuration.load(ROOT / "configurations.toml")
POINTER = NAMED["ezpointer"].with_parameters("ezpointer", SRAM_NUM=2, PIXELS_PER_SRAM=3)
POOL = NAMED["poolpointer_lean"].with_parameters("poolpointer_lean", SRAM_NUM=4, ENGINE_COLUMNS=4)

NETLIST = """autoidx 1000000
attribute \\dynports 1
attribute \\always_ff 1
module $paramod$0123\\adder
  parameter \\WIDTH 8
  attribute \\wiretype "\\\\sent_t"
  wire width 8 input 1 \\a_i
  wire width 8 output 2 \\y_o
  wire width 8 \\sum
  cell $add $cell000000
    parameter \\A_SIGNED 0
    parameter \\A_WIDTH 8
    parameter \\B_SIGNED 0
    parameter \\B_WIDTH 8
    parameter \\Y_WIDTH 8
    connect \\A \\a_i
    connect \\B \\a_i
    connect \\Y \\sum
  end
  cell $not $cell000001
    parameter \\A_SIGNED 0
    parameter \\A_WIDTH 8
    parameter \\Y_WIDTH 8
    connect \\A \\sum
    connect \\Y \\y_o
  end
end
attribute \\top 1
module $paramod$4567\\dtof_array
  wire width 8 input 1 \\a_i
  wire width 8 output 2 \\y_o
  wire width 8 \\first
  cell $paramod$0123\\adder \\u_adder
    connect \\a_i \\a_i
    connect \\y_o \\first
  end
  cell $paramod$0123\\adder \\u_next
    connect \\a_i \\first
    connect \\y_o \\y_o
  end
end
"""


class Digests(unittest.TestCase):
    """Digests of a netlist of two modules."""

    def same(self, *changes: tuple[str, str]) -> bool:
        text = NETLIST
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        return elaborated.digest(text) == elaborated.digest(NETLIST)

    def test_what_has_no_logic_does_not_count(self) -> None:
        self.assertTrue(self.same(("0123", "cdef")))  # Yosys's digest of parameters
        self.assertTrue(self.same(("$paramod$0123\\adder", "$paramod\\adder\\WIDTH=8"), ("  parameter \\WIDTH 8\n", "  parameter \\N 1\n")))
        self.assertTrue(self.same(("attribute \\dynports 1\n", ""), ('  attribute \\wiretype "\\\\sent_t"\n', "")))
        self.assertTrue(self.same(("autoidx 1000000", "autoidx 2"), ("$cell000000", "$cell000009")))

    def test_names_of_nets_and_what_drives_nothing_do_not_count(self) -> None:
        self.assertTrue(self.same(("\\sum", "\\result"), ("\\first", "\\between")))
        self.assertTrue(self.same(("  wire width 8 \\sum\n", "  wire width 8 \\sum\n  wire width 8 \\also\n"),
                                  ("    connect \\A \\sum\n", "    connect \\A \\also\n"),
                                  ("  cell $not", "  connect \\also \\sum\n  cell $not")))
        unused = "  cell $not $cell000002\n    parameter \\A_SIGNED 0\n    parameter \\A_WIDTH 8\n    parameter \\Y_WIDTH 8\n    connect \\A \\sum\n    connect \\Y \\other\n  end\n"
        self.assertTrue(self.same(("  wire width 8 \\sum\n", "  wire width 8 \\sum\n  wire width 8 \\other\n"),
                                  ("  cell $not", f"{unused}  cell $not")))

    def test_the_order_of_modules_does_not_count(self) -> None:
        head, top = NETLIST.split("attribute \\top 1\n")
        self.assertEqual(elaborated.digest("attribute \\top 1\n" + top + head), elaborated.digest(NETLIST))

    def test_logic_counts_in_the_top_and_below(self) -> None:
        self.assertFalse(self.same(("cell $add", "cell $sub")))
        self.assertFalse(self.same(("_SIGNED 0", "_SIGNED 1")))
        self.assertFalse(self.same(("attribute \\always_ff 1\n", "attribute \\always_ff 1\nattribute \\keep 1\n")))
        self.assertFalse(self.same(("  wire width 8 \\sum\n", "  attribute \\keep 1\n  wire width 8 \\sum\n")))
        self.assertFalse(self.same(("\\adder", "\\subtractor")))
        self.assertFalse(self.same(("\\u_next", "\\u_last")))  # the flow names instances
        with self.assertRaisesRegex(FlowError, "no top"):
            self.same(("attribute \\top 1\n", ""))

    def test_connections_count(self) -> None:
        self.assertFalse(self.same(("    connect \\B \\a_i\n", "    connect \\B \\sum\n")))
        self.assertFalse(self.same(("    connect \\a_i \\first\n", "    connect \\a_i \\a_i\n")))
        self.assertFalse(self.same(("    connect \\A \\sum\n", "    connect \\A { \\sum [6:0] \\sum [7] }\n")))  # rotated
        self.assertFalse(self.same(("    connect \\B \\a_i\n", "    connect \\B 8'00000001\n")))

    def test_a_difference_many_cells_away_counts(self) -> None:
        def chain(last: str) -> str:
            nets = [f"\\n{i}" for i in range(40)]
            one = "    parameter \\A_SIGNED 0\n    parameter \\A_WIDTH 1\n    parameter \\Y_WIDTH 1\n"
            cells = [f"  cell $not $c{i}\n{one}    connect \\A {a}\n    connect \\Y {y}\n  end\n"
                     for i, (a, y) in enumerate(zip(["\\a_i", *nets], [*nets, "\\y_o"], strict=True))]
            wires = "".join(f"  wire {net}\n" for net in nets)
            two = one + "    parameter \\B_SIGNED 0\n    parameter \\B_WIDTH 1\n"
            tap = f"  cell $and $tap\n{two}    connect \\A {last}\n    connect \\B \\a_i\n    connect \\Y \\z_o\n  end\n"
            return ("attribute \\top 1\nmodule \\chain\n  wire input 1 \\a_i\n  wire output 2 \\y_o\n  wire output 3 \\z_o\n"
                    f"{wires}{''.join(cells)}{tap}end\n")
        self.assertNotEqual(elaborated.digest(chain("\\n30")), elaborated.digest(chain("\\n31")))


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
        before = elaborated.elaborate(POOL, self.root, self.root / "before")
        self.plant("pool/dtof_pool_sequencer.sv", "  function automatic", '  `DTOF_ASSERT(a_new, rst_ni,\n    "planted")\n\n  function automatic')
        after = elaborated.elaborate(POOL, self.root, self.root / "after")
        self.assertNotEqual(before, after)  # names of variables in functions keep the line of the call
        self.assertEqual(elaborated.digest(before), elaborated.digest(after))

    def plant_parameter(self, default: int) -> None:
        for name in ("dtof_array", "dtof_pointer_update"):
            self.plant(f"thesis/{name}.sv", "    parameter int NP = 10,", f"    parameter int NP = 10,\n    parameter int EXTRA = {default},")
        self.plant("thesis/dtof_pointer_update.sv", "assign up = pointer_i + step;", "assign up = (EXTRA != 0) ? pointer_i : pointer_i + step;")

    def test_a_parameter_whose_default_changes_nothing_alters_nothing(self) -> None:
        self.plant_parameter(0)
        self.assertEqual(self.digest(POINTER.with_parameters("ezpointer", EXTRA=0)), self.unchanged())

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
        run.elaborate(POINTER, self.technology, self.folder / "flow")
        self.assertEqual(elaborated.elaborate(POINTER, ROOT, self.folder / "own"), (self.folder / "flow/elaborated.il").read_text(encoding="utf-8"))

    def test_of_the_subsystem(self) -> None:
        subsystem.generic(POINTER, self.technology, self.folder / "flow")
        self.assertEqual(elaborated.elaborate(POINTER, ROOT, self.folder / "own", whole_subsystem=True),
                         (self.folder / "flow/elaborated.il").read_text(encoding="utf-8"))


class Described(unittest.TestCase):
    def test_parameters_that_the_flow_reads_are_printed(self) -> None:
        names = elaborated.read_by_the_flow(ROOT)
        self.assertLessEqual({"NP", "SRAM_NUM", "PIXELS_PER_SRAM", "SLOTS", "ENGINE_COLUMNS", "SIGNALLED_CLEAR"}, set(names))
        self.assertFalse({"BROADCAST_STAGES", "WINDOW_CENTRED"} & set(names))  # which enter by elaboration alone
        line = elaborated.described(POINTER, names)
        self.assertEqual(elaborated.described(POINTER.with_parameters("ezpointer", BROADCAST_STAGES=3), names), line)
        self.assertNotEqual(elaborated.described(POINTER.with_parameters("ezpointer", SLOTS=3), names), line)
        self.assertIn('"memories": {"pointer": "sram_1r1w_3x14"}', line)

    def test_every_configuration_of_a_report_is_among_its_netlists(self) -> None:
        found = {report: [item.name for item in chosen(NAMED)] for report, chosen in elaborated.REPORTS.items()}
        self.assertLessEqual({*NAMED, "fifh_clear1_pixels4"}, set(found["synth"]))
        self.assertIn("poolpointer_lean_small", found["power"])
        self.assertEqual(found["subsystem"], list(subsystem.CONFIGURATIONS))
        for report, names in found.items():
            self.assertEqual(len(names), len(set(names)), report)


if __name__ == "__main__":
    unittest.main()
