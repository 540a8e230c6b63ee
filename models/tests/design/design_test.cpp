// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/design.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <ranges>
#include <set>

#include "dtof/core/error.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

DesignRequest small_request() {
  DesignRequest request;
  request.bench.sensor = parse_preset("thesis");
  request.bench.sensor.columns = 36;
  request.bench.sensor.rows = 16;
  request.bench.sensor.acquisitions = 300;
  request.bench.scenes = {Scene::kRoom};
  request.bench.klux = {20.0};
  request.frames = 2;
  return request;
}

TEST(Design, SearchesLegalParametersOfEveryReadoutWithTheDefaultsAmongThem) {
  const SensorModel sensor = parse_preset("thesis");
  const std::vector<ReadoutParameters> found = searched_parameters(sensor);
  for (const ReadoutParameters& one : found) {
    EXPECT_NO_THROW(one.validate());
    EXPECT_EQ(one.np, sensor.np);
    EXPECT_EQ(std::ranges::count(found, one), 1) << one.to_string();
  }
  for (const Readout readout : kRtlReadouts) {
    EXPECT_EQ(std::ranges::count(found, default_parameters(readout, sensor)), 1) << readout_name(readout);
  }
}

TEST(Design, NoPoolReadoutForASensorOfTooFewBits) {
  SensorModel sensor = parse_preset("thesis");
  sensor.np = 6;
  for (const ReadoutParameters& one : searched_parameters(sensor)) {
    EXPECT_FALSE(is_pool_readout(one.readout));
  }
}

TEST(Design, OptionsAskForTheParametersThatDiffer) {
  const SensorModel sensor = parse_preset("thesis");
  ReadoutParameters parameters = default_parameters(Readout::kSifh, sensor);
  EXPECT_EQ(command_options(parameters, sensor), "--readout sifh");
  parameters.nb = 5;
  parameters.slots = 1;
  parameters.window_centred = true;
  EXPECT_EQ(command_options(parameters, sensor), "--readout sifh --nb 5 --slots 1 --window-centred");
  ReadoutParameters pool = default_parameters(Readout::kPoolPointer, sensor);
  pool.pool.group_size = 8;
  pool.pool.labels = 4;
  pool.pool.engine_columns = 100;
  EXPECT_EQ(command_options(pool, sensor),
            "--readout poolpointer --group-size 8 --labels 4 --engine-columns 100");
}

TEST(Design, PointersAreInAMemoryOfOnePortWhereSlotsAllowThat) {
  const SensorModel sensor = parse_preset("thesis");
  const auto chosen = [&](Readout readout, int slots) {
    return arrays_for(default_parameters(readout, with_slots(sensor, slots)), with_slots(sensor, slots),
                      330e6)
        .front();
  };
  const ArrayChoice one = chosen(Readout::kEzPointer, 2);
  EXPECT_EQ(one.pointer_ports, 1);
  EXPECT_EQ(product_options(one, sensor), "--readout ezpointer --pointer-ports 1");
  ArrayChoice two = one;
  two.pointer_ports = 2;
  EXPECT_EQ(product_options(two, sensor), "--readout ezpointer");
  EXPECT_LT(estimate_cost(one).mm2, 0.5 * estimate_cost(two).mm2) << "reports/area.md: 0.61 and 1.32 mm2";
  EXPECT_EQ(chosen(Readout::kHisPointer, 1).pointer_ports, 2);
  EXPECT_EQ(chosen(Readout::kSifh, 2).pointer_ports, 2) << "has no pointers";
}

TEST(Design, AnArrayThatIsTooWideForTheClockIsCut) {
  SensorModel sensor = parse_preset("thesis");
  const ReadoutParameters parameters = default_parameters(Readout::kSifh, sensor);
  EXPECT_EQ(arrays_for(parameters, sensor, 330e6).front().arrays, 1);
  const double whole = estimate_cost(arrays_for(parameters, sensor, 330e6).front()).mm2;
  sensor.columns = 600;
  const ArrayChoice cut = arrays_for(parameters, sensor, 330e6).front();
  EXPECT_GT(cut.arrays, 1);
  EXPECT_GE(cut.arrays * cut.columns, 600);
  EXPECT_GE(estimate_cost(cut).fmax_mhz, 330.0);
  EXPECT_NEAR(estimate_cost(cut).mm2 / whole, 3.0, 0.05);
  EXPECT_EQ(arrays_for(parameters, sensor, 1e6).front().arrays, 1) << "a slow clock takes any width";
  EXPECT_EQ(arrays_for(parameters, sensor, 1e9).front().columns, 200) << "no array is fast enough";
}

