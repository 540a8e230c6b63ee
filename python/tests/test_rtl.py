# SPDX-License-Identifier: Apache-2.0
"""The RTL, built on demand, gives the model's results; what is said where it cannot be built; Control-C during the build."""

import os
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import dtof

import programs

COLUMNS, ROWS = 3, 4
SENSOR = dtof.Sensor("thesis").replace(np=8, acquisitions=400)
SCENE = dtof.Scene("staircase", SENSOR, columns=COLUMNS, rows=ROWS, near_m=1.0, far_m=5.0)
READOUTS = ["ezpointer", "hispointer", "sifh"]

SLOW_VERILATOR = """#!/bin/sh
case "$*" in *--version*|*--getenv*) exec {verilator} "$@";; esac
echo $$ > {started}
exec sleep 600
"""

INTERRUPTED = """
import dtof, os, pathlib, signal, threading, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it
started = pathlib.Path({started!r})

def interrupt():
    while not started.exists() or not started.read_text():
        time.sleep(0.01)
    os.kill(os.getpid(), signal.SIGINT)

threading.Thread(target=interrupt, daemon=True).start()
photons = dtof.event_list([0], [0], [0], [9], columns=1, rows=1, acquisitions=50, np=6)
try:
    dtof.read_out(photons, dtof.Readout("sifh", np=6), engine="rtl")
except KeyboardInterrupt:
    print("interrupted")
print(dtof.read_out(photons, dtof.Readout("sifh", np=6)).code.shape)
"""


def readout(name: str) -> dtof.Readout:
    return dtof.Readout(name, SENSOR)


