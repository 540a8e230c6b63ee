// SPDX-License-Identifier: Apache-2.0
#include "readout/pool_parts.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace dtof {
namespace {

TEST(ChainBeliefs, NeighboursCarryAWeakPixelAndAStrongOneStays) {
  const auto node = [](int near_evidence, int far_evidence) {
    return ChainNode{2, 4, {1000, 20000}, {near_evidence, far_evidence}};
  };
  const std::vector<ChainNode> weak = {node(9, 0), node(0, 5), node(9, 0)};
  EXPECT_GT(chain_beliefs(weak)[1][0], chain_beliefs(weak)[1][1]);
  const std::vector<ChainNode> strong = {node(9, 0), node(0, 9), node(9, 0)};
  EXPECT_LT(chain_beliefs(strong)[1][0], chain_beliefs(strong)[1][1]);
}

}  // namespace
}  // namespace dtof
