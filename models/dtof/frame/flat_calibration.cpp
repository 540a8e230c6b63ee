// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/flat_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/readout/model.hpp"

namespace dtof {
namespace {

/// Fine where pile-up bends the scale.
std::vector<double> calibration_distances(const SensorModel& sensor) {
  constexpr double kThesisIntegrationTime = 45e-9;
  const double scale = sensor.integration_time_s / kThesisIntegrationTime;
  const double farthest = 0.5 * kSpeedOfLight * (sensor.integration_time_s - 1.5 * sensor.pulse_fwhm_s);
  std::vector<double> distances;
  const auto add = [&](double at_45_ns) {
    const double distance = at_45_ns * scale;
    const double arrival = arrival_centre_s(distance, sensor.pulse_fwhm_s);
    const bool gated_out =
        sensor.time_gate && (arrival < sensor.time_gate->begin_s || arrival >= sensor.time_gate->end_s);
    if (distance <= farthest && !gated_out) {
      distances.push_back(distance);
    }
  };
  for (int i = 2; i < 20; ++i) {
    add(0.05 * i);
  }
  for (int i = 5; i <= 31; ++i) {
    add(0.2 * i);
  }
  if (distances.size() < 2) {
    throw InputError(
        fmt::format("look-up table: T_int = {:g} ns, a pulse of {:g} ns and the time gate leave no two "
                    "distances to fit it to; "
                    "use --table none",
                    sensor.integration_time_s * 1e9, sensor.pulse_fwhm_s * 1e9));
  }
  return distances;
}

TargetMap calibration_targets(const std::vector<double>& distances, int pitch, int pixels,
                              double reflectivity) {
  TargetMap targets(static_cast<int>(distances.size()) * pitch, pixels);
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      targets.at(column, row) = {.depth_m = distances[static_cast<std::size_t>(column / pitch)],
                                 .reflectivity = reflectivity};
    }
  }
  return targets;
}

}  // namespace

std::string_view table_rule_name(TableRule rule) { return rule == TableRule::kNone ? "none" : "flat"; }

TableRule parse_table_rule(std::string_view name) {
  for (const TableRule rule : {TableRule::kNone, TableRule::kFlat}) {
    if (table_rule_name(rule) == name) {
      return rule;
    }
  }
  throw InputError(fmt::format("unknown look-up table '{}': known are none, flat", name));
}

FlatCalibration::FlatCalibration(const SensorModel& sensor, int pixels)
    : reflectivity_(sensor.default_reflectivity),
      // With coincidence, the neighbours of the block that is read belong to the same distance.
      pitch_(sensor.coincidence_window_s ? 3 * sensor.binning : sensor.binning),
      distances_m_(calibration_distances(sensor)),
      targets_(calibration_targets(distances_m_, pitch_, pixels, reflectivity_)) {}

int FlatCalibration::column(std::size_t distance) const {
  return static_cast<int>(distance) * pitch_ + pitch_ / 2;
}

TargetMap FlatCalibration::paired_targets() const {
  TargetMap paired(2 * targets_.columns(), targets_.rows());
  for (int column = 0; column < paired.columns(); ++column) {
    for (int row = 0; row < paired.rows(); ++row) {
      paired.at(column, row) = targets_.at(column % targets_.columns(), row);
    }
  }
  return paired;
}

RangeConverter FlatCalibration::fit(std::span<const Measurement> measurements, double code_step,
                                    std::uint64_t seed) const {
  std::vector<TargetRun> runs;
  for (std::size_t d = 0; d < distances_m_.size(); ++d) {
    TargetRun run{{seed, kFrame}, distances_m_[d], {}};
    for (std::size_t row = 0; row < pixels(); ++row) {
      run.measurements.push_back(measurements[row * distances_m_.size() + d]);
    }
    runs.push_back(std::move(run));
  }
  return RangeConverter::calibrate(runs, code_step);
}

std::vector<RangeConverter> FlatCalibration::fit(const Photons& photons,
                                                 std::span<const ReadoutParameters> readouts,
                                                 std::uint64_t seed, int threads) const {
  const std::size_t width = distances_m_.size();
  std::vector<std::vector<Measurement>> measurements(readouts.size(),
                                                     std::vector<Measurement>(width * pixels()));
  const auto store = [&](std::size_t readout, std::size_t d, std::span<const PixelResult> results) {
    for (std::size_t row = 0; row < pixels(); ++row) {
      measurements[readout][row * width + d] = to_measurement(results[row], readouts[readout].fraction_bits);
    }
  };
  const auto uses_others = [](const ReadoutParameters& readout) { return readout.columns_together() > 1; };
  const std::unique_ptr<StreamSource> source = photons(targets_);
  const std::unique_ptr<StreamSource> pairs =
      std::ranges::any_of(readouts, uses_others) ? photons(paired_targets()) : nullptr;
  parallel_for(width, threads, [&](std::size_t d) {
    const ColumnStream alone = source->column(column(d));
    std::array<ColumnStream, 2> pair;
    if (pairs != nullptr) {
      pair = {pairs->column(targets_.columns() + column(d)), pairs->column(column(d))};
    }
    for (std::size_t r = 0; r < readouts.size(); ++r) {
      ReadoutParameters clear = readouts[r];
      clear.pool.coarse_template = {};  // nothing stands before these targets
      const auto model = make_readout_model(clear);
      store(r, d,
            uses_others(readouts[r]) ? model->run_columns(pair, source->acquisitions()).back()
                                     : model->run_column(alone, source->acquisitions()));
    }
  });
  std::vector<RangeConverter> tables;
  for (std::size_t r = 0; r < readouts.size(); ++r) {
    tables.push_back(fit(measurements[r], std::ldexp(1.0, -readouts[r].fraction_bits), seed));
  }
  return tables;
}

std::string FlatCalibration::description() const {
  return fmt::format("flat targets of reflectivity {:g} at {} distances from {:g} to {:g} m, {} pixels each",
                     reflectivity_, distances_m_.size(), distances_m_.front(), distances_m_.back(),
                     targets_.rows());
}

std::string table_sentence(TableRule rule, const SensorModel& sensor, std::uint64_t seed) {
  if (rule == TableRule::kNone) {
    return "No look-up table (--table none): every distance and figure is that of Eq. 3.11.";
  }
  return fmt::format(
      "Look-up table (--table flat): each read-out has its own, fitted with its model on {}, at the same "
      "light, "
      "from other photons (seed {}, frame {}). Distances and figures are those after it.",
      FlatCalibration(sensor).description(), seed, FlatCalibration::kFrame);
}

}  // namespace dtof
