# SPDX-License-Identifier: Apache-2.0
"""Runs that share files: a reader sees the whole old text or the whole new one."""

import tempfile
import unittest
from pathlib import Path

from dtof_synth import sram_kit
from dtof_synth.files import write_if_changed
from dtof_synth.sram_model import Size


class SharedFiles(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def test_a_reader_keeps_what_it_opened(self) -> None:
        path = self.folder / "file"
        write_if_changed(path, "old")
        with path.open(encoding="utf-8") as reader:
            write_if_changed(path, "new")
            self.assertEqual(reader.read(), "old")
        self.assertEqual(path.read_text(encoding="utf-8"), "new")
        self.assertEqual(list(self.folder.iterdir()), [path])

    def test_a_second_run_leaves_the_sram_kit_alone(self) -> None:
        def files() -> dict[str, tuple[int, int]]:
            return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in self.folder.iterdir()}

        sram_kit.write_kit(self.folder, [Size(1, 160, 14)])
        before = files()
        sram_kit.write_kit(self.folder, [Size(1, 160, 14)])
        self.assertEqual(files(), before)


if __name__ == "__main__":
    unittest.main()
