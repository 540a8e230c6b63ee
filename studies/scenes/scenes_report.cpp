// SPDX-License-Identifier: Apache-2.0
#include "scenes/scenes_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "dtof/core/parameters.hpp"

namespace dtof {
namespace {

constexpr const char* kNoFigure = "-";

/// Scenes down, estimators across; scenes without a figure are left out.
Table matrix(const LightResults& light, const std::function<std::string(const EstimatorResult&)>& cell) {
  std::vector<std::string> header = {"scene"};
  header.insert(header.end(), light.estimators.begin(), light.estimators.end());
  Table table(std::move(header));
  for (const SceneResult& result : light.scenes) {
    std::vector<std::string> row = {result.scene};
    for (const EstimatorResult& estimator : result.estimators) {
      row.push_back(cell(estimator));
    }
    if (std::any_of(row.begin() + 1, row.end(), [](const std::string& text) { return text != kNoFigure; })) {
      table.add(std::move(row));
    }
  }
  return table;
}

std::string share_pair(const ErrorShares& shares) {
  return shares.pixels == 0 ? kNoFigure
                            : fmt::format("{:.2f} / {:.2f}", shares.above_3_percent * 100.0,
                                          shares.above_10_percent * 100.0);
}

/// hisPointer beside poolPointer; nothing if one of them was not read.
std::optional<PageData> pooled_gain(const LightResults& light) {
  const std::vector<std::string>& estimators = light.estimators;
  const auto alone = std::ranges::find(estimators, readout_title(Readout::kHisPointer)) - estimators.begin();
  const auto pooled =
      std::ranges::find(estimators, readout_title(Readout::kPoolPointer)) - estimators.begin();
  const auto count = static_cast<std::ptrdiff_t>(estimators.size());
  if (alone == count || pooled == count) {
    return std::nullopt;
  }
  Table table({"scene", "above 3 %, hisPointer / poolPointer", "above 10 %", "rmse",
               "median error over bound: hisPointer", "poolPointer"});
  const auto ratio = [](double a, double b, double least) {
    return b > 0.0 ? fmt::format("{:.1f}", a / b) : a > 0.0 ? fmt::format(">{:.0f}", a / least) : kNoFigure;
  };
  for (const SceneResult& result : light.scenes) {
    if (!shows_pooled_gain(result.scene)) {
      continue;
    }
    const EstimatorResult& a = result.estimators[static_cast<std::size_t>(alone)];
    const EstimatorResult& b = result.estimators[static_cast<std::size_t>(pooled)];
    const double one_pixel = 1.0 / static_cast<double>(std::max<std::uint64_t>(1, a.score.all.pixels));
    table.add({result.scene, ratio(a.score.all.above_3_percent, b.score.all.above_3_percent, one_pixel),
               ratio(a.score.all.above_10_percent, b.score.all.above_10_percent, one_pixel),
               ratio(a.score.all.rmse, b.score.all.rmse, one_pixel),
               fmt::format("{:.2f}", a.error_over_bound), fmt::format("{:.2f}", b.error_over_bound)});
  }
  return PageData().set("gain", table);
}

PageData light_data(const LightResults& light) {
  PageData data;
  data.set("klux", "{:g}", light.klux)
      .set("sensor", "{}", light.sensor)
      .set("look_up_table", "{}", light.look_up_table)
      .set("all_pixels", all_pixels_table(light))
      .set("edges", matrix(light, [](const EstimatorResult& r) { return share_pair(r.score.edges); }))
      .set("other_pixels", matrix(light, [](const EstimatorResult& r) { return share_pair(r.score.rest); }))
      .set("single_pixels", matrix(light,
                                   [](const EstimatorResult& r) {
                                     return r.score.singles.pixels == 0
                                                ? kNoFigure
                                                : fmt::format("{:.2f}",
                                                              r.score.singles.above_10_percent * 100.0);
                                   }))
      .set("rmse",
           matrix(light,
                  [](const EstimatorResult& r) { return fmt::format("{:.2f}", r.score.all.rmse * 100.0); }))
      .set("error_over_bound", matrix(light,
                                      [](const EstimatorResult& r) {
                                        return std::isnan(r.error_over_bound)
                                                   ? kNoFigure
                                                   : fmt::format("{:.2f}", r.error_over_bound);
                                      }))
      .set("removed_outliers", matrix(light,
                                      [](const EstimatorResult& r) {
                                        return std::isnan(r.score.removed[2])
                                                   ? kNoFigure
                                                   : fmt::format("{:.0f}", r.score.removed[2] * 100.0);
                                      }))
      .part("pooled_gain", pooled_gain(light));
  return data;
}

}  // namespace

bool shows_pooled_gain(const std::string& scene) {
  return is_flat(scene) || scene == "planes" || scene == "held planes";
}

Table all_pixels_table(const LightResults& light) {
  return matrix(light, [](const EstimatorResult& r) { return share_pair(r.score.all); });
}

PageData scenes_page(const ScenesResults& results) {
  std::vector<PageData> notes;
  for (const std::string& note : results.notes) {
    notes.push_back(PageData().set("note", "{}", note));
  }
  std::vector<PageData> lights;
  for (const LightResults& light : results.lights) {
    lights.push_back(light_data(light));
  }
  PageData data;
  data.set("seed", "{}", results.seed)
      .set("most_columns", "{}", results.columns)
      .set("command", "{}", results.command_line)
      .list("notes", std::move(notes))
      .list("lights", std::move(lights));
  return data;
}

}  // namespace dtof
