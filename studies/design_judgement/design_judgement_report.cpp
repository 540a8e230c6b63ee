// SPDX-License-Identifier: Apache-2.0
#include "design_judgement/design_judgement_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace dtof {
namespace {

constexpr double kPerCent = 100.0;

std::string share_percent(double share) { return fmt::format("{:.3f}", kPerCent * share); }

std::string ratio_text(const Estimate& ratio) {
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", ratio.value, ratio.interval.low, ratio.interval.high);
}

const char* verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::kWithin:
      return "within";
    case Verdict::kUndecided:
      return "undecided";
    case Verdict::kBeyond:
      break;
  }
  return "beyond";
}

std::size_t count(const std::vector<JudgedSensor>& judged, Verdict verdict) {
  return static_cast<std::size_t>(std::ranges::count_if(
      judged, [=](const JudgedSensor& one) { return one.judgement.verdict() == verdict; }));
}

std::string judgement_answer(const std::vector<JudgedSensor>& judged) {
  const std::size_t within = count(judged, Verdict::kWithin);
  const std::size_t undecided = count(judged, Verdict::kUndecided);
  return fmt::format(
      "**For {} of {} random sensors the recommendation of `dtof design` is about as good as the best of a "
      "full sweep.** As good or not told from it by the interval: {} of {}. Worse beyond the interval: {}.\n",
      within, judged.size(), within + undecided, judged.size(), count(judged, Verdict::kBeyond));
}

Table sensor_table(const std::vector<JudgedSensor>& judged) {
  Table table({"no.", "recommended", "best of the sweep", "verdict", "ratio", "> 3 % in %, recommended",
               "best", "mm2, recommended", "best", "place in the sweep"},
              4);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const SensorJudgement& one = judged[i].judgement;
    table.add({fmt::format("{}", i + 1), one.recommended.name,
               one.lost == Lost::kNothing ? "the same" : one.best.name, verdict_text(one.verdict()),
               ratio_text(one.ratio), share_percent(one.recommended.share.value),
               share_percent(one.best.share.value), fmt::format("{:.3g}", one.recommended.mm2),
               fmt::format("{:.3g}", one.best.mm2),
               one.keeps_limits ? fmt::format("{} of {}", one.recommended.place, one.kept) : "-"});
  }
  return table;
}

/// Why the search did not recommend the best of the sweep.
std::string reason(const SensorJudgement& one) {
  if (!one.keeps_limits) {
    return "the recommendation misses a limit";
  }
  const std::string best = share_percent(one.search_best);
  const std::string other = share_percent(one.search_other);
  const bool smaller = one.search_best <= one.search_other;
  switch (one.lost) {
    case Lost::kNotRead:
      return "the search did not read the best; it reads each set of parameters only with the most SLOTS "
             "that keep the limits";
    case Lost::kInScreening:
      return smaller ? fmt::format(
                           "in the search's one frame the best had {} % and other parameters of its "
                           "read-out {} %; their intervals overlap, and the smaller array went on",
                           best, other)
                     : fmt::format(
                           "in the search's one frame the best had {} %, and other parameters of its "
                           "read-out, which went on, {} %",
                           best, other);
    case Lost::kInFinal:
      return fmt::format("in the search's last frames the best had {} % and the recommendation {} %{}", best,
                         other, smaller ? "; the smaller array won, because its share was small enough" : "");
    case Lost::kNothing:
      break;
  }
  return "the recommendation is the best of the sweep";
}

std::string misses(const std::vector<JudgedSensor>& judged) {
  std::string text;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const SensorJudgement& one = judged[i].judgement;
    if (one.verdict() != Verdict::kWithin) {
      text += fmt::format("* {} ({}): {} instead of {}. Reason: {}.\n", i + 1, verdict_text(one.verdict()),
                          one.recommended.name, one.best.name, reason(one));
    }
  }
  return text.empty() ? "* None.\n" : text;
}

std::string sensors_text(const std::vector<JudgedSensor>& judged) {
  std::string text;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const RandomSensor& one = judged[i].sensor;
    const SensorJudgement& judgement = judged[i].judgement;
    text += fmt::format(
        "{}. {}; {}. Of {} candidates {} keep the limits; the search read {}.{}\n", i + 1,
        sensor_line(one.request.bench.sensor),
        one.options.empty() ? "default options" : "`" + one.options + "`", judgement.grid, judgement.kept,
        judgement.read,
        one.refused > 0 ? fmt::format(" Drawn again {} times: no read-out suited.", one.refused) : "");
  }
  return text;
}

}  // namespace

