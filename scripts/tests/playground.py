# SPDX-License-Identifier: Apache-2.0
"""The playground's page in a browser, around a module that stands in for the models: for tests of what the page itself does."""

import io
import json
import tempfile
import time
import unittest
import zlib
from pathlib import Path

import numpy

import playground_page
from tests.browser import Browser

ROOT = Path(__file__).resolve().parent.parent.parent
SCREENSHOTS = ROOT / "build" / "report_test"
SIZES = ((390, 844), (1440, 900))  # a phone and a desk
SECONDS = 30
# Three read-outs of 16 x 8 pixels, columns from 1 m to 2.5 m: the first reads 0.1 m too much, the others 0.1 m too little.
STAND_IN = """
const createModels = async () => {
  const heap = new ArrayBuffer(1 << 20), HEAPF32 = new Float32Array(heap), HEAPU16 = new Uint16Array(heap), HEAPU32 = new Uint32Array(heap);
  const HEAPU8 = new Uint8Array(heap), HEAP32 = new Int32Array(heap);
  let asked = {}, readout = 0, sentence = "", sensor = "", line = "", map = null, recording = null;
  const pixels = () => asked.columns * asked.rows;
  const MAP = 5 << 16;
  const truth = (i) => !map ? 1 + 0.1 * (i % asked.columns) :
    HEAPF32[MAP / 4 + Math.floor(Math.floor(i / asked.columns) * map[1] / asked.rows) * map[0] + Math.floor(i % asked.columns * map[0] / asked.columns)];
  const floats = (place, value) => {
    for (let i = 0; i < pixels(); ++i) { HEAPF32[place / 4 + i] = value(i); }
    return place;
  };
  const off = () => readout === 0 ? 0.1 : -0.1;
  const functions = {
    catalogue: () => "readout\\tfirst\\tFirst\\treads too far\\nreadout\\tpoolpointer\\tPool\\treads as far as the second\\n" +
      "readout\\tsecond\\tSecond\\treads too near\\nscene\\troom\\ta room\\n" +
      "scene\\tflat\\ta wall\\nsensor\\tthesis\\t16\\t8\\t0.5\\t100\\t6.75\\t10\\t2\\t45\\t0.25\\n",
    take_sensor: (name, text) => {
      sentence = text.includes("wrong") ? `${name}:1: wrong` : "";
      sensor = text === "" ? "" : `sensor\\t${name}\\t${text.includes("odd") ? "33\\t7" : "32\\t8"}\\t0.25\\t77\\t3.5\\t9\\t1\\t23.3\\t0.1\\n`;
      return sentence === "" ? 1 : 0;
    },
    sensor: () => sensor,
    take_map: (columns, rows) => { map = columns === 0 ? null : [columns, rows]; return MAP; },
    take_recording: (name, bytes, width) => { recording = bytes === 0 ? null : { name, bytes, width }; return 8 << 16; },
    recognise: () => {
      const first = HEAPU8[8 << 16], name = recording.name;
      sentence = first === 0x89 ? `${name}: HDF5 is not for a page` : "";
      line = first === 0x93 ? "npy\\t1\\tmust" : /\\.csv(\\.gz)?$/i.test(name) ? "csv\\t0\\tno" : /\\.ptu(\\.gz)?$/.test(name) ? "picoquant\\t1\\tno" :
        /\\.json$/.test(name) ? "tmf8820\\t1\\tmay" : /\\.mat$/.test(name) && first === 77 ? "mat\\t1\\tmay" : "";
      return sentence === "" ? 1 : 0;
    },
    recording: () => line,
    begin: (text) => {
      asked = Object.fromEntries(text.split("\\n").map((line) => line.split(" ")));
      sentence = Number(asked.seed) === 13 ? "13 is refused" : "";
      if (recording) {  // a column for each byte, whose value is the pixel's number of detections
        Object.assign(asked, { columns: Math.min(recording.bytes, 16), rows: 1 });
        sentence = HEAPU8[8 << 16] === 33 ? `${recording.name}:1: wrong` : "";
      }
      return sentence === "" ? 1 : 0;
    },
    error: () => sentence, columns: () => Number(asked.columns), rows: () => Number(asked.rows),
    truth: () => floats(0, (i) => recording ? NaN : truth(i)),
    brightness: () => floats(1 << 16, (i) => recording ? HEAPU8[(8 << 16) + i] : 0.5), calibrate: () => 1, read_column: () => 1,
    frame: (index) => { readout = index; return 1; },
    depth: () => floats(2 << 16, (i) => truth(i) + off()), error_map: () => floats(3 << 16, () => recording ? NaN : off()),
    results: () => {
      for (let i = 0; i < pixels(); ++i) { HEAPU16.set([i, 0, 3, 0], (4 << 16) / 2 + 4 * i); }
      return 4 << 16;
    },
    figures: () => ["100", "100", "100", "50 %", "10 %"].join("\\n"),
  };
  // Each pixel has a timestamp of 8 times its column in every second acquisition, and one of 900 in the last.
  const seen = 7 << 16;
  Object.assign(functions, {
    pixel: (column) => {
      for (let i = 0; i < 50; ++i) {
        HEAPU32[seen / 4 + 2 * i] = 2 * i;
        HEAPU16.set([8 * column, 7], seen / 2 + 4 * i + 2);
      }
      HEAPU32[seen / 4 + 100] = 99;
      HEAPU16.set([900, 7], seen / 2 + 4 * 50 + 2);
      return 1;
    },
    detections: () => 51, detection: () => seen, acquisitions: () => 100, codes: () => 1024,
    // The position is four codes an acquisition. Only the pool's group has candidates.
    state: (index, until) => { readout = index; HEAPU16.set([4 * until, 1, 5, 2 * 300], (9 << 16) / 2); return 1; },
    state_numbers: () => 9 << 16, fraction_bits: () => 1,
    candidates: (index, until) => { HEAP32.set([16, until, 64, 1], (10 << 16) / 4); return 1; },
    candidate_count: () => readout === 1 ? 2 : 0, candidate: () => 10 << 16,
    phases: (index) => index === 1 ? "20\\tcoarse\\n55\\ttrack\\n100\\tpointer" : "100\\tpointer",
  });
  return { HEAPF32, HEAPU8, HEAPU16, HEAPU32, HEAP32, ccall: (name, result, types, values) => functions[name.replace("playground_", "")](...values) };
};
"""


