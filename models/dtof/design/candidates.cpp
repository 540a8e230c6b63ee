// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
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

std::vector<ReadoutParameters> searched_of(Readout readout, const SensorModel& sensor) {
  std::vector<ReadoutParameters> sets = {default_parameters(readout, sensor)};
  const ReadoutParameters base = sets.front();
  if (is_pool_readout(readout)) {
    vary(sets, std::vector<int>{8, 9, 10}, [](auto& p, int value) { p.pool.cell_shift = value; });
    vary(sets, std::vector<int>{6, 7, 8}, [](auto& p, int value) { p.count_width = value; });
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

ArrayChoice array_for(const ReadoutParameters& parameters, const SensorModel& sensor, double clock_hz) {
  ArrayChoice array{.parameters = parameters, .rows = sensor.rows, .columns = sensor.columns};
  if (is_pointer_readout(parameters.readout) && parameters.slots > 1) {
    array.pointer_ports = 1;
  }
  const int widest = EstimateCoefficients::built_in().of(parameters.readout).reference.columns;
  while (array.columns > widest && estimate_cost(array).fmax_mhz < clock_hz * kMegahertz) {
    ++array.arrays;
    array.columns = (sensor.columns + array.arrays - 1) / array.arrays;
  }
  return array;
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
  add("--cell-shift", parameters.pool.cell_shift, base.pool.cell_shift);
  add("--slots", parameters.slots, base.slots);
  if (parameters.window_centred && !base.window_centred) {
    text += " --window-centred";
  }
  return text;
}

std::string product_options(const ArrayChoice& array, const SensorModel& sensor) {
  const std::string options = command_options(array.parameters, sensor);
  return array.pointer_ports == ArrayChoice().pointer_ports
             ? options
             : fmt::format("{} --pointer-ports {}", options, array.pointer_ports);
}

}  // namespace dtof
