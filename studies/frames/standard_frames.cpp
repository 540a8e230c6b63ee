// SPDX-License-Identifier: Apache-2.0
#include "frames/standard_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "run/readout_run.hpp"
#include "run/region.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {
namespace {

constexpr double kDroppedTenth = 0.1;

TargetMap targets_of(const StandardFramesSettings& settings, const SensorModel& sensor) {
  SceneParameters parameters;
  parameters.columns = sensor.columns;
  parameters.rows = sensor.rows;
  parameters.reflectivity = sensor.default_reflectivity;
  return make_scene(settings.scene, parameters);
}

std::vector<ReadoutParameters> parameters_of(const StandardFramesSettings& settings,
                                             const SensorModel& sensor) {
  std::vector<ReadoutParameters> readouts;
  for (const Readout readout : settings.readouts) {
    readouts.push_back(default_parameters(readout, sensor));
  }
  return readouts;
}

/// What frames have of one read-out, before their mean is taken.
struct Figures {
  std::vector<ErrorShares> shares;
  std::vector<double> found;
};

StandardFrame figures(const SensorModel& sensor, Readout readout, const Figures& of_frames) {
  std::vector<double> above_3_percent;
  std::vector<double> above_10_percent;
  for (const ErrorShares& shares : of_frames.shares) {
    above_3_percent.push_back(shares.above_3_percent);
    above_10_percent.push_back(shares.above_10_percent);
  }
  const std::uint64_t pixels = of_frames.shares.front().pixels;
  const double found = of_frames.found.empty()
                           ? std::numeric_limits<double>::quiet_NaN()
                           : std::accumulate(of_frames.found.begin(), of_frames.found.end(), 0.0) /
                                 static_cast<double>(of_frames.found.size());
  return {.sensor = sensor.name,
          .acquisitions = sensor.acquisitions,
          .readout = readout,
          .pixels = pixels * of_frames.shares.size(),
          .above_3_percent = estimate_share_of_frames(above_3_percent, pixels),
          .above_10_percent = estimate_share_of_frames(above_10_percent, pixels),
          .rmse = pooled(of_frames.shares).rmse,
          .found_by_confidence = found};
}

std::string per_cent(const Estimate& share) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", 100.0 * share.value, 100.0 * share.interval.low,
                     100.0 * share.interval.high);
}

/// Read-outs down, sensors across.
template <typename Cell>
Table matrix(const StandardFramesSettings& settings, const std::vector<StandardFrame>& frames, Cell cell) {
  std::vector<std::string> header = {"read-out"};
  for (const SensorModel& sensor : settings.sensors) {
    header.push_back(sensor.name);
  }
  Table table(std::move(header));
  for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
    std::vector<std::string> row = {std::string(readout_title(settings.readouts[r]))};
    for (std::size_t s = 0; s < settings.sensors.size(); ++s) {
      row.push_back(cell(frames[s * settings.readouts.size() + r]));
    }
    table.add(std::move(row));
  }
  return table;
}

std::vector<PageData> sensors_data(const StandardFramesSettings& settings) {
  std::vector<PageData> sensors;
  for (const SensorModel& sensor : settings.sensors) {
    sensors.push_back(PageData()
                          .set("sensor", "{}", sensor.name)
                          .set("acquisitions", "{}", sensor.acquisitions)
                          .set("signal_events", "{:.3g}", sensor.signal_events(1.0, 1.0))
                          .flag("last", &sensor == &settings.sensors.back()));
  }
  return sensors;
}

std::vector<PageData> checked_data(const std::vector<CheckedFrame>& checked) {
  std::vector<PageData> frames;
  frames.reserve(checked.size());
  for (const CheckedFrame& frame : checked) {
    frames.push_back(PageData()
                         .set("sensor", "{}", frame.sensor)
                         .set("readout", "{}", readout_title(frame.readout))
                         .set("columns_read", "{}", frame.columns)
                         .set("rows_read", "{}", frame.rows)
                         .set("acquisitions", "{}", frame.acquisitions)
                         .set("clocks", "{}", frame.cycles));
  }
  return frames;
}

}  // namespace

