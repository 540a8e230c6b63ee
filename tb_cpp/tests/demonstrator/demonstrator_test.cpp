// SPDX-License-Identifier: Apache-2.0
// The very top of the FPGA demonstrator, from its serial line alone: what comes out is what the model makes
// of the same photons. Linked with the Verilated RTL or with the Verilated netlist (make fpga).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include <array>
#include <cstdlib>

#include "dtof.h"
#include "dtof/readout/model.hpp"
#include "rtl/write_coverage.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/demonstrator/demonstrator_model.hpp"
#include "tests/demonstrator/generated_photons.hpp"
#include "tests/demonstrator/serial_line.hpp"

namespace dtof {
namespace {

constexpr int kNp = 10;
constexpr int kRows = 8;
constexpr std::uint32_t kAcquisitions = 1000;
constexpr int kWeakBelow = 2;
constexpr int kClocksPerBit = 12;
constexpr int kWordBytes = 9;
constexpr std::uint64_t kFrameClocks = 300000;

struct Pixel {
  int row = 0;
  int column = 0;
  int position = 0;
  int confidence = 0;
  bool weak = false;
  bool saturated = false;

  bool operator==(const Pixel&) const = default;
};

void PrintTo(const Pixel& pixel, std::ostream* stream) {
  *stream << fmt::format("row {} column {} position {} confidence {}{}{}", pixel.row, pixel.column,
                         pixel.position, pixel.confidence, pixel.weak ? " weak" : "",
                         pixel.saturated ? " saturated" : "");
}

class Demonstrator : public testing::Test {
 protected:
  Demonstrator() {
    Verilated::threadContextp(&context_);
    context_.randReset(2);  // memories and registers without a reset start random
    context_.randSeed(static_cast<int>(test_seed() % 0x7FFFFFFFU) + 1);
    const char* program = "demonstrator";  // the RTL looks for +sram_report
    context_.commandArgs(1, &program);
    model_ = make_demonstrator(context_);
    parameters_ = ReadoutParameters::defaults(model_->readout(), kNp);
    photons_ = GeneratedPhotons(kNp, model_->columns(), kRows);
  }
  void TearDown() override { write_coverage(context_); }

  // Words of the next whole frame on the serial line.
  std::vector<std::uint64_t> receive_frame() {
    constexpr std::uint64_t kFirst = std::uint64_t{1} << 61U;
    constexpr std::uint64_t kLast = std::uint64_t{1} << 62U;
    std::vector<std::uint64_t> words;
    for (std::uint64_t clocks = 0; clocks < kFrameClocks; ++clocks) {
      const std::optional<std::uint8_t> byte = receiver_.clock(model_->clock(sender_.clock()));
      if (!byte) {
        continue;
      }
      const bool first_byte = (*byte & 0x80U) != 0;
      EXPECT_EQ(first_byte, bytes_ == 0);
      word_ |= std::uint64_t{*byte & 0x7FU} << (7U * static_cast<unsigned>(bytes_));
      if (++bytes_ < kWordBytes) {
        continue;
      }
      EXPECT_EQ((word_ & kFirst) != 0, words.empty());
      words.push_back(word_ & ~(kFirst | kLast));
      const bool last = (word_ & kLast) != 0;
      word_ = 0;
      bytes_ = 0;
      if (last) {
        EXPECT_EQ(model_->light(), ++frames_ % 2 == 1);
        return words;
      }
    }
    ADD_FAILURE() << "no frame in " << kFrameClocks << " clocks";
    return words;
  }

  // The frame as the driver places it.
  std::vector<Pixel> receive_pixels() {
    const std::vector<std::uint64_t> words = receive_frame();
    dtof_device device{};
    device.columns = static_cast<std::uint16_t>(model_->columns());
    device.rows = kRows;
    std::vector<dtof_result> results(pixel_count());
    EXPECT_EQ(dtof_unpack_frame(&device, words.data(), words.size(), results.data()), DTOF_OK);
    std::vector<Pixel> pixels;
    for (const dtof_result& result : results) {
      EXPECT_FALSE(result.masked);
      EXPECT_EQ(result.empty, result.confidence == 0);
      EXPECT_EQ(result.valid, !result.weak && !result.empty);
      pixels.push_back(
          {result.row, result.column, result.position, result.confidence, result.weak, result.saturated});
    }
    return pixels;
  }

