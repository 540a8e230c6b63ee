// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "page/page.hpp"
#include "scenes/scene_study.hpp"
#include "small_arrays/models/learned_enlarger.hpp"

namespace dtof {

/// A map on which arrays are compared.
struct EnlargeScene {
  std::string name;
  TargetMap targets;
  std::vector<bool> guessed =
      {};  ///< [row][column]: true if the map has no depth, not judged; empty: all are known
};

struct ArraySize {
  int columns = 0;
  int rows = 0;

  bool operator==(const ArraySize&) const = default;
};
/// Parses "100x80". Throws InputError for anything else.
ArraySize parse_array_size(const std::string& text);
/// "100 x 80".
std::string array_size_title(const ArraySize& size);

struct EnlargeSettings {
  SensorModel sensor;  ///< sensor of the large array
  double klux = 50.0;
  std::vector<ArraySize> arrays;
  std::vector<std::string> readouts;  ///< read-outs of the small arrays, as SmallArray accepts them
  std::string large_readout = "poolpointer";
  EnlargerWeights weights;  ///< weights of the learned enlarger and of the joint bilateral filter
  std::uint64_t seed = 1;   ///< first seed; also the seed of the calibration run
  int seeds = 4;
  int threads = 0;
  std::string pictured_scene;  ///< scene of the picture; empty: no picture
  ArraySize pictured_array;    ///< used with large_readout, which must then be among `readouts`
};

/// Name of an ideal read-out that measures every spot without error; the remaining errors are the enlarger's
/// own.
inline constexpr const char* kNoError = "no error";
/// Titles of the enlargers, in the order of the rows. Rows of the large array have kNotEnlarged.
inline constexpr const char* kNotEnlarged = "-";
inline constexpr const char* kLearned = "learned";
std::vector<std::string> enlarger_titles();

/// Figures of an array with a read-out and an enlarger on one scene.
struct EnlargeRow {
  std::string scene;
  ArraySize array;
  std::string readout;
  std::string enlarger;
  std::vector<SceneScore> seeds;
};

struct LabelledMap {
  std::string label;
  std::vector<double> distance_m;  ///< [row][column]
};

struct EnlargeStudy {
  std::vector<EnlargeRow> rows;  ///< by scene: the large array, then every small one
  /// Maps of the pictured scene: true distances, large array, small array with each enlarger.
  std::vector<LabelledMap> maps;
};

/// Throws InputError for arrays that are not small, or read-outs that SmallArray does not accept.
void check_enlarge_settings(const EnlargeSettings& settings);

/// Combines every scene with every array, read-out and enlarger, at one light level. All look-up tables come
/// from one calibration run; photons and intensity images differ between seeds. Throws InputError for scenes
/// that differ in size from the sensor, and as check_enlarge_settings.
EnlargeStudy run_enlarge_study(const EnlargeSettings& settings, std::span<const EnlargeScene> scenes);

/// A figure of an EnlargeRow.
struct EnlargeFigure {
  const char* title;
  const char* column;  ///< column of a CSV file
  ErrorShares SceneScore::*pixels;
  double ErrorShares::*value;
};
std::span<const EnlargeFigure> enlarge_figures();

/// Value of the figure over the pixels of all rows together, for each seed.
std::vector<double> pooled_figure(std::span<const EnlargeRow* const> rows, const EnlargeFigure& figure);

/// Rows of one array, read-out and enlarger, for all scenes.
struct EnlargeEntry {
  ArraySize array;
  std::string readout;
  std::string enlarger;
  std::vector<const EnlargeRow*> rows;
};
/// Entries in the order of the rows of a scene. The study must outlive them.
std::vector<EnlargeEntry> entries_of(const EnlargeStudy& study);

/// Results at one light level, for the report.
struct EnlargeLight {
  double klux = 0.0;
  EnlargeStudy study;
};
/// Adds to the data of enlarge.mustache what the page says about the results.
void add_enlarge_results(std::span<const EnlargeLight> lights, PageData& page);
std::string enlarge_csv(std::span<const EnlargeLight> lights);

}  // namespace dtof
