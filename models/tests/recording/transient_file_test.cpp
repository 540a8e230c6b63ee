// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/transient_file.hpp"

#include <hdf5.h>

#include <numeric>
#include <string>
#include <vector>

#include "dtof/container/npz.hpp"
#include "dtof/io/npy.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;

class TransientFileTest : public test::IoTest {
 protected:
  TransientFileTest() : values_(24) { std::iota(values_.begin(), values_.end(), 0.0); }

  void add(const char* name, const std::vector<hsize_t>& extents, const std::vector<double>& values) const {
    const bool exists = std::filesystem::exists(path("a.h5"));
    const hid_t file = exists ? H5Fopen(path("a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT)
                              : H5Fcreate(path("a.h5").c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = extents.empty()
                            ? H5Screate(H5S_SCALAR)
                            : H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t dataset = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, links, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
    H5Pclose(links);
    H5Sclose(space);
    H5Fclose(file);
  }
  void expect_cube(const TransientFile& file) const {
    EXPECT_THAT(file.array->shape(), ElementsAre(2U, 3U, 4U));
    EXPECT_EQ(read_whole("cube", *file.array).values, values_);
  }
  void refused(const std::string& name, const std::string& sentence) const {
    test::expect_input_error([&] { (void)read_transient_file(path(name).string()); },
                             path(name).string() + ": " + sentence);
  }

  std::vector<double> values_;
};

TEST_F(TransientFileTest, AnNpyHasNoTimeAxis) {
  write_npy(path("a.npy"), std::vector<std::size_t>{2, 3, 4}, values_);
  const TransientFile file = read_transient_file(path("a.npy").string());
  expect_cube(file);
  EXPECT_FALSE(file.bin_width_s.has_value());
  EXPECT_FALSE(file.start_s.has_value());
}

TEST_F(TransientFileTest, AnNpzMayHaveOne) {
  const std::vector<std::size_t> one = {1};
  {
    NpzWriter writer(path("a.npz"));
    writer.add("transient", std::vector<std::size_t>{2, 3, 4}, values_);
    writer.add("bin_width_s", one, std::vector<double>{2e-11});
    writer.add("start_s", one, std::vector<double>{-1e-9});
    writer.commit();
  }
  const TransientFile file = read_transient_file(path("a.npz").string());
  expect_cube(file);
  EXPECT_EQ(file.bin_width_s, 2e-11);
  EXPECT_EQ(file.start_s, -1e-9);
  // As `dtof convert` writes histograms.
  {
    NpzWriter writer(path("b.npz"));
    writer.add("histograms", std::vector<std::size_t>{2, 3, 4}, values_);
    writer.add("bin_width_ps", one, std::vector<double>{50.0});
    writer.commit();
  }
  EXPECT_DOUBLE_EQ(read_transient_file(path("b.npz").string()).bin_width_s.value_or(0.0), 5e-11);
}

TEST_F(TransientFileTest, AnHdf5MayHaveOneBesideTheCube) {
  add("/scene/cube", {2, 3, 4}, values_);
  add("/scene/bin_width_s", {}, {3e-11});
  add("/start_s", {1}, {1e-9});
  const TransientFile file = read_transient_file(path("a.h5").string());
  expect_cube(file);
  EXPECT_EQ(file.bin_width_s, 3e-11);
  EXPECT_FALSE(file.start_s.has_value());  // that of another group
  expect_cube(read_transient_file(path("a.h5").string() + ":scene/cube"));
}

TEST_F(TransientFileTest, RefusesWhatIsNotOneCube) {
  add("/a", {2, 3, 4}, values_);
  add("/b", {2, 3, 4}, values_);
  refused("a.h5", "the file has 2 arrays (/a, /b); name one, as " + path("a.h5").string() + ":/a");
  NpzWriter writer(path("a.npz"));
  writer.add("bin_width_s", std::vector<std::size_t>{1}, std::vector<double>{1e-11});
  writer.commit();
  refused("a.npz", "the file has no array of numbers that could be a transient cube");
  NpzWriter two(path("b.npz"));
  two.add("cube", std::vector<std::size_t>{2, 3, 4}, values_);
  two.add("bin_width_s", std::vector<std::size_t>{2}, std::vector<double>{1e-11, 1e-11});
  two.commit();
  refused("b.npz", "bin_width_s has 2 numbers instead of one");
  refused(write("a.png", "\x89PNG").filename().string(), "a transient cube is an NPY, NPZ or HDF5 file");
  refused("none.npy", "cannot read: No such file or directory");
}

}  // namespace
}  // namespace dtof
