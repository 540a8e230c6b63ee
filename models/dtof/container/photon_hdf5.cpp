// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/photon_hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "dtof/container/hdf5_handle.hpp"
#include "dtof/container/read_apart.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kLongestText = 4096;
constexpr std::size_t kMostSpots = 65535;
constexpr std::size_t kPhotonsOfPiece = std::size_t{1} << 16U;
constexpr std::size_t kNumbersOfPhoton = 3;

bool has(hid_t file, const std::string& name) {
  // Each group on the way has to be there before the library is asked for what is in it.
  for (std::size_t end = name.find('/', 1); end != std::string::npos; end = name.find('/', end + 1)) {
    if (H5Lexists(file, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) {
      return false;
    }
  }
  return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0;
}

/// A number that stands alone; none if it is not there. Throws InputError if it is no number.
std::optional<double> scalar(const std::filesystem::path& path, hid_t file, const std::string& name) {
  if (!has(file, name)) {
    return std::nullopt;
  }
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const H5T_class_t kind = type.good() ? H5Tget_class(type.id()) : H5T_NO_CLASS;
  double value = 0.0;
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || !space.good() ||
      H5Sget_simple_extent_npoints(space.id()) != 1 ||
      H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) < 0) {
    fail_in_file(path, fmt::format("{} is not a number", name));
  }
  return value;
}

/// A unit of time in s; 0 if it is not there.
double unit(const std::filesystem::path& path, hid_t file, const std::string& name) {
  const std::optional<double> seconds = scalar(path, file, name);
  if (seconds && (!std::isfinite(*seconds) || *seconds <= 0.0)) {
    fail_in_file(path, fmt::format("{} is {:g} s, must be above 0", name, *seconds));
  }
  return seconds.value_or(0.0);
}

/// An array of integers with an element a photon.
class PhotonArray {
 public:
  PhotonArray(const std::filesystem::path& path, hid_t file, std::string name)
      : path_(path), name_(std::move(name)), dataset_(H5Dopen2(file, name_.c_str(), H5P_DEFAULT), H5Dclose) {
    const Hdf5Handle type(H5Dget_type(dataset_.id()), H5Tclose);
    if (!type.good() || H5Tget_class(type.id()) != H5T_INTEGER) {
      fail_in_file(path_, fmt::format("{} holds no integers", name_));
    }
    has_sign_ = H5Tget_sign(type.id()) != H5T_SGN_NONE;
    const auto extents = hdf5_extents(dataset_.id());
    if (!extents || extents->size() != 1) {
      fail_in_file(path_, fmt::format("{} has {} axes, not one", name_, extents ? extents->size() : 0));
    }
    size_ = extents->front();
  }

  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Reads `count` elements, each to every third place of `numbers`, from `place` on.
  void read(std::uint64_t first, std::size_t count, std::vector<std::uint64_t>& numbers,
            std::size_t place) const {
    const hsize_t begin = first;
    const hsize_t length = count;
    const Hdf5Handle space(H5Dget_space(dataset_.id()), H5Sclose);
    const Hdf5Handle memory(H5Screate_simple(1, &length, nullptr), H5Sclose);
    std::vector<std::int64_t> piece(count);
    if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &begin, nullptr, &length, nullptr) < 0 ||
        H5Dread(dataset_.id(), has_sign_ ? H5T_NATIVE_INT64 : H5T_NATIVE_UINT64, memory.id(), space.id(),
                H5P_DEFAULT, piece.data()) < 0) {
      fail_in_file(path_, fmt::format("{} is damaged, or packed by a filter that is not here", name_));
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (has_sign_ && piece[i] < 0) {
        fail_in_file(path_, fmt::format("{}: element {} is negative, {}", name_, first + i, piece[i]));
      }
      numbers[place + kNumbersOfPhoton * i] = std::bit_cast<std::uint64_t>(piece[i]);
    }
  }

 private:
  std::filesystem::path path_;
  std::string name_;
  Hdf5Handle dataset_;
  bool has_sign_ = true;
  std::uint64_t size_ = 0;
};

/// The arrays of a spot; all have the same length.
struct SpotArrays {
  PhotonArray timestamps;
  PhotonArray nanotimes;
  std::optional<PhotonArray> detectors;
};

SpotArrays open_spot(const std::filesystem::path& path, hid_t file, const std::string& group) {
  for (const auto& [name, reason] :
       {std::pair{"timestamps", "has no timestamps"},
        {"nanotimes", "has no nanotimes: no photon has a time since the laser's pulse"}}) {
    if (!has(file, fmt::format("{}/{}", group, name))) {
      fail_in_file(path, fmt::format("{} {}", group, reason));
    }
  }
  SpotArrays arrays{.timestamps = {path, file, group + "/timestamps"},
                    .nanotimes = {path, file, group + "/nanotimes"},
                    .detectors = std::nullopt};
  if (has(file, group + "/detectors")) {
    arrays.detectors.emplace(path, file, group + "/detectors");
  }
  const auto require_length = [&](const PhotonArray& array, const char* name) {
    if (array.size() != arrays.timestamps.size()) {
      fail_in_file(path, fmt::format("{} has {} timestamps and {} {}", group, arrays.timestamps.size(),
                                     array.size(), name));
    }
  };
  require_length(arrays.nanotimes, "nanotimes");
  if (arrays.detectors) {
    require_length(*arrays.detectors, "detectors");
  }
  return arrays;
}

