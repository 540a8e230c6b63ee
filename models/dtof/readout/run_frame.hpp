// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/pixel_sampler.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/result.hpp"

namespace dtof {

/// Reads out a frame with the model on at most `threads` threads (0 = all processors). poolPointer always
/// processes all columns of an engine (ReadoutParameters::columns_together).
///
/// `columns` lists the columns of the result, in its order; empty means all. The result is row-major: index =
/// row * n + i for the i-th of n columns. `progress`, if given, advances by one per column. Throws InputError
/// for illegal parameters, a column outside `source`, or a malformed stream.
std::vector<PixelResult> run_frame(const StreamSource& source, const ReadoutParameters& parameters,
                                   int threads = 0, std::span<const int> columns = {},
                                   Progress* progress = nullptr);

/// Same, with the source's sampler instead of its streams: faster, but from other random numbers.
std::vector<PixelResult> run_sampled_frame(const SampledSource& source, const ReadoutParameters& parameters,
                                           int threads = 0, std::span<const int> columns = {},
                                           Progress* progress = nullptr);

}  // namespace dtof
