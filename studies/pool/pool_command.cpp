// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
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
#include "dtof/sensor/preset.hpp"
#include "pool/pool_report.hpp"
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
PoolScores measure_light(const PoolOptions& options, const SensorModel& sensor, double klux, TableRule rule) {
  std::optional<PoolScores> scores;
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

void run_pool_command(PoolOptions options) {
  const TableRule rule = parse_table_rule(options.table);
  const SensorModel sensor = find_sensor(options.sensor);
  options.columns = sensor.columns;
  check_options(options, sensor);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  PoolResults results{.sensor = options.sensor,
                      .first_seed = options.seed,
                      .last_seed = options.seed + static_cast<std::uint64_t>(options.seeds) - 1,
                      .look_up_table = table_sentence(rule, sensor, options.seed),
                      .references = options.references,
                      .lights = {},
                      .command_line = options.command_line};
  for (const double klux : options.klux) {
    results.lights.emplace(klux, measure_light(options, sensor, klux, rule));
  }
  for (const auto& [klux, scores] : results.lights) {
    fmt::print("\n## {:g} klux\n\n{}", klux, pooled_table(scores).markdown());
  }
  write_file(folder / "pool.csv", pool_csv(results.lights).csv());
  write_page(folder, "pool", "pool", pool_page(results));
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
