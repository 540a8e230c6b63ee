# SPDX-License-Identifier: Apache-2.0
import csv
import gzip
import tempfile
import unittest
from pathlib import Path

from dtof_synth import ihp130, sram_model
from dtof_synth.errors import FlowError
from dtof_synth.sram_model import Size

ROOT = Path(__file__).resolve().parents[2]
PDK = ROOT.parent / "shared" / "pdk"


def compiled(ports: int, words: int, bits: int, area: float, access: float = 3.0) -> ihp130.Compiled:
    return ihp130.Compiled(f"{ports}P_{words}x{bits}", Size(ports, words, bits), 2, area, 1.0, access, access + 2, 0.4, 0.8)


class Choice(unittest.TestCase):
    MACROS = [compiled(1, 64, 64, 500), compiled(1, 256, 16, 300), compiled(1, 256, 64, 900), compiled(2, 256, 16, 600)]

    def test_the_smallest_that_holds_all_words(self) -> None:
        for size, copies, name in ((Size(1, 60, 60), 1, "1P_64x64"), (Size(1, 160, 14), 1, "1P_256x16"),
                                   (Size(1, 160, 20), 2, "1P_256x16"), (Size(1, 100, 116), 2, "1P_256x64"),
                                   (Size(2, 256, 16), 1, "2P_256x16")):
            chosen = ihp130.choose(size, self.MACROS)
            assert chosen is not None
            self.assertEqual((chosen[0], chosen[1].name), (copies, name), size)

    def test_too_many_words_or_other_ports(self) -> None:
        self.assertIsNone(ihp130.choose(Size(1, 257, 4), self.MACROS))
        self.assertIsNone(ihp130.choose(Size(2, 16, 4), self.MACROS[:3]))

    def test_the_memory_has_its_figures(self) -> None:
        memory = ihp130.macro(Size(1, 160, 20), self.MACROS)
        self.assertEqual((memory.banks, memory.area, memory.access_slow, memory.setup, memory.hold), (2, 600, 5.0, 0.4, 0.8))
        self.assertEqual(ihp130.macro(Size(1, 257, 4), self.MACROS), sram_model.macro(Size(1, 257, 4)))


def table(middle: float) -> str:
    """A table of 2 by 3 whose middle has this value; other values are larger and smaller."""
    return f'(t) {{ index_1 ("1, 2"); values ("90, 91, 92", "93, {middle}, 0.01"); }}'


def timing(kind: str, *tables: tuple[str, float]) -> str:
    return f"timing () {{ timing_type : {kind}; {' '.join(f'{name} {table(middle)}' for name, middle in tables)} }}"


def macro_liberty(access: float, setup: float) -> str:
    """Two pins with constraints, one of the self-test with larger ones, and a bus with the access times on its pin."""
    pins = [f"pin (A_{name}) {{ {timing('setup_rising', ('rise_constraint', setup - less), ('fall_constraint', setup - 0.1))} "
            f"{timing('hold_rising', ('rise_constraint', 0.1), ('fall_constraint', 0.3 - less))} }}" for name, less in (("MEN", 0.0), ("WEN", 0.2))]
    pins.append(f"pin (A_BIST_EN) {{ {timing('setup_rising', ('rise_constraint', 70.0))} {timing('rising_edge', ('cell_rise', 80.0))} }}")
    output = timing("rising_edge", ("cell_rise", access - 0.5), ("cell_fall", access), ("rise_transition", 50.0))
    return f"library (l) {{ cell (RM) {{ {' '.join(pins)} bus (A_DOUT) {{ pin (A_DOUT[0]) {{ {output} }} }} }} cell (OTHER) {{ }} }}"


class Read(unittest.TestCase):
    """A folder as the PDK has it, with one macro."""

    STEM = "RM_IHPSG13_2P_256x16_c3"

    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        for name, text in ((f"{self.STEM}.lef.gz", "MACRO x\n  SIZE 416.64 BY 118.78 ;\n"),
                           (f"{self.STEM}_typ_1p20V_25C.lib.gz", macro_liberty(2.5, 9.0)),
                           (f"{self.STEM}_slow_1p08V_125C.lib.gz", macro_liberty(4.0, 0.7))):
            (self.folder / name).write_bytes(gzip.compress(text.encode()))

    def test_figures_are_the_worst_of_the_functional_pins_in_the_middle_of_their_tables(self) -> None:
        found, = ihp130.read(self.folder)
        self.assertEqual(found, ihp130.Compiled(self.STEM, Size(2, 256, 16), 3, 416.64, 118.78, 2.5, 4.0, 0.7, 0.3))
        self.assertAlmostEqual(found.area, 416.64 * 118.78)

    def test_what_is_missing_is_named(self) -> None:
        with self.assertRaisesRegex(FlowError, "no timing of type hold_falling"):
            ihp130._worst(ihp130._cell(self.folder / f"{self.STEM}_typ_1p20V_25C.lib.gz"), "hold_falling", ("rise_constraint",))
        (self.folder / f"{self.STEM}_slow_1p08V_125C.lib.gz").unlink()
        with self.assertRaisesRegex(FlowError, "not a macro of which"):
            ihp130.read(self.folder)

    def test_cells_of_both_corners(self) -> None:
        self.assertEqual([path.name for path in ihp130.cells(Path("pdk"))],
                         ["sg13g2_stdcell_typ_1p20V_25C.lib.gz", "sg13g2_stdcell_slow_1p08V_125C.lib.gz"])


@unittest.skipUnless((PDK / "ihp130").is_dir(), f"{PDK}/ihp130 is not here")
class ThePdk(unittest.TestCase):
    def test_sizes_and_access_times_beside_a_list_read_by_hand(self) -> None:
        macros = {(macro.size.words, macro.size.bits): macro for macro in ihp130.read(PDK / "ihp130" / "sram")
                  if macro.size.ports == 1}
        compared = 0
        with (PDK / "sram_points" / "ihp130_1p.csv").open(encoding="utf-8") as file:
            for row in csv.DictReader(file):
                macro = macros.get((int(row["words"]), int(row["bits"])))
                if macro is None:
                    continue
                self.assertAlmostEqual(macro.width, float(row["w_um"]))
                self.assertAlmostEqual(macro.height, float(row["h_um"]))
                if row["clk2q_slow_ns"]:
                    self.assertAlmostEqual(macro.access_typical, float(row["clk2q_typ_ns"]), delta=0.15)
                    self.assertAlmostEqual(macro.access_slow, float(row["clk2q_slow_ns"]), delta=0.2)
                    compared += 1
        self.assertGreaterEqual(compared, 1)


if __name__ == "__main__":
    unittest.main()
