// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/accuracy_tables.hpp"
#include "reproduction/reproduction_report.hpp"

namespace dtof {

// What the parts of the reproduction report share.

inline std::string percent(double share) { return fmt::format("{:.2f}", share * 100.0); }
inline std::string precision_cell(const AccuracyPoint& p) {
  return percent(p.relative_precision.value) + (p.relative_precision.with_unseen ? "*" : "");
}
inline std::string rmse_cell(const AccuracyPoint& p) {
  return percent(p.rmse_m.value / p.distance_m) + (p.rmse_m.with_unseen ? "*" : "");
}
inline std::string bias_cell(const AccuracyPoint& p) { return fmt::format("{:.0f}", p.bias_m.value * 1e3); }
inline std::string slope_cell(const AccuracyPoint& p) {
  return p.slope ? fmt::format("{:.2f}", p.slope->value) : "-";
}

inline std::string verdict_word(Verdict verdict) { return std::string(verdict_text(verdict)); }

/// "a, b", or "none".
inline std::string names_or_none(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

inline PlotSeries bins_of(const std::string& label, const std::vector<double>& values, double first = 1.0,
                          std::size_t end = 1023) {
  PlotSeries series{label, {}, {}};
  for (std::size_t i = 0; i < std::min(end, values.size()); ++i) {
    series.x.push_back(static_cast<double>(i) + first);  // the thesis counts bins from 1
    series.y.push_back(values[i]);
  }
  return series;
}
/// A part of the report: adds values to the page, and pictures.
class ReproductionPart {
 public:
  ReproductionPart(const Reproduction& reproduction, ReproductionReport& report)
      : r_(reproduction), report_(report) {}

 protected:
  /// Scene and light, for the titles of pictures.
  [[nodiscard]] std::string flat(double klux, std::optional<double> distance_m = std::nullopt) const {
    return fmt::format("flat target{}, {:g} klux, sensor {}",
                       distance_m ? fmt::format(" at {:g} m", *distance_m) : "", klux, r_.sensor.name);
  }

  [[nodiscard]] PageData& page() { return report_.page; }

  /// A picture in the folder `reproduction`; `title`, its title's name in the page's data.
  void picture(const std::string& title, const std::string& file, std::vector<PlotSeries> series,
               const PlotLayout& layout) {
    page().set(title, "{}", layout.title);
    report_.pictures.push_back({file, std::move(series), layout});
  }

  const Reproduction& r_;
  ReproductionReport& report_;
};

/// Adds what stands behind the sections of the thesis's own figures: other assumptions, light, hidden errors
/// and future work.
void add_variations(const Reproduction& reproduction, ReproductionReport& report);

}  // namespace dtof
