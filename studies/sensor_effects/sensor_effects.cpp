// SPDX-License-Identifier: Apache-2.0
#include "sensor_effects/sensor_effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dtof/metrics/error_statistics.hpp"

namespace dtof {
namespace {

void require_same_points(const SensorAccuracy& clean, const SensorAccuracy& other) {
  const auto same = [](const AccuracyPoint& a, const AccuracyPoint& b) {
    return a.estimator == b.estimator && a.klux == b.klux && a.distance_m == b.distance_m;
  };
  if (!std::ranges::equal(clean.points, other.points, same)) {
    throw std::logic_error("sensor effects: the studies have different points");
  }
}

std::vector<std::pair<std::string, std::string>> estimators(const SensorAccuracy& study) {
  std::vector<std::pair<std::string, std::string>> names;  // and titles
  for (const AccuracyPoint& point : study.points) {
    if (std::ranges::find(names, point.estimator, &std::pair<std::string, std::string>::first) ==
        names.end()) {
      names.emplace_back(point.estimator, point.title);
    }
  }
  return names;
}

std::string with_interval(const Estimate& estimate, double scale, int digits) {
  return fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", estimate.value * scale, digits,
                     estimate.interval.low * scale, digits, estimate.interval.high * scale, digits);
}

double rmse_ratio(const AccuracyPoint& clean, const AccuracyPoint& other) {
  return other.rmse_m.value / clean.rmse_m.value;
}

/// The point where `change` is largest.
template <typename Change>
std::size_t largest(const SensorAccuracy& clean, const SensorAccuracy& other, Change change) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < clean.points.size(); ++i) {
    if (change(clean.points[i], other.points[i]) > change(clean.points[best], other.points[best])) {
      best = i;
    }
  }
  return best;
}

PageData comparison(const char* figure, const IntervalsApart& apart) {
  return PageData()
      .set("figure", "{}", figure)
      .set("higher", "{}", apart.higher)
      .set("comparisons", "{}", apart.comparisons)
      .set("lower", "{}", apart.lower)
      .set("touching", "{}", apart.comparisons - apart.higher - apart.lower);
}

/// A figure at one point, with the clean sensor and with the other.
PageData change(const AccuracyPoint& clean, const AccuracyPoint& other, Estimate AccuracyPoint::*figure,
                double scale, int digits) {
  return PageData()
      .set("readout", "{}", clean.title)
      .set("distance", "{:g}", clean.distance_m)
      .set("klux", "{:g}", clean.klux)
      .set("clean", "{}", with_interval(clean.*figure, scale, digits))
      .set("with_sensor", "{}", with_interval(other.*figure, scale, digits));
}

/// The read-outs with the least and the largest median ratio of the rmse; nothing if there is only one.
std::optional<PageData> ratios(const SensorAccuracy& clean, const SensorAccuracy& other) {
  std::vector<std::pair<double, std::string>> ranking;
  for (const auto& [name, title] : estimators(clean)) {
    if (name != "matched-filter") {
      ranking.emplace_back(median_rmse_ratio(clean, other, name), title);
    }
  }
  if (ranking.size() < 2) {
    return std::nullopt;
  }
  std::ranges::sort(ranking);
  return PageData()
      .set("least_affected", "{}", ranking.front().second)
      .set("lowest", "{:.2f}", ranking.front().first)
      .set("most_affected", "{}", ranking.back().second)
      .set("highest", "{:.2f}", ranking.back().first);
}

/// Sets what the sentences on a sensor say: differences beyond the intervals, the largest of them, and the
/// least and most affected read-outs.
void set_changes(PageData& data, const SensorAccuracy& clean, const SensorAccuracy& other) {
  const IntervalsApart rmse = intervals_apart(clean, other, &AccuracyPoint::rmse_m);
  const IntervalsApart bias = intervals_apart(clean, other, &AccuracyPoint::bias_m);
  const auto rmse_at = [&](bool shown, auto by) {
    if (!shown) {
      return std::optional<PageData>();
    }
    const std::size_t i = largest(clean, other, by);
    const double percent = 100.0 / clean.points[i].distance_m;
    return std::optional(change(clean.points[i], other.points[i], &AccuracyPoint::rmse_m, percent, 2));
  };
  std::optional<PageData> moved_bias;
  if (bias.higher + bias.lower > 0) {
    const std::size_t i = largest(clean, other, [](const AccuracyPoint& a, const AccuracyPoint& b) {
      return std::abs(b.bias_m.value - a.bias_m.value);
    });
    moved_bias = change(clean.points[i], other.points[i], &AccuracyPoint::bias_m, 1e3, 1);
  }
  data.list("figures",
            {comparison("Rmse", rmse),
             comparison("Share above 3 %", intervals_apart(clean, other, &AccuracyPoint::above_3_percent)),
             comparison("Outliers", intervals_apart(clean, other, &AccuracyPoint::outlier_rate)),
             comparison("Bias before the table", bias)})
      .part("rise", rmse_at(rmse.higher > 0, rmse_ratio))
      .part("fall",
            rmse_at(rmse.lower > 0, [](const auto& a, const auto& b) { return 1.0 / rmse_ratio(a, b); }))
      .flag("rmse_unchanged", rmse.higher + rmse.lower == 0)
      .part("moved_bias", std::move(moved_bias))
      .part("ratios", ratios(clean, other));
}

}  // namespace

