// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_shares.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {

/// A scene of the study and the number of its columns that are read.
struct StudyScene {
  std::string name;
  TargetMap targets;
  int columns;  ///< columns to read, evenly spread over the map
  std::vector<bool> guessed =
      {};  ///< [row][column]: true if the map has no distance, not judged; empty: all are known
};

/// True for the flat scenes ("flat 1 m").
inline bool is_flat(const std::string& scene) { return scene.starts_with("flat "); }

/// Map column of the `index`-th column read.
int picked_column(const StudyScene& scene, int index);

/// Results of one estimator for a scene.
struct SceneMeasurement {
  std::vector<double> distance_m;  ///< [row * columns + column] over the columns read
  std::vector<double> confidence;
};

struct SceneScore {
  ErrorShares all;
  ErrorShares edges;  ///< pixels with a neighbour whose distance differs by more than 10 %
  ErrorShares rest;
  ErrorShares dims;     ///< pixels with at most a quarter of the scene's largest reflectivity
  ErrorShares singles;  ///< pixels whose distance differs by more than 10 % from that of every neighbour
  /// Share of the outliers (errors above 10 %) among the pixels dropped; see kDropped.
  std::vector<double> removed;
};

/// Shares of pixels that are dropped for the confidence curve, lowest confidence first.
inline constexpr std::array kDropped = {0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5};

/// True distances and kinds of the pixels read, in the order of SceneMeasurement.
struct SceneTruth {
  int columns = 0;
  int rows = 0;
  std::vector<double> distance_m;  ///< 0: no target, not judged
  std::vector<bool> edge;      ///< differs by more than 10 % from some neighbour (left, right, above, below)
  std::vector<bool> single;    ///< differs by more than 10 % from every neighbour
  std::vector<bool> dim = {};  ///< at most a quarter of the scene's largest reflectivity; empty: unknown
};
SceneTruth scene_truth(const StudyScene& scene);

SceneScore score_scene(const SceneTruth& truth, const SceneMeasurement& measurement);

/// Precision relative to the bound of a single pixel: the median of |error| / bound divided by that of a
/// normal variable. 1 for an unbiased read-out that reaches every pixel's bound; insensitive to outliers.
/// `relative_bound`: bound of each pixel, relative to its distance; pixels without a finite bound above 0 are
/// left out. NaN without pixels or bounds.
double median_error_over_bound(const SceneTruth& truth, std::span<const double> relative_bound,
                               const SceneMeasurement& measurement);

/// Reads out scenes with the models of several read-outs. Unless `references` is false, it also reads
/// hisPointer with paired coarse bins and two references on full histograms. The references know each pixel's
/// signal and background: the matched filter of the single pixel, and the pooled one
/// (readout/pooled_matched_filter.hpp). All see the same photons; poolPointer also those of the other columns
/// of its engines. With TableRule::kFlat each has a look-up table by FlatCalibration, else distances follow
/// Eq. 3.11.
class SceneStudy {
 public:
  SceneStudy(SensorModel sensor, double klux, std::span<const ReadoutParameters> readouts, std::uint64_t seed,
             int threads, TableRule table = TableRule::kFlat, bool references = true);

  [[nodiscard]] const std::vector<std::string>& estimators() const { return titles_; }
  /// One measurement per estimator, of the n-th frame of the scene. Each frame has its own photons.
  [[nodiscard]] std::vector<SceneMeasurement> measure(const StudyScene& scene, std::uint32_t n = 0) const;
  /// Cramer-Rao bound of each single pixel divided by its distance, in the order of SceneMeasurement; 0
  /// without a target.
  [[nodiscard]] std::vector<double> relative_bounds(const StudyScene& scene) const;

 private:
  using Positions = std::vector<std::vector<Measurement>>;  // estimator, row * columns + column
  [[nodiscard]] bool uses_other_columns(std::size_t estimator) const;
  /// Reads with all estimators except read-outs whose columns depend on each other.
  [[nodiscard]] Positions read(const SensorModel& sensor, const StudyScene& scene, std::uint32_t frame) const;
  /// Reads with the read-outs whose columns depend on each other. Processes whole engines of the scene,
  /// however few columns are asked for.
  void read_engines(const StudyScene& scene, std::uint32_t frame, Positions& positions) const;
  [[nodiscard]] double distance(std::size_t estimator, double position) const;

  SensorModel sensor_;
  double klux_;
  std::vector<ReadoutParameters> readouts_;
  std::vector<std::string> titles_;
  std::uint64_t seed_;
  int threads_;
  bool references_;
  DepthScale scale_;
  std::vector<RangeConverter> converters_;  // for each estimator; empty without look-up tables
};

}  // namespace dtof
