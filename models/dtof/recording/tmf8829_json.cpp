// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf8829_json.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/io/json_file.hpp"

namespace dtof {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

Tmf8829Pixel parse_pixel(const JsonNode& node) {
  Tmf8829Pixel pixel;
  pixel.noise = node["noise"].integer();
  pixel.crosstalk = node["xtalk"].integer();
  const JsonNode peaks = node["peaks"];
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    const JsonNode peak = peaks.at(i);
    pixel.peaks.push_back({.distance = peak["distance"].number() * kMetresPerMillimetre,
                           .x = peak["x"].number() * kMetresPerMillimetre,
                           .y = peak["y"].number() * kMetresPerMillimetre,
                           .z = peak["z"].number() * kMetresPerMillimetre,
                           .signal = peak["signal"].integer(),
                           .snr = peak["snr"].integer()});
  }
  return pixel;
}

Tmf8829Frame parse_frame(const JsonNode& node) {
  Tmf8829Frame frame;
  frame.number = node["info"]["frame_number"].integer();
  const JsonNode results = node["results"];
  const JsonNode histograms = node["mp_histo"];
  const std::size_t rows = results.size();
  if (rows == 0 || results.at(0).size() == 0) {
    results.fail("no pixels");
  }
  const std::size_t columns = results.at(0).size();
  histograms.expect_size(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const JsonNode result_row = results.at(row);
    const JsonNode histogram_row = histograms.at(row);
    result_row.expect_size(columns);
    histogram_row.expect_size(columns);
    for (std::size_t column = 0; column < columns; ++column) {
      frame.results.push_back(parse_pixel(result_row.at(column)));
      const std::vector<std::uint32_t> bins = histogram_row.at(column)["bin"].counts(kTmf8829Bins);
      frame.histograms.insert(frame.histograms.end(), bins.begin(), bins.end());
    }
  }
  frame.rows = static_cast<int>(rows);
  frame.columns = static_cast<int>(columns);
  const JsonNode reference = node["ref_histo"];
  for (std::size_t i = 0; i < reference.size(); ++i) {
    frame.reference.push_back(reference.at(i)["bin"].counts(kTmf8829Bins));
  }
  return frame;
}

void append_pixel(HistogramCube& cube, std::span<const std::uint32_t> histogram, const Tmf8829Pixel& pixel) {
  cube.counts.insert(cube.counts.end(), histogram.begin(), histogram.end());
  cube.true_distance.push_back(pixel.peaks.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                   : pixel.peaks.front().distance);
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

std::vector<Tmf8829Frame> read_tmf8829_json(const std::filesystem::path& path) {
  const nlohmann::json json = read_json(path);
  const JsonNode set = JsonNode(json, path.string())["Result_Set"];
  std::vector<Tmf8829Frame> frames;
  for (std::size_t i = 0; i < set.size(); ++i) {
    frames.push_back(parse_frame(set.at(i)));
  }
  if (frames.empty()) {
    set.fail("no frames");
  }
  return frames;
}

HistogramCube tmf8829_cube(std::span<const Tmf8829Frame> frames, double bin_width, double offset) {
  if (frames.empty()) {
    throw InputError("TMF8829: no frames");
  }
  const Tmf8829Frame& first = frames.front();
  if (!std::ranges::all_of(frames, [&](const Tmf8829Frame& frame) {
        return frame.rows == first.rows && frame.columns == first.columns;
      })) {
    throw InputError("TMF8829: frames of different size");
  }
  const bool row_zero = std::ranges::all_of(frames, &Tmf8829Frame::only_row_zero);
  HistogramCube cube;
  cube.columns = static_cast<int>(frames.size()) * (row_zero ? 1 : first.columns);
  cube.rows = row_zero ? first.columns : first.rows;
  cube.bins = static_cast<int>(kTmf8829Bins);
  cube.bin_width = bin_width;
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
