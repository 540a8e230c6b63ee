// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/npy_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dtof/io/array_reader.hpp"
#include "dtof/io/npy.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;

class NpyReaderTest : public test::IoTest {
 protected:
  [[nodiscard]] static std::string header_of(const std::string& descr, const std::string& shape,
                                             bool fortran) {
    const std::string text = "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") +
                             ", 'shape': " + shape + ", }\n";
    return "\x93NUMPY" + std::string("\x01\x00", 2) + static_cast<char>(text.size()) + '\0' + text;
  }
  /// The reader's refusal is that of read_npy, which holds the file.
  void refused_alike(const std::string& file) const {
    const std::filesystem::path name = write("a.npy", file);
    std::string sentence = "none";
    try {
      (void)read_npy(name);
    } catch (const InputError& error) {
      sentence = error.what();
    }
    test::expect_input_error([&] { (void)read_whole(name, *open_npy(name)); }, sentence);
  }
};

TEST_F(NpyReaderTest, PiecesAndPlacesAreThoseOfTheHeldArray) {
  for (const std::string descr : {"|i1", "|u1", "<i2", ">i2", "<u2", ">u2", "<i4", ">i4", "<u4", ">u4", "<f2",
                                  ">f2", "<f4", ">f4", "<f8", ">f8"}) {
    for (const bool fortran : {false, true}) {
      SCOPED_TRACE(descr + (fortran ? " Fortran" : " C"));
      // Bytes from 0 to 59 are finite numbers of every type.
      std::string elements(60 * static_cast<std::size_t>(descr[2] - '0'), '\0');
      for (std::size_t i = 0; i < elements.size(); ++i) {
        elements[i] = static_cast<char>(i % 60);
      }
      const std::filesystem::path file = write("a.npy", header_of(descr, "(3, 4, 5)", fortran) + elements);
      const NpyArray held = read_npy(file);
      const std::unique_ptr<ArrayReader> array = open_npy(file);
      EXPECT_EQ(array->shape(), held.shape);
      EXPECT_EQ(array->count(), 60U);
      std::vector<double> values(60);
      array->next(std::span(values).first(1));
      array->next(std::span(values).subspan(1, 20));
      array->next(std::span(values).subspan(21));
      EXPECT_EQ(values, held.values);
      ASSERT_EQ(array->any_place(), !fortran);
      if (array->any_place()) {
        std::vector<double> some(5);
        array->read_at(25, some);
        EXPECT_EQ(some, std::vector<double>(held.values.begin() + 25, held.values.begin() + 30));
      }
    }
  }
}

TEST_F(NpyReaderTest, LongPiecesAreThoseOfTheHeldArray) {
  std::vector<double> values(200001);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(i);
  }
  write_npy(path("a.npy"), std::vector<std::size_t>{3, 66667}, values);
  EXPECT_EQ(read_whole("a", *open_npy(path("a.npy"))).values, values);
  write_npy(path("b.npy"), *open_npy(path("a.npy")));
  EXPECT_EQ(contents(path("b.npy")), contents(path("a.npy")));
  std::vector<double> most(200000);
  open_npy(path("a.npy"))->read_at(1, most);
  EXPECT_EQ(most, std::vector<double>(values.begin() + 1, values.end()));
}

TEST_F(NpyReaderTest, FortranOrderOfOneAxisIsCOrder) {
  const std::filesystem::path file = write("a.npy", header_of("|u1", "(1, 3, 1)", true) + "\1\2\3");
  EXPECT_TRUE(open_npy(file)->any_place());
  EXPECT_THAT(read_whole(file, *open_npy(file)).values, ElementsAre(1, 2, 3));
}

TEST_F(NpyReaderTest, ALongArrayInFortranOrderIsRefused) {
  const std::filesystem::path file = write("a.npy", header_of("|u1", "(2, 67108865)", true));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) + 134217730);  // a hole
  double value = 0.0;
  test::expect_input_error(
      [&] {
        open_npy(file)->next({&value, 1});
      },
      file.string() +
          ": shape (2, 67108865) in Fortran order holds more than 2^27 elements; "
          "numpy.ascontiguousarray makes C order of it, which has no limit");
}

TEST_F(NpyReaderTest, RefusalsAreThoseOfAHeldFile) {
  const std::string good = header_of("<u8", "(2, 2)", false) + std::string(32, '\0');
  for (const std::size_t size : {6U, 9U, 10U, 11U, 12U, 40U, 90U}) {
    refused_alike(good.substr(0, size));
  }
  refused_alike("no NPY file");
  refused_alike("\x93NUMPY" + std::string("\1\0\0\0", 4) + std::string(32, '\0'));
  refused_alike("\x93NUMPY" + std::string("\1\0\1\0", 4) + std::string(32, '\0'));
  refused_alike(good + "behind");
  refused_alike(header_of("<c8", "(2, 2)", false) + std::string(32, '\0'));
  refused_alike(header_of("<u8", "(0, 2)", false));
  refused_alike(header_of("<u8", "(2, 9999999999999999999)", false) + std::string(32, '\0'));
  for (const bool fortran : {false, true}) {
    refused_alike(header_of("<u8", "(2, 2)", fortran) + std::string(8, '\0') + std::string(8, '\x7f') +
                  std::string(16, '\0'));
  }
  std::string long_header = good;
  long_header[6] = 2;
  refused_alike(long_header);
  test::expect_input_error([&] { (void)open_npy(path("none.npy")); },
                           path("none.npy").string() + ": cannot read: No such file or directory");
}

TEST_F(NpyReaderTest, AFileThatShrinksIsRefused) {
  write_npy(path("a.npy"), std::vector<std::size_t>{100000}, std::vector<double>(100000, 1.0));
  const std::unique_ptr<ArrayReader> array = open_npy(path("a.npy"));
  std::filesystem::resize_file(path("a.npy"), 700000);
  test::expect_input_error([&] { (void)read_whole("a", *array); },
                           path("a.npy").string() + ": the file ends early");
}

}  // namespace
}  // namespace dtof
