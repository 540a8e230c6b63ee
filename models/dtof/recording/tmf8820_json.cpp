// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf8820_json.hpp"

#include <algorithm>
#include <limits>

#include "dtof/io/input_file.hpp"
#include "dtof/io/json_file.hpp"

namespace dtof {

std::vector<Tmf8820Capture> read_tmf8820_json(const std::filesystem::path& path) {
  return parse_tmf8820_json(path, read_file_or_gzip(path));
}

std::vector<Tmf8820Capture> parse_tmf8820_json(const std::filesystem::path& path, std::string_view text) {
  const nlohmann::json json = parse_json(path, text);
  const JsonNode root(json, path.string());
  std::vector<Tmf8820Capture> captures(root.size());
  if (captures.empty()) {
    root.fail("no captures");
  }
  for (std::size_t i = 0; i < captures.size(); ++i) {
    const JsonNode node = root.at(i);
    const double distance = node["dist_to_plane"].number_or_unknown();
    if (distance < 0.0) {
      node["dist_to_plane"].fail("negative distance");
    }
    captures[i].distance = distance == 0.0 ? std::numeric_limits<double>::quiet_NaN() : distance;
    if (const auto reference = node.find("reference_hist")) {
      std::ranges::copy(reference->counts(kTmf8820Bins), captures[i].reference.begin());
    }
    const JsonNode zones = node["hists"];
    zones.expect_size(kTmf8820Zones);
    for (std::size_t zone = 0; zone < kTmf8820Zones; ++zone) {
      std::ranges::copy(zones.at(zone).counts(kTmf8820Bins), captures[i].histograms.at(zone).begin());
    }
  }
  return captures;
}

HistogramCube tmf8820_cube(std::span<const Tmf8820Capture> captures, double bin_width, double offset,
                           const std::string& name) {
  HistogramCube cube;
  cube.name = name;
  cube.columns = static_cast<int>(captures.size());
  cube.rows = static_cast<int>(kTmf8820Zones);
  cube.bins = static_cast<int>(kTmf8820Bins);
  cube.bin_width = bin_width;
  cube.offset = offset;
  for (std::size_t zone = 0; zone < kTmf8820Zones; ++zone) {
    for (const Tmf8820Capture& capture : captures) {
      const auto& histogram = capture.histograms.at(zone);
      cube.counts.insert(cube.counts.end(), histogram.begin(), histogram.end());
      cube.true_distance.push_back(capture.distance);
    }
  }
  cube.validate();
  return cube;
}

}  // namespace dtof
