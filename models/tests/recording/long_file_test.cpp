// SPDX-License-Identifier: Apache-2.0
// Files and arrays beyond 4 GiB: what is read in pieces or where it lies is read to its end, what is held is
// refused before it is held. The files have holes, so that they take no space on the disk.
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dtof/container/hdf5_array.hpp"
#include "dtof/container/hdf5_reader.hpp"
#include "dtof/container/npz.hpp"
#include "dtof/io/array_reader.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/recording/line_reader.hpp"
#include "dtof/recording/picoquant.hpp"
#include "dtof/recording/recorded_array.hpp"
#include "dtof/recording/recording.hpp"
#include "tests/container/zip_writer.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;

constexpr std::uint64_t kFourGiB = std::uint64_t{1} << 32U;

using test::bytes_of;

/// Rows of 8 histograms of 1024 numbers of 64 bits: 64 KiB each, beyond 4 GiB together.
constexpr std::uint64_t kLongRows = (std::uint64_t{1} << 16U) + 3;
constexpr std::uint64_t kLongBytes = kLongRows << 16U;

/// True in the long lane (docs/reference/testplan.md).
bool is_long_lane() { return std::getenv("DTOF_TEST_LONG") != nullptr; }

constexpr const char* kLongLane = "reads each of 4 GiB, in .ci/long alone";

std::string long_header() { return test::npy_begin("<f8", fmt::format("({}, 8, 1024)", kLongRows)); }

/// While it lives, this process gets no more than 512 MiB beyond the addresses that it has; a sanitizer needs
/// more.
class AddressLimit {
 public:
  AddressLimit() {
    ::getrlimit(RLIMIT_AS, &before_);
    rlimit now = before_;
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    now.rlim_cur = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + (std::uint64_t{1} << 29U);
    if (pages != 0 && now.rlim_cur < std::uint64_t{1} << 40U) {
      ::setrlimit(RLIMIT_AS, &now);
    }
  }
  AddressLimit(const AddressLimit&) = delete;
  AddressLimit& operator=(const AddressLimit&) = delete;
  AddressLimit(AddressLimit&&) = delete;
  AddressLimit& operator=(AddressLimit&&) = delete;
  ~AddressLimit() { ::setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_{};
};

std::string tag(std::string name, std::uint32_t type, std::uint64_t bits) {
  name.resize(32, '\0');
  return name + bytes_of(std::uint32_t{0xFFFFFFFF}) + bytes_of(type) + bytes_of(bits);
}

/// A HydraHarp's PTU header of mode T3 with a unit of 16 ps. A record of zeros is a photon of channel 0 at
/// time 0.
std::string ptu_header(std::uint64_t records) {
  constexpr std::uint32_t kInteger = 0x10000008;
  constexpr std::uint32_t kDouble = 0x20000008;
  return std::string("PQTTTR\0\0", 8) + std::string("1.0.00\0\0", 8) +
         tag("TTResultFormat_TTTRRecType", kInteger, 0x01010304) +
         tag("MeasDesc_Resolution", kDouble, std::bit_cast<std::uint64_t>(16e-12)) +
         tag("TTResult_NumberOfRecords", kInteger, records) + tag("Header_End", 0xFFFF0008, 0);
}

/// A HydraHarp's HT3 header of version 2.0, without inputs.
std::string ht3_header(std::int64_t records) {
  std::string header(0x2b8 + 24, '\0');
  const auto put = [&](std::size_t place, std::string_view bytes) {
    header.replace(place, bytes.size(), bytes);
  };
  put(0, "HydraHarp");
  put(16, "2.0");
  put(0x14c, bytes_of(std::int32_t{32}));
  put(0x154, bytes_of(std::int32_t{3}));
  put(0x160, bytes_of(16.0));
  put(0x2b8 + 16, bytes_of(records));
  return header;
}

constexpr std::uint32_t photon_t3(std::uint32_t channel, std::uint32_t time) {
  return channel << 25U | time << 10U;
}

/// The tests' files lie in the working directory, which CTest sets to the build folder: /tmp may be memory.
class LongFileTest : public ::testing::Test {
 public:
  LongFileTest(const LongFileTest&) = delete;
  LongFileTest& operator=(const LongFileTest&) = delete;
  LongFileTest(LongFileTest&&) = delete;
  LongFileTest& operator=(LongFileTest&&) = delete;

 protected:
  LongFileTest() {
    std::string name = (std::filesystem::current_path() / "dtof_long_XXXXXX").string();
    if (const char* const made = ::mkdtemp(name.data()); made != nullptr) {
      directory_ = made;
    }
  }
  ~LongFileTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }
  void SetUp() override {
    if (directory_.empty()) {
      GTEST_SKIP() << "the working directory cannot be written";
    }
    write_with_hole("probe", "begin", kFourGiB, "end");
    if (!is_sparse("probe")) {
      GTEST_SKIP() << "the file system has no files with holes";
    }
  }

