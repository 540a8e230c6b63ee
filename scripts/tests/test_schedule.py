# SPDX-License-Identifier: Apache-2.0
"""The page of the engine's schedule is made from commands that have a meaning, and shows clocks as they are."""

import unittest

import schedule

TWO = """
typedef struct packed {
  logic begin_step;    // a step begins
  logic [2:0] target;  // with begin_step: a label
} inner_t;

typedef struct packed {
  logic read;  // a word is read
  inner_t choose;
  inner_t decide;
} outer_t;
"""


class Commands(unittest.TestCase):
    def test_fields_have_their_places(self) -> None:
        known = schedule.structs(TWO)
        fields = schedule.all_fields({"pool_column_command_t": known["inner_t"], "pool_engine_command_t": known["outer_t"],
                                      "inner_t": known["inner_t"]})
        self.assertEqual([(field.name, field.place) for field in fields],
                         [("begin_step", 0), ("target", 1), ("read", 4), ("begin_step", 5), ("target", 6),
                          ("begin_step", 9), ("target", 10)])
        self.assertEqual([field.is_command for field in fields], [True, False, True, True, False, True, False])

    def test_a_field_needs_a_meaning(self) -> None:
        with self.assertRaisesRegex(schedule.ScheduleError, "'logic read;' is no field with its meaning"):
            schedule.structs(TWO.replace("  // a word is read", ""))

    def test_clocks(self) -> None:
        cases: list[tuple[set[int], str]] = [({3}, "3"), ({0, 8, 16, 24}, "0, 8, 16, 24"), (set(range(7, 39)), "7 to 38"),
                             ({4, 5, 8}, "4 to 5, 8"), (set(range(0, 32, 4)), "0, 4, ..., 28"), (set(), "")]
        for clocks, text in cases:
            self.assertEqual(schedule.ranges(clocks), text)


if __name__ == "__main__":
    unittest.main()
