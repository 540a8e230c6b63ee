// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "common/scene_list.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/table.hpp"
#include "dtof/rival/rival.hpp"
#include "dtof/sensor/preset.hpp"
#include "rivals/rival_report.hpp"
#include "rivals/rival_study.hpp"

namespace dtof {
namespace {

struct RivalsOptions : SceneChoice {
  std::string sensor = "thesis";
  std::vector<double> klux = {2.0, 14.0, 50.0, 100.0};
  std::string readouts =
      "ezpointer,hispointer,sifh,fifh,threesteps,coarsehistogram,poolpointer,poolpointer-lean";
  std::vector<std::string> rivals;
  std::vector<std::string> bits;
  bool pooled = false;
  bool claims = false;
  int seeds = 4;
  std::string table = "flat";
  int threads = 0;
  std::string out = "build/rivals";
  std::string command_line;
};

/// Bits a pixel of read-outs by their names, from NAME=BITS.
std::map<std::string, double> parse_bits(const std::vector<std::string>& texts) {
  std::map<std::string, double> bits;
  for (const std::string& text : texts) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string number = text.substr(std::min(equals + 1, text.size()));
    double value = 0.0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc() || end != number.data() + number.size() || !(value > 0.0)) {
      throw InputError(fmt::format("--bits {}: expected READOUT=BITS", text));
    }
    const std::string name = text.substr(0, equals);
    (void)parse_readout(name);
    bits[name] = value;
  }
  return bits;
}

std::vector<RivalEntry> chosen_rivals(const std::vector<std::string>& names) {
  std::vector<RivalEntry> chosen;
  chosen.reserve(names.size());
  for (const std::string& name : names) {
    chosen.push_back(find_rival(name));
  }
  if (names.empty()) {
    chosen.assign(all_rivals().begin(), all_rivals().end());
  }
  return chosen;
}

/// The studies of one light and seed, whose measurements stand one behind the other.
class Comparison {
 public:
  Comparison(const RivalsOptions& options, const SensorModel& sensor, double klux)
      : readouts_(parameters(options, sensor)),
        readout_study_(sensor, klux, readouts_, options.seed, options.threads,
                       parse_table_rule(options.table)),
        rival_study_(sensor, klux, chosen_rivals(options.rivals), options.pooled, options.seed,
                     options.threads, parse_table_rule(options.table)) {}

  [[nodiscard]] std::vector<ComparedRow> rows(const std::map<std::string, double>& bits) const {
    const auto known = [&](const std::string& name) {
      const auto found = bits.find(name);
      return found == bits.end() ? std::nullopt : std::optional(found->second);
    };
    std::vector<ComparedRow> rows;
    for (std::size_t e = 0; e < readout_study_.estimators().size(); ++e) {
      const bool is_readout = e < readouts_.size();
      rows.push_back({readout_study_.estimators()[e],
                      is_readout ? ComparedRow::Kind::kReadout : ComparedRow::Kind::kReference,
                      is_readout ? known(std::string(readout_name(readouts_[e].readout))) : std::nullopt});
    }
    for (std::size_t e = 0; e < rival_study_.estimators().size(); ++e) {
      rows.push_back({rival_study_.estimators()[e], ComparedRow::Kind::kRival,
                      static_cast<double>(rival_study_.rival(e).bits_per_pixel())});
    }
    return rows;
  }

  [[nodiscard]] std::vector<SceneMeasurement> measure(const StudyScene& scene) const {
    std::vector<SceneMeasurement> all = readout_study_.measure(scene);
    std::ranges::move(rival_study_.measure(scene), std::back_inserter(all));
    return all;
  }

 private:
  static std::vector<ReadoutParameters> parameters(const RivalsOptions& options, const SensorModel& sensor) {
    ReadoutOptions plain;
    plain.readouts = options.readouts;
    return plain.parameters(kAllReadouts, sensor);
  }

  std::vector<ReadoutParameters> readouts_;
  SceneStudy readout_study_;
  RivalStudy rival_study_;
};

constexpr double kClaimKlux = 50.0;