  [[nodiscard]] std::string path(std::string_view name) const { return directory_ / name; }

  /// `begin`, zeros up to the byte `end_at`, and `end`.
  void write_with_hole(std::string_view name, std::string_view begin, std::uint64_t end_at,
                       std::string_view end) const {
    std::ofstream file(path(name), std::ios::binary);
    file << begin;
    file.seekp(static_cast<std::streamoff>(end_at));
    file << end;
  }

  [[nodiscard]] bool is_sparse(std::string_view name) const {
    struct stat status {};
    constexpr std::int64_t kBlock = 512;
    constexpr std::int64_t kMost = std::int64_t{1} << 24U;
    return ::stat(path(name).c_str(), &status) == 0 &&
           static_cast<std::uint64_t>(status.st_size) > kFourGiB && status.st_blocks * kBlock < kMost;
  }

  /// `header`, records of zeros beyond 4 GiB, and a photon of channel 1 at time 7 as the last record.
  void expect_read_to_its_end(std::string_view name, const std::string& header, std::uint64_t records) const {
    write_with_hole(name, header, header.size() + (records - 1) * 4, bytes_of(photon_t3(1, 7)));
    ASSERT_TRUE(is_sparse(name));
    const RecordingOptions options{.file = path(name)};
    const RecordingFile file = read_recording(options);
    EXPECT_EQ(file.format, "picoquant");
    EXPECT_TRUE(file.contents.empty());
    std::string description;
    const HistogramCube cube = picoquant_cube(path(name), description);
    EXPECT_EQ(description, fmt::format("PicoQuant, T3, {} photons", records));
    EXPECT_EQ(cube.columns, 2);
    EXPECT_EQ(cube.bins, 8);
    EXPECT_EQ(cube.counts.front(), static_cast<double>(records - 1));
    EXPECT_EQ(cube.counts.back(), 1.0);
  }

  /// Histograms that are empty but for three photons in the last bin of the last pixel.
  void expect_photons_at_the_end(std::string_view name) const {
    const std::uint64_t before = held();
    const RecordingOptions options{.file = path(name), .bin_width_s = 1e-11};
    RecordingFile file = read_recording(options);
    EXPECT_TRUE(file.contents.empty());
    const Recording recording = open_recording(options, std::move(file));
    const StreamSource& source = *recording.source;
    ASSERT_EQ(source.columns(), 8);
    ASSERT_EQ(source.rows(), static_cast<int>(kLongRows));
    const auto row = static_cast<int>(kLongRows - 1);
    EXPECT_EQ(source.column_rows(7, {row, 1}).row(0).size(), 3U);
    EXPECT_EQ(source.column_rows(6, {row, 1}).row(0).size(), 0U);
    EXPECT_EQ(source.column_rows(7, {row - 65536, 1}).row(0).size(), 0U);  // 4 GiB before
    EXPECT_LT(held() - before, std::uint64_t{1} << 26U);
  }

  /// The most memory that this process has held so far, bytes.
  static std::uint64_t held() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  }

 private:
  std::filesystem::path directory_;
};

TEST_F(LongFileTest, TimeTagsBeyond4GiBAreCounted) {
  if (!is_long_lane()) {
    GTEST_SKIP() << kLongLane;
  }
  constexpr std::uint64_t kRecords = kFourGiB / 4 + 1000;
  const std::uint64_t before = held();
  expect_read_to_its_end("a.ptu", ptu_header(kRecords), kRecords);
  EXPECT_LT(held() - before, std::uint64_t{1} << 26U);
}

TEST_F(LongFileTest, AnHt3HeaderMayNameMoreRecordsThan32BitsHold) {
  constexpr std::int64_t kNamed = (std::int64_t{1} << 32U) + 5;
  write_with_hole("a.ht3", ht3_header(kNamed), ht3_header(kNamed).size(), bytes_of(photon_t3(1, 7)));
  std::string description;
  (void)picoquant_cube(path("a.ht3"), description);
  EXPECT_EQ(
      description,
      "PicoQuant, T3, 1 photons, 4294967300 of the 4294967301 records that the header names are missing");
}

TEST_F(LongFileTest, WhatIsHeldIsRefusedBeyond4GiBBeforeItIsHeld) {
  const std::uint64_t before = held();
  write_with_hole("a.mat", "MATLAB 5.0 MAT-file", kFourGiB, "end");
  const RecordingOptions options{.file = path("a.mat")};
  test::expect_input_error([&] { (void)read_recording(options); },
                           path("a.mat") + ": more than 4096 MiB to read");
  EXPECT_LT(held() - before, std::uint64_t{1} << 26U);
}

