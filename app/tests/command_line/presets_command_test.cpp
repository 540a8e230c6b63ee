// SPDX-License-Identifier: Apache-2.0
// Every preset as a user meets it.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "dtof/core/parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "tests/io/io_test_support.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::HasSubstr;
using ::testing::Not;

class PresetsCommand : public test::IoTest {
 protected:
  [[nodiscard]] Outcome dtof(const std::string& arguments) const {
    return run_shell(fmt::format("cd '{}' && {} {}", path("").string(), DTOF_PROGRAM, arguments));
  }
};

TEST_F(PresetsCommand, EveryPresetIsListedWithItsRates) {
  const std::string list = dtof("list").output;
  for (const std::string_view name : preset_names()) {
    const SensorModel sensor = parse_preset(name);
    EXPECT_THAT(
        list, HasSubstr(fmt::format(
                  "  {:<16} {:.3f} signal events, {:.3f} background events, {} acquisitions", name,
                  sensor.signal_events(1.0, 1.0), sensor.background_events(14.0, 1.0), sensor.acquisitions)));
  }
  EXPECT_THAT(list, HasSubstr("light assumed (dtof sensor tmf8829)"));
  EXPECT_THAT(list, Not(HasSubstr("(dtof sensor thesis)")));
}

TEST_F(PresetsCommand, EveryPresetIsReadOutByEveryModel) {
  for (const std::string_view name : preset_names()) {
    const Outcome outcome =
        dtof(fmt::format("frame --sensor {0} --array-columns 4 --array-rows 6 --table none --out {0}", name));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    for (const Readout readout : kAllReadouts) {
      EXPECT_TRUE(
          std::filesystem::exists(path(std::string(name)) / fmt::format("{}.csv", readout_name(readout))))
          << name << ", " << readout_name(readout);
    }
  }
}

}  // namespace
}  // namespace dtof
