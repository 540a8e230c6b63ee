// SPDX-License-Identifier: Apache-2.0
#include "photon_models/fidelity_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

FidelitySettings small_fidelity_study() {
  FidelitySettings settings;
  settings.sensor = parse_preset("thesis");
  settings.scenes = {{"wall", TargetMap(10, 20, {2.0, 1.0})}, {"far", TargetMap(10, 20, {4.0, 1.0})}};
  settings.klux = {14.0};
  settings.readouts = {Readout::kEzPointer, Readout::kHisPointer};
  settings.frames = 2;
  return settings;
}

TEST(FidelityStudy, DifferencesOfFiguresWithTheirStandardErrors) {
  const std::vector<ColumnFigures> exact = {{0.1, 0.04, 0.2, 0.1}, {0.3, 0.14, 0.4, 0.1}};
  std::vector<ColumnFigures> other = exact;
  for (ColumnFigures& column : other) {
    column.bias += 0.02;
    column.mean_square += 0.07;
  }
  other[1].above_3_percent += 0.2;
  const ModelDifference difference = compare_models(exact, other);
  EXPECT_DOUBLE_EQ(difference.rmse, 0.3);
  EXPECT_NEAR(difference.figures[0].value, 0.4 - 0.3, 1e-12);
  EXPECT_NEAR(difference.figures[0].standard_error, 0.0, 1e-12);
  EXPECT_NEAR(difference.figures[1].value, 0.02, 1e-12);
  EXPECT_NEAR(difference.figures[2].value, 0.1, 1e-12);
  EXPECT_NEAR(difference.figures[2].standard_error, 0.1, 1e-12);  // 0 and 0.2: deviation 0.1414 over root 2
  EXPECT_EQ(difference.figures[3].value, 0.0);
  EXPECT_NEAR(difference.upper_limit(), 0.1 + 1.96 * 0.1, 1e-4);
  EXPECT_THROW(compare_models(exact, std::span(other).first(1)), InputError);
  EXPECT_THROW(compare_models(std::span(exact).first(1), std::span(other).first(1)), InputError);
}

TEST(FidelityStudy, PromisesAreKeptOpenOrBroken) {
  ModelDifference difference;
  difference.figures[1] = {.value = -0.01, .standard_error = 0.001};
  EXPECT_EQ(difference.promise(0.012), Promise::kKept);
  EXPECT_EQ(difference.promise(0.011), Promise::kOpen);
  EXPECT_EQ(difference.promise(0.0071), Promise::kOpen);
  EXPECT_EQ(difference.promise(0.0069), Promise::kBroken);
}

// The limits that auto relies on, measured again with few frames: six standard errors leave chance no room.
TEST(FidelityStudy, TheFastSamplerIsWithinTheLimitsThatAutoUses) {
  FidelitySettings settings = small_fidelity_study();
  settings.readouts.assign(kThesisReadouts.begin(), kThesisReadouts.end());
  const FidelityStudy study = run_fidelity_study(settings);
  ASSERT_EQ(study.cells.size(), settings.scenes.size() * settings.readouts.size());
  for (const FidelityCell& cell : study.cells) {
    for (const FigureDifference& figure : cell.difference.figures) {
      EXPECT_LE(std::abs(figure.value), fast_sampler_difference(cell.readout) + 6.0 * figure.standard_error)
          << cell.scene << ", " << readout_name(cell.readout);
    }
  }
}

TEST(FidelityStudy, FiguresAreTheSameWhateverTheThreads) {
  FidelitySettings settings = small_fidelity_study();
  settings.threads = 1;
  const FidelityStudy one = run_fidelity_study(settings);
  settings.threads = 3;
  const FidelityStudy three = run_fidelity_study(settings);
  for (std::size_t i = 0; i < one.cells.size(); ++i) {
    for (std::size_t f = 0; f < kFigureNames.size(); ++f) {
      EXPECT_EQ(one.cells[i].difference.figures[f].value, three.cells[i].difference.figures[f].value);
    }
  }
}

