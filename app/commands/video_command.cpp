// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "command_line/shell_words.hpp"
#include "commands/commands.hpp"
#include "commands/json_result.hpp"
#include "commands/optional_output.hpp"
#include "dtof/core/error.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/report/colour_png.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "video/video_reader.hpp"

namespace dtof {
namespace {

struct VideoOptions {
  ReadoutOptions readout;
  SensorOptions sensor;
  std::vector<std::string> scenes = {"room"};
  std::vector<std::string> motions = {"pan"};
  int frames = 16;
  double speed = 2.0;
  std::optional<int> columns;
  std::optional<int> rows;
  std::uint64_t seed = 1;
  int seeds = 1;
  int threads = 0;
  std::string out = "build/video";
  bool json = false;
  std::string command_line;
};

/// One video, read out with each seed: other photons, and other shapes where the scene has random ones.
struct Video {
  Sequence sequence;                                          ///< of the first seed
  std::vector<std::vector<std::vector<ErrorShares>>> shares;  ///< seed, frame, estimator

  [[nodiscard]] std::string name() const {
    return fmt::format("{}_{}", scene_name(sequence.scene), motion_name(sequence.motion));
  }
  /// For titles: "room, pan, 14 klux".
  [[nodiscard]] std::string description() const {
    return fmt::format(
        "{}, {}, {}", scene_name(sequence.scene), motion_name(sequence.motion),
        sequence.motion == Motion::kLight ? "2 to 50 klux" : fmt::format("{:g} klux", sequence.klux));
  }
  /// Error shares of the frames from `first` to before `end`, for each seed.
  [[nodiscard]] std::vector<ErrorShares> of(std::size_t estimator, int first, int end) const {
    std::vector<ErrorShares> seeds;
    for (const auto& of_seed : shares) {
      std::vector<ErrorShares> frames;
      for (int frame = first; frame < end; ++frame) {
        frames.push_back(of_seed[static_cast<std::size_t>(frame)][estimator]);
      }
      seeds.push_back(pooled(frames));
    }
    return seeds;
  }
};

/// How much a share changes, in per cent, with its 95 % interval where there are several seeds: from the
/// spread of the differences, for both see the same photons.
std::string change(std::span<const ErrorShares> before, std::span<const ErrorShares> after,
                   double ErrorShares::*share) {
  const double whole = pooled(before).*share;
  if (whole <= 0.0) {
    return "-";
  }
  std::string text = fmt::format("{:+.1f}", 100.0 * (pooled(after).*share / whole - 1.0));
  if (before.size() > 1) {
    std::vector<double> differences;
    for (std::size_t seed = 0; seed < before.size(); ++seed) {
      differences.push_back(after[seed].*share - before[seed].*share);
    }
    const Interval interval = estimate_mean(differences).interval;
    text += fmt::format(" +-{:.1f}", 100.0 * 0.5 * (interval.high - interval.low) / whole);
  }
  return text + " %";
}

/// Every estimator's shares over a video's frames behind the first, which has no frame before it.
Table overview(const std::vector<Video>& videos, const std::vector<std::string>& estimators) {
  std::vector<std::string> header = {"scene", "motion"};
  header.insert(header.end(), estimators.begin(), estimators.end());
  Table table(std::move(header));
  for (const Video& video : videos) {
    std::vector<std::string> row = {std::string(scene_name(video.sequence.scene)),
                                    std::string(motion_name(video.sequence.motion))};
    for (std::size_t e = 0; e < estimators.size(); ++e) {
      const ErrorShares shares = pooled(video.of(e, 1, video.sequence.frames));
      row.push_back(
          fmt::format("{:.2f} / {:.2f}", 100.0 * shares.above_3_percent, 100.0 * shares.above_10_percent));
    }
    table.add(std::move(row));
  }
  return table;
}

/// Frames of a video that are judged together: from `first` to before `end`.
struct Span {
  std::string name;
  int first;
  int end;
};

/// What the prior is about: the frames behind the first, of a cut its frame and those after it.
std::vector<Span> judged_spans(const Sequence& sequence) {
  const int frames = sequence.frames;
  if (sequence.motion != Motion::kCut) {
    return {{fmt::format("2 to {}", frames), 1, frames}};
  }
  const int cut = cut_frame(sequence);
  std::vector<Span> spans = {{"that of the cut", cut, cut + 1}};
  if (cut + 1 < frames) {
    spans.push_back({"after it", cut + 1, frames});
  }
  return spans;
}

/// What the prior changes, for each video, and for each motion over all scenes that have it.
Table prior_table(const std::vector<Video>& videos, std::size_t without, std::size_t with) {
  Table table({"scene", "motion", "frames", "above 3 %", "with prior", "change", "above 10 %", "with prior",
               "change"});
  const auto add = [&](const std::string& scene, Motion motion, const std::string& frames,
                       std::span<const ErrorShares> a, std::span<const ErrorShares> b) {
    std::vector<std::string> row = {scene, std::string(motion_name(motion)), frames};
    for (const auto share : {&ErrorShares::above_3_percent, &ErrorShares::above_10_percent}) {
      row.push_back(fmt::format("{:.3f}", 100.0 * (pooled(a).*share)));
      row.push_back(fmt::format("{:.3f}", 100.0 * (pooled(b).*share)));
      row.push_back(change(a, b, share));
    }
    table.add(std::move(row));
  };
  std::vector<Motion> motions;
  for (const Video& video : videos) {
    const Motion motion = video.sequence.motion;
    for (const Span& span : judged_spans(video.sequence)) {
      add(std::string(scene_name(video.sequence.scene)), motion, span.name,
          video.of(without, span.first, span.end), video.of(with, span.first, span.end));
    }
    if (std::ranges::find(motions, motion) == motions.end()) {
      motions.push_back(motion);
    }
  }
  for (const Motion motion : motions) {
    std::vector<const Video*> those;
    for (const Video& video : videos) {
      if (video.sequence.motion == motion) {
        those.push_back(&video);
      }
    }
    if (those.size() < 2) {
      continue;
    }
    for (const Span& span : judged_spans(those.front()->sequence)) {
      const auto together = [&](std::size_t estimator) {
        std::vector<ErrorShares> seeds(those.front()->shares.size());
        for (std::size_t seed = 0; seed < seeds.size(); ++seed) {
          std::vector<ErrorShares> scenes;
          for (const Video* video : those) {
            scenes.push_back(video->of(estimator, span.first, span.end)[seed]);
          }
          seeds[seed] = pooled(scenes);
        }
        return seeds;
      };
      add("all", motion, span.name, together(without), together(with));
    }
  }
  return table;
}

Table frames_csv(const std::vector<Video>& videos, const std::vector<std::string>& estimators) {
  Table table({"scene", "motion", "frame", "klux", "estimator", "pixels", "above_3_percent",
               "above_10_percent", "relative_rmse"});
  for (const Video& video : videos) {
    for (int frame = 0; frame < video.sequence.frames; ++frame) {
      const double klux = sequence_frame(video.sequence, frame).klux;
      for (std::size_t e = 0; e < estimators.size(); ++e) {
        const ErrorShares shares = pooled(video.of(e, frame, frame + 1));
        table.add({std::string(scene_name(video.sequence.scene)),
                   std::string(motion_name(video.sequence.motion)), fmt::format("{}", frame + 1),
                   fmt::format("{:.4g}", klux), estimators[e], fmt::format("{}", shares.pixels),
                   fmt::format("{:.6f}", shares.above_3_percent),
                   fmt::format("{:.6f}", shares.above_10_percent), fmt::format("{:.6f}", shares.rmse)});
      }
    }
  }
  return table;
}

void write_picture(const std::filesystem::path& path, const Video& video,
                   const std::vector<std::string>& estimators, const std::string& sensor,
                   const std::string& obstacle) {
  std::vector<PlotSeries> series;
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    PlotSeries line{estimators[e], {}, {}};
    for (int frame = 0; frame < video.sequence.frames; ++frame) {
      line.x.push_back(frame + 1);
      line.y.push_back(100.0 * pooled(video.of(e, frame, frame + 1)).above_3_percent);
    }
    series.push_back(std::move(line));
  }
  write_optional(path, obstacle, [&] {
    write_plot(
        path, series,
        {.title = fmt::format("Pixels above 3 % in % per frame: {}, sensor {}", video.description(), sensor),
         .x_label = "frame",
         .y_label = "above 3 %, %",
         .logarithmic_y = true});
  });
}

/// Frames whose depth maps are drawn: the first, the middle and the last.
class DepthSheet {
 public:
  DepthSheet(int frames, const std::vector<std::string>& estimators)
      : shown_{0, frames / 2, frames - 1}, estimators_(estimators) {
    const auto repeated = std::ranges::unique(shown_);
    shown_.erase(repeated.begin(), repeated.end());
    panels_.resize((estimators.size() + 1) * shown_.size());
  }

