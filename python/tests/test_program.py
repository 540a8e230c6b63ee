# SPDX-License-Identifier: Apache-2.0
"""The module's frames are the program's, code for code."""

import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import dtof

import programs

COLUMNS, ROWS = 34, 24  # an engine of poolPointer
READOUTS = ["hispointer", "sifh", "coarsehistogram", "poolpointer", "poolpointer-lean"]


class ProgramTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name)

    def compare(self, frame: dtof.Frame, *options: object) -> None:
        """The frame against `dtof frame` with these options: codes, fractions, confidences, distances, figures."""
        out = self.out / "frame"
        programs.run("dtof", "frame", *options, "--readout", ",".join(frame), "--out", out)
        summary = programs.table(out / "summary.csv")
        for name in frame:
            made = frame[name]
            rows = made.results.code.shape[0]
            expected = programs.codes(out / f"{name}.csv", rows)
            self.assertEqual(expected["row"][0, 0], frame.first_row)
            self.assertEqual(expected["column"][0].tolist(), frame.columns)
            for field in ("code", "fraction", "confidence"):
                np.testing.assert_array_equal(getattr(made.results, field), expected[field], err_msg=f"{name} {field}")
            row = summary[made.readout.title]
            self.assertEqual(made.summary, {figure: row[figure] for figure in made.summary})
            # The program's point cloud has its distances as float32, each behind one known function.
            points, _ = dtof.point_cloud(made.depth_m, dtof.Sensor("thesis").degrees_per_pixel)
            self.assertGreater(len(points), 0)
            if "--sensor" not in options:
                np.testing.assert_allclose(points, programs.ply_points(out / f"{name}.ply"), rtol=1e-6)

    def test_every_kind_of_readout(self) -> None:
        scene = dtof.Scene("room", columns=COLUMNS, rows=ROWS)
        frame = dtof.frame(scene, "thesis", READOUTS, klux=20.0, seed=3)
        self.compare(frame, "--array-columns", COLUMNS, "--array-rows", ROWS, "--klux", 20, "--seed", 3)

    def test_all_is_all(self) -> None:
        scene = dtof.Scene("staircase", columns=4, rows=6, near_m=1.0, far_m=4.0, steps=3)
        frame = dtof.frame(scene)
        self.assertEqual(list(frame), list(dtof.readouts()))
        self.compare(frame, "--scene", "staircase", "--near", 1, "--far", 4, "--steps", 3, "--array-columns", 4, "--array-rows", 6)

    def test_region_condition_and_no_table(self) -> None:
        scene = dtof.Scene("room", columns=COLUMNS, rows=ROWS)
        frame = dtof.frame(scene, "thesis+mist+column-skew", READOUTS, columns=[*range(3, 20), 25], rows=(4, 12), table="none")
        self.compare(frame, "--sensor", "thesis+mist+column-skew", "--array-columns", COLUMNS, "--array-rows", ROWS,
                     "--columns", "3-19,25", "--rows", "4-11", "--table", "none")

    def test_fast_photons_until_a_precision(self) -> None:
        scene = dtof.Scene("room", dtof.Sensor("phone"), columns=COLUMNS, rows=ROWS)
        frame = dtof.frame(scene, "phone", ["hispointer", "poolpointer"], klux=40.0, fidelity="fast", precision_percent=1.0, max_frames=5)
        self.compare(frame, "--sensor", "phone", "--array-columns", COLUMNS, "--array-rows", ROWS, "--klux", 40, "--fidelity", "fast",
                     "--precision", 1, "--max-frames", 5)
        self.assertGreaterEqual(frame["hispointer"].frames, 4)

    def test_parameters_and_a_changed_sensor(self) -> None:
        sensor = dtof.Sensor("thesis").replace(acquisitions=700, dead_time_ns=7.3, time_gate_ns=(3.1, 40.7), slots=3, np=9)
        readouts = [dtof.Readout("sifh", sensor, nb=4, window_centred=True, code_gate=(5, 400)),
                    dtof.Readout("fifh", sensor, nb=4, code_gate=(5, 400))]
        frame = dtof.frame(dtof.Scene("room", columns=8, rows=ROWS), sensor, readouts)
        self.compare(frame, "--array-columns", 8, "--array-rows", ROWS, "--acquisitions", 700, "--dead-time", 7.3, "--gate", 3.1, 40.7,
                     "--slots", 3, "--np", 9, "--nb", 4, "--window-centred", "--code-gate", 5, 400)

    def test_template_of_the_sensors_own_light(self) -> None:
        size: list[object] = ["--array-columns", COLUMNS, "--array-rows", ROWS]
        cases: list[tuple[str, dict[str, Any], list[object]]] = [
                ("thesis+glass", {}, []), ("thesis+fog", {"slots": 3, "np": 11}, ["--slots", 3, "--np", 11]),
                ("thesis+fog", {"acquisitions": 900, "dead_time_ns": 25.0}, ["--acquisitions", 900, "--dead-time", 25]),
                ("thesis+glass", {"time_gate_ns": (1.0, 40.0), "binning": 2}, ["--gate", 1, 40, "--binning", 2])]
        for condition, changed, options in cases:
            with self.subTest(condition, options=options):
                sensor = dtof.Sensor(condition).replace(**changed)
                compensated = [dtof.Readout(name, sensor, template=True) for name in ("poolpointer", "poolpointer-lean")]
                scene = dtof.Scene("room", sensor, columns=COLUMNS, rows=ROWS)
                frame = dtof.frame(scene, sensor, compensated)
                self.compare(frame, "--sensor", condition, "--template", *size, *options)
                uncompensated = dtof.frame(scene, sensor, list(frame), table="none")
                self.assertFalse(np.array_equal(uncompensated["poolpointer"].results.code, frame["poolpointer"].results.code))

    def test_the_timestamps_are_the_readouts(self) -> None:
        frame = dtof.frame(dtof.Scene("room", columns=6, rows=ROWS), "thesis", dtof.Readout("sifh", np=9, slots=1))
        self.compare(frame, "--array-columns", 6, "--array-rows", ROWS, "--np", 9, "--slots", 1)

    def test_own_maps(self) -> None:
        random = np.random.default_rng(5)
        depth = random.uniform(0.5, 5.0, (31, 23))
        depth[2, 3] = np.nan
        reflectivity = random.uniform(0.1, 1.0, (16, 12))
        np.save(self.out / "depth.npy", depth)
        np.save(self.out / "reflectivity.npy", reflectivity)
        scene = dtof.Scene.from_depth(depth, reflectivity, columns=12, rows=16)
        frame = dtof.frame(scene, readouts=["sifh", "hispointer"])
        self.compare(frame, "--depth", self.out / "depth.npy", "--reflectivity-map", self.out / "reflectivity.npy",
                     "--array-columns", 12, "--array-rows", 16)
        np.testing.assert_array_equal(dtof.read_depth(str(self.out / "depth.npy")), np.nan_to_num(depth).astype(np.float32))

    def test_own_cube(self) -> None:
        random = np.random.default_rng(6)
        events = np.zeros((7, 9, 300))
        rows, columns = np.indices((7, 9))
        for share in (0.02, 0.05):
            events[rows, columns, random.integers(20, 280, (7, 9))] += share * random.uniform(0.5, 1.0, (7, 9))
        np.savez(self.out / "cube.npz", cube=events, bin_width_s=100e-12, start_s=2e-9)
        scene = dtof.Scene.from_cube(events, 100e-12, start_s=2e-9, columns=12, rows=16)
        frame = dtof.frame(scene, readouts=["sifh", "hispointer"])
        self.compare(frame, "--cube", self.out / "cube.npz", "--array-columns", 12, "--array-rows", 16)

    def test_own_sensor_file(self) -> None:
        text = dtof.preset_text("phone").replace("columns = ", "columns = 12 # ").replace("rows = ", "rows = 10 # ")
        (self.out / "mine.toml").write_text(text, encoding="utf-8")
        frame = dtof.frame("room", str(self.out / "mine.toml"), ["sifh"])
        self.assertEqual(frame.truth_m.shape, (10, 12))
        self.compare(frame, "--sensor", self.out / "mine.toml")
        again = dtof.frame("room", dtof.Sensor.parse(text), ["sifh"])
        np.testing.assert_array_equal(again["sifh"].results.code, frame["sifh"].results.code)

    def test_recording_there_and_back(self) -> None:
        stream = self.out / "stream.csv"
        photons = dtof.photons(dtof.Scene("room", columns=6, rows=5), dtof.Sensor("thesis"))
        photons.write_csv(str(stream))
        programs.run("dtof", "replay", stream, "--readout", "sifh", "--out", self.out / "replay")
        read = dtof.read_recording(str(stream))
        self.assertEqual(read.format, "csv")
        for source in (photons, read.photons):
            results = dtof.read_out(source, "sifh")
            np.testing.assert_array_equal(results.code, programs.codes(self.out / "replay" / "sifh.csv", 5)["code"])

    def test_histogram_file(self) -> None:
        counts = np.zeros((3, 4, 90))
        counts[:, :, 30] = 400.0
        counts[1, 2, :] = 3.0
        np.save(self.out / "counts.npy", counts)
        programs.run("dtof", "replay", self.out / "counts.npy", "--bin-width", 500, "--readout", "hispointer", "--out", self.out / "replay",
                     "--photons", 300, "--background", 0.1, "--shift", 2.5)
        expected = programs.codes(self.out / "replay" / "hispointer.csv", 3)["code"]
        read = dtof.read_recording(str(self.out / "counts.npy"), bin_width_s=500 * 1e-12, photons=300.0, background=0.1, time_shift_s=2.5e-9)
        own = dtof.histogram_photons(counts, 500 * 1e-12, photons=300.0, background=0.1, offset_s=2.5e-9)
        for source in (read.photons, own):
            np.testing.assert_array_equal(dtof.read_out(source, "hispointer").code, expected)

    def test_tables_can_be_used_again(self) -> None:
        scene = dtof.Scene("room", columns=COLUMNS, rows=ROWS)
        first = dtof.frame(scene, readouts=["sifh", "poolpointer"])
        tables = {name: first[name].table for name in first}
        for readouts in (["sifh", "poolpointer"], ["poolpointer"]):
            again = dtof.frame(scene, readouts=readouts, table=tables)
            for name in again:
                np.testing.assert_array_equal(again[name].depth_m, first[name].depth_m)
                self.assertEqual(again[name].summary, first[name].summary)
        with self.assertRaisesRegex(ValueError, "table: there is none for fifh"):
            dtof.frame(scene, readouts=["fifh"], table=tables)

    def test_refusals_are_the_programs(self) -> None:
        cases: list[tuple[Callable[[], object], list[object]]] = [
            (lambda: dtof.frame(sensor="thesys"), ["--sensor", "thesys"]),
            (lambda: dtof.frame("rum"), ["--scene", "rum"]),
            (lambda: dtof.frame(readouts=["sfih"]), ["--readout", "sfih"]),
            (lambda: dtof.Readout("sifh", nb=11), ["--readout", "sifh", "--nb", 11])]
        with self.assertRaisesRegex(ValueError, "code_gate: no code is at least 5 and below 5"):
            dtof.Readout("sifh", code_gate=(5, 5))
        for call, options in cases:
            with self.assertRaises(ValueError) as raised:
                call()
            self.assertEqual(str(raised.exception), programs.refusal("dtof", "frame", *options, "--out", self.out / "none"))

    def test_numbers_that_the_program_refuses_are_refused(self) -> None:
        flat = dtof.Scene("flat", columns=2, rows=2)
        cases: list[tuple[Callable[[], object], list[object]]] = [
            (lambda: dtof.photons(flat, dtof.Sensor(), 201.0), ["--klux", 201]),
            (lambda: dtof.frame(flat, klux=201.0, readouts=["sifh"]), ["--klux", 201]),
            (lambda: dtof.LookupTable.flat("sifh", dtof.Sensor(), 201.0), ["--klux", 201]),
            (lambda: dtof.Rival("hedh4", dtof.Sensor()).flat_table(201.0), ["--klux", 201]),
            (lambda: dtof.Scene("flat", columns=2, rows=2, reflectivity=5.0), ["--reflectivity", 5])]
        for call, options in cases:
            with self.subTest(options), self.assertRaises(ValueError) as raised:
                call()
            self.assertEqual("frame: --" + str(raised.exception), programs.refusal("dtof", "frame", *options, "--out", self.out / "none"))

    def test_numbers_of_a_sensor_have_the_limits_of_its_file(self) -> None:
        sensor = dtof.Sensor()
        cases: list[tuple[Callable[[], object], str]] = [
            (lambda: sensor.replace(acquisitions=0), "acquisitions = 0"), (lambda: sensor.replace(acquisitions=1048576), "acquisitions = 1048576"),
            (lambda: sensor.replace(slots=17), "slots = 17"), (lambda: sensor.replace(columns=4097), "columns = 4097"),
            (lambda: sensor.replace(rows=4097), "rows = 4097"), (lambda: dtof.Scene("flat", columns=4097, rows=1), "columns = 4097"),
            (lambda: dtof.Scene.from_depth(np.ones((1, 1)), rows=4097), "rows = 4097")]
        for call, line in cases:
            key = line.split()[0]
            text = "\n".join(line if old.startswith(f"{key} =") else old for old in dtof.preset_text("thesis").splitlines())
            with self.subTest(line), self.assertRaises(ValueError) as raised:
                call()
            with self.assertRaises(ValueError) as of_file:
                dtof.Sensor.parse(text, "a.toml")
            self.assertEqual(str(raised.exception), str(of_file.exception).split(": ", 1)[1])

    def test_arguments_without_effect_are_refused(self) -> None:
        cases: list[tuple[Callable[[], object], str]] = [
            (lambda: dtof.Scene("room", near_m=1.0), "near_m has no effect: only the scenes staircase and plane have a near and a far end"),
            (lambda: dtof.Scene("flat", far_m=1.0), "far_m has no effect"), (lambda: dtof.Scene("room", distance_m=1.0), "distance_m has no effect"),
            (lambda: dtof.Scene("plane", steps=4), "steps has no effect")]
        for call, sentence in cases:
            with self.subTest(sentence), self.assertRaisesRegex(ValueError, sentence):
                call()

    def test_frames_that_are_none(self) -> None:
        scene = dtof.Scene("flat", columns=2, rows=2)
        cases: list[tuple[dict[str, Any], type[Exception], str]] = [
            ({"precision_percent": 0.0}, ValueError, "precision_percent: 0 is not above 0"),
            ({"precision_percent": 5.0, "max_frames": 0}, ValueError, "max_frames: 0 is outside 4 to 1000000"),
            ({"threads": -1}, ValueError, "threads: -1 is outside 0 to 1024"),
            ({"fidelity": "analytic", "precision_percent": 5.0}, ValueError, "precision_percent has no effect: the analytic photon model"),
            ({"readouts": [3]}, TypeError, "3 is neither the name of a read-out nor a dtof.Readout")]
        for options, error, sentence in cases:
            own: dict[str, Any] = {"readouts": ["sifh"], "table": "none", **options}
            with self.subTest(sentence), self.assertRaisesRegex(error, sentence):
                dtof.frame(scene, **own)


if __name__ == "__main__":
    unittest.main()
