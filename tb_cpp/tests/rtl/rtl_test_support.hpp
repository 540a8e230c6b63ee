// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/random.hpp"
#include "rtl/registry.hpp"
#include "rtl/rtl_readout.hpp"
#include "scoreboard/scoreboard.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {

/// Prints a configuration in GoogleTest's failure messages.
inline void PrintTo(const RtlConfiguration& configuration, std::ostream* stream) {
  *stream << configuration.to_string();
}

/// Letters and digits of a text, as the name of a test.
inline std::string test_name(std::string_view text) {
  std::string name(text);
  std::erase_if(name, [](char c) { return c == '='; });
  std::ranges::replace_if(
      name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

inline std::string configuration_test_name(const testing::TestParamInfo<RtlConfiguration>& configuration) {
  return test_name(configuration.param.to_string());
}

inline std::string readout_test_name(const testing::TestParamInfo<Readout>& readout) {
  return test_name(readout_name(readout.param));
}

/// Read-outs of dtof_array. Those of dtof_pool_pointer_array are in pool_pointer_test.
inline std::vector<Readout> array_readouts() {
  std::vector<Readout> readouts;
  std::ranges::remove_copy_if(kRtlReadouts, std::back_inserter(readouts), is_pool_readout);
  return readouts;
}

/// Read-outs compiled into this program at full size.
inline std::vector<Readout> full_size_readouts() {
  std::vector<Readout> readouts;
  for (const RtlConfiguration& configuration : compiled_rtl_configurations()) {
    const Readout readout = configuration.parameters.readout;
    if (configuration.pixels_per_sram == 160 && std::ranges::find(readouts, readout) == readouts.end()) {
      readouts.push_back(readout);
    }
  }
  return readouts;
}

/// Command that repeats the running test and writes a waveform of its last frame. A mismatch ends a test, so
/// this is the failing frame. The array has to record waveforms, as the tests' small arrays do in a build
/// with DTOF_TEST_WAVEFORMS=ON.
inline std::string reproduce_command() {
  const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
  return test_seed_message() + " DTOF_TRACE=trace.fst " +
         std::filesystem::read_symlink("/proc/self/exe").string() + " --gtest_filter='" +
         info->test_suite_name() + "." + info->name() +
         "' (for waveforms: cmake -D DTOF_TEST_WAVEFORMS=ON build/cpp)";
}

/// Compares a frame with the model by the scoreboard, for ASSERT_TRUE.
inline testing::AssertionResult agrees_with_model(RtlReadout& rtl, std::span<const ColumnStream> columns,
                                                  std::uint32_t acquisitions, const RtlRunOptions& options,
                                                  RtlFrame* frame = nullptr) {
  const std::string report = check_frame(rtl, columns, acquisitions, options, reproduce_command(), frame);
  if (report.empty()) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << report;
}

/// Default options, with the waveform file that the environment requests.
inline RtlRunOptions default_options(std::uint64_t seed) {
  RtlRunOptions options;
  options.seed = seed;
  if (const char* trace = std::getenv("DTOF_TRACE"); trace != nullptr) {
    options.trace = trace;
  }
  return options;
}

inline CounterRandom test_random(std::uint64_t seed, std::uint32_t a) {
  return {seed, static_cast<std::uint32_t>(RandomPurpose::kTestStream), a, 0};
}

/// Adversarial streams: each pixel has the next kind, beginning with `first_kind`.
inline std::vector<ColumnStream> adversarial_columns(const RtlConfiguration& configuration,
                                                     std::uint32_t acquisitions, std::size_t first_kind,
                                                     CounterRandom& random) {
  std::vector<ColumnStream> columns(static_cast<std::size_t>(configuration.sram_num));
  std::size_t kind = first_kind;
  for (ColumnStream& column : columns) {
    for (int row = 0; row < configuration.pixels_per_sram; ++row) {
      column.append_row(make_stream(kStreamKinds[kind % kStreamKinds.size()], configuration.parameters,
                                    acquisitions, random));
      ++kind;
    }
  }
  return columns;
}

/// Sets a random gate, sometimes an empty one, if the array has a time gate.
inline void move_gate(RtlReadout& rtl, CounterRandom& random) {
  const ReadoutParameters& parameters = rtl.configuration().parameters;
  if (parameters.time_gate) {
    rtl.set_time_gate({pick(random, parameters.code_count()), pick(random, parameters.code_count())});
  }
}

/// Column of one pixel with these timestamps, acquisition by acquisition; every slot is filled.
inline ColumnStream single_pixel(const std::vector<Timestamp>& timestamps, int slots) {
  ColumnStream column;
  for (std::size_t i = 0; i < timestamps.size(); ++i) {
    column.append({static_cast<std::uint32_t>(i / static_cast<std::size_t>(slots)), timestamps[i]});
  }
  column.finish_row();
  return column;
}

}  // namespace dtof