  void add(int frame, const VideoFrame& seen) {
    for (std::size_t place = 0; place < shown_.size(); ++place) {
      if (shown_[place] == frame) {
        add_panel(place, 0, "true depth", frame, seen, [&](int column, int row) {
          const PixelTarget& target = seen.targets.at(column, row);
          return target.returns_signal() ? target.depth_m : 0.0;
        });
        for (std::size_t e = 0; e < estimators_.size(); ++e) {
          add_panel(place, e + 1, estimators_[e], frame, seen, [&](int column, int row) {
            return seen.distance_m[e][static_cast<std::size_t>(row) *
                                          static_cast<std::size_t>(seen.targets.columns()) +
                                      static_cast<std::size_t>(column)];
          });
        }
      }
    }
  }

  void write(const std::filesystem::path& path, const std::string& title, const std::string& caption) const {
    const auto truth = std::span(panels_).first(shown_.size());
    write_map_picture(path, panels_,
                      {.title = title,
                       .caption = caption,
                       .panels_per_row = static_cast<int>(shown_.size()),
                       .pixel_size = panels_.front().image.width >= 100 ? 1 : 0,
                       .depth_range = depth_range(truth)});
  }

 private:
  template <typename Depth>
  void add_panel(std::size_t place, std::size_t line, const std::string& name, int frame,
                 const VideoFrame& seen, Depth depth) {
    MapPanel& panel = panels_[line * shown_.size() + place];
    panel.label = fmt::format("{}, frame {}", name, frame + 1);
    panel.image = {seen.targets.columns(), seen.targets.rows(), {}};
    for (int row = 0; row < panel.image.height; ++row) {
      for (int column = 0; column < panel.image.width; ++column) {
        panel.image.metres.push_back(static_cast<float>(depth(column, row)));
      }
    }
  }

