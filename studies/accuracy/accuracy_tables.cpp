// SPDX-License-Identifier: Apache-2.0
#include "accuracy/accuracy_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

namespace dtof {
namespace {

void append(std::vector<std::string>& row, const Estimate& estimate) {
  for (const double value : {estimate.value, estimate.interval.low, estimate.interval.high}) {
    row.push_back(fmt::format("{:.6g}", value));
  }
  row.push_back(estimate.with_unseen ? fmt::format("{:.6g}", estimate.with_unseen->low) : "");
  row.push_back(estimate.with_unseen ? fmt::format("{:.6g}", estimate.with_unseen->high) : "");
}

void append(std::vector<std::string>& row, const std::optional<Estimate>& estimate) {
  if (estimate) {
    append(row, *estimate);
  } else {
    row.insert(row.end(), 5, "");
  }
}

}  // namespace

std::string format_estimate(const Estimate& estimate, double scale, int digits) {
  std::string text =
      fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", estimate.value * scale, digits, estimate.interval.low * scale,
                  digits, estimate.interval.high * scale, digits);
  if (estimate.with_unseen) {
    text += '*';
    if (estimate.with_unseen != estimate.interval) {
      text += fmt::format(" {:.{}f} to {:.{}f}", estimate.with_unseen->low * scale, digits,
                          estimate.with_unseen->high * scale, digits);
    }
  }
  return text;
}

Table accuracy_csv(std::span<const AccuracyPoint> points) {
  std::vector<std::string> header = {"klux", "readout", "distance_m", "frames", "precision_reached"};
  for (const char* figure : {"relative_precision", "bias_m", "slope", "rmse_m", "above_3_percent",
                             "outlier_rate", "efficiency", "accepted", "outliers_kept"}) {
    for (const char* part : {"", "_low", "_high", "_low_unseen", "_high_unseen"}) {
      header.push_back(fmt::format("{}{}", figure, part));
    }
  }
  header.emplace_back("cramer_rao_m");
  Table table(header);
  for (const AccuracyPoint& point : points) {
    std::vector<std::string> row = {fmt::format("{:g}", point.klux), point.estimator,
                                    fmt::format("{:g}", point.distance_m), fmt::format("{}", point.frames),
                                    point.precision_reached ? "1" : "0"};
    append(row, point.relative_precision);
    append(row, point.bias_m);
    append(row, point.slope);
    append(row, point.rmse_m);
    append(row, point.above_3_percent);
    append(row, point.outlier_rate);
    append(row, point.efficiency);
    append(row, point.accepted);
    append(row, point.outliers_kept);
    row.push_back(fmt::format("{:.6g}", point.cramer_rao_m));
    table.add(row);
  }
  return table;
}

Table accuracy_table(std::span<const AccuracyPoint> points) {
  const bool rejected =
      std::ranges::any_of(points, [](const AccuracyPoint& point) { return point.accepted.has_value(); });
  std::vector<std::string> header = {"distance m",    "frames",    "relative precision %", "bias mm",
                                     "slope",         "rmse mm",   "above 3 %, %",         "above 10 %, %",
                                     "Cramer-Rao mm", "efficiency"};
  if (rejected) {
    header.emplace_back("accepted %");
    header.emplace_back("of these above 10 %, %");
  }
  Table table(header);
  for (const AccuracyPoint& point : points) {
    std::vector<std::string> row = {
        fmt::format("{:g}", point.distance_m),
        fmt::format("{}{}", point.frames, point.precision_reached ? "" : " (not reached)"),
        format_estimate(point.relative_precision, 100.0, 2),
        format_estimate(point.bias_m, 1e3, 1),
        point.slope ? format_estimate(*point.slope, 1.0, 3) : "-",
        format_estimate(point.rmse_m, 1e3, 1),
        format_estimate(point.above_3_percent, 100.0, 1),
        format_estimate(point.outlier_rate, 100.0, 1),
        fmt::format("{:.2f}", point.cramer_rao_m * 1e3),
        format_estimate(point.efficiency, 1.0, 2)};
    if (rejected) {
      row.push_back(point.accepted ? format_estimate(*point.accepted, 100.0, 1) : "-");
      row.push_back(point.outliers_kept ? format_estimate(*point.outliers_kept, 100.0, 1) : "-");
    }
    table.add(row);
  }
  return table;
}

void for_each_estimator(std::span<const AccuracyPoint> points,
                        const std::function<void(std::span<const AccuracyPoint>)>& use) {
  while (!points.empty()) {
    const auto end = std::ranges::find_if(points, [&](const AccuracyPoint& point) {
      return point.estimator != points.front().estimator || point.klux != points.front().klux;
    });
    const auto count = static_cast<std::size_t>(end - points.begin());
    use(points.first(count));
    points = points.subspan(count);
  }
}

Table accuracy_matrix(std::span<const AccuracyPoint> points,
                      const std::function<std::string(const AccuracyPoint&)>& cell) {
  std::vector<std::string> header = {"distance m"};
  std::map<double, std::vector<std::string>> rows;
  for_each_estimator(points, [&](std::span<const AccuracyPoint> estimator) {
    header.push_back(estimator.front().title);
    for (const AccuracyPoint& point : estimator) {
      rows[point.distance_m].push_back(cell(point));
    }
  });
  Table table(header);
  for (const auto& [distance, cells] : rows) {
    std::vector<std::string> row = {fmt::format("{:g}", distance)};
    row.insert(row.end(), cells.begin(), cells.end());
    table.add(row);
  }
  return table;
}

std::vector<PlotSeries> accuracy_series(std::span<const AccuracyPoint> points,
                                        const std::function<double(const AccuracyPoint&)>& value) {
  std::vector<PlotSeries> series;
  for_each_estimator(points, [&](std::span<const AccuracyPoint> estimator) {
    PlotSeries& line = series.emplace_back();
    line.label = estimator.front().title;
    for (const AccuracyPoint& point : estimator) {
      line.x.push_back(point.distance_m);
      line.y.push_back(value(point));
    }
  });
  return series;
}

}  // namespace dtof
