// SPDX-License-Identifier: Apache-2.0
#include "command_line/options.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parameter_entry.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Parameters of the read-outs that a command line asks for.
std::vector<ReadoutParameters> parse(const std::string& arguments) {
  CLI::App app;
  ReadoutOptions options;
  options.add_to(app);
  app.parse(arguments);
  return options.parameters(kAllReadouts);
}

std::string option_of(std::string_view parameter) {
  std::string option(parameter);
  std::ranges::replace(option, '_', '-');
  std::ranges::transform(option, option.begin(), [](unsigned char c) { return std::tolower(c); });
  return "--" + option;
}

/// A legal value that is not the one in `parameters`.
int other_value(ReadoutParameters parameters, const ParameterEntry& entry) {
  const int own = entry.get(parameters);
  for (const int value : {own + 1, own - 1, 2 * own}) {
    entry.set(parameters, value);
    try {
      parameters.validate();
      return value;
    } catch (const InputError&) {
      continue;
    }
  }
  return own;
}

TEST(ReadoutOptions, EachChoiceOfEachReadOutIsAnOption) {
  int tried = 0;
  for (const Readout readout : kAllReadouts) {
    const ReadoutParameters defaults = default_parameters(readout, {});
    for (const ParameterEntry& entry : parameter_entries()) {
      if (!has_parameter(readout, entry.name)) {
        continue;
      }
      SCOPED_TRACE(fmt::format("{} {}", readout_name(readout), entry.name));
      const int value = other_value(defaults, entry);
      const std::string option = option_of(entry.name) + (entry.flag ? "" : fmt::format(" {}", value));
      const std::vector<ReadoutParameters> sets =
          parse(fmt::format("--readout {} {}", readout_name(readout), option));
      ASSERT_EQ(sets.size(), 1U);
      EXPECT_NE(value, entry.get(defaults));
      for (const ParameterEntry& other : parameter_entries()) {
        EXPECT_EQ(other.get(sets.front()), other.name == entry.name ? value : other.get(defaults))
            << other.name;
      }
      ++tried;
    }
  }
  EXPECT_GT(tried, 20);
}

TEST(ReadoutOptions, NpAndSlotsHoldForAllReadOuts) {
  for (const ReadoutParameters& parameters : parse("--np 9 --slots 3")) {
    EXPECT_EQ(parameters.np, 9);
    EXPECT_EQ(parameters.slots, 3);
  }
}

TEST(ReadoutOptions, AParameterThatNoChosenReadOutHasIsRefused) {
  EXPECT_THAT([] { (void)parse("--readout sifh --pointer-step 2"); },
              ThrowsMessage<InputError>(HasSubstr("--pointer-step has no effect: sifh has no POINTER_STEP")));
  EXPECT_EQ(parse("--readout sifh,ezpointer --pointer-step 2").back().pointer_step, 2);
}

TEST(ReadoutOptions, AReadOutThatIsNamedTwiceIsRefused) {
  EXPECT_THAT([] { (void)parse("--readout sifh,ezpointer,sifh"); },
              ThrowsMessage<InputError>(HasSubstr("--readout: sifh is named twice")));
  EXPECT_EQ(parse("--readout thesis,sifh").size(), 8U);
}

}  // namespace
}  // namespace dtof
