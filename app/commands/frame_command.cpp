// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "command_line/shell_words.hpp"
#include "commands/commands.hpp"
#include "commands/filtered_frame.hpp"
#include "commands/frame_scene.hpp"
#include "commands/json_result.hpp"
#include "commands/optional_output.hpp"
#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/error.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/io/result_csv.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "dtof/recording/stream_csv.hpp"
#include "dtof/report/colour_png.hpp"
#include "dtof/report/ply.hpp"
#include "dtof/report/table.hpp"
#include "run/readout_run.hpp"
#include "run/region.hpp"

namespace dtof {
namespace {

struct FrameOptions {
  ReadoutOptions readout;
  RunSettings run;
  SensorOptions sensor;
  FrameScene scene;
  std::string table = "flat";
  std::optional<double> precision_percent;
  int most_frames = 1000;
  std::uint32_t settle = 0;
  bool host_filter = false;
  std::string out = "build/my_frame";  // build/frame is that of the main job
  std::string record;
  bool json = false;
  std::string command_line;
};

/// A map of the region, in m.
DepthImage region_map(const Region& region, const std::vector<float>& metres) {
  return {static_cast<int>(region.columns.size()), region.rows.count, metres};
}

/// End of the error maps' scale in m, the same for every read-out.
constexpr double kLargestError = 0.25;

/// What the pictures' titles say beside the read-out.
std::string scene_sentence(const SensorModel& sensor, const FrameOptions& options) {
  return fmt::format("{}, {} klux, sensor {}, engine {}", options.scene.name(), options.sensor.klux,
                     sensor.name, options.run.engine);
}

void write_readout_files(const MeasuredFrame& frame, const Region& region, const ColourRange& depth_range,
                         const SensorModel& sensor, const FrameOptions& options) {
  const std::filesystem::path folder(options.out);
  const std::string name(readout_name(frame.parameters.readout));
  const DepthImage depth = region_map(region, frame.maps.depth);
  write_result_csv(folder / (name + ".csv"), result_records(frame.run.results, region));
  const std::filesystem::path millimetres = folder / (name + "_depth_mm.png");
  write_optional(millimetres, depth_png_obstacle(depth), [&] { write_depth_png(millimetres, depth); });
  const std::filesystem::path cloud = folder / (name + ".ply");
  const double degrees = sensor.degrees_per_pixel();
  write_optional(cloud, ply_obstacle(depth.width, depth.height, degrees),
                 [&] { write_ply(cloud, depth, depth_range, degrees); });
  const std::string title(readout_title(frame.parameters.readout));
  const std::string scene = scene_sentence(sensor, options);
  write_map_picture(folder / (name + "_depth.png"), std::vector<MapPanel>{{depth, "", MapKind::kDepth}},
                    {.title = fmt::format("{}, depth in m: {}", title, scene), .depth_range = depth_range});
  write_map_picture(
      folder / (name + "_error.png"),
      std::vector<MapPanel>{{region_map(region, frame.maps.error), "", MapKind::kError}},
      {.title = fmt::format("{}, error in m: {}", title, scene), .largest_error = kLargestError});
}

/// `unfiltered`: each read-out's figures before the host filter; empty without it.
Table summarise(const std::vector<MeasuredFrame>& frames, const std::vector<FrameFigures>& unfiltered,
                const FrameOptions& options) {
  const bool tables = options.table != table_rule_name(TableRule::kNone);
  std::vector<std::string> head = figure_names(tables);
  head.insert(head.begin(), "read-out");
  head.emplace_back("cycles");
  if (options.precision_percent) {
    head.emplace_back("frames");
  }
  Table table(head);
  const auto add = [&](const MeasuredFrame& frame, const FrameFigures& figures, const char* filter) {
    std::vector<std::string> row = figure_values(figures, tables);
    row.insert(row.begin(), fmt::format("{}{}", readout_title(frame.parameters.readout), filter));
    row.push_back(frame.run.cycles == 0 ? "-" : fmt::format("{}", frame.run.cycles));
    if (options.precision_percent) {
      row.push_back(fmt::format("{}{}", frame.frames, frame.precision_reached ? "" : "+"));
    }
    table.add(row);
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!unfiltered.empty()) {
      add(frames[i], unfiltered[i], "");
    }
    add(frames[i], frames[i].maps.figures, unfiltered.empty() ? "" : " with host filter");
  }
  return table;
}

/// What array the cycles are of; empty for the model. Arrays may differ with the read-out.
std::string cycles_sentence(const std::vector<MeasuredFrame>& frames) {
  std::vector<std::string> arrays;
  for (const MeasuredFrame& frame : frames) {
    if (!frame.run.array.empty() && std::ranges::find(arrays, frame.run.array) == arrays.end()) {
      arrays.push_back(frame.run.array);
    }
  }
  if (arrays.empty()) {
    return "";
  }
  const bool one = arrays.size() == 1;
  return fmt::format("Cycles: clocks of a frame in an array of {}{}.\n\n", fmt::join(arrays, ", or "),
                     one ? "" : ", as it is simulated");
}

/// How often each read-out measured the first of several returns; empty if no pixel has another return before
/// its truth.
std::string first_return_sentence(const std::vector<MeasuredFrame>& frames) {
  std::vector<std::string> counts;
  for (const MeasuredFrame& frame : frames) {
    counts.push_back(
        fmt::format("{} {}", readout_title(frame.parameters.readout), frame.maps.figures.at_first_return));
  }
  const std::uint64_t pixels = frames.front().maps.figures.behind_another;
  return pixels == 0 ? ""
                     : fmt::format(
                           "Pixels with a weaker return before the strongest one: {}. Results at this "
                           "first return (within 3 %): {}.\n\n",
                           pixels, fmt::join(counts, ", "));
}

/// What --precision came to; empty without it.
std::string precision_sentence(const std::vector<MeasuredFrame>& frames, const FrameOptions& options) {
  if (!options.precision_percent) {
    return "";
  }
  const auto reached = std::ranges::count(frames, true, &MeasuredFrame::precision_reached);
  const int most = std::ranges::max(frames, {}, &MeasuredFrame::frames).frames;
  return fmt::format(
      "Rmse within {:g} % (95 % interval) for {} of {} read-outs, with up to {} frames; maps and files show "
      "the first frame.\n\n",
      *options.precision_percent, reached, frames.size(), most);
}

/// The photon model; with --precision one that has noise.
Fidelity photon_model(const FrameOptions& options, std::span<const ReadoutParameters> readouts,
                      const PhotonSource& scene, const FrameEngine& engine) {
  const Fidelity fidelity =
      frame_fidelity(options.sensor.fidelity, options.sensor.tolerance, scene, readouts, engine);
  if (options.precision_percent && fidelity == Fidelity::kAnalytic) {
    throw InputError(
        "frame: the analytic photon model has no noise, so --precision has nothing to do; choose exact, fast "
        "or auto");
  }
  return fidelity;
}

/// What --precision asks for; none without it.
std::optional<FramePrecision> frame_precision(const FrameOptions& options) {
  if (!options.precision_percent) {
    return std::nullopt;
  }
  return FramePrecision{.relative = *options.precision_percent / 100.0, .most_frames = options.most_frames};
}

void write_overview(const std::vector<MeasuredFrame>& frames, const Region& region, const DepthImage& truth,
                    const ColourRange& depth_range, const SensorModel& sensor, const FrameOptions& options) {
  std::vector<MapPanel> depths = {{truth, "true depth", MapKind::kDepth}};
  std::vector<MapPanel> errors;
  for (const MeasuredFrame& frame : frames) {
    const std::string title(readout_title(frame.parameters.readout));
    depths.push_back({region_map(region, frame.maps.depth), title, MapKind::kDepth});
    errors.push_back({region_map(region, frame.maps.error), title, MapKind::kError});
  }
  const std::filesystem::path folder(options.out);
  const std::string title = scene_sentence(sensor, options);
  const int pixel_size = truth.width >= 100 ? 1 : 0;
  write_map_picture(folder / "overview.png", depths,
                    {.title = "Depth in m: " + title,
                     .caption = without_threads(options.command_line),
                     .panels_per_row = 4,
                     .pixel_size = pixel_size,
                     .depth_range = depth_range});
  write_map_picture(folder / "errors.png", errors,
                    {.title = "Error in m: " + title,
                     .caption = without_threads(options.command_line),
                     .panels_per_row = 4,
                     .pixel_size = pixel_size,
                     .largest_error = kLargestError});
}

/// Each read-out's figures as numbers, of all frames taken.
nlohmann::ordered_json json_readouts(const std::vector<MeasuredFrame>& frames,
                                     const std::vector<FrameFigures>& unfiltered) {
  auto readouts = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const MeasuredFrame& frame = frames[i];
    nlohmann::ordered_json readout = {{"readout", readout_name(frame.parameters.readout)},
                                      {"title", readout_title(frame.parameters.readout)},
                                      {"parameters", frame.parameters.to_string()},
                                      {"frames", frame.frames},
                                      {"precision_reached", frame.precision_reached},
                                      {"cycles", nullptr},
                                      {"pixels", frame.maps.figures.errors.count()}};
    if (frame.run.cycles > 0) {  // the models have none
      readout["cycles"] = frame.run.cycles;
    }
    if (frame.maps.figures.errors.count() > 0) {
      const ErrorSummary summary = frame.maps.figures.errors.summary();
      readout["rmse_m"] = summary.rmse_m;
      readout["bias_m"] = summary.bias_m;
      readout["share_above_3_percent"] = summary.share_above_3_percent;
      readout["share_above_10_percent"] = summary.share_above_10_percent;
      readout["without_distance"] = frame.maps.figures.without_distance;
      if (!unfiltered.empty()) {
        const ErrorSummary before = unfiltered[i].errors.summary();
        readout["before_host_filter"] = {{"rmse_m", before.rmse_m},
                                         {"bias_m", before.bias_m},
                                         {"share_above_3_percent", before.share_above_3_percent},
                                         {"share_above_10_percent", before.share_above_10_percent},
                                         {"without_distance", unfiltered[i].without_distance}};
      }
      if (frame.maps.figures.behind_another > 0) {
        readout["behind_another_return"] = frame.maps.figures.behind_another;
        readout["at_first_return"] = frame.maps.figures.at_first_return;
      }
    }
    readouts.push_back(std::move(readout));
  }
  return readouts;
}

