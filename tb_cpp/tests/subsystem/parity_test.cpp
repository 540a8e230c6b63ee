// SPDX-License-Identifier: Apache-2.0
// Parity of all memories of the subsystem and its array: a changed bit that changes a result is reported, and
// nothing that did not happen is.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dtof.h"
#include "tests/subsystem/subsystem_test_support.hpp"

namespace dtof {
namespace {

class Parity : public Subsystem {
 protected:
  bool has_parity() { return (bench_.get(DTOF_READOUT) & DTOF_READOUT_PARITY_MASK) != 0; }

  std::optional<RtlSram> sram(std::string_view name) {
    for (const RtlSram& sram : bench_.srams()) {
      if (sram.path().find(name) != std::string::npos) {
        return sram;
      }
    }
    return std::nullopt;
  }

  static void flip(RtlSram& sram, int word, int bit) { sram.set_bit(word, bit, !sram.bit(word, bit)); }

  FrameSettings settings(std::uint32_t acquisitions) {
    return {.acquisitions = acquisitions,
            .gate = {0, bench_.configuration().parameters.no_detection()},
            .weak_below = 0,
            .enabled = {},
            .second_target = bench_.configuration().parameters.pool.second_target,
            .raw = false};
  }

  // A frame's settings, and its lines on their way.
  std::vector<Line> prepare(std::uint32_t acquisitions, CounterRandom& random) {
    write_settings(bench_, settings(acquisitions));
    std::vector<Line> lines = make_lines(bench_.configuration(), acquisitions, random);
    push_lines(bench_, lines);
    return lines;
  }

  // A frame of `lines` after a reset; `disturb` runs after its start.
  template <typename Disturb>
  void run(const std::vector<Line>& lines, Disturb disturb) {
    bench_.reset();
    write_settings(bench_, settings(3));
    push_lines(bench_, lines);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    disturb();
    if (bench_.sink().frames().size() == received_) {
      bench_.wait_for_frames(1);
    }
    received_ = bench_.sink().frames().size();
    bench_.clocks(2);  // from a damaged word to the register
  }

  void expect_errors(std::uint32_t number, std::uint32_t since_reset) {
    bench_.clocks(2);  // from a damaged word to the register
    EXPECT_EQ(bench_.get(DTOF_ERROR), number > 0 ? DTOF_ERROR_PARITY_MASK : 0U);
    EXPECT_EQ(bench_.get(DTOF_IRQ_STATUS) & DTOF_IRQ_STATUS_ERROR_MASK,
              number > 0 ? DTOF_IRQ_STATUS_ERROR_MASK : 0U);
    EXPECT_EQ(bench_.get(DTOF_PARITY_ERRORS), since_reset);
    bench_.set(DTOF_ERROR, 0xFFFFFFFF);
    bench_.set(DTOF_IRQ_STATUS, 0xFFFFFFFF);
  }

