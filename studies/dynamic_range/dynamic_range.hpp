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

/// Light, signal and length of a frame.
struct RangeCell {
  double signal = 1.0;  ///< signal events relative to the sensor's
  double klux = 0.0;
  std::uint32_t acquisitions = 0;
  int repeat = 0;  ///< 1: repetition with other photons, to confirm a finding

  auto operator<=>(const RangeCell&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Pixel counts of one seed's frames, over all scenes.
struct RangeCounts {
  std::uint64_t pixels = 0;
  std::uint64_t above_3_percent = 0;
  std::uint64_t above_10_percent = 0;
  std::uint64_t full = 0;  ///< pixels whose confidence is all ones (not counted for pool read-outs)
  std::uint64_t full_above_3_percent = 0;
  // Comparison with the same read-out with counters of 16 bits, on the same photons; 0 if not measured.
  std::uint64_t changed = 0;  ///< pixels whose distance differs
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
  int rows = 16;  ///< judged rows of each scene
  int seeds = 6;  ///< at least 2
  std::uint64_t seed = 1;
  int threads = 0;
  /// Folder with a file for each measured cell. Cells found there are not measured again. The folder must
  /// belong to this program and these settings.
  std::filesystem::path store;
};

/// Counts by read-out name and seed.
using RangeReadouts = std::map<std::string, std::vector<RangeCounts>>;
using RangeResults = std::map<RangeCell, RangeReadouts>;

/// Reads out the middle of the scenes: rows around the sensor's centre. Each read-out has a look-up table by
/// FlatCalibration at the cell's own light and length. `wide`: also read with counters of 16 bits where
/// COUNT_WIDTH allows them. All read-outs see the same photons.
RangeReadouts measure_range_cell(const RangeSettings& settings, const RangeCell& cell, bool wide = false);

/// Measures cells, short frames first, or takes them from the store. `what` names the work and its files.
/// Throws InputError for settings out of range.
RangeResults measure_range_cells(const RangeSettings& settings, std::vector<RangeCell> cells,
                                 const std::string& what, bool wide = false);

/// All cells of the grid.
std::vector<RangeCell> range_grid(const RangeSettings& settings);

/// Share of the pixels, with an interval from the seeds.
Estimate range_share(const std::vector<RangeCounts>& seeds, std::uint64_t RangeCounts::*figure);

/// A read-out that is worse in one cell than a read-out in another cell, beyond both intervals.
struct RangeFinding {
  std::string readout;
  int limit_percent;  ///< error limit of the figure: 3 or 10
  RangeCell cell;
  RangeCell better_cell;
  std::string better_readout;
  Estimate share;
  Estimate better_share;
};

bool about_pool_readout(const RangeFinding& finding);

/// Quantity that is larger in `cell` than in `better_cell`.
enum class Grown { kAcquisitions, kSignal };

/// At most one finding per read-out, limit and cell: the comparison with the best cell in which this quantity
/// alone is smaller.
std::vector<RangeFinding> worse_with_more(const RangeResults& results, Grown grown);
/// Cells of at least `acquisitions` acquisitions in which the coarse histogram is better than a pool
/// read-out.
std::vector<RangeFinding> behind_coarse_histogram(const RangeResults& results, std::uint32_t acquisitions);
/// Findings whose difference appears again in `results`.
std::vector<RangeFinding> confirmed(const std::vector<RangeFinding>& findings, const RangeResults& results);

/// All data of the report.
struct DynamicRange {
  RangeResults grid;
  RangeResults full;  ///< cells of full counters, with counts of wider counters
  std::vector<RangeFinding> more_acquisitions;
  std::vector<RangeFinding> more_signal;
  std::vector<RangeFinding> behind;
  /// Findings about pool read-outs that did not appear again with other photons.
  std::size_t unconfirmed = 0;
};

/// Measures the grid. Then repeats suspicious cells of pool read-outs with other photons, and measures the
/// effect of full counters on the other read-outs.
DynamicRange run_dynamic_range(const RangeSettings& settings);

/// Number of acquisitions from which no pool read-out should be worse than the coarse histogram.
inline constexpr std::uint32_t kManyAcquisitions = 10'000;

}  // namespace dtof
