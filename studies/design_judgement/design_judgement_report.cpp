// SPDX-License-Identifier: Apache-2.0
#include "design_judgement/design_judgement_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

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

/// Why the search did not recommend the best of the sweep: shows one of the template's reasons.
PageData miss_data(std::size_t number, const SensorJudgement& one) {
  const bool kept = one.keeps_limits;
  const bool in_screening = kept && one.lost == Lost::kInScreening;
  const bool in_final = kept && one.lost == Lost::kInFinal;
  const bool smaller = one.search_best <= one.search_other;
  PageData data;
  data.set("number", "{}", number)
      .set("verdict", "{}", verdict_text(one.verdict()))
      .set("recommended", "{}", one.recommended.name)
      .set("best", "{}", one.best.name)
      .set("best_share", "{}", share_percent(one.search_best))
      .set("other_share", "{}", share_percent(one.search_other))
      .flag("limit_missed", !one.keeps_limits)
      .flag("not_read", kept && one.lost == Lost::kNotRead)
      .flag("in_screening_smaller", in_screening && smaller)
      .flag("in_screening", in_screening && !smaller)
      .flag("in_final", in_final)
      .flag("smaller_won", in_final && smaller);
  return data;
}

std::vector<PageData> misses_data(const std::vector<JudgedSensor>& judged) {
  std::vector<PageData> misses;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (judged[i].judgement.verdict() != Verdict::kWithin) {
      misses.push_back(miss_data(i + 1, judged[i].judgement));
    }
  }
  return misses;
}

std::vector<PageData> drawn_data(const std::vector<JudgedSensor>& judged) {
  std::vector<PageData> drawn;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const RandomSensor& one = judged[i].sensor;
    const SensorJudgement& judgement = judged[i].judgement;
    std::optional<PageData> again;
    if (one.refused > 0) {
      again = PageData().set("times", "{}", one.refused);
    }
    drawn.emplace_back()
        .set("number", "{}", i + 1)
        .set("sensor", "{}", sensor_line(one.request.bench.sensor))
        .flag("default_options", one.options.empty())
        .set("options", "{}", one.options)
        .set("grid", "{}", judgement.grid)
        .set("kept", "{}", judgement.kept)
        .set("read", "{}", judgement.read)
        .part("drawn_again", std::move(again));
  }
  return drawn;
}

}  // namespace

PageData judgement_page(const JudgementSettings& settings, const std::vector<JudgedSensor>& judged,
                        const std::string& command_line) {
  const DesignRequest usual;
  std::vector<std::string_view> scenes;
  for (const Scene scene : usual.bench.scenes) {
    scenes.push_back(scene_name(scene));
  }
  const std::size_t within = count(judged, Verdict::kWithin);
  PageData data;
  data.set("within", "{}", within)
      .set("sensors", "{}", judged.size())
      .set("within_or_undecided", "{}", within + count(judged, Verdict::kUndecided))
      .set("beyond", "{}", count(judged, Verdict::kBeyond))
      .set("judgements", sensor_table(judged))
      .set("good_ratio", "{:g}", kGoodRatio)
      .set("good_difference", "{:g}", kPerCent * kGoodDifference)
      .list("misses", misses_data(judged))
      .set("scenes", "{}", fmt::join(scenes, " and "))
      .set("klux", "{}", fmt::join(usual.bench.klux, " and "))
      .set("search_seed", "{}", usual.bench.seed)
      .set("sweep_pixels", "{:g}", settings.sweep_pixels)
      .set("finalists", "{}", settings.finalists)
      .set("final_seeds", "{}", settings.final_seeds)
      .set("final_pixels", "{:g}", settings.final_pixels)
      .set("seed", "{}", settings.seed)
      .set("ranges", "{}", ranges_text(settings.ranges))
      .list("drawn", drawn_data(judged))
      .set("command", "{}", command_line);
  return data;
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
