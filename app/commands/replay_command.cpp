// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "command_line/recording_options.hpp"
#include "command_line/truth_map.hpp"
#include "commands/commands.hpp"
#include "commands/json_result.hpp"
#include "commands/optional_output.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/io/result_csv.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/recording/recording.hpp"
#include "dtof/recording/resampling.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "run/readout_run.hpp"
#include "run/region.hpp"

namespace dtof {
namespace {

struct ReplayOptions {
  ReadoutOptions readout;
  RunSettings run;
  RecordingOptions recording;
  double shift_ns = 0.0;
  std::optional<double> bin_width_ps;
  double tick_ps = 8.0;
  double t_int_ns = 45.0;
  std::optional<double> photons;
  std::string truth_file;
  std::optional<double> truth_scale;
  std::optional<double> offset_mm;
  std::string out = "build/replay";
  std::string command_line;
  bool json = false;
};

/// Distances of one read-out against the recording's truth.
struct TruthComparison {
  std::string title;
  std::vector<double> true_m;
  std::vector<double> measured_m;  ///< without the offset
  double offset_m = 0.0;  ///< zero distance of the recording: --offset, or the median difference to truth
};

/// True if the recording has a true distance for a pixel of the region that detected photons.
bool has_truth(const Recording& recording, const Region& region) {
  if (recording.true_distance.empty()) {
    return false;
  }
  const auto width = static_cast<std::size_t>(recording.source->columns());
  for (int row = region.rows.first; row < region.rows.first + region.rows.count; ++row) {
    for (const int column : region.columns) {
      if (recording.true_distance[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)] >
          0.0) {
        return true;
      }
    }
  }
  return false;
}

/// The region has a pixel of known distance.
TruthComparison compare(const Recording& recording, const ReadoutParameters& parameters,
                        const ReadoutRun& run, const Region& region, const ReplayOptions& options) {
  // No pulse width is subtracted: the recording's zero distance is part of the offset.
  const DepthScale scale(options.t_int_ns * 1e-9, parameters.np, 0.0);
  TruthComparison comparison;
  comparison.title = readout_title(parameters.readout);
  std::vector<double> differences;
  const auto width = static_cast<std::size_t>(recording.source->columns());
  for (const ResultRecord& pixel : result_records(run.results, region)) {
    const double truth = recording.true_distance[static_cast<std::size_t>(pixel.row) * width +
                                                 static_cast<std::size_t>(pixel.column)];
    if (truth > 0.0) {  // false for NaN, too
      comparison.true_m.push_back(truth);
      comparison.measured_m.push_back(scale.depth(code_position(pixel.result, parameters.fraction_bits)));
      differences.push_back(comparison.measured_m.back() - truth);
    }
  }
  comparison.offset_m = options.offset_mm ? *options.offset_mm * 1e-3 : median(differences);
  for (double& measured : comparison.measured_m) {
    measured -= comparison.offset_m;
  }
  return comparison;
}

double median_error(const TruthComparison& comparison) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < comparison.true_m.size(); ++i) {
    errors.push_back(std::abs(comparison.measured_m[i] - comparison.true_m[i]));
  }
  return median(errors);
}

/// Slope of measured over true distance; none if all true distances are equal.
std::string slope(const TruthComparison& comparison) {
  const auto [lowest, highest] = std::ranges::minmax(comparison.true_m);
  return lowest == highest ? "-"
                           : fmt::format("{:.3f}", fit_line(comparison.true_m, comparison.measured_m).slope);
}

Table summarise(const std::vector<TruthComparison>& comparisons) {
  Table table({"read-out", "slope", "rmse mm", "bias mm", "median error mm", "above 3 %", "above 10 %",
               "offset mm", "measurements"});
  for (const TruthComparison& comparison : comparisons) {
    const ErrorSummary errors = summarise_errors(comparison.true_m, comparison.measured_m);
    table.add({comparison.title, slope(comparison), fmt::format("{:.1f}", errors.rmse_m * 1e3),
               fmt::format("{:.1f}", errors.bias_m * 1e3),
               fmt::format("{:.1f}", median_error(comparison) * 1e3),
               fmt::format("{:.2f} %", errors.share_above_3_percent * 100.0),
               fmt::format("{:.2f} %", errors.share_above_10_percent * 100.0),
               fmt::format("{:.0f}", comparison.offset_m * 1e3), fmt::format("{}", errors.count)});
  }
  return table;
}

