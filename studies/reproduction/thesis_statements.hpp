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

/// Whether figures bear a statement out. Open: a confidence interval holds the limit, so that the frames run
/// do not decide.
enum class Verdict { kAgrees, kDisagrees, kOpen };
/// "yes", "no", "open".
std::string_view verdict_text(Verdict verdict);

struct Judgement {
  Verdict verdict;
  std::string here;  ///< the figures it rests on
};

/// One figure against a limit, e.g. "ezPointer at 3 m".
struct Comparison {
  std::string label;
  Estimate value;
  double limit;
};
enum class Side { kBelow, kAbove };

/// A figure of a point as it is judged: outliers too rare to be seen are allowed for, unless none was seen in
/// so many frames that they are rarer than kRareOutliers.
Comparison precision_against(const AccuracyPoint& point, double limit);
Comparison rmse_against(const AccuracyPoint& point, double limit);  ///< rmse over distance
inline constexpr double kRareOutliers = 1e-3;

/// Estimate::covering() lies wholly on this side of the limit: agrees; wholly on the other: disagrees.
Verdict compare(const Comparison& comparison, Side side);
/// Agrees if all do, disagrees if one does. Names what contradicts, or the figure nearest to its limit.
/// Throws std::logic_error for an empty list: a statement about nothing is always true.
Judgement all_of(std::span<const Comparison> comparisons, Side side);
/// Agrees if one does, disagrees if all do.
Judgement any_of(std::span<const Comparison> comparisons, Side side);
/// One line of both; the worse verdict counts.
Judgement both(const Judgement& first, const Judgement& second);

/// The customers' limit on relative precision (thesis 3.4): 10 % below 1 m, 3 % from there on.
double customer_limit(double distance_m);

/// Geometric mean over the distances in [near_m, far_m] of the ratio of two read-outs' relative precision.
Estimate precision_ratio(const AccuracyStudy& study, const std::string& numerator,
                         const std::string& denominator, double near_m, double far_m);

/// Sweeps behind the statements of thesis sections 3.4 and 6.2; distances thesis_distances(), read-outs
/// thesis_readouts() at least.
struct ThesisStudies {
  std::map<double, AccuracyStudy> at_klux;  ///< 200 x 160 sensors; thesis_klux()
  AccuracyStudy tenth_at_50_klux;           ///< a tenth of the sensors share the laser
};
const std::vector<double>& thesis_klux();
const std::vector<double>& thesis_distances();
/// The five that the thesis evaluates.
const std::vector<Readout>& thesis_readouts();

struct ThesisStatement {
  std::string place;  ///< in the thesis
  std::string text;
  std::string rule;  ///< by which it is judged: which read-outs, distances, figures, what is averaged
  std::function<Judgement(const ThesisStudies&)> judge;
};
/// Every statement of section 3.4, Table 1 and section 6.2 on relative precision, as a predicate.
const std::vector<ThesisStatement>& precision_statements();
/// Other readings of statements that the figures contradict: narrower or wider ranges, plots with fewer
/// points.
const std::vector<ThesisStatement>& alternative_readings();

}  // namespace dtof