// A study made up, so that the report's statements can be checked against it.
FidelityStudy made_up(const FidelitySettings& settings, double difference, double exact_stream_ms) {
  FidelityStudy study;
  for (const double klux : settings.klux) {
    for (const auto& [name, targets] : settings.scenes) {
      for (const Readout readout : settings.readouts) {
        FidelityCell cell{.scene = name, .klux = klux, .readout = readout, .difference = {}};
        cell.difference.figures[2] = {.value = difference, .standard_error = difference / 100.0};
        cell.exact_ms = 100.0;
        cell.fast_ms = 40.0;
        cell.taken.fill(Fidelity::kFast);
        cell.taken.back() = Fidelity::kExact;
        study.cells.push_back(cell);
      }
    }
  }
  study.streams = {.exact_ms = exact_stream_ms, .fast_ms = 100.0};
  return study;
}

TEST(FidelityReport, StatementsFollowTheFigures) {
  const FidelitySettings settings = small_fidelity_study();
  const std::string good =
      page_text("fidelity", fidelity_page(made_up(settings, 1e-6, 90.0), settings, "command"));
  EXPECT_THAT(good,
              StartsWith("# What the fast photon model changes of what a user sees\n\nThis page compares"));
  EXPECT_THAT(good, HasSubstr("before any look-up table. Number of scenes: 2, of 10 x 20 pixels; number of "
                              "lights: 1; frames of each: 2; seed 1. A difference has"));
  EXPECT_THAT(good, HasSubstr("Times are processor time of this run. Command: `command`\n\n| read-out "));
  EXPECT_THAT(good, HasSubstr(R"(
The limits of `--fidelity auto` hold for 2 of 2 read-outs. The fast sampler costs less than the exact streams for 2 of 2 read-outs, and the order that `auto` assumes is right for 2. The streams of a frame took 90 ms with the exact model and 100 ms with the fast one. For streams the exact model is therefore the cheaper one, and the exact streams of `auto` cost less than the fast ones.

## What auto takes, and whether it keeps its promise

Number of the 4 combinations of scene, light and read-out for which `--fidelity auto` takes each model. A promise is kept if the 95 % intervals of all four differences lie within the tolerance, and broken if one of the four differences lies outside by more than three standard errors.

| tolerance | exact | fast |)"));
  EXPECT_THAT(good, HasSubstr(R"(
No promise was broken.

## Differences by scene

Fast sampler minus exact model, in percentage points, with standard errors; auto: the model that `--fidelity auto` takes at tolerances 0.1, 0.03, 0.01, 0.003, 0.001 (e exact, f fast). The light is 14 klux; the CSV file has the other lights.

| scene | read-out   | auto  |)"));
  const std::string bad =
      page_text("fidelity", fidelity_page(made_up(settings, 0.5, 150.0), settings, "command"));
  EXPECT_THAT(bad, HasSubstr("hold for 0 of 2 read-outs"));
  EXPECT_THAT(bad, HasSubstr("For streams the fast model is therefore the cheaper one"));
  EXPECT_THAT(bad, HasSubstr("cost 50 % more than"));
  EXPECT_THAT(bad, Not(HasSubstr("No promise was broken.")));
  EXPECT_THAT(bad, HasSubstr("**Number of broken promises: "));
}

TEST(FidelityReport, CsvHasEveryToleranceOfEveryCell) {
  const FidelitySettings settings = small_fidelity_study();
  const FidelityStudy study = made_up(settings, 1e-6, 90.0);
  const std::string csv = fidelity_csv(study);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')),
            1 + study.cells.size() * kTolerances.size());
}

TEST(FidelityStudy, Refusals) {
  FidelitySettings settings = small_fidelity_study();
  settings.readouts = {Readout::kPoolPointer};
  EXPECT_THAT([&] { run_fidelity_study(settings); },
              testing::ThrowsMessage<InputError>(HasSubstr("poolpointer reads streams")));
  settings = small_fidelity_study();
  settings.frames = 0;
  EXPECT_THROW(run_fidelity_study(settings), InputError);
}

}  // namespace
}  // namespace dtof
