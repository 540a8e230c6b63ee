# SPDX-License-Identifier: Apache-2.0
"""Power of dtof_subsystem from activity: a small subsystem from RTL to counted transitions, with planted faults in its netlist."""

import copy
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import array_stand_in, configuration, endpoints, library, netlist, standard_cells, subsystem, subsystem_power
from dtof_synth.activity import OTHER, STREAMING, Activity, Scope
from dtof_synth.array_stand_in import MODES, Port, Ports
from dtof_synth.configuration import Configuration
from dtof_synth.errors import FlowError
from dtof_synth.library import Buffer, Library
from dtof_synth.mapping import EFFORTS
from dtof_synth.technology import Technology

from .partial import part_of
from .small_netlists import cell, module
from .small_results import ROOT

COLUMNS, ROWS = 2, 3
NAMED = configuration.load(ROOT / "configurations.toml")


def ports_of(design: dict) -> Ports:
    """Ports of the array, as if each had a path."""
    cell = netlist.top(design)["cells"][subsystem.array_cell(design)]
    timed = []
    for port, bits in cell["connections"].items():
        for index in range(len(bits)):
            name = port if len(bits) == 1 else f"{port}[{index}]"
            if port != array_stand_in.CLOCK and not endpoints.SIDE_BAND.fullmatch(name):
                timed.append(Port(name, cell["port_directions"][port] == "output", 0.1, 0.1, 2.0))
    return Ports({mode: timed for mode in MODES}, set(), set())


class Wrapper(unittest.TestCase):
    def test_pins_are_bits_of_the_arrays_ports(self) -> None:
        named = NAMED["ezpointer"]
        ports = Ports({mode: [Port("d_i[0]", False, 0, 0), Port("d_i[2]", False, 0, 0), Port("q_o", True, 0, 0)] for mode in MODES},
                      {"state_o[1]"}, {"d_i[1]", "raw_i"})
        text = subsystem_power.array_wrapper(named, ports, [("sram_cfg_o", True)])
        for line in ("    input wire d_i_0_,", "    output wire q_o,", "  wire [2:0] d_i_bits = {d_i_2_, 1'b0, d_i_0_};",
                     "  assign q_o = q_o_bits[0];", "  wire [0:0] raw_i_bits = {1'b0};", "  wire [1:0] state_o_bits;",
                     "  wire [0:0] clk_i_bits = {clk_i};"):
            self.assertIn(f"\n{line}", text)
        self.assertIn(".PIXELS_PER_SRAM(160)", text)
        self.assertIn(".state_o(state_o_bits)", text)


class Frames(unittest.TestCase):
    """Which results are compared, and what a simulation must have done."""

    def test_a_pointer_of_one_pass_sends_results_behind_the_last_line(self) -> None:
        self.assertEqual({name: subsystem_power.awaits_results(NAMED[name]) for name in subsystem.CONFIGURATIONS},
                         {"ezpointer": True, "hispointer": False, "coarsehistogram": False, "poolpointer": False, "poolpointer_lean": False})

    def test_the_first_pass_has_two_acquisitions(self) -> None:
        self.assertEqual([subsystem_power.case(NAMED[name], 1).frames for name in subsystem.CONFIGURATIONS], [(2,), (4,), (2,), (2,), (2,)])
        self.assertEqual(subsystem_power.first_lines(NAMED["hispointer"]), 2 * 160 * 2)

    def judge(self, said: str, streaming: int, other: int, name: str = "ezpointer") -> subsystem_power.Simulated:
        return subsystem_power.judge(said, Activity({}, {STREAMING: streaming, OTHER: other}), NAMED[name])

    def test_a_frame_whose_results_are_compared(self) -> None:
        self.assertEqual(self.judge("DTOF_PASS lines 640 results 200 clocks 1000\n", 640, 360).compared, 200)
        self.assertEqual(self.judge("DTOF_PASS lines 643 results 0 clocks 6000\n", 643, 5357, "hispointer").compared, 0)
        self.assertEqual(self.judge("DTOF_PASS lines 640 results 4 clocks 5841\n", 640, 5201, "coarsehistogram").compared, 0)

    def test_a_simulation_that_compared_too_little_is_an_error(self) -> None:
        for results in (0, 199):
            with self.assertRaisesRegex(FlowError, f"{results} results were compared, and 200 should be"):
                self.judge(f"DTOF_PASS lines 640 results {results} clocks 1000\n", 640, 360)

    def test_a_frame_that_ends_too_early_is_an_error(self) -> None:
        with self.assertRaisesRegex(FlowError, "639 lines were taken, and 640 should come"):
            self.judge("DTOF_PASS lines 639 results 0 clocks 1000\n", 639, 361, "poolpointer")

    def test_activity_of_another_window_is_an_error(self) -> None:
        self.judge("DTOF_PASS lines 640 results 200 clocks 1000\n", 641, 360)
        for streaming, other in ((642, 358), (360, 640), (640, 362), (0, 1000)):
            with self.assertRaisesRegex(FlowError, f"{streaming} of {streaming + other} clocks were counted as streaming"):
                self.judge("DTOF_PASS lines 640 results 200 clocks 1000\n", streaming, other)

    def test_the_benchs_failure_is_the_flows(self) -> None:
        with self.assertRaisesRegex(FlowError, "ezpointer: DTOF_FAIL a handshake is X, clock 7, word 0"):
            self.judge("DTOF_FAIL a handshake is X, clock 7, word 0\n", 640, 360)
        with self.assertRaisesRegex(FlowError, "printed nothing"):
            self.judge("", 640, 360)


