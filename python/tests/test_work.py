# SPDX-License-Identifier: Apache-2.0
"""Long work: progress, Control-C, other threads."""

import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import dtof

SENSOR = dtof.Sensor("thesis")
SCENE = dtof.Scene("room", columns=200, rows=160)

INTERRUPTED = """
import dtof, os, signal, threading, time
threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
begin = time.monotonic()
try:
    dtof.frame("room", "thesis_full", "all", fidelity="exact")
except KeyboardInterrupt:
    print("interrupted after", time.monotonic() - begin)
print(dtof.frame(dtof.Scene("flat", columns=2, rows=2), readouts=["sifh"])["sifh"].results.code.shape)
"""


class WorkTest(unittest.TestCase):
    def test_progress_grows_and_ends_at_the_whole(self) -> None:
        reported: list[tuple[int, int]] = []
        dtof.frame(SCENE, SENSOR, ["sifh", "poolpointer"], table="none", progress=lambda done, total: reported.append((done, total)))
        self.assertGreater(len(reported), 3)
        self.assertEqual(reported, sorted(set(reported)))
        self.assertEqual(reported[-1], (400, 400))

    def test_progress_of_a_read_out(self) -> None:
        reported: list[int] = []
        dtof.read_out(dtof.photons(SCENE, SENSOR), "sifh", progress=lambda done, total: reported.append(done))
        self.assertEqual(reported[-1], 200)

    def test_an_exception_of_the_callback_ends_the_work(self) -> None:
        class Enough(Exception):
            pass

        def stop(done: int, total: int) -> None:
            raise Enough(f"{done} of {total}")

        with self.assertRaises(Enough) as raised:
            dtof.frame(SCENE, SENSOR, "all", progress=stop)
        self.assertLess(int(str(raised.exception).split()[0]), 200 * len(dtof.readouts()))

    def test_other_threads_run_meanwhile(self) -> None:
        counted = 0
        finished = threading.Event()

        def count() -> None:
            nonlocal counted
            while not finished.is_set():
                counted += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        begin = time.monotonic()
        dtof.frame(SCENE, SENSOR, ["sifh"])
        seconds = time.monotonic() - begin
        finished.set()
        thread.join()
        self.assertGreater(counted, 10 * seconds)  # without the lock given up: none

    def test_frames_of_several_threads_are_right(self) -> None:
        scene = dtof.Scene("room", columns=20, rows=16)
        wanted = dtof.frame(scene, readouts=["sifh"])["sifh"].results.code.tobytes()
        found = []
        threads = [threading.Thread(target=lambda: found.append(dtof.frame(scene, readouts=["sifh"])["sifh"].results.code.tobytes()))
                   for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [wanted] * 4)

    def test_control_c_ends_a_long_frame(self) -> None:
        done = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, timeout=600, check=True,
                              env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)})
        first, second = done.stdout.splitlines()
        self.assertTrue(first.startswith("interrupted after"), done.stdout)
        self.assertLess(float(first.split()[-1]), 40.0)  # the whole frame takes minutes
        self.assertEqual(second, "(2, 2)")  # the next frame is whole
        self.assertEqual(done.stderr, "")

    def test_nothing_is_written_to_standard_error(self) -> None:
        done = subprocess.run([sys.executable, "-c", "import dtof; dtof.frame('room', readouts=['sifh', 'poolpointer'])"],
                              capture_output=True, text=True, check=True, env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)})
        self.assertEqual((done.stdout, done.stderr), ("", ""))

    def test_the_modules_handlers_are_pythons(self) -> None:
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)


if __name__ == "__main__":
    unittest.main()
