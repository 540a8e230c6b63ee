// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "app/commands.hpp"
#include "app/option_checks.hpp"
#include "app/options.hpp"
#include "app/output_folder.hpp"
#include "app/plot.hpp"
#include "app/readout_run.hpp"
#include "app/recording.hpp"
#include "app/region.hpp"
#include "app/table.hpp"
#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/result_csv.hpp"
#include "metrics/depth.hpp"
#include "metrics/error_statistics.hpp"

namespace dtof {
namespace {

struct ReplayOptions {
  ReadoutOptions readout;
  RunOptions run;
  RecordingOptions recording;
  double shift_ns = 0.0;
  double bin_width_ps = 0.0;
  double tick_ps = 8.0;
  double t_int_ns = 45.0;
  std::optional<double> photons;
  std::string out = "build/replay";
  std::string command_line;
};

/// Distances of one read-out against the recording's truth.
struct TruthComparison {
  std::string title;
  std::vector<double> true_m;
  std::vector<double> measured_m;  ///< the median difference to truth is removed: the sensor's own offset
  double offset_m = 0.0;
};

/// Whether the recording knows a true distance of a pixel of the region: not of one that saw nothing.
bool has_truth(const Recording& recording, const Region& region) {
  if (recording.true_distance.empty()) {
    return false;
  }
  const auto width = static_cast<std::size_t>(recording.source->columns());
  for (int row = region.rows.first; row < region.rows.first + region.rows.count; ++row) {
    for (const int column : region.columns) {
      if (!std::isnan(recording.true_distance[static_cast<std::size_t>(row) * width +
                                              static_cast<std::size_t>(column)])) {
        return true;
      }
    }
  }
  return false;
}

/// The region has a pixel of known distance.
TruthComparison compare(const Recording& recording, const ReadoutParameters& parameters,
                        const ReadoutRun& run, const Region& region, double t_int_s) {
  // No pulse width is subtracted: the recording's zero distance is part of the offset.
  const DepthScale scale(t_int_s, parameters.np, 0.0);
  TruthComparison comparison;
  comparison.title = readout_title(parameters.readout);
  std::vector<double> differences;
  const auto width = static_cast<std::size_t>(recording.source->columns());
  for (const ResultRecord& pixel : result_records(run.results, region)) {
    const double truth = recording.true_distance[static_cast<std::size_t>(pixel.row) * width +
                                                 static_cast<std::size_t>(pixel.column)];
    if (!std::isnan(truth)) {
      comparison.true_m.push_back(truth);
      comparison.measured_m.push_back(scale.depth(code_position(pixel.result, parameters.fraction_bits)));
      differences.push_back(comparison.measured_m.back() - truth);
    }
  }
  comparison.offset_m = median(differences);
  for (double& measured : comparison.measured_m) {
    measured -= comparison.offset_m;
  }
  return comparison;
}

double rms_error(const TruthComparison& comparison) {
  RunningMoments error;
  for (std::size_t i = 0; i < comparison.true_m.size(); ++i) {
    error.add(comparison.measured_m[i] - comparison.true_m[i]);
  }
  return std::sqrt(error.mean_square());
}

double median_error(const TruthComparison& comparison) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < comparison.true_m.size(); ++i) {
    errors.push_back(std::abs(comparison.measured_m[i] - comparison.true_m[i]));
  }
  return median(errors);
}

Table summarise(const std::vector<TruthComparison>& comparisons) {
  Table table({"read-out", "slope", "rms error mm", "median error mm", "offset mm", "measurements"});
  for (const TruthComparison& comparison : comparisons) {
    const LinearFit fit = fit_line(comparison.true_m, comparison.measured_m);
    table.add({comparison.title, fmt::format("{:.3f}", fit.slope),
               fmt::format("{:.1f}", rms_error(comparison) * 1e3),
               fmt::format("{:.1f}", median_error(comparison) * 1e3),
               fmt::format("{:.0f}", comparison.offset_m * 1e3),
               fmt::format("{}", comparison.true_m.size())});
  }
  return table;
}

