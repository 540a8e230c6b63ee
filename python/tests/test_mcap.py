# SPDX-License-Identifier: Apache-2.0
"""The point clouds that the example writes for ROS 2, as the makers' readers of MCAP and of ROS 2 messages find them. npm fetches these
readers into build/mcap_reader; without npm or its registry the tests are skipped."""

import base64
import contextlib
import io
import json
import runpy
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
from programs import ROOT

import dtof

EXAMPLE = ROOT / "examples/python/point_cloud_mcap.py"
LISTS = Path(__file__).resolve().parent / "mcap_reader"
FOLDER = ROOT / "build/mcap_reader"
DATA_END_BYTES = 1 + 8 + 4
SECONDS = 120  # for a registry that does not answer


def is_installed() -> bool:
    installed = FOLDER / "node_modules/.package-lock.json"
    if not installed.is_file():
        return False
    found, wanted = (json.loads(file.read_text(encoding="utf-8"))["packages"] for file in (installed, LISTS / "package-lock.json"))
    return all(found.get(name, {}).get("integrity") == entry["integrity"] for name, entry in wanted.items() if name)


def why_not() -> str:
    """Why the readers are not there, after an attempt to fetch them; nothing if they are."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        return "Node.js or npm is not installed"
    if is_installed():
        return ""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copyfile(LISTS / name, FOLDER / name)
    try:
        subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--fetch-retries=0"], cwd=FOLDER, check=False,
                       timeout=SECONDS, stdin=subprocess.DEVNULL, capture_output=True)  # fmt: skip
    except subprocess.TimeoutExpired:
        pass
    return "" if is_installed() else "npm could not fetch the readers of MCAP"


def stamp_ns(cloud: dict[str, Any]) -> int:
    stamp = cloud["header"]["stamp"]
    return stamp["sec"] * 10**9 + stamp["nanosec"]


class McapTest(unittest.TestCase):
    example: dict[str, Any]
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        if reason := why_not():
            raise unittest.SkipTest(reason)
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = Path(scratch.name)
        with mock.patch.object(sys, "argv", [str(EXAMPLE), scratch.name]), contextlib.redirect_stdout(io.StringIO()):
            cls.example = runpy.run_path(str(EXAMPLE))

    def try_to_read(self, file: Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(["node", LISTS / "read_mcap.mjs", FOLDER, file], capture_output=True, text=True, check=False, timeout=300)

    def read(self, file: Path) -> dict[str, Any]:
        done = self.try_to_read(file)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def check_points(self, cloud: dict[str, Any], points: np.ndarray, intensity: np.ndarray) -> None:
        self.assertEqual([(field["name"], field["offset"], field["datatype"], field["count"]) for field in cloud["fields"]],
                         [("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1), ("intensity", 12, 7, 1)])
        self.assertEqual((cloud["height"], cloud["width"], cloud["point_step"], cloud["row_step"]), (1, len(points), 16, 16 * len(points)))
        self.assertEqual((cloud["is_bigendian"], cloud["is_dense"]), (False, True))
        data = np.frombuffer(base64.b64decode(cloud["data"]), dtype="<f4").reshape(-1, 4)
        np.testing.assert_array_equal(data[:, :3], points)
        np.testing.assert_array_equal(data[:, 3], intensity)

    def test_the_examples_points(self) -> None:
        found = self.read(self.folder / "point_cloud.mcap")
        frames, degrees = self.example["frames"], self.example["sensor"].degrees_per_pixel
        self.assertEqual(found["header"]["profile"], "ros2")
        self.assertEqual(found["channels"], [{"topic": "/dtof/points", "messageEncoding": "cdr"}])
        self.assertEqual(found["schemas"], [{"name": "sensor_msgs/msg/PointCloud2", "encoding": "ros2msg"}])
        self.assertEqual(len(found["indexed"]), len(frames))
        for number, (message, frame) in enumerate(zip(found["indexed"], frames, strict=True)):
            with self.subTest(frame=number):
                made, time_ns = frame["poolpointer"], number * 10**9 // 30
                points, known = dtof.point_cloud(made.depth_m, degrees)
                self.assertGreater(len(points), 1000)
                cloud = message["decoded"]
                self.assertEqual((message["logTime"], message["publishTime"], message["sequence"]), (time_ns, time_ns, number))
                self.assertEqual(stamp_ns(cloud), time_ns)
                self.assertEqual(cloud["header"]["frame_id"], "dtof_optical_frame")
                self.check_points(cloud, points, made.confidence[known])

    def test_stream_index_and_statistics_agree(self) -> None:
        found = self.read(self.folder / "point_cloud.mcap")
        count = len(self.example["frames"])
        self.assertTrue(found["done"])
        self.assertEqual([message["data"] for message in found["streamed"]], [message["data"] for message in found["indexed"]])
        self.assertEqual(found["chunks"], count)
        statistics = found["statistics"]
        self.assertEqual((statistics["messageCount"], statistics["chunkCount"], statistics["channelMessageCounts"]), (count, count, [[1, count]]))
        self.assertEqual((statistics["messageStartTime"], statistics["messageEndTime"]), (0, (count - 1) * 10**9 // 30))
        self.assertEqual(found["offsets"], [3, 4, 11, 8])  # each kind of the summary's records
        # The reader does not compare this checksum: of the data section, without the record that has it.
        data = (self.folder / "point_cloud.mcap").read_bytes()[: found["summary_start"] - DATA_END_BYTES]
        self.assertEqual(found["data_crc"], zlib.crc32(data))

    def test_an_empty_cloud_and_names_of_any_length(self) -> None:
        """The lengths of strings move what follows to every place between two multiples of four."""
        for frame_id in ("", "a", "ab", "abc", "abcd", "abcde"):
            file = self.folder / "small.mcap"
            points = np.array([(1.5, -2.0, 3.25, 7.0)], dtype=self.example["RECORD"])
            with self.example["PointCloudFile"](file, "/points", frame_id) as clouds:
                clouds.write(points, 3 * 10**9 + 5)
                clouds.write(points[:0], 4 * 10**9)
            first, second = (message["decoded"] for message in self.read(file)["indexed"])
            self.assertEqual((first["header"]["frame_id"], stamp_ns(first)), (frame_id, 3 * 10**9 + 5))
            self.check_points(first, np.array([[1.5, -2.0, 3.25]]), np.array([7.0]))
            self.check_points(second, np.empty((0, 3)), np.empty(0))

    def test_damage_is_seen(self) -> None:
        """The checksums are there: a bit in a chunk and one in the summary stop the readers."""
        good = (self.folder / "point_cloud.mcap").read_bytes()
        summary = good.rindex(b"sensor_msgs/msg/PointCloud2")
        for place in (len(good) // 2, summary + 3):
            bad = bytearray(good)
            bad[place] ^= 1
            file = self.folder / "damaged.mcap"
            file.write_bytes(bad)
            done = self.try_to_read(file)
            self.assertNotEqual(done.returncode, 0, f"byte {place}")
            self.assertRegex(done.stderr, "(?i)crc")


if __name__ == "__main__":
    unittest.main()
