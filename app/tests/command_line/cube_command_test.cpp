// SPDX-License-Identifier: Apache-2.0
// `dtof frame --cube` and a moving camera as a user runs them; malformed cubes, each with its sentence.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dtof/container/npz.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/npy.hpp"
#include "tests/container/hdf5_writer.hpp"
#include "tests/container/zip_writer.hpp"
#include "tests/io/io_test_support.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kSmallFrame =
    "frame -r histogram,coarsehistogram --array-columns 6 --array-rows 5 --table none ";

class CubeCommand : public test::IoTest {
 protected:
  [[nodiscard]] Outcome dtof(const std::string& arguments) const {
    return run_shell(fmt::format("cd '{}' && {} {}", path("").string(), DTOF_PROGRAM, arguments));
  }
  /// Exit code 1, one line that ends with the reason, and no further file.
  void expect_refused(const std::string& arguments, const std::string& reason) const {
    SCOPED_TRACE(arguments);
    const std::size_t files = file_count();
    const Outcome outcome = dtof(arguments);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, EndsWith(": " + reason + "\n"));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_EQ(file_count(), files);
  }
  /// 1 row, 2 columns, 400 bins of 100 ps: 3 m everywhere, and before the second column's target a third as
  /// much at 1.5 m.
  [[nodiscard]] static std::vector<double> two_returns() {
    std::vector<double> events(800, 0.0);
    events[200] = events[600] = 0.06;
    events[500] = 0.02;
    return events;
  }
  void write_cube(const std::string& name, const std::vector<std::size_t>& shape,
                  const std::vector<double>& events) const {
    write_npy(path(name), shape, events);
  }
};

TEST_F(CubeCommand, ACubeIsAScene) {
  NpzWriter writer(path("cube.npz"));
  writer.add("transient", std::vector<std::size_t>{1, 2, 400}, two_returns());
  writer.add("bin_width_s", std::vector<std::size_t>{1}, std::vector<double>{100e-12});
  writer.commit();
  const Outcome outcome = dtof(kSmallFrame + "--cube cube.npz --out keys --json 2> text");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto result = nlohmann::json::parse(outcome.output);
  EXPECT_THAT(
      result.at("heading").get<std::string>(),
      HasSubstr("Transient cube cube.npz: 2 x 1 pixels, resampled to 6 x 5 by nearest neighbour. 400 bins "
                "of 100 ps."));
  const auto& histogram = result.at("readouts").at(0);
  EXPECT_EQ(histogram.at("pixels"), 30);
  EXPECT_EQ(histogram.at("behind_another_return"), 15);
  EXPECT_LT(histogram.at("rmse_m"), 0.1);
  EXPECT_THAT(
      contents(path("keys/summary.md")),
      HasSubstr("Pixels with a weaker return before the strongest one: 15. Results at this first return"));
  // The options say the same as the archive's keys, and a scale is no more than a factor.
  write_cube("cube.npy", {1, 2, 400, 1}, two_returns());
  ASSERT_EQ(dtof(kSmallFrame + "--cube cube.npy --cube-bin-width 1e-10 --out options").exit_code, 0);
  EXPECT_EQ(contents(path("keys/histogram.csv")), contents(path("options/histogram.csv")));
  std::vector<double> doubled = two_returns();
  std::ranges::transform(doubled, doubled.begin(), [](double events) { return 2.0 * events; });
  write_cube("doubled.npy", {1, 2, 400}, doubled);
  ASSERT_EQ(
      dtof(kSmallFrame + "--cube doubled.npy --cube-bin-width 1e-10 --cube-scale 0.5 --out scaled").exit_code,
      0);
  EXPECT_EQ(contents(path("keys/histogram.csv")), contents(path("scaled/histogram.csv")));
  // Another start is another distance.
  ASSERT_EQ(dtof(kSmallFrame + "--cube cube.npz --cube-start -5e-9 --out earlier").exit_code, 0);
  EXPECT_NE(contents(path("keys/histogram.csv")), contents(path("earlier/histogram.csv")));
}

