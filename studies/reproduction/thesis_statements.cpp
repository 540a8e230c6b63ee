// SPDX-License-Identifier: Apache-2.0
#include "reproduction/thesis_statements.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "accuracy/accuracy_tables.hpp"
#include "dtof/metrics/error_statistics.hpp"

namespace dtof {
namespace {

using Names = std::vector<std::string>;
const Names kFour = {"ezpointer", "sifh", "fifh", "hispointer"};
const Names kFive = {"ezpointer", "sifh", "fifh", "hispointer", "threesteps"};
const Names kIfhAndHisPointer = {"sifh", "fifh", "hispointer"};

std::vector<double> distances_within(double near_m, double far_m) {
  std::vector<double> distances;
  std::ranges::copy_if(thesis_distances(), std::back_inserter(distances),
                       [&](double distance) { return distance >= near_m && distance <= far_m; });
  return distances;
}

std::string title_of(const std::string& estimator) {
  return std::string(readout_title(parse_readout(estimator)));
}

// Relative precision of the read-outs at the distances in [near_m, far_m].
std::vector<Comparison> precisions(const AccuracyStudy& study, const Names& estimators, double near_m,
                                   double far_m, const std::function<double(double)>& limit) {
  std::vector<Comparison> comparisons;
  for (const AccuracyPoint& point : study.points) {
    if (std::ranges::find(estimators, point.estimator) != estimators.end() && point.distance_m >= near_m &&
        point.distance_m <= far_m) {
      comparisons.push_back(precision_against(point, limit(point.distance_m)));
    }
  }
  return comparisons;
}

double three_percent(double) { return 0.03; }

Judgement meets_limits(const AccuracyStudy& study, const Names& estimators, double near_m, double far_m) {
  return all_of(precisions(study, estimators, near_m, far_m, customer_limit), Side::kBelow);
}
// Points at whole metres, as a coarse plot would show.
Judgement fails_three_percent_at_whole_metres(const AccuracyStudy& study, const std::string& estimator,
                                              int near_m, int far_m) {
  std::vector<Comparison> all;
  for (int distance = near_m; distance <= far_m; ++distance) {
    std::ranges::copy(precisions(study, {estimator}, distance, distance, three_percent),
                      std::back_inserter(all));
  }
  return all_of(all, Side::kAbove);
}
Judgement fails_three_percent(const AccuracyStudy& study, const Names& estimators, double near_m,
                              double far_m) {
  return all_of(precisions(study, estimators, near_m, far_m, three_percent), Side::kAbove);
}

// Each of the read-outs breaks a limit somewhere.
Judgement each_fails_somewhere(const AccuracyStudy& study, const Names& estimators, double near_m,
                               double far_m) {
  Judgement judgement =
      any_of(precisions(study, {estimators.front()}, near_m, far_m, customer_limit), Side::kAbove);
  for (const std::string& estimator : std::span(estimators).subspan(1)) {
    judgement =
        both(judgement, any_of(precisions(study, {estimator}, near_m, far_m, customer_limit), Side::kAbove));
  }
  return judgement;
}

Comparison ratio(const AccuracyStudy& study, const std::string& worse, const std::string& better,
                 double near_m, double far_m) {
  return {fmt::format("{} / {}", title_of(worse), title_of(better)),
          precision_ratio(study, worse, better, near_m, far_m), 1.0};
}

// At each distance by itself.
Judgement most_precise(const AccuracyStudy& study, const std::string& best, const Names& among, double near_m,
                       double far_m) {
  std::vector<Comparison> ratios;
  for (const double distance : distances_within(near_m, far_m)) {
    for (const std::string& other : among) {
      if (other != best) {
        ratios.push_back(ratio(study, other, best, distance, distance));
        ratios.back().label += fmt::format(" at {:g} m", distance);
      }
    }
  }
  return all_of(ratios, Side::kAbove);
}

// "Similar results are rated using the same number": nearer to each other than to the next rank.
Judgement table_1(const AccuracyStudy& study) {
  constexpr double kNear = 0.2;
  constexpr double kFar = 3.0;
  const Judgement first =
      all_of(std::vector{ratio(study, "ezpointer", "hispointer", kNear, kFar)}, Side::kAbove);
  const Judgement second = all_of(std::vector{ratio(study, "sifh", "ezpointer", kNear, kFar),
                                              ratio(study, "fifh", "ezpointer", kNear, kFar)},
                                  Side::kAbove);
  const double to_ezpointer = std::min(precision_ratio(study, "sifh", "ezpointer", kNear, kFar).value,
                                       precision_ratio(study, "fifh", "ezpointer", kNear, kFar).value);
  Estimate apart = precision_ratio(study, "sifh", "fifh", kNear, kFar);
  if (apart.value < 1.0) {
    apart = reciprocal(1.0, apart);
  }
  const Judgement third =
      all_of(std::vector{Comparison{"SiFH and FiFH apart", apart, to_ezpointer}}, Side::kBelow);
  return both(both(first, second), third);
}

// Figures that linearity is judged by: share of variance a straight line explains.
Judgement linear(const AccuracyStudy& study, const std::string& estimator, double near_m, double far_m) {
  std::vector<double> x;
  std::vector<double> y;
  for (const AccuracyPoint& point : study.points) {
    if (point.estimator == estimator && point.distance_m >= near_m && point.distance_m <= far_m) {
      x.push_back(point.distance_m);
      y.push_back(point.distance_m + point.bias_m.value);
    }
  }
  const LinearFit fit = fit_line(x, y);
  RunningMoments all;
  RunningMoments rest;
  double largest = 0.0;
  double where = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double deviation = y[i] - fit.slope * x[i] - fit.intercept;
    all.add(y[i]);
    rest.add(deviation);
    if (std::abs(deviation) > std::abs(largest)) {
      largest = deviation;
      where = x[i];
    }
  }
  const double explained = 1.0 - rest.variance() / all.variance();
  constexpr double kLinear = 0.99;
  return {explained >= kLinear ? Verdict::kAgrees : Verdict::kDisagrees,
          fmt::format("{}: r2 = {:.4f}, slope {:.3f}, largest deviation from the line {:.0f} mm at {:g} m",
                      title_of(estimator), explained, fit.slope, largest * 1e3, where)};
}

std::string percent(const Comparison& comparison) {
  const bool is_share = comparison.limit < 0.5;
  return fmt::format("{} {}{} (limit {:g}{})", comparison.label,
                     format_estimate(comparison.value, is_share ? 100.0 : 1.0, 2), is_share ? " %" : "",
                     comparison.limit * (is_share ? 100.0 : 1.0), is_share ? " %" : "");
}

double distance_from_limit(const Comparison& comparison) {
  return std::abs(std::log(comparison.value.value / comparison.limit));
}

std::vector<Comparison> of_verdict(std::span<const Comparison> comparisons, Side side, Verdict verdict) {
  std::vector<Comparison> chosen;
  std::ranges::copy_if(comparisons, std::back_inserter(chosen),
                       [&](const Comparison& c) { return compare(c, side) == verdict; });
  return chosen;
}

// The worst first, three at most.
std::string list(std::vector<Comparison> comparisons) {
  std::ranges::sort(comparisons, std::ranges::greater(), distance_from_limit);
  std::vector<std::string> texts;
  for (const Comparison& comparison :
       std::span(comparisons).first(std::min<std::size_t>(comparisons.size(), 3))) {
    texts.push_back(percent(comparison));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace

std::string_view verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAgrees:
      return "yes";
    case Verdict::kDisagrees:
      return "no";
    default:
      return "open";
  }
}

Comparison precision_against(const AccuracyPoint& point, double limit) {
  return {fmt::format("{} at {:g} m", point.title, point.distance_m),
          without_rare_outliers(point.relative_precision, point.far_before, point.frames, kRareOutliers),
          limit};
}

Comparison rmse_against(const AccuracyPoint& point, double limit) {
  const auto over_distance = [&](const Interval& interval) {
    return Interval{interval.low / point.distance_m, interval.high / point.distance_m};
  };
  Estimate rmse = without_rare_outliers(point.rmse_m, point.far_after, point.frames, kRareOutliers);
  rmse.value /= point.distance_m;
  rmse.interval = over_distance(rmse.interval);
  if (rmse.with_unseen) {
    rmse.with_unseen = over_distance(*rmse.with_unseen);
  }
  return {fmt::format("{} at {:g} m", point.title, point.distance_m), rmse, limit};
}

Verdict compare(const Comparison& comparison, Side side) {
  const bool below = comparison.value.covering().high <= comparison.limit;
  const bool above = comparison.value.covering().low > comparison.limit;
  if (!below && !above) {
    return Verdict::kOpen;
  }
  return below == (side == Side::kBelow) ? Verdict::kAgrees : Verdict::kDisagrees;
}

Judgement all_of(std::span<const Comparison> comparisons, Side side) {
  if (comparisons.empty()) {
    throw std::logic_error("a statement without figures");
  }
  const std::vector<Comparison> against = of_verdict(comparisons, side, Verdict::kDisagrees);
  if (!against.empty()) {
    return {Verdict::kDisagrees,
            fmt::format("not in {} of {}: {}", against.size(), comparisons.size(), list(against))};
  }
  const std::vector<Comparison> open = of_verdict(comparisons, side, Verdict::kOpen);
  if (!open.empty()) {
    return {Verdict::kOpen,
            fmt::format("undecided in {} of {}: {}", open.size(), comparisons.size(), list(open))};
  }
  const Comparison& nearest = *std::ranges::min_element(comparisons, {}, distance_from_limit);
  return {Verdict::kAgrees, fmt::format("nearest to its limit: {}", percent(nearest))};
}

Judgement any_of(std::span<const Comparison> comparisons, Side side) {
  const Side other = side == Side::kBelow ? Side::kAbove : Side::kBelow;
  Judgement none = all_of(comparisons, other);
  if (none.verdict == Verdict::kDisagrees) {
    return {Verdict::kAgrees, list(of_verdict(comparisons, side, Verdict::kAgrees))};
  }
  if (none.verdict == Verdict::kAgrees) {
    none.verdict = Verdict::kDisagrees;
  }
  return none;
}

Judgement both(const Judgement& first, const Judgement& second) {
  const auto severity = [](Verdict verdict) {
    return verdict == Verdict::kDisagrees ? 2 : verdict == Verdict::kOpen ? 1 : 0;
  };
  return {severity(first.verdict) >= severity(second.verdict) ? first.verdict : second.verdict,
          fmt::format("{}; {}", first.here, second.here)};
}

double customer_limit(double distance_m) { return distance_m < 1.0 ? 0.10 : 0.03; }

Estimate precision_ratio(const AccuracyStudy& study, const std::string& numerator,
                         const std::string& denominator, double near_m, double far_m) {
  double sum = 0.0;
  double squared_half_widths = 0.0;
  int count = 0;
  for (const AccuracyPoint& point : study.points) {
    if (point.estimator != numerator || point.distance_m < near_m || point.distance_m > far_m) {
      continue;
    }
    // Both read-outs saw the same photons, which narrows the
    // ratio's interval further; ignoring that is the careful side.
    for (const double sign : {1.0, -1.0}) {
      const AccuracyPoint& side = sign > 0.0 ? point : study.at(denominator, point.distance_m);
      const Estimate precision = precision_against(side, 0.0).value;
      sum += sign * std::log(precision.value);
      // With few outliers the interval reaches farther up than down; the wider side counts for both.
      const Interval& interval = precision.covering();
      const double half_width =
          std::log(std::max(interval.high / precision.value, precision.value / interval.low));
      squared_half_widths += half_width * half_width;
    }
    ++count;
  }
  if (count == 0) {
    throw std::logic_error(fmt::format("the study has no {} from {} to {} m", numerator, near_m, far_m));
  }
  const double mean = sum / count;
  const double half_width = std::sqrt(squared_half_widths) / count;
  return {std::exp(mean), {std::exp(mean - half_width), std::exp(mean + half_width)}};
}

const std::vector<double>& thesis_klux() {
  static const std::vector<double> klux = {2.0, 14.0, 21.0, 25.0, 50.0};
  return klux;
}

const std::vector<double>& thesis_distances() {
  static const std::vector<double> distances = {0.2, 0.5, 0.8, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0};
  return distances;
}

const std::vector<Readout>& thesis_readouts() {
  static const std::vector<Readout> readouts = {Readout::kEzPointer, Readout::kSifh, Readout::kFifh,
                                                Readout::kThreeSteps, Readout::kHisPointer};
  return readouts;
}

namespace {

using StudyOf = std::function<const AccuracyStudy&(const ThesisStudies&)>;

StudyOf at(double klux) {
  return [klux](const ThesisStudies& studies) -> const AccuracyStudy& { return studies.at_klux.at(klux); };
}
const AccuracyStudy& small_array(const ThesisStudies& studies) { return studies.tenth_at_50_klux; }

std::string titles_of(const Names& estimators) {
  std::vector<std::string> titles;
  for (const std::string& estimator : estimators) {
    titles.push_back(title_of(estimator));
  }
  return fmt::format("{}", fmt::join(titles, ", "));
}

std::string metres(const std::vector<double>& distances) {
  return fmt::format("{:g} m", fmt::join(distances, ", "));
}

ThesisStatement meets(std::string place, std::string text, const StudyOf& study, const Names& estimators,
                      double near_m, double far_m) {
  return {
      std::move(place), std::move(text),
      fmt::format("relative precision of each of {} at each of {}: at most 10 % below 1 m, 3 % from 1 m on",
                  titles_of(estimators), metres(distances_within(near_m, far_m))),
      [=](const ThesisStudies& s) { return meets_limits(study(s), estimators, near_m, far_m); }};
}

ThesisStatement fails(std::string place, std::string text, const StudyOf& study, const Names& estimators,
                      double near_m, double far_m) {
  const std::vector<double> judged = distances_within(near_m, far_m);
  const std::string farthest =
      judged.back() == thesis_distances().back()
          ? fmt::format("; nothing is said beyond {:g} m, the largest distance judged", judged.back())
          : std::string();
  return {std::move(place), std::move(text),
          fmt::format("relative precision of each of {} at each of {}: above 3 %{}", titles_of(estimators),
                      metres(judged), farthest),
          [=](const ThesisStudies& s) { return fails_three_percent(study(s), estimators, near_m, far_m); }};
}

ThesisStatement fails_at_whole_metres(std::string place, std::string text, const StudyOf& study,
                                      const std::string& estimator, int near_m, int far_m) {
  return {std::move(place), std::move(text),
          fmt::format("relative precision of {} at {} to {} m in steps of 1 m: above 3 %",
                      title_of(estimator), near_m, far_m),
          [=](const ThesisStudies& s) {
            return fails_three_percent_at_whole_metres(study(s), estimator, near_m, far_m);
          }};
}

ThesisStatement each_fails(std::string place, std::string text, const StudyOf& study, const Names& estimators,
                           double near_m, double far_m) {
  return {std::move(place), std::move(text),
          fmt::format("each of {} is above its limit (10 % below 1 m, 3 % from 1 m on) at one of {} at least",
                      titles_of(estimators), metres(distances_within(near_m, far_m))),
          [=](const ThesisStudies& s) { return each_fails_somewhere(study(s), estimators, near_m, far_m); }};
}

ThesisStatement best(std::string place, std::string text, const StudyOf& study, const std::string& estimator,
                     const Names& among, double near_m, double far_m) {
  return {
      std::move(place), std::move(text),
      fmt::format("relative precision of each other of {} over that of {}, at each of {} by itself: above 1",
                  titles_of(among), title_of(estimator), metres(distances_within(near_m, far_m))),
      [=](const ThesisStudies& s) { return most_precise(study(s), estimator, among, near_m, far_m); }};
}

ThesisStatement rmse_above(std::string place, std::string text, const StudyOf& study, const Names& estimators,
                           double distance_m) {
  return {std::move(place), std::move(text),
          fmt::format("rmse after the look-up table of each of {} at {:g} m: above 3 % of the distance",
                      titles_of(estimators), distance_m),
          [=](const ThesisStudies& s) {
            std::vector<Comparison> errors;
            for (const std::string& estimator : estimators) {
              errors.push_back(rmse_against(study(s).at(estimator, distance_m), 0.03));
            }
            return all_of(errors, Side::kAbove);
          }};
}

}  // namespace

const std::vector<ThesisStatement>& precision_statements() {
  static const std::vector<ThesisStatement> statements = {
      fails("3.4, Fig. 3.12", "50 klux: at 3 m no read-out is below 3 %", at(50.0), kFive, 3.0, 3.0),
      meets("3.4, Fig. 3.14", "14 klux: all but three steps meet the limits from 0.2 to 3.5 m", at(14.0),
            kFour, 0.2, 3.5),
      fails("3.4", "14 klux: beyond 3.5 m no read-out is below 3 %", at(14.0), kFive, 3.6, 5.0),
      fails("Fig. 3.14", "14 klux: three steps fails beyond 2 m", at(14.0), {"threesteps"}, 2.1, 5.0),
      best("3.4, Fig. 3.14", "14 klux, 0.2 to 3 m: hisPointer is the most precise of the four", at(14.0),
           "hispointer", kFour, 0.2, 3.0),
      {"Table 1", "14 klux: hisPointer first, ezPointer second, SiFH and FiFH share the third rank",
       fmt::format(
           "ratios of relative precision, geometric means over {} (the table has one rank for all "
           "distances); SiFH and FiFH share a rank if they are nearer to each other than to ezPointer",
           metres(distances_within(0.2, 3.0))),
       [](const auto& s) { return table_1(s.at_klux.at(14.0)); }},
      best("3.4", "14 klux, 5 m: ezPointer is better than the other four", at(14.0), "ezpointer", kFive, 5.0,
           5.0),
      {"Fig. 3.16", "14 klux, 0.2 to 3 m: FiFH's and hisPointer's results are linear in distance",
       fmt::format(
           "a least-squares line through the mean results at {} explains 99 % of their variance, for each "
           "of both; no interval",
           metres(distances_within(0.2, 3.0))),
       [](const auto& s) {
         return both(linear(s.at_klux.at(14.0), "fifh", 0.2, 3.0),
                     linear(s.at_klux.at(14.0), "hispointer", 0.2, 3.0));
       }},
      meets("3.4", "21 klux: SiFH, FiFH and hisPointer meet the limits to 3 m", at(21.0), kIfhAndHisPointer,
            0.2, 3.0),
      each_fails("3.4", "25 klux: SiFH, FiFH and hisPointer no longer do (\"until 21 klux\")", at(25.0),
                 kIfhAndHisPointer, 0.2, 3.0),
      meets("3.4", "25 klux: ezPointer meets the limits to 3 m", at(25.0), {"ezpointer"}, 0.2, 3.0),
      meets("3.4, Fig. 3.17", "2 klux: all but three steps meet the limits to 5 m", at(2.0), kFour, 0.2, 5.0),
      fails("Fig. 3.17", "2 klux: three steps fails beyond 3 m", at(2.0), {"threesteps"}, 3.1, 5.0),
      best("3.4, Fig. 3.17", "2 klux, 0.2 to 5 m: hisPointer is the most precise of the four", at(2.0),
           "hispointer", kFour, 0.2, 5.0),
      meets(
          "6.2",
          "50 klux, a tenth of the sensors (ten times the signal for each): the four meet the limits to 3 m",
          small_array, kFour, 0.2, 3.0),
  };
  return statements;
}

const std::vector<ThesisStatement>& alternative_readings() {
  static const std::vector<ThesisStatement> readings = {
      fails_at_whole_metres("Fig. 3.14", "14 klux: three steps fails beyond 2 m, judged at whole metres",
                            at(14.0), "threesteps", 3, 5),
      meets("Fig. 3.14", "14 klux: three steps meets the limits to 2 m (so that the plot turns up after 2 m)",
            at(14.0), {"threesteps"}, 0.2, 2.0),
      fails_at_whole_metres("Fig. 3.17", "2 klux: three steps fails beyond 3 m, judged at whole metres",
                            at(2.0), "threesteps", 4, 5),
      meets("3.4, Fig. 3.14",
            "14 klux: all but three steps meet the limits, without 0.2 m: from 0.5 to 3.5 m", at(14.0), kFour,
            0.5, 3.5),
      meets("3.4, Fig. 3.17", "2 klux: all but three steps meet the limits, without 0.2 m: from 0.5 to 5 m",
            at(2.0), kFour, 0.5, 5.0),
      meets("3.4", "21 klux: SiFH, FiFH and hisPointer meet the limits, without 0.2 m: from 0.5 to 3 m",
            at(21.0), kIfhAndHisPointer, 0.5, 3.0),
      meets("3.4", "25 klux: ezPointer meets the limits, without 0.2 m: from 0.5 to 3 m", at(25.0),
            {"ezpointer"}, 0.5, 3.0),
      meets("3.4",
            "21 klux: SiFH, FiFH and hisPointer meet the limits from 0.5 to 3.5 m, the reach at 14 klux",
            at(21.0), kIfhAndHisPointer, 0.5, 3.5),
      each_fails("3.4", "25 klux: SiFH, FiFH and hisPointer no longer do, from 0.5 to 3.5 m", at(25.0),
                 kIfhAndHisPointer, 0.5, 3.5),
      best("3.4, Fig. 3.14", "14 klux, from 0.5 to 3 m: hisPointer is the most precise of the four", at(14.0),
           "hispointer", kFour, 0.5, 3.0),
      best("3.4, Fig. 3.17", "2 klux, from 0.8 to 3.5 m: hisPointer is the most precise of the four", at(2.0),
           "hispointer", kFour, 0.8, 3.5),
      fails("3.4, Fig. 3.12", "50 klux: at 3.5 m no read-out is below 3 %", at(50.0), kFive, 3.5, 3.5),
      rmse_above("3.4, Fig. 3.12",
                 "50 klux: at 3 m the rmse after the look-up table is above 3 % for every read-out", at(50.0),
                 kFive, 3.0),
  };
  return readings;
}

}  // namespace dtof
