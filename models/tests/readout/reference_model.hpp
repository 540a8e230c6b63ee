// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"

namespace dtof {

/// Whether the slow reading below knows the read-out. The pool read-outs have a reference of their own; a
/// read-out that was just added has none yet.
bool has_reference(Readout readout);

/// Slow reading of docs/reference/readouts.md, sentence by sentence, sharing nothing with the models:
/// timestamps are selected by predicates, counts live in a map, all arithmetic is signed 64 bit.
PixelResult reference_result(const ReadoutParameters& parameters, const std::vector<Detection>& detections,
                             std::int64_t acquisitions);
/// Likewise what a raw frame shows of the pixel: each bin's lowest code and, as the confidence, its count.
std::vector<PixelResult> reference_histogram(const ReadoutParameters& parameters,
                                             const std::vector<Detection>& detections,
                                             std::int64_t acquisitions);

}  // namespace dtof
