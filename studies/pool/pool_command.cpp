// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/option_checks.hpp"
#include "common/commands.hpp"
#include "common/scene_list.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/report/table.hpp"
#include "dtof/sensor/preset.hpp"
#include "pool/pool_study.hpp"

namespace dtof {
namespace {

struct PoolOptions : SceneChoice {
  std::string sensor = "thesis";
  std::vector<double> klux = {2.0, 14.0, 50.0, 100.0};
  std::vector<std::string> designs = {""};
  bool references = true;
  int seeds = 4;
  std::string table = "flat";
  int threads = 0;
  std::string out = "build/pool";
  std::string command_line;
};

/// What is counted of a scene.
struct Figure {
  const char* name;
  const char* column;  ///< of the CSV file
  ErrorShares SceneScore::*pixels;
  double ErrorShares::*share;
};
constexpr std::array<Figure, 7> kFigures = {
    {{"above 3 %", "above_3_percent", &SceneScore::all, &ErrorShares::above_3_percent},
     {"above 10 %", "above_10_percent", &SceneScore::all, &ErrorShares::above_10_percent},
     {"edges above 3 %", "edge_above_3_percent", &SceneScore::edges, &ErrorShares::above_3_percent},
     {"edges above 10 %", "edge_above_10_percent", &SceneScore::edges, &ErrorShares::above_10_percent},
     {"other pixels above 3 %", "rest_above_3_percent", &SceneScore::rest, &ErrorShares::above_3_percent},
     {"other pixels above 10 %", "rest_above_10_percent", &SceneScore::rest, &ErrorShares::above_10_percent},
     {"single pixels above 10 %", "single_above_10_percent", &SceneScore::singles,
      &ErrorShares::above_10_percent}}};

/// Scores of one light level: scene, estimator, seed.
class Scores {
 public:
  Scores(std::vector<std::string> scenes, std::vector<std::string> estimators)
      : scenes_(std::move(scenes)), estimators_(std::move(estimators)) {}

  void add(std::size_t scene, std::size_t estimator, const SceneScore& score) {
    scores_[{scene, estimator}].push_back(score);
  }
  [[nodiscard]] const std::vector<std::string>& scenes() const { return scenes_; }
  [[nodiscard]] const std::vector<std::string>& estimators() const { return estimators_; }
  [[nodiscard]] std::size_t estimator(const std::string& title) const {
    return static_cast<std::size_t>(std::ranges::find(estimators_, title) - estimators_.begin());
  }
  [[nodiscard]] std::vector<std::size_t> all_but_flats() const {
    std::vector<std::size_t> chosen;
    for (std::size_t s = 0; s < scenes_.size(); ++s) {
      if (!is_flat(scenes_[s])) {
        chosen.push_back(s);
      }
    }
    return chosen;
  }

  /// The scenes on which no parameter was chosen.
  [[nodiscard]] std::vector<std::size_t> held() const {
    std::vector<std::size_t> chosen = all_but_flats();
    std::erase_if(chosen, [this](std::size_t s) { return !scenes_[s].starts_with("held"); });
    return chosen;
  }

