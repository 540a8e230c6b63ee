# SPDX-License-Identifier: Apache-2.0
"""Point clouds, archives and result files, read back."""

import tempfile
import unittest
from pathlib import Path
from typing import Literal

import numpy as np

import dtof

import programs


class FilesTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name)
        self.sensor = dtof.Sensor("thesis")
        self.frame = dtof.frame(dtof.Scene("sky", columns=9, rows=6), self.sensor, ["sifh", "hispointer"])
        self.made = self.frame["hispointer"]

    def test_ply_is_the_programs_with_the_confidence_beside_it(self) -> None:
        depth = self.made.depth_m.copy()
        depth[0, :3] = [np.nan, 0.0, np.inf]
        dtof.save_ply(self.out / "own.ply", depth, self.sensor.degrees_per_pixel, confidence=self.made.confidence)
        header, _, body = (self.out / "own.ply").read_bytes().partition(b"end_header\n")
        self.assertIn(f"element vertex {np.sum(np.isfinite(depth) & (depth > 0))}\n".encode(), header)
        records = np.frombuffer(body, dtype=[("point", "<f4", 3), ("confidence", "<f4")])
        known = np.isfinite(depth) & (depth > 0)
        np.testing.assert_array_equal(records["confidence"], self.made.confidence[known])
        np.testing.assert_allclose(np.linalg.norm(records["point"], axis=1), depth[known], rtol=1e-6)
        programs.run("dtof", "frame", "--scene", "sky", "--array-columns", 9, "--array-rows", 6, "--readout", "hispointer", "--out",
                     self.out / "program")
        np.testing.assert_allclose(dtof.point_cloud(self.made.depth_m, self.sensor.degrees_per_pixel)[0],
                                   programs.ply_points(self.out / "program" / "hispointer.ply"), rtol=1e-6)
        # x to the right, y down, z ahead
        points, _ = dtof.point_cloud(np.ones((3, 3)), 1.0)
        self.assertTrue(points[2][0] > 0 > points[2][1] and points[2][2] > 0.9)

    def test_arrays_and_conversions(self) -> None:
        """What NumPy has saved is read as it was, and becomes what the program makes of it."""
        cube = np.arange(24.0).reshape(2, 3, 4)
        np.savez(self.out / "two.npz", cube=cube, depth_m=self.made.depth_m, confidence=self.made.confidence)
        np.testing.assert_array_equal(dtof.read_array(f"{self.out / 'two.npz'}:cube"), cube)
        said = dtof.convert(f"{self.out / 'two.npz'}:depth_m", self.out / "converted.pcd", degrees_per_pixel=0.48)
        rows, columns = self.made.depth_m.shape
        self.assertTrue(said.startswith(f"{columns} x {rows} pixels, ") and said.endswith(", confidence"), said)
        dtof.save_pcd(self.out / "saved.pcd", self.made.depth_m, 0.48, confidence=self.made.confidence)
        saved, converted = ((self.out / name).read_bytes().partition(b"DATA binary\n") for name in ("saved.pcd", "converted.pcd"))
        self.assertEqual(saved[0], converted[0])
        np.testing.assert_allclose(np.frombuffer(saved[2], "<f4"), np.frombuffer(converted[2], "<f4"), rtol=1e-6)
        with self.assertRaisesRegex(ValueError, "two.npz: the archive has no array 'none', but cube, depth_m, confidence"):
            dtof.read_array(f"{self.out / 'two.npz'}:none")

    def test_pcd(self) -> None:
        dtof.save_pcd(self.out / "own.pcd", self.made.depth_m, 0.48, confidence=self.made.confidence, error=self.made.error_m)
        header, _, body = (self.out / "own.pcd").read_bytes().partition(b"DATA binary\n")
        lines = dict(line.split(" ", 1) for line in header.decode().splitlines()[1:])
        self.assertEqual((lines["FIELDS"], lines["SIZE"], lines["TYPE"], lines["COUNT"]),
                         ("x y z confidence error", "4 4 4 4 4", "F F F F F", "1 1 1 1 1"))
        records = np.frombuffer(body, dtype="<f4").reshape(-1, 5)
        self.assertEqual((lines["WIDTH"], lines["POINTS"]), (str(len(records)), str(len(records))))
        points, known = dtof.point_cloud(self.made.depth_m, 0.48)
        np.testing.assert_array_equal(records[:, :3], points)
        np.testing.assert_array_equal(records[:, 4], self.made.error_m[known])

    def test_npz(self) -> None:
        dtof.save_npz(self.out / "frame.npz", self.frame)
        with np.load(self.out / "frame.npz") as archive:
            self.assertEqual(len(archive.files), 11)
            np.testing.assert_array_equal(archive["truth_m"], self.frame.truth_m)
            np.testing.assert_array_equal(archive["sifh_code"], self.frame["sifh"].results.code)
            np.testing.assert_array_equal(archive["hispointer_depth_m"], self.made.depth_m)
            scene = dtof.Scene.from_depth(archive["hispointer_depth_m"])  # an archive's map is a scene again
        np.testing.assert_array_equal(scene.depth_m, np.nan_to_num(self.made.depth_m))

    def test_result_file(self) -> None:
        programs.run("dtof", "frame", "--scene", "sky", "--array-columns", 9, "--array-rows", 6, "--readout", "coarsehistogram", "--out",
                     self.out)
        read = dtof.read_results(self.out / "coarsehistogram.csv")
        results = dtof.frame(dtof.Scene("sky", columns=9, rows=6), readouts="coarsehistogram")["coarsehistogram"].results
        fields: tuple[Literal["code", "fraction", "confidence"], ...] = ("code", "fraction", "confidence")
        for field in fields:
            np.testing.assert_array_equal(read[field].reshape(6, 9), getattr(results, field))
        self.assertGreater(len(np.unique(read["fraction"])), 1)
        self.assertEqual(read["column"][:3].tolist(), [0, 1, 2])
        (self.out / "bad.csv").write_text("column,row,code,fraction,confidence\n1,2,x,0,0\n", encoding="ascii")
        with self.assertRaisesRegex(ValueError, r"bad.csv:2: "):
            dtof.read_results(str(self.out / "bad.csv"))

    def test_refusals(self) -> None:
        for call, sentence in [(lambda: dtof.save_ply(self.out / "x", np.ones(3), 1.0), "two axes"),
                               (lambda: dtof.save_ply(self.out / "x", np.ones((2, 90)), 2.0), "below 180 degrees"),
                               (lambda: dtof.save_ply(self.out / "x", np.ones((2, 2)), 1.0, confidence=np.ones(4)), "confidence: its shape"),
                               (lambda: dtof.save_pcd(self.out / "x", np.ones((2, 2)), 1.0, x=np.ones((2, 2))), "'x' is no name of a field")]:
            with self.subTest(sentence), self.assertRaisesRegex(ValueError, sentence):
                call()
        self.assertFalse((self.out / "x").exists())
        for refused in (lambda: dtof.read_recording(str(self.out / "none.csv")), lambda: dtof.read_depth(str(self.out / "none.npy"))):
            with self.assertRaisesRegex(ValueError, "none"):
                refused()


if __name__ == "__main__":
    unittest.main()
