// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// A figure of the study, as tables and the CSV file name it.
struct FilterFigure {
  const char* title;
  const char* column;
};
inline constexpr std::array<FilterFigure, 5> kFilterFigures = {
    {{"above 3 %", "above_3_percent"},
     {"above 10 %", "above_10_percent"},
     {"edges above 3 %", "edge_above_3_percent"},
     {"single pixels above 10 %", "single_above_10_percent"},
     {"flying pixels at edges", "edge_flying"}}};

/// Pixels that a figure is about, and those among them that are wrong.
struct PixelCount {
  std::uint64_t hits = 0;
  std::uint64_t pixels = 0;

  bool operator==(const PixelCount&) const = default;
};
using FilterCounts = std::array<PixelCount, kFilterFigures.size()>;

/// Counts a map's pixels for each figure. A flying pixel is one at an edge whose distance differs by more
/// than 3 % from the true distances of the pixel and its eight neighbours. Pixels without a target are not
/// judged.
FilterCounts count_pixels(const SceneTruth& truth, std::span<const double> measured_m);

/// The `columns` columns in the middle of a scene as a scene of their own, all of whose columns are read. A
/// scene that is not wider is taken whole.
StudyScene middle_columns(const StudyScene& scene, int columns);

/// A measurement's distances after the host filter.
std::vector<double> filtered_distances(const SceneMeasurement& measurement, int columns, double pulse_m);

struct HostFilterSettings {
  SensorModel sensor;
  std::vector<ReadoutParameters> readouts;
  bool references = true;                                             ///< also the matched filters
  std::function<std::vector<StudyScene>(std::uint64_t seed)> scenes;  ///< the same names for every seed
  int columns = 60;                                                   ///< read of each scene
  std::uint64_t seed = 1;                                             ///< the first one
  int seeds = 4;                                                      ///< at least 2
  int threads = 0;
};

/// Counts at one light.
class FilterLight {
 public:
  FilterLight(double klux, std::vector<std::string> scenes, std::vector<std::string> estimators);

  [[nodiscard]] double klux() const { return klux_; }
  [[nodiscard]] const std::vector<std::string>& scenes() const { return scenes_; }
  [[nodiscard]] const std::vector<std::string>& estimators() const { return estimators_; }
  /// Adds the counts of the next seed, before or after the filter.
  void add(std::size_t scene, std::size_t estimator, bool filtered, const FilterCounts& counts);
  [[nodiscard]] std::vector<std::size_t> all_scenes() const;
  /// Pixels that a figure is about, over all seeds.
  [[nodiscard]] std::uint64_t pixels(std::span<const std::size_t> scenes, std::size_t figure) const;
  /// Share of the scenes' pixels together, with the interval of the seeds' spread.
  [[nodiscard]] Estimate estimate(std::span<const std::size_t> scenes, std::size_t estimator, bool filtered,
                                  std::size_t figure) const;

 private:
  [[nodiscard]] const std::vector<FilterCounts>& of(std::size_t scene, std::size_t estimator,
                                                    bool filtered) const;

  double klux_;
  std::vector<std::string> scenes_;
  std::vector<std::string> estimators_;
  std::vector<std::vector<FilterCounts>> counts_;  // [scene, estimator, filtered][seed]
};

/// Reads every scene with every estimator and seed at one light, and filters each map. Throws InputError for
/// fewer than two seeds.
FilterLight measure_host_filter(const HostFilterSettings& settings, double klux);

}  // namespace dtof
