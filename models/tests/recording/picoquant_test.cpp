// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/picoquant.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "dtof/io/atomic_file.hpp"
#include "dtof/recording/recording.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;

constexpr std::uint32_t kInteger = 0x10000008;
constexpr std::uint32_t kDouble = 0x20000008;
constexpr std::uint32_t kText = 0x4001FFFF;
constexpr std::uint32_t kEmpty = 0xFFFF0008;
constexpr std::uint32_t kHydraT2 = 0x01010204;
constexpr std::uint32_t kHydraT3 = 0x01010304;
constexpr std::uint32_t kPicoT2 = 0x00010203;
constexpr std::uint32_t kPicoT3 = 0x00010303;

template <typename T>
std::string bytes_of(T number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

std::string tag(const std::string& name, std::uint32_t type, std::uint64_t bits,
                const std::string& text = "") {
  std::string padded = name;
  padded.resize(32, '\0');
  return padded + bytes_of(std::uint32_t{0xFFFFFFFF}) + bytes_of(type) + bytes_of(bits) + text;
}

const std::string kPtuStart = std::string("PQTTTR\0\0", 8) + std::string("1.0.00\0\0", 8);
const std::string kEnd = tag("Header_End", kEmpty, 0);

/// A header whose T2 unit is 1 ps and whose T3 unit is 16 ps, in front of these records.
std::string ptu(std::uint32_t kind, std::uint64_t said, const std::vector<std::uint32_t>& records) {
  std::string file = kPtuStart + tag("HW_Type", kText, 8, std::string("Tagger\0\0", 8)) +
                     tag("TTResultFormat_TTTRRecType", kInteger, kind) +
                     tag("MeasDesc_GlobalResolution", kDouble, std::bit_cast<std::uint64_t>(1e-12)) +
                     tag("MeasDesc_Resolution", kDouble, std::bit_cast<std::uint64_t>(16e-12)) +
                     tag("TTResult_NumberOfRecords", kInteger, said) + kEnd;
  for (const std::uint32_t record : records) {
    file += bytes_of(record);
  }
  return file;
}

constexpr std::uint32_t photon_t3(std::uint32_t channel, std::uint32_t time, std::uint32_t syncs) {
  return channel << 25U | time << 10U | syncs;
}
constexpr std::uint32_t photon_t2(std::uint32_t channel, std::uint32_t time) { return channel << 25U | time; }
constexpr std::uint32_t special(std::uint32_t channel, std::uint32_t rest) {
  return 1U << 31U | channel << 25U | rest;
}

/// "channel,sync,time" in T3, "channel,time" in T2, the time in ps: as libpicoquant prints an event.
std::string line_of(const PicoquantHeader& header, const PicoquantEvent& event) {
  const auto time = static_cast<std::uint64_t>(static_cast<double>(event.time) * header.unit_ps);
  return header.mode == 3 ? fmt::format("{},{},{}", event.channel, event.sync, time)
                          : fmt::format("{},{}", event.channel, time);
}

class PicoquantTest : public test::IoTest {
 protected:
  static std::vector<std::string> lines(const std::filesystem::path& file) {
    PicoquantFile opened(file);
    std::vector<std::string> found;
    (void)opened.read([&](const PicoquantEvent& event) { found.push_back(line_of(opened.header(), event)); });
    return found;
  }
  static PicoquantCount count(const std::filesystem::path& file) {
    return PicoquantFile(file).read([](const PicoquantEvent& /*event*/) {});
  }
  /// Events as another library has decoded them, in the file beside the sample; `theirs` makes its line of an
  /// own one.
  static void expect_decoded(
      const std::string& sample, const std::string& decoded, std::size_t least,
      const std::function<std::string(const std::string&)>& theirs = [](const auto& line) { return line; }) {
    const std::vector<std::string> own = lines(test::shared_data("picoquant/" + sample));
    std::ifstream reference(test::shared_data("picoquant/" + decoded));
    std::size_t compared = 0;
    for (std::string line; std::getline(reference, line); ++compared) {
      ASSERT_LT(compared, own.size());
      ASSERT_EQ(theirs(own[compared]), line) << compared;
    }
    EXPECT_GE(compared, least);
  }
};

TEST_F(PicoquantTest, SamplesAreDecodedAsByAnotherLibrary) {
  DTOF_SKIP_IF_ABSENT(test::shared_data("picoquant/v10.ht3"));
  expect_decoded("v10.ht3", "v10.ht3.data", 32);
  expect_decoded("v20.ht3", "v20.ht3.data", 100);
  // The other library takes the first HydraHarp's 33,552,000 units for an overflow of every HydraHarp. Here
  // it is 2^25: the sample's times go up to 33,554,382, and only so are its events in the header's 5 s.
  constexpr std::uint64_t kOverflow = 33554432;
  const auto with_short_overflows = [&](const std::string& line) {
    const std::size_t comma = line.find(',') + 1;
    const std::uint64_t time = std::stoull(line.substr(comma));
    return fmt::format("{}{}", line.substr(0, comma), time % kOverflow + time / kOverflow * 33552000);
  };
  expect_decoded("v30_t2.ptu.gz", "v30_t2.ptu.data", 100, with_short_overflows);
  const std::string last = lines(test::shared_data("picoquant/v30_t2.ptu.gz")).back();
  EXPECT_NEAR(std::stod(last.substr(last.find(',') + 1)) * 1e-12, 5.0, 1e-4);
  const PicoquantHeader first = PicoquantFile(test::shared_data("picoquant/v10.ht3")).header();
  EXPECT_EQ(first.instrument, "HydraHarp 400");
  EXPECT_EQ(first.records, 72463591U);
  EXPECT_EQ(first.unit_ps, 4.0);
  EXPECT_EQ(first.sync_rate, 10004460.0);
  const PicoquantHeader second = PicoquantFile(test::shared_data("picoquant/v20.ht3")).header();
  EXPECT_EQ(second.records, 53606U);
  EXPECT_EQ(second.unit_ps, 16.0);
  EXPECT_EQ(second.sync_rate, 998898.0);
  const PicoquantHeader third = PicoquantFile(test::shared_data("picoquant/v30_t2.ptu.gz")).header();
  EXPECT_EQ(third.mode, 2);
  EXPECT_EQ(third.records, 435319U);
  EXPECT_EQ(third.unit_ps, 1.0);
  EXPECT_EQ(count(test::shared_data("picoquant/v20.ht3")).records, 53606U);
  EXPECT_EQ(count(test::shared_data("picoquant/v30_t2.ptu.gz")).records, 435319U);
}

TEST_F(PicoquantTest, ASampleIsARecording) {
  const std::filesystem::path sample = test::shared_data("picoquant/v20.ht3");
  DTOF_SKIP_IF_ABSENT(sample);
  const RecordingOptions options{.file = sample.string()};
  const RecordingFile file = read_recording(options);
  EXPECT_EQ(file.format, "picoquant");
  const RecordedData measurement = open_recorded_data(options, file);
  EXPECT_EQ(measurement.description, "PicoQuant HydraHarp 400, T3, 44141 photons");
  const auto& cube = std::get<HistogramCube>(measurement.data);
  EXPECT_EQ(cube.columns, 4);
  EXPECT_DOUBLE_EQ(cube.bin_width, 16e-12);
  double photons = 0.0;
  for (const double bin : cube.counts) {
    photons += bin;
  }
  EXPECT_EQ(photons, 44141.0);
  EXPECT_GE(cube.pixel(1, 0)[210336 / 16], 1.0);
}

TEST_F(PicoquantTest, OverflowsMoveTheClock) {
  // A record of 0 is one overflow, one of 3 is three; a marker is none.
  const auto t3 = write("a.ptu", ptu(kHydraT3, 6,
                                     {photon_t3(2, 5, 7), special(0x3F, 0), photon_t3(2, 6, 8),
                                      special(0x3F, 3), special(1, 0), photon_t3(0, 7, 9)}));
  EXPECT_THAT(lines(t3), ElementsAre("2,7,80", "2,1032,96", "0,4105,112"));
  EXPECT_EQ(count(t3).markers, 1U);
  const auto t2 =
      write("b.ptu", ptu(kHydraT2, 4, {photon_t2(1, 5), special(0x3F, 2), special(0, 9), photon_t2(0, 10)}));
  EXPECT_THAT(lines(t2), ElementsAre("1,5", "-1,67108873", "0,67108874"));
  EXPECT_EQ(count(t2).syncs, 1U);
  const auto pico3 =
      write("c.ptu", ptu(kPicoT3, 3, {1U << 28U | 4U << 16U | 5U, 0xFU << 28U, 2U << 28U | 6U << 16U | 7U}));
  EXPECT_THAT(lines(pico3), ElementsAre("0,5,64", "1,65543,96"));
  const auto pico2 =
      write("d.ptu", ptu(kPicoT2, 4, {0U << 28U | 4U, 0xFU << 28U, 1U << 28U | 6U, 0xFU << 28U | 1U}));
  EXPECT_THAT(lines(pico2), ElementsAre("-1,4", "0,210698246"));
}

TEST_F(PicoquantTest, TimesCanBeBeyondFourGigabytesOfUnits) {
  std::vector<std::uint32_t> records(200, special(0x3F, 0x1FFFFFF));
  records.push_back(photon_t2(0, 1));
  EXPECT_THAT(lines(write("a.ptu", ptu(kHydraT2, 0, records))), ElementsAre("0,225179974657638400"));
}

TEST_F(PicoquantTest, RecordsAreThoseOfHeaderAndFile) {
  const std::vector<std::uint32_t> three = {photon_t3(0, 1, 1), photon_t3(0, 2, 2), photon_t3(0, 3, 3)};
  EXPECT_EQ(count(write("a.ptu", ptu(kHydraT3, 2, three))).photons, 2U);
  EXPECT_EQ(count(write("a.ptu", ptu(kHydraT3, 0, three))).photons, 3U) << "a measurement that was not ended";
  EXPECT_EQ(count(write("a.ptu", ptu(kHydraT3, 0, {}))).records, 0U);
  const auto cut = write("a.ptu", ptu(kHydraT3, 9, three));
  PicoquantFile file(cut);
  const PicoquantCount read = file.read([](const PicoquantEvent& /*event*/) {});
  EXPECT_EQ(picoquant_description(file.header(), read),
            "PicoQuant Tagger, T3, 3 photons, 6 of the 9 records that the header names are missing");
}

TEST_F(PicoquantTest, PhotonsOfModeT2AreSinceTheLastSync) {
  const auto file = write("a.ptu", ptu(kHydraT2, 0,
                                       {photon_t2(0, 5), special(0, 100), photon_t2(0, 103),
                                        photon_t2(1, 105), special(0, 200), photon_t2(0, 203)}));
  std::string description;
  const HistogramCube cube = picoquant_cube(file, description);
  EXPECT_EQ(
      description,
      "PicoQuant Tagger, T2, 4 photons and 2 syncs, 1 without a sync before or beyond 1048576 bins left out");
  EXPECT_EQ(cube.columns, 2);
  EXPECT_EQ(cube.bins, 6);
  EXPECT_THAT(cube.counts, ElementsAre(0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 1));
}

TEST_F(PicoquantTest, ContentsInMemoryAreReadAsTheFile) {
  // Longer than a piece of the reader, 2^18 bytes.
  std::vector<std::uint32_t> records;
  for (std::uint32_t record = 0; record < 70000; ++record) {
    records.push_back(photon_t3(record % 3, record % 4000, record % 1024));
  }
  const std::string file = ptu(kHydraT3, records.size(), records);
  std::string description;
  std::string of_contents;
  const HistogramCube cube = picoquant_cube(write("a.ptu", file), description);
  const HistogramCube held = picoquant_cube("a.ptu", file, of_contents);
  EXPECT_EQ(of_contents, description);
  EXPECT_EQ(held.counts, cube.counts);
  EXPECT_EQ(held.bin_width, cube.bin_width);
  // A pipe is held.
  const RecordingOptions options{.file = pipe_of(file.substr(0, 60000)).string()};
  const RecordedData recorded = open_recorded_data(options, read_recording(options));
  EXPECT_THAT(recorded.description,
              testing::HasSubstr(" of the 70000 records that the header names are missing"));
}

/// A file as it is met in the wild, and the sentence that it gets.
struct Malformed {
  std::string name;
  std::string contents;
  std::string sentence;
};

TEST_F(PicoquantTest, EachMalformedFileHasItsSentence) {
  const std::string good = ptu(kHydraT3, 1, {photon_t3(0, 1, 1)});
  std::string other_version(800, '\0');
  other_version.replace(0, 9, "HydraHarp");
  std::string seventeen = other_version;
  other_version.replace(16, 3, "3.0");
  seventeen.replace(16, 3, "2.0");
  seventeen.replace(0x14c, 4, bytes_of(std::int32_t{32}));
  seventeen.replace(0x154, 4, bytes_of(std::int32_t{17}));
  std::string no_resolution = seventeen;
  no_resolution.replace(0x154, 4, bytes_of(std::int32_t{3}));
  write_gzip_file(path("whole.ptu.gz"), good + std::string(4000, 'x'));
  const std::string packed = contents(path("whole.ptu.gz"));
  const std::vector<Malformed> table = {
      {"empty", "", "the file is empty"},
      {"other file", "PQHISTO and more than that", "neither a PTU nor an HT3 file"},
      {"cut in the header", good.substr(0, 100), "the file ends in its header"},
      {"cut in the first letters", good.substr(0, 9), "the file ends in its header"},
      {"cut in a record", good.substr(0, good.size() - 1), "the file ends in record 0"},
      {"cut gzip data", packed.substr(0, packed.size() - 12), "damaged gzip data: the file ends early"},
      {"unknown entry", kPtuStart + tag("Strange", 0x12345678, 0),
       "the header's entry 'Strange' is of an unknown type, 0x12345678: damaged"},
      {"endless text", kPtuStart + tag("Comment", kText, std::uint64_t{1} << 40U),
       "the header's entry 'Comment' has 1099511627776 bytes: damaged"},
      {"histogram mode", kPtuStart + kEnd,
       "the header has no TTResultFormat_TTTRRecType: the file has no time tags"},
      {"unknown instrument", ptu(0x00010999, 0, {}), "records of type 0x00010999 are unknown"},
      {"no resolution", kPtuStart + tag("TTResultFormat_TTTRRecType", kInteger, kHydraT3) + kEnd,
       "the header's resolution is 0 ps, must be above 0"},
      {"other HT3", other_version, "HydraHarp format '3.0' is not 1.0 or 2.0"},
      {"other mode", seventeen,
       "the header has 32 bits a record, mode 17 and 0 inputs, not 32 bits, mode 2 or 3 and up to 64 inputs"},
      {"HT3 without resolution", no_resolution, "the header's resolution is 0 ps, must be above 0"},
      {"no photons", ptu(kHydraT3, 0, {special(0x3F, 1)}), "the file has no photons in its 1 records"},
      {"T2 without syncs", ptu(kHydraT2, 0, {photon_t2(0, 1)}),
       "the file is of mode T2 and has no syncs: no time of a photon has a begin"}};
  for (const Malformed& one : table) {
    SCOPED_TRACE(one.name);
    const auto file = write("a.ptu", one.contents);
    std::string description;
    test::expect_input_error([&] { (void)picoquant_cube(file, description); },
                             file.string() + ": " + one.sentence);
    if (!one.contents.starts_with("\x1f\x8b")) {
      test::expect_input_error([&] { (void)picoquant_cube(file, one.contents, description); },
                               file.string() + ": " + one.sentence);
    }
  }
}

}  // namespace
}  // namespace dtof