std::vector<StandardFrame> run_standard_frames(const StandardFramesSettings& settings) {
  if (settings.sensors.empty() || settings.readouts.empty()) {
    throw InputError("frames: needs a sensor and a read-out");
  }
  if (settings.frames < 2) {
    throw InputError(fmt::format("frames: an interval needs at least 2 frames, not {}", settings.frames));
  }
  std::vector<StandardFrame> frames;
  Progress progress("frames", settings.sensors.size() * static_cast<std::size_t>(settings.frames));
  for (const SensorModel& sensor : settings.sensors) {
    const StudyScene scene{std::string(scene_name(settings.scene)), targets_of(settings, sensor),
                           sensor.columns};
    const SceneTruth truth = scene_truth(scene);
    std::vector<Figures> all(settings.readouts.size());
    const SceneStudy study(sensor, settings.klux, parameters_of(settings, sensor), settings.seed,
                           settings.threads, TableRule::kFlat, false);
    for (int n = 0; n < settings.frames; ++n) {
      const std::vector<SceneMeasurement> measured = study.measure(scene, static_cast<std::uint32_t>(n));
      for (std::size_t r = 0; r < all.size(); ++r) {
        const SceneScore score = score_scene(truth, measured[r]);
        all[r].shares.push_back(score.all);
        const auto* const tenth = std::ranges::find(kDropped, kDroppedTenth);
        const double found = score.removed[static_cast<std::size_t>(tenth - kDropped.begin())];
        if (std::isfinite(found)) {
          all[r].found.push_back(found);
        }
      }
      progress.advance();
    }
    for (std::size_t r = 0; r < all.size(); ++r) {
      frames.push_back(figures(sensor, settings.readouts[r], all[r]));
    }
  }
  return frames;
}

std::vector<CheckedFrame> check_standard_frames(const StandardFramesSettings& settings, Readout readout) {
  std::vector<CheckedFrame> checked(settings.sensors.size());
  RunSettings run;
  run.engine = "rtl";
  run.verify = true;
  run.seed = settings.seed;
  run.threads = 1;
  parallel_for(checked.size(), settings.threads, [&](std::size_t s) {
    const SensorModel& sensor = settings.sensors[s];
    const ReadoutParameters parameters = default_parameters(readout, sensor);
    const PhotonSource source(sensor, targets_of(settings, sensor), settings.klux, settings.seed,
                              scene_frame(0));
    Region region = Region::whole(sensor.columns, sensor.rows);
    const int engine = ReadoutParameters::defaults(Readout::kPoolPointer).columns_together();
    region.columns.resize(
        static_cast<std::size_t>(std::min(sensor.columns, std::max(engine, parameters.columns_together()))));
    check_engine(source, std::vector{parameters}, run, region);
    const ReadoutRun done = run_readout(
        source, parameters, run, region,
        fmt::format("dtof frame --scene {} --sensor {} -k {:g} --readout {} --engine rtl --verify --seed {}",
                    scene_name(settings.scene), sensor.name, settings.klux, readout_name(readout),
                    settings.seed));
    checked[s] = {sensor.name,         readout,    static_cast<int>(region.columns.size()), region.rows.count,
                  sensor.acquisitions, done.cycles};
  });
  return checked;
}

PageData standard_frames_page(const StandardFramesSettings& settings,
                              const std::vector<StandardFrame>& frames,
                              const std::vector<CheckedFrame>& checked, const std::string& command_line) {
  PageData data;
  data.set("scene", "{}", scene_name(settings.scene))
      .set("columns", "{}", settings.sensors.front().columns)
      .set("rows", "{}", settings.sensors.front().rows)
      .set("klux", "{:g}", settings.klux)
      .list("sensors", sensors_data(settings))
      .set("frames", "{}", settings.frames)
      .set("seed", "{}", settings.seed)
      .set("above_3_percent",
           matrix(settings, frames,
                  [](const StandardFrame& frame) { return per_cent(frame.above_3_percent); }))
      .set("above_10_percent",
           matrix(settings, frames,
                  [](const StandardFrame& frame) { return per_cent(frame.above_10_percent); }))
      .set("found_by_confidence", matrix(settings, frames,
                                         [](const StandardFrame& frame) {
                                           return std::isfinite(frame.found_by_confidence)
                                                      ? fmt::format("{:.0f}",
                                                                    100.0 * frame.found_by_confidence)
                                                      : std::string("-");
                                         }))
      .list("checked", checked_data(checked))
      .set("command", "{}", command_line);
  return data;
}

Table standard_frames_csv(const std::vector<StandardFrame>& frames) {
  Table table({"sensor", "readout", "read-out", "acquisitions", "pixels", "above_3_percent", "above_3_low",
               "above_3_high", "above_10_percent", "above_10_low", "above_10_high", "relative_rmse",
               "found_by_confidence"});
  for (const StandardFrame& frame : frames) {
    std::vector<std::string> row = {frame.sensor, std::string(readout_name(frame.readout)),
                                    std::string(readout_title(frame.readout)),
                                    fmt::format("{}", frame.acquisitions), fmt::format("{}", frame.pixels)};
    for (const Estimate& share : {frame.above_3_percent, frame.above_10_percent}) {
      for (const double value : {share.value, share.interval.low, share.interval.high}) {
        row.push_back(fmt::format("{:.6g}", value));
      }
    }
    row.push_back(fmt::format("{:.6g}", frame.rmse));
    row.push_back(std::isfinite(frame.found_by_confidence) ? fmt::format("{:.4f}", frame.found_by_confidence)
                                                           : "");
    table.add(std::move(row));
  }
  return table;
}

}  // namespace dtof
