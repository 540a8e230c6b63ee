// SPDX-License-Identifier: Apache-2.0
// Datasets of HDF5 that are read in pieces: what was written comes back, from every layout and at any place.
#include "dtof/container/hdf5_reader.hpp"

#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "dtof/container/asked_apart.hpp"
#include "dtof/container/hdf5_array.hpp"
#include "tests/container/hdf5_writer.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAreArray;
using ::testing::EndsWith;

const char* const kDamaged = "/a: the dataset is damaged, or packed by a filter that is not here";

/// Numbers that every type holds; the period is no extent of an array here.
std::vector<double> numbers(std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<double>(i % 113);
  }
  return values;
}

class Hdf5ReaderTest : public test::IoTest {
 protected:
  /// All elements, in pieces of lengths that differ, and at places where that is said to be possible.
  void expect_array(const std::string& file, const std::vector<hsize_t>& shape,
                    const std::vector<double>& values) const {
    const std::unique_ptr<ArrayReader> array = open_hdf5_array(path(file), "");
    ASSERT_THAT(array->shape(), ElementsAreArray(shape.begin(), shape.end()));
    std::mt19937_64 random(test::test_seed());
    std::vector<double> read(values.size());
    for (std::size_t done = 0; done < read.size();) {
      const std::size_t now = std::min<std::size_t>(read.size() - done, 1 + random() % (read.size() / 3 + 1));
      array->next(std::span(read).subspan(done, now));
      done += now;
    }
    ASSERT_TRUE(read == values) << file;
    ASSERT_TRUE(read_hdf5_array(path(file), "/a").values == values) << file;
    // Legal everywhere, though not always quick.
    for (int i = 0; i < 20; ++i) {
      const std::size_t first = random() % values.size();
      std::vector<double> piece(1 + random() % (values.size() - first));
      array->read_at(first, piece);
      ASSERT_TRUE(std::equal(piece.begin(), piece.end(), values.begin() + static_cast<std::ptrdiff_t>(first)))
          << file;
    }
  }
  [[nodiscard]] bool any_place(const std::vector<hsize_t>& shape, const test::Hdf5Layout& layout) const {
    test::write_hdf5(path("place.h5"), shape, {}, H5T_STD_U8LE, layout);
    return open_hdf5_array(path("place.h5"), "")->any_place();
  }
  void refused(const std::function<void()>& read, const std::string& sentence) const {
    test::expect_input_error(read, path("a.h5").string() + ": " + sentence);
  }
  /// Changes the first byte of these data.
  void spoil(const std::string& file, std::string_view of_data) const {
    std::string bytes = contents(path(file));
    const std::size_t at = bytes.find(of_data);
    ASSERT_NE(at, std::string::npos);
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    (void)write(file, bytes);
  }
};

