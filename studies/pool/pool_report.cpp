// SPDX-License-Identifier: Apache-2.0
#include "pool/pool_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "pool/pool_search.hpp"

namespace dtof {
namespace {

std::string with_half_interval(const Estimate& share) {
  return fmt::format("{:.2f} +-{:.2f}", 100.0 * share.value,
                     50.0 * (share.interval.high - share.interval.low));
}

Table pool_scene_table(const PoolScores& scores, const PoolFigure& first, const PoolFigure& second) {
  std::vector<std::string> header = {"scene"};
  header.insert(header.end(), scores.estimators().begin(), scores.estimators().end());
  Table table(std::move(header));
  for (std::size_t s = 0; s < scores.scenes().size(); ++s) {
    if (scores.pixels({s}, first) == 0) {
      continue;
    }
    std::vector<std::string> row = {scores.scenes()[s]};
    for (std::size_t e = 0; e < scores.estimators().size(); ++e) {
      row.push_back(fmt::format("{:.2f} / {:.2f}", 100.0 * scores.estimate({s}, e, first).value,
                                100.0 * scores.estimate({s}, e, second).value));
    }
    table.add(std::move(row));
  }
  return table;
}

/// A goal: at most `factor` times `of` (1 if empty), for an estimator at a light.
struct PoolGoal {
  double klux;
  const char* estimator;
  std::size_t figure;
  double factor;
  const char* of;
  bool held = false;  ///< on the held scenes alone
};
constexpr const char* kWith = "poolPointer";
constexpr const char* kWithout = "poolPointer, no S1";
constexpr const char* kMatchedFilter = "matched filter (single pixel)";
constexpr std::array<PoolGoal, 14> kPoolGoals = {{{2.0, kWith, 0, 1.0, kMatchedFilter},
                                                  {14.0, kWith, 0, 0.0020, ""},
                                                  {50.0, kWith, 0, 0.012, ""},
                                                  {100.0, kWith, 0, 0.050, ""},
                                                  {50.0, kWith, 1, 0.004, ""},
                                                  {50.0, kWith, 6, 0.10, ""},
                                                  {14.0, kWith, 2, 1.5, kMatchedFilter, true},
                                                  {50.0, kWith, 2, 1.5, kMatchedFilter, true},
                                                  {14.0, kWith, 2, 0.0129, ""},
                                                  {14.0, kWithout, 0, 0.0060, ""},
                                                  {50.0, kWithout, 0, 0.028, ""},
                                                  {100.0, kWithout, 0, 0.0982, ""},
                                                  {50.0, kWithout, 1, 0.009, ""},
                                                  {14.0, kWithout, 2, 0.0129, ""}}};

/// The value that `goal` is a factor of; none where that was not measured.
std::optional<double> compared_with(const PoolGoal& goal, const PoolScores& scores,
                                    const std::vector<std::size_t>& scenes) {
  const std::size_t reference = scores.estimator(goal.of);
  if (reference == scores.estimators().size()) {
    return std::nullopt;
  }
  return scores.estimate(scenes, reference, kPoolFigures.at(goal.figure)).value;
}

/// A goal is met if the whole interval is below the limit, and open if the limit is inside.
const char* verdict(const Interval& interval, double limit) {
  if (interval.high < limit) {
    return "yes";
  }
  return interval.low > limit ? "**no**" : "open";
}

Table goal_table(const std::map<double, PoolScores>& lights) {
  Table table({"goal", "measured", "limit", "met"});
  for (const PoolGoal& goal : kPoolGoals) {
    const auto light = lights.find(goal.klux);
    if (light == lights.end() ||
        light->second.estimator(goal.estimator) == light->second.estimators().size()) {
      continue;
    }
    const PoolScores& scores = light->second;
    const std::vector<std::size_t> scenes = goal.held ? scores.held() : scores.all_but_flats();
    const PoolFigure& figure = kPoolFigures.at(goal.figure);
    if (scenes.empty() || scores.pixels(scenes, figure) == 0) {
      continue;
    }
    std::string of = goal.of;
    double limit = goal.factor;
    if (!of.empty()) {
      const std::optional<double> other = compared_with(goal, scores, scenes);
      if (!other) {
        continue;
      }
      limit *= *other;
      of = fmt::format(", at most {:g} times that of the {}", goal.factor, of);
    }
    const Estimate measured = scores.estimate(scenes, scores.estimator(goal.estimator), figure);
    table.add({fmt::format("{}: {:g} klux, {}{}{}", goal.estimator, goal.klux,
                           goal.held ? "held scenes, " : "", figure.name, of),
               with_half_interval(measured), fmt::format("{:.2f}", 100.0 * limit),
               verdict(measured.interval, limit)});
  }
  return table;
}

}  // namespace

std::size_t PoolScores::estimator(const std::string& title) const {
  return static_cast<std::size_t>(std::ranges::find(estimators_, title) - estimators_.begin());
}

std::vector<std::size_t> PoolScores::all_but_flats() const {
  std::vector<std::size_t> chosen;
  for (std::size_t s = 0; s < scenes_.size(); ++s) {
    if (!is_flat(scenes_[s])) {
      chosen.push_back(s);
    }
  }
  return chosen;
}

std::vector<std::size_t> PoolScores::held() const {
  std::vector<std::size_t> chosen = all_but_flats();
  std::erase_if(chosen, [this](std::size_t s) { return !scenes_[s].starts_with("held"); });
  return chosen;
}

std::vector<double> PoolScores::shares(const std::vector<std::size_t>& scenes, std::size_t estimator,
                                       const PoolFigure& figure) const {
  std::vector<double> found;
  const std::size_t seeds = scores_.at({scenes.front(), estimator}).size();
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    double pixels = 0.0;
    double hits = 0.0;
    for (const std::size_t scene : scenes) {
      const ErrorShares& part = scores_.at({scene, estimator})[seed].*figure.pixels;
      pixels += static_cast<double>(part.pixels);
      hits += static_cast<double>(part.pixels) * part.*figure.share;
    }
    if (pixels > 0.0) {
      found.push_back(hits / pixels);
    }
  }
  return found;
}

