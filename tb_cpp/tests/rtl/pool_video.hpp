// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "dtof/readout/pool_pointer.hpp"
#include "rtl/run_frame.hpp"
#include "scoreboard/scoreboard.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {

/// A video read by an array with a prior, and by the model. The model gets the prior that the frame before
/// left; the model gets none if the array has forgotten the prior.
class PoolVideo {
 public:
  explicit PoolVideo(const RtlConfiguration& configuration) : rtl_(configuration) {}

  testing::AssertionResult agrees(const std::vector<ColumnStream>& columns, std::uint32_t acquisitions,
                                  const RtlRunOptions& options) {
    const RtlConfiguration& configuration = rtl_.configuration();
    const PoolNumbers parameters = pool_pointer_parameters(configuration.parameters);
    const auto model = [&](std::vector<PoolPrior>* priors) {
      return run_pool_pointer(configuration.sram_num, reader_of(std::span(columns)),
                              configuration.parameters.np, acquisitions, parameters, priors);
    };
    if (!options.prior || options.reset_first || options.reset_at || first_) {
      priors_.clear();
    }
    first_ = false;
    const std::vector<std::vector<PixelResult>> by_column = model(&priors_);
    changed_ += options.prior && by_column != model(nullptr) ? 1 : 0;
    std::vector<PixelResult> expected;
    std::vector<int> numbers;
    for (int row = 0; row < configuration.pixels_per_sram; ++row) {
      for (const std::vector<PixelResult>& column : by_column) {
        expected.push_back(column[static_cast<std::size_t>(row)]);
      }
    }
    for (int column = 0; column < configuration.sram_num; ++column) {
      numbers.push_back(column);
    }
    const RtlFrame frame = rtl_.run(columns, acquisitions, options);
    const std::vector<Mismatch> mismatches =
        compare_frames(numbers, expected, frame.results, frame.result_cycles);
    if (mismatches.empty()) {
      return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << describe_mismatches(mismatches, expected.size(),
                                                              {.configuration = configuration,
                                                               .acquisitions = acquisitions,
                                                               .seed = options.seed,
                                                               .reproduce = reproduce_command(),
                                                               .shortest_failing_frame = {}});
  }

  /// Number of frames whose results the prior changed.
  [[nodiscard]] int changed() const { return changed_; }

 private:
  RtlReadout rtl_;
  std::vector<PoolPrior> priors_;
  bool first_ = true;
  int changed_ = 0;
};

}  // namespace dtof
