// SPDX-License-Identifier: Apache-2.0
#include "pool/pool_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "dtof/analytic/pulse_match.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/matched_filter.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/pooled_matched_filter.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

using Design = PoolNumbers;

struct Number {
  std::string_view name;
  int& (*of)(Design&);
};

constexpr std::array kNumbers = std::to_array<Number>({
    {"COUNT_WIDTH", [](Design& d) -> int& { return d.count_width; }},
    {"GROUP_ROWS", [](Design& d) -> int& { return d.group_rows; }},
    {"LABELS", [](Design& d) -> int& { return d.labels; }},
    {"SCORE_BITS", [](Design& d) -> int& { return d.score_bits; }},
    {"OFFSET_BITS", [](Design& d) -> int& { return d.offset_bits; }},
    {"POINTER_SHIFT", [](Design& d) -> int& { return d.pointer_shift; }},
    {"ENGINE_COLUMNS", [](Design& d) -> int& { return d.engine_columns; }},
    {"ADVANTAGE_WIDTH", [](Design& d) -> int& { return d.count_bits; }},
    {"RIVAL_MOVES", [](Design& d) -> int& { return d.rival_moves; }},
    {"CELL_SHIFT", [](Design& d) -> int& { return d.cell_shift; }},
    {"COARSE_SHARE", [](Design& d) -> int& { return d.coarse_share; }},
    {"TRACK_SHARE", [](Design& d) -> int& { return d.track_share; }},
    {"OWN_WEIGHT", [](Design& d) -> int& { return d.own_weight; }},
    {"LEAK_SHIFT", [](Design& d) -> int& { return d.leak_shift; }},
    {"TRACK_REACH", [](Design& d) -> int& { return d.track_reach; }},
    {"OFFSET_GEAR_0", [](Design& d) -> int& { return d.offset_gear[0]; }},
    {"OFFSET_GEAR_1", [](Design& d) -> int& { return d.offset_gear[1]; }},
    {"LABEL_COST", [](Design& d) -> int& { return d.label_cost.base; }},
    {"LABEL_COST_SLOPE", [](Design& d) -> int& { return d.label_cost.slope; }},
    {"CHOOSE_PENALTY", [](Design& d) -> int& { return d.choose_penalty.base; }},
    {"CHOOSE_PENALTY_SLOPE", [](Design& d) -> int& { return d.choose_penalty.slope; }},
    {"LEFT_COST", [](Design& d) -> int& { return d.left_cost.base; }},
    {"LEFT_COST_SLOPE", [](Design& d) -> int& { return d.left_cost.slope; }},
    {"RIGHT_LIMIT", [](Design& d) -> int& { return d.right_limit.base; }},
    {"RIGHT_LIMIT_SLOPE", [](Design& d) -> int& { return d.right_limit.slope; }},
    {"LATERAL_REACH", [](Design& d) -> int& { return d.lateral_reach; }},
    {"WEIGHT_0", [](Design& d) -> int& { return d.windows.weight[0]; }},
    {"WEIGHT_1", [](Design& d) -> int& { return d.windows.weight[1]; }},
    {"WEIGHT_2", [](Design& d) -> int& { return d.windows.weight[2]; }},
    {"WEIGHT_3", [](Design& d) -> int& { return d.windows.weight[3]; }},
    {"WEIGHT_4", [](Design& d) -> int& { return d.windows.weight[4]; }},
    {"WEIGHT_5", [](Design& d) -> int& { return d.windows.weight[5]; }},
    {"WEIGHT_6", [](Design& d) -> int& { return d.windows.weight[6]; }},
    {"WEIGHT_7", [](Design& d) -> int& { return d.windows.weight[7]; }},
    {"RIVAL_REACH", [](Design& d) -> int& { return d.windows.rival_reach; }},
    {"DECIDE_PENALTY", [](Design& d) -> int& { return d.decide_penalty.base; }},
    {"DECIDE_PENALTY_SLOPE", [](Design& d) -> int& { return d.decide_penalty.slope; }},
    {"LEFT_NEEDS_MARGIN", [](Design& d) -> int& { return d.left_needs_margin; }},
    {"SMOOTH_DARK", [](Design& d) -> int& { return d.smooth_reach[0]; }},
    {"SMOOTH_BRIGHT", [](Design& d) -> int& { return d.smooth_reach[1]; }},
    {"SMOOTH_BRIGHT_FROM", [](Design& d) -> int& { return d.smooth_bright_from; }},
});

int& number_of(Design& design, std::string_view name) {
  const auto found = std::ranges::find(kNumbers, name, &Number::name);
  if (found == kNumbers.end()) {
    throw InputError(fmt::format("poolPointer has no {} to change; known are {}", name,
                                 fmt::join(pool_design_names(), ", ")));
  }
  return found->of(design);
}

constexpr int kFractionOf16 = 16;  // bits of a position

