// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/option_checks.hpp"
#include "common/commands.hpp"
#include "common/scene_list.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/table.hpp"
#include "dtof/sensor/preset.hpp"
#include "pool/pool_report.hpp"
#include "pool/pool_search.hpp"

namespace dtof {
namespace {

/// No study that reports accuracy uses these seeds: its shapes are those of its own seeds, or 1,000 above.
constexpr std::uint64_t kTrainingSeed = 700000;

struct SearchOptions {
  std::string sensor = "thesis";
  std::vector<std::string> scenes = {"planes", "clutter", "poles"};
  std::string disparity_file;
  std::vector<double> klux = {2.0, 14.0, 50.0, 100.0};
  std::string design;
  std::vector<std::string> vary;
  int rounds = 1;
  int seeds = 1;
  int threads = 0;
  std::string out = "build/pool_search";
  std::string command_line;
};

struct Axis {
  std::string name;
  std::vector<int> values;  ///< empty: one less and one more than it is
};

Axis parse_axis(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  Axis axis{text.substr(0, equals), {}};
  std::string_view rest = std::string_view(text).substr(std::min(equals + 1, text.size()));
  while (!rest.empty()) {
    int value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    const auto used = static_cast<std::size_t>(end - rest.data());
    if (error != std::errc() || (used < rest.size() && rest[used] != ',')) {
      throw InputError(fmt::format("--vary {}: expected NAME or NAME=NUMBER,NUMBER,...", text));
    }
    axis.values.push_back(value);
    rest.remove_prefix(std::min(used + 1, rest.size()));
  }
  (void)pool_design_number({}, axis.name);  // refuses an unknown name
  return axis;
}

std::vector<TrainingFrame> training_frames(const SearchOptions& options, const SensorModel& sensor,
                                           int engine_columns) {
  std::vector<TrainingFrame> frames;
  for (int i = 0; i < options.seeds; ++i) {
    SceneChoice choice;
    choice.scenes = options.scenes;
    choice.disparity_file = options.disparity_file;
    choice.seed = kTrainingSeed + static_cast<std::uint64_t>(i);
    for (TrainingFrame& frame : draw_training_frames(sensor, make_scenes(choice, sensor).scenes, options.klux,
                                                     choice.seed, engine_columns, options.threads)) {
      frames.push_back(std::move(frame));
    }
  }
  return frames;
}

/// The best design so far, its score, and a table of all designs that were tried.
class Search {
 public:
  Search(const SensorModel& sensor, const SearchOptions& options)
      : sensor_(sensor),
        threads_(options.threads),
        best_(parse_pool_design(options.design)),
        table_(header(options.klux), 2) {
    for (const std::string& text : options.vary) {
      axes_.push_back(parse_axis(text));
    }
  }

  /// Scores the first design, and changes one number after the other, at most `rounds` times each.
  void run(std::vector<TrainingFrame> frames, const SearchOptions& options) {
    frames_ = std::move(frames);
    score_ = score_design(sensor_, frames_, best_, threads_);
    report("start " + options.design, score_, true);
    for (int round = 0; round < options.rounds; ++round) {
      bool changed = false;
      for (const Axis& axis : axes_) {
        changed = try_values(axis) || changed;
      }
      if (!changed) {
        break;
      }
    }
  }

  [[nodiscard]] const PoolNumbers& best() const { return best_; }
  [[nodiscard]] const Table& table() const { return table_; }

 private:
  static std::vector<std::string> header(const std::vector<double>& klux) {
    std::vector<std::string> names = {"design",    "kept",          "objective",  "change, %",
                                      "above 3 %", "S1: above 3 %", "above 10 %", "S1: edges above 3 %"};
    for (const double light : std::set<double>(klux.begin(), klux.end())) {
      names.push_back(fmt::format("objective at {:g} klux", light));
    }
    return names;
  }

