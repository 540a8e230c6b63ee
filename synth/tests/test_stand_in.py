# SPDX-License-Identifier: Apache-2.0
"""Stand-ins for columns are timed as the columns are, and an end of a path that is not timed stops the flow."""

import re
import tempfile
import unittest
from pathlib import Path

from dtof_synth import endpoints, liberty, library, netlist, sram_kit, stand_in, standard_cells, timing, tools, verilog
from dtof_synth.errors import FlowError
from dtof_synth.library import Library

from .partial import part_of
from .small_netlists import cell, module
from .small_results import ROOT

COLUMNS = 6
PERIOD_NS = 3.0


def column(gates_on_the_chain: int = 1) -> dict:
    """A word goes from column to column through an OR; each column ORs a register of its own to it. A told bit goes through a gate
    to that register and to a gated one, and a register inside reaches nothing outside."""
    cells = {"told_gate": cell("NAND2_X1", {"A1": 3, "A2": 20}, {"Y": 10}), "own": cell("DFF_X1", {"D": 10, "CK": 2}, {"Q": 11}),
             "or": cell("OR2_X1", {"A1": 4, "A2": 11}, {"Y": 30}),
             "clock_gate_1": cell("CLKGATE_X1", {"CK": 2, "E": 20}, {"GCK": 12}), "gated": cell("DFF_X1", {"D": 13, "CK": 12}, {"Q": 14}),
             "beside_gate": cell("INV_X1", {"A": 4}, {"Y": 13}), "deep": cell("INV_X1", {"A": 14}, {"Y": 15}),
             "inside": cell("DFF_X1", {"D": 15, "CK": 2}, {"Q": 20}), "late": cell("INV_X1", {"A": 11}, {"Y": 21}),
             "late_2": cell("INV_X4", {"A": 11}, {"Y": 23}), "end": cell("DFF_X1", {"D": 21, "CK": 2}, {"Q": 22})}
    net = 30
    for index in range(gates_on_the_chain):
        cells[f"chain{index}"] = cell("BUF_X1", {"A": net}, {"Y": 5 if index == gates_on_the_chain - 1 else net + 1})
        net += 1
    return module({"clk_i": ("input", 2), "told": ("input", 3), "beside": ("input", 4), "word": ("output", 5)}, cells)


def array(gates_on_the_chain: int = 1) -> dict:
    cells = {"told": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 4}), "zero": cell("TIE0_X1", {}, {"Y": 100}),
             "last": cell("DFF_X1", {"D": 100 + COLUMNS, "CK": 2}, {"Q": 5})}
    cells |= {f"c{index}": cell("a_column", {"clk_i": 2, "told": 4, "beside": 100 + index}, {"word": 101 + index})
              for index in range(COLUMNS)}
    return {"modules": {"a_column": column(gates_on_the_chain),
                        "t": module({"clk_i": ("input", 2), "told_i": ("input", 3), "q": ("output", 5)}, cells, top=True)}}


