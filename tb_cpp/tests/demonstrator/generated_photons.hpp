// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// What photon_generator.sv makes, written from its header: the same events in the same order.
class GeneratedPhotons {
 public:
  GeneratedPhotons(int np, int columns, int rows);

  /// Codes of the targets, row by row.
  [[nodiscard]] std::vector<int>& targets() { return targets_; }
  /// The next acquisitions, numbered from 0, of each column.
  [[nodiscard]] std::vector<ColumnStream> acquire(std::uint32_t acquisitions);

 private:
  int np_;
  int columns_;
  std::uint32_t random_ = 0x2545F491;  // SEED
  std::vector<int> targets_;
};

}  // namespace dtof
