// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Software model of photon_generator.sv, written from its header comment: the same events in the same order.
class GeneratedPhotons {
 public:
  GeneratedPhotons(int np, int columns, int rows);

  /// Codes of the targets, row by row.
  [[nodiscard]] std::vector<int>& targets() { return targets_; }
  /// Events of each column in the next acquisitions, which are numbered from 0.
  [[nodiscard]] std::vector<ColumnStream> acquire(std::uint32_t acquisitions);

 private:
  int np_;
  int columns_;
  std::uint32_t random_ = 0x2545F491;  // SEED
  std::vector<int> targets_;
};

}  // namespace dtof
