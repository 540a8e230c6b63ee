// SPDX-License-Identifier: Apache-2.0
// Bits that are flipped or stuck at known places are seen at the right pixel, and the frame after is right.
#include <gtest/gtest.h>

#include <bit>
#include <functional>

#include "faults/array_srams.hpp"
#include "faults/fault_effect.hpp"
#include "faults/fault_subject.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kAcquisitions = 100;
constexpr PixelPlace kPixel = {5, 33};

std::size_t index_of(PixelPlace pixel) {
  return static_cast<std::size_t>(pixel.row) * kFaultColumns + static_cast<std::size_t>(pixel.column);
}

class PlantedFlip : public testing::TestWithParam<Readout> {
 protected:
  std::vector<PixelResult> run_disturbed(std::function<void(const RtlCycle&)> observer) {
    RtlRunOptions options;
    options.reset_first = false;
    options.observer = std::move(observer);
    return rtl_.run(scene_.frame, scene_.acquisitions, options).results;
  }

  /// The next frame, without a fault.
  std::vector<PixelResult> run_next() {
    RtlRunOptions options;
    options.reset_first = false;
    return rtl_.run(scene_.next, scene_.next_acquisitions, options).results;
  }

  /// The SRAM of this kind that column `column` uses.
  ArraySram array_sram(SramKind kind, int column) {
    for (const ArraySram& candidate : array_srams(rtl_)) {
      if (candidate.kind == kind && candidate.columns.contains(column)) {
        return candidate;
      }
    }
    throw std::logic_error("no such SRAM");
  }
  RtlSram sram(SramKind kind, int column) { return array_sram(kind, column).sram; }

  /// Flips the bit after the last clock in `state`, runs the frame, and the next one without a fault.
  std::vector<PixelResult> run_flipped(RtlSram sram, int word, int bit, RtlState state) {
    const std::uint64_t clock = subject_.clocks(state).back();
    std::vector<PixelResult> actual = run_disturbed([=](const RtlCycle& now) mutable {
      if (now.cycle == clock) {
        sram.set_bit(word, bit, !sram.bit(word, bit));
      }
    });
    EXPECT_EQ(run_next(), subject_.expected_next()) << "the frame after the fault";
    return actual;
  }

  /// Pixels whose results differ from the frame without a fault.
  std::vector<PixelPlace> changed(const std::vector<PixelResult>& actual) {
    std::vector<PixelPlace> pixels;
    for (int row = 0; row < kFaultRows; ++row) {
      for (int column = 0; column < kFaultColumns; ++column) {
        const std::size_t i = index_of({column, row});
        if (actual[i] != subject_.expected()[i]) {
          pixels.push_back({column, row});
        }
      }
    }
    return pixels;
  }

  FaultScene scene_ = make_fault_scene(kAcquisitions, 1);
  FaultSubject subject_{GetParam(), scene_};
  RtlReadout rtl_{subject_.configuration()};
};

std::string readout_test_name(const testing::TestParamInfo<Readout>& readout) {
  std::string name(readout_name(readout.param));
  std::erase(name, '-');
  return name;
}

class PlantedPointerFlip : public PlantedFlip {};
INSTANTIATE_TEST_SUITE_P(Pointers, PlantedPointerFlip,
                         testing::Values(Readout::kEzPointer, Readout::kHisPointer1, Readout::kHisPointer),
                         readout_test_name);

// The word's low bits are the pointer.
TEST_P(PlantedPointerFlip, FlipsTheResultOfItsPixel) {
  constexpr int kBit = 7;
  const std::vector<PixelResult> actual =
      run_flipped(sram(SramKind::kPointer, kPixel.column), kPixel.row, kBit, RtlState::kM3);
  ASSERT_EQ(changed(actual), std::vector{kPixel});
  EXPECT_EQ(actual[index_of(kPixel)].code ^ subject_.expected()[index_of(kPixel)].code, 1 << kBit);
}