std::string judgement_report(const JudgementSettings& settings, const std::vector<JudgedSensor>& judged,
                             const std::string& command_line) {
  const DesignRequest usual;
  std::vector<std::string_view> scenes;
  for (const Scene scene : usual.bench.scenes) {
    scenes.push_back(scene_name(scene));
  }
  return fmt::format(
      "# Judgement of `dtof design`\n\n{}\n"
      "![Share of the recommendation against the best share](design_judgement.svg)\n\n{}\n"
      "* Place in the sweep: 1 is the smallest share in the sweep's own photons.\n"
      "* Verdict: *within*: the ratio is at most {:g}, or the share is at most {:g} % of the pixels larger "
      "than "
      "the best; *undecided*: both are larger, and the interval of the ratio reaches {:g}; *beyond*: the "
      "whole "
      "interval is larger, too.\n\n"
      "## Not within\n\n{}\n"
      "The search takes the smallest array whose measured share is at most {:g} times the smallest one, or "
      "at "
      "most {:g} % of the pixels larger. It therefore gives up a little accuracy for area on "
      "purpose.\n\n"
      "## How it is judged\n\n"
      "* Recommendation: the function that `dtof design` calls, with the default options and the options of "
      "the sensor in the list below; scenes {}, {} klux, seed {}.\n"
      "* Objective: the share of pixels that are more than 3 % off in the worst light, among the candidates "
      "that keep the limits of area, power, frame rate and clock. `dtof design` minimises this share.\n"
      "* Sweep: all candidates of the grid that keep the limits, with every value of SLOTS; the search reads "
      "only the most SLOTS. The judge computes costs and limits of the whole grid itself, by the same "
      "estimates. Each candidate is read in at least {:g} pixels a light.\n"
      "* Final: the {} best of the sweep and the recommendation are read again with {} seeds, at least {:g} "
      "pixels a seed and light. The best is the smallest share in the final. The sweep, the final and the "
      "search have different seeds: photons, look-up tables and poles differ.\n"
      "* Ratio: share of the recommendation over the best share, both means over the seeds of the final, "
      "with an interval at 95 % (delta method over pairs with the same seed). A share below one pixel counts "
      "as one pixel. The best is the smallest of several measured shares, so that the ratio is at least 1, "
      "and too large rather than too small.\n"
      "* Sensors: drawn from seed {}; most numbers evenly in their logarithm: {}. A quarter of the draws has "
      "no limit but the default frame rate, a quarter each a limit of area or power or a high frame rate; "
      "the limit is a random quantile, 15 to 85 %, of the grid's costs.\n\n"
      "## Sensors\n\nSignal: events a pulse from a white target at R in m. The command writes each sensor "
      "file to `sensors/` in its output folder.\n\n{}\nCommand: `{}`\n",
      judgement_answer(judged), sensor_table(judged).markdown(), kGoodRatio, 100.0 * kGoodDifference,
      kGoodRatio, misses(judged), kGoodRatio, 100.0 * kGoodDifference, fmt::join(scenes, " and "),
      fmt::join(usual.bench.klux, " and "), usual.bench.seed, settings.sweep_pixels, settings.finalists,
      settings.final_seeds, settings.final_pixels, settings.seed, ranges_text(settings.ranges),
      sensors_text(judged), command_line);
}

Table judgement_csv(const std::vector<JudgedSensor>& judged) {
  Table table({"sensor",
               "options",
               "recommended",
               "best",
               "verdict",
               "ratio",
               "ratio_low",
               "ratio_high",
               "recommended_share",
               "recommended_low",
               "recommended_high",
               "best_share",
               "best_low",
               "best_high",
               "recommended_mm2",
               "best_mm2",
               "place",
               "grid",
               "kept",
               "read"});
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const SensorJudgement& one = judged[i].judgement;
    std::vector<std::string> row = {fmt::format("{}", i + 1), judged[i].sensor.options, one.recommended.name,
                                    one.best.name, verdict_text(one.verdict())};
    for (const Estimate& estimate : {one.ratio, one.recommended.share, one.best.share}) {
      for (const double value : {estimate.value, estimate.interval.low, estimate.interval.high}) {
        row.push_back(fmt::format("{:.6g}", value));
      }
    }
    row.push_back(fmt::format("{:.4g}", one.recommended.mm2));
    row.push_back(fmt::format("{:.4g}", one.best.mm2));
    for (const std::size_t number : {one.recommended.place, one.grid, one.kept, one.read}) {
      row.push_back(fmt::format("{}", number));
    }
    table.add(std::move(row));
  }
  return table;
}

std::vector<PlotSeries> judgement_curves(const std::vector<JudgedSensor>& judged) {
  PlotSeries points{.label = "recommended", .x = {}, .y = {}};
  std::vector<JudgedSensor> sorted = judged;
  std::ranges::sort(sorted, {}, [](const JudgedSensor& one) { return one.judgement.best.share.value; });
  PlotSeries equal{.label = "the best", .x = {}, .y = {}};
  for (const JudgedSensor& one : sorted) {
    constexpr double kLeastShown = 1e-5;  // a logarithmic axis has no 0
    const double best = kPerCent * std::max(one.judgement.best.share.value, kLeastShown);
    points.x.push_back(best);
    points.y.push_back(kPerCent * std::max(one.judgement.recommended.share.value, kLeastShown));
    equal.x.push_back(best);
    equal.y.push_back(best);
  }
  return {points, equal};
}

}  // namespace dtof
