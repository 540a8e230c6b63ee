// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/line_reader.hpp"

namespace dtof {

/// Zones of an ams-OSRAM TMF8820, TMF8821 or TMF8828.
enum class Tmf882xMode {
  kOneCapture,   ///< 9 zones: 3 x 3
  kTwoCaptures,  ///< two captures one after the other: 16 zones (4 x 4), or 18 (3 x 6)
  kEightByEight  ///< four results of two captures each: 64 zones
};

struct Tmf882xOptions {
  std::optional<Tmf882xMode> mode = std::nullopt;    ///< none: what the log says
  std::optional<double> bin_width_s = std::nullopt;  ///< none: kTmf8820BinWidth, only for kOneCapture
};

/// True if some line of the text begins as the histograms or results of a log do: "#Raw,", "#Cal,", "#Obj,".
bool is_tmf882x_log(std::string_view text);

/// Reads the serial output of the manufacturer's Arduino firmware while it dumps histograms.
///
/// A line "#Raw,<address>,<index>" with 128 numbers holds one byte of each bin of one channel. The channel is
/// index % 10: 0 is the reference, 1 to 9 are the zones. The byte is index / 10, least significant first.
/// Index 0 begins a capture of 30 lines. A line "#Obj,<address>,<result number>,<temperature>,<valid
/// results>,<time>" ends a result, of one or two captures. 36 pairs "<distance in mm>,<confidence>" follow,
/// of which pairs 0 to 8 are the first objects in the zones of the first capture, and 9 to 17 in those of the
/// second. A line "#Conf" names the SPAD map as "SPAD=<number>"; map 15 is 8 x 8. Other lines are ignored.
///
/// In mode kEightByEight the lowest two bits of the result number are the quarter, and a frame is four
/// quarters of consecutive results. The cube has the frames' columns side by side, 8 rows each. In the other
/// modes each result is a column and each zone a row, in the order of the log; mode kOneCapture does not need
/// results. `true_distance` is what the sensor reported, NaN if there is none.
///
/// Captures, results and frames that lack lines are left out; `description` says how many. Throws InputError
/// for a malformed line, for a log without a complete capture, result or frame, for two captures per result
/// if neither `options` nor the log tell the mode, and for an unknown bin width.
HistogramCube read_tmf882x_log(LineReader& lines, const Tmf882xOptions& options, std::string& description);

}  // namespace dtof
