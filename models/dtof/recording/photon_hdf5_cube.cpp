// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/photon_hdf5_cube.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kMostPhotonBins = std::uint64_t{1} << 20U;
constexpr std::uint64_t kMostDetectors = 65535;
constexpr std::size_t kMostCounts = std::size_t{1} << 27U;

/// Bins that the file has, as far as it says.
std::uint64_t most_bins(const PhotonHdf5Header& header) {
  std::uint64_t most = 0;
  for (const PhotonHdf5Spot& spot : header.spots) {
    most = std::max(most, spot.tcspc_bins == 0 ? kMostPhotonBins : spot.tcspc_bins);
  }
  return std::min(most, kMostPhotonBins);
}

void require_one_unit(const std::filesystem::path& path, const PhotonHdf5Header& header) {
  const PhotonHdf5Spot& first = header.spots.front();
  for (const PhotonHdf5Spot& spot : header.spots) {
    if (spot.tcspc_unit_s != first.tcspc_unit_s) {
      fail_in_file(path,
                   fmt::format("tcspc_unit is {:g} ps in {} and {:g} ps in {}: one width of bins is needed",
                               first.tcspc_unit_s * 1e12, first.group, spot.tcspc_unit_s * 1e12, spot.group));
    }
  }
}

}  // namespace

std::string photon_hdf5_description(const PhotonHdf5Header& header) {
  std::uint64_t photons = 0;
  for (const PhotonHdf5Spot& spot : header.spots) {
    photons += spot.photons;
  }
  std::string text = "Photon-HDF5";
  if (!header.measurement.empty()) {
    text += ", " + header.measurement;
  }
  if (header.laser_repetition_hz > 0.0) {
    text += fmt::format(", laser at {:g} MHz", header.laser_repetition_hz * 1e-6);
  }
  if (header.spots.size() > 1) {
    text += fmt::format(", {} spots", header.spots.size());
  }
  return text + fmt::format(", {} photons", photons);
}

HistogramCube photon_hdf5_cube(const std::filesystem::path& path, std::string& description) {
  const PhotonHdf5Header header = read_photon_hdf5_header(path);
  require_one_unit(path, header);
  const std::uint64_t most = most_bins(header);
  // Counts of each spot's detectors, each with as many bins as it needs.
  std::vector<std::vector<std::vector<double>>> spots(header.spots.size());
  std::size_t detectors = 1;
  std::size_t bins = 0;
  std::uint64_t beyond = 0;
  const auto require_size = [&] {
    if (detectors * std::max<std::size_t>(bins, 1) > kMostCounts / spots.size()) {
      fail_in_file(path, fmt::format("{} spots, {} detectors and {} bins are more than 2^27 counts",
                                     spots.size(), detectors, bins));
    }
  };
  read_photon_hdf5(path, [&](const PhotonHdf5Event& photon) {
    if (photon.nanotime >= most) {
      ++beyond;
      return;
    }
    if (photon.detector > kMostDetectors) {
      fail_in_file(path, fmt::format("detector {} is beyond {}", photon.detector, kMostDetectors));
    }
    const auto detector = static_cast<std::size_t>(photon.detector);
    const auto bin = static_cast<std::size_t>(photon.nanotime);
    if (detector >= detectors || bin >= bins) {
      detectors = std::max(detectors, detector + 1);
      bins = std::max(bins, bin + 1);
      require_size();
    }
    std::vector<std::vector<double>>& spot = spots.at(photon.spot);
    spot.resize(std::max(spot.size(), detector + 1));
    spot[detector].resize(std::max(spot[detector].size(), bin + 1), 0.0);
    ++spot[detector][bin];
  });
  if (bins == 0) {
    fail_in_file(path, fmt::format("no photon is within {} bins behind a pulse", most));
  }
  const bool says_bins =
      std::ranges::none_of(header.spots, [](const PhotonHdf5Spot& spot) { return spot.tcspc_bins == 0; });
  bins = says_bins ? static_cast<std::size_t>(most) : bins;
  require_size();
  HistogramCube cube;
  cube.name = path.string();
  cube.columns = static_cast<int>(detectors);
  cube.rows = static_cast<int>(spots.size());
  cube.bins = static_cast<int>(bins);
  cube.bin_width = header.spots.front().tcspc_unit_s;
  for (std::vector<std::vector<double>>& spot : spots) {
    spot.resize(detectors);
    for (std::vector<double>& counts : spot) {
      counts.resize(bins, 0.0);
      cube.counts.insert(cube.counts.end(), counts.begin(), counts.end());
    }
  }
  description = photon_hdf5_description(header);
  if (beyond != 0) {
    description += fmt::format(", {} beyond {} bins left out", beyond, most);
  }
  return cube;
}

}  // namespace dtof
