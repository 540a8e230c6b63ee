// SPDX-License-Identifier: Apache-2.0
#include "playground/catalogue.hpp"

#include <fmt/format.h>

#include "dtof/core/parameters.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/frame/frame_maps.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {

std::string playground_sensor_line(std::string_view name, const SensorModel& sensor) {
  return fmt::format("sensor\t{}\t{}\t{}\t{}\t{}\t{:.2f}\t{}\t{}\t{:g}\t{:.4f}\n", name, sensor.columns,
                     sensor.rows, sensor.default_reflectivity, sensor.acquisitions,
                     0.5 * kSpeedOfLight * sensor.integration_time_s, sensor.np, sensor.slots,
                     sensor.integration_time_s * 1e9, 0.5 * kSpeedOfLight * sensor.pulse_fwhm_s);
}

std::string playground_catalogue() {
  std::string text;
  for (const Readout readout : kAllReadouts) {
    text += fmt::format("readout\t{}\t{}\t{}\n", readout_name(readout), readout_title(readout),
                        readout_summary(readout));
  }
  for (const Scene scene : kAllScenes) {
    text += fmt::format("scene\t{}\t{}\n", scene_name(scene), scene_summary(scene));
  }
  for (const std::string_view name : preset_names()) {
    text += playground_sensor_line(name, parse_preset(name));
  }
  for (const std::string& name : figure_names(true)) {
    text += fmt::format("figure\t{}\n", name);
  }
  return text;
}

}  // namespace dtof