void describe(const std::string& heading, const std::vector<MeasuredFrame>& frames,
              const std::vector<FrameFigures>& unfiltered, const std::string& out, JsonResult& result) {
  result["heading"] = heading;
  result["readouts"] = json_readouts(frames, unfiltered);
  result.add_folder(out);
}

/// The sensor with the acquisitions that read-outs see.
SensorModel settled_sensor(const FrameOptions& options) {
  SensorModel sensor = options.sensor.with_options();
  if (options.settle >= sensor.acquisitions) {
    throw InputError(fmt::format("--settle: of {} acquisitions {} cannot be dropped", sensor.acquisitions,
                                 options.settle));
  }
  sensor.acquisitions -= options.settle;
  return sensor;
}

/// "3333 acquisitions of which the first 733 are dropped"
std::string acquisitions_text(const SensorModel& sensor, const FrameOptions& options) {
  return fmt::format(
      "{} acquisitions{}", sensor.acquisitions,
      options.settle > 0 ? fmt::format(" of which the first {} are dropped", options.settle) : "");
}

/// Times change from run to run and stay out of the files.
std::string times_text(TableRule rule, double table_seconds, double read_seconds) {
  return rule == TableRule::kNone
             ? fmt::format("Read out in {:.1f} s", read_seconds)
             : fmt::format("Look-up table in {:.1f} s, read out in {:.1f} s", table_seconds, read_seconds);
}

