// SPDX-License-Identifier: Apache-2.0
#include "scenes/scenes_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace dtof {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

ErrorShares shares(double above_3_percent, double above_10_percent) {
  ErrorShares shares{};
  shares.pixels = 100;
  shares.above_3_percent = above_3_percent;
  shares.above_10_percent = above_10_percent;
  shares.rmse = above_10_percent / 2.0;
  return shares;
}

EstimatorResult estimator(double share, double error_over_bound) {
  EstimatorResult result{{}, error_over_bound};
  result.score.all = shares(0.04 * share, 0.02 * share);
  result.score.edges = shares(0.4 * share, 0.2 * share);
  result.score.rest = shares(0.03 * share, 0.01 * share);
  result.score.singles = shares(0.8 * share, 0.6 * share);
  result.score.removed = {0.1, 0.2, 0.25 * share, 0.5, 0.6, 0.7, 0.8};
  return result;
}

ScenesResults made_up_scenes() {
  const LightResults light = {14.0,
                              "thesis",
                              "No table.",
                              {"hisPointer", "poolPointer"},
                              {{"planes", {estimator(1.0, 1.5), estimator(0.5, 0.75)}},
                               {"room", {estimator(1.0, std::nan("")), estimator(0.0, std::nan(""))}}}};
  return {.seed = 7,
          .columns = 20,
          .notes = {"Scene map: resampled."},
          .lights = {light},
          .command_line = "the command"};
}

TEST(ScenesReport, ThePageOfALight) {
  const std::string page = page_text("scenes", scenes_page(made_up_scenes()));
  EXPECT_THAT(page, HasSubstr("# Read-outs on scenes\n\nPixels with a relative error above 3 % / above 10 %, "
                              "in %. Seed 7, at most 20 columns of a scene. \"hisPointer pairs\""));
  EXPECT_THAT(page, EndsWith(R"(Scenes "held": no parameter of poolPointer was chosen on them.

Command: `the command`

Scene map: resampled.

## 14 klux, sensor thesis

No table.

### All pixels: above 3 % / 10 %

| scene  |  hisPointer | poolPointer |
|--------|------------:|------------:|
| planes | 4.00 / 2.00 | 2.00 / 1.00 |
| room   | 4.00 / 2.00 | 0.00 / 0.00 |

### Pixels at depth edges

| scene  |    hisPointer |   poolPointer |
|--------|--------------:|--------------:|
| planes | 40.00 / 20.00 | 20.00 / 10.00 |
| room   | 40.00 / 20.00 |   0.00 / 0.00 |

### Other pixels

| scene  |  hisPointer | poolPointer |
|--------|------------:|------------:|
| planes | 3.00 / 1.00 | 1.50 / 0.50 |
| room   | 3.00 / 1.00 | 0.00 / 0.00 |

### Pixels unlike all their neighbours: above 10 %

| scene  | hisPointer | poolPointer |
|--------|-----------:|------------:|
| planes |      60.00 |       30.00 |
| room   |      60.00 |        0.00 |

### Relative rmse, %

| scene  | hisPointer | poolPointer |
|--------|-----------:|------------:|
| planes |       1.00 |        0.50 |
| room   |       1.00 |        0.00 |

### Median error over the single pixel's bound

| scene  | hisPointer | poolPointer |
|--------|-----------:|------------:|
| planes |       1.50 |        0.75 |

### Outliers (above 10 %) removed by dropping the 5 % of lowest confidence, %

| scene  | hisPointer | poolPointer |
|--------|-----------:|------------:|
| planes |         25 |          12 |
| room   |         25 |           0 |

### Gain by pooling, flats and slanted planes

| scene  | above 3 %, hisPointer / poolPointer | above 10 % | rmse | median error over bound: hisPointer | poolPointer |
|--------|------------------------------------:|-----------:|-----:|------------------------------------:|------------:|
| planes |                                 2.0 |        2.0 |  2.0 |                                1.50 |        0.75 |
)"));
}

TEST(ScenesReport, GainByPoolingNeedsBothReadouts) {
  ScenesResults results = made_up_scenes();
  results.lights[0].estimators[1] = "FiFH";
  EXPECT_THAT(page_text("scenes", scenes_page(results)), Not(HasSubstr("Gain by pooling")));
}

}  // namespace
}  // namespace dtof
