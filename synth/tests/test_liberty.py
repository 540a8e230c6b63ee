# SPDX-License-Identifier: Apache-2.0
import unittest

from dtof_synth import liberty
from dtof_synth.errors import FlowError
from dtof_synth.liberty import Group

TEXT = """/* a comment */ library (demo) {
  time_unit : "1ns";
  capacitive_load_unit (1, ff);
  cell (INV) { area : 0.5; pin (A) { direction : input; capacitance : 1.5; }
    pin (Y) { direction : output; function : "!A";
      timing () { values ("1, 2", \\
                          "3, 4"); } } }
}
"""


class Liberty(unittest.TestCase):
    def test_parse(self):
        library = liberty.parse(TEXT, "demo")
        self.assertEqual(library.name, "demo")
        cell = library.children("cell")[0]
        self.assertEqual(cell.number("area"), 0.5)
        self.assertEqual([pin.name for pin in cell.children("pin")], ["A", "Y"])
        timing = cell.children("pin")[1].children("timing")[0]
        self.assertEqual(dict(timing.attributes)["values"], ["1, 2", "3, 4"])

    def test_a_string_may_end_an_attribute_without_a_semicolon(self):
        library = liberty.parse('library (x) { cell (C) { when : "a & b"\n timing () { type : setup; } area : 2; } }', "x")
        cell = library.children("cell")[0]
        self.assertEqual(cell.get("when"), "a & b")
        self.assertEqual(cell.children("timing")[0].get("type"), "setup")
        self.assertEqual(cell.number("area"), 2)

    def test_written_text_parses_to_the_same_tree(self):
        library = Group("library", ["x"], [("a", '"1"'), ("b", ["1", "ff"])],
                        [Group("cell", ["C"], [("area", "2")])], [("last", "z")])
        again = liberty.parse(library.write(), "x")
        self.assertEqual(again.get("a"), "1")
        self.assertEqual(again.get("last"), "z")
        self.assertEqual(again.children("cell")[0].number("area"), 2)

    def test_a_bus_is_descending_from_its_width_to_its_lowest_bit(self):
        for arguments, name, first, last in (((3,), "bits_3_0", "2", "0"), ((4, 5), "bits_4_5", "8", "5")):
            bus = liberty.bus_type(*arguments)
            self.assertEqual((bus.name, bus.get("bit_from"), bus.get("bit_to")), (name, first, last))

    def test_broken_texts_are_refused(self):
        for text in ("", "library (x) { cell (", "library (x) { area 5 }", "module x; endmodule"):
            with self.subTest(text=text), self.assertRaises(FlowError):
                liberty.parse(text, "broken")


if __name__ == "__main__":
    unittest.main()
