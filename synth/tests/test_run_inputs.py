# SPDX-License-Identifier: Apache-2.0
"""Which results are kept after an edit. Each edit is planted in a copy of RTL, constraints, flow and libraries; runs only count themselves."""

import shutil
import tempfile
import unittest
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import batch, configuration, library, run_inputs, sram_kit, sram_model, standard_cells
from dtof_synth.configuration import Configuration
from dtof_synth.sram_model import Macro, Size
from dtof_synth.technology import Technology, needed_sizes

from . import counted_runs
from .partial import part_of
from .small_results import ROOT

NAMED = configuration.load(ROOT / "configurations.toml")
PLAIN = NAMED["ezpointer"].with_parameters("plain", SRAM_NUM=2, PIXELS_PER_SRAM=3)
PARITY = PLAIN.with_parameters("parity", PARITY=1)
POOL = NAMED["poolpointer_lean"].with_parameters("pool", SRAM_NUM=4, ENGINE_COLUMNS=4)
ALL = ["parity", "plain", "pool"]
COPIED = ("hdl", "constraints", "synth/yosys", "synth/sta", "synth/dtof_synth")


class Edited(unittest.TestCase):
    """A copy of all that a run reads. Its results are kept before each test."""

    netlists: dict[str, str] = {}  # digests without an edit

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name in COPIED:
            shutil.copytree(ROOT / name, self.root / name, ignore=shutil.ignore_patterns("__pycache__"))
        (self.root / "reports").mkdir()
        shutil.copy(ROOT / "reports" / "reports.toml", self.root / "reports")
        self.items: list[Configuration] = [PLAIN, PARITY, POOL]
        self.write_kit()
        for corner in standard_cells.CORNERS:
            (self.root / f"{corner.name}.lib").write_text(standard_cells.library(corner), encoding="utf-8")
        cells = {corner.name: part_of(library.Library, path=self.root / f"{corner.name}.lib") for corner in standard_cells.CORNERS}
        self.technology = part_of(Technology, root=self.root, kit=self.root / "kit", target_mhz=330.0, **cells)
        if not self.netlists:
            self.netlists.update((item.name, run_inputs.netlist(item, self.technology, self.root / item.name)) for item in self.items)
        with self.same_rtl():
            self.assertEqual(self.ran(), ALL)
            self.assertEqual(self.ran(), [])

    def write_kit(self, *more: Size, macro_of=sram_model.macro) -> None:
        sram_kit.write_kit(self.root / "kit", [*needed_sizes(self.items), *more], macro_of)

    @contextmanager
    def same_rtl(self) -> Iterator[None]:
        """Without another elaboration."""
        with mock.patch.object(run_inputs, "netlist", lambda item, *_: self.netlists[item.name]):
            yield

    def ran(self, technology: Technology | None = None) -> list[str]:
        """Configurations whose results are not kept."""
        jobs = [batch.Job(item) for item in self.items]
        return sorted(counted_runs.run_all(jobs, technology or self.technology, self.root / "runs", lambda _: None)[1])

    def plant(self, name: str, old: str, new: str) -> None:
        path = self.root / name
        text = path.read_text(encoding="utf-8")
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1), encoding="utf-8")


class Rtl(Edited):
    def test_a_comment_an_assertion_and_a_line_keep_all(self) -> None:
        self.plant("hdl/thesis/dtof_pointer_update.sv", "module dtof_pointer_update", "// A comment.\n\n" * 20 + "module dtof_pointer_update")
        self.plant("hdl/thesis/dtof_controller.sv", "  `DTOF_ASSERT(", '  `DTOF_ASSERT(a_new, !stream_o || final_o,\n    "planted")\n  `DTOF_ASSERT(')
        self.assertEqual(self.ran(), [])

    def test_another_logic_runs_what_has_it(self) -> None:
        self.plant("hdl/thesis/dtof_pointer_update.sv", "confidence_i + 1'b1", "confidence_i + 2'd2")
        self.assertEqual(self.ran(), ["parity", "plain"])

    def test_logic_of_one_configuration_runs_this_one(self) -> None:
        self.plant("hdl/common/dtof_parity_sram.sv", "^write_data_i[", "~^write_data_i[")
        self.assertEqual(self.ran(), ["parity"])

    def test_another_name_runs_what_has_it(self) -> None:  # ABC's result depends on names
        self.plant("hdl/common/dtof_parity_sram.sv", "logic read_q, error_q", "logic seen_q, error_q")
        path = self.root / "hdl/common/dtof_parity_sram.sv"
        path.write_text(path.read_text(encoding="utf-8").replace("read_q", "seen_q"), encoding="utf-8")
        self.assertEqual(self.ran(), ["parity"])

    def test_another_value_of_a_parameter_runs_its_configuration(self) -> None:
        self.items[0] = PLAIN.with_parameters("plain", BROADCAST_STAGES=3)
        self.assertEqual(self.ran(), ["plain"])


