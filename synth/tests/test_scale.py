# SPDX-License-Identifier: Apache-2.0
"""Arrays of other sizes: their parameters, the extrapolation of a simulation's time, and the page."""

import csv
import io
import json
import subprocess
import sys
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import configuration, scale
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]
NAMED = configuration.load(ROOT / "configurations.toml")
SENSOR = 'name = "thesis"\n\n[array]\ncolumns = 200\nrows = 160\n'
FITS = ("ezPointer: a frame of 3333 acquisitions takes 1112812 clocks, 3.37 ms at 330 MHz; 30 frames/s leave 11000000, so that the frame fits.\n"
        "poolPointer: a frame of 3333 acquisitions takes 13000000 clocks, 39 ms at 330 MHz; 30 frames/s leave 11000000. It would fit with 2000 "
        "acquisitions.\n")
ROW = scale.Row("ezPointer", 640, 480, 6, 5.0, 128, 335.0, 8.0, 200.0, 3300000, 10.0, 0.02, 50.0, 0.1, 80.0, "", "column word SRAM")
WHOLE = scale.Whole("ezPointer", 2.5, 2.0, 250.0, "rst_ni", "received[29]", 345.0, "stages_q[86]", "received[0]")


class Arrays(unittest.TestCase):
    def test_a_register_of_the_broadcast_crosses_at_most_its_length_of_wire(self) -> None:
        for columns, stages in ((2, 2), (64, 2), (200, 2), (240, 2), (241, 3), (320, 3), (640, 6), (960, 8), (1024, 8)):
            self.assertEqual(scale.stages(columns), stages, columns)

    def test_parts_keep_all_other_parameters_and_the_broadcast_of_the_whole_array(self) -> None:
        for base in (NAMED[name] for name in scale.READOUTS):
            for columns, rows in scale.SIZES:
                items = scale.parts(base, columns, rows)
                for item in items:
                    changed = {name for name, value in item.parameters.items() if base.parameters.get(name) != value}
                    self.assertLessEqual(changed, {"SRAM_NUM", "PIXELS_PER_SRAM", "BROADCAST_STAGES", "ENGINE_COLUMNS"})
                    self.assertEqual((item["PIXELS_PER_SRAM"], item["BROADCAST_STAGES"]), (rows, scale.stages(columns)))
                    if base.is_pool and len(items) == 2:
                        self.assertEqual(item["SRAM_NUM"] % base["ENGINE_COLUMNS"], 0)
                self.assertEqual(len(items), 1 if columns == 64 else 2)
        names = [item.name for base in (NAMED[name] for name in scale.READOUTS) for size in scale.SIZES for item in scale.parts(base, *size)]
        self.assertEqual(len(set(names)), len(names))

    def test_the_line_goes_through_both_parts(self) -> None:
        items = scale.parts(NAMED["ezpointer"], 320, 240)
        self.assertEqual([item["SRAM_NUM"] for item in items], [64, 128])
        self.assertAlmostEqual(scale.on_the_line(items, [1.0, 1.5], 320), 3.0)
        self.assertEqual(scale.on_the_line(items[:1], [1.0], 64), 1.0)

    def test_the_sensor_has_the_arrays_size(self) -> None:
        self.assertEqual(scale.sensor(SENSOR, 64, 50), SENSOR.replace("200", "64").replace("160", "50"))
        with self.assertRaisesRegex(FlowError, "no line 'rows = '"):
            scale.sensor(SENSOR.replace("rows", "lines"), 64, 50)


class Synthesis(unittest.TestCase):
    def test_a_tool_that_fails_in_one_corner_leaves_the_slow_one(self) -> None:
        asked: list[tuple] = []
        said: list[str] = []
        found = mock.Mock(total_mm2=1.0, timing={"slow": mock.Mock(fmax_mhz=300.0)})

        def run_all(jobs: list, *_: object) -> dict:
            asked.append(jobs[0].corners)
            if len(asked) == 1:
                raise FlowError("fast corner: OpenSTA: stopped")
            return {jobs[0].name: found}

        with mock.patch.object(scale.batch, "run_all", run_all):
            self.assertIs(scale.synthesised(NAMED["ezpointer"], mock.Mock(), said.append), found)
        self.assertEqual(asked, [scale.batch.BOTH_CORNERS, ("slow",)])
        self.assertIn("OpenSTA: stopped; goes on with the slow corner alone", said[0])


    def test_the_release_of_the_reset_has_the_periods_of_the_subsystem(self) -> None:
        subsystem = (ROOT / "constraints" / "subsystem" / "dtof_subsystem.sdc").read_text(encoding="utf-8")
        array_reset = (ROOT / "hdl" / "subsystem" / "dtof_array_reset.sv").read_text(encoding="utf-8")
        resting = int(array_reset.split("RESTING = 4'd", 1)[1].split(";", 1)[0])
        self.assertEqual(scale.release_periods(subsystem), (resting + 1, resting))
        text = scale.released_constraints("create_clock", subsystem)
        self.assertTrue(text.startswith("create_clock\n"))
        self.assertIn(f"\nset_multicycle_path {resting + 1} -setup -from [get_ports rst_ni]\n", text)
        self.assertIn(f"\nset_multicycle_path {resting} -hold -from [get_ports rst_ni]\n", text)
        with self.assertRaisesRegex(FlowError, "no number of periods"):
            scale.release_periods(subsystem.replace("set_multicycle_path 3 -hold", "set_false_path"))


