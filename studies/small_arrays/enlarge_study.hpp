// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "scenes/scene_study.hpp"
#include "small_arrays/models/learned_enlarger.hpp"

namespace dtof {

/// A map that arrays are compared on.
struct EnlargeScene {
  std::string name;
  TargetMap targets;
  std::vector<bool> guessed =
      {};  ///< [row][column]: depth that the map did not know, not judged; empty: none
};

struct ArraySize {
  int columns = 0;
  int rows = 0;

  bool operator==(const ArraySize&) const = default;
};
/// "100x80". Throws InputError for anything else.
ArraySize parse_array_size(const std::string& text);
/// "100 x 80".
std::string array_size_title(const ArraySize& size);

struct EnlargeSettings {
  SensorModel sensor;  ///< of the large array
  double klux = 50.0;
  std::vector<ArraySize> arrays;
  std::vector<std::string> readouts;  ///< of the small arrays, as SmallArray takes them
  std::string large_readout = "poolpointer";
  EnlargerWeights weights;  ///< of the learned enlarger and the joint bilateral filter
  std::uint64_t seed = 1;   ///< first one; also names the calibration run
  int seeds = 4;
  int threads = 0;
  std::string pictured_scene;  ///< empty: none
  ArraySize pictured_array;    ///< with large_readout, which must then be among `readouts`
};

/// What the small arrays' rows say if they measured every spot without an error: what remains is the
/// enlarger's own.
inline constexpr const char* kNoError = "no error";
/// Titles of the enlargers, in the order of the rows; the large array's row has kNotEnlarged.
inline constexpr const char* kNotEnlarged = "-";
inline constexpr const char* kLearned = "learned";
std::vector<std::string> enlarger_titles();

/// An array with a read-out and an enlarger on one scene.
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
  std::vector<EnlargeRow> rows;   ///< scene by scene: the large array, then every small one
  std::vector<LabelledMap> maps;  ///< of the pictured scene: truth, large array, small one by each enlarger
};

/// Throws InputError for arrays that are not small, or read-outs that SmallArray does not take.
void check_enlarge_settings(const EnlargeSettings& settings);

/// Every scene with every array, read-out and enlarger at one light. The look-up tables are those of one
/// calibration run; photons and intensity images differ from seed to seed. Throws InputError for scenes that
/// have not the sensor's size, and as check_enlarge_settings.
EnlargeStudy run_enlarge_study(const EnlargeSettings& settings, std::span<const EnlargeScene> scenes);

/// A figure of an EnlargeRow.
struct EnlargeFigure {
  const char* title;
  const char* column;  ///< of a CSV file
  ErrorShares SceneScore::*pixels;
  double ErrorShares::*value;
};
std::span<const EnlargeFigure> enlarge_figures();

/// The figure over the pixels of all the rows together, in each seed.
std::vector<double> pooled_figure(std::span<const EnlargeRow* const> rows, const EnlargeFigure& figure);

/// Rows of one array, read-out and enlarger on all scenes.
struct EnlargeEntry {
  ArraySize array;
  std::string readout;
  std::string enlarger;
  std::vector<const EnlargeRow*> rows;
};
/// In the order of the rows of a scene. The study must outlive them.
std::vector<EnlargeEntry> entries_of(const EnlargeStudy& study);

/// One light of the report.
struct EnlargeLight {
  double klux = 0.0;
  EnlargeStudy study;
};
/// Markdown: the answer, computed from the figures, and the tables.
std::string enlarge_answer(std::span<const EnlargeLight> lights);
std::string enlarge_tables(std::span<const EnlargeLight> lights);
std::string enlarge_csv(std::span<const EnlargeLight> lights);

}  // namespace dtof
