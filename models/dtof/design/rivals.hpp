// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/progress.hpp"
#include "dtof/design/bench.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/rival/rival.hpp"

namespace dtof {

/// Why a rival's area of logic, clock and power are not estimated, for tables and pages.
inline constexpr std::string_view kRivalsWithoutRtl =
    "a rival has no RTL, and the estimates of logic, clock and power are fitted to synthesised RTL";

/// A rival for a sensor. Its memory is known; logic, clock and power are not (kRivalsWithoutRtl).
struct RivalOption {
  const RivalEntry* entry = nullptr;
  int bits_per_pixel = 0;
  int frames = 1;           ///< frames of a result
  double memory_mm2 = 0.0;  ///< SRAMs of all columns, without logic
  ReadoutScore score;       ///< without `threshold`, which is an integer of the read-outs
};

/// A rival that was not read, and why.
struct RivalLeftOut {
  const RivalEntry* entry = nullptr;
  std::string reason;
};

/// Area in mm2 of the SRAMs of a rival's columns: in each column the smallest of 1 to 16 equal macros side by
/// side, of two ports if a pixel has several words. Same rule as synth/dtof_synth/rival_area.py. None if no
/// such macro exists.
std::optional<double> rival_memory_mm2(const RivalHardware& hardware, const SensorModel& sensor);

struct RivalChoice {
  std::vector<RivalOption> options;  ///< not yet read
  std::vector<RivalLeftOut> left_out;
};
/// Divides the rivals into those whose memory alone keeps the limit of area, and the others. A rival without
/// a model for this sensor is one of the others.
RivalChoice choose_rivals(std::span<const RivalEntry> rivals, const SensorModel& sensor, double most_mm2);

/// Number of steps by which read_rivals() advances its progress.
std::size_t rival_steps(const BenchSettings& settings, const BenchEffort& effort);

/// Fills in the scores of all options: by the frames, columns, look-up tables of flat targets and intervals
/// of run_bench() with the same effort. The host decodes each pixel on its own. Frames that a result needs
/// before the measured one show the same scene.
void read_rivals(const BenchSettings& settings, std::span<RivalOption> options, const BenchEffort& effort,
                 Progress* progress = nullptr);

}  // namespace dtof
