# SPDX-License-Identifier: Apache-2.0
"""area.md and timing.md have the sentences and verdicts of results that were made by hand."""

import unittest
from dataclasses import replace

from dtof_synth import report, sram_model
from dtof_synth.configuration import memories
from dtof_synth.endpoints import Endpoints
from dtof_synth.loads import Load
from dtof_synth.timing import Margin, Timing

from .small_results import result

DIGEST = "0123456789abcdef"


def lines(text: str) -> list[str]:
    return text.splitlines()


class Area(unittest.TestCase):
    """ezPointer with columns of 500 um2, its variant with one port, hisPointer with columns of 1,000 um2."""

    def setUp(self) -> None:
        self.results = {"ezpointer": result("ezpointer", 500.0, 8000.0), "hispointer": result("hispointer", 1000.0, 9000.0),
                        "ezpointer_one_port": result("ezpointer_one_port", 520.0, 8000.0)}
        self.page = report.area(self.results, "the end", "a library", DIGEST)

    @staticmethod
    def sram_um2(name: str) -> float:
        """Memories of a column of a read-out of the thesis."""
        return sum(sram_model.macro(size).area for size in memories(result(name).configuration).values())

    def test_where_the_figures_come_from(self) -> None:
        self.assertIn("Written by `make synth`: library `a library`, SRAM model `sram40`, 330 MHz, thesis's array unless a row says otherwise; "
                      "inputs `0123456789ab` (hash of RTL, constraints, scripts, libraries). Generated libraries from public figures, not sign-off",
                      self.page)
        self.assertTrue(self.page.startswith("# Area\n\n"))
        self.assertTrue(self.page.endswith("the end"))

    def test_the_total_is_columns_and_shared_logic(self) -> None:
        sram = self.sram_um2("ezpointer")
        total = (200 * (500 + sram) + 8000) / 1e6
        row = next(line for line in lines(self.page) if line.startswith("| ezPointer | 0 | 0 |"))
        self.assertEqual(row.split(" | ")[3:6], ["0.62", "500", "8000"])  # a NAND2 of 0.8 um2
        self.assertEqual(row.split(" | ")[7:], ["14", f"{total:.3f} |"])

    def test_the_thesis_stands_beside_its_read_outs_alone(self) -> None:
        total = (200 * (500 + self.sram_um2("ezpointer")) + 8000) / 1e6
        section = self.page.split("## Beside the thesis (Table 5)\n")[1].split("## ")[0]
        rows = [line for line in lines(section) if line.startswith("| ") and not line.startswith("| read-out")]
        self.assertEqual([row.split(" | ")[0] for row in rows], ["| ezPointer", "| hisPointer"])
        self.assertEqual(rows[0], f"| ezPointer | 1.15 | {total:.2f} | {total / 1.15 - 1:+.0%} | The confidence adds 4 bits to the thesis's 10-bit word; "
                                  "without it the array is ezPointer, no confidence, below. |")

    def test_a_variant_is_compared_with_its_own_read_out(self) -> None:
        section = self.page.split("## Variants\n")[1]
        self.assertIn("Changes are against the read-out that the variant belongs to.", section)
        (row,) = [line for line in lines(section) if line.startswith("| ezPointer")]
        cells = row.strip("| ").split(" | ")
        base, own = self.sram_um2("ezpointer"), self.sram_um2("ezpointer_one_port")
        self.assertEqual(cells[1:5], ["520", "+20", f"{own:.0f}", f"{own - base:+.0f}"])
        before, after = 200 * (500 + base) + 8000, 200 * (520 + own) + 8000
        self.assertEqual(cells[6:9], [f"{after / 1e6:.3f}", f"{after / before - 1:+.1%}", "400"])
        self.assertLess(own, 0.6 * base)

    def test_tables_are_whole(self) -> None:
        for above, line in zip(lines(self.page), lines(self.page)[1:]):
            if line.startswith("|---"):
                self.assertEqual(above.count(" | "), line.count("|") - 2, above)


class TimingPage(unittest.TestCase):
    def setUp(self) -> None:
        slow = Timing(0.004, 0.05, -0.9, 331.4, "u_column.a_q", "u_sram.addr_i", 17, 2)
        typical = Timing(1.5, 0.02, 0.5, 640.6, "u_b", "u_c", 9, 0)
        self.one = replace(result("ezpointer"), timing={"slow": slow, "typical": typical}, ends=Endpoints(900, 880, 15, 5),
                           fullest_load=Load("u_driver", 45.0, 60.0, 12),
                           margins={"slow": Margin(0.003, 0.2, 0.31, "x", "y"), "fast": Margin(0.8, -0.001, 0.4, "z", "w")})
        self.page = report.timing({"ezpointer": self.one}, "a library", DIGEST)

    def test_each_corner_has_a_row(self) -> None:
        self.assertIn("| read-out | corner | slack at 330 MHz | at 500 MHz | hold slack | fmax MHz | start | end | stages |", lines(self.page))
        self.assertIn("| ezPointer | slow | +0.004 | -0.900 | +0.050 | 331 | `u_column.a_q` | `u_sram.addr_i` | 17 |", lines(self.page))
        self.assertIn("| ezPointer | typical | +1.500 | +0.500 | +0.020 | 641 | `u_b` | `u_c` | 9 |", lines(self.page))
        self.assertIn("floorplan with columns of 25 um, with 1.5 ohm and 0.2 fF per um, in the slow corner 1.875 ohm and 0.25 fF.", self.page)

    def test_one_negative_slack_is_named(self) -> None:
        self.assertIn("| ezPointer | +0.003 | +0.200 | +0.31 | +0.800 | -0.001 | +0.40 | yes | **no** | yes | `x` | `y` |", lines(self.page))
        self.assertIn("cells 5 % slower or faster where that hurts, 0.15 ns of uncertainty", self.page)

    def test_ends_and_the_fullest_load(self) -> None:
        self.assertIn("| ezPointer | 900 | 880 | 15 | 5 | 2 | 75% | `u_driver` |", lines(self.page))
        self.assertIn("pins beyond a limit of 15 % of the period, slow corner", self.page)
        self.assertIn("or with more than 200 inputs behind it, stops the flow.", self.page)

    def test_without_margins_and_ends_the_page_has_no_such_sections(self) -> None:
        page = report.timing({"ezpointer": replace(self.one, margins={}, ends=None)}, "a library", DIGEST)
        self.assertNotIn("## With margins", page)
        self.assertNotIn("## Ends of paths", page)
        self.assertIn("## Variants", page)


if __name__ == "__main__":
    unittest.main()