std::string offset_sentence(const ReplayOptions& options) {
  const std::string truth = options.truth_file.empty() ? "the recording's own" : options.truth_file;
  return options.offset_mm
             ? fmt::format("Truth: {}. Offset: {:g} mm is taken from every distance (--offset).", truth,
                           *options.offset_mm)
             : fmt::format(
                   "Truth: {}. Offset: each read-out's median difference to truth is taken from its "
                   "distances; "
                   "bias is what is left.",
                   truth);
}

/// Indices of the measurements by groups of true distance of equal width.
std::vector<std::vector<std::size_t>> groups_of_distance(const std::vector<double>& true_m, int count) {
  const auto [lowest, highest] = std::ranges::minmax(true_m);
  const double width = std::max((highest - lowest) / count, 1e-3);
  std::map<int, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < true_m.size(); ++i) {
    groups[std::min(static_cast<int>((true_m[i] - lowest) / width), count - 1)].push_back(i);
  }
  std::vector<std::vector<std::size_t>> found;
  found.reserve(groups.size());
  for (auto& [group, members] : groups) {
    found.push_back(std::move(members));
  }
  return found;
}

/// Median measured distance in about ten groups of true distance.
Table distances_against_truth(const std::vector<TruthComparison>& comparisons) {
  constexpr int kGroups = 10;
  std::vector<std::string> header = {"true mm"};
  for (const TruthComparison& comparison : comparisons) {
    header.push_back(comparison.title);
  }
  Table table(header);
  for (const std::vector<std::size_t>& members : groups_of_distance(comparisons.front().true_m, kGroups)) {
    std::vector<double> truths;
    truths.reserve(members.size());
    for (const std::size_t i : members) {
      truths.push_back(comparisons.front().true_m[i]);
    }
    std::vector<std::string> row = {fmt::format("{:.0f}", median(truths) * 1e3)};
    for (const TruthComparison& comparison : comparisons) {
      std::vector<double> errors;
      errors.reserve(members.size());
      for (const std::size_t i : members) {
        errors.push_back(comparison.measured_m[i] - comparison.true_m[i]);
      }
      row.push_back(fmt::format("{:.0f}", (median(truths) + median(errors)) * 1e3));
    }
    table.add(row);
  }
  return table;
}

/// Errors of each read-out in mm over groups of true distance: the median, and a band that holds 80 % of
/// them.
std::vector<PlotSeries> errors_over_truth(const std::vector<TruthComparison>& comparisons) {
  constexpr int kGroups = 20;
  std::vector<PlotSeries> series;
  for (const TruthComparison& comparison : comparisons) {
    PlotSeries& line = series.emplace_back(PlotSeries{comparison.title, {}, {}});
    for (const std::vector<std::size_t>& members : groups_of_distance(comparison.true_m, kGroups)) {
      std::vector<double> truths;
      truths.reserve(members.size());
      std::vector<double> errors;
      errors.reserve(members.size());
      for (const std::size_t i : members) {
        truths.push_back(comparison.true_m[i] * 1e3);
        errors.push_back((comparison.measured_m[i] - comparison.true_m[i]) * 1e3);
      }
      std::ranges::sort(errors);
      const auto at = [&](double share) {
        return errors[static_cast<std::size_t>(std::lround(share * static_cast<double>(errors.size() - 1)))];
      };
      line.x.push_back(median(truths));
      line.y.push_back(median(errors));
      line.low.push_back(at(0.1));
      line.high.push_back(at(0.9));
    }
  }
  return series;
}

