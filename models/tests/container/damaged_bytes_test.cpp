// SPDX-License-Identifier: Apache-2.0
// Bytes anywhere in a file may be wrong: the readers refuse the file or read it, and never end the program.
#include <hdf5.h>

#include <chrono>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "dtof/container/hdf5_array.hpp"
#include "dtof/container/npz.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

class DamagedBytesTest : public test::IoTest {
 protected:
  /// Reads 150 versions of the file, each with up to four wrong bytes; returns how many were refused. An
  /// extent that is wrong may still be legal: 2^27 elements take seconds.
  template <typename Read>
  int refusals(const std::string& good, const Read& read) const {
    std::mt19937_64 random(test::test_seed());
    int refused = 0;
    for (int i = 0; i < 150; ++i) {
      std::string file = good;
      for (std::uint64_t wrong = 1 + random() % 4; wrong > 0; --wrong) {
        file[random() % file.size()] = static_cast<char>(random());
      }
      const auto start = std::chrono::steady_clock::now();
      try {
        read(file);
      } catch (const InputError&) {
        ++refused;
      }
      EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
    }
    return refused;
  }
};

TEST_F(DamagedBytesTest, OfAnArchive) {
  {
    NpzWriter writer(path("a.npz"));
    std::vector<double> values(64);
    std::iota(values.begin(), values.end(), 0.0);
    writer.add("a", std::vector<std::size_t>{8, 8}, values);
    writer.add("b", std::vector<std::size_t>{64}, values);
    writer.commit();
  }
  const int refused =
      refusals(contents(path("a.npz")), [](const std::string& file) { (void)parse_npz("a", file, "b"); });
  EXPECT_GT(refused, 30);
}

TEST_F(DamagedBytesTest, OfAnHdf5File) {
  const hid_t file = H5Fcreate(path("a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const std::vector<hsize_t> extents = {16, 16};
  std::vector<double> values(256);
  std::iota(values.begin(), values.end(), 0.0);
  const hid_t space = H5Screate_simple(2, extents.data(), nullptr);
  for (const char* const name : {"plain", "packed"}) {
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    if (std::string(name) == "packed") {
      const std::vector<hsize_t> chunk = {8, 8};
      H5Pset_chunk(layout, 2, chunk.data());
      H5Pset_deflate(layout, 6);
    }
    const hid_t dataset = H5Dcreate2(file, name, H5T_STD_U16LE, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
    H5Pclose(layout);
  }
  H5Sclose(space);
  H5Fclose(file);
  const int refused = refusals(contents(path("a.h5")), [&](const std::string& damaged) {
    const std::filesystem::path copy = write("b.h5", damaged);
    (void)hdf5_names(copy);
    (void)read_hdf5_array(copy, "plain");
    (void)read_hdf5_array(copy, "packed");
  });
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace dtof