LIBERTY = """library (small) {
  cell (INV) { cell_leakage_power : 5; pin (A) { direction : input; } pin (Y) { direction : output;
    internal_power () { rise_power (t) { values ("0.5"); } fall_power (t) { values ("1.5"); } } } }
  cell (DFF) { cell_leakage_power : 20; pin (Q) { direction : output;
    internal_power () { rise_power (t) { values ("3"); } fall_power (t) { values ("3"); } } } }
}
"""


class ByHand(unittest.TestCase):
    """A register in the top, and in a module an inverter that inverts its output: 2 V, 330 MHz, pins of 2 and 3 fF, wires of 1 fF per sink."""

    def power(self, compared: int = 200, streaming: int = 10) -> subsystem_power.SubsystemPower:
        child = module({"a_i": ("input", 2), "y_o": ("output", 3)}, {"i": cell("INV", {"A": 2}, {"Y": 3})})
        top = module({"clk_i": ("input", 2), "q_o": ("output", 3)},
                     {"r": cell("DFF", {"CK": 2, "D": 4}, {"Q": 3}), "u": cell("dtof_child__2_netlist", {"a_i": 3}, {"y_o": 4})}, True)
        design = {"modules": {"dtof_subsystem_netlist": top, "dtof_child__2_netlist": child}}
        # In ten clocks with a line the register changes five times, in forty others four times.
        own = Scope("dtof_subsystem_netlist", {STREAMING: {2: 20, 3: 5, 4: 5}, OTHER: {2: 80, 3: 4, 4: 4}})
        inner = Scope("dtof_child__2_netlist", {STREAMING: {2: 5, 3: 5}, OTHER: {2: 4, 3: 4}})
        clocks = {STREAMING: streaming, OTHER: 40} if streaming else {OTHER: 40}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "small.lib"
            path.write_text(LIBERTY, encoding="utf-8")
            kinds = Library(path, "small", {"INV": 1.0, "DFF": 4.0}, {"DFF"}, set(), {"INV": {"A": 2.0}, "DFF": {"D": 3.0, "CK": 1.5}}, {},
                            [Buffer("BUF", "A", "Y", 2.0, 1.0, 60.0)], "INV", {}, 1.0, 1.0, 2.0, "", 1.0, {"DFF": 1.5}, {"DFF": 10.0})
            return subsystem_power.power(subsystem_power.Simulated(Activity({"": own, "p0": inner}, clocks), compared), design, "small", kinds)

    def test_lines_results_and_idle(self) -> None:
        found = self.power()
        # A transition: the register 3 fJ and no load in the top; the inverter 1 fJ and 0.5 * 3 fF * 4 V2 at its own input, and its output's
        # load, 0.5 * 4 fF * 4 V2 at the register's. 3 + 1 + 6 + 8 = 18 fJ.
        self.assertAlmostEqual(found.streaming.logic, 5 * 18 * 330e-6 / 10)
        self.assertIsNotNone(found.results)
        assert found.results is not None
        self.assertAlmostEqual(found.results.logic, 4 * 18 * 330e-6 / 40)
        # The clock: 10 fJ of the register, and a tree without buffers of 1.5 + 1 fF at 4 V2. Leakage: 25 nW.
        clock = (10 + 2.5 * 4) * 330e-6
        self.assertAlmostEqual(found.streaming.clock, clock)
        self.assertAlmostEqual(found.streaming.leakage, 25e-6)
        self.assertAlmostEqual(found.idle, clock + 25e-6)
        self.assertAlmostEqual(found.streaming.total, 5 * 18 * 330e-6 / 10 + clock + 25e-6)
        # While lines stream in, by module: the register's 3 fJ and the load of its D pin; the inverter's 1 fJ and its own input.
        self.assertEqual(set(found.modules), {"dtof_subsystem", "dtof_child"})
        self.assertAlmostEqual(found.modules["dtof_subsystem"], 5 * 11 * 330e-6 / 10)
        self.assertAlmostEqual(found.modules["dtof_child"], 5 * 7 * 330e-6 / 10)
        self.assertEqual((found.clocks, found.compared), ({STREAMING: 10, OTHER: 40}, 200))

    def test_without_a_result_nothing_is_said_of_results(self) -> None:
        self.assertIsNone(self.power(compared=0).results)

    def test_a_simulation_without_a_line_is_an_error(self) -> None:
        with self.assertRaisesRegex(FlowError, "small: the simulation has no clock of the phase streaming"):
            self.power(streaming=0)


