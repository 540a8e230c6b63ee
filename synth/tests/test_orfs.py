# SPDX-License-Identifier: Apache-2.0
"""Files for OpenROAD-flow-scripts: LEF, Liberty and RTL name the same pins; LEF has the forms of the platform's own macros."""

import io
import re
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import liberty, orfs
from dtof_synth.configuration import load

ROOT = Path(__file__).resolve().parents[2]
PLATFORM_LEFS = sorted((ROOT.parent / "shared" / "pdk" / "fakeram45").glob("*.lef"))
BLOCKS = {"MACRO", "PIN", "PORT", "OBS"}
SIGNATURES = {"RECT": 4, "SIZE": 3, "FOREIGN": 3, "LAYER": 1, "CLASS": 1, "DIRECTION": 1, "USE": 1}


def statements(text: str) -> list[tuple[tuple[str, ...], list[str]]]:
    """(blocks around it, words) of every statement of a LEF; ValueError where blocks and ends do not match."""
    found: list[tuple[tuple[str, ...], list[str]]] = []
    around: list[str] = []
    names: list[list[str]] = []
    for line in text.splitlines():
        words = line.split()
        if not words:
            continue
        if words == ["END", "LIBRARY"]:
            if around:
                raise ValueError(f"{around} does not end")
            return found
        if words[0] == "END":
            if not around or len(words) != (2 if names[-1] else 1) or words[1:] != names[-1]:
                raise ValueError(f"{line} ends nothing")
            around.pop(), names.pop()
        elif words[0] in BLOCKS:
            around.append(words[0])
            names.append(words[1:])
        else:
            if words[-1] != ";":
                raise ValueError(f"{line} has no end")
            found.append((tuple(around), words[:-1]))
    raise ValueError("no END LIBRARY")


def lef_pins(text: str) -> dict[str, str]:
    """Direction of every pin but the supplies."""
    found = re.findall(r"^  PIN (\S+)\n    DIRECTION (\S+) ;\n    USE (\S+) ;", text, re.MULTILINE)
    return {name: direction.lower() for name, direction, use in found if use == "SIGNAL"}


def liberty_pins(cell: liberty.Group) -> dict[str, str]:
    found = {pin.name: pin.get("direction") for pin in cell.children("pin")}
    for bus in cell.children("bus"):
        width = int(bus.get("bus_type").split("_")[1])
        found |= {f"{bus.name}[{bit}]": bus.get("direction") for bit in range(width)}
    return found


class Files(unittest.TestCase):
    temporary: tempfile.TemporaryDirectory[str]
    folders: dict[str, Path]

    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = tempfile.TemporaryDirectory()
        named = load(ROOT / "configurations.toml")
        cls.folders = {}
        for name in orfs.DEFAULT:
            cls.folders[name] = Path(cls.temporary.name) / name
            orfs.write(orfs.small(named[name], 4), cls.folders[name], ROOT)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.temporary.cleanup()

    def test_pins_agree(self) -> None:
        for folder in self.folders.values():
            cells = {cell.name: cell for cell in liberty.read(folder / "sram40_typical.lib").children("cell")}
            lefs = {path.stem: path.read_text(encoding="utf-8") for path in folder.glob("*.lef")}
            self.assertEqual(set(cells), set(lefs))
            for name, text in lefs.items():
                self.assertEqual(lef_pins(text), liberty_pins(cells[name]), name)
                wrong = lef_pins(text.replace("PIN clk_i", "PIN clock_i"))
                self.assertNotEqual(wrong, liberty_pins(cells[name]))

    def test_inside_and_apart(self) -> None:
        """Every shape lies inside the macro, on the grid of 5 nm; shapes of metal4 do not touch each other."""
        for folder in self.folders.values():
            for path in folder.glob("*.lef"):
                found = statements(path.read_text(encoding="utf-8"))
                width, _, height = next(words[1:] for _, words in found if words[0] == "SIZE")
                layer, shapes = "", []
                for _, words in found:
                    if words[0] == "LAYER":
                        layer = words[1]
                    if words[0] == "RECT":
                        left, low, right, high = (round(float(word) * 1000) for word in words[1:])
                        self.assertTrue(0 <= left < right <= float(width) * 1000 and 0 <= low < high <= float(height) * 1000)
                        self.assertEqual({number % 5 for number in (left, low, right, high)}, {0}, path)
                        if layer == "metal4":
                            shapes.append((left, right, low, high))
                shapes.sort()
                for one, other in zip(shapes, shapes[1:]):
                    self.assertTrue(one[1] < other[0] or one[3] < other[2] or other[3] < one[2], (path, one, other))

    def test_config(self) -> None:
        for name, folder in self.folders.items():
            text = (folder / "config.mk").read_text(encoding="utf-8")
            settings = dict(re.findall(r"^export (\w+) = (.*(?:\\\n.*)*)$", text, re.MULTILINE))
            for file in re.findall(r"\$\(PROJECT\)/(\S+)", text):
                self.assertTrue((ROOT / file).exists(), file)
            for file in re.findall(r"\$\(FOLDER\)/(\S+\.\w+)", text):
                self.assertTrue((folder / file).is_file(), file)
            parameters = settings["VERILOG_TOP_PARAMS"].split()
            values = dict(zip(parameters[::2], parameters[1::2]))
            self.assertEqual((values["SRAM_NUM"], len(parameters) % 2), ("4", 0))
            self.assertEqual(values.get("ENGINE_COLUMNS", "4"), "4")
            self.assertIn("dtof.sdc", (folder / "constraint.sdc").read_text(encoding="utf-8"), name)

    def test_reader_notices(self) -> None:
        good = next(self.folders["ezpointer"].glob("*.lef")).read_text(encoding="utf-8")
        for bad in (good.replace("  END clk_i\n", "", 1), good.replace(" ;", "", 1),
                    good.replace("END LIBRARY", "")):
            with self.assertRaises(ValueError):
                statements(bad)

    @unittest.skipUnless(PLATFORM_LEFS, "the platform's macros are not here")
    def test_forms_of_the_platform(self) -> None:
        """No statement, in no block, that its macros do not have, with as many words."""
        known = set()
        for path in PLATFORM_LEFS:
            known |= {(around, words[0], SIGNATURES.get(words[0]) and len(words) - 1)
                      for around, words in statements(path.read_text(encoding="utf-8"))}
        for folder in self.folders.values():
            for path in folder.glob("*.lef"):
                for around, words in statements(path.read_text(encoding="utf-8")):
                    self.assertIn((around, words[0], SIGNATURES.get(words[0]) and len(words) - 1), known, path)
        self.assertNotIn((("MACRO",), "ORIGIN", None), known)

    def test_refusals(self) -> None:
        for arguments, sentence in ((["sifg"], "unknown configuration 'sifg'"), (["--columns", "1"], "at least 2")):
            with mock.patch("sys.argv", ["orfs.py", *arguments]), mock.patch("sys.stderr", io.StringIO()) as said:
                self.assertEqual(orfs.main(), 1)
            self.assertIn(sentence, said.getvalue())


if __name__ == "__main__":
    unittest.main()
