# SPDX-License-Identifier: Apache-2.0
"""Every configuration has a name under which the scenes' accuracy is looked up."""

import unittest

import pareto


class EstimatorTitle(unittest.TestCase):
    def test_of_every_configuration(self):
        configurations = pareto.load(pareto.ROOT / "configurations.toml")
        titles = {name: pareto.estimator_title(configuration, configurations[configuration.variant_of or name])
                  for name, configuration in configurations.items()}
        self.assertEqual(titles["hispointer"], "hisPointer")
        self.assertEqual(titles["hispointer_gate"], "hisPointer")  # a parameter that changes no result
        self.assertEqual(titles["hispointer_count8"], "hisPointer COUNT_WIDTH=8")
        self.assertEqual(titles["poolpointer"], "poolPointer")


if __name__ == "__main__":
    unittest.main()
