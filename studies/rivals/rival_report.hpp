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
#include "dtof/rival/rival.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// A compared read-out: of the project, a rival, or a reference that no chip could hold.
struct ComparedRow {
  enum class Kind { kReadout, kRival, kReference };

  std::string title;
  Kind kind = Kind::kReadout;
  std::optional<double> bits;  ///< memory bits per pixel, if known
};

/// A compared figure: a count of pixels in a scene.
struct ComparedFigure {
  const char* name;
  const char* column;  ///< column of the CSV file
  ErrorShares SceneScore::*pixels;
  double ErrorShares::*share;
};
/// The figures: share of errors above 3 % and above 10 %, each of all pixels, at depth edges and elsewhere;
/// above 3 % on dim surfaces; above 10 % on single pixels.
const std::vector<ComparedFigure>& compared_figures();

/// Scores of one light level, by scene, row and seed.
class ComparedScores {
 public:
  ComparedScores(std::vector<std::string> scenes, std::vector<ComparedRow> rows);

  /// Adds a score. Scores come seed by seed, with all scenes and rows of one seed before the next.
  void add(std::size_t scene, std::size_t row, const SceneScore& score);
  [[nodiscard]] const std::vector<std::string>& scenes() const { return scenes_; }
  [[nodiscard]] const std::vector<ComparedRow>& rows() const { return rows_; }
  /// Row with this title, if it exists.
  [[nodiscard]] std::optional<std::size_t> row(const std::string& title) const;
  /// Scene with this name, if it exists.
  [[nodiscard]] std::optional<std::size_t> scene(const std::string& name) const;
  /// All scenes except the flat ones.
  [[nodiscard]] std::vector<std::size_t> scenes_with_depth() const;

  /// Number of pixels of these scenes, over all seeds.
  [[nodiscard]] std::uint64_t pixels(const std::vector<std::size_t>& scenes,
                                     const ComparedFigure& figure) const;
  /// Share of the pixels of these scenes: mean over the seeds. The interval follows from their spread, and is
  /// at least Wilson's for independent pixels. 0 with width 0 without pixels.
  [[nodiscard]] Estimate estimate(const std::vector<std::size_t>& scenes, std::size_t row,
                                  const ComparedFigure& figure) const;

 private:
  std::vector<std::string> scenes_;
  std::vector<ComparedRow> rows_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<SceneScore>> scores_;
};

/// Rows on the front of accuracy against memory, without references: no other row has fewer errors with as
/// few bits. Returns indices by rising bits. Rows with unknown bits are left out.
std::vector<std::size_t> accuracy_front(const ComparedScores& scores, const std::vector<std::size_t>& scenes,
                                        const ComparedFigure& figure);

/// Titles of the rivals on the front of some light level, by errors above 3 % on the scenes with depth.
std::vector<std::string> rivals_on_a_front(const std::map<double, ComparedScores>& lights);

/// Tables of a light level: all scenes with depth together; and (next function) scene by scene, errors above
/// 3 % / above 10 %.
Table overall_table(const ComparedScores& scores);
Table scene_by_scene_table(const ComparedScores& scores);
/// The front by errors above 3 %, and for each row whether it is a rival.
Table front_table(const ComparedScores& scores);
/// Rows of a CSV file with klux in the first column; "all" stands for all scenes with depth together.
Table compared_csv(const std::map<double, ComparedScores>& lights);

/// Sentence on whether `rival` has fewer errors above 3 % than `other` on the scenes with depth, by light
/// level, and on their bits. Empty if one of them is missing.
std::string comparison_sentence(const std::map<double, ComparedScores>& lights, const std::string& rival,
                                const std::string& other);

/// Numbers of a wall's pixels, by relative error.
struct WallCounts {
  std::uint64_t pixels = 0;
  std::uint64_t above_3_percent = 0;
  std::uint64_t above_10_percent = 0;
};
/// Adds a wall's distances as in the claims: the bias of their median is subtracted from all of them.
void add_unbiased(WallCounts& counts, double wall_m, std::span<const double> measured_m);

/// A claim and the measured figure.
struct CheckedClaim {
  std::string title;
  RivalClaim claim;
  WallCounts at_3_m;
  WallCounts at_4_m;
};
/// Table of the claims with Wilson's intervals, and whether they overlap with those of the claim's
/// kClaimedPixels.
Table claim_table(std::span<const CheckedClaim> claims);
/// Sentence with the number of claimed shares that lie within both intervals, and the claims that do not.
std::string claim_sentence(std::span<const CheckedClaim> claims);

}  // namespace dtof
