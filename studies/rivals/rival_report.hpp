// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/report/table.hpp"
#include "rivals/models/rival.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// What is compared: a read-out of the project, a rival, or a reference that no chip could hold.
struct ComparedRow {
  enum class Kind { kReadout, kRival, kReference };

  std::string title;
  Kind kind = Kind::kReadout;
  std::optional<double> bits;  ///< of memory a pixel, if known
};

/// What is counted of a scene.
struct ComparedFigure {
  const char* name;
  const char* column;  ///< of the CSV file
  ErrorShares SceneScore::*pixels;
  double ErrorShares::*share;
};
/// Above 3 % and above 10 % of all pixels, of those at depth edges and of the others; of dim surfaces above
/// 3 %; of single pixels above 10 %.
const std::vector<ComparedFigure>& compared_figures();

/// Scores of one light level: scene, row, seed.
class ComparedScores {
 public:
  ComparedScores(std::vector<std::string> scenes, std::vector<ComparedRow> rows);

  /// Scores come seed by seed, all scenes and rows of one before the next.
  void add(std::size_t scene, std::size_t row, const SceneScore& score);
  [[nodiscard]] const std::vector<std::string>& scenes() const { return scenes_; }
  [[nodiscard]] const std::vector<ComparedRow>& rows() const { return rows_; }
  /// The row of this title, if there is one.
  [[nodiscard]] std::optional<std::size_t> row(const std::string& title) const;
  /// The scene of this name, if there is one.
  [[nodiscard]] std::optional<std::size_t> scene(const std::string& name) const;
  /// All scenes but the flats.
  [[nodiscard]] std::vector<std::size_t> scenes_with_depth() const;

  /// Pixels of the scenes together, over all seeds.
  [[nodiscard]] std::uint64_t pixels(const std::vector<std::size_t>& scenes,
                                     const ComparedFigure& figure) const;
  /// Share of the scenes' pixels together: mean over the seeds, with the interval by their spread, but at
  /// least Wilson's for independent pixels. 0 with no width if there are no pixels.
  [[nodiscard]] Estimate estimate(const std::vector<std::size_t>& scenes, std::size_t row,
                                  const ComparedFigure& figure) const;

 private:
  std::vector<std::string> scenes_;
  std::vector<ComparedRow> rows_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<SceneScore>> scores_;
};

/// Rows, but the references, that no other has fewer errors than with as few bits: indices by rising bits.
/// Rows without bits are left out.
std::vector<std::size_t> accuracy_front(const ComparedScores& scores, const std::vector<std::size_t>& scenes,
                                        const ComparedFigure& figure);

/// Titles of the rivals that are on the front of some light, on the scenes with depth by pixels above 3 %.
std::vector<std::string> rivals_on_a_front(const std::map<double, ComparedScores>& lights);

/// Tables of a light: the scenes with depth together, and scene by scene (above 3 % / above 10 %).
Table overall_table(const ComparedScores& scores);
Table scene_by_scene_table(const ComparedScores& scores);
/// The front by pixels above 3 %, and whether each of its rows is a rival.
Table front_table(const ComparedScores& scores);
/// The rows of a CSV file whose columns begin with klux; "all" are the scenes with depth together.
Table compared_csv(const std::map<double, ComparedScores>& lights);

/// Whether `rival` has fewer errors above 3 % than `other` on the scenes with depth, light by light, and
/// their bits; empty if one of them is not among the rows.
std::string comparison_sentence(const std::map<double, ComparedScores>& lights, const std::string& rival,
                                const std::string& other);

/// Numbers of a wall's pixels by their relative error.
struct WallCounts {
  std::uint64_t pixels = 0;
  std::uint64_t above_3_percent = 0;
  std::uint64_t above_10_percent = 0;
};
/// Adds a wall's distances as the claims count them: what their median is off is taken from all of them.
void add_unbiased(WallCounts& counts, double wall_m, std::span<const double> measured_m);

/// A claim beside what was measured of it.
struct CheckedClaim {
  std::string title;
  RivalClaim claim;
  WallCounts at_3_m;
  WallCounts at_4_m;
};
/// With Wilson's intervals; whether they overlap with those of the claim's kClaimedPixels.
Table claim_table(std::span<const CheckedClaim> claims);
/// How many of the claimed shares are within both intervals, and which are not.
std::string claim_sentence(std::span<const CheckedClaim> claims);

}  // namespace dtof
