// SPDX-License-Identifier: Apache-2.0
#include "pool/pool_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace dtof {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

ErrorShares shares(double above_3_percent, double above_10_percent) {
  ErrorShares shares{};
  shares.pixels = 1'000'000;
  shares.above_3_percent = above_3_percent;
  shares.above_10_percent = above_10_percent;
  return shares;
}

/// Two scenes beside a flat one; a seed each, so that intervals are those of independent pixels.
PoolScores scores() {
  PoolScores scores({"flat 1 m", "planes", "held planes"},
                    {"matched filter (single pixel)", "poolPointer, no S1", "poolPointer"});
  for (std::size_t scene = 0; scene < 3; ++scene) {
    for (std::size_t estimator = 0; estimator < 3; ++estimator) {
      const double share = scene == 0 ? 0.0 : 0.006 / static_cast<double>(1 + estimator);
      SceneScore score;
      score.all = shares(share, share / 2.0);
      score.edges = shares(3.0 * share, share);
      score.rest = shares(share / 3.0, share / 6.0);
      scores.add(scene, estimator, score);
    }
  }
  return scores;
}

PoolResults made_up() {
  return {.sensor = "thesis",
          .first_seed = 3,
          .last_seed = 6,
          .look_up_table = "No table.",
          .references = true,
          .lights = {{14.0, scores()}},
          .command_line = "the command"};
}

TEST(PoolReport, ThePageOfALight) {
  const std::string page = page_text("pool", pool_page(made_up()));
  EXPECT_THAT(page,
              StartsWith("# poolPointer on scenes\n\nPercentage of pixels with a relative error above 3 % "
                         "and above 10 %, sensor thesis. Maps are read whole. Seeds 3 to 6 set the "
                         "photons and the random shapes."));
  EXPECT_THAT(page, EndsWith(R"(No parameter was chosen on a scene whose name begins with "held".

No table.

Command: `the command`

## Goals

All scenes except the flats together; in a row with "held scenes" those alone. A goal is met if the whole interval is below the limit, and open if the limit is inside the interval.

| goal |    measured | limit |  met |
|-----|------------:|------:|-----:|
| poolPointer: 14 klux, above 3 % | 0.20 +-0.01 |  0.20 | open |
| poolPointer: 14 klux, held scenes, edges above 3 %, at most 1.5 times that of the matched filter (single pixel) | 0.60 +-0.02 |  2.70 |  yes |
| poolPointer: 14 klux, edges above 3 % | 0.60 +-0.01 |  1.29 |  yes |
| poolPointer, no S1: 14 klux, above 3 % | 0.30 +-0.01 |  0.60 |  yes |
| poolPointer, no S1: 14 klux, edges above 3 % | 0.90 +-0.01 |  1.29 |  yes |

## 14 klux

### All scenes but the flats together

| estimator                     |   above 3 % |  above 10 % | edges above 3 % | edges above 10 % | other pixels above 3 % | other pixels above 10 % | single pixels above 10 % |
|-------------------------------|------------:|------------:|----------------:|-----------------:|-----------------------:|------------------------:|-------------------------:|
| matched filter (single pixel) | 0.60 +-0.01 | 0.30 +-0.01 |     1.80 +-0.02 |      0.60 +-0.01 |            0.20 +-0.01 |             0.10 +-0.00 |                        - |
| poolPointer, no S1            | 0.30 +-0.01 | 0.15 +-0.01 |     0.90 +-0.01 |      0.30 +-0.01 |            0.10 +-0.00 |             0.05 +-0.00 |                        - |
| poolPointer                   | 0.20 +-0.01 | 0.10 +-0.00 |     0.60 +-0.01 |      0.20 +-0.01 |            0.07 +-0.00 |             0.03 +-0.00 |                        - |

### All pixels: above 3 % / 10 %

| scene       | matched filter (single pixel) | poolPointer, no S1 | poolPointer |
|-------------|------------------------------:|-------------------:|------------:|
| flat 1 m    |                   0.00 / 0.00 |        0.00 / 0.00 | 0.00 / 0.00 |
| planes      |                   0.60 / 0.30 |        0.30 / 0.15 | 0.20 / 0.10 |
| held planes |                   0.60 / 0.30 |        0.30 / 0.15 | 0.20 / 0.10 |

### Pixels at depth edges: above 3 % / 10 %

| scene       | matched filter (single pixel) | poolPointer, no S1 | poolPointer |
|-------------|------------------------------:|-------------------:|------------:|
| flat 1 m    |                   0.00 / 0.00 |        0.00 / 0.00 | 0.00 / 0.00 |
| planes      |                   1.80 / 0.60 |        0.90 / 0.30 | 0.60 / 0.20 |
| held planes |                   1.80 / 0.60 |        0.90 / 0.30 | 0.60 / 0.20 |

### Other pixels: above 3 % / 10 %

| scene       | matched filter (single pixel) | poolPointer, no S1 | poolPointer |
|-------------|------------------------------:|-------------------:|------------:|
| flat 1 m    |                   0.00 / 0.00 |        0.00 / 0.00 | 0.00 / 0.00 |
| planes      |                   0.20 / 0.10 |        0.10 / 0.05 | 0.07 / 0.03 |
| held planes |                   0.20 / 0.10 |        0.10 / 0.05 | 0.07 / 0.03 |
)"));
}

TEST(PoolReport, WithoutMatchedFiltersNoGoalIsJudged) {
  PoolResults results = made_up();
  results.references = false;
  EXPECT_THAT(page_text("pool", pool_page(results)), Not(HasSubstr("Goals")));
}

TEST(PoolReport, ThePageOfASearch) {
  PoolSearchResults results{.scenes = {"planes", "poles"},
                            .map = "map.png",
                            .seed = 700,
                            .engine_columns = 34,
                            .designs = Table({"design", "objective"}),
                            .command_line = "the command"};
  results.designs.add({"start", "0.1"});
  const std::string page = page_text("pool_search", pool_search_page(results));
  EXPECT_THAT(page,
              HasSubstr("10 %, and depth edges above 3 % with S1, each in per cent, + 0.05). Change: against "
                        "the design before. Training scenes: planes, poles with shapes and photons of seeds "
                        "from 700 on, and map.png; 34 columns of each. The scenes of"));
  EXPECT_THAT(
      page,
      EndsWith("another map.\n\nCommand: `the command`\n\n| design | objective |\n|--------|----------:|"
               "\n| start  |       0.1 |\n"));
  results.map.clear();
  EXPECT_THAT(page_text("pool_search", pool_search_page(results)), HasSubstr("from 700 on; 34 columns"));
}

}  // namespace
}  // namespace dtof
