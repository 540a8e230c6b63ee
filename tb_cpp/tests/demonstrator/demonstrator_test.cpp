// SPDX-License-Identifier: Apache-2.0
// The very top of the FPGA demonstrator or of the shuttle chip, from its serial line alone: what comes out is
// what the model makes of the same photons. Linked with the Verilated RTL or with the Verilated netlist.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include <algorithm>
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
constexpr std::uint32_t kAcquisitions = 1000;
constexpr int kWeakBelow = 2;
constexpr int kWordBytes = 9;

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
    photons_ = GeneratedPhotons(kNp, model_->columns(), model_->rows());
    receiver_ = SerialReceiver(model_->clocks_per_bit());
    sender_ = SerialSender(model_->clocks_per_bit());
  }
  void TearDown() override { write_coverage(context_); }

  // Words of the next whole frame on the serial line.
  std::vector<std::uint64_t> receive_frame() {
    constexpr std::uint64_t kFirst = std::uint64_t{1} << 61U;
    constexpr std::uint64_t kLast = std::uint64_t{1} << 62U;
    std::vector<std::uint64_t> words;
    for (std::uint64_t clocks = 0; clocks < frame_clocks(); ++clocks) {
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
    ADD_FAILURE() << "no frame in " << frame_clocks() << " clocks";
    return words;
  }

  // The frame as the driver places it.
  std::vector<Pixel> receive_pixels() {
    const std::vector<std::uint64_t> words = receive_frame();
    dtof_device device{};
    device.columns = static_cast<std::uint16_t>(model_->columns());
    device.rows = static_cast<std::uint16_t>(model_->rows());
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
      for (int row = 0; row < model_->rows(); ++row) {
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

  // Twice the clocks of a frame: each row of an acquisition takes a few clocks more than it has columns, then
  // the words leave over the serial line.
  [[nodiscard]] std::uint64_t frame_clocks() const {
    constexpr std::uint64_t kBitsOfAByte = 10;
    const auto rows = static_cast<std::uint64_t>(model_->rows());
    const auto columns = static_cast<std::uint64_t>(model_->columns());
    const auto bits = pixel_count() * kWordBytes * kBitsOfAByte;
    return 2 * (kAcquisitions * rows * (columns + 8) +
                bits * static_cast<std::uint64_t>(model_->clocks_per_bit()));
  }
  [[nodiscard]] std::size_t pixel_count() const {
    return static_cast<std::size_t>(model_->columns()) * static_cast<std::size_t>(model_->rows());
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

  // Pixels that are near their targets at least. ezPointer needs more photons than these frames have.
  [[nodiscard]] std::size_t most_pixels() const {
    return parameters_.readout == Readout::kEzPointer ? pixel_count() / 2
                                                      : pixel_count() - pixel_count() / 16;
  }

  void set_target(std::size_t pixel, int code) {
    const auto bits = static_cast<unsigned>(code);
    const auto number = bits | static_cast<unsigned>(pixel >> 7U) << static_cast<unsigned>(kNp);
    sender_.push(std::array{static_cast<std::uint8_t>(0x80U | (pixel & 0x7FU)),
                            static_cast<std::uint8_t>(number >> 7U),
                            static_cast<std::uint8_t>(number & 0x7FU)});
    if (pixel < pixel_count()) {
      photons_.targets()[pixel] = code;
    }
  }

  VerilatedContext context_;
  std::unique_ptr<DemonstratorModel> model_;
  ReadoutParameters parameters_;
  GeneratedPhotons photons_{kNp, 1, 1};
  SerialReceiver receiver_{1};
  SerialSender sender_{1};
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
    // Behind the reset each pixel has a depth of its own. The group of a pool read-out can find as many of
    // them as it has candidates.
    EXPECT_GE(near_targets(pixels, 8), is_pool_readout(parameters_.readout)
                                           ? static_cast<std::size_t>(parameters_.pool.labels)
                                           : most_pixels());
  }
}

TEST_F(Demonstrator, TargetsChangeOverTheSerialLine) {
  const std::vector<Pixel> ramp = receive_pixels();
  ASSERT_EQ(ramp, expected_pixels());

  sender_.push(std::array<std::uint8_t, 2>{0x80 | 9, 3});  // a byte is missing: no command
  for (std::size_t pixel = 0; pixel < pixel_count();
       ++pixel) {  // steps from column to column, planes down them
    const auto columns = static_cast<std::size_t>(model_->columns());
    const int step = std::min(60, 800 / model_->columns());
    set_target(pixel, 880 - step * static_cast<int>(pixel % columns) + 3 * static_cast<int>(pixel / columns));
  }
  set_target(pixel_count(), 500);  // no such pixel
  // Targets change during the second frame, which only takes its random numbers from the model.
  (void)receive_frame();
  ASSERT_TRUE(sender_.idle());
  (void)expected_pixels();

  const std::vector<Pixel> changed = receive_pixels();
  ASSERT_EQ(changed, expected_pixels());
  EXPECT_GE(near_targets(changed, 8), most_pixels());
  EXPECT_NE(changed, ramp);
}

}  // namespace
}  // namespace dtof
