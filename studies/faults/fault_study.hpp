// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "faults/fault_effect.hpp"
#include "rtl/configuration.hpp"

namespace dtof {

enum class FaultKind {
  kFlippedBit,          ///< one bit of an SRAM flips at one moment of the frame
  kFlippedBitAtWork,    ///< the same, while poolPointer's engines work
  kStuckBit,            ///< one bit of every word of an SRAM reads a constant for the whole frame
  kStuckTimestamps,     ///< a column's TDCs deliver one code in every slot
  kHotPixelFixedCode,   ///< a pixel has an additional event in every acquisition, at one code
  kHotPixelRandomCode,  ///< the same, at random codes
  kDeadPixel,           ///< a pixel has no events
  kReset,               ///< a reset within the frame, then a whole frame
};

/// One kind of fault in one read-out.
struct FaultCase {
  Readout readout = Readout::kEzPointer;
  FaultKind kind = FaultKind::kFlippedBit;
  std::optional<SramKind> sram;   ///< flipped and stuck bits
  std::optional<RtlState> state;  ///< reset
};

struct FaultCaseResult {
  FaultCase fault;
  std::vector<FaultEffect> effects;  ///< one per fault; empty for a reset
  int frames = 0;                    ///< frames with faults
  int broken_frames = 0;             ///< frames with faults that did not end, or violated an interface rule
  int model_mismatches = 0;   ///< frames with faults that differ from the model with the same timestamps
  int changed_elsewhere = 0;  ///< changed pixels in columns without a fault, over all frames
  int next_frames = 0;        ///< following frames without a fault
  int wrong_next_frames = 0;  ///< following frames that differ from the model in any pixel

  void merge(const FaultCaseResult& other);
};

struct FaultStudyOptions {
  std::vector<Readout> readouts = {kRtlReadouts.begin(), kRtlReadouts.end()};
  std::uint32_t acquisitions = 3333;
  int flips = 300;  ///< per kind of SRAM; a third as many pixel faults, a twelfth as many column faults
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all processors
};

/// Runs every case of every read-out. Faults are spread over a frame: at most one per column, with columns
/// without a fault between them. Throws InputError.
std::vector<FaultCaseResult> study_faults(const FaultStudyOptions& options);

}  // namespace dtof
