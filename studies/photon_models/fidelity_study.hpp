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

namespace dtof {

/// What a user sees of one column of one frame: means over the pixels that have a target.
struct ColumnFigures {
  double bias = 0.0;         ///< of the relative error, (measured - true) / true, before any look-up table
  double mean_square = 0.0;  ///< of the relative error
  double above_3_percent = 0.0;
  double above_10_percent = 0.0;
};

/// One photon model's figure less another's.
struct FigureDifference {
  double value = 0.0;
  double standard_error = 0.0;

  /// The larger end of the 95 % interval, without its sign.
  [[nodiscard]] double upper_limit() const;
};

/// Whether a difference is at most a tolerance.
enum class Promise {
  kKept,    ///< the 95 % intervals of all figures lie within
  kOpen,    ///< more frames would be needed to tell
  kBroken,  ///< a figure is further off than three standard errors explain
};
std::string_view promise_name(Promise promise);

/// What a photon model changes of the figures of a scene.
struct ModelDifference {
  std::array<FigureDifference, 4> figures;  ///< in the order of kFigureNames
  double rmse = 0.0;                        ///< of the exact model's relative error

  /// The largest upper limit of the four.
  [[nodiscard]] double upper_limit() const;
  [[nodiscard]] Promise promise(double tolerance) const;
};
inline constexpr std::array<const char*, 4> kFigureNames = {"rmse", "bias", "above 3 %", "above 10 %"};

/// Compares equally many columns pair by pair, so that what differs between the columns of a scene cancels.
/// At least two pairs (InputError otherwise).
ModelDifference compare_models(std::span<const ColumnFigures> exact, std::span<const ColumnFigures> other);

/// Tolerances for which the study says what `--fidelity auto` takes.
inline constexpr std::array kTolerances = {0.1, 0.03, 0.01, 0.003, 0.001};

/// One scene in one light, read by one read-out with photons of both models.
struct FidelityCell {
  std::string scene;
  double klux = 0.0;
  Readout readout = Readout::kEzPointer;
  ModelDifference difference;
  std::array<Fidelity, kTolerances.size()> taken{};  ///< what auto takes, in the order of kTolerances
  double exact_ms = 0.0;  ///< processor time of a frame with exact streams, photons and read-out
  double fast_ms = 0.0;   ///< with the fast model's sampler
};

/// What drawing the streams of a frame costs, ms of processor time, all scenes and lights together.
struct StreamCost {
  double exact_ms = 0.0;
  double fast_ms = 0.0;
};

struct FidelitySettings {
  SensorModel sensor;
  std::vector<std::pair<std::string, TargetMap>> scenes;
  std::vector<double> klux = {2.0, 14.0, 50.0};
  std::vector<Readout> readouts;  ///< none that pools
  int frames = 4;                 ///< of each scene and light, >= 1
  std::uint64_t seed = 1;
  int threads = 0;
};

struct FidelityStudy {
  std::vector<FidelityCell> cells;
  StreamCost streams;
};

/// Differences depend on the seed alone, times on the machine. Throws InputError for illegal settings.
FidelityStudy run_fidelity_study(const FidelitySettings& settings);

/// The report, every statement computed from the study. `command` is the command line.
std::string fidelity_report(const FidelityStudy& study, const FidelitySettings& settings,
                            const std::string& command);

/// One row per cell and tolerance: what `--fidelity auto` takes there, its cost, the differences measured.
std::string fidelity_csv(const FidelityStudy& study);

}  // namespace dtof