  std::vector<int> shown_;
  std::vector<MapPanel> panels_;
  const std::vector<std::string>& estimators_;
};

/// The asked scenes with the asked motions, without the pairs that do not exist.
std::vector<Video> asked_videos(const VideoOptions& options, const SensorModel& sensor) {
  std::vector<Video> videos;
  for (const std::string& scene : options.scenes) {
    for (const std::string& motion : options.motions) {
      Sequence sequence;
      sequence.scene = parse_scene(scene);
      sequence.motion = parse_motion(motion);
      sequence.frames = options.frames;
      sequence.parameters.columns = options.columns.value_or(sensor.columns);
      sequence.parameters.rows = options.rows.value_or(sensor.rows);
      sequence.parameters.reflectivity = sensor.default_reflectivity;
      sequence.parameters.seed = options.seed;
      sequence.speed = options.speed;
      sequence.klux = options.sensor.klux;
      if (has_motion(sequence.scene, sequence.motion)) {
        // Errors of the input are found before hours of work.
        require_reachable(sequence_frame(sequence, 0).targets, sensor, "--scene " + scene);
        videos.push_back({sequence, {}});
      }
    }
  }
  if (videos.empty()) {
    throw InputError(fmt::format("video: roll and object are motions of the room, not of {}",
                                 fmt::join(options.scenes, ", ")));
  }
  return videos;
}

/// Reads each video with each reader, and writes the pictures of each video.
void read_videos(std::vector<Video>& videos, const std::vector<VideoReader>& readers,
                 const VideoOptions& options, const std::string& sensor, const std::string& plots_obstacle) {
  const std::filesystem::path folder(options.out);
  const std::vector<std::string>& estimators = readers.front().estimators();
  Progress progress("frames", videos.size() * readers.size() * static_cast<std::size_t>(options.frames));
  for (Video& video : videos) {
    DepthSheet sheet(options.frames, estimators);
    for (const VideoReader& with_seed : readers) {
      Sequence sequence = video.sequence;
      sequence.parameters.seed += video.shares.size();
      const bool first = video.shares.empty();
      video.shares.push_back(with_seed.read(sequence, &progress, [&](int frame, const VideoFrame& seen) {
        if (first) {
          sheet.add(frame, seen);
        }
      }));
    }
    write_picture(folder / fmt::format("{}.svg", video.name()), video, estimators, sensor, plots_obstacle);
    sheet.write(folder / fmt::format("{}_depth.png", video.name()),
                fmt::format("Depth in m: {}, sensor {}", video.description(), sensor),
                without_threads(options.command_line));
  }
}

/// "seed 1" or "seeds 1 to 4".
std::string seeds_text(const VideoOptions& options) {
  return options.seeds == 1 ? fmt::format("seed {}", options.seed)
                            : fmt::format("seeds {} to {}", options.seed,
                                          options.seed + static_cast<std::uint64_t>(options.seeds) - 1);
}

/// The sections with tables: for the page and for the standard output.
std::string video_tables(const std::vector<Video>& videos, const VideoReader& reader) {
  std::string tables =
      fmt::format("## Frames behind the first: above 3 % / above 10 %, per cent of pixels\n\n{}",
                  overview(videos, reader.estimators()).markdown());
  if (const std::optional<std::size_t> without = reader.without_prior()) {
    tables += fmt::format("\n## What the prior changes\n\n{}",
                          prior_table(videos, *without, reader.estimators().size() - 1).markdown());
  }
  return tables;
}

/// The page. `pictures`: the videos whose plots the page shows.
std::string video_page(const VideoOptions& options, const SensorModel& sensor, bool with_prior,
                       const std::string& tables, std::span<const Video> pictures) {
  std::string report = fmt::format(
      "# Videos\n\nEvery frame has photons of its own; {} frames, sensor {}, {:g} klux unless the light "
      "changes, {}. Each read-out has a look-up table fitted at {:g} klux and reads each frame on its "
      "own",
      options.frames, sensor.name, options.sensor.klux, seeds_text(options), options.sensor.klux);
  if (with_prior) {
    report +=
        "; with the prior poolPointer begins a frame from the candidates that were used in the last one "
        "(`docs/reference/poolpointer.md`)";
  }
  if (options.seeds > 1) {
    report +=
        ". Seeds differ in photons and random shapes; +- is half of a change's 95 % interval, from their "
        "spread";
  }
  report += fmt::format(". Pixels beyond {} are not judged", range_phrase(sensor));
  report += fmt::format(".\n\nMotions, {:g} columns, degrees or centimetres per frame:\n\n", options.speed);
  for (const std::string& motion : options.motions) {
    report += fmt::format("* {}: {}.\n", motion, motion_summary(parse_motion(motion)));
  }
  report += fmt::format("\n{}\nEvery frame: [video.csv](video.csv).\n", tables);
  for (const Video& video : pictures) {
    report += fmt::format("\n![{} {}]({}.svg)\n", scene_name(video.sequence.scene),
                          motion_name(video.sequence.motion), video.name());
  }
  return report + fmt::format("\nCommand: `{}`\n", options.command_line);
}

void run_video_command(const VideoOptions& options, JsonResult& result) {
  const std::vector<ReadoutParameters> readouts =
      options.readout.parameters(kAllReadouts, options.sensor.with_options());
  const SensorModel sensor = options.sensor.model(readouts.front().np, readouts.front().slots);
  std::vector<Video> videos = asked_videos(options, sensor);
  std::vector<VideoReader> readers;
  for (int number = 0; number < options.seeds; ++number) {
    readers.emplace_back(sensor, readouts, options.sensor.klux,
                         options.seed + static_cast<std::uint64_t>(number), options.threads);
  }
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  const std::string plots_obstacle = plot_obstacle();
  read_videos(videos, readers, options, sensor.name, plots_obstacle);
  const VideoReader& reader = readers.front();
  const std::string tables = video_tables(videos, reader);
  const std::span<const Video> pictures =
      plots_obstacle.empty() ? std::span<const Video>(videos) : std::span<const Video>();
  const Table every_frame = frames_csv(videos, reader.estimators());
  write_file(folder / "video.csv", every_frame.csv());
  write_file(folder / "video.md",
             video_page(options, sensor, reader.without_prior().has_value(), tables, pictures));
  result["frames"] = json_rows(every_frame);
  result.add_folder(folder);
  fmt::print("{}\nWith {}. Written to {}\n", tables, seeds_text(options), (folder / "video.md").string());
}

}  // namespace