TEST_F(LongFileTest, AStreamIsReadLineByLine) {
  const std::uint64_t before = held();
  write_with_hole("a.csv", "acquisition,column,row,timestamp\n5,1,2,7\n", kFourGiB, "end");
  const RecordingOptions options{.file = path("a.csv")};
  const RecordingFile file = read_recording(options);
  EXPECT_EQ(file.format, "csv");
  test::expect_input_error([&] { (void)open_recorded_data(options, file); },
                           path("a.csv") + ":3: the line is longer than 1048576 bytes");
  EXPECT_LT(held() - before, std::uint64_t{1} << 26U);
}

TEST_F(LongFileTest, AnNpyBeyond4GiBStaysInItsFile) {
  const AddressLimit limit;
  write_with_hole("a.npy", long_header(), long_header().size() + kLongBytes - 8, bytes_of(3.0));
  ASSERT_TRUE(is_sparse("a.npy"));
  expect_photons_at_the_end("a.npy");
  // The same photons where the array is that file's last row alone.
  std::ofstream(path("row.npy"), std::ios::binary)
      << test::npy_begin("<f8", "(1, 8, 1024)") << std::string(8 * 1024 * 8 - 8, '\0') << bytes_of(3.0);
  const RecordingOptions options{.file = path("row.npy"), .bin_width_s = 1e-11};
  EXPECT_EQ(open_recording(options, read_recording(options)).source->column(7).row(0).size(), 3U);
}

TEST_F(LongFileTest, AStoredArrayBeyond4GiBStaysInItsArchive) {
  const AddressLimit limit;
  const std::string width = test::npy_begin("<f8", "()") + bytes_of(10.0);
  // The second member lies behind 4 GiB; the checksum of the first is checked over all of it.
  test::write_zip(path("a.npz"),
                  {test::stored_part("histograms.npy", long_header(), kLongBytes - 8, bytes_of(3.0)),
                   test::stored_part("bin_width_ps.npy", width)},
                  true);
  ASSERT_TRUE(is_sparse("a.npz"));
  const RecordingOptions options{.file = path("a.npz")};
  EXPECT_EQ(bin_width_of(options, read_recording(options)), 10.0 * 1e-12);
  expect_photons_at_the_end("a.npz");
}

TEST_F(LongFileTest, ADeflatedArrayBeyondMemoryIsReadForwardAlone) {
  constexpr std::size_t kElements = (std::size_t{1} << 27U) + 1024;
  {
    std::string contents = test::npy_begin("|u1", fmt::format("({}, 1, 1024)", kElements / 1024));
    contents.resize(contents.size() + kElements, '\0');
    contents.back() = '\7';
    test::write_zip(path("a.npz"), {test::deflated_part("a.npy", contents)}, false);
  }
  const AddressLimit limit;
  const std::unique_ptr<ArrayReader> array = NpzArchive(path("a.npz")).open("a");
  std::size_t count = 0;
  double last = 0.0;
  for_each_piece(*array, [&](std::span<const double> values) {
    count += values.size();
    last = values.back();
  });
  EXPECT_EQ(count, kElements);
  EXPECT_EQ(last, 7.0);
  const RecordingOptions options{.file = path("a.npz"), .bin_width_s = 1e-11};
  test::expect_input_error(
      [&] { (void)open_recording(options, read_recording(options)); },
      path("a.npz") +
          ": more than 2^27 counts that are deflated or in Fortran order; in C order, in an NPY file or "
          "stored in an NPZ archive, they have no limit (dtof convert writes deflated ones as NPY)");
}

// Text with holes is no text: the lines are those of gzip members that repeat.
TEST_F(LongFileTest, LinesBeyond4GiBAreReadAndCounted) {
  if (!is_long_lane()) {
    GTEST_SKIP() << kLongLane;
  }
  constexpr std::size_t kLine = std::size_t{1} << 16U;
  constexpr std::size_t kLinesOfMember = 1024;
  constexpr std::size_t kMembers = kFourGiB / (kLine * kLinesOfMember);
  std::string member;
  for (std::size_t line = 0; line < kLinesOfMember; ++line) {
    member.append(kLine - 1, 'x') += '\n';
  }
  write_gzip_file(path("member"), member);
  {
    std::ifstream packed(path("member"), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(packed), {}};
    std::ofstream file(path("a.gz"), std::ios::binary);
    for (std::size_t i = 0; i < kMembers; ++i) {
      file << bytes;
    }
  }
  write_gzip_file(path("member"), "the last line");
  {
    std::ifstream packed(path("member"), std::ios::binary);
    std::ofstream(path("a.gz"), std::ios::binary | std::ios::app) << packed.rdbuf();
  }
  member.clear();
  member.shrink_to_fit();
  const std::uint64_t before = held();
  LineReader reader(path("a.gz"));
  std::size_t bytes = 0;
  std::string last;
  for (std::string_view line; reader.next(line);) {
    bytes += line.size() + 1;
    last = line.size() < kLine - 1 ? line : "";
  }
  EXPECT_EQ(bytes, kFourGiB + 14);
  EXPECT_EQ(last, "the last line");
  test::expect_input_error([&] { reader.fail("."); },
                           EndsWith(fmt::format("a.gz:{}: .", kMembers * kLinesOfMember + 1)));
  EXPECT_LT(held() - before, std::uint64_t{1} << 26U);
}

