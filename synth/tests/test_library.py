# SPDX-License-Identifier: Apache-2.0
"""Facts that the flow takes from a Liberty, by hand."""

import tempfile
import unittest
from pathlib import Path

from dtof_synth import library
from dtof_synth.errors import FlowError
from dtof_synth.library import Buffer, ClockGate


def pin(name: str, direction: str, more: str = "") -> str:
    return f"pin ({name}) {{ direction : {direction}; {more} }}"


def gate(name: str, area: float, function: str, inputs: str, capacitance: float = 0.01, most: float = 0.2) -> str:
    pins = " ".join(pin(one, "input", f"capacitance : {capacitance};") for one in inputs)
    output = pin("Y", "output", f'max_capacitance : {most}; function : "{function}";' if function else "")
    return f"cell ({name}) {{ area : {area}; {pins} {output} }}"


def clock_gate(name: str, area: float, kind: str = "latch_posedge", enable: str = "true") -> str:
    clock = pin("CK", "input", 'capacitance : 0.03; clock_gate_clock_pin : true; internal_power () { rise_power (t) { values ("2, 9"); } }')
    return (f'cell ({name}) {{ area : {area}; clock_gating_integrated_cell : "{kind}"; latch (IQ, IQN) {{ enable : "!CK"; }} {clock} '
            + pin("E", "input", f"capacitance : 0.01; clock_gate_enable_pin : {enable}; timing () {{ timing_type : setup_rising; }}")
            + pin("GCK", "output", "max_capacitance : 1.5; clock_gate_out_pin : true;") + " }")


# A cycle: a rise and a fall in each of two states, at the smallest slew and load.
POWER = " ".join(f'internal_power () {{ rise_power (t) {{ values ("{rise}, 70", "80, 90"); }} fall_power (t) {{ values ("{fall}, 60"); }} }}'
                 for rise, fall in ((4, 1), (6, 3)))
REGISTER = ('cell (DFF_X1) { area : 5; ff (IQ, IQN) { next_state : "D"; clocked_on : "CK"; } '
            + pin("D", "input", "capacitance : 0.01; timing () { timing_type : setup_rising; } timing () { timing_type : hold_rising; }")
            + pin("CK", "input", f"capacitance : 0.012; clock : true; {POWER}") + pin("Q", "output", "max_capacitance : 0.3;") + " }")
CELLS = [gate("BUF_X4", 3, "A", "A", 0.02, 0.8), gate("BUF_X1", 1, "A", "A"), gate("CLKBUF_X1", 1, "A", "A"), gate("INV_X2", 0.7, "A'", "A"),
         gate("INV_X1", 0.5, "(!A)", "A"), gate("NAND2_X2", 1.2, "!(A * B)", "AB"), gate("NAND2_X1", 0.8, "!(A & B)", "AB"),
         gate("AND2_X1", 0.6, "(A B)", "AB"), gate("MUX2_X1", 2, "(A*!S)+(B*S)", "ABS"), gate("mux2_x2", 1.8, "x", "ABS"),
         gate("TIE0", 0.3, "0", ""), gate("TIE1", 0.4, "1", ""), gate("TIE1_AGAIN", 0.4, "1", ""), gate("NOTHING", 0.1, "", ""),
         gate("STUCK", 0.1, "0", "A"), REGISTER, "cell (LATCH) { area : 4; latch (IQ, IQN) { } }", clock_gate("GATE_X2", 9), clock_gate("GATE_X1", 7),
         clock_gate("GATE_LOW", 1, "latch_negedge"), clock_gate("GATE_OTHER", 1, enable="false"), gate("INV_X1", 99, "!A", "A")]
WIRES = """wire_load ("5K") { capacitance : 9; fanout_length (1, 9); }
  wire_load ("1K") { capacitance : 0.002; fanout_length (1, 5.0); fanout_length (2, 11.0); }"""


