// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "dtof/metrics/confidence_interval.hpp"
#include "fault_metrics/metric_study.hpp"

namespace dtof {

/// Whether faults last for one clock, or for ever.
enum class FaultLife { kEvent, kStuck };

const FaultCounts& counts_of(const StratumResult& stratum, FaultLife life);

/// Number of drawn faults that have a property.
using Counted = std::function<std::uint64_t(const FaultCounts&)>;

/// Share of the faults with property `part` among those with property `whole`, which they must have, in the
/// full array. Every element of the full array has the same fault rate: a stratum counts with its elements.
/// The interval is Wilson's, with the number of faults that would have the same variance in one stratum (Korn
/// and Graubard, Survey Methodology 24, 1998). The value is NaN if no fault has the property `whole`.
Estimate weighted_share(std::span<const StratumResult> strata, FaultLife life, const Counted& part,
                        const Counted& whole);

/// Sum of full_sites * share of the drawn faults with the property: elements of the full array.
double weighted_sum(std::span<const StratumResult> strata, FaultLife life, const Counted& part);

/// Metrics of ISO 26262-5, annex C. With the same fault rate for all elements:
struct SafetyMetrics {
  Estimate harmful;          ///< harmful faults among all
  Estimate detected;         ///< detected faults among the harmful ones
  Estimate detected_beyond;  ///< the same among those that move a pixel by more than 3 %, or lose a pixel
  Estimate in_logic;         ///< detected faults among the harmful ones of gates and flip-flops
  Estimate in_frame;         ///< detected without the self-test among the harmful ones
  Estimate single_point;     ///< 1 - undetected harmful faults / all faults
  Estimate latent;  ///< 1 - latent faults / (all faults - undetected harmful faults); kStuck with parity
};
SafetyMetrics safety_metrics(const ArrayResult& result, FaultLife life);

}  // namespace dtof
