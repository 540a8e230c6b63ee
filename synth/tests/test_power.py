# SPDX-License-Identifier: Apache-2.0
import tempfile
import unittest
from pathlib import Path

from dtof_synth import configuration, power, scene_power, sram_model, standard_cells, tools, wide_words
from dtof_synth.library import Buffer, Library

from .partial import part_of

SYNTH = Path(__file__).resolve().parents[1]
NAMED = configuration.load(SYNTH.parent / "configurations.toml")


class WideWords(unittest.TestCase):
    def one(self, name):
        parts = scene_power.Parts(columns=70.0, engines=0.0, control=1.0, sram=60.0, clock=40.0, leakage=10.0, sram_reads=50.0)
        return scene_power.ScenePower(NAMED[name], "day", 0.1, 0.0, parts, parts, 0.0, 0.0, 1, 1)

    def test_reads_alone_cost_more(self) -> None:
        lines = scene_power.wide_word_lines([self.one("poolpointer")])
        title, light, bits, reads, total, factor, more = lines[-1].strip("| ").split(" | ")
        self.assertEqual((title, light, bits, reads, total), ("poolPointer", "day", "232", "50.0", "181.0"))
        self.assertAlmostEqual(float(more), 181.0 + 50.0 * (wide_words.read_factor(232) - 1), delta=0.05)
        self.assertEqual(factor, f"x {wide_words.read_factor(232):.2f}")

    def test_narrow_words_are_not_in_doubt(self) -> None:
        self.assertEqual(scene_power.wide_word_lines([self.one("hispointer")]), [])


class DataPower(unittest.TestCase):
    def test_the_clock_and_leakage_are_taken_off(self) -> None:
        output = ("DTOF_POWER CLOCK column 4.0e-06 1.0e-06 5.0e-09\n"
                  "DTOF_POWER ALL column 7.0e-06 3.0e-06 1.0e-08\n")
        self.assertAlmostEqual(power.data_mw(output), ((7.0 - 4.0) / 2 + 3.0 - 1.0) * 1e-3)

    def test_the_array_is_one_column_times_all_and_what_they_share(self) -> None:
        output = "".join(f"DTOF_POWER {label} {group} {internal} {switching} 1.0e-05\n" for label, group, internal, switching in (
            ("CLOCK", "column", 4.0e-6, 0.0), ("CLOCK", "shared", 2.0e-6, 0.0), ("ALL", "column", 6.0e-6, 3.0e-6),
            ("ALL", "shared", 8.0e-6, 5.0e-6)))
        self.assertAlmostEqual(power.logic_mw(output, 10), (10 * (1 + 3 + 10) + 3 + 5 + 10) * 1e-3)

    def test_opensta_charges_a_column_by_the_rate_of_its_nets(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "typical.lib").write_text(standard_cells.library(standard_cells.TYPICAL), encoding="utf-8")
            (folder / "netlist.v").write_text(
                "module t(clk_i, a, y); input clk_i, a; output y; wire n; INV_X1 out(.A(n), .Y(y));\n"
                " own u_column(.clk_i(clk_i), .a(a), .y(n)); endmodule\n"
                "module own(clk_i, a, y); input clk_i, a; output y; wire m, g;\n"
                " CLKGATE_X1 e(.CK(clk_i), .E(a), .GCK(g)); DFF_X1 r(.D(a), .CK(g), .Q(m)); INV_X1 i(.A(m), .Y(y)); endmodule\n",
                encoding="utf-8")
            found = []
            for rate in (0.1, 0.3):
                settings = folder / "settings.tcl"
                tools.write_settings(settings, {
                    "liberty_files": [folder / "typical.lib"], "netlist": folder / "netlist.v", "top": "t",
                    "wire_load": standard_cells.WIRE_LOAD, "period": "3.0", "column": "u_column", "activity": f"{rate}"})
                output = tools.run_sta(SYNTH / "sta" / "power.tcl", settings, folder / "sta.log", "test")
                found.append(power.data_mw(output))
            # The net behind the register carries an inverter and two micrometres of wire.
            inverter = standard_cells.inverter()
            internal = sum(standard_cells._path_energy(path, 1.1) for path in ((inverter,) * 4, (inverter,)))
            wire = standard_cells.WIRE_FF_PER_UM * standard_cells.WIRE_UM_PER_FANOUT
            nets = 0.5 * 2 * (standard_cells.CINV_FF + wire) * 1.1**2
            self.assertAlmostEqual(found[0] / (0.1 * (internal + nets) / 3.0 * 1e-3), 1, delta=0.02)
            self.assertAlmostEqual(found[1] / found[0], 3, delta=0.01)


