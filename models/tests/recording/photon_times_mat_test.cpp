// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/photon_times_mat.hpp"

#include <fmt/format.h>
#include <matio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "dtof/recording/recording.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kTick = 8e-12;

class PhotonTimesTest : public test::IoTest {
 protected:
  /// 2 rows x 3 columns of cells; the cell of (row, column) holds row + column times 100 * row + 10 * column
  /// + i.
  std::filesystem::path write_cells(const char* name, matio_compression compression) {
    mat_t* const file = Mat_CreateVer(path(name).c_str(), nullptr, MAT_FT_MAT5);
    std::array<std::size_t, 2> dims = {2, 3};
    matvar_t* const cells = Mat_VarCreate("photon_times", MAT_C_CELL, MAT_T_CELL, 2, dims.data(), nullptr, 0);
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 2; ++row) {
        std::vector<double> times(static_cast<std::size_t>(row) + static_cast<std::size_t>(column));
        std::iota(times.begin(), times.end(), 100.0 * row + 10.0 * column);
        std::array<std::size_t, 2> size = {times.size(), 1};
        Mat_VarSetCell(cells, row + 2 * column,
                       Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), times.data(), 0));
      }
    }
    Mat_VarWrite(file, cells, compression);
    Mat_VarFree(cells);
    std::array<std::int32_t, 6> depth = {1, 2, 3, 4, 5, 6};
    matvar_t* const matrix =
        Mat_VarCreate("depth", MAT_C_INT32, MAT_T_INT32, 2, dims.data(), depth.data(), 0);
    Mat_VarWrite(file, matrix, compression);
    Mat_VarFree(matrix);
    Mat_Close(file);
    return path(name);
  }
};

TEST_F(PhotonTimesTest, ReadsCellsInRowOrder) {
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    const PhotonTimes photons = read_photon_times_mat(write_cells("a.mat", compression));
    EXPECT_EQ(photons.columns, 3);
    EXPECT_EQ(photons.rows, 2);
    EXPECT_THAT(photons.pixel(0, 0), IsEmpty());
    EXPECT_THAT(photons.pixel(2, 0), ElementsAre(20, 21));
    EXPECT_THAT(photons.pixel(2, 1), ElementsAre(120, 121, 122));
    EXPECT_THAT(read_mat_matrix(path("a.mat"), "depth").values, ElementsAre(1, 3, 5, 2, 4, 6));
  }
}

TEST_F(PhotonTimesTest, Refusals) {
  const auto file = write_cells("a.mat", MAT_COMPRESSION_NONE);
  test::expect_input_error([&] { (void)read_photon_times_mat(path("none.mat")); },
                           EndsWith("none.mat: cannot read: No such file or directory"));
  test::expect_input_error([&] { (void)read_photon_times_mat(write("t.mat", "plain text, no MATLAB file")); },
                           EndsWith("t.mat: not a MATLAB file"));
  test::expect_input_error([&] { (void)read_photon_times_mat(file, "times"); },
                           EndsWith("the variable \"times\" is missing or damaged"));
  test::expect_input_error([&] { (void)read_photon_times_mat(file, "depth"); },
                           EndsWith("\"depth\" is not a cell array"));
  test::expect_input_error([&] { (void)read_mat_matrix(file, "photon_times"); },
                           EndsWith("\"photon_times\" is not a real numeric matrix, or damaged"));
  test::expect_input_error([&] { PhotonTimesStream(read_photon_times_mat(file), 0.0, {}); },
                           "photon times: tick duration is 0, must be a positive number of seconds");
}

