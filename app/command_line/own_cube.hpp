// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "command_line/own_map.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// A user's transient cube.
struct CubeOptions {
  std::string file;  ///< path, or array in an archive (container/array_address.hpp); empty: none
  std::optional<double> bin_width_s;
  std::optional<double> start_s;
  std::optional<double> events_per_unit;

  /// Adds --cube and the options of its scale.
  void add_to(CLI::App& group);
  /// Throws InputError for options of a scale without a cube.
  void check() const;
};

/// Reads the cube and resamples it to columns x rows by nearest neighbour. Options win over what the file
/// says of its time axis. Throws InputError that names the file.
OwnMap read_own_cube(const CubeOptions& options, const SensorModel& sensor, int columns, int rows,
                     double reflectivity);

}  // namespace dtof