TEST_P(PlantedPointerFlip, AStuckBitIsStuckInEveryResultOfItsColumn) {
  constexpr int kBit = 3;
  RtlSram stuck = sram(SramKind::kPointer, kPixel.column);
  const std::vector<PixelResult> actual = run_disturbed([&](const RtlCycle&) {
    if (stuck.read_address() < stuck.words()) {
      stuck.set_bit(stuck.read_address(), kBit, true);
    }
  });
  for (int row = 0; row < kFaultRows; ++row) {
    EXPECT_NE(actual[index_of({kPixel.column, row})].code & 1 << kBit, 0) << "row " << row;
  }
  EXPECT_EQ(changed_elsewhere(subject_, actual, std::vector<FaultReach>{{{kPixel.column, 1}, std::nullopt}}),
            0);
  EXPECT_EQ(run_next(), subject_.expected_next());
}

class PlantedHistogramFlip : public PlantedFlip {};
INSTANTIATE_TEST_SUITE_P(Histograms, PlantedHistogramFlip,
                         testing::Values(Readout::kSifh, Readout::kFifh, Readout::kThreeSteps,
                                         Readout::kHistogram),
                         readout_test_name);

// The highest bit of an empty bin makes it the peak.
TEST_P(PlantedHistogramFlip, MovesThePeakOfItsPixel) {
  RtlSram histogram = sram(SramKind::kHistogram, kPixel.column);
  const int bins = histogram.words() / kFaultRows;
  constexpr int kBin = 9;
  const std::vector<PixelResult> actual =
      run_flipped(histogram, kPixel.row * bins + kBin, histogram.width() - 1, RtlState::kM3);
  ASSERT_EQ(changed(actual), std::vector{kPixel});
  if (GetParam() == Readout::kHistogram) {
    EXPECT_EQ(actual[index_of(kPixel)].code, kBin);
  }
}

class PlantedPoolFlip : public PlantedFlip {};
INSTANTIATE_TEST_SUITE_P(Pools, PlantedPoolFlip,
                         testing::Values(Readout::kPoolPointer, Readout::kPoolPointerLean),
                         readout_test_name);

// Each bit of a word with two pixels' pointers, one after the other: some change their column, and through S1
// the one to the right of it, none another one.
TEST_P(PlantedPoolFlip, StaysInItsColumnAndTheNext) {
  const ArraySram shared = array_sram(SramKind::kPoolQuad, kPixel.column);
  const RtlSram words = shared.sram;
  int flips_that_change = 0;
  for (int bit = 0; bit < words.width(); bit += 13) {
    const std::vector<PixelPlace> pixels = changed(run_flipped(words, kPixel.row / 2, bit, RtlState::kM4));
    flips_that_change += pixels.empty() ? 0 : 1;
    const int column = shared.columns.first + shared.columns.count * bit / words.width();
    for (const PixelPlace& pixel : pixels) {
      EXPECT_TRUE(pixel.column == column || pixel.column == column + 1)
          << "bit " << bit << ", row " << pixel.row << ", column " << pixel.column;
    }
  }
  EXPECT_GT(flips_that_change, 0);
}

class SramsOfReadout : public testing::TestWithParam<Readout> {};
INSTANTIATE_TEST_SUITE_P(All, SramsOfReadout, testing::ValuesIn(kRtlReadouts), readout_test_name);

TEST_P(SramsOfReadout, EveryColumnHasItsOwn) {
  const FaultScene scene = make_fault_scene(2, 1);
  const FaultSubject subject(GetParam(), scene);
  const RtlReadout rtl(subject.configuration());
  const std::vector<ArraySram> srams = array_srams(rtl);
  for (const SramKind kind : sram_kinds(srams)) {
    std::vector<int> users(kFaultColumns);
    for (const ArraySram& sram : srams) {
      for (int column = 0; sram.kind == kind && column < kFaultColumns; ++column) {
        users[static_cast<std::size_t>(column)] += sram.columns.contains(column) ? 1 : 0;
      }
    }
    EXPECT_EQ(users, std::vector<int>(kFaultColumns, 1)) << sram_title(kind);
  }
}

}  // namespace
}  // namespace dtof
