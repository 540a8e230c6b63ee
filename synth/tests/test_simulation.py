# SPDX-License-Identifier: Apache-2.0
"""The benches of make sim-icarus and make sim-netlist pass what is right and fail for every planted fault."""

import copy
import re
import shutil
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

from dtof_synth import configuration, floorplan, netlist, simulation, sram_kit, technology
from dtof_synth.errors import FlowError
from dtof_synth.mapping import efforts, elaborate, map_to_cells
from dtof_synth.technology import Technology

ROOT = Path(__file__).resolve().parents[2]
NAMED = configuration.load(ROOT / "configurations.toml")
SEED = 1


def copy_project(folder: Path) -> Path:
    """RTL, flow and benches in a folder of their own, to plant faults in."""
    for part in ("hdl", "synth"):
        shutil.copytree(ROOT / part, folder / part)
    (folder / simulation.VECTORS).parent.mkdir(parents=True)
    (folder / simulation.VECTORS).symlink_to(ROOT / simulation.VECTORS)
    return folder


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    if old not in text:
        raise AssertionError(f"{path.name} has no '{old}'")
    path.write_text(text.replace(old, new), encoding="utf-8")


def short(case: simulation.Case, *frames: int) -> simulation.Case:
    return replace(case, frames=frames or (9, 0, 1, 2, 12))


# File, text, what replaces it, and what the bench must say. Of ezPointer's array.
RTL_FAULTS = (
    ("thesis/dtof_pointer_update.sv", "left ? down : up", "left ? up : down", "the model: "),
    ("thesis/dtof_result_output.sv", "= valid_q && tready_i;", "= valid_q;", "changed before tready"),
    ("thesis/dtof_result_output.sv", "      valid_q <= 1'b0;\n      arrives_q", "      arrives_q", "control output is X"),
    ("thesis/dtof_result_register.sv", "if (load_i)", "if (load_i && 1'b0)", "valid result is X"),
    ("thesis/dtof_result_output.sv", "last_row_i && last_column;", "last_column;", "tlast 1; the model: .* tlast 0"),
    ("thesis/dtof_result_output.sv", "tdata_o = {column_q, row_i, result}", "tdata_o = {column_q, ~row_i, result}",
     "the model: "),
    ("thesis/dtof_pixel_sequencer.sv", "tdc_ready_o = active_q || at_start", "tdc_ready_o = at_start",
     "fell inside an acquisition"),
    ("thesis/dtof_pixel_sequencer.sv", "!active_q && more_i;", "!active_q;", "an acquisition too many"),
    ("thesis/dtof_controller.sv", "(state_q == dtof_pkg::STATE_M5) && (state_d", "(state_d", "done_o after 0 acq"),
    ("thesis/dtof_controller.sv", "busy_o = start_q || ", "busy_o = ", "busy_o fell"),
    ("thesis/dtof_controller.sv", "if (scan_last_row_i) begin", "if (scan_last_row_i && 1'b0) begin", "a result too many"),
    ("thesis/dtof_controller.sv", "accept = start_i && !busy_o;", "accept = start_i;", "an acquisition too many"),
    ("thesis/dtof_controller.sv", "accept = start_i && !busy_o;", "accept = start_i && (!busy_o || done_q);",
     "between frames"),
    ("thesis/dtof_pixel_sequencer.sv", "idle_o = (drain_q == '0)", "idle_o = 1'b0", "nothing taken or sent"),
    ("thesis/dtof_result_output.sv", "always_ff @(posedge clk_i or negedge rst_ni)", "always_ff @(posedge clk_i)",
     "control output is X"),
)


