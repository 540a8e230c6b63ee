# SPDX-License-Identifier: Apache-2.0
"""Public recordings that docs/user/data.md names: the programs read them as parsers here do, which were written from formats.md without the code of
the readers, and `dtof-study measured` judges its read-outs by the distances that these parsers find. Tests whose file is absent are skipped."""

import csv
import gzip
import json
import math
import os
import struct
import subprocess
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ROOT / "build" / "cpp" / "bin"
SHARED = ROOT / os.environ.get("SHARED_DATA", "../shared/data")
SECONDS = 200
LIGHT = 299792458.0  # m/s
WINDOW = 2e-9  # s, of a return
CHANCE = 1e-3  # that even photons are taken for a return

TMF8820 = SHARED / "sifferman_tmf8820_distance_data.json"
TMF8829 = SHARED / "ams_tmf8829_log.json.gz"
PHOTON_TIMES = SHARED / "shin2016_two_layer_photon_times.mat"
SURFACES = SHARED / "shin2016_two_layer_obj.mat"
PICOQUANT = SHARED / "picoquant"
PULSE = SHARED / "wisc2019_hydraharp_irf_8ps.npy"
TDCS = SHARED / "linospad2_tdc_calibration_a5.csv.gz"


def log_chance(number: float, mean: float) -> float:
    """Logarithm of the probability that a Poisson number of this mean is `number` or more, summed up."""
    terms = [-mean + k * math.log(mean) - math.lgamma(k + 1) for k in range(int(number), int(number) + 400)]
    most = max(terms)
    return most + math.log(sum(math.exp(term - most) for term in terms))


