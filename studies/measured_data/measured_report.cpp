// SPDX-License-Identifier: Apache-2.0
#include "measured_data/measured_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "dtof/report/table.hpp"

namespace dtof {
namespace {

/// Lights down, read-outs across.
Table by_light(const MeasuredResults& results,
               const std::function<std::string(const MeasuredOutcome&)>& cell) {
  std::vector<std::string> header = {"light"};
  header.insert(header.end(), results.readouts.begin(), results.readouts.end());
  Table table(std::move(header));
  for (const MeasuredLightResult& result : results.lights) {
    std::vector<std::string> row = {result.light.name()};
    for (const MeasuredOutcome& outcome : result.readouts) {
      row.push_back(cell(outcome));
    }
    table.add(std::move(row));
  }
  return table;
}

std::string tenths_of_percent(double share) { return fmt::format("{:.1f}", share * 100.0); }

/// What was recorded: a recording, or photon times with surfaces.
void add_contents(const MeasuredScene& scene, PageData& data) {
  std::optional<PageData> recording;
  std::optional<PageData> photon_times;
  if (scene.contents.empty()) {
    std::optional<PageData> later;
    if (scene.from_tick > 0.0) {
      later = PageData().set("from_tick", "{:g}", scene.from_tick);
    }
    photon_times = PageData().set("mean_photons", "{:.1f}", scene.mean_photons);
    photon_times->part("later_photons", std::move(later));
  } else {
    recording = PageData().set("contents", "{}", scene.contents).flag("tmf8829", scene.is_tmf8829);
  }
  data.part("recording", std::move(recording)).part("photon_times", std::move(photon_times));
}

std::optional<PageData> number_of_pixels(std::size_t pixels) {
  return pixels == 0 ? std::nullopt : std::optional(PageData().set("pixels", "{}", pixels));
}

void add_truth(const MeasuredTruth& truth, PageData& data) {
  std::optional<PageData> strongest_return;
  if (truth.origin == TruthOrigin::kStrongestReturn) {
    strongest_return = PageData().set("window_ns", "{:g}", truth.window_s * 1e9);
    strongest_return->part("without_return", number_of_pixels(truth.without_return));
  }
  std::optional<PageData> map;
  if (truth.origin == TruthOrigin::kMap) {
    map = PageData().set("map_file", "{}", truth.map);
  }
  std::optional<PageData> beyond_range = number_of_pixels(truth.beyond_range);
  if (beyond_range) {
    beyond_range->set("range_m", "{:.2f}", truth.range_m);
  }
  data.part("strongest_return", std::move(strongest_return))
      .flag("plane", truth.origin == TruthOrigin::kPlane)
      .flag("sensor", truth.origin == TruthOrigin::kSensor)
      .flag("surface", truth.origin == TruthOrigin::kSurface)
      .part("truth_map", std::move(map))
      .part("beyond_range", std::move(beyond_range));
}

/// Nothing without names.
std::optional<PageData> joined_names(const std::vector<std::string>& names) {
  return names.empty() ? std::nullopt : std::optional(PageData().set("names", "{}", fmt::join(names, ", ")));
}

}  // namespace

std::string MeasuredLight::name() const {
  return fmt::format("{} photons{}", photons > 0.0 ? fmt::format("{:g}", photons) : "all",
                     background > 0.0 ? fmt::format(", {:g} background", background) : "");
}

PageData measured_page(const MeasuredScene& scene, const MeasuredResults& results) {
  PageData data;
  data.set("title", "{}", scene.title).set("columns", "{}", scene.columns).set("rows", "{}", scene.rows);
  add_contents(scene, data);
  add_truth(scene.truth, data);
  data.set("acquisitions", "{}", results.acquisitions)
      .set("t_int_ns", "{:g}", results.t_int_ns)
      .set("timestamp_bits", "{}", results.timestamp_bits)
      .set("frames", "{}", results.frames)
      .set("seed", "{}", results.seed)
      .set("errors", by_light(results, [](const MeasuredOutcome& o) {
             return fmt::format("{} / {}", tenths_of_percent(o.score.all.above_3_percent),
                                tenths_of_percent(o.score.all.above_10_percent));
           }));
  std::optional<PageData> two_surfaces;
  if (!scene.other_m.empty()) {
    two_surfaces = PageData().set("off_both_surfaces", by_light(results, [](const MeasuredOutcome& o) {
                                    return tenths_of_percent(o.off_both_surfaces);
                                  }));
  }
  data.part("two_surfaces", std::move(two_surfaces))
      .set("rmse_and_bias_mm", by_light(results,
                                        [](const MeasuredOutcome& o) {
                                          return fmt::format("{:.0f} / {:.0f}", o.errors.rmse_m * 1e3,
                                                             o.errors.bias_m * 1e3);
                                        }))
      .set("median_error_mm",
           by_light(results,
                    [](const MeasuredOutcome& o) { return fmt::format("{:.0f}", o.median_error_m * 1e3); }))
      .set("removed_outliers", by_light(results,
                                        [](const MeasuredOutcome& o) {
                                          return std::isnan(o.score.removed[2])
                                                     ? std::string("-")
                                                     : tenths_of_percent(o.score.removed[2]);
                                        }))
      .part("equal_rtl", joined_names(results.compared_with_rtl.equal))
      .part("not_compiled", joined_names(results.compared_with_rtl.not_compiled))
      .set("command", "{}", results.command_line);
  return data;
}

}  // namespace dtof
