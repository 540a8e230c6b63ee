# SPDX-License-Identifier: Apache-2.0
"""The report's sentences follow the figures."""

import math
import unittest

import trade


def point(label: str, lost: float, wrong: float, ratio: float = 1.5, mm2: float = math.nan) -> trade.Point:
    return trade.Point(label, label, {"lost_14klux": lost, "outliers_50klux": wrong, "bound_ratio_1m_14klux": ratio}, mm2)


class RankCorrelation(unittest.TestCase):
    def test_order_of_the_pairs(self):
        self.assertEqual(trade.rank_correlation([(1, 5), (2, 6), (3, 9)]), 1.0)
        self.assertEqual(trade.rank_correlation([(1, 9), (2, 6), (3, 5)]), -1.0)
        self.assertEqual(trade.rank_correlation([(1, 5), (2, 5), (2, 7)]), 0.5)  # one tie, and equals are not compared
        self.assertEqual(trade.rank_correlation([(1, 5)]), 0.0)


class Sentences(unittest.TestCase):
    def test_schedules(self):
        falling = [point("10/12", 3.0, 4.0, 1.4), point("14/12", 2.0, 3.0, 1.5), point("18/12", 1.0, 2.0, 1.6)]
        self.assertIn("single pixels lost show a fall (rank correlation -1.00)", trade.schedule_sentence(falling))
        self.assertIn("rmse over the bound shows a fall (rank correlation -1.00)", trade.schedule_sentence(falling))
        rising = [point("10/12", 1.0, 2.0, 1.6), point("14/12", 2.0, 3.0, 1.5), point("18/12", 3.0, 2.5, 1.4)]
        self.assertIn("single pixels lost show a rise (rank correlation +1.00)", trade.schedule_sentence(rising))
        self.assertIn("50 klux no clear trend (rank correlation +0.33)", trade.schedule_sentence(rising))

    def test_candidates(self):
        worse = [point("5x4", 2.0, 2.0, mm2=1.1), point("6x3", 1.0, 3.0, mm2=1.2), point("6x4", 1.0, 2.5, mm2=1.3)]
        self.assertIn("the area a rise", trade.candidate_sentence(worse))
        self.assertIn("scores of 3 bits are worse than those of 4 at 50 klux (3.00 against 2.50", trade.candidate_sentence(worse))
        worse[1].figures["outliers_50klux"] = 1.0
        self.assertIn("scores of 3 bits are better than those of 4", trade.candidate_sentence(worse))


if __name__ == "__main__":
    unittest.main()