  /// Tries every value of an axis with the best design, and keeps the best of them. Returns true if the best
  /// design changed.
  bool try_values(const Axis& axis) {
    const int start = pool_design_number(best_, axis.name);
    const std::vector<int> values =
        axis.values.empty() ? std::vector<int>{start - 1, start + 1} : axis.values;
    PoolNumbers leader = best_;
    DesignScore leading = score_;
    for (const int value : values) {
      if (value == start) {
        continue;
      }
      const PoolNumbers design = with_pool_design_number(best_, axis.name, value);
      try {
        design.validate();
      } catch (const InputError&) {
        continue;  // not every neighbour of a legal number is legal
      }
      const DesignScore tried = score_design(sensor_, frames_, design, threads_);
      const bool better = tried.objective() < leading.objective();
      report(fmt::format("{}={}", axis.name, value), tried, better);
      if (better) {
        leader = design;
        leading = tried;
      }
    }
    const bool changed = !(leader == best_);
    best_ = leader;
    score_ = leading;
    return changed;
  }

  /// Prints a design's row at once, for a search takes hours.
  void report(const std::string& name, const DesignScore& tried, bool kept) {
    std::vector<std::string> row = {
        name,
        kept ? "yes" : "",
        fmt::format("{:.4f}", tried.objective()),
        fmt::format("{:+.1f}", 100.0 * (tried.objective() / score_.objective() - 1.0)),
        fmt::format("{:.3f}", tried.above_3_percent),
        fmt::format("{:.3f}", tried.smooth_above_3_percent),
        fmt::format("{:.3f}", tried.above_10_percent),
        fmt::format("{:.3f}", tried.edges_above_3_percent)};
    for (const double light : tried.by_light) {
      row.push_back(fmt::format("{:.3f}", light));
    }
    fmt::print("{}\n", fmt::join(row, " | "));
    std::fflush(stdout);
    table_.add(std::move(row));
  }

  const SensorModel& sensor_;
  int threads_;
  PoolNumbers best_;
  DesignScore score_;
  Table table_;
  std::vector<Axis> axes_;
  std::vector<TrainingFrame> frames_;
};

void run_search(const SearchOptions& options) {
  const SensorModel sensor = find_sensor(options.sensor);
  Search search(sensor, options);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  const int engine_columns = search.best().engine_columns;
  search.run(training_frames(options, sensor, engine_columns), options);
  write_file(folder / "pool_search.csv", search.table().csv());
  write_page(folder, "pool_search", "pool_search",
             pool_search_page({.scenes = options.scenes,
                               .map = std::filesystem::path(options.disparity_file).filename().string(),
                               .seed = kTrainingSeed,
                               .engine_columns = search.best().engine_columns,
                               .designs = search.table(),
                               .command_line = options.command_line}));
  fmt::print("Tables are in {}\n", options.out);
}

}  // namespace

void add_pool_search_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<SearchOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "pool-search", "searches poolPointer's numbers on training scenes, which no report of accuracy uses");
  command->add_option("--sensor,-p,--preset", options->sensor, "a preset of `dtof list` or a sensor file")
      ->capture_default_str();
  command->add_option("--scene", options->scenes, "scenes whose shapes depend on the seed, one or more")
      ->check(CLI::IsMember({"planes", "clutter", "poles"}))
      ->capture_default_str();
  command->add_option("--disparity", options->disparity_file,
                      "also a disparity map that is no test scene (8-bit PNG, 0 = unknown)");
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("--design", options->design, "where to start: NAME=NUMBER,... as in `dtof-study pool`");
  command->add_option("--vary", options->vary,
                      "NAME (one less and one more) or NAME=NUMBER,..., one or more");
  command->add_option("--rounds", options->rounds, "most rounds in which all numbers are tried")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--seeds", options->seeds, "seeds of shapes and photons")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("-j,--threads", options->threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options] { run_search(*options); });
}

}  // namespace dtof
