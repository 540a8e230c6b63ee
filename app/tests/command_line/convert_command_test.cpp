// SPDX-License-Identifier: Apache-2.0
// `dtof convert` as a user runs it.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dtof/io/depth_image.hpp"
#include "dtof/io/npy.hpp"
#include "tests/io/io_test_support.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::EndsWith;
using ::testing::HasSubstr;

class ConvertCommand : public test::IoTest {
 protected:
  [[nodiscard]] Outcome dtof(const std::string& arguments) const {
    return run_shell(fmt::format("cd '{}' && {} {}", path("").string(), DTOF_PROGRAM, arguments));
  }
  /// Exit code 1, one line that ends with the reason, and no further file.
  void expect_refused(const std::string& arguments, const std::string& reason) const {
    SCOPED_TRACE(arguments);
    const std::size_t files = file_count();
    const Outcome outcome = dtof("convert " + arguments);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, EndsWith(reason + "\n"));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_EQ(file_count(), files);
  }
};

TEST_F(ConvertCommand, ADepthMapOfAFrameBecomesAPointCloudWithItsConfidence) {
  const Outcome frame = dtof("frame -r sifh --array-columns 6 --array-rows 5 --acquisitions 300 --out f");
  ASSERT_EQ(frame.exit_code, 0) << frame.output;
  const Outcome outcome = dtof("convert f/sifh_depth_mm.png a.pcd --confidence f/sifh.csv --text");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, testing::StartsWith("a.pcd: 6 x 5 pixels, "));
  EXPECT_THAT(contents(path("a.pcd")), HasSubstr("FIELDS x y z confidence\n"));
}

TEST_F(ConvertCommand, HistogramsAreReplayedFromAnArchiveThatHasItsBins) {
  std::vector<double> counts(96, 0.0);  // 2 rows, 3 columns, 16 bins
  for (std::size_t pixel = 0; pixel < 6; ++pixel) {
    counts[pixel * 16 + 5] = 40.0;
  }
  write_npy(path("a.npy"), std::vector<std::size_t>{2, 3, 16}, counts);
  EXPECT_EQ(dtof("convert a.npy a.npz --bin-width 2000").exit_code, 0);
  const Outcome replay = dtof("replay a.npz:array -r sifh --out r");
  EXPECT_EQ(replay.exit_code, 0) << replay.output;
  EXPECT_THAT(replay.output, HasSubstr("(histogram cube): 3 columns x 2 rows"));
}

TEST_F(ConvertCommand, BadInputIsOneLine) {
  write_npy(path("map.npy"), std::vector<std::size_t>{2, 2}, std::vector<double>{1, 2, 3, 4});
  (void)write("cut.npy", contents(path("map.npy")).substr(0, 140));
  expect_refused("none.npy a.npz", "none.npy: cannot read: No such file or directory");
  expect_refused("cut.npy a.npz",
                 "cut.npy: shape (2, 2) of f8 needs more than the file's 1 elements: truncated");
  expect_refused(
      "map.npy a.txt",
      "a.txt: what to write follows from the name's ending: .png, .pfm, .ply, .pcd, .npy, .npz or .csv");
  expect_refused("map.npy a.npz --text", "--text has no effect: only point clouds (.ply, .pcd) have it");
  expect_refused("map.npy a.pcd --tick 3", "--tick has no effect: only photon times (MAT) have it");
  expect_refused(
      "map.npy a.pfm --confidence map.npy",
      "--confidence has no effect: only point clouds (.ply, .pcd) and archives (.npz) have fields");
  expect_refused("map.npy a.pcd --photons 3",
                 "--photons has no effect: only a TDC stream (.csv) of histograms or photon times has it");
  expect_refused("map.npy a.npz --format hdf5", "map.npy: not an HDF5 file, or a pipe");
}

TEST_F(ConvertCommand, TimesBeyondASecondAreRefusedAndLostPhotonsAreCounted) {
  std::vector<double> counts(80, 0.0);
  counts[10] = 10.0;
  counts[60] = 5.0;
  write_npy(path("a.npy"), std::vector<std::size_t>{1, 1, 80}, counts);
  expect_refused("a.npy a.csv --bin-width 1e300", "--bin-width: 1e300 is above 1000000000000 ps, a second");
  expect_refused("a.npy a.npz --bin-width 1e300", "--bin-width: 1e300 is above 1000000000000 ps, a second");
  expect_refused("a.npy a.csv --bin-width 1000 --shift 1e300",
                 "--shift: 1e300 is not within -1000000000 to 1000000000 ns, a second");
  expect_refused("a.npy a.csv --bin-width 1000 --t-int 1e300",
                 "--t-int: 1e300 is above 1000000000 ns, a second");
  expect_refused(
      "a.npy a.csv --bin-width 1000 --shift 900",
      "a.npy: all 15 photons of the pixels read are outside the range, 0 to 45 ns: --t-int and --shift "
      "move it");
  const Outcome outcome = dtof("convert a.npy a.csv --bin-width 1000");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output,
              EndsWith("acquisitions; 5 of 15 photons are outside the range, 0 to 45 ns, and lost\n"));
}

TEST_F(ConvertCommand, DistancesBelowHalfAMillimetreAreNotLostInSilence) {
  const std::vector<std::size_t> shape = {2, 2};
  write_npy(path("a.npy"), shape, std::vector<double>{4e-4, 1e-4, 0.0, 4.9e-4});
  expect_refused(
      "a.npy a.png",
      "a.png: each of the 3 distances is below 0.5 mm, and a PNG has whole mm: choose .pfm or .npy, or "
      "another --depth-scale");
  EXPECT_EQ(dtof("convert a.npy a.pfm").exit_code, 0);
  write_npy(path("b.npy"), shape, std::vector<double>{4e-4, 1.0, 0.0, 4.9e-4});
  const Outcome some = dtof("convert b.npy b.png");
  EXPECT_EQ(some.exit_code, 0);
  EXPECT_THAT(some.output, EndsWith("; 2 are below 0.5 mm and lost, because a PNG has whole mm\n"));
  write_npy(path("c.npy"), shape, std::vector<double>{0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(dtof("convert c.npy c.png").exit_code, 0);  // no distance is known
}

}  // namespace
}  // namespace dtof