std::string sensor_difference(const SensorModel& clean, const SensorModel& sensor) {
  std::vector<std::string> parts;
  const auto add = [&](bool differs, const std::string& text) {
    if (differs) {
      parts.push_back(text);
    }
  };
  add(sensor.columns != clean.columns || sensor.rows != clean.rows,
      fmt::format("array {} x {}", sensor.columns, sensor.rows));
  add(sensor.np != clean.np || sensor.slots != clean.slots,
      fmt::format("NP {}, SLOTS {}", sensor.np, sensor.slots));
  add(sensor.integration_time_s != clean.integration_time_s,
      fmt::format("range {:g} ns", sensor.integration_time_s * 1e9));
  add(sensor.acquisitions != clean.acquisitions, fmt::format("{} acquisitions", sensor.acquisitions));
  if (sensor.pulse_response != clean.pulse_response && sensor.pulse_response) {
    parts.push_back(
        fmt::format("measured pulse, FWHM {:.3g} ns, standard deviation {:.3g} ns instead of {:.3g} ns",
                    sensor.pulse_fwhm_s * 1e9, sensor.pulse_response->standard_deviation() * 1e9,
                    clean.pulse_sigma_s() * 1e9));
  } else {
    add(sensor.pulse_fwhm_s != clean.pulse_fwhm_s,
        fmt::format("pulse FWHM {:.3g} ns", sensor.pulse_fwhm_s * 1e9));
  }
  add(sensor.signal_events_1m != clean.signal_events_1m,
      fmt::format("{:.3g} signal events at 1 m", sensor.signal_events_1m));
  add(sensor.background_events_per_klux != clean.background_events_per_klux,
      fmt::format("{:.3g} background events per klux", sensor.background_events_per_klux));
  add(sensor.default_reflectivity != clean.default_reflectivity,
      fmt::format("reflectivity {:g}", sensor.default_reflectivity));
  add(sensor.dark_count_rate_hz != clean.dark_count_rate_hz,
      fmt::format("dark count rate {:g} Hz", sensor.dark_count_rate_hz));
  add(sensor.dead_time_s != clean.dead_time_s, fmt::format("dead time {:g} ns", sensor.dead_time_s * 1e9));
  add(sensor.jitter_fwhm_s != clean.jitter_fwhm_s,
      fmt::format("jitter FWHM {:g} ps", sensor.jitter_fwhm_s * 1e12));
  add(sensor.afterpulse_probability != clean.afterpulse_probability,
      fmt::format("afterpulsing {:g} %, {:g} ns", sensor.afterpulse_probability * 100.0,
                  sensor.afterpulse_time_constant_s * 1e9));
  add(sensor.defects.hot_share != clean.defects.hot_share || sensor.defects.hot != clean.defects.hot,
      fmt::format("{:g} % and {} listed hot pixels of {:g} Hz", sensor.defects.hot_share * 100.0,
                  sensor.defects.hot.size(), sensor.defects.hot_dark_count_rate_hz));
  add(sensor.defects.dead_share != clean.defects.dead_share || sensor.defects.dead != clean.defects.dead,
      fmt::format("{:g} % and {} listed dead pixels", sensor.defects.dead_share * 100.0,
                  sensor.defects.dead.size()));
  if (sensor.tdc_codes != clean.tdc_codes && sensor.tdc_codes) {
    // The pixels' tables repeat after their number.
    double largest_width = 0.0;
    double largest_shift = 0.0;
    for (std::size_t table = 0; table < sensor.tdc_codes->tables(); ++table) {
      const std::vector<double> begins = sensor.tdc_codes->boundaries(table, sensor.np);
      for (std::size_t code = 0; code + 1 < begins.size(); ++code) {
        largest_width = std::max(largest_width, begins[code + 1] - begins[code]);
        largest_shift = std::max(largest_shift, std::abs(begins[code] - static_cast<double>(code)));
      }
    }
    parts.push_back(
        fmt::format("measured TDC code widths, {} table{}: the widest code {:.2g} T_res, boundaries up to "
                    "{:.2g} T_res from where equal codes have them",
                    sensor.tdc_codes->tables(), sensor.tdc_codes->tables() == 1 ? "" : "s", largest_width,
                    largest_shift));
  }
  return parts.empty() ? "no difference" : fmt::format("{}", fmt::join(parts, "; "));
}

