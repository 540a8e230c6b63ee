#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Takes five sensors from their file to a product (`dtof product`) whose own `make` passes, and writes reports/products.md.

`make` in a product simulates a frame in Verilator and, for a small array, in Icarus Verilog, compares every result with the model, and checks the
driver.
With SMALL=1 only the smallest sensor is taken.
"""

import argparse
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from dtof_synth import program
from figures.small import is_small, written_root

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "cpp" / "bin" / "dtof"
BUILD = written_root(ROOT) / "build" / "products"
REPORT = written_root(ROOT) / "reports" / "products.md"
PASSED = re.compile(r"^PASS: (icarus, )?verilator, driver$", re.MULTILINE)


class ProductError(Exception):
    """A product that cannot be made, or whose `make` fails."""


@dataclass(frozen=True)
class Sensor:
    name: str  # preset, or file in examples/sensors
    what: str
    readout: str  # as `dtof product --readout`
    options: tuple[str, ...] = ()  # of `dtof product`

    @property
    def choice(self) -> str:
        return " ".join([self.readout, *self.options])

    @property
    def given(self) -> str:
        """The argument of --sensor, from the project's root."""
        file = ROOT / "examples" / "sensors" / f"{self.name}.toml"
        return str(file.relative_to(ROOT)) if file.exists() else self.name


# The smallest first.
SENSORS = (
    Sensor("vl53l8ch", "8 x 8 zones at 940 nm", "hispointer"),
    Sensor("small_64x48", "a pulse of 0.2 ns, a TDC of 12 bits", "sifh", ("--columns-per-sram", "3")),
    Sensor("thesis", "the thesis's sensor", "poolpointer", ("--engine-columns", "100")),
    Sensor("car_320x120", "a car's, to 200 m", "coarsehistogram"),
    Sensor("vga_640x480", "640 x 480 pixels", "poolpointer-lean"),
)


@dataclass(frozen=True)
class Product:
    sensor: Sensor
    columns: int
    rows: int
    bits: int  # of a timestamp
    frame: str  # the program's sentence on the frame's time
    acquisitions: int  # of the simulated frame
    results: int  # that were compared, in each simulator
    simulators: str
    seconds: float  # of the product's `make`


def run(command: list[str], log: Path) -> str:
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    log.write_text(done.stdout, encoding="utf-8")
    if done.returncode != 0:
        last = (done.stdout.strip().splitlines() or ["no output"])[-1]
        raise ProductError(f"{' '.join(command)}: {last} (see {log})")
    return done.stdout


def simulated(text: str) -> tuple[int, int, int, int]:
    """(acquisitions, columns, rows, results) in the line of a product's bench."""
    found = re.search(r"^(\d+) acquisitions of (\d+) x (\d+) pixels in \d+ clocks, (\d+) results$", text, re.MULTILINE)
    if not found:
        raise ProductError("the bench does not say what it has compared")
    acquisitions, columns, rows, results = map(int, found.groups())
    return acquisitions, columns, rows, results


def parameter(report: str, name: str) -> int:
    found = re.search(rf"^\| {name} \| (\d+) \|$", report, re.MULTILINE)
    if not found:
        raise ProductError(f"the product's report has no {name}")
    return int(found.group(1))


def make(sensor: Sensor) -> Product:
    """Makes the product and runs its `make`. ProductError if either fails, or if the two simulators compared different frames."""
    folder = BUILD / sensor.name
    shutil.rmtree(folder, ignore_errors=True)
    log = BUILD / f"{sensor.name}.log"
    run([str(PROGRAM), "product", "--sensor", sensor.given, "--readout", sensor.readout, *sensor.options, "--out", str(folder)], log)
    started = time.monotonic()
    text = run(["make", "-C", str(folder)], log)
    seconds = time.monotonic() - started
    passed = PASSED.search(text)
    if not passed:
        raise ProductError(f"{folder}: make does not say that all checks pass (see {log})")
    tools = ("icarus", "verilator") if passed.group(1) else ("verilator",)
    frames = [simulated((folder / "build" / f"{tool}.log").read_text(encoding="utf-8")) for tool in tools]
    if frames[0] != frames[-1]:
        raise ProductError(f"{folder}: Icarus Verilog and Verilator simulated different frames")
    acquisitions, columns, rows, results = frames[0]
    report = (folder / "report.md").read_text(encoding="utf-8")
    frame = next(line for line in report.splitlines() if ": a frame of " in line)
    return Product(sensor, columns, rows, parameter(report, "NP"), frame, acquisitions, results, " and ".join({"icarus": "Icarus Verilog", "verilator": "Verilator"}[tool] for tool in tools), seconds)


def page(products: list[Product]) -> str:
    rows = [f"| {one.sensor.what} (`{one.sensor.given}`) | {one.columns} x {one.rows} | {one.bits} | {one.sensor.choice} | {one.acquisitions:,} | "
            f"{one.results:,} | {one.simulators} |" for one in products]
    return "\n".join([
        "# From a sensor file to a product",
        "",
        "From `make products`: `dtof product` for each sensor, then the product's own `make`. It simulates a frame of the sensor's photons,",
        "compares every result with the model, and compiles and checks the driver. All of the products below pass.",
        "",
        "| sensor | columns x rows of the array | bits of a timestamp | read-out | acquisitions simulated | results compared | in |",
        "|---|---:|---:|---|---:|---:|---|",
        *rows,
        "",
        "The frame that is simulated has as many acquisitions as fit into some megabytes of vectors. The clocks of a whole frame:",
        "",
        *(f"* `{one.sensor.name}`, {one.frame}" for one in products),
        ""])


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.parse_args()
    try:
        if not PROGRAM.exists():
            raise ProductError(f"{PROGRAM}: `make` builds it")
        BUILD.mkdir(parents=True, exist_ok=True)
        products = []
        for sensor in SENSORS[:1] if is_small() else SENSORS:
            products.append(make(sensor))
            print(f"products: {sensor.name}, {sensor.choice}: {products[-1].results} results, {products[-1].seconds:.0f} s", flush=True)
        REPORT.write_text(page(products), encoding="utf-8")
        print(f"products: wrote {REPORT.relative_to(ROOT)}")
        return 0
    except ProductError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    program.run(main)
