# SPDX-License-Identifier: Apache-2.0
"""Files with every kind of fault on the playground's page: each has its sentence, and the frame that was read before stays usable."""

import gzip
import io
import struct
import unittest
import zlib

import numpy

from tests.browser import missing
from tests.playground import InPlayground, npy, png

HEADER = b"acquisition,column,row,timestamp"
MAP = npy(numpy.ones((8, 16), numpy.float32))
NO_KNOWN_FILE = ("neither a sensor file (.toml) nor a depth map (PNG, PFM, NPY) nor a recording (CSV, NPY, NPZ, MAT, PTU, HT3, HT2, logs of TMF8820, "
                 "TMF8821, TMF8828, TMF8829, VL53L8CH); `dtof convert` makes these of other files")
MAT = b"MATLAB 5.0 MAT-file".ljust(128)


def packed(*elements: bytes) -> bytes:
    """A MATLAB file whose variables are packed, as `save -v7` writes it."""
    return MAT + b"".join(struct.pack("<II", 15, len(data)) + data for data in map(zlib.compress, elements))


def npz(**arrays: numpy.ndarray) -> bytes:
    file = io.BytesIO()
    numpy.savez(file, **arrays)
    return file.getvalue()


def claims(columns: int, rows: int) -> bytes:
    """A PNG whose header claims more pixels than there are."""
    content = bytearray(png(numpy.ones((2, 2)), 16))
    content[16:24] = columns.to_bytes(4, "big") + rows.to_bytes(4, "big")
    return bytes(content)


REFUSED: tuple[tuple[str, bytes, str], ...] = (
    *((f"x.{kind}", b"", "the file is empty") for kind in ("toml", "png", "pfm", "npy", "npz", "csv", "csv.gz", "txt")),
    *((name, b"hello", NO_KNOWN_FILE) for name in ("x.txt", "x.png", "x.mat", "x")),
    ("x.jpg", b"\xff\xd8\xff\xe0", NO_KNOWN_FILE),
    ("x.toml", b" \n", "the file is empty"),
    ("x.toml", b"\0name", "no text, so no sensor file"),
    ("x.csv", HEADER, "no detections below the header"),
    ("x.csv", HEADER + b"\n\r\n ", "no detections below the header"),
    ("x.csv.gz", gzip.compress(HEADER), "no detections below the header"),
    ("x.csv.gz", b"\x1f\x8b12", "damaged gzip data"),
    *(("x.npy", MAP[:length], sentence) for length, sentence in (
        (4, "a damaged NPY"), (8, "a damaged NPY"), (20, "a damaged NPY"), (200, "16 x 8 numbers need 512 bytes, the file has 72"))),
    ("x.npy", npy(numpy.zeros((0, 5))), "5 x 0 pixels: each must be 1..65535"),
    ("x.npy", npy(numpy.zeros((2, 2), bool)), "NPY of b1: numbers are f4, f8, u1, u2, u4, i1, i2, i4"),
    ("x.npy", npy(numpy.ones((2, 2), numpy.float32) * -1), "column 0, row 0: a negative depth"),
    ("x.png", claims(65535, 65535), "65535 x 65535 pixels are more than 16777216, the most that this page takes; `dtof frame` takes more"),
    ("x.png", claims(4096, 4096), "a damaged PNG"),
    ("x.png", claims(1, 1), "a damaged PNG"),
    ("x.npz", npz(a=numpy.ones(2), b=numpy.ones(2)), 'an NPZ without an array "histograms"'),
    ("x.h5", b"\x89HDF\r\n\x1a\n", "HDF5 is not for a page"),
    ("x.mat", packed(bytes(80))[:-3] + b"abc", "damaged: the variable at byte 128 does not decompress"),
    ("x.ptu.gz", gzip.compress(b"PQTTTR\0\0")[:-9], "damaged gzip data"),
)


