# SPDX-License-Identifier: Apache-2.0
"""The generated standard cells against their stated figures and, where present, Nangate 45 nm."""

import itertools
import unittest
from pathlib import Path

from dtof_synth import liberty, standard_cells
from dtof_synth.standard_cells import CINV_FF, FAST, SLOW, TYPICAL, inverter, path_delay

NANGATE = Path(__file__).resolve().parents[3] / "shared" / "pdk" / "liberty" / "nangate45_typ.lib.gz"


def fo4(corner) -> float:
    """Delay of an inverter with fan-out 4 whose input comes from another one."""
    tau = standard_cells.FO4_NS / 5 * corner.gate
    _, slew = path_delay((inverter(),), 0.0, 4 * CINV_FF, tau)
    return path_delay((inverter(),), slew, 4 * CINV_FF, tau)[0]


class StandardCells(unittest.TestCase):
    def test_fo4_is_28_ps_typical_and_nangate_ratio_slow(self) -> None:
        self.assertAlmostEqual(fo4(TYPICAL), 0.028, places=6)
        self.assertAlmostEqual(fo4(SLOW) / fo4(TYPICAL), 81 / 25.8, places=6)
        self.assertAlmostEqual(fo4(FAST) / fo4(TYPICAL), 16 / 25.8, places=6)

    def test_setup_and_hold_of_a_flip_flop(self) -> None:
        # Nangate's 0.029 and 0.017 ns by 28 / 25.8; slow 0.137 and 0.058 ns, fast 0.026 and 0.008 ns by the same.
        for corner, setup, hold in ((TYPICAL, 0.029, 0.017), (SLOW, 0.137, 0.058), (FAST, 0.026, 0.008)):
            cell = next(cell for cell in liberty.parse(standard_cells.library(corner), "generated").children("cell")
                        if cell.name == "DFF_X1")
            pin = next(pin for pin in cell.children("pin") if pin.name == "D")
            found = {arc.get("timing_type"): float(dict(arc.groups[0].attributes)["values"][0]) for arc in pin.children("timing")}
            self.assertEqual(list(found), ["setup_rising", "hold_rising"])
            for arc in pin.children("timing"):  # a rising and a falling D alike
                self.assertEqual([group.kind for group in arc.groups], ["rise_constraint", "fall_constraint"])
                self.assertEqual(*(dict(group.attributes)["values"] for group in arc.groups))
            self.assertAlmostEqual(found["setup_rising"], setup * 28 / 25.8, places=4)
            self.assertAlmostEqual(found["hold_rising"], hold * 28 / 25.8, places=4)

    def test_area_anchors(self) -> None:
        cells = {cell.name: cell.number("area") for cell in
                 liberty.parse(standard_cells.library(TYPICAL), "generated").children("cell")}
        self.assertAlmostEqual(cells["NAND2_X1"], 0.7056, places=4)
        self.assertGreaterEqual(cells["DFF_X1"], 3.0)
        self.assertLessEqual(cells["DFF_X1"], 3.6)

    def test_delay_grows_with_load_and_slew_in_every_table(self) -> None:
        library = liberty.parse(standard_cells.library(SLOW), "generated")
        tables = 0
        for cell in library.children("cell"):
            for pin in cell.children("pin"):
                for timing in pin.children("timing"):
                    for table in timing.children("cell_rise"):
                        rows = [list(map(float, row.split(","))) for row in dict(table.attributes)["values"]]
                        tables += 1
                        for row in rows:
                            self.assertEqual(row, sorted(row), cell.name)
                            self.assertGreater(row[0], 0, cell.name)
                        for column in zip(*rows):
                            self.assertEqual(list(column), sorted(column), cell.name)
        self.assertGreater(tables, 100)

    @unittest.skipUnless(NANGATE.exists(), "../shared/pdk is not present")
    def test_areas_are_nangates_times_the_shrink(self) -> None:
        theirs = {cell.name: cell.number("area") for cell in liberty.read(NANGATE).children("cell")}
        compared = 0
        for gate in standard_cells.gates():
            if gate.name in theirs and gate.name.endswith("_X1") and gate.name != "AOI211_X1":
                ratio = gate.pitches * standard_cells.PITCH_AREA_UM2 / theirs[gate.name]
                self.assertAlmostEqual(ratio, 0.884, delta=0.01, msg=gate.name)
                compared += 1
        self.assertGreater(compared, 20)

    @unittest.skipUnless(NANGATE.exists(), "../shared/pdk is not present")
    def test_clock_gates_have_nangates_loads_and_at_least_nearly_its_areas(self) -> None:
        theirs = {cell.name: cell for cell in liberty.read(NANGATE).children("cell")}
        for drive, ff in standard_cells.GATE_CK_FF.items():
            ours, other = standard_cells.clock_gate(drive, TYPICAL), theirs[f"CLKGATE_X{drive}"]
            clock = next(pin for pin in other.children("pin") if pin.name == "CK")
            self.assertAlmostEqual(ff, clock.number("capacitance") * 40 / 45, delta=0.01, msg=ours.name)
            ratio = ours.number("area") / (other.number("area") * 0.79)
            self.assertTrue(0.98 < ratio < 1.13, f"{ours.name}: {ratio}")