  /// Share in each seed of the scenes' pixels together; empty if there are none.
  [[nodiscard]] std::vector<double> shares(const std::vector<std::size_t>& scenes, std::size_t estimator,
                                           const Figure& figure) const {
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
  [[nodiscard]] std::uint64_t pixels(const std::vector<std::size_t>& scenes, const Figure& figure) const {
    std::uint64_t sum = 0;
    for (const std::size_t scene : scenes) {
      for (const SceneScore& score : scores_.at({scene, 0})) {
        sum += (score.*figure.pixels).pixels;
      }
    }
    return sum;
  }
  /// From the spread of the seeds, at least Wilson's for independent pixels.
  [[nodiscard]] Estimate estimate(const std::vector<std::size_t>& scenes, std::size_t estimator,
                                  const Figure& figure) const {
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

 private:
  std::vector<std::string> scenes_;
  std::vector<std::string> estimators_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<SceneScore>> scores_;
};

std::string per_cent(const Estimate& share) {
  return fmt::format("{:.2f} +-{:.2f}", 100.0 * share.value,
                     50.0 * (share.interval.high - share.interval.low));
}

Table pooled_table(const Scores& scores) {
  std::vector<std::string> header = {"estimator"};
  for (const Figure& figure : kFigures) {
    header.emplace_back(figure.name);
  }
  Table table(std::move(header));
  const std::vector<std::size_t> scenes = scores.all_but_flats();
  for (std::size_t e = 0; e < scores.estimators().size(); ++e) {
    std::vector<std::string> row = {scores.estimators()[e]};
    for (const Figure& figure : kFigures) {
      row.push_back(scores.pixels(scenes, figure) == 0 ? "-" : per_cent(scores.estimate(scenes, e, figure)));
    }
    table.add(std::move(row));
  }
  return table;
}

Table scene_table(const Scores& scores, const Figure& first, const Figure& second) {
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
struct Goal {
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
constexpr std::array<Goal, 14> kGoals = {{{2.0, kWith, 0, 1.0, kMatchedFilter},
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
std::optional<double> compared_with(const Goal& goal, const Scores& scores,
                                    const std::vector<std::size_t>& scenes) {
  const std::size_t reference = scores.estimator(goal.of);
  if (reference == scores.estimators().size()) {
    return std::nullopt;
  }
  return scores.estimate(scenes, reference, kFigures.at(goal.figure)).value;
}

/// A goal is met if the whole interval is below the limit, and open if the limit is inside.
const char* verdict(const Interval& interval, double limit) {
  if (interval.high < limit) {
    return "yes";
  }
  return interval.low > limit ? "**no**" : "open";
}

Table goal_table(const std::map<double, Scores>& lights) {
  Table table({"goal", "measured", "limit", "met"});
  for (const Goal& goal : kGoals) {
    const auto light = lights.find(goal.klux);
    if (light == lights.end() ||
        light->second.estimator(goal.estimator) == light->second.estimators().size()) {
      continue;
    }
    const Scores& scores = light->second;
    const std::vector<std::size_t> scenes = goal.held ? scores.held() : scores.all_but_flats();
    const Figure& figure = kFigures.at(goal.figure);
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
               per_cent(measured), fmt::format("{:.2f}", 100.0 * limit), verdict(measured.interval, limit)});
  }
  return table;
}

/// Throws InputError for options that cannot be used, before any file is written.
void check_options(const PoolOptions& options, const SensorModel& sensor) {
  for (auto klux = options.klux.begin(); klux != options.klux.end(); ++klux) {
    if (std::find(options.klux.begin(), klux, *klux) != klux) {
      throw InputError(fmt::format("--klux: {:g} is named twice", *klux));
    }
  }
  for (const std::string& design : options.designs) {
    (void)parse_pool_design(design);
  }
  (void)make_scenes(options, sensor);
}

/// Scores of all scenes and seeds at one light.
Scores measure_light(const PoolOptions& options, const SensorModel& sensor, double klux, TableRule rule) {
  std::optional<Scores> scores;
  PoolOptions of_seed = options;
  for (int i = 0; i < options.seeds; ++i) {
    of_seed.seed = options.seed + static_cast<std::uint64_t>(i);
    const SceneList list = make_scenes(of_seed, sensor);
    Progress progress(fmt::format("{:g} klux, seed {}", klux, of_seed.seed), list.scenes.size() + 1);
    const PoolStudy study(sensor, klux, options.designs, options.references, of_seed.seed, options.threads,
                          rule);
    progress.advance();
    if (!scores) {
      std::vector<std::string> names;
      for (const StudyScene& scene : list.scenes) {
        names.push_back(scene.name);
      }
      scores.emplace(std::move(names), study.estimators());
    }
    for (std::size_t s = 0; s < list.scenes.size(); ++s) {
      const SceneTruth truth = scene_truth(list.scenes[s]);
      const std::vector<SceneMeasurement> measured = study.measure(list.scenes[s]);
      for (std::size_t e = 0; e < measured.size(); ++e) {
        scores->add(s, e, score_scene(truth, measured[e]));
      }
      progress.advance();
    }
  }
  return scores.value();
}

Table csv_of(const std::map<double, Scores>& lights) {
  std::vector<std::string> header = {"klux", "scene", "estimator", "pixels"};
  for (const Figure& figure : kFigures) {
    for (const char* part : {"", "_low", "_high"}) {
      header.push_back(std::string(figure.column) + part);
    }
  }
  Table csv(header, 3);
  for (const auto& [klux, scores] : lights) {
    for (std::size_t s = 0; s < scores.scenes().size(); ++s) {
      for (std::size_t e = 0; e < scores.estimators().size(); ++e) {
        std::vector<std::string> row = {fmt::format("{:g}", klux), scores.scenes()[s], scores.estimators()[e],
                                        fmt::format("{}", scores.pixels({s}, kFigures[0]))};
        for (const Figure& figure : kFigures) {
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

/// The page. Prints the pooled table of each light.
std::string pool_page(const PoolOptions& options, const SensorModel& sensor, TableRule rule,
                      const std::map<double, Scores>& lights) {
  std::string report = fmt::format(
      "# poolPointer on scenes\n\n"
      "Percentage of pixels with a relative error above 3 % and above 10 %, sensor {}. Maps are read whole. "
      "Seeds {} to {} set the photons and the random shapes. +- is half of the 95 % interval, which comes "
      "from the spread of the seeds and is at least that of independent pixels. S1 is the last smoothing "
      "([definition](../docs/reference/poolpointer.md#decide)); the matched filter's smoothing uses the "
      "same T. An edge pixel has a neighbour whose distance differs by more than 10 %. The distance of a "
      "single pixel differs from those of all its neighbours. No parameter was chosen on a scene whose name "
      "begins with \"held\".\n\n{}\n\nCommand: `{}`\n",
      options.sensor, options.seed, options.seed + static_cast<std::uint64_t>(options.seeds) - 1,
      table_sentence(rule, sensor, options.seed), options.command_line);
  if (options.references) {
    report += fmt::format(
        "\n## Goals\n\nAll scenes except the flats together; in a row with \"held scenes\" those alone. A "
        "goal is "
        "met if the whole interval is below the limit, and open if the limit is inside the "
        "interval.\n\n{}",
        goal_table(lights).markdown());
  }
  for (const auto& [klux, scores] : lights) {
    const Table pooled = pooled_table(scores);
    fmt::print("\n## {:g} klux\n\n{}", klux, pooled.markdown());
    report +=
        fmt::format("\n## {:g} klux\n\n### All scenes but the flats together\n\n{}", klux, pooled.markdown());
    report += fmt::format("\n### All pixels: above 3 % / 10 %\n\n{}",
                          scene_table(scores, kFigures[0], kFigures[1]).markdown());
    report += fmt::format("\n### Pixels at depth edges: above 3 % / 10 %\n\n{}",
                          scene_table(scores, kFigures[2], kFigures[3]).markdown());
    report += fmt::format("\n### Other pixels: above 3 % / 10 %\n\n{}",
                          scene_table(scores, kFigures[4], kFigures[5]).markdown());
  }
  return report;
}

void run_pool_command(PoolOptions options) {
  const TableRule rule = parse_table_rule(options.table);
  const SensorModel sensor = find_sensor(options.sensor);
  options.columns = sensor.columns;
  check_options(options, sensor);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  std::map<double, Scores> lights;
  for (const double klux : options.klux) {
    lights.emplace(klux, measure_light(options, sensor, klux, rule));
  }
  const std::string report = pool_page(options, sensor, rule, lights);
  write_file(folder / "pool.csv", csv_of(lights).csv());
  write_file(folder / "pool.md", report);
  fmt::print("\nTables are in {}\n", options.out);
}

}  // namespace

void add_pool_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<PoolOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "pool", "poolPointer with and without S1 beside the matched filters, over several seeds");
  command->add_option("--sensor,-p,--preset", options->sensor, "a preset of `dtof list` or a sensor file")
      ->capture_default_str();
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("--design", options->designs,
                      "numbers to change, NAME=NUMBER,..., one design each\nnames: " +
                          fmt::format("{}", fmt::join(pool_design_names(), ", ")));
  command->add_flag("!--no-references", options->references, "leave out the matched filters");
  add_scene_options(*command, *options);
  command->add_option("--table", options->table, "host look-up table: flat or none (Eq. 3.11 alone)")
      ->check(CLI::IsMember({"none", "flat"}))
      ->capture_default_str();
  command->add_option("-s,--seed", options->seed, "first seed of photons and random shapes")
      ->capture_default_str();
  command->add_option("--seeds", options->seeds, "seeds, from the first one up")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("-j,--threads", options->threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options, command] {
    check_scene_options(*command, *options);
    run_pool_command(*options);
  });
}

}  // namespace dtof