@unittest.skipIf(missing(), missing() or "")
class Files(InPlayground):
    def refused(self) -> str:
        self.assertEqual(self.state(), "failed", self.status())
        return self.status()

    def test_each_fault_has_its_sentence(self) -> None:
        self.show()
        for name, content, sentence in REFUSED:
            with self.subTest(name=name, sentence=sentence):
                self.drop((name, content))
                self.assertEqual(self.refused(), f"{name}: {sentence}")
                self.assertEqual(self.browser.evaluate("Object.values(given)"), [None, None, None])

    def test_a_refused_file_leaves_the_frame_and_its_pixels(self) -> None:
        self.show()
        for name, content in (("x.png", b"hello"), ("x.toml", b"wrong")):
            self.drop((name, content))
            self.refused()
            self.browser.evaluate("document.getElementById('watch').hidden = true")
            self.point_at("#cards article:nth-of-type(2) canvas", 6, 2)
            self.wait_for("!document.getElementById('watch').hidden")
            self.assertEqual(self.browser.evaluate("watched.pixel.column"), 6)
            self.assertFalse(self.browser.evaluate("document.getElementById('shown').classList.contains('stale')"))

    def test_an_unknown_depth_is_no_fault(self) -> None:
        metres = numpy.ones((8, 16), numpy.float32)
        metres[0, :4] = (numpy.nan, numpy.inf, -numpy.inf, 0)
        self.show()
        self.drop(("x.npy", npy(metres)))
        self.assertEqual(self.state(), "done", self.status())
        self.assertEqual(self.truth()[:5], [0, 0, 0, 0, 1])

    def test_a_scene_without_any_distance_is_shown(self) -> None:
        self.show()
        self.browser.evaluate("delete document.body.dataset.state; scene.truth.fill(NaN); frames.forEach(f => f.depth.fill(NaN)); hear.done()")
        self.assertEqual(self.state(), "done")
        self.assertIn("unknown", self.browser.evaluate("document.querySelector('#cards article dl').innerText"))

    def test_a_file_too_long_for_the_page_is_refused_unread(self) -> None:
        self.show()
        for name, length, sentence in (("x.npy", 257e6, "257 MB; this page takes 256 MB, `dtof` more"), ("x.csv", 300e6, "300 MB; this page takes"),
                                       ("x.toml", 2e6, "2 MB; a sensor file has at most 1 MB")):
            self.browser.evaluate("delete document.body.dataset.state; takeFiles([Object.defineProperty(new File([], "
                                  f"'{name}'), 'size', {{value: {length}}})])")
            self.assertTrue(self.refused().startswith(f"{name}: {sentence}"), self.status())

    def test_packed_data_that_grow_without_end_are_refused(self) -> None:
        self.show()
        self.drop(("x.csv.gz", gzip.compress(HEADER + bytes(260_000_000), compresslevel=1)))
        self.assertEqual(self.refused(), "x.csv.gz: unpacked, it has more than 256 MB; this page takes 256 MB, `dtof` more")

    def test_files_that_are_dropped_together_are_all_taken(self) -> None:
        for files in ((("mine.toml", b"name = 'mine'"), ("map.npy", MAP)), (("map.npy", MAP), ("mine.toml", b"name = 'mine'"))):
            self.show()
            self.drop(*files)
            self.assertEqual(self.state(), "done", self.status())
            self.assertIn("dtof frame --depth map.npy --sensor mine.toml --array-columns 32", self.command())

    def test_or_none_of_them(self) -> None:
        self.show()
        self.drop(("map.npy", MAP), ("x.txt", b"hello"), ("x.toml", b"wrong"))
        self.assertEqual(self.refused(), f"x.txt: {NO_KNOWN_FILE} x.toml:1: wrong")
        self.assertIn("--scene room --sensor thesis", self.command())

    def test_what_is_no_file(self) -> None:
        self.show()
        self.browser.evaluate("delete document.body.dataset.state; document.body.dispatchEvent(new DragEvent('drop', "
                              "{dataTransfer: new DataTransfer(), bubbles: true, cancelable: true}))")
        self.assertEqual(self.refused(), "What was dropped is no file.")
        self.browser.evaluate("delete document.body.dataset.state; byId('typed').value = ' '; byId('type-use').click()")
        self.assertEqual(self.refused(), "typed.toml: the file is empty")

    def test_parts_of_an_odd_sensor_are_whole_pixels(self) -> None:
        self.show()
        self.drop(("odd.toml", b"odd"))
        self.assertEqual(self.state(), "done", self.status())
        self.assertEqual(self.browser.evaluate("[...form.size.options].map(o => o.value)"), ["33 7", "16 3", "8 1"])

    def test_a_field_outside_its_limits_is_named(self) -> None:
        self.show()
        for name, value, sentence in (("seed", "1.5", "Seed: 1.5 is no whole number from 0 to 9007199254740991."),
                                      ("acquisitions", "", "Acquisitions a frame: what is there is no whole number from 1 to 33333.")):
            self.browser.evaluate(f"delete document.body.dataset.state; form['{name}'].value = '{value}'; form.requestSubmit()")
            self.assertEqual(self.refused(), sentence)
            self.browser.evaluate(f"form['{name}'].value = 1")

    def test_a_fault_of_the_page_is_shown(self) -> None:
        self.show()
        self.browser.evaluate("delete document.body.dataset.state; setTimeout(() => { throw new Error('planted'); })")
        self.assertIn("The page stopped: Uncaught Error: planted", self.refused())
        self.assertIn("planted", self.browser.complaints.pop())


if __name__ == "__main__":
    unittest.main()