/// Median measured distance in about ten groups of true distance.
Table distances_against_truth(const std::vector<TruthComparison>& comparisons) {
  constexpr double kGroups = 10.0;
  std::vector<std::string> header = {"true mm"};
  for (const TruthComparison& comparison : comparisons) {
    header.push_back(comparison.title);
  }
  Table table(header);
  const auto [lowest, highest] =
      std::minmax_element(comparisons.front().true_m.begin(), comparisons.front().true_m.end());
  const double first = *lowest;
  const double width = std::max((*highest - first) / kGroups, 1e-3);
  std::map<int, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < comparisons.front().true_m.size(); ++i) {
    groups[static_cast<int>((comparisons.front().true_m[i] - first) / width)].push_back(i);
  }
  for (const auto& [group, members] : groups) {
    std::vector<double> truths;
    for (const std::size_t i : members) {
      truths.push_back(comparisons.front().true_m[i]);
    }
    std::vector<std::string> row = {fmt::format("{:.0f}", median(truths) * 1e3)};
    for (const TruthComparison& comparison : comparisons) {
      std::vector<double> errors;
      for (const std::size_t i : members) {
        errors.push_back(comparison.measured_m[i] - comparison.true_m[i]);
      }
      row.push_back(fmt::format("{:.0f}", (median(truths) + median(errors)) * 1e3));
    }
    table.add(row);
  }
  return table;
}

void write_comparison(const std::vector<TruthComparison>& comparisons, const ReplayOptions& options,
                      const std::string& heading) {
  const std::filesystem::path folder(options.out);
  const Table summary = summarise(comparisons);
  const Table distances = distances_against_truth(comparisons);
  Table measurements({"true_mm", "readout", "measured_mm"});
  std::vector<PlotSeries> series;
  for (const TruthComparison& comparison : comparisons) {
    PlotSeries& line = series.emplace_back(PlotSeries{comparison.title, {}, {}});
    std::map<double, std::vector<double>> by_truth;
    for (std::size_t i = 0; i < comparison.true_m.size(); ++i) {
      measurements.add({fmt::format("{:.1f}", comparison.true_m[i] * 1e3), comparison.title,
                        fmt::format("{:.1f}", comparison.measured_m[i] * 1e3)});
      by_truth[comparison.true_m[i] * 1e3].push_back(comparison.measured_m[i] * 1e3);
    }
    for (const auto& [truth, measured] : by_truth) {
      line.x.push_back(truth);
      line.y.push_back(median(measured) - truth);
    }
  }
  write_file(folder / "summary.csv", summary.csv());
  write_file(folder / "measurements.csv", measurements.csv());
  write_file(folder / "summary.md",
             fmt::format("{}\n{}\nMeasured distance in mm (median of each group of true distances):\n\n{}\n"
                         "Command: `{}`\n",
                         heading, summary.markdown(), distances.markdown(), options.command_line));
  write_plot(folder / "error.svg", series,
             {.title = "Error of the measured distance: " + options.recording.file,
              .x_label = "true distance, mm",
              .y_label = "measured - true, mm (median of the zones)"});
  fmt::print("{}\n{}\nMeasured distance in mm (median of each group of true distances):\n\n{}\n", heading,
             summary.markdown(), distances.markdown());
}

/// Options that say nothing about this kind of recording.
void check_recording_options(const CLI::App& command, const RecordingOptions& recording) {
  const std::string format = recording_format(recording);
  if (format == "csv") {
    for (const char* option : {"--photons", "--background", "--shift"}) {
      refuse_without_effect(command, option, "a TDC stream is replayed as it was recorded");
    }
  } else {
    for (const char* option : {"--array-columns", "--array-rows"}) {
      refuse_without_effect(command, option, "only a TDC stream (CSV) does not know its array");
    }
  }
  if (format != "npy") {
    refuse_without_effect(command, "--bin-width", "only an NPY file does not know it");
  }
  if (format != "mat") {
    for (const char* option : {"--tick", "--variable"}) {
      refuse_without_effect(command, option, "only MATLAB files have one");
    }
  }
}