void write_comparison(const std::vector<TruthComparison>& comparisons, const ReplayOptions& options,
                      const std::string& recording, const std::string& heading) {
  const std::filesystem::path folder(options.out);
  const Table summary = summarise(comparisons);
  const Table distances = distances_against_truth(comparisons);
  Table measurements({"true_mm", "readout", "measured_mm"});
  for (const TruthComparison& comparison : comparisons) {
    for (std::size_t i = 0; i < comparison.true_m.size(); ++i) {
      measurements.add({fmt::format("{:.1f}", comparison.true_m[i] * 1e3), comparison.title,
                        fmt::format("{:.1f}", comparison.measured_m[i] * 1e3)});
    }
  }
  write_file(folder / "summary.csv", summary.csv());
  write_file(folder / "measurements.csv", measurements.csv());
  const std::filesystem::path plot = folder / "error.svg";
  const bool plotted = write_optional(plot, plot_obstacle(), [&] {
    write_plot(
        plot, errors_over_truth(comparisons),
        {.title = fmt::format(
             "Error of the measured distance in mm (median, and 80 % of the measurements): {}", recording),
         .x_label = "true distance, mm",
         .y_label = "error, mm",
         .y_limits = {0.0},
         .panels = true});
  });
  write_file(
      folder / "summary.md",
      fmt::format("{}\n{}\n{}\n\n{}"
                  "Measured distance in mm (median of each group of true distances):\n\n{}\nCommand: `{}`\n",
                  heading, summary.markdown(), offset_sentence(options),
                  plotted ? "![Error of the measured distance](error.svg)\n\n" : "", distances.markdown(),
                  options.command_line));
  fmt::print("{}\n{}\n{}\n\nMeasured distance in mm (median of each group of true distances):\n\n{}\n",
             heading, summary.markdown(), offset_sentence(options), distances.markdown());
}

/// Options that say nothing about this kind of recording.
void check_recording_options(const CLI::App& command, const std::string& format) {
  if (format == "csv") {
    for (const char* option : {"--photons", "--background", "--shift"}) {
      refuse_without_effect(command, option, "a TDC stream is replayed as it was recorded");
    }
  } else {
    for (const char* option : {"--array-columns", "--array-rows"}) {
      refuse_without_effect(command, option, "only a TDC stream (CSV) lacks the size of its array");
    }
  }
  refuse_recording_options(command, format);
}

/// Distance whose light, there and back, still falls into T_int, m.
double reach_m(const ReplayOptions& options) {
  return 0.5 * kSpeedOfLight * 1e-9 * (options.t_int_ns - options.shift_ns);
}

/// The range as sentences name it.
std::string range_phrase(const ReplayOptions& options) {
  return fmt::format(
      "the range, {:.2f} m (light there and back in {:g} ns{})", reach_m(options), options.t_int_ns,
      options.shift_ns == 0.0 ? "" : fmt::format(", times shifted by {:g} ns", options.shift_ns));
}