IntervalsApart intervals_apart(const SensorAccuracy& clean, const SensorAccuracy& other,
                               Estimate AccuracyPoint::*figure) {
  require_same_points(clean, other);
  IntervalsApart apart;
  for (std::size_t i = 0; i < clean.points.size(); ++i) {
    const Interval before = (clean.points[i].*figure).interval;
    const Interval after = (other.points[i].*figure).interval;
    ++apart.comparisons;
    apart.higher += after.low > before.high ? 1 : 0;
    apart.lower += after.high < before.low ? 1 : 0;
  }
  return apart;
}

double median_rmse_ratio(const SensorAccuracy& clean, const SensorAccuracy& other,
                         const std::string& estimator) {
  require_same_points(clean, other);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < clean.points.size(); ++i) {
    if (clean.points[i].estimator == estimator) {
      ratios.push_back(rmse_ratio(clean.points[i], other.points[i]));
    }
  }
  if (ratios.empty()) {
    throw std::logic_error("sensor effects: no such estimator");
  }
  return median(std::move(ratios));
}

Table effect_overview(const SensorAccuracy& clean, std::span<const SensorAccuracy> others) {
  std::vector<std::string> header = {"sensor"};
  for (const auto& [name, title] : estimators(clean)) {
    header.push_back(title);
  }
  Table table(std::move(header));
  for (const SensorAccuracy& other : others) {
    std::vector<std::string> row = {other.sensor.name};
    for (const auto& [name, title] : estimators(clean)) {
      row.push_back(fmt::format("{:.2f}", median_rmse_ratio(clean, other, name)));
    }
    table.add(std::move(row));
  }
  return table;
}

Table effect_table(const SensorAccuracy& clean, const SensorAccuracy& other, double klux,
                   Estimate AccuracyPoint::*figure, double scale, bool relative_to_distance) {
  require_same_points(clean, other);
  std::vector<std::string> header = {"read-out"};
  for (const AccuracyPoint& point : clean.points) {
    if (point.klux == klux && point.estimator == clean.points.front().estimator) {
      header.push_back(fmt::format("{:g} m clean", point.distance_m));
      header.emplace_back("with");
    }
  }
  Table table(std::move(header));
  for (const auto& [name, title] : estimators(clean)) {
    std::vector<std::string> row = {title};
    for (std::size_t i = 0; i < clean.points.size(); ++i) {
      if (clean.points[i].klux == klux && clean.points[i].estimator == name) {
        const double unit = relative_to_distance ? scale / clean.points[i].distance_m : scale;
        row.push_back(with_interval(clean.points[i].*figure, unit, 1));
        row.push_back(with_interval(other.points[i].*figure, unit, 1));
      }
    }
    table.add(std::move(row));
  }
  return table;
}

PageData sensor_effects_page(const SensorEffects& effects, const std::string& command_line) {
  const SensorModel& clean = effects.clean.sensor;
  std::vector<PageData> sensors;
  for (const SensorAccuracy& other : effects.others) {
    std::vector<PageData> lights;
    for (const double klux : effects.klux) {
      lights.push_back(
          PageData()
              .set("light", "{:g}", klux)
              .set("rmse", effect_table(effects.clean, other, klux, &AccuracyPoint::rmse_m, 100.0, true)));
    }
    PageData sensor;
    sensor.set("sensor", "{}", other.sensor.name)
        .set("difference", "{}", sensor_difference(clean, other.sensor));
    set_changes(sensor, effects.clean, other);
    sensors.push_back(sensor.list("lights", std::move(lights)));
  }
  PageData data;
  data.set("clean_sensor", "{}", clean.name)
      .set("reflectivity", "{:g}", clean.default_reflectivity)
      .set("frames", "{}", effects.frames)
      .set("seed", "{}", effects.seed)
      .set("overview", effect_overview(effects.clean, effects.others))
      .list("sensors", std::move(sensors))
      .set("command", "{}", command_line);
  return data;
}

Table effects_csv(const SensorAccuracy& clean, std::span<const SensorAccuracy> others) {
  Table table({"sensor", "klux", "readout", "distance_m", "frames", "rmse_m", "rmse_low_m", "rmse_high_m",
               "bias_m", "bias_low_m", "bias_high_m", "above_3_percent", "above_3_percent_low",
               "above_3_percent_high", "outliers", "outliers_low", "outliers_high"});
  const auto add = [&](const SensorAccuracy& study) {
    for (const AccuracyPoint& point : study.points) {
      std::vector<std::string> row = {study.sensor.name, fmt::format("{:g}", point.klux), point.estimator,
                                      fmt::format("{:g}", point.distance_m), fmt::format("{}", point.frames)};
      for (const Estimate& estimate :
           {point.rmse_m, point.bias_m, point.above_3_percent, point.outlier_rate}) {
        for (const double value : {estimate.value, estimate.interval.low, estimate.interval.high}) {
          row.push_back(fmt::format("{:.6g}", value));
        }
      }
      table.add(std::move(row));
    }
  };
  add(clean);
  for (const SensorAccuracy& other : others) {
    add(other);
  }
  return table;
}

}  // namespace dtof
