// SPDX-License-Identifier: Apache-2.0
// The compiled configurations hold every value listed here of every parameter with every kind of column: all
// in the program of the long lane, both ends and one between elsewhere (hold).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>
#include <set>
#include <string>

#include "tests/rtl/promised_values.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

using testing::IsSupersetOf;

// The column modules of the RTL.
enum class Kind : std::uint8_t { kEzPointer, kHisPointer, kInterframe, kPartitioned, kCoarseHistogram };

Kind kind_of(Readout readout) {
  switch (readout) {
    case Readout::kEzPointer:
      return Kind::kEzPointer;
    case Readout::kHisPointer1:
    case Readout::kHisPointer:
      return Kind::kHisPointer;
    case Readout::kPifh:
    case Readout::kHistogram:
      return Kind::kPartitioned;
    case Readout::kCoarseHistogram:
      return Kind::kCoarseHistogram;
    default:
      return Kind::kInterframe;
  }
}

std::string kind_test_name(const testing::TestParamInfo<Kind>& kind) {
  constexpr std::array<const char*, 5> kNames = {"EzPointer", "HisPointer", "Interframe", "Partitioned",
                                                 "CoarseHistogram"};
  return kNames[static_cast<std::size_t>(kind.param)];
}

class SweepCoverage : public testing::TestWithParam<Kind> {
 protected:
  [[nodiscard]] static std::set<int> values(const std::function<int(const RtlConfiguration&)>& field) {
    std::set<int> found;
    for (const RtlConfiguration& configuration : compiled_rtl_configurations()) {
      if (kind_of(configuration.parameters.readout) == GetParam()) {
        found.insert(field(configuration));
      }
    }
    return found;
  }
  static std::vector<int> range(int first, int last) {
    std::vector<int> all(static_cast<std::size_t>(last - first + 1));
    std::iota(all.begin(), all.end(), first);
    return all;
  }
};

INSTANTIATE_TEST_SUITE_P(Kinds, SweepCoverage,
                         testing::Values(Kind::kEzPointer, Kind::kHisPointer, Kind::kInterframe,
                                         Kind::kPartitioned, Kind::kCoarseHistogram),
                         kind_test_name);

TEST_P(SweepCoverage, EveryValueOccurs) {
  using C = RtlConfiguration;
  EXPECT_THAT(values([](const C& c) { return c.parameters.np; }), hold(range(4, 12)));
  EXPECT_THAT(values([](const C& c) { return c.pixels_per_sram; }), hold({1, 2, 3, 5, 7, 160}));
  EXPECT_THAT(values([](const C& c) { return c.sram_num; }), hold({1, 2, 3, 8}));
  EXPECT_THAT(values([](const C& c) { return c.parameters.slots; }), hold(range(1, 4)));
  EXPECT_THAT(values([](const C& c) { return c.parameters.time_gate ? 1 : 0; }), IsSupersetOf({0, 1}));
  if (GetParam() != Kind::kEzPointer) {
    EXPECT_THAT(values([](const C& c) { return c.parameters.nb; }), hold(range(1, 12)));
    EXPECT_THAT(values([](const C& c) { return c.parameters.np - c.parameters.nb; }), hold({0, 1, 2, 3}));
    EXPECT_THAT(values([](const C& c) { return c.parameters.count_width; }), hold(range(1, 12)));
    EXPECT_THAT(values([](const C& c) { return c.signalled_clear ? 1 : 0; }), IsSupersetOf({0, 1}));
  }
  if (GetParam() != Kind::kInterframe && GetParam() != Kind::kPartitioned) {
    EXPECT_THAT(values([](const C& c) { return c.parameters.fraction_bits; }), hold({0, 1, 2, 4}));
  }
  if (GetParam() == Kind::kEzPointer || GetParam() == Kind::kHisPointer) {
    EXPECT_THAT(values([](const C& c) { return c.parameters.pointer_step; }), hold({1, 2, 3, 5}));
    EXPECT_THAT(values([](const C& c) { return c.parameters.confidence_width; }), hold({0, 2, 4, 8}));
    EXPECT_THAT(values([](const C& c) { return c.pointer_ports; }), IsSupersetOf({1, 2}));
  }
  if (GetParam() == Kind::kInterframe) {
    EXPECT_THAT(values([](const C& c) { return c.parameters.window_centred ? 1 : 0; }), IsSupersetOf({0, 1}));
  }
}

TEST(SweepCoverage, EveryReadoutHasItsDefaultsAtFullSize) {
  for (const Readout readout : array_readouts()) {
    const RtlConfiguration configuration =
        find_rtl_configuration(ReadoutParameters::defaults(readout), 160, 200);
    EXPECT_EQ(configuration.pixels_per_sram, 160) << readout_name(readout);
  }
}

}  // namespace
}  // namespace dtof