/// Positions on the code axis as winners, in the groups of a design.
PoolWinners as_winners(std::span<const Measurement> column, const PoolWinners& groups, int np) {
  const double units = std::ldexp(1.0, kFractionOf16 - np);
  PoolWinners winners;
  for (std::size_t row = 0; row < column.size(); ++row) {
    winners.push_back({.position = static_cast<std::int32_t>(std::lround(column[row].position * units)),
                       .lost = 0,
                       .advantage = 0,
                       .margin = 0,
                       .background = groups[row].background});
  }
  return winners;
}

/// What the full histograms of a column say: the single pixels' peaks and the pooled ones.
struct FullHistograms {
  std::vector<Measurement> single;
  std::vector<Measurement> pooled;
};

FullHistograms read_full_histograms(const ColumnStream& stream, const SensorModel& sensor,
                                    const PhotonSource& source, int column) {
  const auto rows = static_cast<std::size_t>(stream.rows());
  const auto bins = (std::size_t{1} << static_cast<unsigned>(sensor.np)) - 1;
  FullHistograms read{std::vector<Measurement>(rows), std::vector<Measurement>(rows)};
  // The template depends on the rates: neighbouring pixels of equal rates share a filter.
  std::unique_ptr<MatchedFilter> filter;
  PixelRates matched;
  std::vector<std::vector<double>> scores(rows, std::vector<double>(bins, 0.0));
  for (std::size_t row = 0; row < rows; ++row) {
    const PixelRates rates = source.rates(column, static_cast<int>(row));
    if (rates.signal <= 0.0) {
      continue;  // no pulse to look for, and nothing to tell the neighbours
    }
    if (!filter || rates.signal != matched.signal || rates.background != matched.background) {
      filter = std::make_unique<MatchedFilter>(matched_to(sensor, rates));
      matched = rates;
    }
    std::ranges::copy(filter->scores(stream.row(static_cast<int>(row))), scores[row].begin());
    const auto peak = std::ranges::max_element(scores[row]);
    read.single[row] = {refined_peak(scores[row], static_cast<std::size_t>(peak - scores[row].begin())),
                        *peak};
  }
  const std::vector<MatchedFilter::Result> pooled = pool_column(scores);
  for (std::size_t row = 0; row < rows; ++row) {
    read.pooled[row] = {pooled[row].position, pooled[row].score};
  }
  return read;
}

constexpr std::size_t kReferences = 3;  // estimators that are no design

}  // namespace

std::vector<std::string> pool_design_names() {
  std::vector<std::string> names;
  names.reserve(kNumbers.size());
  for (const Number& number : kNumbers) {
    names.emplace_back(number.name);
  }
  return names;
}

int pool_design_number(const PoolNumbers& design, const std::string& name) {
  Design copy = design;
  return number_of(copy, name);
}

PoolNumbers with_pool_design_number(PoolNumbers design, const std::string& name, int number) {
  number_of(design, name) = number;
  return design;
}

PoolNumbers parse_pool_design(const std::string& text) {
  Design design;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view change = rest.substr(0, comma);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
    const std::size_t equals = std::min(change.find('='), change.size());
    const std::string_view number = change.substr(std::min(equals + 1, change.size()));
    int value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc() || end != number.data() + number.size()) {
      throw InputError(fmt::format("design {}: expected NAME=NUMBER,...", text));
    }
    number_of(design, change.substr(0, equals)) = value;
  }
  design.validate();
  return design;
}

PoolFrame draw_pool_frame(const SensorModel& sensor, const TargetMap& targets, double klux,
                          std::uint64_t seed, std::uint32_t frame, int engine_columns, int threads) {
  const PhotonSource source(sensor, targets, klux, seed, frame);
  const int engines = (targets.columns() + engine_columns - 1) / engine_columns;
  PoolFrame drawn{sensor.acquisitions,
                  std::vector<std::vector<PoolColumn>>(static_cast<std::size_t>(engines))};
  parallel_for(static_cast<std::size_t>(engines), threads, [&](std::size_t engine) {
    const int begin = static_cast<int>(engine) * engine_columns;
    for (int column = begin; column < std::min(begin + engine_columns, targets.columns()); ++column) {
      drawn.engines[engine].push_back(
          pool_column_events(source.column(column), sensor.np, sensor.acquisitions));
    }
  });
  return drawn;
}