/// The claims of the entries' figures, measured on walls of the claim's kind.
std::vector<CheckedClaim> check_claims(const RivalsOptions& options, const SensorModel& sensor) {
  std::vector<RivalEntry> claimed = chosen_rivals(options.rivals);
  std::erase_if(claimed, [](const RivalEntry& entry) { return !entry.claim; });
  std::vector<CheckedClaim> claims;
  claims.reserve(claimed.size());
  for (const RivalEntry& entry : claimed) {
    claims.push_back({std::string(entry.title), *entry.claim, {}, {}});
  }
  constexpr int kColumns = 10;
  for (int i = 0; i < options.seeds && !claims.empty(); ++i) {
    const RivalStudy study(sensor, kClaimKlux, claimed, false, options.seed + static_cast<std::uint64_t>(i),
                           options.threads, TableRule::kNone);
    for (const double wall_m : {3.0, 4.0}) {
      const StudyScene wall{"wall", TargetMap(kColumns, sensor.rows, {wall_m, 1.0}), kColumns};
      const std::vector<SceneMeasurement> measured = study.measure(wall);
      for (std::size_t r = 0; r < claims.size(); ++r) {
        add_unbiased(wall_m < 3.5 ? claims[r].at_3_m : claims[r].at_4_m, wall_m, measured[r].distance_m);
      }
    }
  }
  return claims;
}

/// What the rivals' columns are made of, and what their hosts compute.
Table hardware_of(const std::vector<RivalEntry>& rivals, const SensorModel& sensor) {
  Table table({"rival", "option", "bits_per_pixel", "words", "word_bits", "adder_bits", "table_bits",
               "host_operations", "pooling_operations"},
              2);
  for (const RivalEntry& entry : rivals) {
    const std::unique_ptr<Rival> rival = entry.make(sensor);
    const RivalHardware hardware = rival->hardware();
    std::vector<std::string> cells = {std::string(entry.title), std::string(entry.name)};
    for (const int number : {rival->bits_per_pixel(), hardware.words, hardware.word_bits, hardware.adder_bits,
                             hardware.table_bits, rival->host_operations(), pooling_operations(*rival)}) {
      cells.push_back(fmt::format("{}", number));
    }
    table.add(std::move(cells));
  }
  return table;
}

std::string sources_of(const std::vector<RivalEntry>& rivals) {
  Table table({"rival", "option", "source"}, 3);
  for (const RivalEntry& entry : rivals) {
    table.add({std::string(entry.title), std::string(entry.name), std::string(entry.citation)});
  }
  return table.markdown();
}

std::string report_of(const RivalsOptions& options, const SensorModel& sensor, std::uint64_t first_seed,
                      const std::vector<std::string>& notes, const std::map<double, ComparedScores>& lights,
                      const std::vector<CheckedClaim>& claims) {
  const std::vector<RivalEntry> rivals = chosen_rivals(options.rivals);
  std::string report = fmt::format(
      "# Read-outs and their rivals\n\nPer cent of pixels with a relative error above 3 % and above 10 "
      "%, sensor {}, seeds {} to {} (photons and random shapes), at most {} columns of a scene. All "
      "rows see the same photons; a rival whose result needs several frames also sees frames before them, "
      "and the linearised average a frame without laser light. +- is half of the 95 % interval, from the "
      "spread of the seeds, and at least that of independent pixels. Edges: pixels with a neighbour "
      "that differs by more than 10 %; single pixels: pixels that differ from all their neighbours. "
      "Scenes \"held\": no "
      "parameter of poolPointer was chosen on them. Bits: the pixel's memory only. \"pooled\": the "
      "host combines the pixels of a column. References have full histograms, which no chip could "
      "hold.\n\n{}\n\nCommand: `{}`\n",
      options.sensor, first_seed, options.seed, options.columns,
      table_sentence(parse_table_rule(options.table), sensor, first_seed), options.command_line);
  for (const std::string& note : notes) {
    report += fmt::format("\n{}\n", note);
  }
  report +=
      "\n## Beside each other\n\nAll scenes except the flat targets together. The list has the rivals that "
      "are on the front of at least one light (section Front).\n";
  for (const std::string& title : rivals_on_a_front(lights)) {
    for (const Readout other : {Readout::kHisPointer, Readout::kPoolPointer}) {
      const std::string sentence = comparison_sentence(lights, title, std::string(readout_title(other)));
      report += sentence.empty() ? "" : fmt::format("\n* {}", sentence);
    }
  }
  report += "\n";
  if (!claims.empty()) {
    report += fmt::format(
        "\n## Beside a first estimate\n\nFlat walls at {:g} klux, above 3 % / above 10 %. The first "
        "estimate had {} pixels a distance and counters without limits; here counters are as wide as "
        "stated, and there are {} pixels. Instead of a look-up table, both subtract the error of the "
        "median over all pixels of a distance, which favours rivals whose result does not grow with "
        "the distance. Agree: the 95 % intervals of both overlap. {}\n\n{}",
        kClaimKlux, kClaimedPixels, claims.front().at_3_m.pixels, claim_sentence(claims),
        claim_table(claims).markdown());
  }
  for (const auto& [klux, scores] : lights) {
    report += fmt::format("\n## {:g} klux\n", klux);
    if (!scores.scenes_with_depth().empty()) {
      report += fmt::format(
          "\n### All scenes but the flats together\n\n{}\n### Front\n\nA row is on the front if no "
          "other row with as few bits has fewer pixels above 3 %.\n\n{}",
          overall_table(scores).markdown(), front_table(scores).markdown());
    }
    report +=
        fmt::format("\n### All pixels: above 3 % / 10 %\n\n{}", scene_by_scene_table(scores).markdown());
  }
  return report + fmt::format("\n## Sources\n\n{}", sources_of(rivals));
}

