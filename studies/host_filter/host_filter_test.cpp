// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "host_filter/host_filter_report.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::size_t kOnlyScene[] = {0};

/// Two columns: distances of 1 m and 2 m, and a pixel without a target.
SceneTruth step_truth() {
  return {.columns = 2,
          .rows = 3,
          .distance_m = {1.0, 2.0, 1.0, 2.0, 0.0, 2.0},
          .edge = {true, true, true, true, false, false},
          .single = {false, false, false, true, false, false}};
}

TEST(HostFilterStudy, CountsEqualHandCalculations) {
  // Within 3 %; 5 % off; between both surfaces, flying; on the other surface; not judged; 11 % off.
  const std::vector<double> measured = {1.029, 2.1, 1.5, 1.0, 9.0, 2.22};
  EXPECT_THAT(
      count_pixels(step_truth(), measured),
      ElementsAre(PixelCount{4, 5}, PixelCount{3, 5}, PixelCount{3, 4}, PixelCount{1, 1}, PixelCount{2, 4}));
}

TEST(HostFilterStudy, TakesTheMiddleOfAScene) {
  StudyScene scene{"steps", TargetMap(7, 2), 7};
  for (int column = 0; column < 7; ++column) {
    scene.targets.at(column, 1).depth_m = 1.0 + column;
  }
  const StudyScene part = middle_columns(scene, 3);
  EXPECT_EQ(part.columns, 3);
  ASSERT_EQ(part.targets.columns(), 3);
  EXPECT_EQ(part.targets.at(0, 1).depth_m, 3.0);
  EXPECT_EQ(part.targets.at(2, 1).depth_m, 5.0);
  EXPECT_EQ(middle_columns(scene, 70).targets.columns(), 7);
}

TEST(HostFilterStudy, SharesAreOfAllScenesAndSeedsTogether) {
  FilterLight light(14.0, {"one", "two"}, {"a", "b"});
  const auto counts = [](std::uint64_t hits, std::uint64_t pixels) {
    FilterCounts result{};
    result[0] = {hits, pixels};
    return result;
  };
  for (const std::uint64_t seed : {0U, 2U}) {
    light.add(0, 1, false, counts(10 + seed, 100));
    light.add(1, 1, false, counts(0, 300));
    light.add(0, 1, true, counts(1, 100));
    light.add(0, 0, false, counts(0, 100));
    light.add(1, 0, false, counts(0, 300));
  }
  const std::vector<std::size_t> both = light.all_scenes();
  EXPECT_THAT(both, ElementsAre(0, 1));
  EXPECT_DOUBLE_EQ(light.estimate(both, 1, false, 0).value, 0.0275);  // 10 and 12 of 400
  EXPECT_DOUBLE_EQ(light.estimate(kOnlyScene, 1, true, 0).value, 0.01);
  EXPECT_EQ(light.pixels(both, 0), 800U);
  EXPECT_EQ(light.pixels(both, 3), 0U);
}

TEST(HostFilterStudy, AGoalIsMetOpenOrMissed) {
  EXPECT_STREQ(goal_verdict({0.004, {0.003, 0.0049}}, 0.005), "yes");
  EXPECT_STREQ(goal_verdict({0.004, {0.003, 0.0051}}, 0.005), "open");
  EXPECT_STREQ(goal_verdict({0.006, {0.0051, 0.007}}, 0.005), "**no**");
}

TEST(HostFilterStudy, AWallHasFewerErrorsAfterTheFilter) {
  HostFilterSettings settings;
  settings.sensor = find_sensor("thesis");
  settings.sensor.acquisitions = 1000;
  settings.readouts = {default_parameters(Readout::kHisPointer, settings.sensor)};
  settings.references = false;
  settings.scenes = [](std::uint64_t) {
    return std::vector<StudyScene>{{"wall", TargetMap(12, 16, {2.0, 1.0}), 12}};
  };
  settings.columns = 8;
  settings.seeds = 2;
  settings.threads = 1;
  const FilterLight light = measure_host_filter(settings, 14.0);
  EXPECT_EQ(light.pixels(kOnlyScene, 0), 2U * 8 * 16);
  EXPECT_LT(light.estimate(kOnlyScene, 0, true, 0).value,
            0.5 * light.estimate(kOnlyScene, 0, false, 0).value);
  const HostFilterReport report{
      .settings = settings, .lights = {light}, .whole = {light}, .command_line = "command"};
  const std::string page = page_text("host_filter", host_filter_page(report));
  EXPECT_THAT(page, HasSubstr("| hisPointer: 14 klux, above 3 % |"));
  EXPECT_THAT(page,
              HasSubstr("sensor thesis. The filter and its constants are the same for every read-out. The "
                        "constants were chosen on the scenes of `make pool-search`, which no report uses. "
                        "The tables have the 8 middle columns of each map. Seeds 1 to 2 set the photons and "
                        "the random shapes. +- is half of the 95 % interval over the seeds."));
  EXPECT_THAT(page,
              HasSubstr("\n## Goal\n\nWhole maps of all scenes together. The goal is met if the whole "
                        "interval is below the limit, and open if the limit is inside the interval.\n\n| "
                        "goal "));
  EXPECT_THAT(page, HasSubstr("\n## 14 klux\n\n### All scenes together\n\n| read-out "));
  EXPECT_THAT(page, HasSubstr("\n\n### Each scene: above 3 %, before / after\n\n| scene "));
  const Table csv = host_filter_csv(report);
  EXPECT_EQ(csv.cells().size(), 5U);  // before and after, of both parts
  EXPECT_TRUE(host_filter_curves(report).empty());
  settings.seeds = 1;
  EXPECT_THAT([&] { (void)measure_host_filter(settings, 14.0); },
              ThrowsMessage<InputError>(HasSubstr("needs at least 2 seeds, not 1")));
}

}  // namespace
}  // namespace dtof