/// A frame of each read-out, after the host filter if it is asked for; `unfiltered` then gets the figures
/// before it.
std::vector<MeasuredFrame> measure_frames(const FramePipeline& pipeline,
                                          const std::vector<TabledReadout>& readouts,
                                          const FrameOptions& options,
                                          std::vector<FrameFigures>& unfiltered) {
  std::vector<MeasuredFrame> frames;
  for (const TabledReadout& readout : readouts) {
    frames.push_back(pipeline.measure(readout, frame_precision(options)));
    if (options.host_filter) {
      unfiltered.push_back(frames.back().maps.figures);
      frames.back().maps = filtered_maps(frames.back(), readout, pipeline);
    }
  }
  return frames;
}

/// Names of the files that the command writes into its folder.
std::vector<std::string> output_names(std::span<const ReadoutParameters> readouts) {
  std::vector<std::string> names = {"overview.png", "errors.png", "summary.csv", "summary.md"};
  for (const ReadoutParameters& parameters : readouts) {
    for (const char* end : {".csv", "_depth_mm.png", ".ply", "_depth.png", "_error.png"}) {
      names.push_back(fmt::format("{}{}", readout_name(parameters.readout), end));
    }
  }
  return names;
}

/// True if both are one file, whether it exists or not.
bool same_file(const std::filesystem::path& one, const std::filesystem::path& other) {
  std::error_code error;
  const auto place = [&](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
  };
  const std::filesystem::path first = place(one);  // empty if it cannot be resolved
  return (!first.empty() && first == place(other)) || std::filesystem::equivalent(one, other, error);
}

