// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <span>

#include "dtof/core/error.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

constexpr double kMegahertz = 1e-6;

using Setter = std::function<void(ReadoutParameters&, int)>;

bool is_legal(const ReadoutParameters& parameters) {
  try {
    parameters.validate();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Every set once more for each of the values.
void vary(std::vector<ReadoutParameters>& sets, std::span<const int> values, const Setter& set) {
  std::vector<ReadoutParameters> varied;
  for (const ReadoutParameters& one : sets) {
    for (const int value : values) {
      ReadoutParameters other = one;
      set(other, value);
      if (std::ranges::find(varied, other) == varied.end()) {
        varied.push_back(other);
      }
    }
  }
  sets = std::move(varied);
}

/// The read-out's own engine; half of it, where the sensor has more columns than that; and equal engines of
/// at most kWidestEngine columns. An engine that is wider than the sensor is the same hardware as one of the
/// sensor's columns.
std::vector<int> engine_widths(const ReadoutParameters& base, const SensorModel& sensor) {
  const auto even = [](int columns) { return (columns + 1) / 2 * 2; };
  const int own = base.pool.engine_columns;
  const int engines = (sensor.columns + kWidestEngine - 1) / kWidestEngine;
  const int widest = even((sensor.columns + engines - 1) / engines);
  std::set<int> widths = {own};
  if (even(own / 2) < sensor.columns) {
    widths.insert(even(own / 2));
  }
  if (widest > own) {
    widths.insert(widest);
  }
  return {widths.begin(), widths.end()};
}

std::vector<ReadoutParameters> searched_of(Readout readout, const SensorModel& sensor) {
  std::vector<ReadoutParameters> sets = {default_parameters(readout, sensor)};
  const ReadoutParameters base = sets.front();
  if (is_pool_readout(readout)) {
    std::vector<ReadoutParameters> groups = sets;
    vary(sets, std::vector<int>{8, 9, 10}, [](auto& p, int value) { p.pool.cell_shift = value; });
    vary(sets, std::vector<int>{6, 7, 8}, [](auto& p, int value) { p.count_width = value; });
    const PoolPointerParameters& pool = base.pool;
    vary(groups, std::vector<int>{pool.labels - 1, pool.labels + 1},
         [](auto& p, int value) { p.pool.labels = value; });
    vary(groups, std::vector<int>{pool.group_size, 2 * pool.group_size},
         [](auto& p, int value) { p.pool.group_size = value; });
    sets.insert(sets.end(), groups.begin(), groups.end());
    vary(sets, engine_widths(base, sensor), [](auto& p, int value) { p.pool.engine_columns = value; });
  }
  if (!is_pool_readout(readout) && has_parameter(readout, "NB")) {
    vary(sets, std::vector<int>{base.nb - 1, base.nb, base.nb + 1}, [](auto& p, int value) { p.nb = value; });
  }
  if (!is_pool_readout(readout) && has_parameter(readout, "COUNT_WIDTH")) {
    vary(sets, std::vector<int>{8, 10, 12}, [](auto& p, int value) { p.count_width = value; });
  }
  if (is_pointer_readout(readout)) {
    vary(sets, std::vector<int>{0, 2, 4}, [](auto& p, int value) { p.fraction_bits = value; });
  }
  if (has_parameter(readout, "WINDOW_CENTRED")) {
    vary(sets, std::vector<int>{0, 1}, [](auto& p, int value) { p.window_centred = value != 0; });
  }
  std::vector<int> slots;
  for (int value = 1; value <= sensor.slots; ++value) {
    slots.push_back(value);
  }
  vary(sets, slots, [](auto& p, int value) { p.slots = value; });
  std::erase_if(sets, [](const ReadoutParameters& p) { return !is_legal(p); });
  return sets;
}

int pointer_ports_of(const ReadoutParameters& parameters) {
  return is_pointer_readout(parameters.readout) && parameters.slots > 1 ? 1 : 2;
}

/// The array, cut where it is too slow.
ArrayChoice fast_enough(ArrayChoice array, double clock_hz) {
  const int widest = EstimateCoefficients::built_in().of(array.parameters.readout).reference.columns;
  const int whole = array.columns;
  while (estimate_cost(array).fmax_mhz < clock_hz * kMegahertz && array.columns > widest) {
    ++array.arrays;
    array.columns = (whole + array.arrays - 1) / array.arrays;
  }
  return array;
}

}  // namespace

double DesignCandidate::mw(double clock_hz) const {
  return estimate_mw(array, slots_taken, clock_hz * kMegahertz);
}

LimitsKept limits_kept(const DesignCandidate& candidate, const DesignLimits& limits) {
  const double clock_hz = limits.budget.clock_hz;
  return {.area = candidate.cost.mm2 <= limits.most_mm2,
          .power = candidate.mw(clock_hz) <= limits.most_mw,
          .frame = candidate.frames_per_s(clock_hz) >= limits.budget.frames_per_s,
          .clock = candidate.cost.fmax_mhz >= clock_hz * kMegahertz};
}

std::vector<ReadoutParameters> searched_parameters(const SensorModel& sensor) {
  std::vector<ReadoutParameters> found;
  for (const Readout readout : kRtlReadouts) {
    const std::vector<ReadoutParameters> sets = searched_of(readout, sensor);
    found.insert(found.end(), sets.begin(), sets.end());
  }
  return found;
}

ReadoutParameters compared_parameters(ReadoutParameters parameters) {
  const int own = ReadoutParameters::defaults(parameters.readout, parameters.np).pool.engine_columns;
  parameters.pool.engine_columns = std::min(parameters.pool.engine_columns, own);
  return parameters;
}

std::vector<ArrayChoice> arrays_for(const ReadoutParameters& parameters, const SensorModel& sensor,
                                    double clock_hz) {
  std::vector<ArrayChoice> arrays;
  for (const int columns_per_sram : {1, 2, 3, 4, 6, 8, 12, 16}) {
    const int rows = sensor.rows * columns_per_sram;
    if (columns_per_sram > 1 &&
        (is_pool_readout(parameters.readout) || columns_per_sram > sensor.columns ||
         rows > kMostSubsystemRows || rows * parameters.slots > kMostSubsystemLines)) {
      break;
    }
    try {
      arrays.push_back(fast_enough({.parameters = parameters,
                                    .rows = rows,
                                    .columns = (sensor.columns + columns_per_sram - 1) / columns_per_sram,
                                    .pointer_ports = pointer_ports_of(parameters),
                                    .columns_per_sram = columns_per_sram},
                                   clock_hz));
    } catch (const InputError&) {
      break;  // a memory that cannot be made, nor any larger one
    }
  }
  return arrays;
}

std::vector<DesignCandidate> all_candidates(const SensorModel& sensor, double clock_hz,
                                            const std::map<int, double>& slots_taken) {
  std::vector<DesignCandidate> candidates;
  for (const ReadoutParameters& parameters : searched_parameters(sensor)) {
    for (const ArrayChoice& array : arrays_for(parameters, sensor, clock_hz)) {
      candidates.push_back(
          {.array = array,
           .cost = estimate_cost(array),
           .slots_taken = slots_taken.at(parameters.slots),
           .clocks = predicted_frame_clocks(parameters, array.rows, array.columns, sensor.acquisitions)});
    }
  }
  return candidates;
}

SensorModel with_slots(SensorModel sensor, int slots) {
  sensor.slots = slots;
  return sensor;
}

std::string command_options(const ReadoutParameters& parameters, const SensorModel& sensor) {
  const ReadoutParameters base = default_parameters(parameters.readout, sensor);
  std::string text = fmt::format("--readout {}", readout_name(parameters.readout));
  const auto add = [&](std::string_view option, int value, int usual) {
    if (value != usual) {
      text += fmt::format(" {} {}", option, value);
    }
  };
  add("--nb", parameters.nb, base.nb);
  add("--count-width", parameters.count_width, base.count_width);
  add("--fraction-bits", parameters.fraction_bits, base.fraction_bits);
  add("--group-size", parameters.pool.group_size, base.pool.group_size);
  add("--labels", parameters.pool.labels, base.pool.labels);
  add("--cell-shift", parameters.pool.cell_shift, base.pool.cell_shift);
  add("--engine-columns", parameters.pool.engine_columns, base.pool.engine_columns);
  add("--slots", parameters.slots, base.slots);
  if (parameters.window_centred && !base.window_centred) {
    text += " --window-centred";
  }
  return text;
}

std::string product_options(const ArrayChoice& array, const SensorModel& sensor) {
  const ArrayChoice usual;
  std::string options = command_options(array.parameters, sensor);
  if (array.pointer_ports != usual.pointer_ports) {
    options += fmt::format(" --pointer-ports {}", array.pointer_ports);
  }
  if (array.columns_per_sram != usual.columns_per_sram) {
    options += fmt::format(" --columns-per-sram {}", array.columns_per_sram);
  }
  return options;
}

}  // namespace dtof