  // What the model makes of the next frame's photons.
  std::vector<Pixel> expected_pixels() {
    const std::vector<ColumnStream> streams = photons_.acquire(kAcquisitions);
    const bool counts = !is_pool_readout(parameters_.readout);
    const int full = (1 << parameters_.confidence_width) - 1;
    const std::vector<std::vector<PixelResult>> results =
        make_readout_model(parameters_)->run_columns(streams, kAcquisitions);
    std::vector<Pixel> pixels(pixel_count());
    for (std::size_t i = 0; i < streams.size(); ++i) {
      const auto column = static_cast<int>(i);
      for (int row = 0; row < kRows; ++row) {
        const PixelResult& result = results[i][static_cast<std::size_t>(row)];
        pixels[static_cast<std::size_t>(row) * streams.size() + i] = {
            row,
            column,
            (result.code << parameters_.fraction_bits) + result.fraction,
            result.confidence,
            result.confidence < kWeakBelow,
            counts && result.confidence == full};
      }
    }
    return pixels;
  }

  [[nodiscard]] std::size_t pixel_count() const {
    return static_cast<std::size_t>(model_->columns()) * kRows;
  }
  [[nodiscard]] int code(const Pixel& pixel) const { return pixel.position >> parameters_.fraction_bits; }

  // Pixels whose code is at most `reach` beside their target.
  std::size_t near_targets(const std::vector<Pixel>& pixels, int reach) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      count += std::abs(code(pixels[i]) - photons_.targets()[i]) <= reach ? 1U : 0U;
    }
    return count;
  }

  void set_target(std::size_t pixel, int code) {
    const auto bits = static_cast<unsigned>(code);
    sender_.push(std::array{static_cast<std::uint8_t>(0x80U | pixel), static_cast<std::uint8_t>(bits >> 7U),
                            static_cast<std::uint8_t>(bits & 0x7FU)});
    if (pixel < pixel_count()) {
      photons_.targets()[pixel] = code;
    }
  }

  VerilatedContext context_;
  std::unique_ptr<DemonstratorModel> model_;
  ReadoutParameters parameters_;
  GeneratedPhotons photons_{kNp, 1, kRows};
  SerialReceiver receiver_{kClocksPerBit};
  SerialSender sender_{kClocksPerBit};
  std::uint64_t word_ = 0;
  int bytes_ = 0;
  int frames_ = 0;
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

TEST_F(Demonstrator, DepthsAreTheModels) {
  for (int frame = 0; frame < 2; ++frame) {
    SCOPED_TRACE(testing::Message() << "frame " << frame);
    const std::vector<Pixel> pixels = receive_pixels();
    ASSERT_EQ(pixels, expected_pixels());
    // Behind the reset each pixel has a depth of its own. The group of a pool read-out, which has all pixels
    // here, can find as many of them as it has candidates.
    EXPECT_GE(near_targets(pixels, 8), is_pool_readout(parameters_.readout)
                                           ? static_cast<std::size_t>(parameters_.pool.labels)
                                           : pixel_count() - pixel_count() / 16);
  }
}

TEST_F(Demonstrator, TargetsChangeOverTheSerialLine) {
  const std::vector<Pixel> ramp = receive_pixels();
  ASSERT_EQ(ramp, expected_pixels());

  sender_.push(std::array<std::uint8_t, 2>{0x80 | 9, 3});  // a byte is missing: no command
  for (std::size_t pixel = 0; pixel < pixel_count();
       ++pixel) {  // steps from column to column, planes down them
    const auto columns = static_cast<std::size_t>(model_->columns());
    set_target(pixel, 880 - 60 * static_cast<int>(pixel % columns) + 3 * static_cast<int>(pixel / columns));
  }
  set_target(pixel_count(), 500);  // no such pixel
  // Targets change during the second frame, which only takes its random numbers from the model.
  (void)receive_frame();
  ASSERT_TRUE(sender_.idle());
  (void)expected_pixels();

  const std::vector<Pixel> changed = receive_pixels();
  ASSERT_EQ(changed, expected_pixels());
  EXPECT_GE(near_targets(changed, 8), pixel_count() - pixel_count() / 16);
  EXPECT_NE(changed, ramp);
}

}  // namespace
}  // namespace dtof
