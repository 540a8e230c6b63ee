// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "page/page.hpp"
#include "rivals/paper_claims.hpp"

namespace dtof {
namespace {

struct ClaimsOptions {
  PaperClaimSettings settings;
  std::string out = "build/claims";
  std::string command_line;
};

Table claims_table(const PaperClaims& found) {
  Table table({"paper", "claim", "test", "here", "verdict"}, 5);
  for (const PaperClaim& claim : found.claims) {
    table.add(
        {claim.paper, claim.claim, claim.test, claim.figure, std::string(claim_verdict_word(claim.verdict))});
  }
  return table;
}

std::string bits_of(const CodePrecision& code) { return code.bits == 0 ? "-" : fmt::format("{}", code.bits); }

Table scene_table(const PaperScene& scene) {
  Table table({"code", "numbers", "bits", "error, codes", "times the bound", "lost, %"});
  for (const CodePrecision& code : scene.codes) {
    table.add({code.code, fmt::format("{}", code.values), bits_of(code),
               fmt::format("{:.3f} ({:.3f} to {:.3f})", code.rmse.value, code.rmse.interval.low,
                           code.rmse.interval.high),
               fmt::format("{:.2f}", code.rmse.value / scene.bound),
               fmt::format("{:.2f}", 100.0 * code.lost)});
  }
  return table;
}

Table csv_table(const PaperClaims& found) {
  Table table({"photons", "family", "code", "values", "bits", "rmse_codes", "rmse_low", "rmse_high",
               "cramer_rao_codes", "lost_share"},
              3);
  for (const PaperScene& scene : found.scenes) {
    for (const CodePrecision& code : scene.codes) {
      table.add({scene.name, code.family, code.code, fmt::format("{}", code.values),
                 code.bits == 0 ? "" : fmt::format("{}", code.bits), fmt::format("{:.6g}", code.rmse.value),
                 fmt::format("{:.6g}", code.rmse.interval.low),
                 fmt::format("{:.6g}", code.rmse.interval.high), fmt::format("{:.6g}", scene.bound),
                 fmt::format("{:.6g}", code.lost)});
    }
  }
  return table;
}

/// Error over the bound by the numbers that leave a pixel: a line for each family of several codes.
void write_picture(const std::filesystem::path& path, const PaperScene& scene) {
  std::vector<PlotSeries> series;
  for (const CodePrecision& code : scene.codes) {
    if (series.empty() || series.back().label != code.family) {
      series.push_back({code.family, {}, {}});
    }
    series.back().x.push_back(code.values);
    series.back().y.push_back(code.rmse.value / scene.bound);
  }
  std::erase_if(series, [](const PlotSeries& line) { return line.x.size() < 2; });
  write_plot(path, series,
             {.title = fmt::format("Error over the Cramer-Rao bound, {} photons", scene.name),
              .x_label = "numbers that leave a pixel",
              .y_label = "error / bound",
              .logarithmic_y = true,
              .y_limits = {1.0},
              .logarithmic_x = true});
}

/// Error over the bound by the numbers that leave a pixel is a curve only with three codes or more.
bool has_picture(const PaperScene& scene) { return scene.codes.size() > 2; }

PageData claims_page(const ClaimsOptions& options, const PaperClaims& found) {
  std::vector<PageData> scenes;
  for (const PaperScene& scene : found.scenes) {
    scenes.emplace_back()
        .set("photons", "{}", scene.name)
        .set("description", "{}", scene.description)
        .set("bound", "{:.3f}", scene.bound)
        .flag("has_picture", has_picture(scene))
        .set("precision", scene_table(scene));
  }
  PageData data;
  data.set("pixels", "{}", options.settings.pixels)
      .set("seed", "{}", options.settings.seed)
      .set("claims", claims_table(found))
      .list("scenes", std::move(scenes))
      .set("command", "{}", options.command_line);
  return data;
}

void run_claims_command(const ClaimsOptions& options) {
  const PaperClaims found = judge_paper_claims(options.settings);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  for (const PaperScene& scene : found.scenes) {
    if (has_picture(scene)) {
      write_picture(folder / fmt::format("{}.svg", scene.name), scene);
    }
  }
  write_file(folder / "claims.csv", csv_table(found).csv());
  write_page(folder, "claims", "claims", claims_page(options, found));
  fmt::print("{}\nSeed {}. Written to {}\n", claims_table(found).markdown(), options.settings.seed,
             (folder / "claims.md").string());
}

}  // namespace

void add_claims_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ClaimsOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "claims", "Tests the claims of the rivals' papers on the kind of photons that these papers use");
  command->add_option("--pixels", options->settings.pixels, "pixels of each kind of photons")
      ->check(CLI::Range(100, 1'000'000))
      ->capture_default_str();
  add_study_options(*command, options->settings.seed, options->settings.threads, options->out);
  command->callback([options] { run_claims_command(*options); });
}

}  // namespace dtof