class InPlayground(unittest.TestCase):
    """Chromium has the page open; what Chromium complains about fails the test."""

    STAND_IN = STAND_IN
    page: Path
    browser: Browser

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.page = Path(folder.name) / "index.html"
        cls.page.write_text(playground_page.page(cls.STAND_IN), encoding="utf-8")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def show(self, width: int = 1440, height: int = 900) -> None:
        self.browser.complaints.clear()
        self.browser.window(width, height)
        self.browser.open(self.page)
        self.assertEqual(self.state(), "done")

    def state(self) -> str:
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            state = self.browser.evaluate("document.body.dataset.state ?? 'running'")
            if state != "running":
                return str(state)
            time.sleep(0.05)
        return "running"

    def wait_for(self, script: str) -> None:
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            if self.browser.evaluate(f"Boolean({script})"):
                return
            time.sleep(0.05)
        self.fail(f"not so after {SECONDS} s: {script}")

    def tearDown(self) -> None:
        self.assertEqual(self.browser.complaints, [])

    def point_at(self, selector: str, column: int, row: int) -> None:
        x, y = self.browser.evaluate(f"(c => {{ c.scrollIntoView({{block: 'center'}}); const r = c.getBoundingClientRect();"
                                     f"return [r.left + r.width * {column + 0.5} / 16, r.top + r.height * {row + 0.5} / 8]; }})"
                                     f"(document.querySelector('{selector}'))")
        self.browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)

    def drop(self, *files: tuple[str, bytes]) -> None:
        """Drops files, by name and content, on the page."""
        made = ",".join(f"new File([Uint8Array.from({list(content)})], {json.dumps(name)})" for name, content in files)
        self.browser.evaluate("delete document.body.dataset.state;"
                              f"(data => {{ [{made}].forEach(file => data.items.add(file));"
                              "document.body.dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true})); })"
                              "(new DataTransfer())")

    def status(self) -> str:
        return str(self.browser.evaluate("document.getElementById('status').textContent"))

    def command(self) -> str:
        return " ".join(str(self.browser.evaluate("document.getElementById('command').textContent")).replace("\\\n", "").split())

    def truth(self) -> list[float]:
        return self.browser.evaluate("[...scene.truth]")


def npy(array: numpy.ndarray) -> bytes:
    file = io.BytesIO()
    numpy.save(file, array)
    return file.getvalue()


def png(array: numpy.ndarray, bits: int, filters: tuple[int, ...] = (0, 1, 2, 3, 4)) -> bytes:
    """In grey; its rows have the filters in turn."""
    rows = [list(line.astype(">u2" if bits == 16 else "u1").tobytes()) for line in array]
    pixel = bits // 8
    data = b""
    for number, row in enumerate(rows):
        above = rows[number - 1] if number else [0] * len(row)
        used = filters[number % len(filters)]
        data += bytes([used])
        for i, value in enumerate(row):
            left, corner = (row[i - pixel], above[i - pixel]) if i >= pixel else (0, 0)
            nearest = min((left, above[i], corner), key=lambda one: abs(left + above[i] - corner - one))
            data += bytes([(value - (0, left, above[i], (left + above[i]) // 2, nearest)[used]) % 256])

    def chunk(name: bytes, content: bytes) -> bytes:
        return len(content).to_bytes(4, "big") + name + content + zlib.crc32(name + content).to_bytes(4, "big")

    size = array.shape[1].to_bytes(4, "big") + array.shape[0].to_bytes(4, "big")
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size + bytes([bits, 0, 0, 0, 0])) + chunk(b"IDAT", zlib.compress(data)) +
            chunk(b"IEND", b""))