@unittest.skipIf(not (ROOT / "build/cpp/bin/dtof-vectors").is_file(), "dtof-vectors is not built: make vectors")
class Simulation(unittest.TestCase):
    """A small subsystem around an array of some read-out."""

    READOUT = ""
    kept: tempfile.TemporaryDirectory[str]
    technology: Technology
    configuration: Configuration
    design: dict
    ports: Ports
    others: list[tuple[str, bool]]

    @classmethod
    def setUpClass(cls) -> None:
        if not cls.READOUT:
            raise unittest.SkipTest("only the classes below have an array")
        cls.kept = tempfile.TemporaryDirectory()
        folder = Path(cls.kept.name)
        libraries = []
        for name, corner in (("slow", standard_cells.SLOW), ("typical", standard_cells.TYPICAL)):
            (folder / f"{name}.lib").write_text(standard_cells.library(corner), encoding="utf-8")
            libraries.append(library.read(folder / f"{name}.lib"))
        cls.technology = part_of(Technology, root=ROOT, slow=libraries[0], typical=libraries[1], target_mhz=330.0)
        cls.configuration = cls.small(NAMED[cls.READOUT])
        subsystem.generic(cls.configuration, cls.technology, folder / "netlist")
        cls.design = subsystem.map_to_cells(cls.configuration, cls.technology, folder / "netlist", EFFORTS[0])
        cls.ports = ports_of(cls.design)
        cls.others = subsystem.connect_stand_in(cls.design, cls.ports)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.kept.cleanup()

    @staticmethod
    def small(named: Configuration) -> Configuration:
        return named.with_parameters(named.name, SRAM_NUM=COLUMNS, PIXELS_PER_SRAM=ROWS)

    def measure(self, design: dict) -> subsystem_power.SubsystemPower:
        folder = Path(tempfile.mkdtemp(dir=self.kept.name))
        with mock.patch.multiple(subsystem_power, MOST_RESULTS=COLUMNS * ROWS - 1, MOST_CLOCKS=3000):
            return subsystem_power.measure(design, self.configuration, self.ports, self.others, self.technology, folder, 1)


