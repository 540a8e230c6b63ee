// SPDX-License-Identifier: Apache-2.0
#include "photon_models/speed_error_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace dtof {
namespace {

using testing::HasSubstr;

/// Error 1 % at `cost`, and a tenth of it for a hundred times the cost, as noise falls.
ErrorCurve falling_to_a_tenth(const std::string& model, double cost) {
  return {
      .model = model, .frames = {100, 10'000}, .cpu_ms = {cost, 100.0 * cost}, .error_percent = {1.0, 0.1}};
}

SpeedErrorResults results_with(const ModelCosts& costs, std::vector<ErrorCurve> curves) {
  SpeedErrorResults results{.sensor = "thesis",
                            .seed = 9,
                            .frames = 300,
                            .scenes = 15,
                            .readouts = 5,
                            .acquisitions = 3333,
                            .detections = 23'840'000,
                            .threads = 2,
                            .models = Table({"model", "bias, %"}),
                            .costs = costs,
                            .curves = std::move(curves),
                            .reference_frames = 400,
                            .command_line = "the command"};
  results.models.add({"exact", "0.3"});
  return results;
}

std::string page_with(const ModelCosts& costs, std::vector<ErrorCurve> curves) {
  return page_text("speed_error", speed_error_page(results_with(costs, std::move(curves))));
}

const ErrorCurve kAnalytic{.model = "analytic", .frames = {}, .cpu_ms = {40.0}, .error_percent = {0.2}};

TEST(SpeedErrorReport, AdviceFollowsTheFigures) {
  const std::string one = page_with({.exact_stream_ms = 700, .fast_stream_ms = 800, .fast_sampler_ms = 300},
                                    {falling_to_a_tenth("exact", 5.0), kAnalytic});
  EXPECT_THAT(one, HasSubstr(R"(
Which model to take, by the figures above:

* **a stream** (RTL, recording, several read-outs of the same photons): the exact model, 700 ms a frame against 800 ms with the fast one;
* **one read-out model of a frame**: the fast model's sampler, 300 ms against 700 ms with the exact model;
* **a sweep**, by the error of its points that is asked for: 1 %: exact (5 ms); 0.3 %: analytic (40 ms); 0.1 %: exact (500 ms); 0.03 %: none of these runs.

Only the exact)"));
  const std::string other =
      page_with({.exact_stream_ms = 200, .fast_stream_ms = 100, .fast_sampler_ms = 300},
                {falling_to_a_tenth("exact", 5.0), falling_to_a_tenth("fast sampler", 2.0)});
  EXPECT_THAT(other, HasSubstr("the fast model's stream, 100 ms a frame against 200 ms with the exact one;"));
  EXPECT_THAT(other, HasSubstr("**: the exact model, 200 ms against 300 ms with the fast model's sampler;"));
  EXPECT_THAT(other, HasSubstr("1 %: fast sampler (2 ms)"));
}

TEST(SpeedErrorReport, ThePageHasItsFigures) {
  const std::string page = page_with({}, {falling_to_a_tenth("exact", 5.0), kAnalytic});
  EXPECT_THAT(page, HasSubstr(R"(
Preset thesis, seed 9, 300 frames a point; 15 scenes (2, 14 and 50 klux; 0.5 to 5 m); read-outs ezPointer, hisPointer, SiFH, FiFH and three steps. Command: `the command`

| model | bias, % |
|-------|--------:|
| exact |     0.3 |

![speed against error](speed_error.svg)

| frames | exact, CPU ms | error, % | analytic, CPU ms | error, % |
|--------|--------------:|---------:|-----------------:|---------:|
| 100    |             5 |        1 |               40 |      0.2 |
| 10000  |           500 |      0.1 |               40 |      0.2 |

* **Picture)"));
  EXPECT_THAT(page, HasSubstr("The truth is 400 other frames of the exact model"));
  EXPECT_THAT(page, HasSubstr("200 x 160 pixels, 3333 acquisitions, a plane from 0.8 to 5 m at 14 klux (23.8 "
                              "million detections in the exact model), 2 threads."));
  EXPECT_THAT(
      page, HasSubstr("(times, 15 tests), detections of each pixel (numbers, 15 tests) and results of "
                      "each code (results, 75 tests). With 75 tests of a right model the smallest p-value is "
                      "below 1e-04 once"));
}

}  // namespace
}  // namespace dtof