TEST(Design, SeveralColumnsShareAnSramWhereTheFrameHasTime) {
  const SensorModel sensor = parse_preset("thesis");
  const ReadoutParameters parameters = default_parameters(Readout::kEzPointer, sensor);
  const std::vector<ArrayChoice> arrays = arrays_for(parameters, sensor, 330e6);
  ASSERT_EQ(arrays.size(), 8U);
  EXPECT_EQ(arrays.front().columns_per_sram, 1);
  for (std::size_t i = 1; i < arrays.size(); ++i) {
    EXPECT_EQ(arrays[i].rows, 160 * arrays[i].columns_per_sram);
    EXPECT_EQ(arrays[i].columns, (200 + arrays[i].columns_per_sram - 1) / arrays[i].columns_per_sram);
    EXPECT_LT(estimate_cost(arrays[i]).mm2, estimate_cost(arrays[i - 1]).mm2);
  }
  EXPECT_EQ(product_options(arrays[3], sensor), "--readout ezpointer --pointer-ports 1 --columns-per-sram 4");
  EXPECT_EQ(arrays_for(default_parameters(Readout::kPoolPointer, sensor), sensor, 330e6).size(), 1U);
  SensorModel narrow = sensor;
  narrow.columns = 3;
  EXPECT_EQ(arrays_for(parameters, narrow, 330e6).size(), 3U);
  SensorModel tall = sensor;
  tall.rows = 2000;
  EXPECT_EQ(arrays_for(parameters, tall, 330e6).size(), 2U) << "dtof_subsystem numbers 4,096 rows";
}

// An SRAM of 30,720 words is too slow for 330 MHz.
TEST(Design, AnSramLimitsTheClock) {
  const SensorModel sensor = parse_preset("thesis");
  const ReadoutParameters parameters = default_parameters(Readout::kHisPointer, sensor);
  for (const ArrayChoice& array : arrays_for(parameters, sensor, 1e6)) {
    const bool is_fast = array.rows << parameters.nb < 30720;
    EXPECT_EQ(estimate_cost(array).fmax_mhz >= 330.0, is_fast) << array.columns_per_sram;
  }
}

// The synthesised array of 480 rows reaches 305 MHz (reports/scale.md): poolPointer's path goes on behind the
// SRAM.
TEST(Design, AnSramOfManyRowsLimitsTheClockOfPoolPointer) {
  const auto fmax = [](int rows) {
    return estimate_cost({.parameters = ReadoutParameters::defaults(Readout::kPoolPointer), .rows = rows})
        .fmax_mhz;
  };
  EXPECT_GT(fmax(160), 350.0);
  EXPECT_NEAR(fmax(480), 305.0, 10.0);
  EXPECT_NEAR(fmax(1024), 285.0, 10.0);
}

// Two engines of 100 columns were synthesised at 350 MHz, one of 200 at 208.
TEST(Design, AWideEngineLimitsTheClock) {
  SensorModel sensor = parse_preset("thesis");
  const auto widest = [&] {
    int found = 0;
    for (const ReadoutParameters& one : searched_parameters(sensor)) {
      found = std::max(found, is_pool_readout(one.readout) ? one.pool.engine_columns : 0);
    }
    return found;
  };
  EXPECT_EQ(widest(), 100);
  sensor.columns = 320;
  EXPECT_EQ(widest(), 80) << "four equal engines";
  sensor.columns = 64;
  EXPECT_EQ(widest(), 64);
  ArrayChoice array{.parameters = ReadoutParameters::defaults(Readout::kPoolPointerLean)};
  array.parameters.pool.engine_columns = 100;
  EXPECT_GT(estimate_cost(array).fmax_mhz, 350.0);
  array.parameters.pool.engine_columns = 200;
  EXPECT_NEAR(estimate_cost(array).fmax_mhz, 208.0, 2.0);
}

// With 8 columns an engine of 18 and one of 36 columns are the same hardware.
TEST(Design, FewColumnsKeepTheReadOutsOwnEngine) {
  SensorModel sensor = parse_preset("thesis");
  const auto widths = [&] {
    std::set<int> found;
    for (const ReadoutParameters& one : searched_parameters(sensor)) {
      if (one.readout == Readout::kPoolPointer) {
        found.insert(one.pool.engine_columns);
      }
    }
    return found;
  };
  const int own = default_parameters(Readout::kPoolPointer, sensor).pool.engine_columns;
  sensor.columns = 8;
  EXPECT_THAT(widths(), ElementsAre(own));
  sensor.columns = own;
  EXPECT_THAT(widths(), Contains((own / 2 + 1) / 2 * 2));
}