# Stages of a path by hand: parasitic delay, logical effort of the input, drive. `k`: drive of the cell; `i`: of its inner stage.
def stages(name: str, output: str, pin: str) -> list[tuple[float, float, float]]:
    kind, k = name.split("_X")[0], int(name.split("_X")[1])
    i = {1: 1, 2: 1, 4: 2, 8: 4, 16: 8}[k]
    inputs = int(kind[-1]) if kind[-1].isdigit() else 1
    series, parallel = (inputs + 2) / 3, (2 * inputs + 1) / 3
    last = (1, 1, k)
    shapes: dict[str, list[tuple[float, float, float]]] = {
        "INV": [last], "BUF": [(1, 1, i), last], f"NAND{inputs}": [(inputs, series, k)], f"NOR{inputs}": [(inputs, parallel, k)],
        f"AND{inputs}": [(inputs, series, i), last], f"OR{inputs}": [(inputs, parallel, i), last],
        "AOI21": [(7 / 3, 5 / 3 if pin == "B" else 2, k)], "OAI21": [(8 / 3, 4 / 3 if pin == "B" else 2, k)], "AOI22": [(4, 2, k)],
        "OAI22": [(4, 2, k)], "AOI211": [(10 / 3, 8 / 3 if pin[0] == "A" else 7 / 3, k)],
        "OAI211": [(11 / 3, 7 / 3 if pin[0] == "A" else 5 / 3, k)], "XOR2": [(2, 5 / 3, 1), (7 / 3, 5 / 3, k)],
        "XNOR2": [(2, 4 / 3, 1), (8 / 3, 4 / 3, k)], "MUX2": [*([(1, 1, 1)] if pin == "S" else []), (4, 2, i), last],
        "HA": [(2, 5 / 3, 1), (7 / 3, 5 / 3, 1)] if output == "S" else [(2, 4 / 3, 1), last],
        "FA": [*([(4, 2, 1)] if output == "S" else []), (4, 2, 1), last], "CLKGATE": [(2, 4 / 3, i), last]}
    return shapes[kind]


