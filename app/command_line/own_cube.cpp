// SPDX-License-Identifier: Apache-2.0
#include "command_line/own_cube.hpp"

#include <fmt/format.h>

#include "command_line/option_checks.hpp"
#include "dtof/core/error.hpp"
#include "dtof/recording/transient_file.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {
namespace {

constexpr double kPicosecondsPerSecond = 1e12;

TransientScale scale_of(const CubeOptions& options, const TransientFile& file, const SensorModel& sensor) {
  const std::optional<double> bin_width = options.bin_width_s ? options.bin_width_s : file.bin_width_s;
  if (!bin_width) {
    throw InputError(fmt::format(
        "{}: a transient cube needs the width of its bins: --cube-bin-width in s, or bin_width_s in the file",
        options.file));
  }
  if (*bin_width > sensor.integration_time_s) {
    throw InputError(fmt::format("{}: a bin of {:g} s is longer than the sensor's range of {:g} s",
                                 options.file, *bin_width, sensor.integration_time_s));
  }
  return {.bin_width_s = *bin_width,
          .start_s = options.start_s.value_or(file.start_s.value_or(0.0)),
          .events_per_unit = options.events_per_unit.value_or(1.0)};
}

}  // namespace

void CubeOptions::add_to(CLI::App& group) {
  group.add_option(
      "--cube", file,
      "transient cube instead of a scene: NPY, NPZ or HDF5 of shape (rows, columns, time bins),\n"
      "events of a pixel and pulse in each bin, resampled to the array by nearest neighbour");
  group
      .add_option("--cube-bin-width", bin_width_s,
                  "width of the cube's bins in s (default: bin_width_s in the file)")
      ->check(above_zero());
  group.add_option("--cube-start", start_s,
                   "begin of the cube's first bin in s after the laser's shot (default: start_s in the file, "
                   "else 0)");
  group
      .add_option(
          "--cube-scale", events_per_unit,
          "detected events of a pixel and pulse that a value of 1 in the cube stands for (default: 1)")
      ->check(above_zero());
}

void CubeOptions::check() const {
  if (file.empty() && (bin_width_s || start_s || events_per_unit)) {
    throw InputError("--cube-bin-width, --cube-start and --cube-scale need --cube");
  }
}

OwnMap read_own_cube(const CubeOptions& options, const SensorModel& sensor, int columns, int rows,
                     double reflectivity) {
  const TransientFile file = read_transient_file(options.file);
  const TransientScale scale = scale_of(options, file, sensor);
  bool reading = false;  // an error of the reader names the file itself
  const NextValues next = [&](std::span<double> values) {
    reading = true;
    file.array->next(values);
    reading = false;
  };
  try {
    OwnMap map{scene_from_transient_cube(file.array->shape(), next, scale, sensor.pulse_fwhm_s, columns, rows,
                                         reflectivity),
               {}};
    const auto [width, height] = transient_cube_size(file.array->shape());
    map.description =
        fmt::format("{} {} bins of {:g} ps.",
                    resampling_sentence("Transient cube " + options.file, width, height, map.targets),
                    file.array->shape()[2], scale.bin_width_s * kPicosecondsPerSecond);
    return map;
  } catch (const InputError& error) {
    if (reading) {
      throw;
    }
    throw InputError(fmt::format("{}: {}", options.file, error.what()));
  }
}

}  // namespace dtof