PoolStudy::PoolStudy(SensorModel sensor, double klux, std::span<const std::string> designs, bool references,
                     std::uint64_t seed, int threads, TableRule table)
    : sensor_(std::move(sensor)),
      klux_(klux),
      references_(references),
      seed_(seed),
      threads_(threads),
      scale_(sensor_.integration_time_s, sensor_.np, sensor_.pulse_fwhm_s) {
  if (references_) {
    titles_ = {"matched filter (single pixel)", "matched filter, S1", "pooled matched filter"};
  }
  for (const std::string& text : designs) {
    designs_.push_back(parse_pool_design(text));
    const std::string title = text.empty() ? "poolPointer" : "poolPointer " + text;
    titles_.push_back(title + ", no S1");
    titles_.push_back(title);
  }
  if (table == TableRule::kNone) {
    return;
  }
  // Each distance has an engine of a pair of its own, whose right column is read.
  const FlatCalibration calibration(sensor_);
  const std::size_t width = calibration.distances_m().size();
  TargetMap targets(2 * static_cast<int>(width), FlatCalibration::kPixels);
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      targets.at(column, row) = {.depth_m = calibration.distances_m()[static_cast<std::size_t>(column / 2)],
                                 .reflectivity = sensor_.default_reflectivity};
    }
  }
  const Positions positions = read(targets, FlatCalibration::kFrame, 2);
  for (std::size_t e = 0; e < titles_.size(); ++e) {
    std::vector<Measurement> right;
    for (std::size_t i = 1; i < positions[e].size(); i += 2) {
      right.push_back(positions[e][i]);
    }
    const bool continuous = references_ && e < kReferences;
    converters_.push_back(
        calibration.fit(right, continuous ? 0.0 : std::ldexp(1.0, sensor_.np - kFractionOf16), seed_));
  }
}

PoolStudy::Positions PoolStudy::read(const TargetMap& targets, std::uint32_t frame,
                                     int engine_columns) const {
  const PhotonSource source(sensor_, targets, klux_, seed_, frame);
  const auto width = static_cast<std::size_t>(targets.columns());
  const auto rows = static_cast<std::size_t>(targets.rows());
  const auto step = static_cast<std::size_t>(engine_columns);
  Positions positions(titles_.size(), std::vector<Measurement>(width * rows));
  parallel_for((width + step - 1) / step, threads_, [&](std::size_t engine) {
    const std::size_t begin = engine * step;
    const std::size_t end = std::min(begin + step, width);
    const auto store = [&](std::size_t estimator, std::size_t column, std::span<const Measurement> values) {
      for (std::size_t row = 0; row < rows; ++row) {
        positions[estimator][row * width + column] = values[row];
      }
    };
    std::vector<PoolColumn> events;
    std::vector<std::vector<Measurement>> single;
    for (std::size_t column = begin; column < end; ++column) {
      const ColumnStream stream = source.column(static_cast<int>(column));
      events.push_back(pool_column_events(stream, sensor_.np, sensor_.acquisitions));
      if (references_) {
        const FullHistograms full = read_full_histograms(stream, sensor_, source, static_cast<int>(column));
        store(0, column, full.single);
        store(2, column, full.pooled);
        single.push_back(full.single);
      }
    }
    const int fraction_bits = kFractionOf16 - sensor_.np;
    for (std::size_t d = 0; d < designs_.size(); ++d) {
      const std::vector<PoolWinners> winners = read_engine(events, sensor_.acquisitions, designs_[d]);
      const std::size_t first = (references_ ? kReferences : 0) + 2 * d;
      PoolWinners filter_left;
      for (std::size_t i = 0; i < winners.size(); ++i) {
        const std::vector<std::int32_t> smooth =
            smoothed_positions(winners[i], i > 0 ? winners[i - 1] : PoolWinners(), designs_[d]);
        std::vector<Measurement> raw;
        std::vector<Measurement> filtered;
        for (std::size_t row = 0; row < rows; ++row) {
          const auto measured = [&](std::int32_t position) {
            return to_measurement(
                pool_result(position, winners[i][row].margin, static_cast<unsigned>(fraction_bits)),
                fraction_bits);
          };
          raw.push_back(measured(winners[i][row].position));
          filtered.push_back(measured(smooth[row]));
        }
        store(first, begin + i, raw);
        store(first + 1, begin + i, filtered);
        if (references_ && d == 0) {  // the matched filter gets the first design's S1
          const PoolWinners filter = as_winners(single[i], winners[i], sensor_.np);
          const std::vector<std::int32_t> moved = smoothed_positions(filter, filter_left, designs_[d]);
          std::vector<Measurement> values = single[i];
          for (std::size_t row = 0; row < rows; ++row) {
            values[row].position += std::ldexp(moved[row] - filter[row].position, -fraction_bits);
          }
          store(1, begin + i, values);
          filter_left = filter;
        }
      }
    }
  });
  return positions;
}

std::vector<SceneMeasurement> PoolStudy::measure(const StudyScene& scene) const {
  if (scene.columns != scene.targets.columns()) {
    throw InputError(fmt::format("{}: poolPointer reads all {} columns of a map, not {}", scene.name,
                                 scene.targets.columns(), scene.columns));
  }
  const Positions positions = read(scene.targets, scene_frame(0), designs_.front().engine_columns);
  std::vector<SceneMeasurement> measurements(titles_.size());
  for (std::size_t e = 0; e < titles_.size(); ++e) {
    for (const Measurement& pixel : positions[e]) {
      measurements[e].distance_m.push_back(converters_.empty() ? scale_.depth(pixel.position)
                                                               : converters_[e].distance(pixel.position));
      measurements[e].confidence.push_back(pixel.confidence);
    }
  }
  return measurements;
}

}  // namespace dtof
