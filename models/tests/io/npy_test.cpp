// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/npy.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

template <typename T>
std::string bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
  std::string file = "\x93NUMPY";
  file += version;
  file += '\0';
  const auto length = static_cast<std::uint32_t>(dictionary.size());
  file.append(reinterpret_cast<const char*>(&length), version == 1 ? 2 : 4);
  return file + dictionary + data;
}

std::string header(const std::string& descr, const std::string& shape, bool fortran = false) {
  return "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") +
         ", 'shape': " + shape + ", }\n";
}

class NpyTest : public test::IoTest {
 protected:
  NpyArray read(const std::string& file) { return read_npy(write("a.npy", file)); }
  void refused(const std::string& file, const std::string& reason) {
    test::expect_input_error([&] { (void)read(file); }, path("a.npy").string() + ": " + reason);
  }
};

TEST_F(NpyTest, ReadsEveryDtype) {
  const auto check = [&](const std::string& descr, const std::string& data, double first, double second) {
    SCOPED_TRACE(descr);
    const NpyArray array = read(npy(header(descr, "(2,)"), data));
    EXPECT_THAT(array.shape, ElementsAre(2U));
    EXPECT_THAT(array.values, ElementsAre(DoubleEq(first), DoubleEq(second)));
  };
  check("|u1", bytes<std::uint8_t>({1, 255}), 1, 255);
  check("<u2", bytes<std::uint16_t>({1, 65535}), 1, 65535);
  check("<u4", bytes<std::uint32_t>({1, 4294967295}), 1, 4294967295);
  check("<i4", bytes<std::int32_t>({-1, 2147483647}), -1, 2147483647);
  check("<i8", bytes<std::int64_t>({-5, 1LL << 52}), -5, 4503599627370496.0);
  check("<f4", bytes<float>({-0.5F, 1e30F}), -0.5, double{1e30F});
  check("<f8", bytes<double>({-0.5, 1e300}), -0.5, 1e300);
  check("|i1", bytes<std::int8_t>({-128, 127}), -128, 127);
  check("<i2", bytes<std::int16_t>({-32768, 32767}), -32768, 32767);
  check("<u8", bytes<std::uint64_t>({1, 1ULL << 53U}), 1, 9007199254740992.0);
}

