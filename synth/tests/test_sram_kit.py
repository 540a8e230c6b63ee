# SPDX-License-Identifier: Apache-2.0
"""The macros' Liberty in each corner against figures by hand."""

import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

from dtof_synth import liberty, sram_kit
from dtof_synth.sram_model import Size, macro
from dtof_synth.standard_cells import CINV_FF, FAST, FO4_NS, SLOW, TYPICAL

LARGEST = Size(2, 10240, 10)  # the access times are anchored here: 1.2 ns typical, 2.2 ns slow


class Liberty(unittest.TestCase):
    def pins(self, corner) -> dict[str, liberty.Group]:
        cell, = liberty.parse(sram_kit.liberty([macro(LARGEST)], corner), "macro").children("cell")
        return {pin.name: pin for pin in cell.groups if pin.kind in ("pin", "bus")}

    def test_access_and_cycle_of_each_corner(self):
        # The fast corner's gates take 16 / 25.8 of the typical ones' time.
        for corner, access in ((TYPICAL, 1.2), (SLOW, 2.2), (FAST, 1.2 * 16 / 25.8)):
            pins = self.pins(corner)
            self.assertAlmostEqual(pins["clk_i"].number("min_period"), access, places=3, msg=corner.name)
            arc, = pins["rdata_o"].children("timing")
            delays = [float(text) for text in dict(arc.children("cell_rise")[0].attributes)["values"][0].split(",")]
            self.assertAlmostEqual(delays[1], access, places=3, msg=corner.name)  # with a fan-out of four

    def test_setup_and_hold_of_every_input(self):
        for corner in (TYPICAL, SLOW, FAST):
            for name, pin in self.pins(corner).items():
                if pin.get("direction") != "input" or name == "clk_i":
                    continue
                found = {timing.get("timing_type"): [dict(edge.attributes)["values"][0] for edge in timing.groups]
                         for timing in pin.children("timing")}
                self.assertEqual(found, {"setup_rising": ["0.15", "0.15"], "hold_rising": ["0.05", "0.05"]}, f"{corner.name} {name}")

    def test_loads_and_energies(self):
        # A pin is two inverters, the clock 16; an output of drive 4 drives 24 times its own load. pJ are written as fJ, uW as nW.
        for size, conditions in ((LARGEST, ("re_i", "we_i")), (Size(1, 160, 14), ("en_i * !we_i", "en_i * we_i"))):
            one = macro(size)
            cell, = liberty.parse(sram_kit.liberty([one], TYPICAL), "macro").children("cell")
            pins = {pin.name: pin for pin in cell.groups if pin.kind in ("pin", "bus")}
            for name, pin in pins.items():
                if pin.get("direction") == "input":
                    self.assertAlmostEqual(pin.number("capacitance"), (16 if name == "clk_i" else 2) * CINV_FF, delta=1e-4, msg=name)
            self.assertAlmostEqual(pins["rdata_o"].number("max_capacitance"), 96 * CINV_FF, delta=1e-4)
            self.assertAlmostEqual(cell.number("area"), one.area, delta=0.01)
            self.assertAlmostEqual(cell.number("cell_leakage_power"), 1000 * one.leakage, delta=1e-4)
            energies = {power.get("when"): [float(dict(edge.attributes)["values"][0]) for edge in power.groups]
                        for power in pins["clk_i"].children("internal_power")}
            self.assertEqual(set(energies), set(conditions))
            for condition, picojoules in zip(conditions, (one.read_energy, one.write_energy)):
                self.assertAlmostEqual(energies[condition][0] / (1000 * picojoules), 1, delta=1e-5)
                self.assertEqual(energies[condition][1], 0.0)

    def test_an_access_is_later_by_the_load_behind_it(self):
        # A fifth of FO4 is the time constant; loads of 1, 4, 12 and 24 inverters of drive 4; a slew is that of load plus own capacitance.
        arc, = self.pins(TYPICAL)["rdata_o"].children("timing")
        tau = FO4_NS / 5 * TYPICAL.gate
        for table, values in (("cell_rise", [1.2 + tau * step for step in (-3, 0, 8, 20)]), ("rise_transition", [tau * step for step in (2, 5, 13, 25)])):
            for name in (table, table.replace("rise", "fall")):
                found = dict(arc.children(name)[0].attributes)
                for key, numbers in (("index_1", [4 * CINV_FF * step for step in (1, 4, 12, 24)]), ("values", values)):
                    for text, number in zip(found[key][0].split(","), numbers, strict=True):
                        self.assertAlmostEqual(float(text), number, delta=2e-4 * number, msg=f"{name} {key}")

    def test_words_and_addresses_are_buses(self):
        one, two = (liberty.parse(sram_kit.liberty([macro(Size(ports, 160, 14))], SLOW), "macro") for ports in (1, 2))
        for library, buses, pins, address in ((one, {"addr_i": 8, "wdata_i": 14, "rdata_o": 14}, {"clk_i", "en_i", "we_i"}, "addr_i"),
                                              (two, {"raddr_i": 8, "waddr_i": 8, "wdata_i": 14, "rdata_o": 14}, {"clk_i", "re_i", "we_i"}, "raddr_i")):
            cell, = library.children("cell")
            self.assertEqual({bus.name: bus.get("bus_type") for bus in cell.children("bus")},
                             {name: f"bits_{bits}_0" for name, bits in buses.items()})
            self.assertEqual({pin.name for pin in cell.children("pin")}, pins)
            self.assertEqual({group.name for group in library.children("type")}, {"bits_8_0", "bits_14_0"})
            read, = next(bus for bus in cell.children("bus") if bus.name == "rdata_o").children("memory_read")
            self.assertEqual(read.get("address"), address)
            memory, = cell.children("memory")
            self.assertEqual((memory.get("address_width"), memory.get("word_width")), ("8", "14"))


