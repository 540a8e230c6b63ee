// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/metrics/error_shares.hpp"
#include "dtof/report/table.hpp"
#include "page/page.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// What is counted of a scene.
struct PoolFigure {
  const char* name;
  const char* column;  ///< of the CSV file
  ErrorShares SceneScore::*pixels;
  double ErrorShares::*share;
};
inline constexpr std::array<PoolFigure, 7> kPoolFigures = {
    {{"above 3 %", "above_3_percent", &SceneScore::all, &ErrorShares::above_3_percent},
     {"above 10 %", "above_10_percent", &SceneScore::all, &ErrorShares::above_10_percent},
     {"edges above 3 %", "edge_above_3_percent", &SceneScore::edges, &ErrorShares::above_3_percent},
     {"edges above 10 %", "edge_above_10_percent", &SceneScore::edges, &ErrorShares::above_10_percent},
     {"other pixels above 3 %", "rest_above_3_percent", &SceneScore::rest, &ErrorShares::above_3_percent},
     {"other pixels above 10 %", "rest_above_10_percent", &SceneScore::rest, &ErrorShares::above_10_percent},
     {"single pixels above 10 %", "single_above_10_percent", &SceneScore::singles,
      &ErrorShares::above_10_percent}}};

/// Scores of one light level: scene, estimator, seed.
class PoolScores {
 public:
  PoolScores(std::vector<std::string> scenes, std::vector<std::string> estimators)
      : scenes_(std::move(scenes)), estimators_(std::move(estimators)) {}

  void add(std::size_t scene, std::size_t estimator, const SceneScore& score) {
    scores_[{scene, estimator}].push_back(score);
  }
  [[nodiscard]] const std::vector<std::string>& scenes() const { return scenes_; }
  [[nodiscard]] const std::vector<std::string>& estimators() const { return estimators_; }
  /// Index of the estimator of this title; the number of estimators if there is none.
  [[nodiscard]] std::size_t estimator(const std::string& title) const;
  [[nodiscard]] std::vector<std::size_t> all_but_flats() const;
  /// The scenes on which no parameter was chosen.
  [[nodiscard]] std::vector<std::size_t> held() const;

  /// Share in each seed of the scenes' pixels together; empty if there are none.
  [[nodiscard]] std::vector<double> shares(const std::vector<std::size_t>& scenes, std::size_t estimator,
                                           const PoolFigure& figure) const;
  [[nodiscard]] std::uint64_t pixels(const std::vector<std::size_t>& scenes, const PoolFigure& figure) const;
  /// From the spread of the seeds, at least Wilson's for independent pixels.
  [[nodiscard]] Estimate estimate(const std::vector<std::size_t>& scenes, std::size_t estimator,
                                  const PoolFigure& figure) const;

 private:
  std::vector<std::string> scenes_;
  std::vector<std::string> estimators_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<SceneScore>> scores_;
};

/// What the page says beside the scores.
struct PoolResults {
  std::string sensor;
  std::uint64_t first_seed;
  std::uint64_t last_seed;
  std::string look_up_table;            ///< a sentence: table_sentence
  bool references;                      ///< whether the matched filters were read
  std::map<double, PoolScores> lights;  ///< by klux
  std::string command_line;
};

/// All scenes but the flats together: estimators down, figures across.
Table pooled_table(const PoolScores& scores);

/// Data of the page pool.mustache.
PageData pool_page(const PoolResults& results);

/// Each light, scene and estimator.
Table pool_csv(const std::map<double, PoolScores>& lights);

/// The designs that a search tried.
struct PoolSearchResults {
  std::vector<std::string> scenes;
  std::string map;  ///< name of its file, or empty
  std::uint64_t seed;
  int engine_columns;
  Table designs;
  std::string command_line;
};

/// Data of the page pool_search.mustache.
PageData pool_search_page(const PoolSearchResults& results);

}  // namespace dtof
