// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/line_reader.hpp"

namespace dtof {

/// Width in s of a bin of an ST VL53L8CH's histograms before the sensor sums bins: the light's way there and
/// back over 37.5348 mm, which the manufacturer's driver names as VL53LMZ_CNH_BIN_WIDTH_MM.
inline constexpr double kVl53l8chBinWidth = 250.4e-12;

/// True if the text is a log of a VL53L8CH's histograms (CNH): its first line names a column
/// "cnh__hist_bin_...", or a line begins with "Agg,".
bool is_vl53l8ch_log(std::string_view text);

/// Reads a log of compact normalised histograms, one for each aggregate of zones, in one of two forms.
///
/// CSV of the manufacturer's evaluation software: a line of names, and a line for each frame. Columns:
/// "cnh__hist_bin_<bin>_a<aggregate>"; "mi__agg_id_z<zone>", the aggregate of a zone; "distance_mm_z<zone>"
/// and ".is_valid_range_z<zone>" (1: valid). The last three may be missing. If the zones' aggregates are
/// known, the cube has the frames' columns side by side; otherwise each frame is a column and each aggregate
/// a row. `true_distance` is the sensor's valid distance of an aggregate of one zone, else NaN.
///
/// Text of the driver's example: lines "Agg, <aggregate>, Ambient, <level>, Bins, <bin>, <bin>, ...", in
/// ascending order from 0 in each frame. Other lines are ignored. Each frame is a column, each aggregate a
/// row.
///
/// The sensor subtracts ambient light and crosstalk, and a negative bin becomes 0. A frame without histograms
/// (nan) or without all aggregates is left out; `description` says how many. Throws InputError for a
/// malformed line, for a log without a complete frame, and if `bin_width_s` is not set: the log does not
/// contain it.
HistogramCube read_vl53l8ch_log(LineReader& lines, std::optional<double> bin_width_s,
                                std::string& description);

}  // namespace dtof
