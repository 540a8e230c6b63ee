// SPDX-License-Identifier: Apache-2.0
#include "design_judgement/random_sensor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(RandomSensor, IsTheSameForASeedAndNumber) {
  const RandomSensor one = draw_sensor(1, 3, {});
  EXPECT_EQ(draw_sensor(1, 3, {}).toml, one.toml);
  EXPECT_EQ(draw_sensor(1, 3, {}).options, one.options);
  EXPECT_NE(draw_sensor(1, 4, {}).toml, one.toml);
  EXPECT_NE(draw_sensor(2, 3, {}).toml, one.toml);
  EXPECT_EQ(one.request.bench.sensor.name, "random_03");
}

TEST(RandomSensor, KeepsItsRangesAndSuitsAReadout) {
  const SensorRanges ranges{.most_columns = 40, .most_rows = 30, .most_acquisitions = 900};
  std::set<std::string> limits;
  for (int number = 1; number <= 20; ++number) {
    const RandomSensor drawn = draw_sensor(1, number, ranges);
    const SensorModel& sensor = drawn.request.bench.sensor;
    EXPECT_GE(sensor.columns, kLeastColumns);
    EXPECT_LE(sensor.columns, ranges.most_columns);
    EXPECT_GE(sensor.rows, kLeastRows);
    EXPECT_LE(sensor.rows, ranges.most_rows);
    EXPECT_GE(sensor.acquisitions, kLeastAcquisitions);
    EXPECT_LE(sensor.acquisitions, ranges.most_acquisitions);
    EXPECT_GE(sensor.np, 8);
    EXPECT_LE(sensor.np, 12);
    EXPECT_LE(sensor.pulse_fwhm_s, sensor.integration_time_s / 12.0 * 1.01);
    const std::vector<DesignCandidate> grid = design_candidates(drawn.request);
    const std::size_t kept = kept_of(grid, drawn.request.limits).size();
    EXPECT_GE(kept, 1U) << drawn.options;
    EXPECT_LE(kept, grid.size());
    limits.insert(drawn.options.substr(0, drawn.options.find(' ')));
  }
  EXPECT_EQ(limits, (std::set<std::string>{"", "--max-mm2", "--max-mw", "--frame-rate"}));
}

TEST(RandomSensor, TheGridHasEverySlotsAndTheCostsOfTheSearch) {
  DesignRequest request;
  request.bench.sensor = parse_preset("thesis");
  request.bench.sensor.columns = 20;
  request.bench.sensor.rows = 16;
  request.bench.sensor.acquisitions = 50;
  request.bench.scenes = {Scene::kRoom};
  request.bench.klux = {20.0};
  request.frames = 2;
  const std::vector<DesignCandidate> grid = design_candidates(request);
  std::vector<ReadoutParameters> compared;
  std::ranges::transform(searched_parameters(request.bench.sensor), std::back_inserter(compared),
                         compared_parameters);
  EXPECT_EQ(smallest_of_each(grid).size(), distinct_readouts(compared).size());
  EXPECT_GT(
      std::ranges::count_if(grid, [](const DesignCandidate& c) { return c.array.parameters.slots == 1; }),
      static_cast<std::ptrdiff_t>(grid.size() / 3));
  const DesignResult result = run_design(request);
  EXPECT_EQ(result.searched, grid.size());
  for (const DesignOption& option : result.options) {
    const auto found = std::ranges::find_if(grid, [&](const DesignCandidate& c) {
      return c.array.parameters == option.candidate.array.parameters &&
             c.array.columns_per_sram == option.candidate.array.columns_per_sram;
    });
    ASSERT_NE(found, grid.end());
    EXPECT_EQ(found->cost.mm2, option.candidate.cost.mm2);
    EXPECT_EQ(found->mw(330e6), option.candidate.mw(330e6));
    EXPECT_EQ(found->clocks, option.candidate.clocks);
  }
}

TEST(RandomSensor, ALineAndTheFileDescribeIt) {
  EXPECT_THAT(
      sensor_line(parse_preset("thesis")),
      StartsWith("200 x 160, NP 10, 2 SLOTS, 45 ns in bins of 43.9 ps, pulse 2 ns, 3333 acquisitions"));
  EXPECT_THAT(draw_sensor(1, 1, {}).toml, HasSubstr("[laser]\nacquisitions = "));
  EXPECT_THAT(ranges_text({.most_columns = 50}), HasSubstr("columns 16 to 50, "));
}

}  // namespace
}  // namespace dtof
