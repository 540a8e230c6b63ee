# SPDX-License-Identifier: Apache-2.0
"""Arrays: shapes, types, memory that is shared and lives long enough, events there and back."""

import gc
import tracemalloc
import unittest
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

import dtof


class ArrayTest(unittest.TestCase):
    def test_shared_arrays_are_read_only_and_outlive_their_owner(self) -> None:
        frame = dtof.frame(dtof.Scene("room", columns=7, rows=5), readouts=["sifh"])
        made = frame["sifh"]
        shared: dict[str, tuple[npt.NDArray[Any], type]] = {
            "truth": (frame.truth_m, np.float32), "depth": (made.depth_m, np.float32), "error": (made.error_m, np.float32),
            "code": (made.results.code, np.uint16), "confidence": (made.confidence, np.uint16)}
        kept = {name: array.copy() for name, (array, _) in shared.items()}
        for name, (array, kind) in shared.items():
            self.assertEqual((array.shape, array.dtype), ((5, 7), np.dtype(kind)), name)
            self.assertFalse(array.flags.owndata, name)
            self.assertFalse(array.flags.writeable, name)
        again = made.depth_m
        self.assertEqual(again.__array_interface__["data"], made.depth_m.__array_interface__["data"])  # the same memory, no copy
        del frame, made, again
        gc.collect()
        _ = [dtof.frame(dtof.Scene("flat", columns=7, rows=5), readouts=["fifh"]) for _ in range(5)]  # takes freed memory
        for name, (array, _) in shared.items():
            np.testing.assert_array_equal(array, kept[name], err_msg=name)

    def test_scene_maps_are_row_by_row(self) -> None:
        depth = np.arange(1, 7, dtype=np.float64).reshape(2, 3) / 2
        scene = dtof.Scene.from_depth(depth, depth / 10)
        self.assertEqual((scene.columns, scene.rows), (3, 2))
        np.testing.assert_array_equal(scene.depth_m, depth)
        np.testing.assert_allclose(scene.reflectivity, depth / 10, rtol=1e-7)
        self.assertFalse(scene.depth_m.flags.owndata)
        np.testing.assert_array_equal(dtof.Scene("staircase", columns=4, rows=2, steps=4, near_m=1.0, far_m=4.0).depth_m[1], [1, 2, 3, 4])

    def test_arrays_of_any_layout_are_taken(self) -> None:
        depth = np.linspace(1.0, 4.0, 12).reshape(3, 4)
        wanted = dtof.Scene.from_depth(depth).depth_m
        for other in (np.asfortranarray(depth), depth.astype(">f4"), np.repeat(depth, 2, axis=1)[:, ::2], depth.tolist()):
            np.testing.assert_array_equal(dtof.Scene.from_depth(other).depth_m, wanted)

    def test_an_array_is_copied_where_its_type_or_order_differs(self) -> None:
        def copies(function: Callable[[npt.NDArray[Any]], object], array: npt.NDArray[Any]) -> bool:
            """Whether NumPy has made another array as large as this one: it tells tracemalloc of its memory, the library does not."""
            tracemalloc.start()
            function(array)
            most = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            return most > 4 * array.size

        zeros, pulses = np.zeros(4000, np.int64), np.arange(4000, dtype=np.int64)
        takers: list[tuple[Callable[[npt.NDArray[Any]], object], tuple[int, ...], type, type]] = [
            (dtof.Scene.from_depth, (50, 40), np.float32, np.float64),
            (lambda cube: dtof.Scene.from_cube(cube, 1e-9), (10, 8, 40), np.float64, np.float32),
            (lambda codes: dtof.event_list(zeros, zeros, pulses, codes, columns=1, rows=1, acquisitions=4000, np=6), (4000,), np.int64, np.uint16)]
        for function, shape, own, other in takers:
            array: npt.NDArray[Any] = np.ones(shape, own)
            self.assertFalse(copies(function, array), shape)
            self.assertTrue(copies(function, array.astype(other)), shape)
            if len(shape) > 1:
                self.assertTrue(copies(function, np.asfortranarray(array)), shape)
        depth = np.ones((5, 4), np.float32)
        scene = dtof.Scene.from_depth(depth)
        depth[:] = 2.0
        self.assertEqual(scene.depth_m[0, 0], 1.0)

    def test_maps_that_are_none(self) -> None:
        for depth, sentence in [(np.zeros(3), "two axes"), (np.array([[-1.0]]), "-1"), (np.zeros((0, 2)), "")]:
            with self.subTest(sentence), self.assertRaisesRegex(ValueError, sentence):
                dtof.Scene.from_depth(depth)
        with self.assertRaisesRegex(ValueError, "beyond the sensor's range"):
            dtof.frame(dtof.Scene.from_depth(np.full((2, 2), 50.0)))

    def test_a_cube_is_a_scene(self) -> None:
        events = np.zeros((2, 3, 400), np.float32)
        events[:, :, 200] = 0.3 / 9
        events[0, 1, 100] = 0.02
        events[1, 2] = 0.0
        scene = dtof.Scene.from_cube(events, 100e-12)
        self.assertEqual((scene.columns, scene.rows), (3, 2))
        strongest = 0.5 * 299792458.0 * 200.5 * 100e-12
        wanted = np.full((2, 3), strongest)
        wanted[1, 2] = 0.0
        np.testing.assert_allclose(scene.depth_m, wanted, rtol=1e-12)
        frame = dtof.frame(scene, readouts=["histogram"])
        self.assertTrue(np.isnan(frame.truth_m[1, 2]))
        for broken, sentence in [(events[0], "rows, columns and time bins"), (-events, "column 0, row 0, bin 200: -0.0333"),
                                 (np.full((1, 1, 2), np.nan), "nan is not a finite number")]:
            with self.subTest(sentence), self.assertRaisesRegex(ValueError, sentence):
                dtof.Scene.from_cube(broken, 100e-12)
        with self.assertRaisesRegex(ValueError, "bin width must be above 0 s"):
            dtof.Scene.from_cube(events, 0.0)
        with self.assertRaisesRegex(ValueError, "transient cube: use the exact one"):
            dtof.photons(scene, dtof.Sensor("thesis"), fidelity="fast")

    def test_column_events_are_those_of_the_stream(self) -> None:
        photons = dtof.photons(dtof.Scene("room", columns=3, rows=4), dtof.Sensor("thesis"))
        events = photons.events()
        timestamps: dict[int, npt.NDArray[np.uint16]] = {}
        for column in range(3):
            one = photons.column(column)
            of_column = events["column"] == column
            np.testing.assert_array_equal(one.timestamp, events["timestamp"][of_column])
            np.testing.assert_array_equal(one.acquisition, events["acquisition"][of_column])
            np.testing.assert_array_equal(np.repeat(np.arange(4), np.diff(one.row_bounds)), events["row"][of_column])
            self.assertEqual(len(one), int(of_column.sum()))
            timestamps[column] = one.timestamp
        self.assertEqual(timestamps[0].dtype, np.uint16)
        self.assertFalse(timestamps[0].flags.owndata)
        with self.assertRaisesRegex(ValueError, "column 3 is outside 0 to 2"):
            photons.column(3)

    def test_photons_without_laser_are_the_background(self) -> None:
        scene, sensor = dtof.Scene("room", columns=2, rows=3), dtof.Sensor("thesis").replace(acquisitions=200)
        counts = [sum(len(dtof.photons(scene, sensor, klux, laser=laser).column(column)) for column in range(2))
                  for klux in (0.0, 50.0) for laser in (False, True)]  # fmt: skip
        self.assertTrue(counts[0] < counts[1] and counts[2] < counts[3], counts)
        self.assertLess(counts[0], counts[2])

    def test_events_in_any_order_make_the_same_stream(self) -> None:
        photons = dtof.photons(dtof.Scene("room", columns=5, rows=4), dtof.Sensor("thesis"))
        events = photons.events()
        # Events of one pixel and acquisition keep their order.
        keys: npt.NDArray[np.int64] = (events["column"].astype(np.int64) * 4 + events["row"]) * 3333 + events["acquisition"]
        mixed = np.argsort(np.random.default_rng(1).permutation(keys.max() + 1)[keys], kind="stable")
        own = dtof.event_list(events["column"][mixed], events["row"][mixed], events["acquisition"][mixed], events["timestamp"][mixed],
                              columns=5, rows=4, acquisitions=3333)
        for name in ("sifh", "hispointer", "poolpointer"):
            np.testing.assert_array_equal(dtof.read_out(own, name).code, dtof.read_out(photons, name).code)

    def test_events_that_are_none(self) -> None:
        good: dict[str, Any] = {"column": [0, 1], "row": [0, 0], "acquisition": [5, 5], "timestamp": [10, 20]}
        size: dict[str, Any] = {"columns": 2, "rows": 1, "acquisitions": 6}
        dtof.event_list(**good, **size)
        cases: list[tuple[dict[str, Any], str]] = [
            ({"column": [0, 2]}, r"column\[1\]: 2 is outside 0 to 1"), ({"row": [0, -1]}, r"row\[1\]: -1 is outside"),
            ({"acquisition": [6, 5]}, r"acquisition\[0\]: 6 is outside 0 to 5"),
            ({"timestamp": [10, 1024]}, r"timestamp\[1\]: 1024 is outside 0 to 1023"),
            ({"timestamp": [10]}, "needs one axis of 2 numbers"),
            ({"rows": 0}, "rows: 0 is not at least 1"), ({"np": 17}, "np: 17 is outside 1 to 16"),
            ({"column": [0.0, 0.5]}, r"column\[1\]: 0.5 is not a whole number"), ({"row": [float("nan"), 0]}, r"row\[0\]: nan is not a whole number"),
            ({"acquisition": ["5", "5"]}, "acquisition: needs whole numbers, not <U1"), ({"timestamp": None}, "timestamp: needs whole numbers, not object"),
            ({"column": [0, 1 << 64]}, "column: needs whole numbers, not object"), ({"row": [0j, 0]}, "row: needs whole numbers, not complex128"),
            ({"acquisitions": 0}, "acquisitions: 0 is not at least 1"), ({"slots": 17}, "slots: 17 is outside 1 to 16"),
            ({"columns": 1 << 20, "rows": 1 << 20}, "1048576 x 1048576 pixels are more than 16777216")]
        for change, sentence in cases:
            with self.subTest(sentence), self.assertRaisesRegex(ValueError, sentence):
                dtof.event_list(**(good | size | change))
        whole: dict[str, Any] = good | size | {"timestamp": [10.0, 20.0]}
        dtof.event_list(**whole)
        with self.assertRaisesRegex(ValueError, "acquisition 3 has more than 2 events"):
            dtof.event_list([0] * 3, [0] * 3, [3] * 3, [1, 2, 3], columns=1, rows=1, acquisitions=6)

    def test_no_events_at_all(self) -> None:
        empty = dtof.event_list([], [], [], [], columns=2, rows=3, acquisitions=10)
        self.assertEqual(len(empty.column(1)), 0)
        self.assertEqual(empty.column(1).timestamp.shape, (0,))
        self.assertEqual(dtof.read_out(empty, "sifh").has_distance.sum(), 0)

    def test_regions(self) -> None:
        photons = dtof.photons(dtof.Scene("room", columns=6, rows=5), dtof.Sensor("thesis"))
        whole = dtof.read_out(photons, "fifh").code
        np.testing.assert_array_equal(dtof.read_out(photons, "fifh", columns=[4, 1], rows=(2, 4)).code, whole[2:4][:, [1, 4]])
        cases: list[tuple[dict[str, Any], str]] = [
            ({"columns": [6]}, "column 6 is outside 0 to 5"), ({"columns": [1, 1]}, "named twice"),
            ({"columns": []}, "none is named"), ({"rows": (3, 3)}, "rows: 3 to below 3"), ({"rows": (0, 6)}, "rows:")]
        for region, sentence in cases:
            with self.subTest(sentence), self.assertRaisesRegex(ValueError, sentence):
                dtof.read_out(photons, "fifh", **region)


if __name__ == "__main__":
    unittest.main()