class Recording(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def need(self, *files: Path) -> None:
        for file in files:
            if not file.is_file():
                self.skipTest(f"{file.name} is absent (docs/user/data.md)")

    def run_program(self, program: str, *words: object) -> subprocess.CompletedProcess[str]:
        if not (PROGRAMS / program).is_file():
            self.skipTest(f"{program} is not built")
        return subprocess.run([PROGRAMS / program, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=SECONDS, check=False)

    def convert(self, source: object, target: str, *options: object) -> Path:
        done = self.run_program("dtof", "convert", source, target, *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return self.folder / target

    def measure(self, file: Path, *options: object) -> tuple[list[dict[str, str]], numpy.ndarray]:
        """Rows of summary.csv, and the true distances by row and column, NaN if unknown."""
        done = self.run_program("dtof-study", "measured", file, *options, "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "out" / "summary.csv", newline="", encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
        with open(self.folder / "out" / "truth.csv", newline="", encoding="utf-8") as table:
            pixels = list(csv.DictReader(table))
        truth = numpy.full((1 + max(int(p["row"]) for p in pixels), 1 + max(int(p["column"]) for p in pixels)), numpy.nan)
        for pixel in pixels:
            truth[int(pixel["row"]), int(pixel["column"])] = float(pixel["true_m"] or "nan")
        return rows, truth

    def refused(self, file: Path, sentence: str, *options: object) -> None:
        done = self.run_program("dtof-study", "measured", file, *options, "--out", "out")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (1, "", f"dtof-study: error: {file}: {sentence}\n"))
        self.assertFalse((self.folder / "out").exists())


def even_photons_explain(times: numpy.ndarray, span: float) -> bool:
    """Whether the fullest window is no return: by Poisson's distribution itself, where the program has a bound."""
    times = numpy.sort(times)
    inside = numpy.searchsorted(times, times + WINDOW, side="left") - numpy.arange(len(times))
    mean = (len(times) - inside.max() + 1) * WINDOW / (span - WINDOW)
    return log_chance(float(inside.max()), mean) + math.log(len(times)) > math.log(CHANCE)


def fullest_window(counts: numpy.ndarray, bin_s: float) -> float:
    """Mean time of the photons in the fullest window of a histogram, the earliest of several."""
    length = max(1, math.ceil(WINDOW / bin_s - 1e-9))
    sums = numpy.convolve(counts, numpy.ones(length))[length - 1:]
    begin = int(sums.argmax())
    inside = counts[begin:begin + length]
    return float((inside * (numpy.arange(begin, begin + len(inside)) + 0.5)).sum() / inside.sum() * bin_s)


class Tmf8820(Recording):
    def captures(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Counts by zone, capture and bin; the plane's distance in m by capture."""
        self.need(TMF8820)
        captures = json.loads(TMF8820.read_text(encoding="utf-8"))
        return (numpy.array([capture["hists"] for capture in captures], float).transpose(1, 0, 2),
                numpy.array([float(capture["dist_to_plane"]) for capture in captures]))

    def test_every_count_and_distance_is_read(self) -> None:
        counts, distance = self.captures()
        self.assertEqual(counts.shape, (9, 159, 128))
        archive = numpy.load(self.convert(TMF8820, "out.npz"))
        numpy.testing.assert_array_equal(archive["histograms"], counts)
        numpy.testing.assert_allclose(archive["true_distance_m"], numpy.tile(distance, (9, 1)), rtol=1e-12)
        self.assertAlmostEqual(float(archive["bin_width_ps"]), 92.7, places=9)

    def test_errors_are_those_of_photons_that_are_drawn_here(self) -> None:
        counts, distance = self.captures()
        rows, truth = self.measure(TMF8820, "--shift", 2, "--photons", 500, "--readout", "histogram", "--frames", 4, "--seed", 1)
        lit = counts.sum(axis=2) > 0  # a zone without photons measured nothing
        self.assertEqual(int(lit.sum()), 9 * 159 - 2)
        numpy.testing.assert_allclose(truth, numpy.where(lit, distance, numpy.nan), atol=1e-6)
        self.assertEqual([(row["readout"], row["pixels"]) for row in rows], [("histogram", str(4 * int(lit.sum())))])
        random = numpy.random.default_rng(7)
        code_s, frames, measured = 45e-9 / 1024, 6, []
        for _ in range(frames):
            for zone in counts[lit]:
                bins = random.choice(128, size=random.poisson(500), p=zone / zone.sum())
                codes = (((bins + random.random(len(bins))) * 92.7e-12 + 2e-9) / code_s).astype(int)
                measured.append((numpy.bincount(codes[codes < 1024]).argmax() + 0.5) * code_s * LIGHT / 2)
        true = numpy.tile(truth[lit], frames)
        errors = numpy.array(measured) - true
        offset = float(numpy.median(errors))
        errors -= offset
        shown = {name: float(rows[0][name]) for name in ("above_3_percent", "above_10_percent", "rmse_mm", "median_error_mm", "offset_mm")}
        for name, limit in (("above_3_percent", 0.03), ("above_10_percent", 0.10)):
            share = float(numpy.mean(abs(errors) > limit * true))
            noise = math.sqrt(share * (1 - share) * (1 / 4 + 1 / frames) / float(lit.sum()))
            self.assertAlmostEqual(shown[name], share, delta=4 * noise + 1e-3, msg=name)
        self.assertAlmostEqual(shown["rmse_mm"], 1e3 * float(numpy.sqrt(numpy.mean(errors ** 2))), delta=0.8)
        self.assertAlmostEqual(shown["offset_mm"], 1e3 * offset, delta=1.5)
        self.assertAlmostEqual(shown["median_error_mm"], 1e3 * float(numpy.median(abs(errors))), delta=0.5)


class Tmf8829(Recording):
    def test_every_count_and_distance_is_read(self) -> None:
        self.need(TMF8829)
        frames = json.loads(gzip.decompress(TMF8829.read_bytes()))["Result_Set"]
        self.assertEqual(len(frames), 26)
        counts = numpy.array([[frame["mp_histo"][zone][0]["bin"] for frame in frames] for zone in range(16)], float)
        for frame in frames:  # each list repeats one histogram
            for entries in frame["mp_histo"]:
                self.assertTrue(all(entry["bin"] == entries[0]["bin"] for entry in entries))
        distance = numpy.array([[frame["results"][0][zone]["peaks"][0]["distance"] * 1e-3 for frame in frames] for zone in range(16)])
        archive = numpy.load(self.convert(TMF8829, "out.npz"))
        numpy.testing.assert_array_equal(archive["histograms"], counts)
        numpy.testing.assert_allclose(archive["true_distance_m"], distance, rtol=1e-12)
        rows, truth = self.measure(TMF8829, "--photons", 300, "--readout", "sifh", "--frames", 1)
        numpy.testing.assert_allclose(truth, distance, atol=1e-6)
        self.assertEqual(rows[0]["pixels"], str(26 * 16))


def mat_elements(data: bytes, offset: int = 0) -> list[tuple[int, bytes]]:
    """Types and contents of the elements of a MATLAB file of version 5."""
    found = []
    while offset + 8 <= len(data):
        kind, size = struct.unpack_from("<II", data, offset)
        if kind >> 16:  # a short element, in its own tag
            found.append((kind & 0xffff, data[offset + 4:offset + 4 + (kind >> 16)]))
            offset += 8
            continue
        content = data[offset + 8:offset + 8 + size]
        if kind == 15:
            found += mat_elements(zlib.decompress(content))
            offset += 8 + size
        else:
            found.append((kind, content))
            offset += 8 + (size + 7) // 8 * 8
    return found


NUMBERS = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 9: "<f8", 12: "<i8", 13: "<u8"}


def mat_variable(content: bytes) -> tuple[str, tuple[int, ...], list[tuple[int, bytes]]]:
    """Name, shape and the remaining elements of a matrix element."""
    _, shape, name, *rest = mat_elements(content)
    return name[1].decode(), tuple(numpy.frombuffer(shape[1], "<i4")), rest


def mat_matrix(file: Path, wanted: str) -> numpy.ndarray:
    for kind, content in mat_elements(file.read_bytes(), 128):
        name, shape, rest = mat_variable(content) if kind == 14 else ("", (), [])
        if name == wanted:
            return numpy.frombuffer(rest[0][1], NUMBERS[rest[0][0]]).astype(float).reshape(shape, order="F")
    raise KeyError(wanted)


def mat_cells(file: Path, wanted: str) -> list[list[numpy.ndarray]]:
    """Numbers of each cell, by row and column."""
    for kind, content in mat_elements(file.read_bytes(), 128):
        name, (rows, columns), cells = mat_variable(content) if kind == 14 else ("", (0, 0), [])
        if name != wanted:
            continue
        found: list[list[numpy.ndarray]] = [[numpy.zeros(0)] * columns for _ in range(rows)]
        for number, (_, cell) in enumerate(cells):
            numbers = mat_variable(cell)[2] if cell else []
            if numbers:
                found[number % rows][number // rows] = numpy.frombuffer(numbers[0][1], NUMBERS[numbers[0][0]]).astype(float)
        return found
    raise KeyError(wanted)


class PhotonTimes(Recording):
    TICK = 8e-12
    SHIFT = -20e-9

    def test_the_stronger_surface_is_the_truth(self) -> None:
        self.need(PHOTON_TIMES, SURFACES)
        times = mat_cells(PHOTON_TIMES, "photon_times")
        self.assertEqual(sum(cell.size for row in times for cell in row), 507713)
        first, second = mat_matrix(SURFACES, "T_first"), mat_matrix(SURFACES, "T_second")
        expected = numpy.full(first.shape, numpy.nan)
        for at in numpy.ndindex(first.shape):
            near = [int((abs(times[at[0]][at[1]] - surface[at]) < 150).sum()) for surface in (first, second)]
            if sum(near) > 0:
                distance = LIGHT / 2 * ((second if near[1] > near[0] else first)[at] * self.TICK + self.SHIFT)
                expected[at] = distance if distance > 0 else numpy.nan
        options = ("--shift", self.SHIFT * 1e9, "--photons", 0, "--readout", "sifh")
        rows, truth = self.measure(PHOTON_TIMES, "--surfaces", SURFACES, *options)
        numpy.testing.assert_allclose(truth, expected, atol=1e-6)
        self.assertEqual(rows[0]["pixels"], str(int(numpy.isfinite(expected).sum())))
        # Without the surfaces the photons alone say where the stronger one is.
        _, found = self.measure(PHOTON_TIMES, *options)
        both = numpy.isfinite(found) & numpy.isfinite(expected)
        self.assertGreater(float(both.mean()), 0.97)
        for row, column in numpy.argwhere(both):
            ticks = numpy.sort(times[row][column]) * self.TICK
            ends = numpy.searchsorted(ticks, ticks + WINDOW * (1 - 1e-9))
            begin = int((ends - numpy.arange(len(ticks))).argmax())
            self.assertAlmostEqual(found[row, column], LIGHT / 2 * (ticks[begin:ends[begin]].mean() + self.SHIFT), places=5)
        # The surfaces are places of the pulse's peak, the return is its mean: a constant apart. 150 ticks are four deviations of the pulse.
        apart = numpy.nanmin([abs(found - expected - numpy.median((found - expected)[both]))[both],
                              abs(found - LIGHT / 2 * (first * self.TICK + self.SHIFT))[both],
                              abs(found - LIGHT / 2 * (second * self.TICK + self.SHIFT))[both]], axis=0)
        self.assertLess(float(numpy.median(apart)), 0.03)
        self.assertGreater(float((apart < LIGHT / 2 * 150 * self.TICK).mean()), 0.95)


def ptu_or_ht3(data: bytes) -> tuple[int, float, numpy.ndarray]:
    """Mode, unit in s and records of a file of a HydraHarp."""
    if data.startswith(b"HydraHarp"):
        mode, inputs = struct.unpack_from("<i", data, 0x154)[0], struct.unpack_from("<i", data, 0x298)[0]
        offset = 0x2b8 + 20 * inputs
        words, count = struct.unpack_from("<iq", data, offset + 12)
        offset += 24 + 4 * words
        unit = struct.unpack_from("<d", data, 0x160 if mode == 3 else 0x288)[0] * 1e-12
    else:
        tags, offset = {}, 16
        while "Header_End" not in tags:
            name, kind = data[offset:offset + 32].split(b"\0")[0].decode(), struct.unpack_from("<I", data, offset + 36)[0]
            tags[name] = data[offset + 40:offset + 48]
            offset += 48
            if kind in (0x2001FFFF, 0x4001FFFF, 0x4002FFFF, 0xFFFFFFFF):
                offset += struct.unpack("<Q", tags[name])[0]
        mode = 2 if struct.unpack("<Q", tags["TTResultFormat_TTTRRecType"])[0] & 0xff00 == 0x0200 else 3
        count = struct.unpack("<Q", tags["TTResult_NumberOfRecords"])[0]
        unit = struct.unpack("<d", tags["MeasDesc_GlobalResolution" if mode == 2 else "MeasDesc_Resolution"])[0]
    return mode, unit, numpy.frombuffer(data[offset:offset + (len(data) - offset) // 4 * 4], "<u4")[:count or None].astype(numpy.int64)


def events_of(mode: int, records: numpy.ndarray, counted: bool) -> numpy.ndarray:
    """Channel, clock and time of each photon: syncs of T3, units of T2. `counted`: an overflow may stand for several."""
    special, channel = records >> 31, records >> 25 & 0x3f
    low = records & (0x3ff if mode == 3 else 0x1ffffff)
    overflow = (special == 1) & (channel == 0x3f)
    clock = numpy.cumsum(numpy.where(overflow, numpy.maximum(low, 1) if counted else 1, 0)) * (1024 if mode == 3 else 1 << 25)
    photon = special == 0
    time = records >> 10 & 0x7fff if mode == 3 else clock + low
    return numpy.stack([channel[photon], (clock + low)[photon], time[photon]], axis=1)


def made_ht3(photons: list[tuple[int, int]]) -> bytes:
    """HT3 of format 2.0 with photons (channel, time in units of 16 ps), one a sync."""
    header = bytearray(0x2b8)
    header[:9], header[16:19] = b"HydraHarp", b"2.0"
    for place, number in ((0x14c, 32), (0x154, 3)):
        header[place:place + 4] = struct.pack("<i", number)
    header[0x160:0x168] = struct.pack("<d", 16.0)
    records, syncs = [], 0
    for channel, time in photons:
        if syncs == 1023:
            records.append(1 << 31 | 0x3f << 25 | 1)
            syncs = 0
        syncs += 1
        records.append(channel << 25 | time << 10 | syncs)
    return bytes(header) + bytes(16) + struct.pack("<q", len(records)) + struct.pack(f"<{len(records)}I", *records)


class TimeTags(Recording):
    FILES = (("v10.ht3", "v10.ht3.data", False), ("v20.ht3", "v20.ht3.data", True), ("v30_t2.ptu.gz", "v30_t2.ptu.data", True))
    NO_RETURN = "none of its 4 pixels has a return: chance explains the number of photons in the fullest 2 ns of each (--return-window); " \
        "--truth gives distances"

    def photons(self, name: str) -> tuple[int, float, numpy.ndarray]:
        self.need(PICOQUANT / name)
        data = (PICOQUANT / name).read_bytes()
        mode, unit, records = ptu_or_ht3(gzip.decompress(data) if name.endswith(".gz") else data)
        return mode, unit, events_of(mode, records, dict((file, counted) for file, _, counted in self.FILES)[name])

    def test_every_event_is_read_and_the_first_are_the_authors_own(self) -> None:
        for name, decoded, _ in self.FILES:
            with self.subTest(file=name):
                mode, unit, photons = self.photons(name)
                ps = numpy.floor(photons[:, 2] * round(unit * 1e12)).astype(numpy.int64)
                own = numpy.column_stack([photons[:, 0], photons[:, 1], ps]) if mode == 3 else numpy.column_stack([photons[:, 0], ps])
                read = numpy.loadtxt(self.convert(PICOQUANT / name, "out.csv"), delimiter=",", skiprows=1, dtype=numpy.int64)
                numpy.testing.assert_array_equal(read, own)
                theirs = numpy.loadtxt(PICOQUANT / decoded, delimiter=",", dtype=numpy.int64, ndmin=2)
                first = own[:len(theirs)].copy()
                if mode == 2:  # their overflow is that of the first format (formats.md)
                    first[:, 1] = first[:, 1] % (1 << 25) + first[:, 1] // (1 << 25) * 33552000
                numpy.testing.assert_array_equal(first, theirs)

    def test_the_samples_have_no_return_and_a_sentence_says_so(self) -> None:
        for name in ("v10.ht3", "v20.ht3"):
            mode, unit, photons = self.photons(name)
            self.assertEqual(mode, 3)
            span = (photons[:, 2].max() + 1) * unit
            for channel in range(4):
                self.assertTrue(even_photons_explain(photons[photons[:, 0] == channel, 2] * unit, span), (name, channel))
            self.refused(PICOQUANT / name, self.NO_RETURN)
        self.need(PICOQUANT / "v30_t2.ptu.gz")
        self.refused(PICOQUANT / "v30_t2.ptu.gz", "the file is of mode T2 and has no syncs: no time of a photon has a begin")

    def test_a_file_with_returns_is_measured_against_them(self) -> None:
        random = numpy.random.default_rng(3)
        photons = [(channel, int(time)) for channel, peak_ns in ((0, 22.0), (2, 61.5)) for time in
                   numpy.concatenate([random.normal(peak_ns * 1e3 / 16, 30, 4000), random.uniform(0, 6000, 4000)]).clip(0, 32767)]
        random.shuffle(photons)
        file = self.folder / "mine.ht3"
        file.write_bytes(made_ht3(photons))
        mode, unit, records = ptu_or_ht3(file.read_bytes())
        read = events_of(mode, records, True)
        self.assertEqual(len(read), 16000)
        expected = [LIGHT / 2 * fullest_window(numpy.bincount(read[read[:, 0] == channel, 2], minlength=int(read[:, 2].max()) + 1), unit)
                    for channel in (0, 2)]
        rows, truth = self.measure(file, "--t-int", 100, "--photons", 2000, "--readout", "sifh,coarsehistogram", "--frames", 5)
        numpy.testing.assert_allclose(truth, [[expected[0], numpy.nan, expected[1]]], atol=2e-6)
        for true, peak_ns in zip(expected, (22.0, 61.5)):
            self.assertAlmostEqual(true, LIGHT / 2 * peak_ns * 1e-9, delta=0.02)
        self.assertEqual([(row["readout"], row["pixels"], row["above_10_percent"]) for row in rows],
                         [("SiFH", "10", "0.00000"), ("coarse histogram", "10", "0.00000")])
        # T_int ends before the second detector's return.
        _, truth = self.measure(file, "--t-int", 45, "--photons", 2000, "--readout", "sifh")
        numpy.testing.assert_allclose(truth, [[expected[0], numpy.nan, numpy.nan]], atol=2e-6)


def paeth(left: int, above: int, corner: int) -> int:
    """The predictor of PNG: which of the three is nearest to their plane."""
    return min((left, above, corner), key=lambda one: abs(left + above - corner - one))


def grey_png(file: Path) -> numpy.ndarray:
    """Grey values of a PNG of 8 bits, grey or RGB with equal colours."""
    data, offset, packed = file.read_bytes(), 8, b""
    columns, rows, bits, colour = struct.unpack_from(">IIBB", data, 16)
    assert bits == 8
    while offset < len(data):
        length, name = struct.unpack_from(">I4s", data, offset)
        packed += data[offset + 8:offset + 8 + length] if name == b"IDAT" else b""
        offset += 12 + length
    pixel = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    lines = zlib.decompress(packed)
    before, found = [0] * (columns * pixel), []
    for row in range(rows):
        method, *line = lines[row * (columns * pixel + 1):(row + 1) * (columns * pixel + 1)]
        for i, value in enumerate(line):
            left, corner = (line[i - pixel], before[i - pixel]) if i >= pixel else (0, 0)
            line[i] = (value + (0, left, before[i], (left + before[i]) // 2, paeth(left, before[i], corner))[method]) & 0xff
        found.append(line[::pixel])
        before = line
    return numpy.array(found, float)


class OtherFiles(Recording):
    def test_disparity_maps_are_read(self) -> None:
        for scene in ("Art", "Moebius", "Laundry"):
            file = SHARED / f"middlebury_{scene}_disp1.png"
            self.need(file)
            with self.subTest(scene=scene):
                grey = grey_png(file)
                read = numpy.load(self.convert(file, f"{scene}.npy", "--depth-scale", 0.01))
                numpy.testing.assert_allclose(numpy.nan_to_num(read), 0.01 * grey, rtol=1e-6)

    def test_the_pulse_is_read(self) -> None:
        self.need(PULSE)
        numpy.testing.assert_array_equal(numpy.load(self.convert(PULSE, "pulse.npy")), numpy.load(PULSE))

    def test_codes_of_a_recorded_frame_have_the_measured_widths(self) -> None:
        self.need(TDCS)
        lines = [line.split(",")[1:] for line in gzip.decompress(TDCS.read_bytes()).decode().splitlines()[1:]]
        table = [[float(field) for field in line] for line in lines if any(line)]  # three TDCs have no times
        self.assertEqual((len(lines), len(table)), (256, 253))
        shares = []
        for edges in table:
            widths = numpy.diff([0.0, *edges])
            lit = numpy.flatnonzero(widths)
            repeated = numpy.resize(widths[lit[0]:lit[-1] + 1], 1024)
            shares.append(repeated / repeated.sum())
        sensor = (ROOT / "studies/sensor_effects/tdc_per_pixel.toml").read_text(encoding="utf-8")
        sensor = sensor.replace("columns = 200", "columns = 16").replace("rows = 160", "rows = 16")
        sensor = sensor.replace("dark_count_rate_hz = 1e4", "dark_count_rate_hz = 5e6")  # spread evenly, unlike the pulse
        sensor = sensor.replace('"linospad2', f'"{TDCS.parent}/linospad2')
        (self.folder / "tdcs.toml").write_text(sensor, encoding="utf-8")
        done = self.run_program("dtof", "frame", "--sensor", "tdcs.toml", "--scene", "flat", "--distance", 6, "--reflectivity", 0.0001, "--klux", 0,
                                "--acquisitions", 20000, "--readout", "ezpointer", "--record", "codes.csv", "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        codes = numpy.loadtxt(self.folder / "codes.csv", delimiter=",", skiprows=1, dtype=numpy.int64)[:, 3]
        seen = numpy.bincount(codes, minlength=1024)
        expected = numpy.mean([shares[pixel % len(shares)] for pixel in range(256)], axis=0) * len(codes)
        lit = expected > 20
        self.assertGreater(int(lit.sum()), 900)
        deviation = float(((seen - expected)[lit] ** 2 / expected[lit]).mean())
        self.assertLess(deviation, 1.3)
        even = len(codes) / 1024
        self.assertGreater(float(((seen - even) ** 2 / even).mean()), 10 * deviation)


if __name__ == "__main__":
    unittest.main()