TEST_F(PhotonTimesTest, SparseMatricesAreRefusedWithTheWayOut) {
  mat_t* const file = Mat_CreateVer(path("s.mat").c_str(), nullptr, MAT_FT_MAT5);
  std::array<std::size_t, 2> dims = {4, 3};
  std::array<mat_uint32_t, 1> rows = {2};
  std::array<mat_uint32_t, 4> ends = {0, 0, 1, 1};
  std::array<double, 1> values = {7.0};
  mat_sparse_t sparse{};
  sparse.nzmax = 1;
  sparse.ir = rows.data();
  sparse.nir = 1;
  sparse.jc = ends.data();
  sparse.njc = ends.size();
  sparse.ndata = 1;
  sparse.data = values.data();
  matvar_t* const spad =
      Mat_VarCreate("spad", MAT_C_SPARSE, MAT_T_DOUBLE, 2, dims.data(), &sparse, MAT_F_DONT_COPY_DATA);
  Mat_VarWrite(file, spad, MAT_COMPRESSION_NONE);
  std::array<std::size_t, 2> one = {1, 1};
  matvar_t* const cells = Mat_VarCreate("cells", MAT_C_CELL, MAT_T_CELL, 2, one.data(), nullptr, 0);
  Mat_VarSetCell(cells, 0, spad);
  Mat_VarWrite(file, cells, MAT_COMPRESSION_NONE);
  Mat_VarFree(cells);
  Mat_Close(file);
  for (const auto& read : {std::function([&] { (void)read_mat_matrix(path("s.mat"), "spad"); }),
                           std::function([&] { (void)read_photon_times_mat(path("s.mat"), "spad"); })}) {
    test::expect_input_error(
        read, EndsWith("s.mat: \"spad\" is sparse, which is not supported; convert it in MATLAB "
                       "or Octave: spad = full(spad); save('-v7', 'full.mat', 'spad')"));
  }
  test::expect_input_error([&] { (void)read_photon_times_mat(path("s.mat"), "cells"); },
                           HasSubstr("cells = cellfun(@full, cells, 'UniformOutput', false); save"));
}

TEST_F(PhotonTimesTest, AHeaderThatAsksForMoreThanTheFileHoldsIsRefusedBeforeItIsRead) {
  std::string whole = contents(write_cells("a.mat", MAT_COMPRESSION_NONE));
  // The dimensions of "photon_times", 2 x 3, stand behind the flags: 128 + 8 + 16 + 8 bytes into the file.
  ASSERT_EQ(whole[160], 2);
  whole[162] = 0;
  whole[161] = static_cast<char>(0xE0);
  whole[165] = static_cast<char>(0xE0);
  test::expect_input_error([&] { (void)read_photon_times_mat(write("t.mat", whole)); },
                           HasSubstr("damaged: \"photon_times\" has 57346 x 57347 cells in "));
}

TEST_F(PhotonTimesTest, ShortElementsStandInTheirTag) {
  mat_t* const file = Mat_CreateVer(path("d.mat").c_str(), nullptr, MAT_FT_MAT5);
  std::array<std::size_t, 2> dims = {1, 3};
  std::array<double, 3> depth = {1.5, 2.5, 3.5};
  matvar_t* const matrix = Mat_VarCreate("d", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims.data(), depth.data(), 0);
  Mat_VarWrite(file, matrix, MAT_COMPRESSION_NONE);
  Mat_VarFree(matrix);
  Mat_Close(file);
  std::string whole = contents(path("d.mat"));
  // The name stands behind header, tag, flags and extents, with a tag of its own, or in it: 1 byte of type 1.
  constexpr std::size_t kName = 128 + 8 + 16 + 16;
  const std::string in_tag("\1\0\1\0d\0\0\0", 8);
  const std::string with_tag("\1\0\0\0\1\0\0\0d\0\0\0\0\0\0\0", 16);
  if (whole.compare(kName, with_tag.size(), with_tag) == 0) {
    whole.replace(kName, with_tag.size(), in_tag);
    whole[132] = static_cast<char>(whole[132] - 8);  // the variable's size
  }
  ASSERT_EQ(whole.compare(kName, in_tag.size(), in_tag), 0);
  EXPECT_THAT(read_mat_matrix(write("s.mat", whole), "d").values, ElementsAre(1.5, 2.5, 3.5));
  whole[kName + in_tag.size()] = 99;  // no type of numbers
  test::expect_input_error([&] { (void)read_mat_matrix(write("s.mat", whole), "d"); },
                           EndsWith("\"d\" is not a real numeric matrix, or damaged"));
}

TEST_F(PhotonTimesTest, TruncationAnywhereIsRefused) {
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    const std::string whole = contents(write_cells("a.mat", compression));
    // A file cut exactly behind its header or its first variable is a whole file that lacks variables.
    for (std::size_t size = 1; size < whole.size(); ++size) {
      SCOPED_TRACE(fmt::format("{} of {} bytes", size, whole.size()));
      const auto cut = write("t.mat", whole.substr(0, size));
      test::expect_input_error(
          [&] {
            (void)read_photon_times_mat(cut);
            (void)read_mat_matrix(cut, "depth");
          },
          AnyOf(HasSubstr("not a MATLAB file"), HasSubstr("damaged")));
    }
  }
}

TEST_F(PhotonTimesTest, DamagedCompressionIsRefused) {
  std::string whole = contents(write_cells("a.mat", MAT_COMPRESSION_ZLIB));
  whole[160] = static_cast<char>(whole[160] ^ 1);
  test::expect_input_error(
      [&] { (void)read_photon_times_mat(write("t.mat", whole)); },
      EndsWith("t.mat: damaged: the variable at byte 128 does not decompress, or not to 1 GiB at most; "
               "\"photon_times\" was asked for"));
}