class Views(unittest.TestCase):
    SMALL = Size(1, 2, 2)

    def test_a_black_box_has_the_ports(self):
        self.assertEqual(sram_kit.black_boxes([macro(self.SMALL)]).split("\n\n")[1], "\n".join([
            "(* blackbox *)", "module sram_1rw_2x2 (", "    input wire clk_i,", "    input wire en_i,", "    input wire we_i,",
            "    input wire [0:0] addr_i,", "    input wire [1:0] wdata_i,", "    output wire [1:0] rdata_o", ");", "endmodule", ""]))

    def test_a_model_is_the_behavioural_memory_of_the_size(self):
        self.assertEqual(sram_kit.behavioural_models([self.SMALL, self.SMALL]).split("\n\n")[1], "\n".join([
            "module sram_1rw_2x2 (", "    input wire clk_i,", "    input wire en_i,", "    input wire we_i,", "    input wire [0:0] addr_i,",
            "    input wire [1:0] wdata_i,", "    output wire [1:0] rdata_o", ");",
            "  dtof_sram_1rw #(.DEPTH(2), .WIDTH(2)) u_memory (.clk_i(clk_i), .en_i(en_i), .we_i(we_i), .addr_i(addr_i), .wdata_i(wdata_i), "
            ".rdata_o(rdata_o), .wparts_i(1'b1), .cfg_i(1'b0), .cfg_o());", "endmodule", ""]))

    def test_a_macro_with_a_write_mask_has_a_pin_for_each_part(self):
        masked = Size(1, 4, 6, 3)
        self.assertIn(("wparts_i", "input", 3), sram_kit.pins(masked))
        self.assertIn("  dtof_sram_1rw #(.DEPTH(4), .WIDTH(6), .PARTS(3)) u_memory (.clk_i(clk_i), .en_i(en_i), .we_i(we_i), .addr_i(addr_i), "
                      ".wparts_i(wparts_i), .wdata_i(wdata_i), .rdata_o(rdata_o), .cfg_i(1'b0), .cfg_o());\n",
                      sram_kit.behavioural_models([masked]))
        text = sram_kit.technology_module(1, [Size(1, 4, 6), masked])
        self.assertIn("    input wire [PARTS-1:0] wparts_i,\n", text)
        self.assertIn("    if (DEPTH == 4 && WIDTH == 6 && PARTS == 1) begin : g_4x6\n      sram_1rw_4x6 u_macro (.clk_i(clk_i), .en_i(en_i), "
                      ".we_i(we_i), .addr_i(addr_i), .wdata_i(wdata_i), .rdata_o(rdata_o));\n", text)
        self.assertIn("    end else if (DEPTH == 4 && WIDTH == 6 && PARTS == 3) begin : g_4x6_3p\n      sram_1rw_4x6_3p u_macro (.clk_i(clk_i), "
                      ".en_i(en_i), .we_i(we_i), .addr_i(addr_i), .wparts_i(wparts_i), ", text)

    def test_a_module_selects_among_the_sizes_of_its_ports(self):
        text = sram_kit.technology_module(2, [Size(1, 9, 9), Size(2, 4, 3), Size(2, 5, 3)])
        self.assertIn("    input wire [(DEPTH > 1 ? $clog2(DEPTH) : 1)-1:0] raddr_i,\n", text)
        self.assertIn("    input wire [WIDTH-1:0] wdata_i,\n    output wire [WIDTH-1:0] rdata_o\n);\n", text)
        self.assertIn("    input wire clk_i,\n    input wire re_i,\n", text)
        ports = ", ".join(f".{name}({name})" for name in ("clk_i", "re_i", "raddr_i", "we_i", "waddr_i", "wdata_i", "rdata_o"))
        self.assertIn("    if (DEPTH == 4 && WIDTH == 3) begin : g_4x3\n"
                      f"      sram_1r1w_4x3 u_macro ({ports});\n"
                      "    end else if (DEPTH == 5 && WIDTH == 3) begin : g_5x3\n"
                      f"      sram_1r1w_5x3 u_macro ({ports});\n"
                      "    end else begin : g_unlisted\n      $fatal(", text)
        self.assertNotIn("9x9", text)
        self.assertIn("  generate\n    $fatal(", sram_kit.technology_module(1, []))

    def test_an_abstract_has_its_pins_in_a_row_and_nothing_may_cross_it(self):
        one = replace(macro(self.SMALL), width=31.5, height=24.25)
        lines = [line.strip() for line in sram_kit.lef([one]).splitlines()]
        self.assertIn("SIZE 31.500 BY 24.250 ;", lines)
        names = [line.split()[1] for line in lines if line.startswith("PIN ")]
        self.assertEqual(names, ["clk_i", "en_i", "we_i", "addr_i[0]", "wdata_i[0]", "wdata_i[1]", "rdata_o[0]", "rdata_o[1]"])
        places = [line for line in lines if line.startswith("RECT")]
        # 0.28 um from one 0.14 um square to the next.
        self.assertEqual(places[:2] + places[7:8], ["RECT 0.280 0.000 0.420 0.140 ;", "RECT 0.560 0.000 0.700 0.140 ;", "RECT 2.240 0.000 2.380 0.140 ;"])
        self.assertEqual(lines[lines.index("OBS"):], ["OBS", *(text for layer in (1, 2, 3) for text in (
            f"LAYER metal{layer} ;", "RECT 0.000 0.000 31.500 24.250 ;")), "END", "END sram_1rw_2x2", "END LIBRARY"])
        self.assertEqual([line for line in lines if line.startswith(("USE", "DIRECTION"))][:4],
                         ["DIRECTION INPUT ;", "USE CLOCK ;", "DIRECTION INPUT ;", "USE SIGNAL ;"])
        self.assertEqual(lines.count("DIRECTION OUTPUT ;"), 2)

    def test_the_kit_has_all_files(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name) / "kit"
            macros = sram_kit.write_kit(folder, [Size(2, 4, 3), self.SMALL])
            self.assertEqual([one.size for one in macros], [self.SMALL, Size(2, 4, 3)])
            self.assertEqual({path.name for path in folder.iterdir()}, {
                "sram40_typical.lib", "sram40_slow.lib", "sram40_fast.lib", "sram40.lef", "sram40_blackbox.v", "dtof_sram_1rw.sv", "dtof_sram_1r1w.sv"})
            for corner in (TYPICAL, SLOW, FAST):
                self.assertEqual((folder / f"sram40_{corner.name}.lib").read_text(encoding="utf-8"), sram_kit.liberty(macros, corner))


if __name__ == "__main__":
    unittest.main()