/// Makes unknown what the pixels of the region cannot be judged by, and says so. Throws InputError if no true
/// distance can be measured.
std::string drop_unjudged(Recording& recording, const Region& region, const ReplayOptions& options) {
  std::uint64_t beyond = 0;
  std::uint64_t dark = 0;
  std::uint64_t judged = 0;
  double nearest = std::numeric_limits<double>::infinity();
  bool whole = true;
  const auto width = static_cast<std::size_t>(recording.source->columns());
  for (const int column : region.columns) {
    const ColumnStream stream = recording.source->column_rows(column, region.rows);
    for (int row = 0; row < region.rows.count; ++row) {
      double& truth = recording.true_distance[static_cast<std::size_t>(region.rows.first + row) * width +
                                              static_cast<std::size_t>(column)];
      if (!(truth > 0.0)) {
        continue;
      }
      nearest = std::min(nearest, truth);
      whole = whole && truth == std::floor(truth);
      const bool out_of_reach = truth >= reach_m(options);
      const bool saw_nothing = stream.row(row).empty();
      beyond += out_of_reach ? 1 : 0;
      dark += !out_of_reach && saw_nothing ? 1 : 0;
      judged += !out_of_reach && !saw_nothing ? 1 : 0;
      if (out_of_reach || saw_nothing) {
        truth = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }
  if (judged == 0 && dark == 0) {
    throw InputError(fmt::format("{}: every true distance is beyond {}, {}",
                                 options.truth_file.empty() ? options.recording.file : options.truth_file,
                                 range_phrase(options),
                                 unreachable_phrase(nearest, reach_m(options),
                                                    whole && !options.truth_file.empty(), "--truth-scale")));
  }
  return not_judged_sentence(beyond, fmt::format("beyond {},", range_phrase(options))) +
         not_judged_sentence(dark, "without a detection");
}

/// What is lost of a measurement because it lies outside the range; empty if nothing is. Throws InputError if
/// everything is.
std::string lost_of_region(const Recording& recording, const Region& region, const ReplayOptions& options) {
  const auto* measured = dynamic_cast<const ResampledStream*>(recording.source.get());
  if (measured == nullptr) {
    return "";
  }
  const std::string sentence = lost_photons_sentence(
      options.recording.file, measured->count_photons(region.columns, region.rows), options.t_int_ns * 1e-9);
  return sentence.empty() ? "" : fmt::format(" {}.", sentence);
}

/// How many of a TDC stream's detections a region has; empty for other recordings, and for the whole stream.
std::string read_part(const Recording& recording, const Region& region) {
  const auto* const stream = dynamic_cast<const RecordedStream*>(recording.source.get());
  if (stream == nullptr) {
    return "";
  }
  std::size_t read = 0;
  for (const int column : region.columns) {
    read += stream->column_rows(column, region.rows).detection_count();
  }
  return read == stream->detection_count() ? "" : fmt::format(", {} of them in the pixels read", read);
}

/// The read-outs, and their offset where they were compared with a truth.
nlohmann::ordered_json json_results(const std::vector<ReadoutParameters>& readouts,
                                    const std::vector<TruthComparison>& comparisons) {
  nlohmann::ordered_json results;
  for (std::size_t r = 0; r < readouts.size(); ++r) {
    const auto& read = readouts[r];
    results.push_back({{"readout", readout_name(read.readout)}, {"parameters", read.to_string()}});
    results.back()["offset_m"] = comparisons.empty() ? std::nan("") : comparisons[r].offset_m;
  }
  return results;
}

void run_replay_command(const ReplayOptions& options, RecordingFile file, JsonResult& result) {
  check_run_options(options.run);
  if (options.truth_scale && options.truth_file.empty()) {
    throw InputError("--truth-scale needs --truth");
  }
  std::vector<ReadoutParameters> readouts = options.readout.parameters(options.run.readouts());
  if (!options.run.trace.empty() && readouts.size() != 1) {
    throw InputError("--trace needs exactly one read-out");
  }
  RecordingOptions recording_options = options.recording;
  recording_options.tick_s = options.tick_ps * 1e-12;
  if (options.bin_width_ps) {
    recording_options.bin_width_s = *options.bin_width_ps * 1e-12;
  }
  Resampling& resampling = recording_options.resampling;
  resampling.np = readouts.front().np;
  resampling.slots = readouts.front().slots;
  resampling.integration_time = options.t_int_ns * 1e-9;
  resampling.time_shift = options.shift_ns * 1e-9;
  resampling.photon_budget = options.photons;
  resampling.seed = options.run.seed;
  Recording recording = open_recording(recording_options, std::move(file));
  const Region region{.columns = parse_columns(options.run.columns, recording.source->columns()),
                      .rows = parse_rows(options.run.rows, recording.source->rows())};
  if (options.readout.all()) {
    readouts = without_unfit_engines(*recording.source, std::move(readouts), options.run, region);
  }
  check_engine(*recording.source, readouts, options.run, region);
  if (!options.truth_file.empty()) {
    recording.true_distance = read_truth_map(options.truth_file, options.truth_scale,
                                             recording.source->columns(), recording.source->rows(), region);
  }
  bool judged = has_truth(recording, region);
  if (!judged && (!options.truth_file.empty() || options.offset_mm)) {
    throw InputError(options.truth_file.empty() ? "--offset needs true distances: name a map with --truth"
                                                : "--truth: the pixels read have no true distance");
  }
  std::string losses = lost_of_region(recording, region, options);
  if (judged) {
    losses += drop_unjudged(recording, region, options);
    judged = has_truth(recording, region);
  }
  create_output_folder(options.out);
  std::vector<TruthComparison> comparisons;
  for (const ReadoutParameters& parameters : readouts) {
    const ReadoutRun run =
        run_readout(*recording.source, parameters, options.run, region, options.command_line);
    write_result_csv(
        std::filesystem::path(options.out) / fmt::format("{}.csv", readout_name(parameters.readout)),
        result_records(run.results, region));
    if (judged) {
      comparisons.push_back(compare(recording, parameters, run, region, options));
    }
  }
  const std::string heading = fmt::format(
      "{} ({}{}): {} columns x {} rows, {} acquisitions{}, engine {}{}, seed {}.{}\n", options.recording.file,
      recording.description, read_part(recording, region), region.columns.size(), region.rows.count,
      recording.source->acquisitions(),
      options.photons ? fmt::format(", thinned to {:g} photons per pixel and frame", *options.photons) : "",
      options.run.engine, options.run.verify ? " (every pixel equal to the model)" : "", options.run.seed,
      losses);
  if (comparisons.empty()) {
    fmt::print("{}", heading);
  } else {
    const std::string thinned =
        options.photons ? fmt::format(", {:g} photons per pixel and frame", *options.photons) : "";
    write_comparison(comparisons, options, recording.description + thinned, heading);
  }
  result["heading"] = heading;
  result["readouts"] = json_results(readouts, comparisons);
  result.add_folder(options.out);
  fmt::print("Results are in {}\n", options.out);
}

}  // namespace

void add_replay_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ReplayOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "replay",
      "Reads out recorded data: TDC streams (CSV), histograms (NPY, NPZ, HDF5, MAT, TMF8820, TMF8821, "
      "TMF8828, TMF8829, VL53L8CH), photon times (MAT), time tags (PTU, HT3, Photon-HDF5)");
  command
      ->add_option("file", options->recording.file,
                   "recording; an array of an archive is file.npz:name, file.h5:/group/name or file.mat:name")
      ->required();
  add_recording_options(*command, options->recording, options->bin_width_ps, options->tick_ps);
  command
      ->add_option("-a,--acquisitions", options->recording.acquisitions,
                   "laser pulses per frame (default: CSV: the last one recorded, else 3333)")
      ->check(CLI::Range(std::uint32_t{1}, std::numeric_limits<std::uint32_t>::max()));
  command
      ->add_option("--array-columns", options->recording.columns,
                   "CSV: columns of the sensor (default: up to the last detection)")
      ->check(CLI::Range(1, 65536));
  command->add_option("--array-rows", options->recording.rows, "CSV: rows of the sensor (default: the same)")
      ->check(CLI::Range(1, 65536));
  command->add_option("--photons", options->photons,
                      "measured data: thin to this mean number of photons per pixel and frame");
  command
      ->add_option("--background", options->recording.resampling.background,
                   "measured data: background events to add per acquisition and T_int")
      ->capture_default_str();
  command->add_option("--shift", options->shift_ns, "measured data: ns to add to every time")
      ->check(shift_ns())
      ->capture_default_str();
  command->add_option("--t-int", options->t_int_ns, "T_int in ns; T_res = T_int / 2^NP")
      ->check(duration_ns())
      ->capture_default_str();
  command->add_option(
      "--truth", options->truth_file,
      "true distances: a depth map (PNG of 8 or 16 bits, PFM or NPY) of the recording's or the\n"
      "region's size; errors are then in the summary");
  add_truth_scale_option(*command, options->truth_scale);
  command
      ->add_option("--offset", options->offset_mm,
                   "mm to subtract from every distance: the recording's zero (default: each\n"
                   "read-out's median difference to truth; 299.8 for a stream of preset thesis)")
      ->check(within(-1e8, 1e8, "100000000 mm, 100 km"));
  options->readout.add_to(*command);
  add_run_options(*command, options->run, true);
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  JsonResult::add_to(*command, options->json);
  command->callback([options, command] {
    RecordingFile file = read_recording(options->recording);
    check_recording_options(*command, file.format);
    JsonResult result(options->json, "replay", options->command_line);
    run_replay_command(*options, std::move(file), result);
    result.finish();
  });
}

}  // namespace dtof
