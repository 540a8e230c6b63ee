// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/hdf5_array.hpp"

#include <hdf5.h>
#include <matio.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Hdf5ArrayTest : public test::IoTest {
 protected:
  /// Adds a dataset of numbers, in pieces of 2 and packed where that is asked for.
  void add(const char* name, const std::vector<hsize_t>& extents, hid_t kind,
           const std::vector<double>& values, bool packed = false) const {
    const bool exists = std::filesystem::exists(path("a.h5"));
    const hid_t file = exists ? H5Fopen(path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT)
                              : H5Fcreate(path("a.h5").c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    if (packed) {
      const std::vector<hsize_t> chunk(extents.size(), 2);
      H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data());
      H5Pset_deflate(layout, 6);
    }
    const hid_t dataset = H5Dcreate2(file, name, kind, space, links, layout, H5P_DEFAULT);
    if (!values.empty()) {
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    H5Dclose(dataset);
    H5Pclose(layout);
    H5Pclose(links);
    H5Sclose(space);
    H5Fclose(file);
  }
  /// A MAT file of version 7.3 with one variable.
  void write_mat(const char* name, matvar_t* variable) const {
    mat_t* const file = Mat_CreateVer(path(name).c_str(), nullptr, MAT_FT_MAT73);
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE), 0);
    Mat_VarFree(variable);
    Mat_Close(file);
  }
  void refused(const std::string& name, const std::string& sentence) const {
    test::expect_input_error([&] { (void)read_hdf5_array(path("a.h5"), name); },
                             path("a.h5").string() + ": " + sentence);
  }
};

TEST_F(Hdf5ArrayTest, ReadsNumbersOfEveryKind) {
  std::vector<double> values(24);
  std::iota(values.begin(), values.end(), 0.0);
  add("/measured/cube", {2, 3, 4}, H5T_STD_U16BE, values, true);
  EXPECT_TRUE(is_hdf5(path("a.h5")));
  EXPECT_FALSE(is_hdf5(write("b.h5", "no HDF5 file")));
  const NpyArray cube = read_hdf5_array(path("a.h5"), "");
  EXPECT_THAT(cube.shape, ElementsAre(2, 3, 4));
  EXPECT_EQ(cube.values, values);
  add("/depth", {2}, H5T_IEEE_F32LE, {1.5, 2.5});
  EXPECT_THAT(hdf5_names(path("a.h5")), ElementsAre("/depth", "/measured/cube"));
  EXPECT_THAT(read_hdf5_array(path("a.h5"), "/depth").values, ElementsAre(1.5, 2.5));
  EXPECT_EQ(read_hdf5_array(path("a.h5"), "measured/cube").values, values);
}

TEST_F(Hdf5ArrayTest, MatlabsAxesAreInMatlabsOrder) {
  // Element (row, column, bin) is 100 row + 10 column + bin; MATLAB writes the rows as the fastest axis.
  std::array<size_t, 3> extents = {2, 3, 4};
  std::vector<std::uint16_t> by_row;
  for (int bin = 0; bin < 4; ++bin) {
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 2; ++row) {
        by_row.push_back(static_cast<std::uint16_t>(100 * row + 10 * column + bin));
      }
    }
  }
  write_mat("a.mat",
            Mat_VarCreate("histograms", MAT_C_UINT16, MAT_T_UINT16, 3, extents.data(), by_row.data(), 0));
  EXPECT_THAT(contents(path("a.mat")), ::testing::StartsWith("MATLAB 7.3"));
  EXPECT_TRUE(is_hdf5(path("a.mat")));
  const NpyArray cube = read_hdf5_array(path("a.mat"), "histograms");
  EXPECT_THAT(cube.shape, ElementsAre(2, 3, 4));
  EXPECT_EQ(cube.values[0], 0.0);
  EXPECT_EQ(cube.values[1], 1.0);
  EXPECT_EQ(cube.values[4], 10.0);
  EXPECT_EQ(cube.values[(1 * 3 + 2) * 4 + 3], 123.0);
}

TEST_F(Hdf5ArrayTest, MatlabsCellsAreRead) {
  std::array<size_t, 2> shape = {2, 3};
  matvar_t* const cells = Mat_VarCreate("photon_times", MAT_C_CELL, MAT_T_CELL, 2, shape.data(), nullptr, 0);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 2; ++row) {
      std::vector<double> times(static_cast<std::size_t>(row + 2 * column), 10.0 * row + column);
      std::array<size_t, 2> length = {times.empty() ? 0U : 1U, times.size()};
      Mat_VarSetCell(cells, row + 2 * column,
                     Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, length.data(), times.data(), 0));
    }
  }
  write_mat("a.mat", cells);
  EXPECT_TRUE(is_hdf5_cell_array(path("a.mat"), "photon_times"));
  EXPECT_FALSE(is_hdf5_cell_array(path("a.mat"), "others"));
  const Hdf5Cells read = read_hdf5_cells(path("a.mat"), "photon_times");
  EXPECT_THAT(read.shape, ElementsAre(2, 3));
  ASSERT_EQ(read.cells.size(), 6U);
  EXPECT_TRUE(read.cells[0].empty());
  EXPECT_THAT(read.cells[1], ElementsAre(1.0, 1.0));          // row 0, column 1
  EXPECT_THAT(read.cells[3], ElementsAre(10.0));              // row 1, column 0
  EXPECT_THAT(read.cells[4], ElementsAre(11.0, 11.0, 11.0));  // row 1, column 1
}

TEST_F(Hdf5ArrayTest, EachRefusalHasItsSentence) {
  add("/b", {2}, H5T_IEEE_F64LE, {1.0, 2.0});
  refused("c", "the file has no dataset 'c', but /b");
  add("/a/large", {1U << 14U, 1U << 14U}, H5T_STD_U8LE, {});
  refused("/a/large", "/a/large: shape (16384, 16384) holds more than 2^27 elements");
  refused("", "the file has 2 datasets (/a/large, /b); name one, as " + path("a.h5").string() + ":/a/large");
  add("/none", {0, 3}, H5T_STD_U8LE, {});
  refused("/none", "/none: the array is empty");
  add("/beyond", {1}, H5T_STD_U64LE, {0x1.0p60});
  refused("/beyond", "/beyond: an integer is beyond 2^53");
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, 8);
  add("/text", {1}, text, {});
  H5Tclose(text);
  refused("/text", "/text: the dataset holds no real numbers");
  const std::string whole = contents(path("a.h5"));
  (void)write("a.h5", whole.substr(0, whole.size() / 2));
  refused("/b", "the HDF5 file is damaged or ends early");
  test::expect_input_error([&] { (void)read_hdf5_cells(path("a.h5"), "b"); }, HasSubstr("a.h5: "));
}

TEST_F(Hdf5ArrayTest, PackedDataThatIsDamagedIsRefused) {
  std::vector<double> values(4096);
  std::iota(values.begin(), values.end(), 0.0);
  add("/a", {64, 64}, H5T_IEEE_F64LE, values, true);
  std::string file = contents(path("a.h5"));
  const std::size_t packed = file.find("\x78\x9c");  // where zlib's data begin
  ASSERT_NE(packed, std::string::npos);
  for (std::size_t i = packed; i < packed + 8; ++i) {
    file[i] = '\xff';
  }
  (void)write("a.h5", file);
  refused("/a", "/a: the dataset is damaged, or packed by a filter that is not here");
}

}  // namespace
}  // namespace dtof
