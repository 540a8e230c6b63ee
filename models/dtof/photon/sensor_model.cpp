// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/sensor_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "dtof/core/error.hpp"
#include "dtof/core/parameter_limits.hpp"
#include "dtof/core/random.hpp"
#include "dtof/photon/physics.hpp"

namespace dtof {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

void require_at_least_zero(double value, std::string_view what) {
  if (!std::isfinite(value) || value < 0.0) {
    throw InputError(
        fmt::format("sensor model: {} must be a finite number of at least 0, not {}", what, value));
  }
}

void require_positive(double value, std::string_view what) {
  if (!std::isfinite(value) || value <= 0.0) {
    throw InputError(fmt::format("sensor model: {} must be a finite number above 0, not {}", what, value));
  }
}

}  // namespace

namespace {

double defect_draw(std::uint64_t seed, int column, int row) {
  return CounterRandom(seed, static_cast<std::uint32_t>(RandomPurpose::kPixelDefects),
                       static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row))
      .uniform();
}

}  // namespace

bool PixelDefects::is_dead(int column, int row) const {
  return (dead_share > 0.0 && defect_draw(seed, column, row) < dead_share) ||
         std::ranges::find(dead, PixelPosition{column, row}) != dead.end();
}

bool PixelDefects::is_hot(int column, int row) const {
  return !is_dead(column, row) && ((hot_share > 0.0 && defect_draw(seed, column, row) >= 1.0 - hot_share) ||
                                   std::ranges::find(hot, PixelPosition{column, row}) != hot.end());
}

double SensorModel::time_resolution_s() const { return std::ldexp(integration_time_s, -np); }

double SensorModel::pulse_sigma_s() const {
  const double pulse =
      pulse_response ? pulse_response->standard_deviation() : dtof::pulse_sigma_s(pulse_fwhm_s);
  return jitter_fwhm_s == 0.0 ? pulse : std::hypot(pulse, dtof::pulse_sigma_s(jitter_fwhm_s));
}

std::shared_ptr<const PulseResponse> SensorModel::pulse_response_bins() const {
  if (!pulse_response) {
    return nullptr;
  }
  return std::make_shared<const PulseResponse>(
      pulse_response->broadened(dtof::pulse_sigma_s(jitter_fwhm_s)).scaled(1.0 / time_resolution_s()));
}

double SensorModel::signal_events(double depth_m, double reflectivity) const {
  return signal_events_1m * reflectivity / depth_m / depth_m;
}

double SensorModel::background_events(double klux, double reflectivity) const {
  return background_events_per_klux * klux * reflectivity + dark_count_rate_hz * integration_time_s;
}

double SensorModel::pulse_period() const {
  constexpr double kFramesPerSecond = 30.0;
  return pulse_period_s > 0.0 ? pulse_period_s : 1.0 / kFramesPerSecond / acquisitions;
}

SensorModel SensorModel::as_calibrated() const {
  SensorModel model = *this;
  model.surroundings = {};
  return model;
}

void SensorModel::validate() const {
  ReadoutParameters bits;
  bits.np = np;
  if (const ParameterLimit* const broken = broken_limit(bits, "NP")) {
    throw InputError(fmt::format("sensor model: {}, not {}", broken->sentence, np));
  }
  if (slots < 1) {
    throw InputError(fmt::format("sensor model: SLOTS must be at least 1, not {}", slots));
  }
  if (binning < 1) {
    throw InputError(fmt::format("sensor model: binning must be at least 1, not {}", binning));
  }
  if (columns < 1 || rows < 1) {
    throw InputError(
        fmt::format("sensor model: the array must have at least 1 x 1 pixels, not {} x {}", columns, rows));
  }
  if (binning > std::max(columns, rows)) {
    throw InputError(
        fmt::format("sensor model: binning must be at most {}, the array has {} x {} pixels, not {}",
                    std::max(columns, rows), columns, rows, binning));
  }
  // Written so that a NaN fails.
  if (!(field_of_view_deg > 0.0 && field_of_view_deg <= 180.0)) {
    throw InputError(fmt::format("sensor model: the field of view must be above 0 to 180 degrees, not {}",
                                 field_of_view_deg));
  }
  require_positive(integration_time_s, "integration time (s)");
  require_positive(pulse_fwhm_s, "pulse FWHM (s)");
  require_at_least_zero(signal_events_1m, "signal events at 1 m");
  require_at_least_zero(background_events_per_klux, "background events per klux");
  require_at_least_zero(dark_count_rate_hz, "dark count rate (Hz)");
  require_at_least_zero(dead_time_s, "dead time (s)");
  require_at_least_zero(default_reflectivity, "reflectivity");
  require_at_least_zero(jitter_fwhm_s, "jitter FWHM (s)");
  // Written so that a NaN fails. Above 0.9 a pixel would fire nearly without end.
  if (!(afterpulse_probability >= 0.0 && afterpulse_probability <= 0.9)) {
    throw InputError(fmt::format("sensor model: the afterpulsing probability must be 0 to 0.9, not {}",
                                 afterpulse_probability));
  }
  if (afterpulse_probability > 0.0) {
    require_positive(afterpulse_time_constant_s, "afterpulsing time constant (s)");
  }
  if (!(defects.hot_share >= 0.0 && defects.dead_share >= 0.0 &&
        defects.hot_share + defects.dead_share <= 1.0)) {
    throw InputError(
        fmt::format("sensor model: the shares of hot and dead pixels must be at least 0 and together at "
                    "most 1, not {} and {}",
                    defects.hot_share, defects.dead_share));
  }
  require_at_least_zero(defects.hot_dark_count_rate_hz, "dark count rate of hot pixels (Hz)");
  if (coincidence_window_s) {
    require_at_least_zero(*coincidence_window_s, "coincidence window (s)");
  }
  require_at_least_zero(pulse_period_s, "pulse period (s)");
  surroundings.validate();
  if (surroundings.other_laser.events > 0.0) {
    const FiringOffsets& offsets = surroundings.firing_offsets;
    const double longest =
        integration_time_s + offsets.step_s * ((1U << static_cast<unsigned>(offsets.bits)) - 1U);
    if (pulse_period() < longest) {
      throw InputError(
          fmt::format("sensor model: pulses every {:g} ns overlap: range and firing offsets take {:g} ns",
                      pulse_period() * kNanosecondsPerSecond, longest * kNanosecondsPerSecond));
    }
  }
  // Written so that a NaN fails.
  if (time_gate && !(time_gate->begin_s >= 0.0 && time_gate->begin_s < time_gate->end_s &&
                     time_gate->end_s <= integration_time_s)) {
    throw InputError(fmt::format(
        "sensor model: the time gate, {:g} to {:g} ns, must be inside 0 to {:g} ns, its begin below its end",
        time_gate->begin_s * kNanosecondsPerSecond, time_gate->end_s * kNanosecondsPerSecond,
        integration_time_s * kNanosecondsPerSecond));
  }
}

}  // namespace dtof
