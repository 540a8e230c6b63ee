// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/circuit_part.hpp"

#include <gtest/gtest.h>

namespace dtof {
namespace {

TEST(CircuitPart, FollowsTheInstancesOfTheName) {
  const auto part = [](std::string_view path) { return part_of_cell(path); };
  EXPECT_EQ(part("$flatten\\g_column[0].g_ez_pointer.u_column.\\u_timestamp_input.$procdff$1"),
            CircuitPart::kColumns);
  EXPECT_EQ(part("$flatten\\g_column[0].g_ez_pointer.u_column.\\u_pointer_builder.\\u_word_builder.$abc$1"),
            CircuitPart::kMemoryControl);
  EXPECT_EQ(
      part("$flatten\\g_column[0].x.u_column.\\u_pointer_builder.\\u_word_builder.\\u_word_sram.$abc$1"),
      CircuitPart::kParityCheck);
  EXPECT_EQ(part("$flatten\\g_quad[0].u_quad.\\u_sram.$abc$1"), CircuitPart::kMemoryControl);
  EXPECT_EQ(part("$flatten\\g_quad[0].u_quad.\\g_parity.u_word_parity.$abc$1"), CircuitPart::kParityCheck);
  EXPECT_EQ(part("$flatten\\u_parity.\\g_parity.u_parity_store.$abc$1"), CircuitPart::kParityCheck);
  EXPECT_EQ(part("$flatten\\g_engine[0].u_engine.\\u_scratch_sram.\\u_words.$abc$1"),
            CircuitPart::kMemoryControl);
  EXPECT_EQ(part("$flatten\\g_quad[0].u_quad.\\g_pair[1].u_pair.$abc$1"), CircuitPart::kColumns);
  EXPECT_EQ(part("$flatten\\g_quad[0].u_quad.$abc$1"), CircuitPart::kMemoryControl);
  EXPECT_EQ(part("$flatten\\g_engine[0].u_engine.\\u_choose.$abc$1"), CircuitPart::kEngines);
  EXPECT_EQ(part("$flatten\\g_engine[0].u_engine.\\u_parity_link.$abc$1"), CircuitPart::kParityCheck);
  EXPECT_EQ(part("$flatten\\u_parity.\\u_parity_head.$abc$1"), CircuitPart::kParityCheck);
  EXPECT_EQ(part("$flatten\\u_result_output.$abc$1"), CircuitPart::kOutput);
  EXPECT_EQ(part("$flatten\\u_result_path.\\u_result_output.$abc$1"), CircuitPart::kOutput);
  EXPECT_EQ(part("$flatten\\g_column[3].x.u_column.\\u_result_register.$abc$1"), CircuitPart::kOutput);
  EXPECT_EQ(part("$flatten\\u_control.\\u_pass_sequencer.$abc$1"), CircuitPart::kControl);
  EXPECT_EQ(part("$abc$5251$auto$blifparse.cc:386:parse_blif$5253"), CircuitPart::kControl);
}

TEST(CircuitPart, IsRepeatedWithItsColumnOrEngine) {
  EXPECT_EQ(repeated_of_cell("$flatten\\g_column[0].u_column.\\u_result_register.$abc$1"), Repeated::kColumn);
  EXPECT_EQ(repeated_of_cell("$flatten\\g_quad[0].u_quad.$abc$1"), Repeated::kColumn);
  EXPECT_EQ(repeated_of_cell("$flatten\\g_engine[0].u_engine.$abc$1"), Repeated::kEngine);
  EXPECT_EQ(repeated_of_cell("$flatten\\u_parity.\\g_parity.u_parity_store.$abc$1"), Repeated::kColumn);
  EXPECT_EQ(repeated_of_cell("$flatten\\u_control.\\u_controller.$abc$1"), Repeated::kArray);
}

TEST(CircuitPart, KnowsWhichBitsOfAMemoryAreParities) {
  EXPECT_EQ(parity_bits_of_memory("g_column[0].x.u_column.u_word_builder.u_word_sram.u_words.u_macro", 15),
            1U);
  EXPECT_EQ(parity_bits_of_memory("g_engine[0].u_engine.u_scratch_sram.u_words.u_macro", 37), 4U);
  EXPECT_EQ(parity_bits_of_memory("g_quad[0].u_quad.u_sram.g_one_port.u_macro", 232), 0U);
  EXPECT_EQ(parity_bits_of_memory("u_parity.g_parity.u_parity_store.u_parities.g_one_port.u_macro", 50), 50U);
}

}  // namespace
}  // namespace dtof
