// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "design_judgement/random_sensor.hpp"
#include "dtof/design/design.hpp"
#include "dtof/metrics/confidence_interval.hpp"

namespace dtof {

/// Where the search lost the best of the sweep.
enum class Lost {
  kNothing,      ///< the recommendation is the best of the sweep
  kNotRead,      ///< the search did not read the best
  kInScreening,  ///< the search's one frame preferred other parameters of the same read-out
  kInFinal,      ///< the search's comparison of read-outs preferred another one
};

enum class Verdict {
  kWithin,     ///< the ratio is at most kGoodRatio, or the shares differ by at most kGoodDifference
  kUndecided,  ///< ratio and difference are larger, and its interval reaches kGoodRatio
  kBeyond,     ///< the difference and the ratio's whole interval are larger, or the recommendation misses a
               ///< limit
};

/// One candidate as the judge read it in the final.
struct JudgedCandidate {
  std::string name;  ///< "sifh --nb 5"
  Estimate share;    ///< pixels above 3 % in the worst light
  double mm2 = 0.0;
  std::size_t place = 0;  ///< in the sweep, from 1; 0: not in the sweep

  bool operator==(const JudgedCandidate&) const = default;
};

struct SensorJudgement {
  std::size_t grid = 0;  ///< candidates of the full grid
  std::size_t kept = 0;  ///< of these, within the limits: the sweep
  std::size_t read = 0;  ///< options that the search read
  bool keeps_limits = true;
  JudgedCandidate recommended;
  JudgedCandidate best;  ///< the finalist with the smallest share
  Estimate ratio;        ///< recommended / best, from pairs with the same seed
  Lost lost = Lost::kNothing;
  double search_best = 0.0;   ///< share of the best, where the search lost it
  double search_other = 0.0;  ///< share of the option that the search preferred

  [[nodiscard]] Verdict verdict() const;
  bool operator==(const SensorJudgement&) const = default;
};

/// Study of `dtof design`: its recommendation for random sensors, compared with the best of a full sweep.
struct JudgementSettings {
  int sensors = 20;
  SensorRanges ranges;
  std::uint64_t seed = 1;  ///< of the sensors; the judge's photons have seeds that follow from it
  int threads = 0;
  double sweep_pixels = 6000.0;   ///< at least, for each candidate and light
  double final_pixels = 12000.0;  ///< at least, for each finalist, light and seed
  int final_seeds = 6;            ///< at least 2
  int finalists = 8;              ///< the best of the sweep that are read again, at least 1
  /// Makes the recommendation. Tests plant another one.
  std::function<DesignResult(const DesignRequest&)> design = run_design;
  /// Folder with a file for each sensor that was judged. Sensors found there are not judged again. The folder
  /// must belong to this program and these settings. Empty: nothing is kept.
  std::filesystem::path store;
  /// Called after each sensor, with its number from 1.
  std::function<void(int number, const SensorJudgement& judgement)> on_judged;
};

/// Ratio of two shares from their values with the same seeds. The interval is that of the ratio's linear
/// approximation (delta method) over the seeds. `pixels`: of all seeds; a smaller `best` than one pixel
/// counts as one pixel.
Estimate share_ratio(std::span<const double> chosen, std::span<const double> best, std::uint64_t pixels);

/// Judges one recommendation: sweeps the whole grid within the limits, and reads the best of the sweep and
/// the recommendation again, with other seeds.
SensorJudgement judge_sensor(const JudgementSettings& settings, const DesignRequest& request, int number);

struct JudgedSensor {
  RandomSensor sensor;
  SensorJudgement judgement;
};
/// Judges all sensors. Throws InputError for settings out of range.
std::vector<JudgedSensor> judge_designs(const JudgementSettings& settings);

}  // namespace dtof
