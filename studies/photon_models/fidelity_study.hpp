// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "page/page.hpp"

namespace dtof {

/// Error figures of one column of a frame: means over the pixels that have a target.
struct ColumnFigures {
  double bias = 0.0;         ///< of the relative error, (measured - true) / true, before any look-up table
  double mean_square = 0.0;  ///< mean square of the relative error
  double above_3_percent = 0.0;
  double above_10_percent = 0.0;
};

/// Difference of a figure between two photon models.
struct FigureDifference {
  double value = 0.0;
  double standard_error = 0.0;

  /// Larger absolute end of the 95 % interval.
  [[nodiscard]] double upper_limit() const;
};

/// Whether a difference is within a tolerance.
enum class Promise {
  kKept,    ///< the 95 % intervals of all figures lie within the tolerance
  kOpen,    ///< more frames would be needed to decide
  kBroken,  ///< a figure exceeds the tolerance by more than three standard errors
};
std::string_view promise_name(Promise promise);

/// Differences of a scene's figures between a photon model and the exact one.
struct ModelDifference {
  std::array<FigureDifference, 4> figures;  ///< in the order of kFigureNames
  double rmse = 0.0;                        ///< of the exact model's relative error

  /// Largest upper limit of the four figures.
  [[nodiscard]] double upper_limit() const;
  [[nodiscard]] Promise promise(double tolerance) const;
};
inline constexpr std::array<const char*, 4> kFigureNames = {"rmse", "bias", "above 3 %", "above 10 %"};

/// Compares two photon models column by column, so that differences between the columns of a scene cancel.
/// Throws InputError for fewer than two pairs or different numbers of columns.
ModelDifference compare_models(std::span<const ColumnFigures> exact, std::span<const ColumnFigures> other);

/// Tolerances for which the study reports the choice of `--fidelity auto`.
inline constexpr std::array kTolerances = {0.1, 0.03, 0.01, 0.003, 0.001};

/// One read-out for one scene and light level, with photons of both models.
struct FidelityCell {
  std::string scene;
  double klux = 0.0;
  Readout readout = Readout::kEzPointer;
  ModelDifference difference;
  std::array<Fidelity, kTolerances.size()> taken{};  ///< choice of `--fidelity auto` for each of kTolerances
  double exact_ms = 0.0;  ///< processor time of a frame with exact streams, photons and read-out included
  double fast_ms = 0.0;   ///< processor time of a frame with the fast model's sampler
};

/// Processor time to draw the streams of a frame, ms, over all scenes and light levels.
struct StreamCost {
  double exact_ms = 0.0;
  double fast_ms = 0.0;
};

struct FidelitySettings {
  SensorModel sensor;
  std::vector<std::pair<std::string, TargetMap>> scenes;
  std::vector<double> klux = {2.0, 14.0, 50.0};
  std::vector<Readout> readouts;  ///< without pool read-outs
  int frames = 4;                 ///< per scene and light level, >= 1
  std::uint64_t seed = 1;
  int threads = 0;
};

struct FidelityStudy {
  std::vector<FidelityCell> cells;
  StreamCost streams;
};

/// Runs the study. Differences depend on the seed alone, times on the machine. Throws InputError for illegal
/// settings.
FidelityStudy run_fidelity_study(const FidelitySettings& settings);

/// Data of the page fidelity.mustache; every statement follows from the study. `command`: the command line.
PageData fidelity_page(const FidelityStudy& study, const FidelitySettings& settings,
                       const std::string& command);

/// A row per cell and tolerance: the choice of `--fidelity auto`, its cost, and the measured differences.
std::string fidelity_csv(const FidelityStudy& study);

}  // namespace dtof
