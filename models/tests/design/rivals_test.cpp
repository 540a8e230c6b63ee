// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/rivals.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "dtof/core/error.hpp"
#include "dtof/design/design.hpp"
#include "dtof/design/sram_macro.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Keeps every timestamp's count over six frames, at the memory of one word: better than any read-out.
class Cheat final : public Rival {
 public:
  [[nodiscard]] int bits_per_pixel() const override { return 1; }
  [[nodiscard]] RivalHardware hardware() const override { return {.word_bits = 1}; }
  [[nodiscard]] int host_operations() const override { return 0; }
  [[nodiscard]] int frames() const override { return 6; }
  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    RivalWords words(1024, 0);
    for (const std::span<const Detection> frame : frames) {
      for (const Detection& detection : frame) {
        ++words[detection.timestamp];
      }
    }
    words[1023] = 0;
    return words;
  }
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    constexpr std::size_t kWidth = 60;
    double best = 0.0;
    std::size_t place = 0;
    for (std::size_t begin = 0; begin + kWidth < words.size(); ++begin) {
      double sum = 0.0;
      for (std::size_t i = 0; i < kWidth; ++i) {
        sum += words[begin + i];
      }
      if (sum > best) {
        best = sum;
        place = begin;
      }
    }
    return {static_cast<double>(place) + kWidth / 2.0, best};
  }
};

/// Says the same of each pixel.
class Constant final : public Rival {
 public:
  [[nodiscard]] int bits_per_pixel() const override { return 1; }
  [[nodiscard]] RivalHardware hardware() const override { return {.word_bits = 1}; }
  [[nodiscard]] int host_operations() const override { return 0; }
  [[nodiscard]] RivalWords read_pixel(PixelFrames /*frames*/) const override { return {0}; }
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> /*words*/) const override {
    return {512.0, 3.0};
  }
};

std::unique_ptr<Rival> make_cheat(const SensorModel& /*sensor*/) { return std::make_unique<Cheat>(); }
std::unique_ptr<Rival> make_constant(const SensorModel& /*sensor*/) { return std::make_unique<Constant>(); }
std::unique_ptr<Rival> refuse(const SensorModel& /*sensor*/) { throw InputError("only for 8 bits"); }

constexpr std::array<RivalEntry, 3> kMadeUp = {{{"cheat", "cheat", "nobody", make_cheat},
                                                {"constant", "constant", "nobody", make_constant},
                                                {"refusing", "refusing", "nobody", refuse}}};

BenchSettings small_bench() {
  BenchSettings bench;
  bench.sensor = parse_preset("thesis");
  bench.sensor.columns = 36;
  bench.sensor.rows = 16;
  bench.sensor.acquisitions = 600;
  bench.scenes = {Scene::kRoom};
  bench.klux = {2.0, 20.0};
  return bench;
}

TEST(Rivals, MemoryIsThatOfTheSmallestMacros) {
  const SensorModel sensor = parse_preset("thesis");
  const RivalHardware histogram = find_rival("histogram32").make(sensor)->hardware();
  const std::optional<double> mm2 = rival_memory_mm2(histogram, sensor);
  ASSERT_TRUE(mm2);
  EXPECT_DOUBLE_EQ(*mm2, 200e-6 * sram_macro({2, 160 * 32, 8}).area_um2);
  // What sram_um2 of synth/dtof_synth/rival_area.py gives for 200 columns of 160 rows.
  EXPECT_NEAR(*mm2, 6.742112557, 1e-6);
  const RivalHardware wide{.words = 1, .word_bits = 1000};
  double least = 1e9;
  for (int macros = 1; macros <= 16; ++macros) {
    try {
      least = std::min(least, macros * sram_macro({1, 160, (1000 + macros - 1) / macros}).area_um2);
    } catch (const InputError&) {
      continue;
    }
  }
  EXPECT_DOUBLE_EQ(rival_memory_mm2(wide, sensor).value(), 200e-6 * least) << "one port for one word";
  EXPECT_NEAR(rival_memory_mm2(wide, sensor).value(), 13.0096, 1e-6) << "by the same function";
  EXPECT_EQ(rival_memory_mm2({.words = 1 << 20, .word_bits = 8}, sensor), std::nullopt);
}

