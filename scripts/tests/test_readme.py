# SPDX-License-Identifier: Apache-2.0
"""The examples of README.md and docs/ run as they stand, one after the other."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import update_readme
from figures import store

ROOT = Path(__file__).resolve().parent.parent.parent
# A command may go on behind a backslash, and some make their input with Python.
EXAMPLE = re.compile(r"^    ((?:build/cpp/|/usr/bin/python3 )(?:.*\\\n)*.*?)(?:\s+#.*)?$", re.MULTILINE)
# Those of the main job, which `make publish` copies: no example writes there.
MAIN_JOB = re.findall(r"^ *run_once (\w+)", (ROOT / "scripts" / "simulate.sh").read_text(encoding="utf-8"), re.MULTILINE)
PROGRAMS = ROOT / "build" / "cpp"
# Their commands need the files that they add: make test-adding runs those of the first in a clone that has them,
# test_adding_a_rival compiles those of the second.
ADDING = {ROOT / "docs" / "user" / name for name in ("adding_a_readout.md", "adding_a_rival.md")}


def examples(document: Path) -> list[str]:
    return EXAMPLE.findall(document.read_text(encoding="utf-8"))


@unittest.skipUnless((PROGRAMS / "bin" / "dtof").is_file(), "dtof is not built")
class Examples(unittest.TestCase):
    def run_examples(self, document: Path) -> int:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "build").mkdir()
            (Path(folder) / "build" / "cpp").symlink_to(PROGRAMS)
            commands = examples(document)
            for command in commands:
                with self.subTest(document=document.name, command=command):
                    done = subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True)
                    self.assertEqual(done.returncode, 0, done.stderr[-2000:])
                    for name in MAIN_JOB:
                        self.assertFalse((Path(folder) / "build" / name).exists(), f"build/{name} is the main job's")
            return len(commands)

    def test_readme(self) -> None:
        self.assertGreaterEqual(self.run_examples(ROOT / "README.md"), 8)

    def test_documents(self) -> None:
        documents = sorted(set(ROOT.glob("docs/**/*.md")) - ADDING)
        self.assertGreater(sum(self.run_examples(document) for document in documents), 0)


class MainJob(unittest.TestCase):
    def test_no_command_of_a_document_names_its_folders(self) -> None:
        self.assertEqual(MAIN_JOB, ["frame", "tmf8820"])
        for document in [ROOT / "README.md", *ROOT.glob("docs/**/*.md")]:
            for command in examples(document):
                for name in MAIN_JOB:
                    self.assertNotIn(f"--out build/{name}", f"{command} ".replace("\n", " "), document.name)

    @unittest.skipUnless((PROGRAMS / "bin" / "dtof").is_file(), "dtof is not built")
    def test_no_command_of_the_program_writes_there_by_default(self) -> None:
        for command in ("frame", "replay", "video"):
            text = subprocess.run([PROGRAMS / "bin" / "dtof", command, "--help"], capture_output=True, text=True,
                                  check=True).stdout
            default = re.search(r"--out TEXT(?:=| \[)build/(\w+)", text)  # of CLI11 2.3 and of 2.4
            assert default, text
            self.assertNotIn(default[1], MAIN_JOB)


class Results(unittest.TestCase):
    def test_the_block_is_replaced_and_the_rest_stays(self) -> None:
        text = "before\n" + update_readme.BEGIN + "old\n" + update_readme.END + "\nafter\n"
        new = update_readme.updated(text)
        self.assertTrue(new.startswith("before\n" + update_readme.BEGIN))
        self.assertTrue(new.endswith(update_readme.END + "\nafter\n"))
        self.assertNotIn("old\n", new)
        self.assertEqual(update_readme.updated(new), new)

    def test_scene_and_light_are_named(self) -> None:
        self.assertRegex(update_readme.Results(ROOT).scene(), r"Scene \w+: \d+ x \d+ pixels, [\d.]+ klux, sensor \w+")

    def test_power_is_that_of_the_activity_by_day(self) -> None:
        figures = store.load(ROOT)
        row, = [line for line in update_readme.Results(ROOT).table().splitlines() if line.startswith("| poolPointer |")]
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        self.assertEqual(cells[4], store.text("power.poolpointer.day_mw:.0f", figures))
        self.assertEqual(cells[2], store.text("area.poolpointer.placed_with_scan_and_clock_tree_mm2:.2f", figures))
        self.assertEqual(update_readme.quoted_reports(ROOT) - {"frame", "frames"}, {"synth", "power"})

    def test_standard_frames_stand_beside_each_other_once_they_are_measured(self) -> None:
        measured = {name: one for name, one in store.load(ROOT).items() if one.report != "frames"}
        for readout, share in (("ezpointer", "53.95"), ("poolpointer", "0.16")):
            for sensor in ("thesis", "thesis_1mhz"):
                measured[f"frames.{readout}.{sensor}_above_3_percent"] = store.Figure(share, "%", report="frames")
        with mock.patch.object(store, "load", lambda root: measured):
            lines = update_readme.Results(ROOT).table().splitlines()
        self.assertTrue(lines[0].endswith("| pixels off by > 3 %: thesis | pixels off by > 3 %: thesis_1mhz |"), lines[0])
        self.assertTrue(next(line for line in lines if "| poolPointer |" in line).endswith("| 0.16 % | 0.16 % |"))
        self.assertTrue(next(line for line in lines if "| SiFH |" in line).endswith("| - | - |"))


if __name__ == "__main__":
    unittest.main()
