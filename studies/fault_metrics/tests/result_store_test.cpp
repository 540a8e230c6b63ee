// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/result_store.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

ArrayResult kept_result() {
  StratumResult one{CircuitPart::kEngines, Element::kFlipFlop, Repeated::kEngine, 7, 42.5, {}, {}};
  one.events = {.faults = 9,
                .harmful = 8,
                .beyond = 7,
                .by_parity = 1,
                .by_protocol = 2,
                .by_frame_check = 3,
                .by_self_test = 0,
                .undetected = 2,
                .undetected_beyond = 1,
                .latent = 0};
  one.stuck = {.faults = 5, .harmful = 4, .by_self_test = 4, .latent = 1};
  return {
      .readout = "poolpointer", .parity = true, .rows = 16, .columns = 4, .clocks = 99, .strata = {one, one}};
}

class ResultStore : public test::IoTest {};

TEST_F(ResultStore, KeepsAResultForItsKeyAlone) {
  const std::filesystem::path file = path("one.txt");
  EXPECT_FALSE(stored_result(file, "key").has_value());
  store_result(file, "key", kept_result());
  EXPECT_EQ(stored_result(file, "key"), kept_result());
  EXPECT_FALSE(stored_result(file, "other").has_value());
}

TEST_F(ResultStore, ADamagedFileIsNoResult) {
  const std::filesystem::path file = path("one.txt");
  store_result(file, "key", kept_result());
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 6);
  EXPECT_FALSE(stored_result(file, "key").has_value());
}

TEST_F(ResultStore, TheKeyFollowsOptionsAndNetlist) {
  const std::filesystem::path file = path("netlist.json");
  std::ofstream(file) << "{}";
  const MetricStudyOptions options;
  const std::string key = result_key(options, file);
  EXPECT_EQ(result_key(options, file), key);
  MetricStudyOptions others = options;
  others.seed = 2;
  EXPECT_NE(result_key(others, file), key);
  others = options;
  others.faults = 1;
  EXPECT_NE(result_key(others, file), key);
  others = options;
  others.threads = 5;
  EXPECT_EQ(result_key(others, file), key);
  std::ofstream(file) << "{ }";
  EXPECT_NE(result_key(options, file), key);
}

}  // namespace
}  // namespace dtof
