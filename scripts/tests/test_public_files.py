# SPDX-License-Identifier: Apache-2.0
"""Files that other projects publish for the tests of their own readers, as Debian installs them with NumPy, SciPy and h5py: `dtof convert`
reads the whole ones as their makers do, and has a sentence for the damaged and foreign ones. formats.md names these files."""

import importlib.util
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build" / "cpp" / "bin" / "dtof"
SECONDS = 60
CUBE = numpy.arange(1.0, 25.0).reshape(4, 3, 2).T  # MATLAB's reshape(1:24, 2, 3, 4)
# Package, file with the name of the array in it, options, content.
WHOLE: list[tuple[str, str, tuple[str, ...], list[float] | numpy.ndarray]] = [
    ("numpy", "lib/tests/data/python3.npy", (), [1.0, 1.0]),
    ("scipy", "io/matlab/tests/data/test3dmatrix_6.5.1_GLNX86.mat:test3dmatrix", ("--bin-width", "500"), CUBE),
    ("scipy", "io/matlab/tests/data/test3dmatrix_7.1_GLNX86.mat:test3dmatrix", ("--bin-width", "500"), CUBE),
    ("scipy", "io/matlab/tests/data/test3dmatrix_7.4_GLNX86.mat:test3dmatrix", ("--bin-width", "500"), CUBE),
    ("scipy", "io/matlab/tests/data/testhdf5_7.4_GLNX86.mat", (), numpy.linspace(0.0, 2.0 * numpy.pi, 9).reshape(1, 9)),
    ("h5py", "_debian_h5py_serial/tests/data_files/vlen_string_s390x.h5:/DSBEfloat", (), [3.14, 1.61, 2.71, 2.41, 1.2]),
    ("h5py", "_debian_h5py_serial/tests/data_files/vlen_string_s390x.h5:/DSLEint", (), [1.0, 2.0, 3.0, 4.0, 5.0]),
]
MATLAB = "io/matlab/tests/data"
REFUSED = [
    ("numpy", "lib/tests/data/py3-objarr.npy", "dtype '|O8' is not one of i1,"),
    ("numpy", "lib/tests/data/py2-objarr.npz", "dtype '|O8' is not one of i1,"),
    ("scipy", f"{MATLAB}/malformed1.mat", "damaged: the variable at byte 128 ends beyond the file"),
    ("scipy", f"{MATLAB}/corrupted_zlib_data.mat", "damaged: the variable at byte 222 does not decompress"),
    ("scipy", f"{MATLAB}/corrupted_zlib_checksum.mat", "damaged: the variable at byte 128 does not decompress"),
    ("scipy", f"{MATLAB}/big_endian.mat", "not a little-endian MATLAB 5 file (save with -v7 or -v6)"),
    ("scipy", f"{MATLAB}/testdouble_4.2c_SOL2.mat", "not a MATLAB file"),
    ("scipy", f"{MATLAB}/testsparse_7.4_GLNX86.mat:testsparse", "convert it in MATLAB or Octave: testsparse = full(testsparse)"),
    ("scipy", f"{MATLAB}/testcomplex_7.4_GLNX86.mat:testcomplex", '"testcomplex" is not a real numeric array'),
    ("scipy", f"{MATLAB}/teststruct_7.4_GLNX86.mat", 'the variable "photon_times" is missing or damaged'),
    ("h5py", "_debian_h5py_serial/tests/data_files/vlen_string_dset.h5", "the file has no dataset of numbers"),
    ("h5py", "_debian_h5py_serial/tests/data_files/vlen_string_s390x.h5", "the file has 4 datasets (/DSBEfloat, /DSBEint, /DSLEfloat, /DSLEint)"),
]


def folder(package: str) -> Path | None:
    spec = importlib.util.find_spec(package)
    return Path(spec.submodule_search_locations[0]) if spec and spec.submodule_search_locations else None


@unittest.skipUnless(PROGRAM.is_file(), "dtof is not built")
class PublicFiles(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.out = Path(scratch.name) / "out.npy"

    def convert(self, package: str, name: str, options: tuple[str, ...] = ()) -> subprocess.CompletedProcess[str]:
        place = folder(package)
        file, _, array = name.partition(":")
        if place is None or not (place / file).is_file():
            self.skipTest(f"{package} is not installed, or comes without {file}")
        source = f"{place / file}{':' if array else ''}{array}"
        return subprocess.run([PROGRAM, "convert", source, self.out, *options], capture_output=True, text=True, timeout=SECONDS, check=False)

    def test_whole_files_are_read_as_their_makers_read_them(self) -> None:
        for package, name, options, content in WHOLE:
            with self.subTest(file=name):
                done = self.convert(package, name, options)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                numpy.testing.assert_array_equal(numpy.load(self.out), content)

    def test_damaged_and_foreign_files_have_a_sentence(self) -> None:
        for package, name, sentence in REFUSED:
            with self.subTest(file=name):
                done = self.convert(package, name)
                self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (1, "", 1))
                self.assertTrue(done.stderr.startswith("dtof: error: "))
                self.assertIn(Path(name.partition(":")[0]).name, done.stderr)
                self.assertIn(sentence, done.stderr)
                self.assertFalse(self.out.exists())

    def test_no_file_of_these_packages_brings_the_program_down(self) -> None:
        for package, pattern in (("scipy", "io/matlab/tests/data/*.mat"), ("h5py", "**/data_files/*.h5"), ("numpy", "lib/tests/data/*.np*")):
            place = folder(package)
            if place is None:
                continue
            for file in sorted(place.glob(pattern)):
                with self.subTest(file=file.name):
                    done = self.convert(package, str(file.relative_to(place)))
                    self.assertIn(done.returncode, (0, 1))
                    self.assertEqual(done.stderr.count("\n"), done.returncode)


if __name__ == "__main__":
    unittest.main()