# Pitches of a NAND2's third, and loads of the pins in inverter inputs.
PITCHES = {
    "INV": (2, 3, 5, 9, 17), "BUF": (3, 4, 7, 13, 25), "NAND2": (3, 5, 9), "NAND3": (4, 7, 13), "NAND4": (5, 9, 17), "NOR2": (3, 5, 9),
    "NOR3": (4, 7, 13), "NOR4": (5, 9, 17), "AND2": (4, 5, 9), "AND3": (5, 6, 11), "AND4": (6, 7, 13), "OR2": (4, 5, 9), "OR3": (5, 6, 11),
    "OR4": (6, 7, 13), "AOI21": (4, 7, 13), "OAI21": (4, 7, 13), "AOI22": (5, 9, 17), "OAI22": (5, 9, 17), "AOI211": (5, 9, 17),
    "OAI211": (5, 9, 17), "XOR2": (6, 9), "XNOR2": (6, 9), "MUX2": (7, 8), "HA": (10,), "FA": (16,), "TIE0": (2,), "TIE1": (2,),
    "DFF": (15, 16), "DFFR": (18, 19), "DFFS": (18, 19), "DLATCH": (9,), "CLKGATE": (12, 13, 17)}  # fmt: skip
FUNCTIONS = {
    "INV": "!A", "BUF": "A", "NAND3": "!(A1 * A2 * A3)", "NOR2": "!(A1 + A2)", "AND2": "(A1 * A2)", "OR4": "(A1 + A2 + A3 + A4)",
    "AOI21": "!((A1 * A2) + B)", "OAI21": "!((A1 + A2) * B)", "AOI22": "!((A1 * A2) + (B1 * B2))", "OAI22": "!((A1 + A2) * (B1 + B2))",
    "AOI211": "!((A1 * A2) + B + C)", "OAI211": "!((A1 + A2) * B * C)", "XOR2": "(A ^ B)", "XNOR2": "!(A ^ B)",
    "MUX2": "((A * !S) + (B * S))", "TIE0": "0", "TIE1": "1", "DFF": "IQ"}  # fmt: skip
# Voltage, temperature, and times of gates, clock to Q, setup, hold and leakage relative to the typical corner.
BY_HAND = {"typical": (1.1, 25, 1, 1, 1, 1, 1), "slow": (0.95, 125, 3.13953, 3.40566, 4.72414, 3.41176, 0.65),
           "fast": (1.25, 0, 0.62016, 0.57547, 0.89655, 0.47059, 3.39655)}
# 0.5 - 0.65 / 2.3 = 0.217391 and 2 (1.125 + 0.6875 ln(5.5 / e)) = 3.219029 give the three coefficients.
STEP, RAMP, SLEW = 0.588308, 0.362319, 1.136271
INVERTER = 1.511111  # fF: 1.70 x 40 / 45