class OtherInputs(Edited):
    def setUp(self) -> None:
        super().setUp()
        self.enterContext(self.same_rtl())

    def test_a_title_keeps_all(self) -> None:
        self.items[0] = replace(PLAIN, title="Another title", note="a note")
        self.assertEqual(self.ran(), [])

    def test_what_python_reads_of_a_configuration_is_an_input(self) -> None:
        self.items[0] = PLAIN.with_parameters("plain", SLOTS=PLAIN["SLOTS"] + 1)
        self.assertEqual(self.ran(), ["plain"])

    def test_a_source_of_the_flow_runs_all(self) -> None:
        for name, old in (("constraints/dtof.sdc", "set setup_uncertainty 0.10"), ("synth/yosys/4_map.tcl", "setundef -zero"),
                          ("synth/sta/resize.tcl", "proc "), ("synth/dtof_synth/floorplan.py", "REPEATER_UM = 400.0")):
            with self.subTest(name):
                self.plant(name, old, f"{old}1" if old[-1].isdigit() else f"set planted 1\n{old}")
                self.assertEqual(self.ran(), ALL)
                self.assertEqual(self.ran(), [])

    def test_a_comment_in_the_flow_and_a_source_that_no_run_uses_keep_all(self) -> None:
        self.plant("constraints/dtof.sdc", "set setup_uncertainty", "# A comment.\nset setup_uncertainty")
        self.plant("synth/dtof_synth/technology.py", "\nTARGET_MHZ", "\n# A comment.\nTARGET_MHZ")
        self.plant("synth/dtof_synth/report.py", "from __future__", "import os\nfrom __future__")
        self.assertEqual(self.ran(), [])

    def test_a_library_of_cells_runs_all(self) -> None:
        for corner in standard_cells.CORNERS:
            with self.subTest(corner.name):
                self.plant(f"{corner.name}.lib", "area : ", "area : 1")
                self.assertEqual(self.ran(), ALL)

    def test_another_clock_runs_all(self) -> None:
        self.assertEqual(self.ran(part_of(Technology, **{**vars(self.technology), "target_mhz": 250.0})), ALL)

    def test_an_sram_runs_the_configuration_that_has_it(self) -> None:
        own = next(iter(configuration.memories(PARITY).values()))

        def slower(size: Size) -> Macro:
            found = sram_model.macro(size)
            return replace(found, access_slow=found.access_slow + 0.1) if size == own else found

        self.write_kit(macro_of=slower)
        self.assertEqual(self.ran(), ["parity"])

    def test_another_sram_keeps_all(self) -> None:
        self.write_kit(Size(1, 99, 17))
        self.assertIn("99x17", (self.root / "kit" / "sram40_slow.lib").read_text(encoding="utf-8"))
        self.assertEqual(self.ran(), [])


class Parts(Edited):
    def test_the_libraries_of_the_srams_have_what_is_said_of_one_and_their_units(self) -> None:
        text = (self.root / "kit" / "sram40_slow.lib").read_text(encoding="utf-8")
        size = next(iter(configuration.memories(PLAIN).values()))
        found = run_inputs.srams(text, {size.name})
        alone = sram_kit.liberty([sram_model.macro(size)], standard_cells.SLOW)
        self.assertEqual(found, run_inputs.srams(alone, {size.name}))
        self.assertEqual(found.count("  cell ("), 1)
        self.assertIn("time_unit", found)

    def test_every_file_and_name_is_in_the_digest_of_everything(self) -> None:
        def digest(flow: str = "flow") -> str:
            with mock.patch.object(run_inputs.report_inputs, "flow_digest", return_value=flow):
                return run_inputs.everything(self.technology)

        found = [digest(), digest("other")]
        for path in (self.root / "kit" / "sram40.lef", self.technology.typical.path, self.technology.slow.path):
            path.write_text("changed", encoding="utf-8")
            found.append(digest())
        (self.root / "kit" / "sram40.lef").rename(self.root / "kit" / "other.lef")
        found.append(digest())
        self.assertEqual(len(set(found)), len(found))
        self.assertEqual(digest(), found[-1])


if __name__ == "__main__":
    unittest.main()
