// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "dtof/metrics/confidence_interval.hpp"

namespace dtof {

/// Whether figures confirm a statement. Open: a confidence interval contains the limit, so the number of
/// frames is too small to decide.
enum class Verdict { kAgrees, kDisagrees, kOpen };
/// Text of a verdict: "yes", "no", "open".
std::string_view verdict_text(Verdict verdict);

struct Judgement {
  Verdict verdict;
  std::string here;  ///< figures on which the verdict rests
};

/// A figure and its limit, e.g. for "ezPointer at 3 m".
struct Comparison {
  std::string label;
  Estimate value;
  double limit;
};
enum class Side { kBelow, kAbove };

/// Comparison of a point's figure with a limit. The interval allows for unseen outliers, unless none was seen
/// in so many frames that they are rarer than kRareOutliers.
Comparison precision_against(const AccuracyPoint& point, double limit);
Comparison rmse_against(const AccuracyPoint& point, double limit);  ///< rmse divided by distance
inline constexpr double kRareOutliers = 1e-3;

/// kAgrees if Estimate::covering() lies wholly on this side of the limit, kDisagrees if wholly on the other,
/// else kOpen.
Verdict compare(const Comparison& comparison, Side side);
/// kAgrees if all comparisons agree, kDisagrees if one disagrees. The text names the contradiction, or the
/// figure nearest to its limit. Throws std::logic_error for an empty list.
Judgement all_of(std::span<const Comparison> comparisons, Side side);
/// kAgrees if one comparison agrees, kDisagrees if all disagree.
Judgement any_of(std::span<const Comparison> comparisons, Side side);
/// Joins two judgements; the worse verdict counts.
Judgement both(const Judgement& first, const Judgement& second);

/// Customers' limit on relative precision (thesis 3.4): 10 % below 1 m, 3 % from 1 m.
double customer_limit(double distance_m);

/// Geometric mean, over distances in [near_m, far_m], of the ratio of two read-outs' relative precision.
Estimate precision_ratio(const AccuracyStudy& study, const std::string& numerator,
                         const std::string& denominator, double near_m, double far_m);

/// Sweeps for the statements of thesis sections 3.4 and 6.2, with at least the distances thesis_distances()
/// and the read-outs thesis_readouts().
struct ThesisStudies {
  std::map<double, AccuracyStudy> at_klux;  ///< 200 x 160 pixels; light levels thesis_klux()
  AccuracyStudy tenth_at_50_klux;           ///< a tenth of the pixels share the laser
};
const std::vector<double>& thesis_klux();
const std::vector<double>& thesis_distances();
/// The five read-outs that the thesis evaluates.
const std::vector<Readout>& thesis_readouts();

struct ThesisStatement {
  std::string place;  ///< place in the thesis
  std::string text;
  std::string rule;  ///< how it is judged: read-outs, distances, figures, averages
  std::function<Judgement(const ThesisStudies&)> judge;
};
/// All statements of section 3.4, Table 1 and section 6.2 on relative precision, as predicates.
const std::vector<ThesisStatement>& precision_statements();
/// Other readings of statements that the figures contradict: narrower or wider ranges, plots with fewer
/// points.
const std::vector<ThesisStatement>& alternative_readings();

}  // namespace dtof
