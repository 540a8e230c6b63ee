// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/design/bench.hpp"
#include "dtof/design/candidates.hpp"
#include "dtof/design/recommendation.hpp"
#include "dtof/design/rivals.hpp"

namespace dtof {

/// A sensor and limits, for which run_design chooses a read-out.
struct DesignRequest {
  BenchSettings bench;
  DesignLimits limits;
  int frames = 4;  ///< frames that compare the read-outs, at least 2; small arrays get more
  /// Budgets in pixels x acquisitions: `screening_work` to compare parameters, `final_work` to compare
  /// read-outs; both set the number of pixels of a frame. `contest_work` sets the number of frames that
  /// compare the contenders, as long as those frames do not settle the choice.
  double screening_work = 4e10;
  double final_work = 4e10;
  double contest_work = 4e10;
  double rival_work = 3e9;  ///< likewise, to compare rivals
  bool detection = true;    ///< measure P_d and P_fa
  /// Rivals to read beside the read-outs, from the photons of the same frames. At most as many pixels are
  /// read as with the read-outs.
  std::span<const RivalEntry> rivals;
  /// Observes the steps of the work. Without an observer, progress is shown on standard error.
  std::function<void(std::string_view step, std::size_t done, std::size_t total)> observer;
};

/// The request with a twentieth of the pixels (at least those of bench_region), and without P_d, P_fa
/// and rivals (`--quick`, and the playground's page).
DesignRequest quick_design(DesignRequest request);

/// A read-out none of whose parameters meet the limits, and why.
struct LeftOut {
  Readout readout;
  std::string reason;
};

struct DesignResult {
  std::vector<DesignOption> options;  ///< all options that were read out
  Recommendation recommendation;
  std::vector<LeftOut> left_out;
  std::vector<RivalOption> rivals;  ///< best first
  std::vector<RivalLeftOut> rivals_left_out;
  struct Consequence {
    LimitChange change;
    Recommendation recommendation;
    std::string needed;  ///< what would be needed, if no read-out meets the changed limits
  };
  std::vector<Consequence> consequences;  ///< one for each changed limit
  int frames = 0;                         ///< frames that compared the read-outs
  int contest_frames = 0;                 ///< frames that compared the contenders last; 0: without contest
  bool settled = true;                    ///< the frames show whether a smaller array is as good (good_share)
  std::size_t searched = 0;               ///< parameter sets whose cost was estimated
};

/// Returns the rivals that have fewer errors in their worst light than the recommended read-out, as far as
/// the intervals can tell. Best first. A rival has no RTL, so it is never recommended.
std::vector<const RivalOption*> more_accurate_rivals(const DesignResult& result);

/// Returns every candidate of the request with its estimated cost, in the brightest light.
std::vector<DesignCandidate> design_candidates(const DesignRequest& request);

/// Throws the InputError of run_design() that follows before any photon is read: with one line that says what
/// would be needed, if no read-out meets the limits.
void check_design(const DesignRequest& request);

/// Estimates the cost of every candidate. Reads out those that meet the limits, also after one limit is
/// loosened by 10 %. Of candidates that differ in SLOTS, ENGINE_COLUMNS and columns for each SRAM alone,
/// reads one: with most SLOTS, then with the smallest array. Compares the best option of each read-out, and
/// the contenders in more frames until these settle the choice or the budget is spent. Throws as
/// check_design() does.
DesignResult run_design(const DesignRequest& request);

}  // namespace dtof