TEST(Rivals, AreLeftOutWithTheReason) {
  const SensorModel sensor = parse_preset("thesis");
  const RivalChoice all = choose_rivals(all_rivals(), sensor, std::numeric_limits<double>::infinity());
  EXPECT_THAT(all.left_out, IsEmpty()) << "the thesis's sensor has a model of each rival";
  ASSERT_EQ(all.options.size(), all_rivals().size());
  const RivalChoice some = choose_rivals(all_rivals(), sensor, 1.0);
  EXPECT_EQ(some.options.size() + some.left_out.size(), all_rivals().size());
  ASSERT_FALSE(some.left_out.empty());
  for (const RivalOption& option : some.options) {
    EXPECT_LE(option.memory_mm2, 1.0) << option.entry->name;
    EXPECT_EQ(option.bits_per_pixel, option.entry->make(sensor)->bits_per_pixel());
  }
  EXPECT_EQ(some.left_out.front().entry->name, "histogram32");
  EXPECT_THAT(some.left_out.front().reason, HasSubstr("its memory alone takes "));
  const RivalChoice refused = choose_rivals(kMadeUp, sensor, 1.0);
  ASSERT_EQ(refused.left_out.size(), 1U);
  EXPECT_EQ(refused.left_out.front().reason, "only for 8 bits");
}

TEST(Rivals, ScoresAreThoseOfTheReadoutsFrames) {
  const BenchSettings bench = small_bench();
  RivalChoice choice = choose_rivals(kMadeUp, bench.sensor, 10.0);
  const BenchEffort effort{.frames = 3, .detection = true};
  std::size_t steps = 0;
  {
    Progress progress(rival_steps(bench, effort), [&](std::size_t done, std::size_t total) {
      steps = done;
      EXPECT_EQ(total, rival_steps(bench, effort));
    });
    read_rivals(bench, choice.options, effort, &progress);
  }
  EXPECT_EQ(steps, rival_steps(bench, effort));
  const ReadoutScore& cheat = choice.options[0].score;
  const ReadoutScore& constant = choice.options[1].score;
  const std::vector<ReadoutParameters> readouts = {default_parameters(Readout::kEzPointer, bench.sensor)};
  const ReadoutScore pointer = run_bench(bench, readouts, effort).front();
  EXPECT_EQ(cheat.pixels, pointer.pixels) << "the same pixels are judged";
  ASSERT_EQ(cheat.lights.size(), 2U);
  EXPECT_DOUBLE_EQ(cheat.worst().klux, 20.0);
  EXPECT_LT(cheat.worst().above_3_percent.covering().high, pointer.worst().above_3_percent.covering().low);
  EXPECT_LT(cheat.lights[0].above_10_percent.value, 0.02) << "at 2 klux nearly every pulse is found";
  EXPECT_GT(cheat.lights[0].detected->value, 0.2);
  EXPECT_LT(cheat.lights[1].false_alarms->value, 0.02) << "the threshold lets 0.1 % of another sky pass";
  EXPECT_GT(constant.worst().above_3_percent.value, 0.5);
  EXPECT_DOUBLE_EQ(constant.worst().detected->value, 0.0) << "sky has the same confidence as targets";
  EXPECT_DOUBLE_EQ(constant.worst().false_alarms->value, 0.0);
}

TEST(Rivals, ABetterRivalIsNamedAndNotRecommended) {
  DesignRequest request;
  request.bench = small_bench();
  request.bench.klux = {20.0};
  request.frames = 2;
  request.limits.most_mm2 = 0.12;
  request.rivals = kMadeUp;
  const DesignResult found = run_design(request);
  ASSERT_TRUE(found.recommendation.chosen);
  ASSERT_EQ(found.rivals.size(), 2U);
  EXPECT_EQ(found.rivals[0].entry->name, "cheat") << "best first";
  const std::vector<const RivalOption*> better = more_accurate_rivals(found);
  ASSERT_EQ(better.size(), 1U) << "the constant is no better";
  EXPECT_EQ(better[0]->entry->name, "cheat");
  request.rivals = {};
  const DesignResult without = run_design(request);
  EXPECT_THAT(without.rivals, IsEmpty());
  EXPECT_EQ(without.recommendation.chosen, found.recommendation.chosen);
}

TEST(Rivals, AQuickDesignReadsAFewPixelsAndNoRivals) {
  DesignRequest request;
  request.bench = small_bench();
  request.bench.klux = {20.0};
  request.frames = 2;
  request.limits.most_mm2 = 0.12;
  request.rivals = kMadeUp;
  std::size_t observed = 0;
  request.observer = [&](std::string_view, std::size_t, std::size_t) { ++observed; };
  const DesignRequest quick = quick_design(request);
  EXPECT_LT(quick.final_work, 0.1 * request.final_work);
  const DesignResult found = run_design(quick);
  EXPECT_THAT(found.rivals, IsEmpty());
  EXPECT_GT(observed, 0U);
  const DesignOption& chosen = found.options[*found.recommendation.chosen];
  ASSERT_TRUE(chosen.score);
  EXPECT_EQ(chosen.score->worst().detected, std::nullopt);
}

}  // namespace
}  // namespace dtof