@unittest.skipUnless(shutil.which("verilator"), "verilator is not installed")
class RtlTest(unittest.TestCase):
    folder: tempfile.TemporaryDirectory[str]
    photons: dtof.Photons

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.enterClassContext(mock.patch.dict(os.environ, {"DTOF_CACHE": str(Path(cls.folder.name) / "cache")}))
        cls.photons = dtof.photons(SCENE, SENSOR, klux=10.0, seed=4)

    def kept(self) -> set[str]:
        """The arrays in the cache."""
        return {entry.name for entry in (Path(self.folder.name) / "cache").iterdir() if entry.is_dir()}

    def assert_same(self, rtl: dtof.Results, model: dtof.Results) -> None:
        for field in ("code", "fraction", "confidence", "second", "amplitude", "ambient", "position", "has_distance"):
            np.testing.assert_array_equal(getattr(rtl, field), getattr(model, field), err_msg=f"{model.readout} {field}")
        self.assertEqual((rtl.columns, rtl.first_row), (model.columns, model.first_row))

    def test_codes_are_the_models(self) -> None:
        for name in READOUTS:
            with self.subTest(name):
                rtl = dtof.read_out(self.photons, readout(name), engine="rtl")
                model = dtof.read_out(self.photons, readout(name))
                self.assert_same(rtl, model)
                self.assertGreater(len(np.unique(model.code)), 3)
                assert rtl.clocks is not None
                self.assertGreater(rtl.clocks, 400 * ROWS)  # a beat of each row in every acquisition
                self.assertIsNone(model.clocks)

    def test_recording_and_region(self) -> None:
        stream = Path(self.folder.name) / "stream.csv"
        self.photons.write_csv(stream)
        recorded = dtof.read_recording(stream, np=8).photons
        reported: list[tuple[int, int]] = []
        rtl = dtof.read_out(recorded, readout("sifh"), engine="rtl", columns=[0, 2], rows=(1, 3),
                            progress=lambda done, total: reported.append((done, total)))
        self.assert_same(rtl, dtof.read_out(self.photons, readout("sifh"), columns=[0, 2], rows=(1, 3)))
        self.assertEqual(rtl.code.shape, (2, 2))
        self.assertEqual(reported[-1], (2, 2))

    def test_frames_and_arrays_are_the_programs(self) -> None:
        """`dtof frame --engine rtl` takes the arrays that the module has built, and writes the same results."""
        frame = dtof.frame(SCENE, SENSOR, READOUTS, klux=10.0, seed=4, engine="rtl", table="none")
        before = self.kept()
        out = Path(self.folder.name) / "frame"
        programs.run("dtof", "frame", "--engine", "rtl", "--scene", "staircase", "--near", 1, "--far", 5, "--np", 8, "--acquisitions", 400,
                     "--array-columns", COLUMNS, "--array-rows", ROWS, "--klux", 10, "--seed", 4, "--table", "none", "--readout",
                     ",".join(READOUTS), "--out", out)
        self.assertEqual(self.kept(), before)
        summary = programs.table(out / "summary.csv")
        for name in READOUTS:
            expected = programs.codes(out / f"{name}.csv", ROWS)
            for field in ("code", "fraction", "confidence"):
                np.testing.assert_array_equal(getattr(frame[name].results, field), expected[field], err_msg=f"{name} {field}")
            row = summary[frame[name].readout.title]
            self.assertEqual(frame[name].summary, {figure: row[figure] for figure in frame[name].summary})
            self.assertEqual(frame[name].results.clocks, int(row["cycles"]))

    def test_threads_take_turns(self) -> None:
        wanted = dtof.read_out(self.photons, readout("sifh")).code.tobytes()
        found: list[bytes] = []
        threads = [threading.Thread(target=lambda: found.append(dtof.read_out(self.photons, readout("sifh"), engine="rtl").code.tobytes()))
                   for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [wanted] * 4)

    def refusal(self, photons: dtof.Photons, name: str = "fifh", engine: str = "rtl") -> str:
        with self.assertRaises(ValueError) as raised:
            dtof.read_out(photons, readout(name), engine=engine)
        self.assertNotIn("\n", str(raised.exception))
        return str(raised.exception)

    def test_refusals(self) -> None:
        self.assertEqual(self.refusal(self.photons, engine="rlt"), "engine: 'rlt' is neither model nor rtl")
        with self.assertRaisesRegex(ValueError, "engine: 'rlt' is neither model nor rtl"):
            dtof.frame(SCENE, SENSOR, READOUTS, engine="rlt")
        long = dtof.event_list([0], [0], [0], [9], columns=1, rows=1, acquisitions=65536, np=8)
        self.assertEqual(self.refusal(long), "--engine rtl: 65536 acquisitions; the RTL counts 16 bits of them, to 65535")
        with mock.patch.dict(os.environ, {"DTOF_CACHE": "off"}):
            self.assertTrue(self.refusal(self.photons).endswith("; none is built: DTOF_CACHE is off"))

    def test_without_verilator(self) -> None:
        with mock.patch.dict(os.environ, {"PATH": self.folder.name}):
            said = self.refusal(self.photons)
        self.assertTrue(said.endswith("; none is built: verilator does not run here (it is in the Debian package verilator)"), said)
        self.assertTrue(said.startswith("no RTL is compiled for fifh NP=8"), said)

    def test_control_c_ends_a_build(self) -> None:
        """The thread that interrupts runs while the tool does, and the tool is gone afterwards."""
        folder = Path(self.folder.name) / "slow"
        folder.mkdir()
        started = folder / "started"
        (folder / "verilator").write_text(SLOW_VERILATOR.format(verilator=shutil.which("verilator"), started=started), encoding="utf-8")
        (folder / "verilator").chmod(0o755)
        environment = os.environ | {"PATH": f"{folder}:{os.environ['PATH']}", "PYTHONPATH": os.pathsep.join(sys.path),
                                    "DTOF_CACHE": str(folder / "cache")}
        done = subprocess.run([sys.executable, "-c", INTERRUPTED.format(started=str(started))], capture_output=True, text=True, timeout=300,
                              check=True, env=environment)
        self.assertEqual(done.stdout.splitlines(), ["interrupted", "(1, 1)"])
        self.assertRegex(done.stderr, r"\ABuilds the RTL of sifh NP=6 .*, once; kept in .*/slow/cache\n\Z")
        self.assertFalse(Path(f"/proc/{started.read_text(encoding='utf-8').strip()}").exists())
        self.assertEqual([entry.suffix for entry in (folder / "cache").iterdir()], [".lock"])


if __name__ == "__main__":
    unittest.main()
