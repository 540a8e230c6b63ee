# SPDX-License-Identifier: Apache-2.0
"""Power of dtof_subsystem from activity: a small subsystem from RTL to counted transitions, with planted faults in its netlist."""

import copy
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import array_stand_in, configuration, endpoints, library, netlist, standard_cells, subsystem, subsystem_power
from dtof_synth.activity import OTHER, STREAMING
from dtof_synth.array_stand_in import MODES, Port, Ports
from dtof_synth.configuration import Configuration
from dtof_synth.errors import FlowError
from dtof_synth.run import EFFORTS, Technology

from .partial import part_of
from .small_results import ROOT

COLUMNS, ROWS = 2, 3


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
        named = configuration.load(ROOT / "configurations.toml")["ezpointer"]
        ports = Ports({mode: [Port("d_i[0]", False, 0, 0), Port("d_i[2]", False, 0, 0), Port("q_o", True, 0, 0)] for mode in MODES},
                      {"state_o[1]"}, {"d_i[1]", "raw_i"})
        text = subsystem_power.array_wrapper(named, ports, [("sram_cfg_o", True)])
        for line in ("    input wire d_i_0_,", "    output wire q_o,", "  wire [2:0] d_i_bits = {d_i_2_, 1'b0, d_i_0_};",
                     "  assign q_o = q_o_bits[0];", "  wire [0:0] raw_i_bits = {1'b0};", "  wire [1:0] state_o_bits;",
                     "  wire [0:0] clk_i_bits = {clk_i};"):
            self.assertIn(f"\n{line}", text)
        self.assertIn(".PIXELS_PER_SRAM(160)", text)
        self.assertIn(".state_o(state_o_bits)", text)


@unittest.skipIf(not (ROOT / "build/cpp/bin/dtof-vectors").is_file(), "dtof-vectors is not built: make vectors")
class Small(unittest.TestCase):
    kept: tempfile.TemporaryDirectory[str]
    technology: Technology
    configuration: Configuration
    design: dict
    ports: Ports
    others: list[tuple[str, bool]]

    @classmethod
    def setUpClass(cls) -> None:
        cls.kept = tempfile.TemporaryDirectory()
        folder = Path(cls.kept.name)
        libraries = []
        for name, corner in (("slow", standard_cells.SLOW), ("typical", standard_cells.TYPICAL)):
            (folder / f"{name}.lib").write_text(standard_cells.library(corner), encoding="utf-8")
            libraries.append(library.read(folder / f"{name}.lib"))
        cls.technology = part_of(Technology, root=ROOT, slow=libraries[0], typical=libraries[1], target_mhz=330.0)
        named = configuration.load(ROOT / "configurations.toml")["ezpointer"]
        cls.configuration = named.with_parameters("ezpointer", SRAM_NUM=COLUMNS, PIXELS_PER_SRAM=ROWS)
        subsystem.generic(cls.configuration, cls.technology, folder / "netlist")
        cls.design = subsystem.map_to_cells(cls.configuration, cls.technology, folder / "netlist", EFFORTS[0])
        cls.ports = ports_of(cls.design)
        cls.others = subsystem.connect_stand_in(cls.design, cls.ports)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.kept.cleanup()

    def measure(self, design: dict) -> subsystem_power.SubsystemPower:
        folder = Path(tempfile.mkdtemp(dir=self.kept.name))
        with mock.patch.multiple(subsystem_power, MOST_RESULTS=COLUMNS * ROWS - 1, MOST_CLOCKS=3000):
            return subsystem_power.measure(design, self.configuration, self.ports, self.others, self.technology, folder, 1)

    def test_every_line_of_the_frame_is_a_clock_of_streaming(self) -> None:
        found = self.measure(copy.deepcopy(self.design))
        lines = subsystem_power.ACQUISITIONS * ROWS * self.configuration["SLOTS"]
        self.assertIn(found.clocks[STREAMING] - lines, (0, 1))  # the waveform may have s_axis_tready_o before the edge that sets it
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


if __name__ == "__main__":
    unittest.main()