class Facts(unittest.TestCase):
    def read(self, cells: list[str] | None = None, unit: str = "0.1, pf", more: str = WIRES) -> library.Library:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "small.lib"
            path.write_text(f"library (small) {{ capacitive_load_unit ({unit}); nom_voltage : 1.1; {more} {' '.join(cells or CELLS)} }}",
                            encoding="utf-8")
            return library.read(path)

    def test_buffers_and_inverters(self):
        # The unit is 100 fF.
        found = self.read()
        self.assertEqual(found.buffers, [Buffer("BUF_X1", "A", "Y", 1.0, 1.0, 20.0), Buffer("BUF_X4", "A", "Y", 3.0, 2.0, 80.0)])
        self.assertEqual(found.inverter, "INV_X1")
        self.assertEqual(found.area["INV_X1"], 0.5)  # the first of two cells with a name
        self.assertEqual((found.input_ff["BUF_X4"], found.max_load_ff["BUF_X4"]), ({"A": 2.0}, {"Y": 80.0}))

    def test_areas_of_a_nand_and_a_multiplexer_are_the_smallest(self):
        found = self.read()
        self.assertEqual((found.nand2_area, found.mux2_area), (0.8, 1.8))
        self.assertEqual(self.read([*CELLS, gate("N", 0.75, "(A B)'", "AB")]).nand2_area, 0.8)  # a quote behind brackets is not read
        self.assertEqual(self.read([*CELLS, gate("N", 0.75, "!A + !B", "AB")]).nand2_area, 0.75)

    def test_ties_have_no_input_and_a_function(self):
        self.assertEqual(self.read().tie, {"0": ("TIE0", "Y"), "1": ("TIE1", "Y")})

    def test_registers_latches_and_clock_gates(self):
        found = self.read()
        self.assertEqual((found.sequential, found.latches), ({"DFF_X1"}, {"LATCH", "GATE_LOW", "GATE_OTHER"}))
        self.assertEqual(found.clock_gates, [ClockGate("GATE_X1", "CK", "E", "GCK", 7.0, 150.0), ClockGate("GATE_X2", "CK", "E", "GCK", 9.0, 150.0)])
        self.assertEqual(found.checked, {name: {"D"} if name == "DFF_X1" else {"E"}
                                         for name in ("DFF_X1", "GATE_X1", "GATE_X2", "GATE_LOW", "GATE_OTHER")})
        self.assertEqual(found.clock_pin_ff, {"DFF_X1": 1.2, "GATE_X1": 3.0, "GATE_X2": 3.0})
        # (4 + 1 + 6 + 3) / 2 of the register's states, 2 of the gate, times 100 fF V2.
        self.assertEqual(found.clock_energy_fj, {"DFF_X1": 700.0, "GATE_X1": 200.0, "GATE_X2": 200.0})
        self.assertEqual(found.energy_fj, 100.0)

    def test_drives_of_a_function(self):
        # Smallest first; NAND2_X2's function is written in another way than NAND2_X1's.
        found = self.read([*CELLS[:-1], gate("INV_X3", 0.6, "!A", "A")])
        self.assertEqual(sorted(found.drives), [["BUF_X1", "BUF_X4"], ["GATE_X1", "GATE_X2"], ["INV_X1", "INV_X3", "INV_X2"]])
        self.assertEqual(found.smaller["BUF_X4"], "BUF_X1")
        self.assertNotIn("BUF_X1", found.smaller)

    def test_the_wire_of_a_sink_is_that_of_the_default_or_of_a_thousand_gates(self):
        # 5 um of 0.002 units of 100 fF.
        found = self.read()
        self.assertEqual((found.wire_load, found.voltage), ("1K", 1.1))
        self.assertAlmostEqual(found.wire_ff_per_sink, 1.0)
        found = self.read(more=f"default_wire_load : 5K; {WIRES}")
        self.assertEqual((found.wire_load, found.wire_ff_per_sink), ("5K", 8100.0))
        for more in ("", 'wire_load ("5K") { capacitance : 9; fanout_length (1, 9); }'):
            found = self.read(more=more)
            self.assertEqual((found.wire_load, found.wire_ff_per_sink), ("", 0.0))

    def test_units(self):
        self.assertEqual(self.read(unit="2, ff").buffers[0].max_load_ff, 0.4)
        for unit in ("1, uf", "1"):
            with self.assertRaisesRegex(FlowError, "no capacitive_load_unit"):
                self.read(unit=unit)

    def test_what_the_flow_needs_is_named_if_it_is_missing(self):
        with self.assertRaisesRegex(FlowError, "the library has no inverter and no buffer and no NAND2 and no flip-flop"):
            self.read(["cell (X) { area : 1; }"])
        with self.assertRaisesRegex(FlowError, "the library has no flip-flop$"):
            self.read([one for one in CELLS if one is not REGISTER])


if __name__ == "__main__":
    unittest.main()
