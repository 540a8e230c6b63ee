// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/recording/recording.hpp"

namespace dtof {

/// Histograms of a measurement, and how many photons are outside their bins.
struct CountedHistograms {
  HistogramCube cube;
  std::uint64_t outside = 0;
};

/// Counts the photons of a measurement: a cube stays as it is; a TDC stream has a bin for each of its 2^NP
/// codes, T_int / 2^NP wide; photon times fall into bins of `options.bin_width_s` (default T_int / 2^NP) from
/// 0 to T_int, after the time shift. Throws InputError for more than 2^27 bins in all.
CountedHistograms count_histograms(RecordedData measurement, const RecordingOptions& options);

}  // namespace dtof