TEST_F(CubeCommand, ACubeInItsFileIsTheHeldOne) {
  write_cube("a.npy", {1, 2, 400}, two_returns());
  const std::string array = contents(path("a.npy"));
  const std::string width = test::npy_begin("<f8", "()") + test::bytes_of(1e-10);
  const test::ZipPart key = test::stored_part("bin_width_s.npy", width);
  test::ZipPart stored = test::stored_part("cube.npy", array);
  test::write_zip(path("stored.npz"), {stored, key}, true);
  test::write_zip(path("deflated.npz"), {test::deflated_part("cube.npy", array), key}, false);
  const Outcome piped =
      run_shell(fmt::format("cd '{}' && cat a.npy | {} {}--cube /dev/stdin --cube-bin-width 1e-10 --out held",
                            path("").string(), DTOF_PROGRAM, kSmallFrame));
  ASSERT_EQ(piped.exit_code, 0) << piped.output;
  test::write_hdf5(path("a.h5"), {1, 2, 400}, two_returns(), H5T_IEEE_F64LE,
                   {.chunk = {1, 1, 100}, .deflate = true});
  test::write_hdf5(path("a.mat"), {1, 2, 400}, two_returns(), H5T_IEEE_F64LE, {.matlab = true});
  for (const char* const file : {"a.npy --cube-bin-width 1e-10", "stored.npz", "deflated.npz",
                                 "a.h5 --cube-bin-width 1e-10", "a.mat --cube-bin-width 1e-10"}) {
    ASSERT_EQ(dtof(fmt::format("{}--cube {} --out out", kSmallFrame, file)).exit_code, 0) << file;
    EXPECT_EQ(contents(path("out/histogram.csv")), contents(path("held/histogram.csv"))) << file;
  }
  stored.crc ^= 1U;
  test::write_zip(path("wrong.npz"), {stored, key}, false);
  EXPECT_EQ(dtof(kSmallFrame + "--cube wrong.npz --out wrong").output,
            "dtof: error: wrong.npz:cube: damaged: the checksum (CRC-32) is not that of the archive\n");
  std::vector<double> events = two_returns();
  events.back() = 0x1.23456789abcdep-9;
  test::write_hdf5(path("wrong.h5"), {1, 2, 400}, events, H5T_IEEE_F64LE,
                   {.chunk = {1, 1, 400}, .fletcher32 = true});
  std::string file = contents(path("wrong.h5"));
  file[file.find(test::bytes_of(events.back()))] ^= 1;
  (void)write("wrong.h5", file);
  EXPECT_EQ(dtof(kSmallFrame + "--cube wrong.h5 --cube-bin-width 1e-10 --out wrong").output,
            "dtof: error: wrong.h5: /a: the dataset is damaged, or packed by a filter that is not here\n");
  EXPECT_FALSE(std::filesystem::exists(path("wrong")));
}

