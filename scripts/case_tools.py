# SPDX-License-Identifier: Apache-2.0
"""Helpers for the rules of scripts/cases.py: running a program, and reading PNG pictures, NPY arrays and PFM maps."""

import os
import re
import shutil
import struct
import subprocess
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DTOF = ROOT / "build" / "cpp" / "bin" / "dtof"
MINUTES = 20  # that a step may take


class CaseError(Exception):
    """A case does not behave as its rule demands."""


@dataclass
class Done:
    code: int
    out: str
    error: str

    @property
    def text(self) -> str:
        return self.out + self.error


def require(condition: bool, what: str) -> None:
    if not condition:
        raise CaseError(what)


def run(*command: str | bytes | Path, folder: Path, text: bytes | None = None, **environment: str) -> Done:
    done = subprocess.run([os.fsencode(part) for part in command], cwd=folder, input=text, capture_output=True, check=False,
                          stdin=subprocess.DEVNULL if text is None else None, timeout=60 * MINUTES,
                          env={**os.environ, **environment})  # fmt: skip
    return Done(done.returncode, done.stdout.decode(errors="surrogateescape"), done.stderr.decode(errors="surrogateescape"))


def shell(command: str, folder: Path) -> Done:
    """Runs a line of bash, in which $DTOF is the program."""
    return run("bash", "-c", command, folder=folder, DTOF=str(DTOF))


def succeed(done: Done) -> Done:
    require(done.code == 0, f"exit status {done.code}: {last_line(done.text)}")
    return done


def last_line(text: str) -> str:
    lines = text.strip().splitlines()
    return lines[-1] if lines else "(nothing was printed)"


def refused(done: Done, *parts: str) -> None:
    """Checks for exit status 1 and a single line on standard error that contains these parts."""
    require(done.code == 1, f"exit status {done.code} instead of 1: {last_line(done.text)}")
    require(done.error.count("\n") == 1, f"{done.error.count(chr(10))} lines instead of one: {done.error!r}")
    for part in parts:
        require(part in done.error, f"'{part}' is missing: {done.error.strip()}")


def png(path: Path) -> tuple[int, int, int, list[list[int]]]:
    """Width, height, bits and all samples, row by row, of a PNG without interlacing (with a palette: the indices)."""
    data = path.read_bytes()
    at, packed, header = 8, b"", b""
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        name, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        header = body if name == b"IHDR" else header
        packed += body if name == b"IDAT" else b""
        at += length + 12
    width, height, bits, kind = struct.unpack(">IIBB", header[:10])
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[kind]
    stride = (width * channels * bits + 7) // 8
    step = max(1, channels * bits // 8)
    raw, previous, rows = zlib.decompress(packed), bytearray(stride), []
    for y in range(height):
        rule, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for x in range(stride):
            left, up = (line[x - step] if x >= step else 0), previous[x]
            corner = previous[x - step] if x >= step else 0
            paeth = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            line[x] = (line[x] + (0, left, up, (left + up) // 2, paeth)[rule]) & 0xFF
        previous = line
        rows.append(samples(bytes(line), bits, width * channels))
    return width, height, bits, rows


def samples(line: bytes, bits: int, count: int) -> list[int]:
    if bits == 16:
        return list(struct.unpack(f">{count}H", line))
    if bits == 8:
        return list(line)
    return [line[i * bits // 8] >> (8 - bits - i * bits % 8) & ((1 << bits) - 1) for i in range(count)]


def npy(path: Path) -> list[float]:
    """The elements of an NPY array, in file order."""
    data = path.read_bytes()
    size, form = (2, "<H") if data[6] == 1 else (4, "<I")
    (length,) = struct.unpack(form, data[8 : 8 + size])
    header, body = data[8 + size : 8 + size + length].decode(), data[8 + size + length :]
    found = re.search(r"'descr': '([<>|])(\w)(\d)'", header)
    require(found is not None, f"{path}: no dtype")
    assert found is not None
    order, kind, width = found.groups()
    letter = {"f2": "e", "f4": "f", "f8": "d", "i1": "b", "i2": "h", "i4": "i", "i8": "q", "u1": "B", "u2": "H", "u4": "I", "u8": "Q"}[kind + width]
    return list(struct.unpack(f"{order.replace('|', '<')}{len(body) // int(width)}{letter}", body))


def floats_from_below(data: bytes, width: int, height: int, order: str) -> list[float]:
    """The numbers of a PFM map, row 0 on top."""
    values = struct.unpack(f"{order}{width * height}f", data)
    return [values[(height - 1 - row) * width + column] for row in range(height) for column in range(width)]


# Short pulses in the dark: every depth is measured to a few millimetres.
SHARP_SENSOR = """name = "sharp"
[array]
columns = 4
rows = 4
field_of_view_deg = 20
[tdc]
range_ns = 45
timestamp_bits = 10
[laser]
acquisitions = 300
pulse_fwhm_ns = 0.05
[light]
signal_events_at_1m = 1.0
background_events_per_klux = 0.0
"""
TOLERANCE_MM = 15  # two codes of the time converter


def depth_map(folder: Path, file: str | Path, *options: str) -> list[int]:
    """Distances in mm that a sensor without noise measures for a depth map of 4 x 4 pixels."""
    (folder / "sharp.toml").write_text(SHARP_SENSOR, encoding="utf-8")
    out = folder / "out"
    succeed(run(DTOF, "frame", "--depth", file, "--sensor", "sharp.toml", "--klux", "0", "--readout", "histogram", "--engine", "model",
                "--table", "none", "--out", out, *options, folder=folder))  # fmt: skip
    return [value for row in png(out / "histogram_depth_mm.png")[3] for value in row]


def require_heading(done: Done, *parts: str) -> None:
    for part in parts:
        require(part in done.out, f"'{part}' is missing: {done.out.strip().splitlines()[0]}")


def require_depths(measured: list[int], metres: Sequence[float | None], what: str) -> None:
    """Checks that known depths are measured; a pixel of unknown depth (None) has no light and must be 0."""
    for place, (value, truth) in enumerate(zip(measured, metres, strict=True)):
        wanted = 0.0 if truth is None else truth * 1000
        require(abs(value - wanted) <= TOLERANCE_MM, f"{what}: pixel {place} is {value} mm instead of {wanted:.0f}")


def with_shot(chip: Path, work: Path) -> Path:
    """A copy of a case's chip with the subsystem's new port connected: Verilator reports PINMISSING for any output without a pin."""
    text = chip.read_text(encoding="utf-8")
    require(text.count(".irq_o(irq),") == 1 and "shot_o" not in text, f"{chip.name} connects irq_o otherwise, or shot_o")
    copy = work / chip.name
    copy.write_text(text.replace(".irq_o(irq),", ".irq_o(irq), .shot_o(),"), encoding="utf-8")
    return copy


def archive(folder: Path) -> Path:
    """Copies the files of the working tree, without the repository, to `folder`, which it returns."""
    listed = succeed(run("git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard", folder=ROOT))
    for file in filter(None, listed.out.split("\0")):
        if (ROOT / file).is_file() or (ROOT / file).is_symlink():
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / file, folder / file, follow_symlinks=False)
    return folder