void run_rivals_command(RivalsOptions options) {
  const SensorModel sensor = find_sensor(options.sensor);
  const std::map<std::string, double> bits = parse_bits(options.bits);
  if (options.claims && sensor.name != "thesis") {
    throw InputError("--claims: the first estimate is of the sensor thesis");
  }
  for (auto klux = options.klux.begin(); klux != options.klux.end(); ++klux) {
    if (std::find(options.klux.begin(), klux, *klux) != klux) {
      throw InputError(fmt::format("--klux: {:g} is named twice", *klux));
    }
  }
  (void)chosen_rivals(options.rivals);
  std::vector<std::string> notes = make_scenes(options, sensor).notes;  // refused before anything is written
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  const std::uint64_t first_seed = options.seed;
  std::vector<CheckedClaim> claims;
  if (options.claims) {
    claims = check_claims(options, sensor);
  }
  std::map<double, ComparedScores> lights;
  for (const double klux : options.klux) {
    for (int i = 0; i < options.seeds; ++i) {
      options.seed = first_seed + static_cast<std::uint64_t>(i);
      const SceneList list = make_scenes(options, sensor);
      Progress progress(fmt::format("{:g} klux, seed {}", klux, options.seed), list.scenes.size() + 1);
      const Comparison comparison(options, sensor, klux);
      progress.advance();
      if (!lights.contains(klux)) {
        std::vector<std::string> names;
        for (const StudyScene& scene : list.scenes) {
          names.push_back(scene.name);
        }
        lights.emplace(klux, ComparedScores(std::move(names), comparison.rows(bits)));
      }
      for (std::size_t s = 0; s < list.scenes.size(); ++s) {
        const SceneTruth truth = scene_truth(list.scenes[s]);
        const std::vector<SceneMeasurement> measured = comparison.measure(list.scenes[s]);
        for (std::size_t row = 0; row < measured.size(); ++row) {
          lights.at(klux).add(s, row, score_scene(truth, measured[row]));
        }
        progress.advance();
      }
    }
    if (!lights.at(klux).scenes_with_depth().empty()) {
      fmt::print("\n## {:g} klux\n\n{}", klux, overall_table(lights.at(klux)).markdown());
    }
  }
  write_file(folder / "rivals.csv", compared_csv(lights).csv());
  write_file(folder / "rival_hardware.csv", hardware_of(chosen_rivals(options.rivals), sensor).csv());
  write_file(folder / "rivals.md", report_of(options, sensor, first_seed, notes, lights, claims));
  fmt::print("\nSeeds {} to {}. Tables are in {}\n", first_seed, options.seed, options.out);
}

}  // namespace

void add_rivals_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<RivalsOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand("rivals",
                                         "The project's read-outs beside those that others have proposed, on "
                                         "the same photons, over several seeds");
  command->add_option("--sensor,-p,--preset", options->sensor, "a preset of `dtof list` or a sensor file")
      ->capture_default_str();
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("-r,--readout", options->readouts, "names from `dtof list`, separated by commas")
      ->capture_default_str();
  std::vector<std::string_view> names;
  for (const RivalEntry& entry : all_rivals()) {
    names.push_back(entry.name);
  }
  command->add_option("--rival", options->rivals,
                      fmt::format("rivals, one or more (default: all)\nnames: {}", fmt::join(names, ", ")));
  command->add_flag("--pooled", options->pooled,
                    "each rival also with its pixels pooled along the column by the host");
  command->add_flag(
      "--claims", options->claims,
      "also compare the errors that a rival's entry states for a flat wall with measured errors");
  command->add_option(
      "--bits", options->bits,
      "READOUT=BITS, one or more: bits a pixel of the project's read-outs, as synthesis reports them");
  add_scene_options(*command, *options);
  command->add_option("--table", options->table, "host look-up table: flat or none (Eq. 3.11 alone)")
      ->check(CLI::IsMember({"none", "flat"}))
      ->capture_default_str();
  command
      ->add_option(
          "--columns", options->columns,
          "columns of a scene that are judged, evenly spread; poolPointer reads all of their engines")
      ->check(CLI::Range(1, 4096))
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
    run_rivals_command(*options);
  });
}

}  // namespace dtof