std::uint64_t PoolScores::pixels(const std::vector<std::size_t>& scenes, const PoolFigure& figure) const {
  std::uint64_t sum = 0;
  for (const std::size_t scene : scenes) {
    for (const SceneScore& score : scores_.at({scene, 0})) {
      sum += (score.*figure.pixels).pixels;
    }
  }
  return sum;
}

Estimate PoolScores::estimate(const std::vector<std::size_t>& scenes, std::size_t estimator,
                              const PoolFigure& figure) const {
  const std::vector<double> values = shares(scenes, estimator, figure);
  double mean = 0.0;
  for (const double value : values) {
    mean += value / static_cast<double>(values.size());
  }
  const std::uint64_t trials = pixels(scenes, figure);
  Estimate result =
      estimate_share(static_cast<std::uint64_t>(std::llround(mean * static_cast<double>(trials))), trials);
  result.value = mean;
  if (values.size() > 1) {
    const Interval spread = estimate_mean(values).interval;
    result.interval = {std::max(0.0, std::min(result.interval.low, spread.low)),
                       std::min(1.0, std::max(result.interval.high, spread.high))};
  }
  return result;
}

Table pooled_table(const PoolScores& scores) {
  std::vector<std::string> header = {"estimator"};
  for (const PoolFigure& figure : kPoolFigures) {
    header.emplace_back(figure.name);
  }
  Table table(std::move(header));
  const std::vector<std::size_t> scenes = scores.all_but_flats();
  for (std::size_t e = 0; e < scores.estimators().size(); ++e) {
    std::vector<std::string> row = {scores.estimators()[e]};
    for (const PoolFigure& figure : kPoolFigures) {
      row.push_back(
          scores.pixels(scenes, figure) == 0 ? "-" : with_half_interval(scores.estimate(scenes, e, figure)));
    }
    table.add(std::move(row));
  }
  return table;
}

PageData pool_page(const PoolResults& results) {
  PageData data;
  data.set("sensor", "{}", results.sensor)
      .set("first_seed", "{}", results.first_seed)
      .set("last_seed", "{}", results.last_seed)
      .set("look_up_table", "{}", results.look_up_table)
      .set("command", "{}", results.command_line);
  std::optional<PageData> goals;
  if (results.references) {
    goals = PageData().set("judged_goals", goal_table(results.lights));
  }
  data.part("goals", std::move(goals));
  std::vector<PageData> lights;
  for (const auto& [klux, scores] : results.lights) {
    PageData light;
    light.set("klux", "{:g}", klux)
        .set("scenes_together", pooled_table(scores))
        .set("all_pixels", pool_scene_table(scores, kPoolFigures[0], kPoolFigures[1]))
        .set("edges", pool_scene_table(scores, kPoolFigures[2], kPoolFigures[3]))
        .set("other_pixels", pool_scene_table(scores, kPoolFigures[4], kPoolFigures[5]));
    lights.push_back(std::move(light));
  }
  data.list("lights", std::move(lights));
  return data;
}

Table pool_csv(const std::map<double, PoolScores>& lights) {
  std::vector<std::string> header = {"klux", "scene", "estimator", "pixels"};
  for (const PoolFigure& figure : kPoolFigures) {
    for (const char* part : {"", "_low", "_high"}) {
      header.push_back(std::string(figure.column) + part);
    }
  }
  Table csv(header, 3);
  for (const auto& [klux, scores] : lights) {
    for (std::size_t s = 0; s < scores.scenes().size(); ++s) {
      for (std::size_t e = 0; e < scores.estimators().size(); ++e) {
        std::vector<std::string> row = {fmt::format("{:g}", klux), scores.scenes()[s], scores.estimators()[e],
                                        fmt::format("{}", scores.pixels({s}, kPoolFigures[0]))};
        for (const PoolFigure& figure : kPoolFigures) {
          if (scores.pixels({s}, figure) == 0) {
            row.insert(row.end(), 3, "");
            continue;
          }
          const Estimate share = scores.estimate({s}, e, figure);
          for (const double value : {share.value, share.interval.low, share.interval.high}) {
            row.push_back(fmt::format("{:.6f}", value));
          }
        }
        csv.add(std::move(row));
      }
    }
  }
  return csv;
}

PageData pool_search_page(const PoolSearchResults& results) {
  PageData data;
  data.set("added_to_each_figure", "{}", kLeastShare)
      .set("scenes", "{}", fmt::join(results.scenes, ", "))
      .set("first_seed", "{}", results.seed);
  std::optional<PageData> map;
  if (!results.map.empty()) {
    map = PageData().set("map_file", "{}", results.map);
  }
  data.part("map", std::move(map))
      .set("columns", "{}", results.engine_columns)
      .set("command", "{}", results.command_line)
      .set("designs", results.designs);
  return data;
}

}  // namespace dtof
