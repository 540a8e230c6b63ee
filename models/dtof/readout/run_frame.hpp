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

/// Reads out a frame with the model on at most `threads` threads (0 = all processors), column by column;
/// poolPointer engine by engine (ReadoutParameters::columns_together), of which it reads all columns.
///
/// `columns` lists the columns to read, in the order of the result; empty means all. The result is
/// row-major: index = row * n + i for the i-th of n columns read. `progress`, if given, advances by one a
/// column. Throws InputError for illegal parameters, a column outside the source, or a malformed stream.
std::vector<PixelResult> run_frame(const StreamSource& source, const ReadoutParameters& parameters,
                                   int threads = 0, std::span<const int> columns = {},
                                   Progress* progress = nullptr);

/// The same with the source's sampler instead of its streams: faster, other random numbers.
std::vector<PixelResult> run_sampled_frame(const SampledSource& source, const ReadoutParameters& parameters,
                                           int threads = 0, std::span<const int> columns = {},
                                           Progress* progress = nullptr);

}  // namespace dtof