std::vector<std::string> spot_groups(const std::filesystem::path& path, hid_t file) {
  std::vector<std::string> groups;
  if (has(file, "/photon_data")) {
    groups.emplace_back("/photon_data");
  }
  for (std::size_t spot = 0; groups.size() < kMostSpots; ++spot) {
    std::string group = fmt::format("/photon_data{}", spot);
    if (!has(file, group)) {
      break;
    }
    groups.push_back(std::move(group));
  }
  if (groups.empty()) {
    fail_in_file(path, "the file has neither /photon_data nor /photon_data0");
  }
  return groups;
}

PhotonHdf5Header header_in(const std::filesystem::path& path) {
  const QuietHdf5 quiet;
  const Hdf5Handle file = open_hdf5_file(path);
  PhotonHdf5Header header;
  std::uint64_t photons = 0;
  for (const std::string& group : spot_groups(path, file.id())) {
    const SpotArrays arrays = open_spot(path, file.id(), group);
    PhotonHdf5Spot spot{
        .group = group,
        .photons = arrays.timestamps.size(),
        .timestamps_unit_s = unit(path, file.id(), group + "/timestamps_specs/timestamps_unit"),
        .tcspc_unit_s = unit(path, file.id(), group + "/nanotimes_specs/tcspc_unit"),
        .tcspc_bins = 0};
    if (spot.tcspc_unit_s == 0.0) {
      fail_in_file(path, fmt::format("{}/nanotimes_specs has no tcspc_unit: no bin has a width", group));
    }
    if (const auto bins = scalar(path, file.id(), group + "/nanotimes_specs/tcspc_num_bins")) {
      if (!(*bins >= 1.0 && *bins <= 0x1.0p32) || *bins != std::floor(*bins)) {
        fail_in_file(
            path, fmt::format("{}/nanotimes_specs/tcspc_num_bins is {:g}, no number of bins", group, *bins));
      }
      spot.tcspc_bins = static_cast<std::uint64_t>(*bins);
    }
    photons += spot.photons;
    header.spots.push_back(std::move(spot));
  }
  if (photons == 0) {
    fail_in_file(path, "the file has no photons");
  }
  const std::string specs = header.spots.front().group + "/measurement_specs";
  if (has(file.id(), specs + "/measurement_type")) {
    const Hdf5Handle type(H5Dopen2(file.id(), (specs + "/measurement_type").c_str(), H5P_DEFAULT), H5Dclose);
    header.measurement = type.good() ? hdf5_text(type.id(), kLongestText).value_or("") : "";
  }
  header.laser_repetition_hz = scalar(path, file.id(), specs + "/laser_repetition_rate").value_or(0.0);
  return header;
}

/// A piece: the spot, and of each photon detector, timestamp and nanotime.
void give_pieces(const std::filesystem::path& path, const GivePiece& give) {
  const QuietHdf5 quiet;
  const Hdf5Handle file = open_hdf5_file(path);
  std::uint64_t spot = 0;
  for (const std::string& group : spot_groups(path, file.id())) {
    const SpotArrays arrays = open_spot(path, file.id(), group);
    const std::uint64_t photons = arrays.timestamps.size();
    for (std::uint64_t first = 0; first < photons; first += kPhotonsOfPiece) {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kPhotonsOfPiece, photons - first));
      ReadPiece piece(1 + kNumbersOfPhoton * count);
      piece[0] = spot;
      if (arrays.detectors) {
        arrays.detectors->read(first, count, piece, 1);
      }
      arrays.timestamps.read(first, count, piece, 2);
      arrays.nanotimes.read(first, count, piece, 3);
      give(piece);
    }
    ++spot;
  }
}

}  // namespace

bool is_photon_hdf5(const std::filesystem::path& path) {
  return read_apart(path, [&] {
           const QuietHdf5 quiet;
           const Hdf5Handle file = open_hdf5_file(path);
           const bool is = hdf5_attribute_text(file.id(), "format_name", kLongestText) == "Photon-HDF5";
           return ReadAnswer{.sizes = {is ? 1U : 0U}};
         }).sizes.at(0) == 1;
}

PhotonHdf5Header read_photon_hdf5_header(const std::filesystem::path& path) {
  const ReadAnswer answer = read_apart(path, [&] {
    const PhotonHdf5Header header = header_in(path);
    ReadAnswer flat{.sizes = {}, .values = {header.laser_repetition_hz}, .names = {header.measurement}};
    for (const PhotonHdf5Spot& spot : header.spots) {
      flat.names.push_back(spot.group);
      flat.sizes.insert(flat.sizes.end(), {spot.photons, spot.tcspc_bins});
      flat.values.insert(flat.values.end(), {spot.timestamps_unit_s, spot.tcspc_unit_s});
    }
    return flat;
  });
  PhotonHdf5Header header{
      .spots = {}, .measurement = answer.names.at(0), .laser_repetition_hz = answer.values.at(0)};
  for (std::size_t spot = 0; spot + 1 < answer.names.size(); ++spot) {
    header.spots.push_back({.group = answer.names[spot + 1],
                            .photons = answer.sizes.at(2 * spot),
                            .timestamps_unit_s = answer.values.at(2 * spot + 1),
                            .tcspc_unit_s = answer.values.at(2 * spot + 2),
                            .tcspc_bins = answer.sizes.at(2 * spot + 1)});
  }
  return header;
}

void read_photon_hdf5(const std::filesystem::path& path,
                      const std::function<void(const PhotonHdf5Event&)>& take) {
  read_pieces_apart(
      path, [&](const GivePiece& give) { give_pieces(path, give); },
      [&](const ReadPiece& piece) {
        for (std::size_t i = 1; i + kNumbersOfPhoton <= piece.size(); i += kNumbersOfPhoton) {
          take({.spot = static_cast<std::uint32_t>(piece[0]),
                .detector = piece[i],
                .timestamp = piece[i + 1],
                .nanotime = piece[i + 2]});
        }
      });
}

}  // namespace dtof
