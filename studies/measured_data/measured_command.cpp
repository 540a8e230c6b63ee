// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "command_line/recording_options.hpp"
#include "command_line/shell_words.hpp"
#include "command_line/truth_map.hpp"
#include "common/commands.hpp"
#include "common/readout_variant.hpp"
#include "dtof/core/error.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/recording/recording.hpp"
#include "dtof/report/colour_png.hpp"
#include "dtof/report/table.hpp"
#include "measured_data/measured_report.hpp"
#include "measured_data/measured_scene.hpp"
#include "rtl/run_frame.hpp"
#include "run/readout_run.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {
namespace {

struct MeasuredOptions {
  RecordingOptions recording;
  std::string surfaces_file;
  std::string truth_file;
  std::optional<double> truth_scale;
  double from_tick = 0.0;
  double tick_ps = 8.0;
  std::optional<double> bin_width_ps;
  std::optional<double> return_window_ns;
  double shift_ns = 0.0;
  double t_int_ns = 45.0;
  std::uint32_t acquisitions = 3333;
  std::vector<double> photons = {750.0};
  std::vector<double> background = {0.0};
  std::uint32_t frames = 1;
  ReadoutOptions readout;
  RunSettings run;
  std::string out = "build/measured";
  std::string command_line;

  [[nodiscard]] Resampling resampling() const {
    Resampling resampling;
    resampling.np = readout.value("NP").value_or(SensorModel().np);
    resampling.slots = readout.value("SLOTS").value_or(2);
    resampling.integration_time = t_int_ns * 1e-9;
    resampling.acquisitions = acquisitions;
    resampling.seed = run.seed;
    return resampling;
  }
};

MeasuredScene open_recorded_scene(const MeasuredOptions& options, RecordingFile file) {
  if (options.surfaces_file.empty()) {
    RecordedSceneOptions scene{.recording = options.recording,
                               .shift_s = options.shift_ns * 1e-9,
                               .truth_is_given = !options.truth_file.empty()};
    if (options.return_window_ns) {
      scene.return_window_s = *options.return_window_ns * 1e-9;
    }
    scene.recording.tick_s = options.tick_ps * 1e-12;
    if (options.bin_width_ps) {
      scene.recording.bin_width_s = *options.bin_width_ps * 1e-12;
    }
    return recorded_scene(scene, std::move(file));
  }
  return two_surfaces_scene(
      {.photons = read_photon_times_mat(options.recording.file, options.recording.variable),
       .first = read_mat_matrix(options.surfaces_file, "T_first"),
       .second = read_mat_matrix(options.surfaces_file, "T_second"),
       .tick_s = options.tick_ps * 1e-12,
       .shift_s = options.shift_ns * 1e-9,
       .from_tick = options.from_tick});
}

/// With --truth, that map's distances are the truth, of one surface.
MeasuredScene open_scene(const MeasuredOptions& options, RecordingFile file) {
  if (options.truth_scale && options.truth_file.empty()) {
    throw InputError("--truth-scale needs --truth");
  }
  MeasuredScene scene = open_recorded_scene(options, std::move(file));
  if (!options.truth_file.empty()) {
    scene.true_m = read_truth_map(options.truth_file, options.truth_scale, scene.columns, scene.rows,
                                  Region::whole(scene.columns, scene.rows));
    std::ranges::replace_if(
        scene.true_m, [](double metres) { return std::isnan(metres); }, 0.0);
    scene.other_m.clear();
    scene.truth = {.origin = TruthOrigin::kMap, .map = options.truth_file};
  }
  leave_out_beyond_range(scene, options.t_int_ns * 1e-9, options.recording.file);
  return scene;
}

bool is_compiled(const ReadoutParameters& parameters, const MeasuredScene& scene) {
  try {
    const int rows = is_pool_readout(parameters.readout) ? std::max(scene.rows, kArrayRows) : scene.rows;
    (void)find_rtl_configurations(parameters, rows, scene.columns,
                                  Region::whole(scene.columns, scene.rows).columns);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Truth of `frames` frames above each other.
SceneTruth repeated_truth(const MeasuredScene& scene, std::uint32_t frames) {
  SceneTruth truth{.columns = scene.columns,
                   .rows = scene.rows * static_cast<int>(frames),
                   .distance_m = {},
                   .edge = {},
                   .single = {}};
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    truth.distance_m.insert(truth.distance_m.end(), scene.true_m.begin(), scene.true_m.end());
  }
  truth.edge.resize(truth.distance_m.size());
  truth.single.resize(truth.distance_m.size());
  return truth;
}

class MeasuredStudy {
 public:
  MeasuredStudy(const MeasuredOptions& options, MeasuredScene scene)
      : options_(options),
        scene_(std::move(scene)),
        truth_(repeated_truth(scene_, options.frames)),
        readouts_(options.readout.parameters(kAllReadouts)) {
    for (const ReadoutParameters& readout : readouts_) {
      titles_.push_back(variant_title(readout));
    }
  }

  [[nodiscard]] const MeasuredScene& scene() const { return scene_; }
  [[nodiscard]] const std::vector<std::string>& titles() const { return titles_; }
  [[nodiscard]] int timestamp_bits() const { return readouts_.front().np; }
  [[nodiscard]] const std::vector<double>& offsets_m() const { return offsets_m_; }

  /// The first light's median differences to truth are the read-outs' offsets from then on: host calibration.
  MeasuredLightResult measure(const MeasuredLight& light) {
    MeasuredLightResult result{light, {}};
    const bool calibrates = offsets_m_.empty();
    for (std::size_t r = 0; r < readouts_.size(); ++r) {
      SceneMeasurement measurement = read(light, readouts_[r]);
      if (calibrates) {
        std::vector<double> differences;
        for (std::size_t i = 0; i < truth_.distance_m.size(); ++i) {
          if (truth_.distance_m[i] > 0.0) {
            differences.push_back(measurement.distance_m[i] - truth_.distance_m[i]);
          }
        }
        offsets_m_.push_back(median(std::move(differences)));
      }
      for (double& distance : measurement.distance_m) {
        distance -= offsets_m_[r];
      }
      result.readouts.push_back(judge(std::move(measurement)));
    }
    return result;
  }

  /// One frame through the RTL of what is compiled, each pixel compared with the model.
  [[nodiscard]] ComparedWithRtl verify_rtl(const MeasuredLight& light) const {
    RunSettings run = options_.run;
    run.engine = "rtl";
    run.verify = true;
    ComparedWithRtl compared;
    for (std::size_t r = 0; r < readouts_.size(); ++r) {
      if (!is_compiled(readouts_[r], scene_)) {
        compared.not_compiled.push_back(titles_[r]);
        continue;
      }
      (void)run_readout(*scene_.frame(resampling(light, 0)), readouts_[r], run, whole(),
                        options_.command_line);
      compared.equal.push_back(titles_[r]);
    }
    return compared;
  }

 private:
  [[nodiscard]] Resampling resampling(const MeasuredLight& light, std::uint32_t frame) const {
    Resampling resampling = options_.resampling();
    if (light.photons > 0.0) {
      resampling.photon_budget = light.photons;
    }
    resampling.background = light.background;
    resampling.frame = frame;
    return resampling;
  }

  [[nodiscard]] Region whole() const { return Region::whole(scene_.columns, scene_.rows); }

  [[nodiscard]] SceneMeasurement read(const MeasuredLight& light, const ReadoutParameters& readout) const {
    // No pulse width is subtracted: the recording's zero distance is part of the offset.
    const DepthScale scale(options_.t_int_ns * 1e-9, readout.np, 0.0);
    SceneMeasurement measurement;
    for (std::uint32_t frame = 0; frame < options_.frames; ++frame) {
      const ReadoutRun run = run_readout(*scene_.frame(resampling(light, frame)), readout, options_.run,
                                         whole(), options_.command_line);
      for (const PixelResult& result : run.results) {
        const Measurement pixel = to_measurement(result, readout.fraction_bits);
        measurement.distance_m.push_back(scale.depth(pixel.position));
        measurement.confidence.push_back(pixel.confidence);
      }
    }
    return measurement;
  }

  [[nodiscard]] MeasuredOutcome judge(SceneMeasurement measurement) const {
    MeasuredOutcome outcome{{}, score_scene(truth_, measurement), {}, 0.0, 0.0};
    ErrorStatistics statistics;
    std::vector<double> errors;
    std::size_t off = 0;
    for (std::size_t i = 0; i < truth_.distance_m.size(); ++i) {
      const double truth = truth_.distance_m[i];
      if (truth <= 0.0) {
        continue;
      }
      const double measured = measurement.distance_m[i];
      errors.push_back(std::abs(measured - truth));
      statistics.add(truth, measured);
      const double other = scene_.other_m.empty() ? truth : scene_.other_m[i % scene_.other_m.size()];
      constexpr double kOff = 0.03;
      off += std::abs(measured - truth) > kOff * truth && std::abs(measured - other) > kOff * other ? 1 : 0;
    }
    outcome.errors = statistics.summary();
    outcome.off_both_surfaces = static_cast<double>(off) / static_cast<double>(errors.size());
    outcome.median_error_m = median(std::move(errors));
    outcome.measurement = std::move(measurement);
    return outcome;
  }

  const MeasuredOptions& options_;
  MeasuredScene scene_;
  SceneTruth truth_;
  std::vector<ReadoutParameters> readouts_;
  std::vector<std::string> titles_;
  std::vector<double> offsets_m_;
};

/// First frame of each read-out.
void write_pictures(const std::filesystem::path& folder, const MeasuredScene& scene,
                    const std::vector<std::string>& titles, const MeasuredLightResult& result,
                    const MeasuredOptions& options) {
  const std::size_t pixels = scene.true_m.size();
  const DepthImage empty{scene.columns, scene.rows, {}};
  std::vector<MapPanel> depths = {{empty, "truth", MapKind::kDepth}};
  std::vector<MapPanel> errors;
  depths[0].image.metres.assign(scene.true_m.begin(), scene.true_m.end());
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  for (const double truth : scene.true_m) {
    if (truth > 0.0) {
      nearest = std::min(nearest, truth);
      farthest = std::max(farthest, truth);
    }
  }
  for (std::size_t r = 0; r < titles.size(); ++r) {
    MapPanel depth{empty, titles[r], MapKind::kDepth};
    MapPanel error{empty, titles[r], MapKind::kError};
    for (std::size_t i = 0; i < pixels; ++i) {
      const double measured = result.readouts[r].measurement.distance_m[i];
      depth.image.metres.push_back(static_cast<float>(measured));
      error.image.metres.push_back(scene.true_m[i] > 0.0 ? static_cast<float>(measured - scene.true_m[i])
                                                         : std::numeric_limits<float>::quiet_NaN());
    }
    depths.push_back(std::move(depth));
    errors.push_back(std::move(error));
  }
  constexpr int kPanelWidth = 200;
  const int pixel_size = std::clamp(kPanelWidth / scene.columns, 1, 12);
  const double margin = 0.1 * (farthest > nearest ? farthest - nearest : farthest);
  write_map_picture(folder / "depth.png", depths,
                    {.title = fmt::format("Distance in m: {}, {}", scene.title, result.light.name()),
                     .caption = without_threads(options.command_line),
                     .panels_per_row = 4,
                     .pixel_size = pixel_size,
                     .depth_range = ColourRange{std::max(0.0, nearest - margin), farthest + margin}});
  write_map_picture(folder / "error.png", errors,
                    {.title = fmt::format("Error in m: {}, {}", scene.title, result.light.name()),
                     .caption = without_threads(options.command_line),
                     .panels_per_row = 4,
                     .pixel_size = pixel_size,
                     .largest_error = 0.25});
}

Table summary_table(const MeasuredStudy& study, const std::vector<MeasuredLightResult>& results) {
  const std::vector<std::string>& titles = study.titles();
  const bool two_surfaces = !study.scene().other_m.empty();
  Table csv({"photons", "background", "readout", "pixels", "above_3_percent", "above_10_percent",
             "off_both_surfaces", "median_error_mm", "relative_rmse", "outliers_removed_at_5_percent",
             "offset_mm", "rmse_mm", "bias_mm"});
  for (const MeasuredLightResult& result : results) {
    for (std::size_t r = 0; r < titles.size(); ++r) {
      const MeasuredOutcome& outcome = result.readouts[r];
      const double removed = outcome.score.removed[2];
      csv.add({fmt::format("{:g}", result.light.photons), fmt::format("{:g}", result.light.background),
               titles[r], fmt::format("{}", outcome.score.all.pixels),
               fmt::format("{:.5f}", outcome.score.all.above_3_percent),
               fmt::format("{:.5f}", outcome.score.all.above_10_percent),
               two_surfaces ? fmt::format("{:.5f}", outcome.off_both_surfaces) : "",
               fmt::format("{:.1f}", outcome.median_error_m * 1e3),
               fmt::format("{:.5f}", outcome.score.all.rmse),
               std::isnan(removed) ? "" : fmt::format("{:.4f}", removed),
               fmt::format("{:.1f}", study.offsets_m()[r] * 1e3),
               fmt::format("{:.1f}", outcome.errors.rmse_m * 1e3),
               fmt::format("{:.1f}", outcome.errors.bias_m * 1e3)});
    }
  }
  return csv;
}

void run_measured_command(const MeasuredOptions& options, RecordingFile file) {
  MeasuredStudy study(options, open_scene(options, std::move(file)));
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  std::vector<MeasuredLightResult> results;
  for (const double photons : options.photons) {
    for (const double background : options.background) {
      results.push_back(study.measure({photons, background}));
    }
  }
  const std::vector<std::string>& titles = study.titles();
  const PageData page =
      measured_page(study.scene(), {.readouts = titles,
                                    .lights = results,
                                    .acquisitions = options.acquisitions,
                                    .t_int_ns = options.t_int_ns,
                                    .timestamp_bits = study.timestamp_bits(),
                                    .frames = options.frames,
                                    .seed = options.run.seed,
                                    .compared_with_rtl = study.verify_rtl(results.front().light),
                                    .command_line = options.command_line});
  write_file(folder / "summary.csv", summary_table(study, results).csv());
  write_file(folder / "truth.csv", truth_csv(study.scene()));
  write_page(folder, "summary", "measured", page);
  write_pictures(folder, study.scene(), titles, results.back(), options);
  fmt::print("{}\nTables and maps are in {}\n", page_text("measured", page), options.out);
}

}  // namespace

void add_measured_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<MeasuredOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand("measured",
                                         "Read-outs compared on a recording: histograms, photon times, time "
                                         "tags or logs of sensors, as dtof replay "
                                         "reads them");
  command
      ->add_option(
          "file", options->recording.file,
          "recording; an array of an archive is file.npz:name, file.h5:/group/name or file.mat:name;\n"
          "with --surfaces photon times (MAT)")
      ->required();
  add_recording_options(*command, options->recording, options->bin_width_ps, options->tick_ps);
  command->add_option("--surfaces", options->surfaces_file,
                      "MATLAB file with T_first and T_second, the surfaces' ticks in each pixel");
  command->add_option(
      "--truth", options->truth_file,
      "true distances instead of the recording's own: a depth map (PNG of 8 or 16 bits, PFM or\n"
      "NPY) of the recording's size");
  add_truth_scale_option(*command, options->truth_scale);
  command
      ->add_option("--from-tick", options->from_tick,
                   "photon times: the first tick that counts; earlier times are dropped")
      ->check(not_negative())
      ->capture_default_str();
  command->add_option("--shift", options->shift_ns, "ns to add to every time")->capture_default_str();
  command
      ->add_option("--return-window", options->return_window_ns,
                   "without true distances: a pixel's distance is that of its strongest return, of the\n"
                   "ns that hold the most of all of its photons (default: 2)")
      ->check(above_zero());
  command->add_option("--t-int", options->t_int_ns, "T_int in ns")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("-a,--acquisitions", options->acquisitions, "laser pulses per frame")
      ->capture_default_str();
  command
      ->add_option("--photons", options->photons,
                   "mean photons per pixel and frame, one or more; 0: all photons of the recording")
      ->check(not_negative())
      ->capture_default_str();
  command
      ->add_option("--background", options->background,
                   "background events to add per acquisition, one or more")
      ->check(not_negative())
      ->capture_default_str();
  command->add_option("--frames", options->frames, "frames drawn from the recording")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  options->readout.add_to(*command);
  add_study_options(*command, options->run.seed, options->run.threads, options->out);
  command->callback([options, command] {
    RecordingFile file;
    if (options->surfaces_file.empty()) {
      refuse_without_effect(*command, "--from-tick", "only photon times with --surfaces have a first tick");
      file = read_recording(options->recording);
      refuse_recording_options(*command, file.format);
    } else {
      for (const char* option : {"--format", "--bin-width", "--return-window"}) {
        refuse_without_effect(*command, option,
                              "photon times with --surfaces (MAT) have their own distances");
      }
    }
    if (!options->truth_file.empty()) {
      refuse_without_effect(*command, "--return-window", "--truth has the distances");
    }
    run_measured_command(*options, std::move(file));
  });
}

}  // namespace dtof