// At 30 frames/s 300 acquisitions leave time for one engine, at 6,000 frames/s they do not.
TEST(Design, AnEngineServesAsManyColumnsAsTheFrameHasTimeFor) {
  DesignRequest request = quick_design(small_request());
  request.bench.sensor.columns = 100;
  const auto widths = [&] {
    std::set<int> found;
    for (const DesignOption& option : run_design(request).options) {
      if (is_pool_readout(option.candidate.readout())) {
        found.insert(option.candidate.array.parameters.pool.engine_columns);
      }
    }
    return found;
  };
  EXPECT_THAT(widths(), ElementsAre(100));
  request.limits.budget.frames_per_s = 6000.0;
  EXPECT_THAT(widths(), AllOf(Not(testing::IsEmpty()), Not(Contains(100))));
}

// Candidates are compared with the read-out's own engine, as if a wider one were no worse.
TEST(Design, AWiderEngineHasNoMoreErrors) {
  SensorModel sensor = small_request().bench.sensor;
  sensor.columns = 102;
  sensor.rows = 32;
  const ReadoutParameters own = default_parameters(Readout::kPoolPointer, sensor);
  ReadoutParameters wide = own;
  wide.pool.engine_columns = 102;
  ReadoutParameters narrow = own;
  narrow.pool.engine_columns = 16;
  EXPECT_EQ(compared_parameters(wide), own);
  EXPECT_EQ(compared_parameters(narrow), narrow);
  const std::vector<ReadoutScore> scores =
      run_bench({.sensor = sensor, .klux = {50.0}}, std::vector{own, wide}, {.frames = 8});
  const Estimate& of_own = scores[0].worst().above_3_percent;
  const Estimate& of_wide = scores[1].worst().above_3_percent;
  EXPECT_GT(of_own.value, 0.01);
  EXPECT_LE(of_wide.value, of_own.value);
}

TEST(Design, OptionsWithEqualParametersAreReadOnce) {
  const SensorModel sensor = small_request().bench.sensor;
  const ReadoutParameters one = default_parameters(Readout::kEzPointer, sensor);
  const ReadoutParameters other = default_parameters(Readout::kSifh, sensor);
  EXPECT_THAT(distinct_readouts(std::vector{one, other, one}), ElementsAre(one, other));
  const BenchSettings bench = small_request().bench;
  const std::vector<ReadoutScore> twice = run_bench(bench, std::vector{one, other, one}, {});
  ASSERT_EQ(twice.size(), 3U);
  EXPECT_EQ(twice[0].worst().above_3_percent.value, twice[2].worst().above_3_percent.value);
  EXPECT_NE(twice[0].worst().above_3_percent.value, twice[1].worst().above_3_percent.value);
}

TEST(Design, ATighterLimitChangesTheWinner) {
  DesignRequest request = small_request();
  const DesignResult free = run_design(request);
  ASSERT_TRUE(free.recommendation.chosen);
  const DesignOption& first = free.options[*free.recommendation.chosen];
  EXPECT_TRUE(is_pool_readout(first.candidate.readout()) ||
              first.candidate.readout() == Readout::kCoarseHistogram);
  double least = first.candidate.cost.mm2;
  for (const DesignOption& option : free.options) {
    least = std::min(least, option.candidate.cost.mm2);
  }
  ASSERT_LT(least, first.candidate.cost.mm2);
  request.limits.most_mm2 = 1.0001 * least;
  const DesignResult tight = run_design(request);
  ASSERT_TRUE(tight.recommendation.chosen);
  EXPECT_LE(tight.options[*tight.recommendation.chosen].candidate.cost.mm2, request.limits.most_mm2);
  ASSERT_FALSE(tight.left_out.empty());
  EXPECT_THAT(tight.left_out.front().reason, HasSubstr("needs --max-mm2 "));
  EXPECT_EQ(tight.consequences.size(), 6U);
  EXPECT_EQ(tight.consequences[0].recommendation.chosen, std::nullopt) << "nothing is smaller still";
}

TEST(Design, EveryOptionThatIsRecommendedHasItsFinalScore) {
  DesignRequest request = small_request();
  request.limits.most_mm2 = 0.3;
  const DesignResult found = run_design(request);
  for (const std::size_t i : found.recommendation.within) {
    ASSERT_TRUE(found.options[i].score);
    EXPECT_LE(found.options[i].candidate.cost.mm2, 0.3);
  }
  for (const DesignResult::Consequence& one : found.consequences) {
    for (const std::size_t i : one.recommendation.within) {
      EXPECT_TRUE(found.options[i].score) << one.change.name;
    }
  }
}