class ByHand(unittest.TestCase):
    libraries: dict[str, liberty.Group]

    @classmethod
    def setUpClass(cls) -> None:
        cls.libraries = {corner.name: liberty.parse(standard_cells.library(corner), corner.name) for corner in (TYPICAL, SLOW, FAST)}

    def cells(self, corner: str = "typical") -> dict[str, liberty.Group]:
        return {cell.name: cell for cell in self.libraries[corner].children("cell")}

    def near(self, found: float, expected: float, of: str) -> None:
        self.assertAlmostEqual(found / expected if expected else found + 1, 1, delta=2e-4, msg=of)

    @staticmethod
    def numbers(group: liberty.Group, name: str) -> list[list[float]]:
        return [[float(text) for text in row.split(",")] for row in dict(group.attributes)[name]]

    def test_every_cell_and_its_area_and_leakage(self) -> None:
        expected = {f"{kind}_X{2**step}": pitches for kind, found in PITCHES.items() for step, pitches in enumerate(found)}
        for corner, factors in BY_HAND.items():
            cells = self.cells(corner)
            self.assertEqual(set(cells), set(expected))
            for name, pitches in expected.items():
                self.near(cells[name].number("area"), 0.2352 * pitches, name)
                nw = 79 * pitches / 15 if name.startswith(("DFF", "DLATCH", "CLKGATE")) else 17 / 3 * pitches
                self.near(cells[name].number("cell_leakage_power"), nw * factors[6], name)

    def test_loads_of_pins(self) -> None:
        # The first stage of each path; further: the second stage of an XOR, the select's inverter, the gates of adders.
        more = {"XOR2_X1": 2, "XOR2_X2": 4, "XNOR2_X1": 2, "XNOR2_X2": 4}
        adders = {"HA_X1": {"A": 5, "B": 5}, "FA_X1": {"A": 4, "B": 4, "CI": 3}}
        for name, cell in self.cells().items():
            pins = {pin.name: pin for pin in cell.children("pin")}
            output = next(name for name, pin in pins.items() if pin.get("direction") == "output")
            for pin, group in pins.items():
                if group.get("direction") == "output":
                    self.near(group.number("max_capacitance"), 24 * INVERTER * int(name.split("_X")[1]), name)
                elif name.startswith("CLKGATE") and pin == "CK":  # 1.84, 2.56 and 4.25 fF x 40 / 45
                    self.near(group.number("capacitance"), {"1": 1.635556, "2": 2.275556, "4": 3.777778}[name[-1]], name)
                elif name.startswith(("DFF", "DLATCH", "CLKGATE")):
                    self.near(group.number("capacitance"), 0.844444 if pin in ("CK", "G") else 1.013333, f"{name}/{pin}")
                else:
                    _, effort, drive = stages(name, output, pin if name[:4] != "MUX2" else "A")[0]
                    expected = adders.get(name, {}).get(pin, effort * drive + more.get(name, 0) + (1 if name.startswith("MUX2") and pin == "S" else 0))
                    self.near(group.number("capacitance"), expected * INVERTER, f"{name}/{pin}")

    def test_functions_and_senses(self) -> None:
        cells = self.cells()
        for kind, function in FUNCTIONS.items():
            driven = next(pin for pin in cells[f"{kind}_X1"].children("pin") if pin.get("direction") == "output")
            self.assertEqual(driven.get("function"), function)
        for name, output, expected in (("NAND2_X1", "Y", "negative_unate"), ("AND3_X2", "Y", "positive_unate"), ("INV_X4", "Y", "negative_unate"),
                                       ("BUF_X1", "Y", "positive_unate"), ("XOR2_X1", "Y", "non_unate"), ("AOI22_X1", "Y", "negative_unate"),
                                       ("FA_X1", "S", "non_unate"), ("FA_X1", "CO", "positive_unate"), ("HA_X1", "CO", "positive_unate")):
            pin = next(pin for pin in cells[name].children("pin") if pin.name == output)
            self.assertEqual({arc.get("timing_sense") for arc in pin.children("timing")}, {expected}, name)
        adders = {pin.name: pin.get("function") for name in ("HA_X1", "FA_X1") for pin in cells[name].children("pin") if pin.get("function")}
        self.assertEqual(adders, {"S": "(A ^ B ^ CI)", "CO": "((A * B) + (CI * (A + B)))"})
        mux = next(pin for pin in cells["MUX2_X1"].children("pin") if pin.name == "Y")
        self.assertEqual({arc.get("related_pin"): arc.get("timing_sense") for arc in mux.children("timing")},
                         {"A": "positive_unate", "B": "positive_unate", "S": "non_unate"})

    def test_every_delay_slew_and_energy_of_the_gates(self) -> None:
        arcs = 0
        for corner, (voltage, _, factor, *_) in BY_HAND.items():
            tau = 0.0056 * factor
            for name, cell in self.cells(corner).items():
                if name.startswith(("DFF", "DLATCH", "TIE")):
                    continue
                drive = int(name.split("_X")[1])
                for output in (pin for pin in cell.children("pin") if pin.get("direction") == "output"):
                    energies = {power.get("related_pin"): power for power in output.children("internal_power")}
                    for arc in output.children("timing"):
                        path = stages(name, output.name, arc.get("related_pin"))
                        arcs += 1
                        for edge in ("rise", "fall"):
                            times = {table.kind: table for table in arc.groups}
                            delays, slews = times[f"cell_{edge}"], times[f"{edge}_transition"]
                            for index, multiple in enumerate((1, 6, 20, 80)):
                                self.near(self.numbers(delays, "index_1")[0][index], tau * multiple, name)
                                for column, load in enumerate((0.5, 4, 12, 24)):
                                    self.near(self.numbers(delays, "index_2")[0][column], INVERTER * drive * load, name)
                                    delay, slew = 0.0, tau * multiple
                                    for number, (parasitic, _, k) in enumerate(path):
                                        behind = path[number + 1][1] * path[number + 1][2] if number + 1 < len(path) else drive * load
                                        effort = parasitic + behind / k
                                        delay += STEP * tau * effort + RAMP * slew
                                        slew = SLEW * tau * effort
                                    self.near(self.numbers(delays, "values")[index][column], delay, f"{name} {arc.get('related_pin')}")
                                    self.near(self.numbers(slews, "values")[index][column], slew, name)
                        switched = sum(parasitic * k for parasitic, _, k in path) + sum(effort * k for _, effort, k in path[1:])
                        for table in energies[arc.get("related_pin")].groups:
                            self.near(self.numbers(table, "values")[0][0], 0.5 * switched * INVERTER * voltage**2, name)
        self.assertGreater(arcs, 3 * 150)

    def test_registers(self) -> None:
        # Clock to Q 0.106 ns, setup 0.029, hold 0.017 by 28 / 25.8, into a fan-out of four of drive 1; other loads as an inverter's.
        for corner, (voltage, _, gate, clock_to_q, setup, hold, _) in BY_HAND.items():
            tau = 0.0056 * gate
            for name, drive in (("DFF_X1", 1), ("DFF_X2", 2), ("DFFR_X1", 1), ("DFFS_X2", 2), ("DLATCH_X1", 1)):
                pins = {pin.name: pin for pin in self.cells(corner)[name].children("pin")}
                for arc in pins["Q"].children("timing"):
                    for table in arc.groups:
                        for row in self.numbers(table, "values"):
                            for value, load in zip(row, (0.5, 4, 12, 24), strict=True):
                                slew = table.kind.endswith("transition")
                                self.near(value, SLEW * tau * (1 + load) if slew else 0.1150388 * clock_to_q + STEP * tau * (load - 4), name)
                checks = {arc.get("timing_type"): self.numbers(arc.groups[0], "values")[0][0] for pin in pins.values() for arc in pin.children("timing")
                          if pin.get("direction") == "input"}
                kinds: tuple[str, ...] = ("setup_falling", "hold_falling") if name == "DLATCH_X1" else ("setup_rising", "hold_rising")
                if name[:4] in ("DFFR", "DFFS"):
                    kinds += ("recovery_rising", "removal_rising")
                self.assertEqual(set(checks), set(kinds))
                for kind, value in checks.items():
                    self.near(value, 0.0314729 * setup if kind.startswith(("setup", "recovery")) else 0.0184496 * hold, kind)
                if name != "DLATCH_X1":
                    # 7 times the clock pin on each edge; Q: the parasitics of four inverters and the inputs of three.
                    for pin, ff in (("CK", 7 * 0.844444), ("Q", 7 * INVERTER)):
                        power, = pins[pin].children("internal_power")
                        for table in power.groups:
                            self.near(self.numbers(table, "values")[0][0], 0.5 * ff * voltage**2, f"{name}/{pin}")

    def test_what_registers_do(self) -> None:
        cells = self.cells()
        for name, attributes, pin in (("DFF_X1", {"next_state": "D", "clocked_on": "CK"}, ""),
                                      ("DFFR_X2", {"next_state": "D", "clocked_on": "CK", "clear": "!RN"}, "RN"),
                                      ("DFFS_X1", {"next_state": "D", "clocked_on": "CK", "preset": "!SN"}, "SN")):
            state, = cells[name].children("ff")
            self.assertEqual((state.args, dict(state.attributes)), (["IQ", "IQN"], attributes))
            pins = {one.name: one for one in cells[name].children("pin")}
            self.assertEqual((set(pins), pins["CK"].get("clock")), ({"D", "CK", "Q", *([pin] if pin else [])}, "true"))
            arcs = [(arc.get("related_pin"), arc.get("timing_type"), arc.get("timing_sense")) for arc in pins["Q"].children("timing")]
            action = {"RN": [("RN", "clear", "positive_unate")], "SN": [("SN", "preset", "negative_unate")]}.get(pin, [])
            self.assertEqual(arcs, [("CK", "rising_edge", "non_unate"), *action])
        state, = cells["DLATCH_X1"].children("latch")
        self.assertEqual(dict(state.attributes), {"data_in": "D", "enable": "G"})
        latch = next(pin for pin in cells["DLATCH_X1"].children("pin") if pin.name == "Q")
        self.assertEqual([(arc.get("related_pin"), arc.get("timing_type"), arc.get("timing_sense")) for arc in latch.children("timing")],
                         [("D", "", "positive_unate"), ("G", "rising_edge", "")])

    def test_a_clock_gate(self) -> None:
        # Its clock is earlier by NAND2 and inverter into 12 inverters without an input slew: 3 + 13 stages' steps and the edge between them. With
        # drives 2 and 4 the NAND2 drives an inverter of twice its size: 4 + 13.
        for (corner, (voltage, _, gate, _, setup, hold, _)), (name, nand2) in itertools.product(BY_HAND.items(), (("1", 3), ("2", 4), ("4", 4))):
            cell = self.cells(corner)[f"CLKGATE_X{name}"]
            pins = {pin.name: pin for pin in cell.children("pin")}
            early = 0.0056 * gate * ((nand2 + 13) * STEP + RAMP * SLEW * nand2)
            found = {arc.get("timing_type"): self.numbers(arc.groups[0], "values")[0][0] for arc in pins["E"].children("timing")}
            self.near(found["setup_rising"], 0.0314729 * setup + early, corner)
            self.near(found["hold_rising"], 0.0184496 * hold, corner)
            power, = pins["CK"].children("internal_power")
            self.near(self.numbers(power.groups[0], "values")[0][0], 0.5 * 4 * 0.844444 * voltage**2, corner)
            self.assertEqual((cell.get("clock_gating_integrated_cell"), pins["GCK"].get("state_function")), ("latch_posedge", "CK * E"))
            self.assertEqual({(name, role) for name, pin in pins.items() for role in ("clock", "enable", "out")
                              if pin.get(f"clock_gate_{role}_pin") == "true"}, {("CK", "clock"), ("E", "enable"), ("GCK", "out")})

    def test_what_holds_for_the_library(self) -> None:
        for corner, (voltage, temperature, gate, *_) in BY_HAND.items():
            found = self.libraries[corner]
            self.assertEqual((found.number("nom_voltage"), found.number("nom_temperature"), found.get("default_operating_conditions")),
                             (voltage, temperature, corner))
            self.near(found.number("default_max_transition"), 80 * 0.0056 * gate, corner)
            self.near(found.number("default_input_pin_cap"), INVERTER, corner)
            conditions, = found.children("operating_conditions")
            self.assertEqual((conditions.number("voltage"), conditions.number("temperature")), (voltage, temperature))
            wire, = found.children("wire_load")
            self.assertEqual((wire.name, wire.number("capacitance"), wire.number("slope"), dict(wire.attributes)["fanout_length"]),
                             (found.get("default_wire_load"), 0.18, 2.0, ["1", "2.0"]))
            template, = found.children("lu_table_template")
            self.assertEqual((template.get("variable_1"), len(self.numbers(template, "index_1")[0]), len(self.numbers(template, "index_2")[0])),
                             ("input_net_transition", 4, 4))


if __name__ == "__main__":
    unittest.main()
