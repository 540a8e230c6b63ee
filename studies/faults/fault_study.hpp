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
  kFlippedBit,          ///< one bit of an SRAM at one moment of the frame
  kFlippedBitAtWork,    ///< the same, at a moment in which poolPointer's engines work
  kStuckBit,            ///< one bit of every word of an SRAM reads the same all the frame
  kStuckTimestamps,     ///< a column's TDCs deliver one code, in every slot
  kHotPixelFixedCode,   ///< a pixel fires once more in every acquisition, at one code
  kHotPixelRandomCode,  ///< ... at random codes
  kDeadPixel,           ///< a pixel sees nothing
  kReset,               ///< a reset in mid frame; then a whole frame
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
  std::vector<FaultEffect> effects;  ///< one per fault; none of a reset
  int frames = 0;                    ///< frames with faults
  int broken_frames = 0;             ///< of them those that did not end, or broke an interface rule
  int model_mismatches = 0;   ///< of them those whose model, with the same timestamps, reads something else
  int changed_elsewhere = 0;  ///< pixels that changed in columns without a fault, in all frames
  int next_frames = 0;        ///< frames after those, without a fault
  int wrong_next_frames = 0;  ///< of them those that differ from the model in any pixel

  void merge(const FaultCaseResult& other);
};

struct FaultStudyOptions {
  std::vector<Readout> readouts = {kRtlReadouts.begin(), kRtlReadouts.end()};
  std::uint32_t acquisitions = 3333;
  int flips = 300;  ///< per kind of SRAM; a third as many of each pixel's fault, a twelfth of each column's
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all processors
};

/// Runs every case of every read-out. Faults are spread over a frame's columns, one in a column at most, with
/// columns between that have none. Throws InputError.
std::vector<FaultCaseResult> study_faults(const FaultStudyOptions& options);

}  // namespace dtof