TEST_F(PhotonTimesTest, RefusalsOfHistogramsNameTheVariable) {
  mat_t* const file = Mat_CreateVer(path("h.mat").c_str(), nullptr, MAT_FT_MAT5);
  std::array<std::size_t, 3> dims = {1, 1, 2};
  std::array<double, 2> counts = {1.0, -1.0};
  matvar_t* const cube =
      Mat_VarCreate("counts", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, dims.data(), counts.data(), 0);
  Mat_VarWrite(file, cube, MAT_COMPRESSION_NONE);
  Mat_VarFree(cube);
  Mat_Close(file);
  const std::string name = path("h.mat").string();
  for (const RecordingOptions& options :
       {RecordingOptions{.file = name, .bin_width_s = 1e-9, .variable = "counts"},
        RecordingOptions{.file = name + ":counts", .bin_width_s = 1e-9}}) {
    test::expect_input_error([&] { (void)open_recorded_data(options, read_recording(options)); },
                             HasSubstr("h.mat:counts: column 0, row 0, bin 1"));
  }
}

TEST_F(PhotonTimesTest, OtherMatlabVersionsAreRefused) {
  std::string whole = contents(write_cells("a.mat", MAT_COMPRESSION_NONE));
  whole[125] = 2;
  test::expect_input_error([&] { (void)read_photon_times_mat(write("t.mat", whole)); },
                           EndsWith("t.mat: not a little-endian MATLAB 5 file (save with -v7 or -v6)"));
}

TEST_F(PhotonTimesTest, StreamMapsTicksToCodesAndThins) {
  PhotonTimes photons{
      .columns = 1, .rows = 1, .ticks = std::vector<double>(2000, 1000.0), .begin = {0, 2000}};
  // 1000 ticks of 8 ps less 4 ns are 4 ns: code 64 of 1024 in 64 ns.
  Resampling resampling{
      .integration_time = 64e-9, .time_shift = -3.99e-9, .acquisitions = 100000, .slots = 8};
  const ColumnStream all = PhotonTimesStream(photons, kTick, resampling).column(0);
  EXPECT_EQ(all.detection_count(), 2000U);
  EXPECT_TRUE(std::ranges::all_of(all.row(0), [](const Detection& d) { return d.timestamp == 64; }));

  resampling.photon_budget = 500.0;
  const auto thinned = PhotonTimesStream(photons, kTick, resampling).column(0).detection_count();
  EXPECT_NE(thinned, 500U);
  EXPECT_NEAR(static_cast<double>(thinned), 500.0, 5 * 19.4);
  resampling.photon_number = PhotonNumber::kFixed;
  EXPECT_EQ(PhotonTimesStream(photons, kTick, resampling).column(0).detection_count(), 500U);
  resampling.photon_budget = 5000.0;
  EXPECT_EQ(PhotonTimesStream(photons, kTick, resampling).column(0).detection_count(), 2000U);
}

TEST_F(PhotonTimesTest, ReadsTheMeasuredTwoLayerScene) {
  const auto file = test::shared_data("shin2016_two_layer_photon_times.mat");
  DTOF_SKIP_IF_ABSENT(file);
  const PhotonTimes photons = read_photon_times_mat(file);
  EXPECT_EQ(photons.columns, 100);
  EXPECT_EQ(photons.rows, 100);
  EXPECT_EQ(photons.ticks.size(), 507713U);
  const auto [lowest, highest] = std::ranges::minmax(photons.ticks);
  EXPECT_GE(lowest, 3000.0);
  EXPECT_LE(highest, 7000.0);
  EXPECT_THAT(photons.pixel(0, 0).subspan(0, 4), ElementsAre(4349, 4366, 4347, 4267));

  // Ticks 3000..7000 of 8 ps are 24 to 56 ns: 20 ns earlier they all fit in 45 ns.
  const PhotonTimesStream stream(photons, kTick, {.time_shift = -20e-9, .slots = 8});
  std::size_t detections = 0;
  for (int column = 0; column < stream.columns(); ++column) {
    detections += stream.column(column).detection_count();
  }
  EXPECT_EQ(detections, photons.ticks.size());

  const MatMatrix truth = read_mat_matrix(test::shared_data("shin2016_two_layer_obj.mat"), "T_first");
  ASSERT_EQ(truth.values.size(), 10000U);
}

}  // namespace
}  // namespace dtof