class EzPointer(Simulation):
    READOUT = "ezpointer"

    def test_every_line_of_the_frame_is_a_clock_of_streaming(self) -> None:
        found = self.measure(copy.deepcopy(self.design))
        self.assertIn(found.clocks[STREAMING] - 12, (0, 1))  # 2 acquisitions of 3 rows and 2 slots, see subsystem_power.judge
        self.assertEqual(found.compared, COLUMNS * ROWS - 1)
        self.assertGreater(found.clocks[OTHER], COLUMNS * ROWS)
        self.assertGreater(found.modules["dtof_line_buffer"], 0.0)
        self.assertAlmostEqual(found.streaming.total, found.streaming.logic + found.streaming.clock + found.streaming.leakage)
        self.assertGreater(found.streaming.clock, found.idle - found.streaming.leakage)  # clock gates that open

    def test_idle_is_the_clock_of_what_no_gate_stops(self) -> None:
        found = self.measure(copy.deepcopy(self.design))
        library_ = self.technology.typical
        pins = [kind["type"] for module in netlist.modules(self.design).values() for kind in module["cells"].values()
                if kind["type"] in library_.clock_pin_ff]
        most = sum(library_.clock_energy_fj[kind] for kind in pins) * 330e-6
        self.assertGreater(found.idle, 0.2 * most)  # without the tree and leakage some registers have gates
        self.assertLess(found.idle, 3 * most)

    def test_a_wrong_wire_of_the_results_is_found(self) -> None:
        design = copy.deepcopy(self.design)
        bits = netlist.modules(design)["dtof_stream_output"]["ports"]["m_axis_tdata_o"]["bits"]
        bits[0], bits[9] = bits[9], bits[0]  # of the position
        with self.assertRaisesRegex(FlowError, "a result is not the model's"):
            self.measure(design)

    def test_a_subsystem_that_sends_nothing_is_found(self) -> None:
        design = copy.deepcopy(self.design)
        control = netlist.modules(design)["dtof_frame_control"]["ports"]
        self.assertIn("begin_o", control)
        control["begin_o"]["bits"] = ["0"]
        with self.assertRaisesRegex(FlowError, "the results do not come"):
            self.measure(design)

    def test_a_bench_that_does_not_wait_for_results_is_found(self) -> None:
        asked = iter((False, True))  # by the bench, and by the judge of what the bench said
        with mock.patch.multiple(subsystem_power, awaits_results=lambda _: next(asked), QUIET_CLOCKS=1):
            with self.assertRaisesRegex(FlowError, "0 results were compared, and 5 should be"):
                self.measure(copy.deepcopy(self.design))

    def test_lines_and_other_clocks_exchanged_are_found(self) -> None:
        streams = subsystem_power._streams
        with mock.patch.object(subsystem_power, "_streams", lambda ports: not streams(ports)):
            with self.assertRaisesRegex(FlowError, "were counted as streaming, and the bench saw 12 lines"):
                self.measure(copy.deepcopy(self.design))


class HisPointer(Simulation):
    READOUT = "hispointer"

    def test_the_simulation_ends_behind_the_lines_of_the_first_pass(self) -> None:
        found = self.measure(copy.deepcopy(self.design))
        self.assertGreaterEqual(found.clocks[STREAMING], 12)
        self.assertLess(found.clocks[STREAMING], 24)  # of both passes
        self.assertGreater(found.clocks[OTHER], ROWS * 32)  # the clear
        self.assertEqual((found.results, found.compared), (None, 0))

    def test_lines_that_are_not_taken_are_found(self) -> None:
        design = copy.deepcopy(self.design)
        netlist.modules(design)["dtof_frame_control"]["ports"]["begin_o"]["bits"] = ["0"]
        with self.assertRaisesRegex(FlowError, "the lines are not taken"):
            self.measure(design)


class PoolPointer(Simulation):
    READOUT = "poolpointer_lean"

    @staticmethod
    def small(named: Configuration) -> Configuration:
        return named.with_parameters(named.name, SRAM_NUM=4, ENGINE_COLUMNS=4, PIXELS_PER_SRAM=named["GROUP_SIZE"])

    def test_all_lines_come_in_the_first_phase(self) -> None:
        found = self.measure(copy.deepcopy(self.design))
        self.assertIn(found.clocks[STREAMING] - subsystem_power.first_lines(self.configuration), (0, 1))
        self.assertEqual((found.results, found.compared), (None, 0))


if __name__ == "__main__":
    unittest.main()
