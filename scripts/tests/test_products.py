# SPDX-License-Identifier: Apache-2.0
"""Sensors that become products: the page, what stops the command, and the smallest sensor for real."""

import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import products
from products import Product, ProductError, Sensor

ROOT = Path(__file__).resolve().parents[2]
BENCH = "x\n3333 acquisitions of 8 x 6 pixels in 61818 clocks, 48 results\nPASS\n"
FRAME = "hisPointer: a frame of 3333 acquisitions takes 53768 clocks, 0.16 ms at 330 MHz"


class Products(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def made(self, icarus: str = BENCH, verilator: str = BENCH, said: str = "PASS: icarus, verilator, driver\n", report: str = f"{FRAME}\n| NP | 8 |\n") -> Product:
        """The product of a sensor, with a program and a make that only write these texts."""
        def run(command: list[str], _log: Path) -> str:
            folder = self.folder / "small"
            if command[0] == "make":
                (folder / "build/icarus.log").write_text(icarus, encoding="utf-8")
                (folder / "build/verilator.log").write_text(verilator, encoding="utf-8")
                return said
            (folder / "build").mkdir(parents=True)
            (folder / "report.md").write_text(report, encoding="utf-8")
            return ""

        with mock.patch.object(products, "run", run), mock.patch.object(products, "BUILD", self.folder):
            return products.make(Sensor("small", "small one", "hispointer"))

    def test_a_product_has_what_its_bench_compared(self) -> None:
        one = self.made()
        self.assertEqual((one.columns, one.rows, one.bits, one.acquisitions, one.results, one.frame), (8, 6, 8, 3333, 48, FRAME))

    def test_a_large_product_is_simulated_in_verilator_alone(self) -> None:
        one = self.made(icarus="", said="PASS: verilator, driver\n")
        self.assertEqual((one.simulators, one.results), ("Verilator", 48))

    def test_a_product_that_proves_nothing_is_refused(self) -> None:
        for changes, message in (({"said": "PASS: icarus\n"}, "does not say"), ({"icarus": "PASS\n"}, "does not say what it has compared"),
                                 ({"verilator": BENCH.replace("48", "47")}, "different frames"), ({"report": FRAME + "\n"}, "has no NP")):
            with self.assertRaisesRegex(ProductError, message):
                self.made(**changes)

    def test_a_command_that_fails_is_named_with_its_last_line(self) -> None:
        with self.assertRaisesRegex(ProductError, r"sh -c .*: the reason \(see .*log\)"):
            products.run(["sh", "-c", "echo first; echo the reason; exit 3"], self.folder / "log")

    def test_the_page_has_a_row_for_each_product(self) -> None:
        text = products.page([self.made()])
        self.assertIn("| small one (`small`) | 8 x 6 | 8 | hispointer | 3,333 | 48 | Icarus Verilog and Verilator |", text)
        self.assertIn(f"* `small`, {FRAME}", text)

    def test_sensors_are_files_or_presets_and_differ(self) -> None:
        self.assertEqual(len({sensor.name for sensor in products.SENSORS}), 5)
        self.assertEqual(len({sensor.readout for sensor in products.SENSORS}), 5)
        presets = {path.stem for path in (ROOT / "models/dtof/sensor/presets").glob("*.toml")}
        for sensor in products.SENSORS:
            self.assertTrue(sensor.name in presets or (ROOT / sensor.given).is_file(), sensor.name)
        self.assertEqual({path.stem for path in (ROOT / "examples/sensors").glob("*.toml")} | {"vl53l8ch", "thesis"},
                         {sensor.name for sensor in products.SENSORS})  # fmt: skip

    def test_the_smallest_sensor_becomes_a_product(self) -> None:
        if not products.PROGRAM.exists():
            self.skipTest("the program dtof is not built")
        with mock.patch.object(products, "BUILD", self.folder):
            one = products.make(products.SENSORS[0])
        self.assertEqual(one.results, one.columns * one.rows)
        # A wrong result in the vectors is found by the product's own make.
        results = next((self.folder / one.sensor.name / "vectors").glob("*result*"))
        lines = results.read_text(encoding="utf-8").splitlines()
        line = next(index for index, text in enumerate(lines) if text and not text.startswith(("/", "#", "@")))
        lines[line] = lines[line][:-1] + ("0" if lines[line][-1] != "0" else "1")
        results.write_text("\n".join(lines) + "\n", encoding="utf-8")
        done = subprocess.run(["make", "-C", self.folder / one.sensor.name, "icarus"], capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main()
