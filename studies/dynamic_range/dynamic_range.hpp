// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

/// Light, laser and length of a frame.
struct RangeCell {
  double signal = 1.0;  ///< signal events, times the sensor's
  double klux = 0.0;
  std::uint32_t acquisitions = 0;
  int repeat = 0;  ///< 1: other photons, for what the first ones showed

  auto operator<=>(const RangeCell&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Pixels of one seed's frames, all scenes together.
struct RangeCounts {
  std::uint64_t pixels = 0;
  std::uint64_t above_3_percent = 0;
  std::uint64_t above_10_percent = 0;
  std::uint64_t full = 0;  ///< the result's confidence is all ones (not of the pool read-outs)
  std::uint64_t full_above_3_percent = 0;
  // Against the same read-out with counters of 16 bits on the same photons; 0 where it was not asked for.
  std::uint64_t changed = 0;  ///< pixels of another distance
  std::uint64_t wide_above_3_percent = 0;
  std::uint64_t wide_above_10_percent = 0;

  bool operator==(const RangeCounts&) const = default;
};

struct RangeSettings {
  SensorModel sensor;
  std::vector<ReadoutParameters> readouts;
  std::vector<std::uint32_t> acquisitions;
  std::vector<double> klux;
  std::vector<double> signals;
  std::vector<Scene> scenes = {Scene::kRoom, Scene::kPlanes, Scene::kPoles};
  int rows = 16;  ///< judged of each scene
  int seeds = 6;  ///< at least 2
  std::uint64_t seed = 1;
  int threads = 0;
  /// Folder of the cells that are done, one file each: what lies there is not measured again. It must belong
  /// to this program and these settings.
  std::filesystem::path store;
};

/// Counts of each read-out, by its name, and seed.
using RangeReadouts = std::map<std::string, std::vector<RangeCounts>>;
using RangeResults = std::map<RangeCell, RangeReadouts>;

/// Reads the middle of the scenes out: rows of the sensor's pixels around its centre, a look-up table for
/// each read-out by FlatCalibration at the cell's own light and length. `wide`: also with counters of 16
/// bits, where the read-out has a COUNT_WIDTH that can be so large. All read-outs see the same photons.
RangeReadouts measure_range_cell(const RangeSettings& settings, const RangeCell& cell, bool wide = false);

/// Measures these cells, short frames first, or takes them from the store; `what` names the work and its
/// files. Throws InputError for settings out of range.
RangeResults measure_range_cells(const RangeSettings& settings, std::vector<RangeCell> cells,
                                 const std::string& what, bool wide = false);

/// Every cell of the grid.
std::vector<RangeCell> range_grid(const RangeSettings& settings);

/// Share of the pixels with its interval, from the seeds.
Estimate range_share(const std::vector<RangeCounts>& seeds, std::uint64_t RangeCounts::*figure);

/// A read-out that is worse in one cell than something in another, by more than both intervals.
struct RangeFinding {
  std::string readout;
  int limit_percent;  ///< of the error: 3 or 10
  RangeCell cell;
  RangeCell better_cell;
  std::string better_readout;
  Estimate share;
  Estimate better_share;
};

bool about_pool_readout(const RangeFinding& finding);

/// Which quantity grew from better_cell to cell.
enum class Grown { kAcquisitions, kSignal };

/// For each read-out, limit and cell at most one: against the best cell that differs in a smaller value of
/// this quantity alone.
std::vector<RangeFinding> worse_with_more(const RangeResults& results, Grown grown);
/// Cells of at least so many acquisitions in which the coarse histogram is better than a pool read-out.
std::vector<RangeFinding> behind_coarse_histogram(const RangeResults& results, std::uint32_t acquisitions);
/// Those whose difference `results` show again.
std::vector<RangeFinding> confirmed(const std::vector<RangeFinding>& findings, const RangeResults& results);

/// All that a report says of the grid.
struct DynamicRange {
  RangeResults grid;
  RangeResults full;  ///< cells of settings of full counters, with their counts of wider ones
  std::vector<RangeFinding> more_acquisitions;
  std::vector<RangeFinding> more_signal;
  std::vector<RangeFinding> behind;
  std::size_t unconfirmed = 0;  ///< findings about pool read-outs that other photons did not show again
};

/// Measures the grid, then once more, with other photons, what seems wrong with a pool read-out, and what
/// full counters do to the others.
DynamicRange run_dynamic_range(const RangeSettings& settings);

/// Acquisitions from which no pool read-out should be behind the coarse histogram.
inline constexpr std::uint32_t kManyAcquisitions = 10'000;

}  // namespace dtof
