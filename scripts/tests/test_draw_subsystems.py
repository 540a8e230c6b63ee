# SPDX-License-Identifier: Apache-2.0
"""Tests of scripts/draw_subsystems.py."""

import contextlib
import io
import re
import unittest

import draw_subsystems as draws


def value(parameters: str, name: str, default: int) -> int:
    found = re.search(rf"\b{name} (\d+)", parameters)
    return int(found.group(1)) if found else default


class Draws(unittest.TestCase):
    def test_a_seed_has_its_subsystems(self) -> None:
        self.assertEqual(draws.drawn(4, 12), draws.drawn(4, 12))
        self.assertNotEqual(draws.drawn(4, 12), draws.drawn(5, 12))
        self.assertEqual(draws.drawn(4, 20)[:12], draws.drawn(4, 12))

    def test_tests_have_names_of_their_own(self) -> None:
        found = draws.drawn(7, draws.MOST)
        names = {(one.split()[1], value(one, "SRAM_NUM", 0), value(one, "PIXELS_PER_SRAM", 0)) for one in found}
        self.assertEqual(len(names), draws.MOST)
        self.assertEqual({name for name, _, _ in names}, set(draws.readouts()))

    def test_buffers_are_legal_and_on_both_sides_of_each_limit(self) -> None:
        sizes = set()
        for one in (parameters for seed in range(20) for parameters in draws.drawn(seed, 30)):
            slots = value(one, "SLOTS", 2)
            acquisition = slots * value(one, "PIXELS_PER_SRAM", 0)
            source_waits = value(one, "SOURCE_WAITS", 1)
            lines = value(one, "BUFFER_LINES", acquisition + 4)
            self.assertGreaterEqual(lines, 2 if source_waits else max(2, slots), one)
            sizes.add((value(one, "CLOCK_WAITS", 1), source_waits, lines < acquisition, lines <= draws.MOST_REGISTERS))
        self.assertEqual(len(sizes), 16)

    def test_parameters_are_those_of_the_read_out(self) -> None:
        for one in draws.drawn(9, draws.MOST):
            pool = "READOUT poolpointer" in one
            self.assertEqual("ENGINE_COLUMNS" in one, pool, one)
            self.assertFalse(pool and "RAW_HISTOGRAM" in one, one)
            self.assertFalse("AMPLITUDE" in one and "RASTER_ORDER" in one, one)
            self.assertFalse("poolpointer-lean" in one and "PRIOR" in one, one)


class CommandLine(unittest.TestCase):
    def test_bad_numbers_get_one_line(self) -> None:
        for arguments in (["--seed", "-1"], ["--count", "0"], ["--count", "61"]):
            error = io.StringIO()
            with contextlib.redirect_stderr(error), contextlib.redirect_stdout(io.StringIO()) as output:
                self.assertEqual(draws.main(arguments), 2)
            self.assertEqual(error.getvalue().count("\n"), 1)
            self.assertEqual(output.getvalue(), "")


if __name__ == "__main__":
    unittest.main()
