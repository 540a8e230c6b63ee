// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string_view>

#include "dtof/core/error.hpp"
#include "dtof/rival/rival.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(RivalList, NamesAndTitlesAreUniqueAndHaveASource) {
  std::set<std::string_view> names;
  std::set<std::string_view> titles;
  for (const RivalEntry& entry : all_rivals()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_TRUE(titles.insert(entry.title).second) << entry.title;
    EXPECT_FALSE(entry.citation.empty()) << entry.name;
    EXPECT_EQ(find_rival(entry.name).title, entry.title);
  }
  EXPECT_THAT(
      [] { (void)find_rival("none"); },
      ThrowsMessage<InputError>(AllOf(HasSubstr("no rival is called none"), HasSubstr("histogram32"))));
}

// What the tables say of memory.
TEST(RivalList, BitsOfAPixel) {
  const auto bits = [](std::string_view name) {
    return find_rival(name).make(SensorModel())->bits_per_pixel();
  };
  EXPECT_EQ(bits("histogram32"), 32 * 8);
  EXPECT_EQ(bits("fourier16"), 16 * 13 + 1);
  EXPECT_EQ(bits("gray8-1bit"), 8 * 10 + 1);
  EXPECT_EQ(bits("correlations"), 2 * 12);
  EXPECT_EQ(bits("sketch2"), 4 * 21);
  EXPECT_EQ(bits("spline16"), 16 * 11 + 1);
  EXPECT_EQ(bits("legendre8"), 8 * 17);
  EXPECT_EQ(bits("legendre16"), 16 * 17);
}

// What the estimates of area and host work take.
TEST(RivalList, HardwareHasAllBitsOfAPixel) {
  for (const RivalEntry& entry : all_rivals()) {
    const std::unique_ptr<Rival> rival = entry.make(SensorModel());
    const RivalHardware hardware = rival->hardware();
    EXPECT_GE(hardware.words * hardware.word_bits, rival->bits_per_pixel()) << entry.name;
    EXPECT_LT((hardware.words - 1) * hardware.word_bits, rival->bits_per_pixel()) << entry.name;
    EXPECT_GE(rival->host_operations(), 0) << entry.name;
  }
  const auto hardware = [](std::string_view name) {
    return find_rival(name).make(SensorModel())->hardware();
  };
  EXPECT_EQ(hardware("histogram32").words, 32);
  EXPECT_EQ(hardware("fourier16").table_bits, 16 * 4 * 256);
  EXPECT_EQ(hardware("fourier16-1bit").table_bits, 0);
  EXPECT_EQ(hardware("pedh4").adder_bits, 3 * 2 * 10);
  const auto operations = [](std::string_view name) {
    return find_rival(name).make(SensorModel())->host_operations();
  };
  EXPECT_EQ(operations("fourier8"), 1023 * 9 + 4 * 8);
  EXPECT_EQ(operations("hedh16"), 8 * 16);
}

// What every rival owes its callers, whoever adds it.
TEST(RivalList, EveryRivalReadsDarkBrightAndHostilePixels) {
  const SensorModel sensor;
  std::vector<Detection> bright;
  for (std::uint32_t acquisition = 0; acquisition < sensor.acquisitions; ++acquisition) {
    bright.push_back({acquisition, static_cast<Timestamp>(acquisition * 7 % 1024)});
    bright.push_back({acquisition, 1022});
  }
  for (const RivalEntry& entry : all_rivals()) {
    const std::unique_ptr<Rival> rival = entry.make(sensor);
    EXPECT_GT(rival->bits_per_pixel(), 0) << entry.name;
    ASSERT_GE(rival->frames(), 1) << entry.name;
    const auto frames = static_cast<std::size_t>(rival->frames());
    for (const std::vector<Detection>& pixel : {std::vector<Detection>(), bright}) {
      const RivalWords words = rival->read_pixel(
          std::vector<std::span<const Detection>>(frames, std::span<const Detection>(pixel)));
      const Measurement measured = rival->decode(words);
      EXPECT_GE(measured.position, 0.0) << entry.name;
      EXPECT_LE(measured.position, 1023.0) << entry.name;
      if (pixel.empty()) {
        EXPECT_EQ(measured.confidence, 0.0) << entry.name;
      }
      const std::vector<double> evidence = rival->evidence(words);
      EXPECT_TRUE(evidence.empty() || evidence.size() == 1023) << entry.name;
    }
    const std::vector<Detection> wrong = {{0, 1024}};
    EXPECT_THAT(
        [&] {
          (void)rival->read_pixel(
              std::vector<std::span<const Detection>>(frames, std::span<const Detection>(wrong)));
        },
        ThrowsMessage<InputError>(HasSubstr("timestamp 1024")))
        << entry.name;
  }
}

}  // namespace
}  // namespace dtof