void add_video_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<VideoOptions>();
  options->command_line = command_line;
  options->readout.readouts = "hispointer,coarsehistogram,poolpointer";
  CLI::App* command = app.add_subcommand("video",
                                         "Read videos out with the models: accuracy from frame to frame, and "
                                         "what the last frame tells the next");
  command->add_option("--scene", options->scenes, "scenes of `dtof list`, one or more")
      ->capture_default_str();
  command
      ->add_option("--motion", options->motions,
                   "still, pan, roll, object, cut or light, one or more; roll and object are the room's")
      ->capture_default_str();
  command->add_option("--frames", options->frames, "frames of each video")
      ->check(CLI::Range(2, 10'000))
      ->capture_default_str();
  command
      ->add_option("--seeds", options->seeds,
                   "seeds, from the first one up; with several, changes have intervals")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--speed", options->speed, "columns, degrees or centimetres per frame")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--array-columns", options->columns, "columns of the array (default: the sensor's)")
      ->check(CLI::Range(1, 4096));
  command->add_option("--array-rows", options->rows, "rows of the array (default: the sensor's)")
      ->check(CLI::Range(1, 4096));
  options->sensor.add_to(*command);
  options->readout.add_to(*command);
  add_study_options(*command, options->seed, options->threads, options->out);
  JsonResult::add_to(*command, options->json);
  command->callback([options, command] {
    for (const char* option : {"--fidelity", "--tolerance"}) {
      refuse_without_effect(*command, option, "videos are drawn with exact photons");
    }
    options->sensor.refuse_options_without_effect(*command);
    JsonResult result(options->json, "video", options->command_line);
    run_video_command(*options, result);
    result.finish();
  });
}

}  // namespace dtof
