# SPDX-License-Identifier: Apache-2.0
"""A release: its archive, its metadata, and the licence of every file (REUSE.toml)."""

import hashlib
import json
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import unittest
from fnmatch import fnmatchcase
from pathlib import Path

import yaml

import file_lists
import release
from dtof_synth.errors import FlowError
from figures.source_tree import SourceTree

ROOT = Path(__file__).resolve().parents[2]
SPDX = re.compile(rb"SPDX-License-Identifier: ([\w.-]+)")


class Metadata(unittest.TestCase):
    def test_the_version_is_cmakes(self) -> None:
        version = file_lists.version()
        self.assertRegex(version, r"^\d+\.\d+\.\d+$")
        self.assertEqual(yaml.safe_load((ROOT / release.CITATION).read_text(encoding="utf-8"))["version"], version)
        self.assertEqual(json.loads((ROOT / release.ZENODO).read_text(encoding="utf-8"))["version"], version)
        self.assertTrue(release.notes((ROOT / release.CHANGELOG).read_text(encoding="utf-8"), version).startswith(f"## {version}"))

    def test_an_archive_with_dois_has_what_it_asks_for(self) -> None:
        table = json.loads((ROOT / release.ZENODO).read_text(encoding="utf-8"))
        self.assertLessEqual({"title", "description", "upload_type", "access_right", "license", "creators"}, table.keys())
        self.assertTrue(all(creator["name"] for creator in table["creators"]))

    def test_notes_are_those_of_the_version(self) -> None:
        text = "# Changelog\n\nWords.\n\n## 1.2.0, today\n\n* a\n\n### b\n\n## 1.1.0\n\n* c\n"
        self.assertEqual(release.notes(text, "1.2.0"), "## 1.2.0, today\n\n* a\n\n### b\n")
        for other in ("1.1.0", "1.2", "1.2.0.1"):
            with self.assertRaisesRegex(FlowError, "does not begin with"):
                release.notes(text, other)

    def test_a_citation_has_one_version(self) -> None:
        self.assertEqual(release.citation("a: b\nversion: 1\ncff-version: 2\n", "3.4.5"), "a: b\nversion: 3.4.5\ncff-version: 2\n")
        with self.assertRaisesRegex(FlowError, "0 lines"):
            release.citation("a: b\n", "3.4.5")


@unittest.skipUnless((ROOT / ".git").exists() and shutil.which("git"), "an archive is made of a git repository")
class Archive(unittest.TestCase):
    folder: Path
    files: list[Path]
    tree: Path

    @classmethod
    def setUpClass(cls) -> None:
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = Path(scratch.name)
        cls.files = release.archive(cls.folder / "first", "HEAD")
        with tarfile.open(cls.files[0]) as packed:
            packed.extractall(cls.folder)
        (cls.tree,) = (path for path in cls.folder.iterdir() if path.name != "first")

    def test_the_same_commit_gives_the_same_bytes(self) -> None:
        for first, second in zip(self.files, release.archive(self.folder / "first" / "second", "HEAD"), strict=True):
            self.assertEqual(first.read_bytes(), second.read_bytes())

    def test_checksums_are_those_of_the_files(self) -> None:
        lines = (self.folder / "first" / release.SUMS).read_text(encoding="ascii").splitlines()
        self.assertEqual(len(lines), len(self.files) - 1)
        for line in lines:
            digest, name = line.split("  ")
            self.assertEqual(hashlib.sha256((self.folder / "first" / name).read_bytes()).hexdigest(), digest)

    def test_it_has_what_git_keeps_and_nothing_else(self) -> None:
        kept = subprocess.run(["git", "ls-tree", "-r", "--name-only", "-z", "HEAD"], cwd=ROOT, text=True, stdout=subprocess.PIPE, check=True).stdout
        found = {str(path.relative_to(self.tree)) for path in self.tree.rglob("*") if path.is_symlink() or path.is_file()}
        self.assertEqual(found - {name for name in found if "__pycache__" in name}, set(kept.split("\0")) - {""})
        self.assertRegex(self.tree.name, r"^dtof-readout-\d+\.\d+\.\d+$")

    def test_its_scripts_work_without_git(self) -> None:
        for command in (["list_files.py", ".cpp"], ["generate.py", "--check"], ["check_names.py"], ["check_documents.py"],
                        ["reports.py", "figures", "--check"]):  # fmt: skip
            with self.subTest(command=command):
                done = subprocess.run([sys.executable, "-B", self.tree / "scripts" / command[0], *command[1:]], cwd=self.tree, text=True,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
                self.assertEqual(done.returncode, 0, done.stdout[-2000:])


class Reuse(unittest.TestCase):
    """What `reuse lint` would say, as far as this project has it."""

    def setUp(self) -> None:
        self.table = tomllib.loads((ROOT / "REUSE.toml").read_text(encoding="utf-8"))
        self.files = SourceTree(ROOT).files

    def test_every_file_has_copyright_and_licence(self) -> None:
        self.assertEqual(self.table["version"], 1)
        for name in self.files:
            covered = [one for one in self.table["annotations"] for pattern in ([one["path"]] if isinstance(one["path"], str) else one["path"])
                       if fnmatchcase(name, pattern)]
            self.assertTrue(covered and covered[-1]["SPDX-FileCopyrightText"] and covered[-1]["SPDX-License-Identifier"], name)

    def test_every_licence_has_its_text(self) -> None:
        used = {one["SPDX-License-Identifier"] for one in self.table["annotations"]}
        for name in self.files:
            first = (ROOT / name).read_bytes()[:400] if (ROOT / name).is_file() else b""
            used |= {found.decode() for found in SPDX.findall(first.splitlines()[0] if first else b"")}
        self.assertEqual({path.name.removesuffix(".txt") for path in (ROOT / "LICENSES").iterdir()}, used)
        self.assertEqual((ROOT / "LICENSE").read_bytes(), (ROOT / "LICENSES" / "Apache-2.0.txt").read_bytes())

    def test_every_named_file_is_there(self) -> None:
        for one in self.table["annotations"]:
            for name in [one["path"]] if isinstance(one["path"], str) else one["path"]:
                self.assertTrue(name == "**" or (ROOT / name).is_file(), name)


if __name__ == "__main__":
    unittest.main()