class Clock(unittest.TestCase):
    def test_the_tree_has_a_level_of_buffers_for_each_load_that_is_too_large(self) -> None:
        # 1,000 flip-flops of 1 fF and 0.5 fF of wire each are 1,500 fF; a buffer takes half of 160 fF: 19 buffers, whose pins of
        # 2 fF and wires of 0.5 fF are 47.5 fF. One buffer drives these.
        library = part_of(Library, buffers=[Buffer("BUF_X16", "A", "Y", 3.0, 2.0, 160.0)], wire_ff_per_sink=0.5)
        tree = power.clock_tree(1000, 1000.0, library)
        self.assertEqual((tree.buffers, tree.area, tree.load_ff), (19, 57.0, 1547.5))

    def test_a_clock_charges_pins_and_tree_once(self) -> None:
        # OpenSTA's internal power is halved: 10 columns of 2 uW and 1 uW beside them are 0.021 mW; 1,000 fF at 1.1 V and 330 MHz
        # are 0.3993 mW.
        output = "DTOF_POWER CLOCK column 4.0e-06 9.0 9.0\nDTOF_POWER CLOCK shared 2.0e-06 9.0 9.0\n"
        found = power.clock_mw(output, 10, power.ClockTree(1, 1.0, 1000.0), part_of(Library, voltage=1.1), 330.0)
        self.assertAlmostEqual(found, 0.021 + 0.3993, places=9)


class Accesses(unittest.TestCase):
    """Reads and writes a clock of each SRAM of a column, by hand, with two slots a pixel."""

    def test_rates(self) -> None:
        for name, rates in (
                # Words of two rows: a word in four clocks, in three quarters of the frame; two parts of each in the first.
                ("poolpointer", {"pixels and groups": (0.25 * 2 * 0.25 + 0.75 * 0.25,) * 2}),
                ("ezpointer", {"pointer": (0.5, 0.5)}),
                # The histogram is counted in for half of the frame, a quarter of the slots hold a detection.
                ("hispointer", {"histogram": (0.125, 0.125), "pointer": (0.25, 0.25)}),
                ("sifh", {"histogram": (0.25, 0.25)})):
            found = power.access_rates(NAMED[name])
            self.assertEqual({use: found[use] for use in rates}, rates, name)
        self.assertEqual(power.access_rates(NAMED["poolpointer"])["pixels and groups"], (0.3125, 0.3125))

    def test_an_array_takes_its_accesses_and_leakage(self) -> None:
        # ezPointer: 200 SRAMs, each read and written in every second clock of 330 MHz.
        macro = sram_model.macro(sram_model.Size(2, 160, 14))
        expected = 200 * (0.5 * (macro.read_energy + macro.write_energy) * 330e-3 + macro.leakage * 1e-3)
        self.assertAlmostEqual(power.sram_mw(NAMED["ezpointer"], 330.0), expected, places=6)

    def test_memories_of_the_engines_leak(self) -> None:
        # poolPointer: 50 SRAMs of columns with 5 accesses in 16 clocks, reads and writes alike; 6 of engines, idle during a measurement.
        column, engine = (sram_model.macro(sram_model.Size(1, words, bits)) for words, bits in ((100, 232), (160, 33)))
        dynamic = 0.3125 * (column.read_energy + column.write_energy) * 330e-3
        expected = 50 * (dynamic + column.leakage * 1e-3) + 6 * engine.leakage * 1e-3
        self.assertAlmostEqual(power.sram_mw(NAMED["poolpointer"], 330.0), expected, places=8)


if __name__ == "__main__":
    unittest.main()
