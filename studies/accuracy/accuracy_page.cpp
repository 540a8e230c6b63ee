// SPDX-License-Identifier: Apache-2.0
#include "accuracy/accuracy_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "accuracy/accuracy_tables.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/report/table.hpp"

namespace dtof {
namespace {

void set_photon_model(PageData& data, const std::string& fidelity) {
  data.set("photon_model", "{}", fidelity).flag("is_auto", fidelity == "auto");
}

std::optional<PageData> until_precise(const StudySettings& settings) {
  if (!settings.precision) {
    return std::nullopt;
  }
  return PageData()
      .set("most_frames", "{}", settings.most_frames)
      .set("precision", "{:g}", *settings.precision * 100.0)
      .set("rare_outliers", "{:g}", settings.rare_outliers * 100.0);
}

std::optional<PageData> not_rejected(const AccuracyStudy& study) {
  if (study.without_rejection.empty()) {
    return std::nullopt;
  }
  return PageData().set("estimators", "{}", fmt::join(study.without_rejection, ", "));
}

/// At how many points --precision was reached.
std::optional<PageData> precise(const StudySettings& settings, const AccuracyStudy& study) {
  if (!settings.precision) {
    return std::nullopt;
  }
  return PageData()
      .set("points_reached", "{}", std::ranges::count(study.points, true, &AccuracyPoint::precision_reached))
      .set("points", "{}", study.points.size())
      .set("longest_run", "{}", std::ranges::max(study.points, {}, &AccuracyPoint::frames).frames);
}

PageData light_data(const StudySettings& settings, const LightAccuracy& light) {
  const std::vector<AccuracyPoint>& points = light.study.points;
  std::vector<PageData> sections;
  for_each_estimator(points, [&](std::span<const AccuracyPoint> own) {
    sections.push_back(
        PageData().set("estimator", "{}", own.front().title).set("figures", accuracy_table(own)));
  });
  const auto relative_precision = [](const AccuracyPoint& p) {
    return fmt::format("{:.2f}", p.relative_precision.value * 100.0);
  };
  const auto rmse = [](const AccuracyPoint& p) {
    return fmt::format("{:.2f}", p.rmse_m.value / p.distance_m * 100.0);
  };
  const auto above_10_percent = [](const AccuracyPoint& p) {
    return fmt::format("{:.1f}", p.outlier_rate.value * 100.0);
  };
  return PageData()
      .set("klux", "{:g}", light.klux)
      .set("relative_precision", accuracy_matrix(points, relative_precision))
      .set("rmse", accuracy_matrix(points, rmse))
      .set("above_10_percent", accuracy_matrix(points, above_10_percent))
      .part("not_rejected", not_rejected(light.study))
      .part("precise", precise(settings, light.study))
      .list("sections", std::move(sections));
}

/// Bands down, read-outs across; the last row is the whole range.
Table band_matrix(const std::vector<BandAccuracy>& rows,
                  const std::function<std::string(const BandAccuracy&)>& cell) {
  std::vector<std::string> header = {"distance m", "pixels"};
  std::vector<std::vector<std::string>> lines;
  std::size_t line = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const BandAccuracy& row = rows[i];
    if (i == 0 || row.readout != rows[i - 1].readout) {
      header.push_back(row.title);
      line = 0;
    }
    if (line == lines.size()) {
      lines.push_back({fmt::format("{:.2f} to {:.2f}", row.from_m, row.to_m), fmt::format("{}", row.pixels)});
    }
    lines[line].push_back(cell(row));
    ++line;
  }
  Table table(std::move(header));
  for (std::vector<std::string>& cells : lines) {
    table.add(std::move(cells));
  }
  return table;
}

PageData bands_data(const LightBands& light) {
  const auto table = [&](Estimate BandAccuracy::*figure, double scale, int digits) {
    return band_matrix(
        light.bands, [=](const BandAccuracy& band) { return format_estimate(band.*figure, scale, digits); });
  };
  return PageData()
      .set("klux", "{:g}", light.klux)
      .set("rmse", table(&BandAccuracy::rmse_m, 1e3, 0))
      .set("bias", table(&BandAccuracy::bias_m, 1e3, 1))
      .set("above_3_percent", table(&BandAccuracy::above_3_percent, 100.0, 2))
      .set("above_10_percent", table(&BandAccuracy::above_10_percent, 100.0, 2));
}

}  // namespace

PageData accuracy_page(const StudySettings& settings, const std::string& fidelity,
                       const std::vector<LightAccuracy>& lights) {
  std::vector<PageData> sections;
  sections.reserve(lights.size());
  for (const LightAccuracy& light : lights) {
    sections.push_back(light_data(settings, light));
  }
  PageData data;
  data.set("sensor", "{}", settings.sensor.name)
      .set("reflectivity", "{:g}", settings.reflectivity)
      .set("acquisitions", "{}", settings.sensor.acquisitions)
      .set("engine", "{}", settings.run.engine);
  set_photon_model(data, fidelity);
  data.set("seed", "{}", settings.run.seed)
      .set("frames", "{}", settings.frames)
      .part("until_precise", until_precise(settings))
      .set("calibration_seed", "{}", settings.calibration_seed)
      .set("calibration_frames", "{}", settings.calibration_frames)
      .set("calibration_step", "{:g}", settings.calibration_step_m)
      .list("lights", std::move(sections))
      .set("command", "{}", settings.command);
  return data;
}

PageData map_accuracy_page(const MapAccuracySettings& settings, const OwnScene& scene,
                           const std::string& fidelity, const std::vector<LightBands>& lights) {
  std::vector<PageData> sections;
  sections.reserve(lights.size());
  for (const LightBands& light : lights) {
    sections.push_back(bands_data(light));
  }
  PageData data;
  data.set("scene", "{}", scene.description)
      .flag("is_cube", scene.is_cube)
      .set("sensor", "{}", settings.sensor.name)
      .set("acquisitions", "{}", settings.sensor.acquisitions)
      .set("frames", "{}", settings.frames)
      .set("engine", "{}", settings.run.engine);
  set_photon_model(data, fidelity);
  data.set("seed", "{}", settings.run.seed)
      .set("look_up_tables", "{}", table_sentence(TableRule::kFlat, settings.sensor, settings.run.seed))
      .list("lights", std::move(sections))
      .set("command", "{}", settings.command);
  return data;
}

}  // namespace dtof
