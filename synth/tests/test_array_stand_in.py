# SPDX-License-Identifier: Apache-2.0
"""The array's stand-in: times from slacks by hand, and arrays that cannot have one."""

import re
import unittest
from pathlib import Path

from dtof_synth import array_stand_in
from dtof_synth.array_stand_in import Port
from dtof_synth.errors import FlowError, found_in

ROOT = Path(__file__).resolve().parents[2]
PERIOD = 3.0
HEADER = "DTOF_THROUGH\nNo paths found.\nDTOF_END\n"
LOAD = "Net {} \n Pin capacitance: 3.00\n Wire capacitance: 1.00\n Total capacitance: 4.25\n"


def output(*ports: str, through: str = "") -> str:
    loads = "".join(LOAD.format(name).replace(" \n", "\n", 1) for name in ("start_i", "tdc_i[1]", "rst_ni"))
    lines = [f"DTOF_PORT {mode} {port}" for mode in array_stand_in.MODES for port in ports]
    return (f"DTOF_THROUGH\n{through}DTOF_END\n" if through else HEADER) + loads + "\n".join(lines) + "\n"


class Times(unittest.TestCase):
    def test_times_follow_from_slacks_and_budgets(self) -> None:
        found = array_stand_in.parse("t", output("start_i in 1.2 0.9 2", "rst_ni in 0.5 0.4 1", "busy_o out 0.7 1.1 1"), PERIOD)
        start, reset, busy = found.timed["nominal"]
        # Setup: 3.0 - 0.1 of uncertainty - 0.9 of the budget - 1.2 of slack. Hold: 0.9 - 0.05 - 0.9.
        self.assertAlmostEqual(start.late, 0.8)
        self.assertAlmostEqual(start.early, -0.05)
        self.assertEqual(start.load_ff, 4.25)
        # The reset's budget is 0.6.
        self.assertAlmostEqual(reset.late, 1.8)
        self.assertAlmostEqual(reset.early, 0.15)
        # The output changes 3.0 - 0.1 - 0.9 - 0.7 after the edge at the latest, 1.1 + 0.05 - 0.9 at the earliest.
        self.assertAlmostEqual(busy.late, 1.3)
        self.assertAlmostEqual(busy.early, 0.25)
        self.assertAlmostEqual(found.timed["margins"][0].late, 0.75)

    def test_the_numbers_are_those_of_the_constraints(self) -> None:
        text = (ROOT / "constraints" / "dtof.sdc").read_text(encoding="utf-8")
        margins = (ROOT / "constraints" / "margins.sdc").read_text(encoding="utf-8")
        for name, value in (("tdc_share", array_stand_in.SHARE), ("control_share", array_stand_in.SHARE),
                            ("stream_share", array_stand_in.SHARE), ("reset_share", array_stand_in.RESET_SHARE),
                            ("setup_uncertainty", array_stand_in.SETUP_UNCERTAINTY["nominal"]),
                            ("hold_uncertainty", array_stand_in.HOLD_UNCERTAINTY)):
            self.assertEqual(float(found_in("dtof.sdc", rf"set {name} (\S+)", text)[1]), value, name)
        self.assertEqual(float(found_in("margins.sdc", r"set margin_uncertainty (\S+)", margins)[1]),
                         array_stand_in.SETUP_UNCERTAINTY["margins"])
        for kind, value in (("late", array_stand_in.LATE), ("early", array_stand_in.EARLY)):
            self.assertEqual(float(found_in("margins.sdc", rf"-{kind} (\S+)", margins)[1]), value)

    def test_side_band_unused_inputs_and_constant_outputs_have_no_times(self) -> None:
        found = array_stand_in.parse("t", output("start_i in 1.2 0.9 2", "sram_cfg_i in Inf Inf 1", "raw_i in Inf Inf 0",
                                                 "state_o[2] out Inf Inf 1"), PERIOD)
        self.assertEqual(({port.name for port in found.timed["nominal"]}, found.unused, found.constant),
                         ({"start_i"}, {"raw_i"}, {"state_o[2]"}))

    def test_an_input_that_is_connected_and_has_no_path_is_found(self) -> None:
        with self.assertRaisesRegex(FlowError, r"t: no path begins at the array's port tdc_i\[1\], although 3 pins"):
            array_stand_in.parse("t", output("start_i in 1.2 0.9 2", "tdc_i[1] in Inf Inf 3"), PERIOD)

    def test_an_array_without_times_is_found(self) -> None:
        with self.assertRaisesRegex(FlowError, "t: no port of the array is timed"):
            array_stand_in.parse("t", output("raw_i in Inf Inf 0"), PERIOD)

    def test_a_path_through_the_array_is_found(self) -> None:
        through = "Startpoint: start_i (input port)\nEndpoint: busy_o (output port)\n"
        with self.assertRaisesRegex(FlowError, "t: a path through the array from start_i to busy_o has no arc"):
            array_stand_in.parse("t", output("start_i in 1.2 0.9 2", through=through), PERIOD)


class Liberty(unittest.TestCase):
    def values(self, mode: str) -> list[float]:
        text = array_stand_in.liberty([Port("d[3]", False, 0.4, -0.1, 2.0), Port("q", True, 1.05, 0.19)], [("sram_cfg_i", False)], mode, 1.0)
        self.assertIn("pin (d_3_)", text)
        return [float(value) for value in re.findall(r'(?:constraint|cell_rise) \(scalar\) \{\s*values \("(\S+)"\)', text)]

    def test_setup_hold_and_two_delays_from_the_clock(self) -> None:
        self.assertEqual(self.values("nominal"), [0.4, 0.4, -0.1, -0.1, 1.05, 0.19])

    def test_margins_that_opensta_adds_are_taken_off_delays_alone(self) -> None:
        self.assertEqual(self.values("margins"), [0.4, 0.4, -0.1, -0.1, 1.0, 0.2])


if __name__ == "__main__":
    unittest.main()