void run_replay_command(const ReplayOptions& options) {
  options.run.validate();
  const std::vector<ReadoutParameters> readouts = options.readout.parameters(kModelReadouts);
  if (!options.run.trace.empty() && readouts.size() != 1) {
    throw InputError("--trace needs exactly one read-out");
  }
  RecordingOptions recording_options = options.recording;
  recording_options.tick_s = options.tick_ps * 1e-12;
  if (options.bin_width_ps > 0.0) {
    recording_options.bin_width_s = options.bin_width_ps * 1e-12;
  }
  Resampling& resampling = recording_options.resampling;
  resampling.np = readouts.front().np;
  resampling.slots = readouts.front().slots;
  resampling.integration_time = options.t_int_ns * 1e-9;
  resampling.time_shift = options.shift_ns * 1e-9;
  resampling.photon_budget = options.photons;
  resampling.seed = options.run.seed;
  const Recording recording = open_recording(recording_options);
  const Region region{.columns = parse_columns(options.run.columns, recording.source->columns()),
                      .rows = parse_rows(options.run.rows, recording.source->rows())};
  check_engine(*recording.source, readouts, options.run, region);
  create_output_folder(options.out);
  std::vector<TruthComparison> comparisons;
  for (const ReadoutParameters& parameters : readouts) {
    const ReadoutRun run =
        run_readout(*recording.source, parameters, options.run, region, options.command_line);
    write_result_csv(
        std::filesystem::path(options.out) / fmt::format("{}.csv", readout_name(parameters.readout)),
        result_records(run.results, region));
    if (has_truth(recording, region)) {
      comparisons.push_back(compare(recording, parameters, run, region, resampling.integration_time));
    }
  }
  const std::string heading = fmt::format(
      "{} ({}): {} columns x {} rows, {} acquisitions{}, engine {}{}, seed {}.\n", options.recording.file,
      recording.description, region.columns.size(), region.rows.count, recording.source->acquisitions(),
      options.photons ? fmt::format(", thinned to {:g} photons per pixel and frame", *options.photons) : "",
      options.run.engine, options.run.verify ? " (every pixel equal to the model)" : "", options.run.seed);
  if (comparisons.empty()) {
    fmt::print("{}", heading);
  } else {
    write_comparison(comparisons, options, heading);
  }
  fmt::print("Results are in {}\n", options.out);
}

}  // namespace

void add_replay_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ReplayOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "replay",
      "Reads out recorded data: TDC streams (CSV), histograms (NPY, TMF8820, TMF8829), photon times (MAT)");
  command->add_option("file", options->recording.file, "recording")->required();
  command->add_option("--format", options->recording.format, "kind of file")
      ->check(CLI::IsMember({"auto", "csv", "npy", "mat", "tmf8820", "tmf8829"}))
      ->capture_default_str();
  command->add_option("-a,--acquisitions", options->recording.acquisitions,
                      "laser pulses per frame (default: CSV: the last one recorded, else 3333)");
  command
      ->add_option("--array-columns", options->recording.columns,
                   "CSV: columns of the sensor (default: to the last one that detected something)")
      ->check(CLI::Range(1, 65536));
  command->add_option("--array-rows", options->recording.rows, "CSV: rows of the sensor, likewise")
      ->check(CLI::Range(1, 65536));
  command->add_option("--photons", options->photons,
                      "measured data: thin to this mean number of photons per pixel and frame");
  command
      ->add_option("--background", options->recording.resampling.background,
                   "measured data: background events to add per acquisition and T_int")
      ->capture_default_str();
  command->add_option("--shift", options->shift_ns, "measured data: ns to add to every time")
      ->capture_default_str();
  command->add_option("--t-int", options->t_int_ns, "T_int in ns; T_res = T_int / 2^NP")
      ->capture_default_str();
  command->add_option("--bin-width", options->bin_width_ps, "NPY: width of a bin in ps");
  command->add_option("--tick", options->tick_ps, "MAT: duration of a tick in ps")->capture_default_str();
  command->add_option("--variable", options->recording.variable, "MAT: name of the cell array")
      ->capture_default_str();
  options->readout.add_to(*command);
  options->run.add_to(*command);
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options, command] {
    check_recording_options(*command, options->recording);
    run_replay_command(*options);
  });
}

}  // namespace dtof
