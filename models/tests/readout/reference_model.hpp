// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"

namespace dtof {

/// True if the reference below covers the read-out. Pool read-outs have their own reference; a new read-out
/// has none yet.
bool has_reference(Readout readout);

/// Slow reference after docs/reference/readouts.md, sentence by sentence, without code of the models.
/// Timestamps are selected by predicates, counts are in a map, all arithmetic is signed 64 bit.
PixelResult reference_result(const ReadoutParameters& parameters, const std::vector<Detection>& detections,
                             std::int64_t acquisitions);
/// Reference of a pixel's raw frame: each bin's lowest code and, as the confidence, its count.
std::vector<PixelResult> reference_histogram(const ReadoutParameters& parameters,
                                             const std::vector<Detection>& detections,
                                             std::int64_t acquisitions);

}  // namespace dtof
