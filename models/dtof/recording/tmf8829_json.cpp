// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf8829_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dtof/io/input_file.hpp"
#include "dtof/io/json_file.hpp"

namespace dtof {
namespace {

std::optional<std::int64_t> integer_member(const JsonNode& node, const char* key) {
  const auto member = node.find(key);
  return member ? std::optional(member->integer()) : std::nullopt;
}

std::optional<double> metres_member(const JsonNode& node, const char* key) {
  constexpr double kMetresPerMillimetre = 1e-3;
  const auto member = node.find(key);
  return member ? std::optional(member->number() * kMetresPerMillimetre) : std::nullopt;
}

Tmf8829Pixel parse_pixel(const JsonNode& node) {
  Tmf8829Pixel pixel;
  pixel.noise = integer_member(node, "noise");
  pixel.crosstalk = integer_member(node, "xtalk");
  const auto peaks = node.find("peaks");
  for (std::size_t i = 0; peaks && i < peaks->size(); ++i) {
    const JsonNode peak = peaks->at(i);
    pixel.peaks.push_back({.distance = metres_member(peak, "distance"),
                           .x = metres_member(peak, "x"),
                           .y = metres_member(peak, "y"),
                           .z = metres_member(peak, "z"),
                           .signal = integer_member(peak, "signal"),
                           .snr = integer_member(peak, "snr")});
  }
  return pixel;
}

/// An array that is there and has elements.
std::optional<JsonNode> filled_array(const JsonNode& node, const char* key) {
  auto member = node.find(key);
  return member && member->size() > 0 ? member : std::nullopt;
}

/// None if the frame has no results or no histograms.
std::optional<Tmf8829Frame> parse_frame(const JsonNode& node) {
  const auto results = filled_array(node, "results");
  const auto histograms = filled_array(node, "mp_histo");
  if (!results || !histograms) {
    return std::nullopt;
  }
  Tmf8829Frame frame;
  if (const auto info = node.find("info")) {
    frame.number = integer_member(*info, "frame_number");
  }
  const std::size_t rows = results->size();
  const std::size_t columns = results->at(0).size();
  if (columns == 0) {
    results->fail("no pixels");
  }
  histograms->expect_size(rows);
  histograms->at(0).expect_size(columns);
  frame.bins = histograms->at(0).at(0)["bin"].size() == kTmf8829FineBins ? kTmf8829FineBins : kTmf8829Bins;
  for (std::size_t row = 0; row < rows; ++row) {
    const JsonNode result_row = results->at(row);
    const JsonNode histogram_row = histograms->at(row);
    result_row.expect_size(columns);
    histogram_row.expect_size(columns);
    for (std::size_t column = 0; column < columns; ++column) {
      frame.results.push_back(parse_pixel(result_row.at(column)));
      const std::vector<std::uint32_t> bins = histogram_row.at(column)["bin"].counts(frame.bins);
      frame.histograms.insert(frame.histograms.end(), bins.begin(), bins.end());
    }
  }
  frame.rows = static_cast<int>(rows);
  frame.columns = static_cast<int>(columns);
  const auto reference = node.find("ref_histo");
  for (std::size_t i = 0; reference && i < reference->size(); ++i) {
    frame.reference.push_back(reference->at(i)["bin"].counts(kTmf8829Bins));
  }
  return frame;
}

/// Steps of the sensor's converter that its configuration puts into a bin, as a power of two; where a log
/// does not say, histograms of either length span the same range.
std::int64_t bin_shift(const JsonNode& root, std::size_t bins) {
  const auto configuration = root.find("configuration");
  const auto shift = configuration ? configuration->find("bin_shift") : std::nullopt;
  if (!shift) {
    return bins == kTmf8829FineBins ? 0 : kTmf8829BinShift;
  }
  constexpr std::int64_t kLargest = 7;
  const std::int64_t value = shift->integer();
  if (value < 0 || value > kLargest) {
    shift->fail(fmt::format("{} is not within 0 to {}", value, kLargest));
  }
  return value;
}

void append_pixel(HistogramCube& cube, std::span<const std::uint32_t> histogram, const Tmf8829Pixel& pixel) {
  cube.counts.insert(cube.counts.end(), histogram.begin(), histogram.end());
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  cube.true_distance.push_back(pixel.peaks.empty() ? kUnknown
                                                   : pixel.peaks.front().distance.value_or(kUnknown));
}

}  // namespace

bool Tmf8829Frame::only_row_zero() const {
  for (int list = 0; list < rows; ++list) {
    for (int entry = 1; entry < columns; ++entry) {
      if (!std::ranges::equal(histogram(list, 0), histogram(list, entry))) {
        return false;
      }
    }
  }
  return rows == columns && columns > 1;
}

Tmf8829Log read_tmf8829_json(const std::filesystem::path& path) {
  return parse_tmf8829_json(path, read_file_or_gzip(path));
}

Tmf8829Log parse_tmf8829_json(const std::filesystem::path& path, std::string_view text) {
  const nlohmann::json json = parse_json(path, text);
  const JsonNode root(json, path.string());
  const JsonNode set = root["Result_Set"];
  Tmf8829Log log;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (auto frame = parse_frame(set.at(i))) {
      log.frames.push_back(std::move(*frame));
    } else {
      ++log.left_out;
    }
  }
  if (log.frames.empty()) {
    set.fail(log.left_out == 0
                 ? "no frames"
                 : fmt::format("none of {} frames has both results and histograms", log.left_out));
  }
  log.bin_width = std::ldexp(kTmf8829BinWidth,
                             static_cast<int>(bin_shift(root, log.frames.front().bins) - kTmf8829BinShift));
  return log;
}

HistogramCube tmf8829_cube(const Tmf8829Log& log, double offset, const std::string& name) {
  const std::vector<Tmf8829Frame>& frames = log.frames;
  HistogramCube cube;
  cube.name = name;
  if (frames.empty()) {
    cube.fail("no frames");
  }
  const Tmf8829Frame& first = frames.front();
  if (!std::ranges::all_of(frames, [&](const Tmf8829Frame& frame) {
        return frame.rows == first.rows && frame.columns == first.columns && frame.bins == first.bins;
      })) {
    cube.fail("frames of different size");
  }
  const bool row_zero = std::ranges::all_of(frames, &Tmf8829Frame::only_row_zero);
  cube.columns = static_cast<int>(frames.size()) * (row_zero ? 1 : first.columns);
  cube.rows = row_zero ? first.columns : first.rows;
  cube.bins = static_cast<int>(first.bins);
  cube.bin_width = log.bin_width;
  cube.offset = offset;
  for (int row = 0; row < cube.rows; ++row) {
    for (const Tmf8829Frame& frame : frames) {
      if (row_zero) {
        append_pixel(cube, frame.histogram(row, 0), frame.result(0, row));
        continue;
      }
      for (int column = 0; column < frame.columns; ++column) {
        append_pixel(cube, frame.histogram(row, column), frame.result(row, column));
      }
    }
  }
  cube.validate();
  return cube;
}

}  // namespace dtof
