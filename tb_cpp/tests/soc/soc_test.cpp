// SPDX-License-Identifier: Apache-2.0
// The SoC example by its software: examples/soc/software.c with the project's driver, unchanged, whose
// accesses become APB transfers; the words on the serial line are what the model makes of the same photons.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

#include "dtof/readout/model.hpp"
#include "rtl/error.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/demonstrator/generated_photons.hpp"
#include "tests/soc/soc_bench.hpp"

namespace dtof {
namespace {

constexpr int kNp = 10;
constexpr int kColumns = 4;
constexpr int kRows = 8;
constexpr std::size_t kPixels = std::size_t{kColumns} * kRows;
constexpr std::uint32_t kAcquisitions = 600;

struct Pixel {
  int position = 0;
  int confidence = 0;

  bool operator==(const Pixel&) const = default;
};

void PrintTo(const Pixel& pixel, std::ostream* stream) {
  *stream << fmt::format("position {} confidence {}", pixel.position, pixel.confidence);
}

class Soc : public testing::Test {
 protected:
  /// A frame by the software; its pixels row by row.
  std::vector<Pixel> run_frame() {
    EXPECT_FALSE(bench_.irq());
    soc_frame frame{};
    const dtof_status status = soc_run_frame(&platform_, kAcquisitions, &frame);
    EXPECT_EQ(status, DTOF_OK);
    if (status != DTOF_OK) {
      return {};
    }
    EXPECT_EQ(frame.device.columns, kColumns);
    EXPECT_EQ(frame.device.rows, kRows);
    // The serial line is so slow that the source must wait, which OVERRUN tells; nothing is lost.
    EXPECT_EQ(frame.causes, DTOF_IRQ_STATUS_FRAME_MASK | DTOF_IRQ_STATUS_ERROR_MASK);
    EXPECT_EQ(frame.errors, DTOF_ERROR_OVERRUN_MASK);
    EXPECT_FALSE(bench_.irq());
    EXPECT_FALSE(frame.state.busy);
    EXPECT_EQ(frame.state.errors, 0U);
    EXPECT_EQ(frame.state.lost_lines, 0U);
    EXPECT_EQ(frame.state.frames, ++frames_);

    const std::vector<std::uint64_t> words = bench_.receive_frame();
    std::uint32_t number = 0;
    EXPECT_EQ(dtof_check_frame(&frame.device, words.data(), words.size(), &number), DTOF_OK);
    EXPECT_EQ(number, frames_);
    std::vector<dtof_result> results(kPixels);
    EXPECT_EQ(dtof_unpack_frame(&frame.device, words.data(), words.size(), results.data()), DTOF_OK);
    std::vector<Pixel> pixels;
    for (const dtof_result& result : results) {
      EXPECT_EQ(result.valid, result.confidence != 0);
      pixels.push_back({result.position, result.confidence});
    }
    return pixels;
  }

  /// What the model makes of the next frame's photons.
  std::vector<Pixel> expected_pixels() {
    const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHisPointer, kNp);
    const std::vector<std::vector<PixelResult>> results =
        make_readout_model(parameters)->run_columns(photons_.acquire(kAcquisitions), kAcquisitions);
    std::vector<Pixel> pixels;
    for (std::size_t row = 0; row < kRows; ++row) {
      for (const std::vector<PixelResult>& column : results) {
        pixels.push_back(
            {(column[row].code << parameters.fraction_bits) + column[row].fraction, column[row].confidence});
      }
    }
    return pixels;
  }

  SocBench bench_{test_seed()};
  soc_platform platform_ = bench_.platform();
  GeneratedPhotons photons_{kNp, kColumns, kRows};
  std::uint32_t frames_ = 0;
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

TEST_F(Soc, DepthsOnTheSerialLineAreTheModels) {
  for (int frame = 0; frame < 2; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    const std::vector<Pixel> pixels = run_frame();
    ASSERT_EQ(pixels, expected_pixels());
  }
}

TEST_F(Soc, TargetsMoveByTheBus) {
  const std::vector<Pixel> ramp = run_frame();
  ASSERT_EQ(ramp, expected_pixels());
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
    const int code = 850 - 150 * static_cast<int>(pixel % kColumns) + 5 * static_cast<int>(pixel / kColumns);
    ASSERT_EQ(soc_set_target(&platform_, static_cast<std::uint32_t>(pixel), static_cast<std::uint32_t>(code)),
              DTOF_OK);
    photons_.targets()[pixel] = code;
  }
  // Lines that the source had made before the targets moved belong to this frame: only the random numbers are
  // taken.
  (void)run_frame();
  (void)expected_pixels();

  const std::vector<Pixel> moved = run_frame();
  ASSERT_EQ(moved, expected_pixels());
  std::size_t near = 0;
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
    near += std::abs(moved[pixel].position - photons_.targets()[pixel]) <= 10 ? 1U : 0U;
  }
  EXPECT_GE(near, kPixels - kPixels / 8);
}

TEST_F(Soc, TheSceneMakesTheBusWait) {
  const std::uint32_t free = bench_.write(SOC_SCENE_BASE, 500).clocks;
  const std::uint32_t waits = bench_.write(SOC_SCENE_BASE + 4, 500).clocks;
  EXPECT_EQ(free, 3U);  // the request, and APB's two
  EXPECT_EQ(waits, kColumns + kPixels + 1);
}

TEST_F(Soc, WhatIsNotThereIsRefused) {
  constexpr std::uint32_t kPage = 0x1000;
  for (const std::uint32_t address :
       {std::uint32_t{0}, SOC_READOUT_BASE - 4, SOC_SCENE_BASE + kPage, SOC_READOUT_BASE + 0x80000000U}) {
    EXPECT_TRUE(bench_.read(address).error) << address;
    EXPECT_TRUE(bench_.write(address, 1).error) << address;
  }
  EXPECT_TRUE(bench_.read(SOC_SCENE_BASE).error);
  EXPECT_TRUE(bench_.write(SOC_SCENE_BASE + 1, 5).error);
  EXPECT_TRUE(bench_.write(SOC_SCENE_BASE, 5, 0x3).error);
  EXPECT_EQ(soc_set_target(&platform_, kPixels, 5), DTOF_BUS);
  EXPECT_EQ(soc_set_target(&platform_, 0, 1U << kNp), DTOF_BUS);
  // Nothing of this reached the read-out or the scene.
  ASSERT_EQ(run_frame(), expected_pixels());
}

TEST_F(Soc, AResetEndsAFrame) {
  soc_frame frame{};
  platform_.wait_for_interrupt = [](void* context) {
    static_cast<SocBench*>(context)->clock(2000);
    return false;  // the software gives up
  };
  ASSERT_EQ(soc_run_frame(&platform_, kAcquisitions, &frame), DTOF_BUSY);
  bench_.reset();
  platform_ = bench_.platform();
  ASSERT_EQ(run_frame(), expected_pixels());
}

}  // namespace
}  // namespace dtof