// Coarse histogram and hisPointer 1 are 10 % apart in nearly equal arrays: 7 frames cannot tell.
TEST(Design, ContendersAreReadInMoreFramesUntilTheChoiceIsSettled) {
  DesignRequest request = small_request();
  request.bench.sensor.signal_events_1m *= 40.0;
  request.contest_work = 2e6;  // fewer frames than before
  const DesignResult without = run_design(request);
  EXPECT_FALSE(without.settled);
  EXPECT_EQ(without.contest_frames, 0);
  request.contest_work = 4e9;
  const DesignResult found = run_design(request);
  EXPECT_TRUE(found.settled);
  EXPECT_EQ(found.contest_frames, 4 * found.frames);
  const std::vector<DesignOption>& options = found.options;
  const LightScore& best = options[found.recommendation.within.front()].best_known().worst();
  EXPECT_EQ(best.above_3_of_frames.size(), static_cast<std::size_t>(found.contest_frames));
  EXPECT_TRUE(best.detected) << "P_d is that of the first frames";
  const LightScore& last = options[found.recommendation.within.back()].best_known().worst();
  EXPECT_EQ(last.above_3_of_frames.size(), static_cast<std::size_t>(found.frames)) << "no contender";
  const LightScore& before = without.options[found.recommendation.within.front()].best_known().worst();
  EXPECT_TRUE(
      std::ranges::equal(before.above_3_of_frames, best.above_3_of_frames | std::views::take(found.frames)))
      << "the contest begins with the same frames";
}

// More than 10,000 such frames would fit a budget that counts pixels alone.
TEST(Design, AContestOfOnePixelIsShort) {
  DesignRequest request = small_request();
  request.bench.sensor.columns = 1;
  request.bench.sensor.rows = 1;
  request.bench.sensor.acquisitions = 20;
  request.bench.scenes = {Scene::kRoom, Scene::kPoles};
  request.bench.klux = {2.0, 50.0};
  request.contest_work = 1e7;
  request.detection = false;
  const DesignResult found = run_design(request);
  EXPECT_FALSE(found.settled);
  EXPECT_EQ(found.contest_frames, 0) << "at most 25 frames for two contenders in two lights";
}

TEST(Design, AReadoutWhoseMemoryCannotBeMadeIsLeftOut) {
  DesignRequest request = small_request();
  request.bench.sensor.np = 16;
  request.bench.sensor.rows = 400;
  request.bench.sensor.columns = 2;
  request.bench.sensor.acquisitions = 20;
  request.limits.most_mm2 = 0.05;
  const DesignResult found = run_design(request);
  const auto histogram = std::ranges::find(found.left_out, Readout::kHistogram, &LeftOut::readout);
  ASSERT_NE(histogram, found.left_out.end());
  EXPECT_THAT(histogram->reason, HasSubstr("memories that cannot be made"));
}

TEST(Design, LimitsThatNobodyKeepsAreOneLine) {
  DesignRequest request = small_request();
  request.limits.most_mm2 = 1e-3;
  EXPECT_THAT([&] { run_design(request); },
              ThrowsMessage<InputError>(HasSubstr("one of these would do: --max-mm2")));
}

TEST(Design, AFrameThatDoesNotFitHasItsWaysOut) {
  for (const auto& [columns, rows, np] : {std::array{64, 48, 12}, std::array{1024, 1024, 10}}) {
    DesignRequest request = small_request();
    request.bench.sensor.columns = columns;
    request.bench.sensor.rows = rows;
    request.bench.sensor.np = np;
    request.bench.sensor.acquisitions = 3333;
    request.limits.budget.frames_per_s = 8000.0;
    EXPECT_THAT([&] { run_design(request); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("one of these would do: --frame-rate "),
                                                HasSubstr("a frame of 3333 acquisitions takes "),
                                                HasSubstr("What would, one of: "), HasSubstr(" acquisitions"),
                                                HasSubstr(" MHz"))));
    request.limits.most_mm2 = 1e-3;  // no frame rate alone would do
    EXPECT_THAT([&] { run_design(request); },
                ThrowsMessage<InputError>(Not(HasSubstr("What would, one of: "))));
  }
}

TEST(Design, FewerSlotsAreTakenOnlyWhereMoreDoNotFit) {
  DesignRequest request = small_request();
  for (const DesignOption& option : run_design(request).options) {
    EXPECT_EQ(option.candidate.array.parameters.slots, 2);
  }
  request.limits.budget.frames_per_s = 40'000.0;  // of 330 MHz: two SLOTS leave no read-out as many
  const DesignResult found = run_design(request);
  for (const std::size_t i : found.recommendation.within) {
    EXPECT_EQ(found.options[i].candidate.array.parameters.slots, 1);
    EXPECT_GE(found.options[i].candidate.frames_per_s(330e6), 40'000.0);
  }
  EXPECT_TRUE(found.recommendation.chosen);
}

}  // namespace
}  // namespace dtof