/// Throws InputError if a recording would be lost in a result.
void check_record(const FrameOptions& options, std::span<const ReadoutParameters> readouts) {
  if (options.record.empty()) {
    return;
  }
  for (const std::string& name : output_names(readouts)) {
    if (same_file(options.record, std::filesystem::path(options.out) / name)) {
      throw InputError(
          fmt::format("--record: {} is a result of the command; choose another file", options.record));
    }
  }
  if (!options.run.trace.empty() && same_file(options.record, options.run.trace)) {
    throw InputError(fmt::format("--record and --trace are one file, {}", options.record));
  }
}

/// Throws InputError for options of which each excludes the other.
void check_together(const FrameOptions& options, std::size_t readouts) {
  if (options.host_filter && options.precision_percent) {
    throw InputError("--host-filter works on one frame, --precision takes many: choose one");
  }
  if (!options.run.trace.empty() && readouts != 1) {
    throw InputError("--trace needs exactly one read-out");
  }
  if (!options.run.trace.empty() && options.precision_percent) {
    throw InputError("--trace shows one frame, --precision takes many: choose one");
  }
}

void run_frame_command(const FrameOptions& options, JsonResult& result) {
  check_run_options(options.run);
  std::vector<ReadoutParameters> readouts =
      options.readout.parameters(options.run.readouts(), settled_sensor(options));
  check_together(options, readouts.size());
  check_record(options, readouts);
  const SensorModel sensor = options.sensor.model(readouts.front().np, readouts.front().slots);
  options.scene.check_distances(sensor);
  check_frame_memory(sensor, options.scene.array_rows.value_or(sensor.rows));
  OwnMap made = options.scene.targets(sensor);
  const PhotonSource scene(sensor, std::move(made.targets), options.sensor.klux, options.run.seed);
  const ProgramEngine engine(options.run, options.command_line);
  const Fidelity fidelity = photon_model(options, readouts, scene, engine);
  const Region region{.columns = parse_columns(options.run.columns, scene.columns()),
                      .rows = parse_rows(options.run.rows, scene.rows())};
  if (options.readout.all()) {
    readouts = without_unfit_engines(scene, std::move(readouts), options.run, region);
  }
  check_engine(scene, readouts, options.run, region);
  check_filtered_region(region, options.host_filter);
  const FramePipeline pipeline(scene, engine,
                               {.region = region,
                                .fidelity = fidelity,
                                .seed = options.run.seed,
                                .threads = options.run.threads,
                                .keep_photons = readouts.size() > 1 || options.run.verify,
                                .settle = options.settle});
  const FrameTruth& judged = pipeline.truth();
  if (options.precision_percent && !judged.any_judged()) {
    throw InputError("--precision: no pixel of the scene has a distance to be wrong about");
  }
  const DepthImage truth = region_map(region, judged.metres);
  const TableRule rule = parse_table_rule(options.table);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<TabledReadout> tabled = pipeline.tables(readouts, rule);
  const double table_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  create_output_folder(options.out);
  const ColourRange range = depth_range(std::vector<MapPanel>{{truth, "", MapKind::kDepth}});
  if (!options.record.empty()) {
    write_stream_csv(options.record, *make_source(fidelity, scene));
  }
  std::vector<FrameFigures> unfiltered;
  const std::vector<MeasuredFrame> frames = measure_frames(pipeline, tabled, options, unfiltered);
  for (const MeasuredFrame& frame : frames) {
    write_readout_files(frame, region, range, sensor, options);
  }
  write_overview(frames, region, truth, range, sensor, options);
  double seconds = 0.0;
  for (const MeasuredFrame& frame : frames) {
    seconds += frame.run.seconds;
  }
  const Table table = summarise(frames, unfiltered, options);
  const std::string returns = first_return_sentence(frames) + precision_sentence(frames, options);
  const std::string heading = fmt::format(
      "Scene {}: {} x {} pixels, {} klux, sensor {}, {}, {} photons, engine {}{}, seed "
      "{}.{}{}{}\n",
      options.scene.name(), truth.width, truth.height, options.sensor.klux, sensor.name,
      acquisitions_text(sensor, options), fidelity_name(fidelity), options.run.engine,
      options.run.verify ? " (every pixel equal to the model)" : "", options.run.seed,
      judged.sentences(sensor), made.description.empty() ? "" : "\n", made.description);
  const std::string body =
      fmt::format("{}\n{}\n{}{}\n\n{}", heading, table.markdown(), cycles_sentence(frames),
                  table_sentence(rule, sensor, options.run.seed), returns);
  write_file(std::filesystem::path(options.out) / "summary.csv", table.csv());
  write_file(std::filesystem::path(options.out) / "summary.md",
             fmt::format("{}Command: `{}`\n", body, options.command_line));
  describe(heading, frames, unfiltered, options.out, result);
  fmt::print("{}{}. Depth maps, error maps, point clouds and CSV are in {}\n", body,
             times_text(rule, table_seconds, seconds), options.out);
}

}  // namespace

