# SPDX-License-Identifier: Apache-2.0
"""The examples of README.md and docs/ run as they stand, one after the other, and print what the pages quote.

A quotation is the indented block behind `<!-- printed by dtof ... -->`: what the last command above that has these words prints. Spaces and the
width of tables do not matter, and between two paragraphs of the quotation the command may print more.
"""

import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import update_readme
from figures import store

ROOT = Path(__file__).resolve().parent.parent.parent
# A command may go on behind a backslash, and some make their input with Python or echo.
EXAMPLE = re.compile(r"^    ((?:build/cpp/|/usr/bin/python3 |echo )(?:.*\\\n)*.*?)(?:\s+#.*)?$", re.MULTILINE)
# Those of the main job, which `make publish` copies: no example writes there.
MAIN_JOB = re.findall(r"^ *run_once (\w+)", (ROOT / "scripts" / "simulate.sh").read_text(encoding="utf-8"), re.MULTILINE)
PROGRAMS = ROOT / "build" / "cpp"
# Takes three minutes. The long lane (.ci/long) runs it; its answer is no input of another example.
LONG = re.compile(r"\bdtof design (?!.*--quick)")
LONG_LANE = "DTOF_TEST_LONG" in os.environ
# Their commands need the files that they add: make test-adding runs those of the first in a clone that has them,
# test_adding_a_rival compiles those of the second.
ADDING = {ROOT / "docs" / "user" / name for name in ("adding_a_readout.md", "adding_a_rival.md")}


QUOTATION = re.compile(r"^<!-- printed by (.+?) -->\n\n((?:(?:    .*)?\n)+)", re.MULTILINE)


def examples(document: Path) -> list[str]:
    return EXAMPLE.findall(document.read_text(encoding="utf-8"))


def quotations(text: str) -> dict[str, list[str]]:
    """The paragraphs that a page quotes, by the command that prints them."""
    found: dict[str, list[str]] = {}
    for quotation in QUOTATION.finditer(text):
        words = quotation[1].split()
        commands = [command for command in EXAMPLE.findall(text[:quotation.start()])
                    if " ".join(words) in command.replace("build/cpp/bin/", "")]
        if not commands:
            raise ValueError(f"no command above has the words '{quotation[1]}'")
        found.setdefault(commands[-1], []).extend(part for part in re.split(r"\n\s*\n", quotation[2]) if part.strip())
    return found


def missing(paragraphs: list[str], printed: str) -> list[str]:
    """The quoted paragraphs that a command did not print."""

    def plain(text: str) -> str:
        return " ".join(re.sub(r"-{2,}:?", "--", text).split())

    return [paragraph for paragraph in paragraphs if plain(paragraph) not in plain(printed)]


class Runs:
    """Runs commands. A command that ran before with the same files is not run again: what it wrote and printed is taken from that run."""

    def __init__(self, kept: Path) -> None:
        self.kept = kept
        self.known: dict[tuple, tuple[Path, subprocess.CompletedProcess]] = {}

    def run(self, command: str, folder: Path) -> subprocess.CompletedProcess:
        words = re.findall(r"[\w./-]+", command)
        read = tuple((word, (folder / word).read_bytes()) for word in words if (folder / word).is_file() and not word.startswith("build/cpp/"))
        key = (command, read)
        if key not in self.known:
            before = self.files(folder)
            done = subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True)
            written = self.kept / str(len(self.known))
            for path, state in self.files(folder).items():
                if before.get(path) != state:
                    (written / path).parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy2(folder / path, written / path)
            self.known[key] = written, done
        written, done = self.known[key]
        if written.is_dir():
            shutil.copytree(written, folder, dirs_exist_ok=True)
        return done

    @staticmethod
    def files(folder: Path) -> dict[Path, tuple]:
        """Every file, with its time and size. The link to the programs is not followed."""
        found = (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())
        return {path.relative_to(folder): (path.stat().st_mtime_ns, path.stat().st_size) for path in found}


@unittest.skipUnless((PROGRAMS / "bin" / "dtof").is_file(), "dtof is not built")
class Examples(unittest.TestCase):
    def run_examples(self, document: Path, runs: Runs) -> int:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "build").mkdir()
            (folder / "build" / "cpp").symlink_to(PROGRAMS)
            commands = examples(document)
            quoted = quotations(document.read_text(encoding="utf-8"))
            for command in commands:
                with self.subTest(document=document.name, command=command):
                    if LONG.search(command) and not LONG_LANE:
                        self.skipTest("takes minutes, in .ci/long alone")
                    done = runs.run(command, folder)
                    self.assertEqual(done.returncode, 0, done.stderr[-2000:])
                    for main_job in MAIN_JOB:
                        self.assertFalse((folder / "build" / main_job).exists(), f"build/{main_job} is the main job's")
                    self.assertEqual(missing(quoted.get(command, []), done.stdout + done.stderr), [],
                                     f"the command now prints\n{done.stdout}{done.stderr}")
            return len(commands)

    def test_every_document(self) -> None:
        documents = [ROOT / "README.md", *sorted(set(ROOT.glob("docs/**/*.md")) - ADDING)]
        with tempfile.TemporaryDirectory() as kept:
            runs = Runs(Path(kept))
            counts = {document: self.run_examples(document, runs) for document in documents}
        self.assertGreaterEqual(counts[ROOT / "README.md"], 8)
        self.assertGreater(sum(counts.values()), counts[ROOT / "README.md"])


class Quotations(unittest.TestCase):
    PAGE = ("    build/cpp/bin/dtof list\n    build/cpp/bin/dtof list all\n\ntext\n\n<!-- printed by dtof list -->\n\n"
            "    | a | b |\n    |--:|---|\n\n    two\n    lines\n\ntext\n")

    def test_a_quotation_belongs_to_the_last_command_above(self) -> None:
        (command, paragraphs), = quotations(self.PAGE).items()
        self.assertEqual(command, "build/cpp/bin/dtof list all")
        self.assertEqual(len(paragraphs), 2)
        with self.assertRaisesRegex(ValueError, "no command above has the words 'dtof frame'"):
            quotations(self.PAGE.replace("printed by dtof list", "printed by dtof frame"))

    def test_widths_and_line_ends_do_not_matter_and_words_do(self) -> None:
        paragraphs = quotations(self.PAGE)["build/cpp/bin/dtof list all"]
        self.assertEqual(missing(paragraphs, "| a  | b |\n|---:|-----|\nmore\ntwo lines\n"), [])
        self.assertEqual(missing(paragraphs, "| a  | c |\n|---:|-----|\ntwo lines\n"), [paragraphs[0]])

    def test_a_repeated_command_is_run_once_unless_its_files_differ(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            runs = Runs(Path(name) / "kept")
            prints = []
            for number, content in enumerate(["1", "1", "2"]):
                folder = Path(name) / str(number)
                folder.mkdir()
                (folder / "in").write_text(content, encoding="utf-8")
                done = runs.run("cat in > out; date +%N", folder)
                prints.append(done.stdout)
                self.assertEqual((folder / "out").read_text(encoding="utf-8"), content)
            self.assertEqual(prints[0], prints[1])
            self.assertNotEqual(prints[0], prints[2])


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
