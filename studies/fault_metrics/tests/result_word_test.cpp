// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/result_word.hpp"

#include <gtest/gtest.h>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

TEST(ResultWord, SplitsTheFieldsOfThePort) {
  GateNetlist netlist;
  netlist.readout = "ezpointer";
  netlist.rows = 16;
  netlist.columns = 4;
  netlist.ports["result_tdata_o"].resize(20);
  const ResultWord word(netlist);
  EXPECT_EQ(word.confidence_width, 4);
  const std::uint64_t one = 2U << 18U | 13U << 14U | 777U << 4U | 9U;
  EXPECT_EQ(word.column(one), 2U);
  EXPECT_EQ(word.row(one), 13U);
  EXPECT_EQ(word.position(one), 777U);
  EXPECT_EQ(word.confidence(one), 9U);
  EXPECT_EQ(word.address(one), 2U << 4U | 13U);
  netlist.ports["result_tdata_o"].resize(15);
  EXPECT_THROW((void)ResultWord(netlist), InputError);
}

TEST(ResultWord, OfPoolPointerHasAFraction) {
  GateNetlist netlist;
  netlist.readout = "poolpointer";
  netlist.rows = 16;
  netlist.columns = 4;
  netlist.ports["result_tdata_o"].resize(30);
  const ResultWord word(netlist);
  EXPECT_EQ(word.fraction_width, 6);
  EXPECT_EQ(word.confidence_width, 8);
}

}  // namespace
}  // namespace dtof