/// This process has no child that runs.
void expect_no_child() {
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(Hdf5ReaderTest, WhatWasWrittenComesBackFromEveryTypeAndLayout) {
  const std::vector<hsize_t> shape = {5, 6, 7};
  const std::vector<double> values = numbers(5 * 6 * 7);
  for (const hid_t type : {H5T_STD_I8LE, H5T_STD_U8BE, H5T_STD_I16BE, H5T_STD_U16LE, H5T_STD_I32LE,
                           H5T_STD_U32BE, H5T_STD_I64LE, H5T_STD_U64LE, H5T_IEEE_F32BE, H5T_IEEE_F64LE}) {
    for (const bool matlab : {false, true}) {
      for (const test::Hdf5Layout& layout :
           {test::Hdf5Layout{.matlab = matlab},
            {.compact = true, .matlab = matlab},
            {.chunk = {2, 6, 3}, .matlab = matlab},
            {.chunk = {5, 1, 7}, .deflate = true, .matlab = matlab},
            {.chunk = {3, 4, 5}, .deflate = true, .shuffle = true, .fletcher32 = true, .matlab = matlab}}) {
        test::write_hdf5(path("a.h5"), shape, values, type, layout);
        expect_array("a.h5", shape, values);
      }
    }
  }
}

TEST_F(Hdf5ReaderTest, AnyNumberOfAxesComesBack) {
  for (const std::vector<hsize_t>& shape :
       std::vector<std::vector<hsize_t>>{{}, {1}, {97}, {13, 11}, {2, 3, 1, 5, 4}}) {
    const std::size_t count =
        std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
    for (const bool matlab : {false, true}) {
      test::write_hdf5(path("a.h5"), shape, numbers(count), H5T_IEEE_F64LE, {.matlab = matlab});
      expect_array("a.h5", shape, numbers(count));
      if (!shape.empty()) {
        test::write_hdf5(path("a.h5"), shape, numbers(count), H5T_IEEE_F64LE,
                         {.chunk = std::vector<hsize_t>(shape.size(), 1), .deflate = true, .matlab = matlab});
        expect_array("a.h5", shape, numbers(count));
      }
    }
  }
}

TEST_F(Hdf5ReaderTest, ArraysOfSeveralWindowsComeBack) {
  // A window is 2^22 elements: rows of one, of several with a rest, and an axis that is longer than a window.
  for (const auto& [shape, chunk] :
       {std::pair<std::vector<hsize_t>, std::vector<hsize_t>>{{3, 1500, 1100}, {2, 400, 300}},
        {{1500, 61, 103}, {64, 61, 50}},
        {{2, (1U << 22U) + 5}, {1, 1U << 20U}}}) {
    const std::vector<double> values =
        numbers(std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>()));
    for (const bool matlab : {false, true}) {
      for (const std::vector<hsize_t>& of_layout : {std::vector<hsize_t>(), chunk}) {
        test::write_hdf5(path("a.h5"), shape, values, H5T_STD_U8LE, {.chunk = of_layout, .matlab = matlab});
        const std::unique_ptr<ArrayReader> array = open_hdf5_array(path("a.h5"), "");
        ASSERT_TRUE(read_whole("a", *array).values == values);
        std::vector<double> piece(200'000);
        array->read_at(values.size() - piece.size(), piece);
        ASSERT_TRUE(std::equal(piece.rbegin(), piece.rend(), values.rbegin()));
      }
    }
  }
}

TEST_F(Hdf5ReaderTest, ChunksThatWereNeverWrittenHaveTheFillValue) {
  test::write_hdf5(path("a.h5"), {40, 50}, {}, H5T_STD_U16LE, {.chunk = {7, 9}, .deflate = true});
  expect_array("a.h5", {40, 50}, std::vector<double>(2000, 0.0));
}

TEST_F(Hdf5ReaderTest, APlaceIsReadWhereItCostsLittle) {
  const std::vector<hsize_t> cube = {160, 200, 1024};
  EXPECT_TRUE(any_place(cube, {}));
  EXPECT_FALSE(any_place(cube, {.matlab = true}));
  EXPECT_TRUE(any_place(cube, {.chunk = {8, 8, 64}, .deflate = true}));
  EXPECT_TRUE(any_place(cube, {.chunk = {8, 8, 64}, .deflate = true, .matlab = true}));
  EXPECT_FALSE(any_place(cube, {.chunk = {8, 8, 63}}));  // 17 chunks a pixel
  // Each column needs all of a cube of rows, 64 MiB and a little more.
  EXPECT_TRUE(any_place({256, 256, 1024}, {.chunk = {1, 256, 1024}}));
  EXPECT_FALSE(any_place({257, 256, 1024}, {.chunk = {1, 256, 1024}}));
}

TEST_F(Hdf5ReaderTest, SeveralThreadsReadAtTheSameTime) {
  const std::vector<double> values = numbers(std::size_t{64} * 64 * 16);
  test::write_hdf5(path("a.h5"), {64, 64, 16}, values, H5T_STD_U16LE, {.chunk = {8, 8, 16}, .deflate = true});
  const std::unique_ptr<ArrayReader> array = open_hdf5_array(path("a.h5"), "");
  std::vector<double> read(values.size());
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (std::size_t pixel = thread; pixel < 64 * 64; pixel += 4) {
        array->read_at(16 * pixel, std::span(read).subspan(16 * pixel, 16));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_TRUE(read == values);
}

TEST_F(Hdf5ReaderTest, TheOtherProcessEndsWithItsReader) {
  test::write_hdf5(path("a.h5"), {64, 64}, numbers(4096));
  std::unique_ptr<ArrayReader> older = open_hdf5_array(path("a.h5"), "/a");
  std::unique_ptr<ArrayReader> younger = open_hdf5_array(path("a.h5"), "a");
  double value = 0.0;
  older->next({&value, 1});
  older.reset();  // the younger process still has a copy of its socket
  younger->read_at(100, {&value, 1});
  EXPECT_EQ(value, 100.0);
  younger.reset();
  expect_no_child();
}

TEST_F(Hdf5ReaderTest, AProcessThatIsKilledIsARefusal) {
  test::write_hdf5(path("a.h5"), {3000, 3000}, numbers(9'000'000), H5T_STD_U8LE);
  const std::unique_ptr<ArrayReader> array = open_hdf5_array(path("a.h5"), "a");
  pid_t child = 0;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream(thread.path() / "children") >> child;
    if (child != 0) {
      break;
    }
  }
  if (child == 0) {
    GTEST_SKIP() << "this system does not say which children a process has";
  }
  ::kill(child, SIGKILL);
  const std::size_t files = file_count();
  const std::string sentence =
      path("a.h5").string() + ": a: damaged: the library that reads such files ended without an answer";
  test::expect_input_error([&] { write_npy(path("a.npy"), *array); }, sentence);
  double value = 0.0;
  test::expect_input_error([&] { array->read_at(0, {&value, 1}); }, sentence);
  EXPECT_EQ(file_count(), files);
}

TEST_F(Hdf5ReaderTest, AWrongChecksumIsARefusal) {
  std::vector<double> values(std::size_t{64} * 64);
  std::iota(values.begin(), values.end(), 0.0);
  values.back() = 0x1.23456789abcdep9;
  test::write_hdf5(path("a.h5"), {64, 64}, values, H5T_IEEE_F64LE, {.chunk = {16, 64}, .fletcher32 = true});
  expect_array("a.h5", {64, 64}, values);
  spoil("a.h5", {reinterpret_cast<const char*>(&values.back()), sizeof(double)});
  const std::unique_ptr<ArrayReader> array = open_hdf5_array(path("a.h5"), "");
  std::vector<double> read(values.size());
  refused([&] { array->next(read); }, kDamaged);
  refused([&] { array->read_at(4095, std::span(read).first(1)); }, kDamaged);
  array->read_at(70, std::span(read).first(3));  // in another chunk
  EXPECT_EQ(read[2], 72.0);
}

TEST_F(Hdf5ReaderTest, AFileThatShrinksIsARefusal) {
  test::write_hdf5(path("a.h5"), {3000, 3000}, numbers(9'000'000), H5T_STD_U8LE);
  const std::unique_ptr<ArrayReader> array = open_hdf5_array(path("a.h5"), "");
  std::filesystem::resize_file(path("a.h5"), 5'000'000);
  refused([&] { write_npy(path("a.npy"), *array); }, "the HDF5 file is damaged or ends early");
  EXPECT_EQ(file_count(), 1U);
  test::expect_input_error([&] { (void)open_hdf5_array(path("a.h5"), ""); },
                           EndsWith(": the HDF5 file is damaged or ends early"));
}

TEST_F(Hdf5ReaderTest, AnIntegerBeyondDoubleIsARefusalWhereItIsRead) {
  std::vector<double> values(4);
  values[3] = 0x1.0p60;
  test::write_hdf5(path("a.h5"), {2, 2}, values, H5T_STD_I64LE);
  const std::unique_ptr<ArrayReader> array = open_hdf5_array(path("a.h5"), "");
  refused([&] { array->read_at(3, std::span(values).first(1)); }, "/a: an integer is beyond 2^53");
  array->read_at(0, std::span(values).first(3));
  test::write_hdf5(path("b.h5"), {2, 2}, {1.0, 2.0, 3.0, 0x1.0p60}, H5T_IEEE_F64LE);
  expect_array("b.h5", {2, 2}, {1.0, 2.0, 3.0, 0x1.0p60});
}

TEST_F(Hdf5ReaderTest, WhatCannotBeReadIsRefusedWhenItIsOpened) {
  const auto open = [&] { (void)open_hdf5_array(path("a.h5"), ""); };
  const hsize_t many = hsize_t{1} << 30U;
  test::write_hdf5(path("a.h5"), {many, many}, {}, H5T_STD_U8LE, {.chunk = {1024, 1024}});
  refused(open, "/a: shape (1073741824, 1073741824) holds more than 2^59 elements");
  test::write_hdf5(path("a.h5"), {many, 4}, {}, H5T_STD_U8LE, {.chunk = {many / 2, 3}, .deflate = true});
  refused(open, "/a: the dataset has packed chunks above 1 GiB");
  test::write_hdf5(path("a.h5"), {many, 4}, {}, H5T_STD_U8LE, {.chunk = {many / 2, 2}, .deflate = true});
  open();
  test::write_hdf5(path("a.h5"), {3, 0}, {}, H5T_STD_U8LE);
  refused(open, "/a: the array is empty");
  test::write_hdf5(path("a.h5"), {4}, {}, H5T_STD_U8LE, {.external = "/etc/hostname"});
  refused(open, "/a: the dataset's numbers are in other files, which are not read");
  expect_no_child();
}

TEST(AskedApart, ACrashOrARefusalOfAnAnswerIsOne) {
  AskedApart apart("a", 4, [] {
    return AskedApart::Opened{
        .said = {.sizes = {7}, .names = {"name"}},
        .answer = [](const ReadRequest& request, std::span<double> room) -> std::size_t {
          if (request.first == 1) {
            throw InputError("a: its own");
          }
          if (request.first == 2) {
            std::raise(SIGSEGV);
          }
          room[1] = 5.0;
          return 2;
        }};
  });
  EXPECT_THAT(apart.opened().sizes, ::testing::ElementsAre(7));
  test::expect_input_error([&] { (void)apart.ask("b", {.first = 1}); }, "a: its own");
  EXPECT_EQ(apart.ask("b", {}), 2U);
  EXPECT_EQ(apart.room()[1], 5.0);
  for (int i = 0; i < 2; ++i) {
    test::expect_input_error([&] { (void)apart.ask("b", {.first = 2}); },
                             "b: damaged: the library that reads such files ended without an answer");
  }
  test::expect_input_error(
      [] {
        const AskedApart none("a", 4, []() -> AskedApart::Opened { throw InputError("a: cannot open"); });
      },
      "a: cannot open");
}

}  // namespace
}  // namespace dtof