class Simulation(unittest.TestCase):
    def test_strips_are_the_columns_of_an_engine_or_ten(self) -> None:
        large, small = scale.array(NAMED["hispointer"], 320, 240), scale.array(NAMED["hispointer"], 15, 8)
        self.assertEqual((scale.strips(large), scale.strips(small)), ([10, 20, 30], [10, 15]))
        pool = scale.array(NAMED["poolpointer"], 640, 480)
        engine = pool["ENGINE_COLUMNS"]
        self.assertEqual(scale.strips(pool), [engine, 2 * engine, 3 * engine])

    def test_a_straight_line_is_extrapolated_without_error(self) -> None:
        value, error = scale.extrapolated({10: 3.0, 20: 5.0, 30: 7.0}, 100)  # 1 + 0.2 a column
        self.assertAlmostEqual(value, 21.0)
        self.assertAlmostEqual(error, 0.0)

    def test_a_bent_line_shows_its_error(self) -> None:
        value, error = scale.extrapolated({10: 3.0, 20: 4.0, 30: 7.0}, 100)
        self.assertAlmostEqual(value, 21.0)
        self.assertAlmostEqual(error, 0.25)

    def test_a_line_never_falls(self) -> None:
        value, error = scale.extrapolated({10: 3.0, 20: 3.0, 30: 2.4}, 100)
        self.assertAlmostEqual(value, 2.4)
        self.assertAlmostEqual(error, 0.0)

    def test_a_whole_array_is_not_extrapolated(self) -> None:
        self.assertEqual(scale.extrapolated({10: 3.0, 15: 4.0}, 15), (4.0, 0.0))

    def test_the_memory_is_that_of_the_command(self) -> None:
        def memory(megabytes: int) -> float:
            return scale._in_a_process([sys.executable, "-c", f"x = b'1' * ({megabytes} << 20)"])[1]

        large, small = memory(200), memory(20)
        self.assertGreater(large, 200)
        self.assertLess(small, 150)  # not that of the command before

    def test_a_command_that_fails_stops_the_study(self) -> None:
        with self.assertRaisesRegex(FlowError, "no such sensor"):
            scale._in_a_process(["sh", "-c", "echo no such sensor >&2; exit 1"])

    def test_the_sentences_on_the_frame_rate_are_read(self) -> None:
        self.assertEqual(scale.fit(FITS, "ezPointer"), (1112812, ""))
        self.assertEqual(scale.fit(FITS, "poolPointer"), (13000000, "30 frames/s leave 11000000. It would fit with 2000 acquisitions."))
        with self.assertRaisesRegex(FlowError, "nothing on SiFH"):
            scale.fit(FITS, "SiFH")

    def test_the_program_speaks_as_these_tests_assume(self) -> None:
        program = ROOT / "build/cpp/bin/dtof"
        if not program.exists():
            self.skipTest("the program dtof is not built")
        text = subprocess.run([program, "sensor", "thesis", "--frame-rate", "30", "--json"], capture_output=True, text=True, check=True).stdout
        for item in (NAMED[name] for name in scale.READOUTS):
            clocks, limit = scale.fit(json.loads(text)["fits"], item.title)
            self.assertGreater(clocks, 3333 * 160 * 2)
            self.assertEqual(limit, "")


class Page(unittest.TestCase):
    def test_rows_have_the_figures(self) -> None:
        text = scale.report([ROW], [])
        self.assertIn("No array misses the clock or the frame rate.", text)
        self.assertIn("| ezPointer | 640 x 480 | 5.00 | 16 | 6 | 8.0 | 335 (128) | 200 | 3,300,000 | 100 |", text)
        self.assertIn("| ezPointer | 640 x 480 | 10.0 | 2% | 50.0 | 10% | 80 |", text)
        self.assertNotIn("whole array of", text)

    def test_a_whole_array_stands_beside_its_extrapolation(self) -> None:
        text = scale.report([ROW], [WHOLE])
        self.assertIn("| ezPointer | 2.50 | 2.00 | +25.0% | 250 | `rst_ni` | 345 |", text)
        self.assertIn("250 MHz, from `rst_ni` to `received[29]`. The release of the reset does not reach all columns in a period. In dtof_subsystem it has more periods (dtof_array_reset), and the array has 345 MHz, from `stages_q[86]` to `received[0]`.", text)

    def test_an_array_without_power_says_so(self) -> None:
        text = scale.report([replace(ROW, power=None)], [])
        self.assertIn("| 335 (128) | - | 3,300,000 |", text)
        self.assertIn("OpenSTA crashed", text)
        self.assertNotIn("crashed", scale.report([ROW], []))
        self.assertIn(",335,8,,", scale.table([replace(ROW, power=None)]))

    def test_what_limits_an_array_has_a_line(self) -> None:
        logic = replace(ROW, fmax_slow=320.0)
        wires = replace(ROW, columns=2048, stages=8, half_width=25.6)
        frame = replace(ROW, limit="30 frames/s leave 11000000. It would fit with 2000 acquisitions.")
        slow = replace(logic, frame_clocks=16000000)
        lines = scale._limits([ROW, logic, slow, wires, frame], [replace(WHOLE, start="received[1]"), replace(WHOLE, fmax_slow=331.0)])
        self.assertEqual(len(lines), 5)
        self.assertNotIn("reset", lines[0])
        self.assertIn("320 MHz even with 128 columns, from `column word SRAM`. At this clock it still has 97 frames/s.", lines[1])
        self.assertIn("At this clock it has only 20 frames/s: use fewer rows", lines[2])
        self.assertIn("several narrower arrays", lines[3])
        self.assertIn("2000 acquisitions", lines[4])

    def test_the_table_has_every_field(self) -> None:
        (header, values) = csv.reader(io.StringIO(scale.table([ROW])))
        self.assertEqual(len(header), len(values))
        self.assertEqual(dict(zip(header, values, strict=True))["model_error"], "0.02")


if __name__ == "__main__":
    unittest.main()
