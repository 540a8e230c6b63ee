// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/recording/histogram_stream.hpp"

namespace dtof {

inline constexpr std::size_t kTmf8820Zones = 9;  ///< 3 x 3
inline constexpr std::size_t kTmf8820Bins = 128;
/// Bin width in s. 13.9 mm per bin: the slope of the published captures against their true distances.
inline constexpr double kTmf8820BinWidth = 92.7e-12;

/// One capture of an ams TMF8820.
struct Tmf8820Capture {
  double distance = 0.0;  ///< true distance, m (`dist_to_plane`); NaN = unknown
  std::array<std::array<std::uint32_t, kTmf8820Bins>, kTmf8820Zones> histograms{};
  std::array<std::uint32_t, kTmf8820Bins> reference{};  ///< the emitted pulse; all 0 if the file has none
};

/// Reads a list of captures of a plane (C. Sifferman, SPAD-ICCP-Summer-School, part 2). A distance of 0, null
/// or NaN is unknown; the reference histogram may be missing. Throws InputError that names file, capture and
/// member.
std::vector<Tmf8820Capture> read_tmf8820_json(const std::filesystem::path& path);

/// Parses text that was read from `path`, as read_tmf8820_json does.
std::vector<Tmf8820Capture> parse_tmf8820_json(const std::filesystem::path& path, std::string_view text);

/// Cube of captures: a column per capture, a row per zone, distances in `true_distance`. `name`: the file,
/// for error messages.
HistogramCube tmf8820_cube(std::span<const Tmf8820Capture> captures, double bin_width = kTmf8820BinWidth,
                           double offset = 0.0, const std::string& name = HistogramCube().name);

}  // namespace dtof
