# SPDX-License-Identifier: Apache-2.0
"""Each module of the flow can be imported first: none relies on what another one has imported before."""

import subprocess
import sys
import unittest
from pathlib import Path

SYNTH = Path(__file__).resolve().parents[1]


class Imports(unittest.TestCase):
    def test_each_module_can_be_the_first(self) -> None:
        modules = [".".join(file.relative_to(SYNTH).with_suffix("").parts) for file in sorted((SYNTH / "dtof_synth").rglob("*.py"))
                   if file.name != "__init__.py"]
        self.assertGreater(len(modules), 50)
        for module in modules:
            with self.subTest(module=module):
                done = subprocess.run([sys.executable, "-c", f"import {module}"], cwd=SYNTH, check=False, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
