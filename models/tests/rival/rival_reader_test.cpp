// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/rival_reader.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <vector>

namespace dtof {
namespace {

/// Its words are the number of detections of each frame.
class Counter final : public Rival {
 public:
  Counter(int frames, int laser_off) : frames_(frames), laser_off_(laser_off) {}

  [[nodiscard]] int bits_per_pixel() const override { return 16; }
  [[nodiscard]] RivalHardware hardware() const override { return {.word_bits = 16}; }
  [[nodiscard]] int host_operations() const override { return 0; }
  [[nodiscard]] int frames() const override { return frames_; }
  [[nodiscard]] int laser_off_frames() const override { return laser_off_; }
  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    RivalWords words;
    for (const std::span<const Detection> frame : frames) {
      words.push_back(static_cast<std::int32_t>(frame.size()));
    }
    return words;
  }
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    return {static_cast<double>(words[0]), 1.0};
  }

 private:
  int frames_;
  int laser_off_;
};

struct Read {
  SensorModel sensor;
  TargetMap targets{3, 4, {2.0, 1.0}};
  std::vector<std::unique_ptr<Rival>> rivals;
  static constexpr double kKlux = 10.0;
  static constexpr std::uint64_t kSeed = 5;

  Read() {
    sensor.acquisitions = 500;
    rivals.push_back(std::make_unique<Counter>(1, 0));
    rivals.push_back(std::make_unique<Counter>(3, 1));
  }

  [[nodiscard]] int detections(const SensorModel& model, std::uint32_t frame, int column, int row) const {
    const ColumnStream stream = PhotonSource(model, targets, kKlux, kSeed, frame).column(column);
    return static_cast<int>(stream.row(row).size());
  }
};

TEST(RivalReader, EachRivalHasTheFramesThatItNeedsOldestFirst) {
  const Read read;
  EXPECT_EQ(most_frames(read.rivals), 3U);
  const RivalReader reader(read.sensor, read.targets, Read::kKlux, Read::kSeed, {40, 30, 7}, read.rivals);
  const auto words = reader.column(2);
  ASSERT_EQ(words.size(), 2U);
  SensorModel dark = read.sensor;
  dark.signal_events_1m = 0.0;
  for (int row = 0; row < 4; ++row) {
    const auto at = static_cast<std::size_t>(row);
    EXPECT_EQ(words[0][at], (RivalWords{read.detections(read.sensor, 7, 2, row)}));
    EXPECT_EQ(words[1][at],
              (RivalWords{read.detections(dark, 40, 2, row), read.detections(read.sensor, 30, 2, row),
                          read.detections(read.sensor, 7, 2, row)}));
  }
  EXPECT_LT(words[1][0][0], words[1][0][1]) << "the first frame has no laser light";
}

TEST(RivalReader, NeedsANumberForEachFrame) {
  const Read read;
  EXPECT_THROW(RivalReader(read.sensor, read.targets, Read::kKlux, Read::kSeed, {7}, read.rivals),
               std::logic_error);
}

}  // namespace
}  // namespace dtof