TEST_F(NpyTest, ReadsShapesOfPython2) {
  const std::string data = bytes<double>({1, 2, 3, 4, 5, 6});
  const NpyArray array = read(npy(header("<f8", "(2L, 3L)"), data));
  EXPECT_THAT(array.shape, ElementsAre(2U, 3U));
  EXPECT_THAT(array.values, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(read(npy(header("<f8", "(6L,)"), data)).shape, ElementsAre(6U));
  EXPECT_THAT(read(npy(header("<f8", "(2L, 3)"), data)).shape, ElementsAre(2U, 3U));
  refused(npy(header("<f8", "(99999999999999999999L,)"), data),
          "the NPY shape (99999999999999999999L,) is too large");
}

TEST_F(NpyTest, ReadsBothByteOrders) {
  const auto swapped = [](const auto& values) {
    std::string result = bytes(values);
    const std::size_t size = sizeof(values.front());
    for (std::size_t at = 0; at < result.size(); at += size) {
      std::reverse(result.begin() + static_cast<std::ptrdiff_t>(at),
                   result.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
    return result;
  };
  const auto check = [&](const std::string& descr, const std::string& data, double first, double second) {
    SCOPED_TRACE(descr);
    EXPECT_THAT(read(npy(header(descr, "(2,)"), data)).values,
                ElementsAre(DoubleEq(first), DoubleEq(second)));
  };
  check(">u1", bytes<std::uint8_t>({1, 200}), 1, 200);
  check(">i2", swapped(std::vector<std::int16_t>{-2, 258}), -2, 258);
  check(">u2", swapped(std::vector<std::uint16_t>{2, 40000}), 2, 40000);
  check(">i4", swapped(std::vector<std::int32_t>{-70000, 3}), -70000, 3);
  check(">u4", swapped(std::vector<std::uint32_t>{1, 4000000000U}), 1, 4e9);
  check(">i8", swapped(std::vector<std::int64_t>{-5, 1LL << 40}), -5, 1099511627776.0);
  check(">u8", swapped(std::vector<std::uint64_t>{5, 1ULL << 40U}), 5, 1099511627776.0);
  check(">f4", swapped(std::vector<float>{-0.5F, 3.25F}), -0.5, 3.25);
  check(">f8", swapped(std::vector<double>{-0.5, 1e300}), -0.5, 1e300);
  check(">f2", swapped(std::vector<std::uint16_t>{0x3C00, 0xC100}), 1.0, -2.5);
}

TEST_F(NpyTest, HalfPrecisionOfEveryKind) {
  // One, the largest, the smallest normal and subnormal number, minus zero, a third.
  const NpyArray array = read(
      npy(header("<f2", "(6,)"), bytes<std::uint16_t>({0x3C00, 0x7BFF, 0x0400, 0x0001, 0x8000, 0x3555})));
  EXPECT_THAT(array.values, ElementsAre(1.0, 65504.0, 0x1p-14, 0x1p-24, -0.0, 1365.0 / 4096.0));
  EXPECT_TRUE(std::signbit(array.values[4]));
  const NpyArray special = read(npy(header("<f2", "(3,)"), bytes<std::uint16_t>({0x7C00, 0xFC00, 0x7E00})));
  EXPECT_EQ(special.values[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(special.values[1], -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(special.values[2]));
}

TEST_F(NpyTest, IntegersBeyondADoubleAreRefusedWithTheirPlace) {
  refused(npy(header("<u8", "(2, 2)"), bytes<std::uint64_t>({1, 2, (1ULL << 53U) + 2, 3})),
          "element [1, 0]: the integer 9007199254740994 is beyond 2^53");
  refused(npy(header("<i8", "(2,)"), bytes<std::int64_t>({1, -(1LL << 60)})),
          "element [1]: the integer -1152921504606846976 is beyond 2^53");
  // In Fortran order the place is that of the array, not of the file.
  refused(npy(header("<u8", "(2, 3)", true), bytes<std::uint64_t>({0, 0, 0, 1ULL << 63U, 0, 0})),
          "element [1, 1]: the integer 9223372036854775808 is beyond 2^53");
  EXPECT_THAT(read(npy(header("<f8", "(1,)"), bytes<double>({1e30}))).values, ElementsAre(1e30));
}

TEST_F(NpyTest, ReadsFortranOrderVersion2AndScalars) {
  const NpyArray fortran =
      read(npy(header("<u2", "(2, 3)", true), bytes<std::uint16_t>({0, 10, 1, 11, 2, 12})));
  EXPECT_THAT(fortran.shape, ElementsAre(2U, 3U));
  EXPECT_THAT(fortran.values, ElementsAre(0, 1, 2, 10, 11, 12));
  EXPECT_THAT(read(npy(header("|u1", "(1, 2)"), bytes<std::uint8_t>({3, 4}), 2)).values, ElementsAre(3, 4));
  EXPECT_THAT(read(npy(header("|u1", "(1, 2)"), bytes<std::uint8_t>({5, 6}), 3)).values, ElementsAre(5, 6));
  const NpyArray scalar = read(npy(header("|u1", "()"), bytes<std::uint8_t>({3})));
  EXPECT_THAT(scalar.shape, IsEmpty());
  EXPECT_THAT(scalar.values, ElementsAre(3));
}

TEST_F(NpyTest, RoundTrip) {
  const std::vector<std::size_t> shape = {2, 1, 3};
  const std::vector<double> values = {0, 1, 2.5, -3, 1e-300, 5};
  write_npy(path("w.npy"), shape, values);
  EXPECT_EQ((contents(path("w.npy")).size() - values.size() * 8) % 64, 0U);
  const NpyArray back = read_npy(path("w.npy"));
  EXPECT_EQ(back.shape, shape);
  EXPECT_EQ(back.values, values);
  EXPECT_THROW(write_npy(path("x.npy"), shape, std::vector<double>(5)), std::logic_error);
}

TEST_F(NpyTest, Refusals) {
  const std::string two = bytes<double>({1, 2});
  refused("PK\x03\x04", "not an NPY file");
  refused("\x93NUMPY", "the NPY header ends early");
  refused(npy(header("<f8", "(2,)"), two, 4), "NPY format 4.0 is not 1.0, 2.0 or 3.0");
  refused(npy(header("<f8", "(2,)"), "").substr(0, 40), "the NPY header ends early");
  const std::string kinds = "is not one of i1, i2, i4, i8, u1, u2, u4, u8, f2, f4, f8, little- or big-endian";
  refused(npy(header("<c16", "(1,)"), two), "dtype '<c16' " + kinds);
  refused(npy(header("|f8", "(2,)"), two), "dtype '|f8' " + kinds);
  refused(npy("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (2,), }", two),
          "the NPY header has no readable 'descr'");
  refused(npy("{'descr': '<f8', 'shape': (2,), }", two), "the NPY header has no readable 'fortran_order'");
  refused(npy("{'descr': '<f8', 'fortran_order': Maybe, 'shape': (2,), }", two),
          "the NPY header has no readable 'fortran_order'");
  for (const char* shape : {"(-2,)", "(L,)", "(2LL,)", "(2l,)", "(2L3,)", "(2.0,)"}) {
    SCOPED_TRACE(shape);
    refused(npy(header("<f8", shape), two), "the NPY header has no readable 'shape'");
  }
  refused(npy(header("<f8", "(3,)"), two),
          "shape (3) of f8 needs more than the file's 2 elements: truncated");
  refused(npy(header("<f8", "(2,)"), two.substr(0, 15)),
          "shape (2) of f8 needs more than the file's 1 elements: truncated");
  refused(npy(header("<f8", "(1,)"), two), "shape (1) of f8 needs 8 bytes, the file has 16");
  refused(npy(header("<f8", "(4294967296, 4294967296)"), two),
          "shape (4294967296, 4294967296) of f8 needs more than the file's 2 elements: truncated");
  refused(npy(header("<f8", "(99999999999999999999,)"), two),
          "the NPY shape (99999999999999999999,) is too large");
  refused(npy(header("<f8", "(0, 3)"), ""), "the array is empty: shape (0, 3) has no element");
  refused(npy(header("<f8", "(4, 0)"), ""), "the array is empty: shape (4, 0) has no element");
  refused(npy(header("<f8", "(4294967296, 4294967296, 0)"), ""),
          "the array is empty: shape (4294967296, 4294967296, 0) has no element");
}

TEST_F(NpyTest, ReadsTheMeasuredImpulseResponse) {
  const auto file = test::shared_data("wisc2019_hydraharp_irf_8ps.npy");
  DTOF_SKIP_IF_ABSENT(file);
  const NpyArray array = read_npy(file);
  EXPECT_THAT(array.shape, ElementsAre(1250U));
  EXPECT_NEAR(*std::max_element(array.values.begin(), array.values.end()), 27.170, 0.001);
}

}  // namespace
}  // namespace dtof
