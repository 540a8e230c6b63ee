// SPDX-License-Identifier: Apache-2.0
#include "photon/sensor_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "core/error.hpp"

namespace dtof {
namespace {

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

double SensorModel::time_resolution_s() const { return std::ldexp(integration_time_s, -np); }

double SensorModel::signal_events(double depth_m, double reflectivity) const {
  return signal_events_1m * reflectivity / depth_m / depth_m;
}

double SensorModel::background_events(double klux, double reflectivity) const {
  return background_events_per_klux * klux * reflectivity + dark_count_rate_hz * integration_time_s;
}

void SensorModel::validate() const {
  if (np < 3 || np > 16) {
    throw InputError(fmt::format("sensor model: NP must be 3 to 16, not {}", np));
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
  if (coincidence_window_s) {
    require_at_least_zero(*coincidence_window_s, "coincidence window (s)");
  }
  // Written so that a NaN fails.
  if (time_gate && !(time_gate->begin_s >= 0.0 && time_gate->begin_s < time_gate->end_s &&
                     time_gate->end_s <= integration_time_s)) {
    throw InputError(fmt::format(
        "sensor model: the time gate [{} s, {} s) must be inside [0, {} s], its begin below its end",
        time_gate->begin_s, time_gate->end_s, integration_time_s));
  }
}

}  // namespace dtof
