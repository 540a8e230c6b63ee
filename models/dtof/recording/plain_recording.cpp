// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/plain_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dtof/recording/line_reader.hpp"
#include "dtof/recording/picoquant.hpp"
#include "dtof/recording/tmf8820_json.hpp"
#include "dtof/recording/tmf8829_json.hpp"
#include "dtof/recording/tmf882x_log.hpp"
#include "dtof/recording/vl53l8ch_log.hpp"

namespace dtof {
namespace {

RecordedData open_line_log(const std::filesystem::path& path, const RecordingOptions& options,
                           const RecordingFile& file) {
  LineReader lines = file.contents.empty() ? LineReader(path) : LineReader(path, file.contents);
  std::string description;
  HistogramCube cube;
  if (file.format == "vl53l8ch") {
    cube = read_vl53l8ch_log(lines, options.bin_width_s, description);
  } else {
    Tmf882xOptions log{.mode = std::nullopt, .bin_width_s = options.bin_width_s};
    if (file.format != "tmf8820") {
      log.mode = file.format == "tmf8821" ? Tmf882xMode::kTwoCaptures : Tmf882xMode::kEightByEight;
    }
    cube = read_tmf882x_log(lines, log, description);
  }
  return {.description = std::move(description), .data = std::move(cube)};
}

RecordedData open_tmf8820(const RecordingOptions& options, const RecordingFile& file) {
  const std::vector<Tmf8820Capture> captures = parse_tmf8820_json(options.file, file.contents);
  return {.description = fmt::format("ams TMF8820, {} captures of 9 zones", captures.size()),
          .data = tmf8820_cube(captures, options.bin_width_s.value_or(kTmf8820BinWidth), 0.0, options.file)};
}

RecordedData open_tmf8829(const RecordingOptions& options, const RecordingFile& file) {
  const Tmf8829Log log = parse_tmf8829_json(options.file, file.contents);
  const std::string left_out =
      log.left_out == 0 ? "" : fmt::format(", {} without results or histograms left out", log.left_out);
  return {.description = fmt::format("ams TMF8829, {} frames{}", log.frames.size(), left_out),
          .data = tmf8829_cube(log, 0.0, options.file)};
}

RecordedData open_stream(const std::filesystem::path& path, const RecordingOptions& options,
                         const RecordingFile& file) {
  LineReader lines = file.contents.empty() ? LineReader(path) : LineReader(path, file.contents);
  RecordedStream stream = read_stream_csv(lines, {.np = options.resampling.np,
                                                  .slots = options.resampling.slots,
                                                  .columns = options.columns,
                                                  .rows = options.rows,
                                                  .acquisitions = options.acquisitions});
  std::string description = fmt::format("recorded stream, {} detections", stream.detection_count());
  return {.description = std::move(description), .data = std::move(stream)};
}

RecordedData open_picoquant(const std::filesystem::path& path, const RecordingFile& file) {
  std::string description;
  HistogramCube cube = file.contents.empty() ? picoquant_cube(path, description)
                                             : picoquant_cube(path, file.contents, description);
  return {.description = std::move(description), .data = std::move(cube)};
}

}  // namespace

bool is_plain_recording(std::string_view format) {
  constexpr std::array<std::string_view, 7> kPlain = {"csv",     "picoquant", "tmf8820", "tmf8821",
                                                      "tmf8828", "tmf8829",   "vl53l8ch"};
  return std::ranges::find(kPlain, format) != kPlain.end();
}

RecordedData open_plain_recording(const std::filesystem::path& path, const RecordingOptions& options,
                                  const RecordingFile& file) {
  if (file.format == "csv") {
    return open_stream(path, options, file);
  }
  if (file.format == "picoquant") {
    return open_picoquant(path, file);
  }
  if (file.format == "tmf8829") {
    return open_tmf8829(options, file);
  }
  const bool json = file.format == "tmf8820" && !file.contents.empty() && !is_tmf882x_log(file.contents);
  return json ? open_tmf8820(options, file) : open_line_log(path, options, file);
}

RecordedData recorded_times(PhotonTimes photons) {
  std::string description = fmt::format("photon times, {} photons of {} x {} pixels", photons.ticks.size(),
                                        photons.columns, photons.rows);
  return {.description = std::move(description), .data = std::move(photons)};
}

}  // namespace dtof
