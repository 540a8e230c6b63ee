// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/recording/recording.hpp"

namespace dtof {

/// Histograms of a measurement, and the number of photons outside their bins.
struct CountedHistograms {
  HistogramCube cube;
  std::uint64_t outside = 0;
};

/// Histograms of a measurement. A cube is returned unchanged. A TDC stream gets 2^NP bins of T_int / 2^NP.
/// Photon times get bins of `options.bin_width_s` (default T_int / 2^NP) from 0 to T_int, after the time
/// shift. Throws InputError for more than 2^27 bins in all.
CountedHistograms count_histograms(RecordedData measurement, const RecordingOptions& options);

}  // namespace dtof
