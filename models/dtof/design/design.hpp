// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/design/bench.hpp"
#include "dtof/design/candidates.hpp"
#include "dtof/design/recommendation.hpp"

namespace dtof {

/// From a sensor and limits to a read-out.
struct DesignRequest {
  BenchSettings bench;
  DesignLimits limits;
  int frames = 4;  ///< that compare the read-outs, at least 2; more of a small array
  /// Acquisitions of pixels that may be read for all parameters, and for the frames that compare read-outs,
  /// which decides how many pixels a frame has.
  double screening_work = 4e10;
  double final_work = 4e10;
};

/// What one read-out lacks, where no parameters keep the limits.
struct LeftOut {
  Readout readout;
  std::string reason;
};

struct DesignResult {
  std::vector<DesignOption> options;  ///< all that were read
  Recommendation recommendation;
  std::vector<LeftOut> left_out;
  struct Consequence {
    LimitChange change;
    Recommendation recommendation;
    std::string needed;  ///< where no read-out keeps the limits
  };
  std::vector<Consequence> consequences;  ///< of each change of a limit
  int frames = 0;                         ///< that have compared the read-outs
  std::size_t searched = 0;               ///< sets of parameters whose costs were estimated
};

/// Estimates every candidate, reads those that keep the limits or a limit that is 10 % looser, and compares
/// the best of each read-out. Throws InputError, with one line that says what would do, if no read-out keeps
/// the limits.
DesignResult run_design(const DesignRequest& request);

}  // namespace dtof