class RtlBench(unittest.TestCase):
    def test_what_is_right_passes(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            case = short(simulation.rtl_case(NAMED["ezpointer"], SEED))
            found = simulation.simulate(case, ROOT, Path(folder))
            pixels = case.configuration["SRAM_NUM"] * case.configuration["PIXELS_PER_SRAM"]
            self.assertEqual(found.frames, len(case.frames))
            self.assertGreaterEqual(found.results, pixels * len(case.frames))

    def test_every_planted_fault_is_seen(self) -> None:
        with tempfile.TemporaryDirectory() as temporary:
            root = copy_project(Path(temporary) / "project")
            # The bench alone must see them, not the assertions of the RTL.
            macros = root / "hdl" / "common" / "dtof_macros.svh"
            macros.write_text("`define SYNTHESIS\n" + macros.read_text(encoding="utf-8"), encoding="utf-8")
            case = short(simulation.rtl_case(NAMED["ezpointer"], SEED))
            for name, old, new, message in RTL_FAULTS:
                path = root / "hdl" / name
                original = path.read_text(encoding="utf-8")
                edit(path, old, new)
                with self.subTest(file=name, fault=new), self.assertRaisesRegex(FlowError, message):
                    simulation.simulate(case, root, Path(temporary) / "run")
                path.write_text(original, encoding="utf-8")

    def test_assertions_of_the_rtl_are_failures(self) -> None:
        with tempfile.TemporaryDirectory() as temporary:
            root = copy_project(Path(temporary) / "project")
            edit(root / "hdl" / "common" / "dtof_stream_rules.sv", "!waits_q || tvalid_i,", "!waits_q || !tvalid_i,")
            with self.assertRaisesRegex(FlowError, "tvalid fell before tready"):
                simulation.simulate(short(simulation.rtl_case(NAMED["ezpointer"], SEED)), root,
                                    Path(temporary) / "run")

    def test_warnings_of_icarus_are_failures(self) -> None:
        with tempfile.TemporaryDirectory() as temporary:
            root = copy_project(Path(temporary) / "project")
            edit(root / "hdl" / "thesis" / "dtof_result_output.sv", "assign shift_o = shift_q;",
                 "assign shift_o = shift_q;\n  logic o;\n  always_comb o = tdata_o[0];")
            with self.assertRaisesRegex(FlowError, "sorry"):
                simulation.simulate(short(simulation.rtl_case(NAMED["ezpointer"], SEED)), root,
                                    Path(temporary) / "run")

    def test_one_seed_one_simulation(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            case = short(simulation.rtl_case(NAMED["ezpointer"], SEED), 5, 6)
            clocks = [simulation.simulate(replace(case, seed=seed), ROOT, Path(folder)).clocks for seed in (1, 1, 2)]
            self.assertEqual(clocks[0], clocks[1])
            self.assertNotEqual(clocks[0], clocks[2])


class NetlistBench(unittest.TestCase):
    temporary: tempfile.TemporaryDirectory[str]
    folder: Path
    technology: Technology
    case: simulation.Case
    design: dict

    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.technology = technology.prepare(ROOT, cls.folder / "generic40", [])
        cls.case = short(simulation.netlist_cases(NAMED["ezpointer"], SEED)[0])
        elaborate(cls.case.configuration, cls.technology, cls.folder)
        cls.design = map_to_cells(cls.case.configuration, cls.technology, cls.folder, efforts(cls.case.configuration)[0])
        floorplan.finish(cls.design, cls.technology.slow, sram_kit.PIN_FF, cls.case.configuration)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.temporary.cleanup()

    def files(self, design: dict) -> tuple[Path, ...]:
        return simulation.write_simulation_netlist(design, self.case.configuration, self.technology, self.folder, SEED)

    def simulate(self, files: tuple[Path, ...]) -> simulation.Outcome:
        return simulation.simulate(self.case, ROOT, self.folder, files)

    def test_what_is_right_passes(self) -> None:
        self.assertEqual(self.simulate(self.files(copy.deepcopy(self.design))).frames, len(self.case.frames))

    def test_a_wrong_cell_model_is_seen(self) -> None:
        files = self.files(copy.deepcopy(self.design))
        edit(files[1], "(~(A1 & A2))", "(~(A1 | A2))")
        with self.assertRaisesRegex(FlowError, "netlist"):
            self.simulate(files)

    def test_a_register_without_reset_is_seen(self) -> None:
        files = self.files(copy.deepcopy(self.design))
        edit(files[1], "if ((~RN)) IQ <= 1'b0;", "if (1'b0) IQ <= 1'b0;")
        with self.assertRaisesRegex(FlowError, "netlist"):
            self.simulate(files)

    def test_a_wrong_fanout_tree_is_seen(self) -> None:
        """The first buffer of a tree hangs on another input."""
        design = copy.deepcopy(self.design)
        array = netlist.top(design)
        name = next(name for name in array["cells"] if name.startswith(netlist.TREE_PREFIX))
        buffer = next(item for item in self.technology.slow.buffers if item.name == array["cells"][name]["type"])
        array["cells"][name]["connections"][buffer.input_pin] = array["ports"]["result_tready_i"]["bits"]
        with self.assertRaisesRegex(FlowError, "netlist"):
            self.simulate(self.files(design))

    def test_an_open_net_is_x_on_an_output(self) -> None:
        files = self.files(copy.deepcopy(self.design))
        text = files[0].read_text(encoding="utf-8")
        files[0].write_text(re.sub(r"(result_tvalid_o *;.*?)\.Q\(result_tvalid_o\)", r"\1.Q()", text, flags=re.S),
                            encoding="utf-8")
        self.assertNotEqual(text, files[0].read_text(encoding="utf-8"))
        with self.assertRaisesRegex(FlowError, "netlist: a control output is X"):
            self.simulate(files)

    def test_a_parameter_that_yosys_folds_wrongly_is_seen(self) -> None:
        """Yosys 0.23 reads a typed localparam set to '1 as 1: the netlist scans two bins only, the RTL all."""
        with tempfile.TemporaryDirectory() as temporary:
            root = copy_project(Path(temporary) / "project")
            source = root / "hdl" / "thesis" / "dtof_scan_sequencer.sv"
            edit(source, "LAST_BIN_ALL = {BIN_WIDTH{1'b1}};", "LAST_BIN_ALL = '1;")
            self.assertRegex(source.read_text(encoding="utf-8"), r"localparam logic \[BIN_WIDTH-1:0\] LAST_BIN_ALL")
            case = short(simulation.netlist_cases(NAMED["fifh"], SEED)[0], 2)
            with self.assertRaisesRegex(FlowError, "fifh: netlist differs from RTL"):
                simulation.simulate_netlist(case, replace(self.technology, root=root), Path(temporary) / "run")
            # The RTL itself still is what the model says.
            simulation.simulate(case, root, Path(temporary) / "run")


if __name__ == "__main__":
    unittest.main()