void add_frame_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<FrameOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "frame", "One frame of a scene: photons, TDC stream, read-out, depth map with errors");
  options->scene.add_to(*command);
  command
      ->add_option("--table", options->table,
                   "host look-up table: flat (each read-out's own, fitted on flat targets of the sensor's\n"
                   "reflectivity from other photons, as `dtof-study scenes` does) or none (Eq. 3.11 alone)")
      ->check(CLI::IsMember({"none", "flat"}))
      ->capture_default_str();
  command
      ->add_option("--precision", options->precision_percent,
                   "more frames of the scene, until the 95 % interval of the rmse is within this many per "
                   "cent of its value")
      ->check(above_zero());
  command
      ->add_option(
          "--settle", options->settle,
          "acquisitions at the frame's start that are dropped, as the register SETTLE does: the laser's\n"
          "start, where a sensor file has one; read-outs receive as many fewer")
      ->capture_default_str();
  command->add_flag(
      "--host-filter", options->host_filter,
      "filter each depth map as a host does, with the same constants for every read-out: maps,\n"
      "point clouds and errors are those after it; the table also has those before it");
  command->add_option("--max-frames", options->most_frames, "where --precision gives up")
      ->check(CLI::Range(4, 1'000'000))
      ->capture_default_str();
  options->sensor.add_to(*command);
  options->readout.add_to(*command);
  add_run_options(*command, options->run, true);
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->add_option("--record", options->record,
                      "also write the TDC stream of the whole array as CSV, for `dtof replay`");
  JsonResult::add_to(*command, options->json);
  command->callback([options, command] {
    options->scene.check(*command);
    if (!options->precision_percent) {
      refuse_without_effect(*command, "--max-frames", "it limits the frames of --precision");
    }
    options->sensor.refuse_options_without_effect(*command);
    // A recording must give the same results when it is replayed.
    options->run.streams_only = !options->record.empty();
    JsonResult result(options->json, "frame", options->command_line);
    run_frame_command(*options, result);
    result.finish();
  });
}

}  // namespace dtof