TEST_F(CubeCommand, PixelsWithoutLightAreNotJudged) {
  std::vector<double> events = two_returns();
  events[200] = 0.0;
  write_cube("cube.npy", {1, 2, 400}, events);
  const Outcome outcome = dtof(kSmallFrame + "--cube cube.npy --cube-bin-width 1e-10 --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("15 pixels are without a true distance and not judged."));
}

TEST_F(CubeCommand, MalformedCubesHaveASentenceEach) {
  const auto with = [](double value) {
    std::vector<double> events = two_returns();
    events[412] = value;
    return events;
  };
  const std::string frame = kSmallFrame + "--cube a.npy --cube-bin-width 1e-10 --out out";
  struct MalformedCube {
    std::vector<std::size_t> shape;
    std::vector<double> events;
    std::string sentence;
  };
  const std::vector<MalformedCube> table = {
      {{2, 400}, two_returns(), "shape (2, 400): a transient cube has rows, columns and time bins"},
      {{1, 1, 2, 2, 200},
       two_returns(),
       "shape (1, 1, 2, 2, 200): a transient cube has rows, columns and time bins"},
      {{1, 2, 100, 4},
       two_returns(),
       "shape (1, 2, 100, 4): a transient cube has no colours; take one channel, or the mean of all"},
      {{1, 2, 400}, with(std::nan("")), "column 1, row 0, bin 12: nan is not a finite number of at least 0"},
      {{1, 2, 400}, with(-0.5), "column 1, row 0, bin 12: -0.5 is not a finite number of at least 0"},
      {{1, 2, 400}, with(INFINITY), "column 1, row 0, bin 12: inf is not a finite number of at least 0"},
      {{1, 2, 400}, std::vector<double>(800, 0.0), "no pixel has a distance"},
  };
  for (const MalformedCube& cube : table) {
    write_cube("a.npy", cube.shape, cube.events);
    expect_refused(frame, "a.npy: " + cube.sentence);
  }
  write_cube("a.npy", {1, 2, 400}, two_returns());
  expect_refused(
      kSmallFrame + "--cube a.npy --out out",
      "a.npy: a transient cube needs the width of its bins: --cube-bin-width in s, or bin_width_s in the "
      "file");
  expect_refused(kSmallFrame + "--cube a.npy --cube-bin-width 100 --out out",
                 "a.npy: a bin of 100 s is longer than the sensor's range of 4.5e-08 s");
  expect_refused(
      frame + " --cube-start -1e-6",
      "a.npy: column 0, row 0: the strongest return is at -146.891 m, before the laser's shot; see the "
      "cube's start");
  expect_refused(
      frame + " --cube-scale 1e9",
      "pixel (column 0, row 0): 2e+11 mean events a frame are too many for a transient cube (at most "
      "1e+08); its scale is in detected events of a pixel and pulse");
  expect_refused(kSmallFrame + "--cube " + write("b.txt", "1 2 3").string() + " --out out",
                 path("b.txt").string() + ": a transient cube is an NPY, NPZ or HDF5 file");
}

TEST_F(CubeCommand, OptionsThatDoNotFitACubeAreErrors) {
  write_cube("a.npy", {1, 2, 400}, two_returns());
  const std::string frame = kSmallFrame + "--out out --cube a.npy --cube-bin-width 1e-10 ";
  expect_refused(frame + "--depth a.npy", "--depth and --cube contradict each other: choose one");
  expect_refused(frame + "--scene room", "--scene has no effect: --cube takes its place");
  expect_refused(frame + "--distance 2", "--distance has no effect: only --scene flat has one distance");
  expect_refused(kSmallFrame + "--cube-scale 2 --out out",
                 "--cube-bin-width, --cube-start and --cube-scale need --cube");
  EXPECT_THAT(dtof(frame + "--fidelity fast").output, HasSubstr("transient cube: use the exact one"));
  EXPECT_THAT(dtof(frame + "--fidelity analytic").output, HasSubstr("transient cube: use the exact one"));
  EXPECT_EQ(dtof(frame + "--fidelity auto").exit_code, 0);
  EXPECT_THAT(dtof(frame + "--sensor thesis+fog").output, HasSubstr("cannot see a transient cube"));
  // Sunlight is the sensor's and the reflectivity's, as for other scenes.
  ASSERT_EQ(dtof(frame + "--reflectivity 0.1 --klux 100").exit_code, 0);
}

TEST_F(CubeCommand, AMovingCameraSeesAnEdgeInMorePixels) {
  const std::string frame =
      "frame -r histogram --scene staircase --steps 2 --array-columns 12 --array-rows 4 --table none --klux "
      "1 ";
  const Outcome still = dtof(frame + "--out still --json 2> text");
  const Outcome moved = dtof(frame + "--sensor thesis+camera-motion --out moved --json 2> text");
  ASSERT_EQ(still.exit_code, 0) << still.output;
  ASSERT_EQ(moved.exit_code, 0) << moved.output;
  const auto rmse = [](const Outcome& outcome) {
    return nlohmann::json::parse(outcome.output).at("readouts").at(0).at("rmse_m").get<double>();
  };
  EXPECT_GT(rmse(moved), 2.0 * rmse(still));
  EXPECT_THAT(dtof("list").output, HasSubstr("the camera moves right by 4 columns during the frame"));
}

}  // namespace
}  // namespace dtof