/// Adds a dataset; `write` may write into it.
void add_dataset(hid_t file, const char* name, const std::vector<hsize_t>& extents, hid_t layout,
                 const std::function<void(hid_t)>& write) {
  const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
  const hid_t dataset = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  write(dataset);
  H5Dclose(dataset);
  H5Sclose(space);
}

/// Writes 3 into the last bin of the last pixel.
void write_last_bin(hid_t dataset) {
  const std::array<hsize_t, 3> begin = {kLongRows - 1, 7, 1023};
  const std::array<hsize_t, 3> one = {1, 1, 1};
  const hid_t space = H5Dget_space(dataset);
  const hid_t memory = H5Screate_simple(3, one.data(), nullptr);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, begin.data(), nullptr, one.data(), nullptr);
  const double photons = 3.0;
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &photons);
  H5Sclose(memory);
  H5Sclose(space);
}

TEST_F(LongFileTest, AnHdf5ArrayBeyond4GiBStaysInItsFile) {
  if (!is_long_lane()) {
    GTEST_SKIP() << kLongLane;
  }
  const hid_t file = H5Fcreate(path("a.h5").c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_alloc_time(layout, H5D_ALLOC_TIME_EARLY);  // the place is taken, and nothing is written into it
  H5Pset_fill_time(layout, H5D_FILL_TIME_NEVER);
  add_dataset(file, "long", {kLongRows, 8, 1024}, layout, write_last_bin);
  add_dataset(file, "behind", {3}, layout, [](hid_t dataset) {
    const std::array<double, 3> values = {1.0, 2.0, 3.0};
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  });
  H5Pclose(layout);
  H5Fclose(file);
  ASSERT_TRUE(is_sparse("a.h5"));
  const AddressLimit limit;
  EXPECT_THAT(read_hdf5_array(path("a.h5"), "/behind").values, ElementsAre(1.0, 2.0, 3.0));
  test::expect_input_error([&] { (void)read_hdf5_array(path("a.h5"), "/long"); },
                           EndsWith("/long: shape (65539, 8, 1024) holds more than 2^27 elements"));
  expect_photons_at_the_end("a.h5:/long");
}

TEST_F(LongFileTest, APackedHdf5ArrayBeyond4GiBIsReadToItsEnd) {
  const hid_t file = H5Fcreate(path("a.h5").c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  const std::array<hsize_t, 3> chunk = {100, 8, 512};  // of which the last one alone is in the file
  H5Pset_chunk(layout, 3, chunk.data());
  H5Pset_deflate(layout, 1);
  H5Pset_fletcher32(layout);
  add_dataset(file, "long", {kLongRows, 8, 1024}, layout, write_last_bin);
  H5Pclose(layout);
  H5Fclose(file);
  EXPECT_LT(std::filesystem::file_size(path("a.h5")), std::uint64_t{1} << 24U);
  const AddressLimit limit;
  const std::uint64_t before = held();
  const std::unique_ptr<ArrayReader> array = open_hdf5_array(path("a.h5"), "");
  EXPECT_FALSE(array->any_place());  // a column is in all chunks
  double sum = 0.0;
  double last = 0.0;
  std::size_t count = 0;
  for_each_piece(*array, [&](std::span<const double> values) {
    sum = std::accumulate(values.begin(), values.end(), sum);
    last = values.back();
    count += values.size();
  });
  EXPECT_EQ(count, kLongBytes / 8);
  EXPECT_EQ(sum, 3.0);
  EXPECT_EQ(last, 3.0);
  std::array<double, 2> place{};
  array->read_at(count - 2, place);
  EXPECT_THAT(place, ElementsAre(0.0, 3.0));
  EXPECT_LT(held() - before, std::uint64_t{1} << 26U);
  const RecordingOptions options{.file = path("a.h5"), .bin_width_s = 1e-11};
  test::expect_input_error(
      [&] { (void)open_recording(options, read_recording(options)); },
      path("a.h5") +
          ": more than 2^27 counts, and those of a pixel or of a column of pixels lie far "
          "apart in the file; in an NPY file, which dtof convert writes, they have no limit");
}

}  // namespace
}  // namespace dtof