  std::size_t received_ = 0;  // frames
  std::uint64_t cycles_ = 0;  // of the last frame
};

INSTANTIATE_TEST_SUITE_P(All, Parity, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(Parity, IsQuietWhileNothingChanges) {
  CounterRandom random = this->random(60);
  bench_.source().gap_probability = 0.3;
  for (int frame = 0; frame < 5; ++frame) {
    bench_.sink().stall_probability = 0.5 * random.uniform();
    bench_.source().gap_probability = 0.0;
    prepare(1 + random() % 5, random);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    expect_errors(0, 0);
  }
}

TEST_P(Parity, OfALineReportsEachWordOnce) {
  if (!has_parity() || !sram("u_line_buffer")) {
    return;  // no parity, or a buffer of registers
  }
  CounterRandom random = this->random(61);
  RtlSram lines = *sram("u_line_buffer");
  const int parity_bit = lines.width() - 1;
  EXPECT_EQ(lines.width(), bench_.configuration().sram_num * bench_.configuration().parameters.np + 2);
  std::uint32_t since_reset = 0;
  for (int round = 0; round < 20; ++round) {
    bench_.reset();
    since_reset = 0;
    prepare(2, random);
    bench_.clocks(bench_.acquisition_lines());  // nothing is taken before the frame: they lie in the buffer
    // The parity bit, so that the lines stay what the bench expects; the first line has left the memory.
    std::uint32_t flipped = 0;
    for (int word = 1; word + 2 < static_cast<int>(bench_.acquisition_lines()); ++word) {
      if (pick(random, 2) == 0) {
        flip(lines, word, parity_bit);
        ++flipped;
      }
    }
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    since_reset += flipped;
    expect_errors(flipped, since_reset);
    prepare(2, random);  // each word is written anew
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    expect_errors(0, since_reset);
    dtof_device device{};
    ASSERT_EQ(dtof_probe(&device, {&bench_,
                                   [](void* context, std::uint32_t offset, std::uint32_t* value) {
                                     *value = static_cast<SubsystemBench*>(context)->get(offset);
                                     return true;
                                   },
                                   nullptr}),
              DTOF_OK);
    dtof_state state{};
    ASSERT_EQ(dtof_read_state(&device, &state), DTOF_OK);
    EXPECT_EQ(state.parity_errors, since_reset);
  }
}

TEST_P(Parity, OfAResultReportsEveryBit) {
  const bool raster = (bench_.get(DTOF_READOUT) & DTOF_READOUT_RASTER_ORDER_MASK) != 0;
  if (!has_parity() || !raster) {
    return;
  }
  CounterRandom random = this->random(62);
  RtlSram results = *sram("u_raster_buffer");
  std::uint32_t since_reset = 0;
  for (int bit = 0; bit < results.width(); ++bit) {
    prepare(2, random);
    bench_.sink().blocked = true;
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    while (bench_.frames().size() <= static_cast<std::size_t>(bit) || bench_.frames().back().cycles == 0) {
      bench_.clock();
    }
    bench_.clocks(50);  // the first word waits at the port, behind it the memory
    const int word = 2 + pick(random, results.words() - 2);
    flip(results, word, bit);
    const int twice = 2 + (word - 1) % (results.words() - 2);
    flip(results, twice, bit);  // an even number of bits in one word is not seen
    flip(results, twice, (bit + 1) % results.width());
    bench_.sink().blocked = false;
    bench_.wait_for_frames(1);
    ++since_reset;
    expect_errors(1, since_reset);
  }
}

// In the first frame after a reset no word of a memory has been written, and an abort leaves them as they
// are.
TEST_P(Parity, IsQuietAfterAnAbort) {
  CounterRandom random = this->random(63);
  for (int round = 0; round < 20; ++round) {
    if (round % 4 == 0) {
      bench_.reset();
    }
    prepare(1 + random() % 4, random);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.clocks(1 + random() % 1500);
    const bool ended = bench_.frames().back().cycles != 0;
    if (!ended) {
      bench_.set(DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK | DTOF_CONTROL_FLUSH_MASK);
    }
    bench_.clocks(300);
    EXPECT_EQ(bench_.get(DTOF_PARITY_ERRORS), 0U) << "round " << round;
    EXPECT_EQ(bench_.get(DTOF_ERROR) & DTOF_ERROR_PARITY_MASK, 0U);
    prepare(2, random);
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.wait_for_frames(1);
    EXPECT_EQ(bench_.get(DTOF_PARITY_ERRORS), 0U) << "round " << round;
  }
}

// The same lines twice, the second time with a bit of the array's memory that changes in a random clock.
TEST_P(Parity, OfAnArrayReportsEachBitThatChangesAResult) {
  if (!has_parity()) {
    return;
  }
  std::vector<RtlSram> srams = bench_.srams();
  std::erase_if(srams, [](const RtlSram& sram) { return sram.path().find("u_array") == std::string::npos; });
  ASSERT_FALSE(srams.empty());
  CounterRandom random = this->random(64);
  std::map<std::string, int> reported;  // by the instance's name
  constexpr int kRounds = 80;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Line> lines = make_lines(bench_.configuration(), 3, random);
    RtlSram& sram = srams[static_cast<std::size_t>(round) % srams.size()];
    const std::uint64_t before = random() % std::max<std::uint64_t>(cycles_, 1);
    const int word = pick(random, sram.words());
    const int bit = pick(random, sram.width());
    run(lines, [] {});
    cycles_ = bench_.frames().back().cycles;
    EXPECT_EQ(bench_.get(DTOF_PARITY_ERRORS), 0U);
    const std::vector<std::uint64_t> right = bench_.sink().frames().back();
    run(lines, [&] {
      bench_.clocks(before);
      flip(sram, word, bit);
    });
    const std::uint32_t errors = bench_.get(DTOF_PARITY_ERRORS);
    EXPECT_EQ(bench_.get(DTOF_ERROR), errors > 0 ? DTOF_ERROR_PARITY_MASK : 0U);
    if (bench_.sink().frames().back() != right) {
      EXPECT_GT(errors, 0U) << sram.path() << " word " << word << " bit " << bit << " clock " << before;
    }
    reported[sram.path().substr(sram.path().rfind('.') + 1)] += errors > 0 ? 1 : 0;
  }
  for (const auto& [name, number] : reported) {
    EXPECT_GT(number, 0) << "no changed bit of " << name << " was reported";
  }
}

// A pointer that no timestamp moves is read once in each acquisition, and once for the result; while the
// array's clock is stopped, an error counts once.
TEST_P(Parity, OfAPointerCountsEachRead) {
  const ReadoutParameters& parameters = bench_.configuration().parameters;
  if (!has_parity() || parameters.readout != Readout::kEzPointer || !bench_.clock_waits()) {
    return;
  }
  CounterRandom random = this->random(65);
  constexpr std::uint32_t kAcquisitions = 5;
  std::vector<Line> lines = make_lines(bench_.configuration(), kAcquisitions, random);
  for (Line& line : lines) {
    std::fill(line.begin(), line.end(), parameters.no_detection());
  }
  std::uint64_t rests = 0;
  for (RtlSram& sram : bench_.srams()) {
    if (sram.path().find("u_array") == std::string::npos) {
      continue;
    }
    bench_.reset();
    write_settings(bench_, settings(kAcquisitions));
    bench_.set(DTOF_CONTROL, DTOF_CONTROL_START_MASK);
    bench_.clocks(100);  // the start values are written, and the array is ready for its first line
    flip(sram, 1, sram.width() - 1);
    bench_.source().gap_probability = 0.7;
    push_lines(bench_, lines);
    bench_.wait_for_frames(1);
    bench_.clocks(2);
    EXPECT_EQ(bench_.get(DTOF_PARITY_ERRORS), kAcquisitions + 1) << sram.path();
    rests += bench_.rests();
    bench_.source().gap_probability = 0.0;
  }
  EXPECT_GT(rests, 0U);
}

}  // namespace
}  // namespace dtof
