# SPDX-License-Identifier: Apache-2.0
"""What elaboration and mapping ask of Yosys and ABC. The tools are replaced."""

import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import configuration, library, mapping
from dtof_synth.errors import FlowError
from dtof_synth.sram_model import Size
from dtof_synth.technology import Technology

from .partial import part_of
from .small_results import ROOT

NAMED = configuration.load(ROOT / "configurations.toml")


class Mapping(unittest.TestCase):
    TECHNOLOGY = part_of(Technology, root=ROOT, target_mhz=330.0, slow=part_of(
        library.Library, inverter="INV_X1", input_ff={"INV_X1": {"A": 1.5}}, path=Path("slow.lib"), tie={"0": ("TIE0", "Y"), "1": ("TIE1", "Y")}))

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def settings(self, name: str, effort: int, naming: int = 0, foreign: frozenset = frozenset()) -> dict:
        (self.folder / "mapped.json").write_text("{}", encoding="utf-8")
        with mock.patch.object(mapping.tools, "write_settings") as written, mock.patch.object(mapping.tools, "run_yosys") as self.yosys, \
                mock.patch.object(mapping.netlist, "rename_parts"), mock.patch.object(mapping.netlist, "foreign_cells", return_value=foreign) as self.cells:
            mapping.map_to_cells(NAMED[name], self.TECHNOLOGY, self.folder, mapping.efforts(NAMED[name])[effort], naming)
        return written.call_args.args[1]

    def test_abc_gets_its_share_of_the_period(self) -> None:
        # 330 MHz are 3030.3 ps.
        for name, shares in (("ezpointer", (0.62, 0.62, 0.55)), ("poolpointer", (0.68, 0.68, 0.68))):
            self.assertEqual(len(mapping.efforts(NAMED[name])), len(shares))
            for effort, share in enumerate(shares):
                self.assertEqual(self.settings(name, effort)["abc_period_ps"], f"{3030.303 * share:.0f}")

    def test_logic_drives_four_inverters_and_is_mapped_with_the_slow_library(self) -> None:
        settings = self.settings("ezpointer", 0, naming=3)
        self.assertEqual((self.folder / "abc.constr").read_text(encoding="utf-8"), "set_driving_cell INV_X1\nset_load 6.000 [all_outputs]\n")
        found = {name: settings[name] for name in ("liberty", "naming", "tie_low", "tie_high", "generic_netlist")}
        self.assertEqual(found, {"liberty": Path("slow.lib"), "naming": "3", "tie_low": ["TIE0", "Y"], "tie_high": ["TIE1", "Y"],
                                 "generic_netlist": self.folder / "generic.il"})
        self.assertEqual(self.yosys.call_args.args[0], ROOT / "synth/yosys/map.tcl")

    def test_a_cell_that_is_not_of_the_library_stops_the_flow(self) -> None:
        with self.assertRaisesRegex(FlowError, "poolpointer: unmapped cells in the netlist: a, b"):
            self.settings("poolpointer", 0, foreign=frozenset("ba"))
        self.assertEqual(self.cells.call_args.args[2], {"sram_1rw_100x232_8p", "sram_1rw_160x33"})

    def test_elaboration_sees_the_memories_of_this_configuration_alone(self) -> None:
        with mock.patch.object(mapping.sram_kit, "write_rtl_views", return_value=["boxes", "one", "two"]) as views, \
                mock.patch.object(mapping.tools, "write_settings") as written, mock.patch.object(mapping, "to_generic") as generic, \
                mock.patch.object(mapping.clock_gating, "insert") as gates:
            mapping.elaborate(NAMED["poolpointer"], self.TECHNOLOGY, self.folder / "new", ["part"])
        self.assertEqual(views.call_args.args[1], [Size(1, 100, 232, 8), Size(1, 160, 33)])
        settings = written.call_args.args[1]
        self.assertEqual((settings["black_boxes"], settings["technology_files"], settings["kept_modules"]), ("boxes", ["one", "two"], ["*part*"]))
        self.assertEqual((settings["top"], settings["parameters"]), (NAMED["poolpointer"].top, NAMED["poolpointer"].rtl_parameters()))
        self.assertEqual(generic.call_args.args[0], ROOT)
        self.assertEqual(gates.call_args.args, (self.folder / "new" / "generic.il", self.TECHNOLOGY.slow))


if __name__ == "__main__":
    unittest.main()