class StandIns(unittest.TestCase):
    scratch: tempfile.TemporaryDirectory[str]
    folder: Path
    library: Library

    @classmethod
    def setUpClass(cls) -> None:
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = Path(cls.scratch.name)
        (cls.folder / "slow.lib").write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
        cls.library = library.read(cls.folder / "slow.lib")
        (cls.folder / "t.sdc").write_text(
            "create_clock -name clk -period $period [get_ports clk_i]\nset_input_delay 0.9 -clock clk [get_ports told_i]\n"
            "set_output_delay 0.9 -clock clk [all_outputs]\n", encoding="utf-8")

    def load(self, kind: str, pin: str) -> float:
        return self.library.input_ff[kind].get(pin, 0.0) if kind in self.library.input_ff else sram_kit.PIN_FF

    def sta(self, design: dict, stand: stand_in.StandIn | None = None, sdc: str = "") -> timing.Report:
        files = [self.folder / "slow.lib"]
        if stand:
            files.append(self.folder / "stand_in.lib")
            files[1].write_text(stand_in.liberty(stand, 0.95), encoding="utf-8")
        (self.folder / "t.v").write_text(verilog.write(design), encoding="utf-8")
        (self.folder / "own.sdc").write_text(sdc or (self.folder / "t.sdc").read_text(encoding="utf-8"), encoding="utf-8")
        tools.write_settings(self.folder / "settings.tcl", {
            "liberty_files": files, "netlist": self.folder / "t.v", "wires": "", "top": "t", "wire_load": self.library.wire_load,
            "constraints": self.folder / "own.sdc", "target_period": f"{PERIOD_NS}", "steps": ["check", "nominal"]})
        return timing.Report(tools.run_sta(ROOT / "synth/sta/timing.tcl", self.folder / "settings.tcl", self.folder / "log", "t"), {})

    def timed(self, design: dict) -> tuple[dict, stand_in.StandIn]:
        return stand_in.timed(design, ["c0", "c1", f"c{COLUMNS - 1}"], self.library, self.load)

    def slowest(self, report: timing.Report) -> tuple[float, float, list[tuple[str, str]]]:
        """Setup, hold, and the slowest path's arrivals, pin by pin."""
        path = report._section("DTOF_PATH_MAX").split("data arrival time")[0]
        return report.slack, report._number("DTOF_SLACK", 1), re.findall(r"([\d.]+) [v^] (\S+)", path)

    def test_every_path_is_as_slow_as_with_all_columns(self) -> None:
        for gates in (1, 4):
            design = array(gates)
            timed, stand = self.timed(design)
            real, found = self.slowest(self.sta(design)), self.slowest(self.sta(timed, stand))
            self.assertEqual(real, found)
            self.assertIn(f"c{COLUMNS // 2}/chain0/Y", [pin for _, pin in found[2]])

    def test_a_chain_that_is_longer_is_slower_by_its_gates(self) -> None:
        short, long = (self.sta(*self.timed(array(gates))).slack for gates in (1, 2))
        # One more buffer in each of six columns: 0.06 to 0.2 ns in the slow corner.
        self.assertTrue(0.36 < short - long < 1.2, (short, long))

    def test_what_is_inside_is_left_out_and_still_loads(self) -> None:
        timed, stand = self.timed(array())
        cells = stand.module["cells"]
        self.assertEqual({name for name in cells if not name.startswith(stand_in.LOAD_PREFIX)},
                         {"told_gate", "own", "or", "chain0", "clock_gate_1", "gated", "beside_gate"})
        self.assertEqual(stand.cut, {"clock_gate_1/E"})
        # The register's net loses two inverters, of one and four inputs, and has the wire of one of them with the load cell.
        load = cells[f"{stand_in.LOAD_PREFIX}11"]
        self.assertAlmostEqual(stand.loads[load["type"]], 5 * standard_cells.CINV_FF + self.library.wire_ff_per_sink, delta=0.01)
        self.assertEqual([cell["type"] for cell in netlist.top(timed)["cells"].values() if "told" in cell["connections"]],
                         ["a_column", "a_column", *[netlist.STUB] * 3, "a_column"])

    def test_a_pin_behind_a_register_that_is_an_end_alone_is_cut(self) -> None:
        column = module({"clk_i": ("input", 2), "told": ("input", 3)}, {
            "end": cell("DFF_X1", {"D": 3, "CK": 2}, {"Q": 10}), "after": cell("DFFR_X1", {"D": 10, "RN": 3, "CK": 2}, {"Q": 11})})
        stand = stand_in.of(column, self.library, self.load)
        self.assertEqual(stand.cut, {"after/D"})

    def test_a_loop_behind_an_input_ends(self) -> None:
        column = module({"clk_i": ("input", 2), "told": ("input", 3)}, {
            "x": cell("NAND2_X1", {"A1": 3, "A2": 11}, {"Y": 10}), "y": cell("INV_X1", {"A": 10}, {"Y": 11})})
        self.assertEqual(set(stand_in.of(column, self.library, self.load).module["cells"]), {"x", "y"})

    def test_bits_of_a_macros_pin_are_cut_one_by_one(self) -> None:
        macro = cell("sram_1rw_4x2", {"clk_i": 2, "en_i": 3}, {"rdata_o": 12})
        macro["connections"]["wdata_i"], macro["port_directions"]["wdata_i"] = [3, 10], "input"
        column = module({"clk_i": ("input", 2), "told": ("input", 3)}, {"m": macro, "inside": cell("DFF_X1", {"D": 12, "CK": 2}, {"Q": 10})})
        stand = stand_in.of(column, self.library, self.load)
        self.assertEqual(stand.cut, {"m/wdata_i[1]"})
        self.assertEqual(stand.module["cells"]["m"]["connections"]["wdata_i"], [3, "0"])

    def test_what_hangs_on_an_output_inside_loads_it(self) -> None:
        column = module({"clk_i": ("input", 2), "word": ("output", 5)}, {
            "own": cell("DFF_X1", {"D": 10, "CK": 2}, {"Q": 5}), "late": cell("INV_X2", {"A": 5}, {"Y": 21}),
            "end": cell("DFF_X1", {"D": 21, "CK": 2}, {"Q": 10})})
        stand = stand_in.of(column, self.library, self.load)
        self.assertEqual(set(stand.module["cells"]), {"own", f"{stand_in.LOAD_PREFIX}5"})
        self.assertAlmostEqual(sum(stand.loads.values()), 2 * standard_cells.CINV_FF, delta=0.01)

    def test_load_cells_are_named_by_hundredths_and_are_inputs_alone(self) -> None:
        # Two pins of 1 and 2.25 fF and the wire of one of them; a pin alone has none; nothing is missing behind the third net.
        cells, loads = stand_in._load_cells({5: [1.0, 2.25], 6: [1.0], 7: []}, part_of(Library, wire_ff_per_sink=0.5))
        self.assertEqual(loads, {"load_375": 3.75, "load_100": 1.0})
        self.assertEqual({name: (one["type"], one["connections"]) for name, one in cells.items()},
                         {"load_5": ("load_375", {"A": [5]}), "load_6": ("load_100", {"A": [6]})})
        written = liberty.parse(stand_in.liberty(stand_in.StandIn({}, loads, set()), 0.95), "t")
        self.assertEqual(written.number("nom_voltage"), 0.95)
        self.assertEqual([(one.name, one.groups[0].name, one.groups[0].get("direction"), one.groups[0].number("capacitance"))
                          for one in written.children("cell")], [("load_100", "A", "input", 1.0), ("load_375", "A", "input", 3.75)])

    def test_a_mere_load_weighs_what_the_column_does_and_has_no_path(self) -> None:
        design = array()
        timed, stand = stand_in.timed(design, ["c0", "c1", f"c{COLUMNS - 1}"], self.library, self.load, ["c2"])
        kinds = [cell["type"] for cell in netlist.top(timed)["cells"].values() if "told" in cell["connections"]]
        self.assertEqual(kinds, ["a_column", "a_column", netlist.STUB, stand_in.LOAD, stand_in.LOAD, "a_column"])
        load = netlist.modules(timed)[stand_in.LOAD]["cells"]
        self.assertEqual(set(load), {f"{stand_in.LOAD_PREFIX}3", f"{stand_in.LOAD_PREFIX}4"})
        # Behind the told bit is a NAND2's input of 4/3 of an inverter's, behind the neighbour's word an OR2's and an inverter's.
        for bit, pins in ((3, [("NAND2_X1", "A1")]), (4, [("OR2_X1", "A1"), ("INV_X1", "A")])):
            expected = sum(self.library.input_ff[kind][pin] for kind, pin in pins) + (len(pins) - 1) * self.library.wire_ff_per_sink
            self.assertAlmostEqual(stand.loads[load[f"{stand_in.LOAD_PREFIX}{bit}"]["type"]], expected, delta=0.01)

    def judge(self, design: dict, stand: stand_in.StandIn | None, report: timing.Report) -> endpoints.Endpoints:
        inside = {f"c{index}/{pin}" for index in range(2, COLUMNS - 1) for pin in stand.cut} if stand else set()
        return endpoints.judge("t", report.unchecked, design, self.library, inside)

    def test_every_end_is_counted_and_timed(self) -> None:
        # A real column has four registers and a gate of the clock; a stand-in two registers whose paths are timed; around
        # them are two registers and a port.
        for design, stand, number in ((array(), None, COLUMNS * 5 + 3), (*self.timed(array()), 3 * 5 + 3 * 2 + 3)):
            found = self.judge(design, stand, self.sta(design, stand))
            # The first column's neighbour is a constant.
            self.assertEqual(found, endpoints.Endpoints(number, number - 1, 1, 0))

    def test_a_stand_in_without_paths_is_found(self) -> None:
        timed, stand = self.timed(array())
        del stand.module["cells"]["or"]
        with self.assertRaisesRegex(FlowError, r"t: OpenSTA warns of \d+ unconstrained endpoints: .*c5/gated/D"):
            self.judge(timed, stand, self.sta(timed, stand))

    def test_a_port_without_budget_is_found(self) -> None:
        for sdc, message in (("create_clock -name clk -period $period [get_ports clk_i]\nset_output_delay 0.9 -clock clk [get_ports q]\n",
                              "input port missing set_input_delay: told_i"),
                             ("create_clock -name clk -period $period [get_ports clk_i]\nset_input_delay 0.9 -clock clk [get_ports told_i]\n",
                              "unconstrained endpoints: q")):
            design = array()
            with self.assertRaisesRegex(FlowError, message):
                self.judge(design, None, self.sta(design, None, sdc))

    def test_a_register_without_clock_is_found(self) -> None:
        design = array()
        del netlist.top(design)["cells"]["last"]["connections"]["CK"]
        with self.assertRaisesRegex(FlowError, "last/CK|last/D"):
            self.judge(design, None, self.sta(design))

    def test_a_loop_is_found(self) -> None:
        design = array()
        netlist.top(design)["cells"] |= {"x": cell("NAND2_X1", {"A1": 200, "A2": 4}, {"Y": 201}), "y": cell("INV_X1", {"A": 201}, {"Y": 200})}
        with self.assertRaisesRegex(FlowError, "loop"):
            self.judge(design, None, self.sta(design))

    def test_a_constant_is_no_path(self) -> None:
        design = array()
        cells = netlist.top(design)["cells"]
        cells["not"] = cell("INV_X1", {"A": 100}, {"Y": 200})
        cells["still"] = cell("DFF_X1", {"D": 200, "CK": 2}, {"Q": 201})
        number = COLUMNS * 5 + 4
        self.assertEqual(self.judge(design, None, self.sta(design)), endpoints.Endpoints(number, number - 2, 2, 0))
        cells["not"]["connections"]["A"] = [250]  # driven by nothing
        with self.assertRaisesRegex(FlowError, "still/D"):
            self.judge(design, None, self.sta(design))


if __name__ == "__main__":
    unittest.main()
