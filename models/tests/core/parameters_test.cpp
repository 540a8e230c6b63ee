// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/parameters.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(ParameterDefaults, AreThoseOfTheRtl) {
  const ReadoutParameters readout;
  EXPECT_EQ(readout.np, 10);
  EXPECT_EQ(readout.nb, 5);
  EXPECT_EQ(readout.slots, 2);
  EXPECT_EQ(readout.count_width, 10);
  EXPECT_EQ(readout.pointer_step, 1);
  EXPECT_EQ(readout.fraction_bits, 0);
  EXPECT_EQ(readout.confidence_width, 4);
  EXPECT_EQ(readout.guard, 46);
  EXPECT_FALSE(readout.window_centred);
  EXPECT_FALSE(readout.time_gate);
  const PoolPointerParameters pool;
  EXPECT_EQ(pool, PoolPointerParameters::defaults(Readout::kPoolPointer));
  EXPECT_EQ(pool.group_size, 4);
  EXPECT_EQ(pool.labels, 5);
  EXPECT_EQ(pool.score_bits, 4);
  EXPECT_EQ(pool.offset_bits, 6);
  EXPECT_EQ(pool.count_bits, 7);
  EXPECT_EQ(pool.pointer_shift, 1);
  EXPECT_TRUE(pool.rival_moves);
  EXPECT_EQ(pool.coarse_share, 14);
  EXPECT_EQ(pool.track_share, 30);
}

TEST(ReadoutNames, RoundTripAndUnique) {
  std::set<std::string_view> titles;
  for (const Readout readout : kAllReadouts) {
    EXPECT_EQ(parse_readout(readout_name(readout)), readout);
    EXPECT_FALSE(readout_summary(readout).empty());
    titles.insert(readout_title(readout));
  }
  EXPECT_EQ(titles.size(), kAllReadouts.size());
}

TEST(ReadoutNames, UnknownNameListsTheKnownOnes) {
  EXPECT_THAT([] { parse_readout("sihf"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("unknown read-out 'sihf'"), HasSubstr("ezpointer"),
                                              HasSubstr("sifh"), HasSubstr("histogram"))));
  EXPECT_THROW(parse_readout(""), InputError);
  EXPECT_THROW(parse_readout("SiFH"), InputError);
}

TEST(ReadoutNames, PointerReadouts) {
  for (const Readout readout : kAllReadouts) {
    const bool expected =
        std::string(readout_name(readout)).find("pointer") != std::string::npos && !is_pool_readout(readout);
    EXPECT_EQ(is_pointer_readout(readout), expected) << readout_name(readout);
  }
}

TEST(ReadoutNames, EveryReadoutHasItsOwn) {
  std::set<std::string_view> names;
  for (const Readout readout : kAllReadouts) {
    EXPECT_EQ(parse_readout(readout_name(readout)), readout);
    EXPECT_FALSE(readout_title(readout).empty());
    EXPECT_FALSE(readout_summary(readout).empty());
    names.insert(readout_name(readout));
    const bool thesis = std::ranges::find(kThesisReadouts, readout) != kThesisReadouts.end();
    EXPECT_FALSE(is_pool_readout(readout) && thesis);
    EXPECT_EQ(has_rtl(readout), std::ranges::find(kRtlReadouts, readout) != kRtlReadouts.end());
    EXPECT_FALSE(is_pool_readout(readout) && is_pointer_readout(readout));
  }
  EXPECT_EQ(names.size(), kAllReadouts.size());
  EXPECT_EQ(parse_readout("poolpointer"), Readout::kPoolPointer);
  EXPECT_EQ(parse_readout("poolpointer-lean"), Readout::kPoolPointerLean);
}

TEST(ReadoutParameters, DefaultsOfTheSpecification) {
  const auto nb = [](Readout readout) { return ReadoutParameters::defaults(readout).nb; };
  EXPECT_EQ(nb(Readout::kSifh), 6);
  EXPECT_EQ(nb(Readout::kFifh), 5);
  EXPECT_EQ(nb(Readout::kHisPointer1), 5);
  EXPECT_EQ(nb(Readout::kHisPointer), 5);
  EXPECT_EQ(nb(Readout::kHistogram), 10);
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHisPointer);
  EXPECT_EQ(parameters.np, 10);
  EXPECT_EQ(parameters.slots, 2);
  EXPECT_EQ(parameters.count_width, 10);
  EXPECT_EQ(parameters.pointer_step, 1);
  EXPECT_EQ(parameters.fraction_bits, 0);
  EXPECT_EQ(parameters.guard, 46);
  EXPECT_FALSE(parameters.window_centred);
  EXPECT_EQ(parameters.code_count(), 1024);
  EXPECT_EQ(parameters.no_detection(), 1023);
}

TEST(ReadoutParameters, DefaultsAreLegalForEveryWidth) {
  for (const Readout readout : kAllReadouts) {
    const int fewest = is_pool_readout(readout) ? 8 : 3;
    for (int np = 3; np <= 16; ++np) {
      SCOPED_TRACE(fmt::format("{} {}", readout_name(readout), np));
      const ReadoutParameters parameters = ReadoutParameters::defaults(readout, np);
      if (np < fewest) {
        EXPECT_THROW(parameters.validate(), InputError);
      } else {
        EXPECT_NO_THROW(parameters.validate());
      }
    }
  }
}

TEST(ReadoutParameters, RefusesTimestampsOfOtherWidthsBeforeAnyArithmetic) {
  for (const int np : {-1, 0, 2, 17, 100, 1 << 30}) {
    EXPECT_THROW((void)ReadoutParameters::defaults(Readout::kSifh, np), InputError) << np;
  }
}

TEST(ReadoutParameters, AReadoutHasTheParametersThatItsTextNames) {
  for (const Readout readout : kAllReadouts) {
    const std::string text = ReadoutParameters::defaults(readout).to_string();
    for (const char* name : {"NB", "COUNT_WIDTH", "POINTER_STEP", "FRACTION_BITS", "CONFIDENCE_WIDTH",
                             "GUARD", "WINDOW_CENTRED"}) {
      EXPECT_EQ(has_parameter(readout, name), text.find(fmt::format(" {}=", name)) != std::string::npos)
          << text << ' ' << name;
    }
    EXPECT_FALSE(has_parameter(readout, "NP_"));
  }
  EXPECT_TRUE(has_parameter(Readout::kHisPointer, "GUARD"));
  EXPECT_FALSE(has_parameter(Readout::kHisPointer1, "GUARD"));
}

TEST(ReadoutParameters, RangesAreInclusive) {
  const auto legal = [](int ReadoutParameters::*member, int value) {
    ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHisPointer, 10);
    parameters.*member = value;
    try {
      parameters.validate();
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  struct Range {
    int ReadoutParameters::*member;
    int lowest;
    int highest;
  };
  const std::vector<Range> ranges = {{&ReadoutParameters::nb, 1, 10},
                                     {&ReadoutParameters::count_width, 1, 16},
                                     {&ReadoutParameters::pointer_step, 1, 511},
                                     {&ReadoutParameters::fraction_bits, 0, 6},
                                     {&ReadoutParameters::confidence_width, 0, 8}};
  for (const Range& range : ranges) {
    EXPECT_FALSE(legal(range.member, range.lowest - 1));
    EXPECT_TRUE(legal(range.member, range.lowest));
    EXPECT_TRUE(legal(range.member, range.highest));
    EXPECT_FALSE(legal(range.member, range.highest + 1));
  }
  EXPECT_FALSE(legal(&ReadoutParameters::slots, 0));
  EXPECT_TRUE(legal(&ReadoutParameters::slots, 4));
  EXPECT_FALSE(legal(&ReadoutParameters::guard, -1));
  EXPECT_FALSE(legal(&ReadoutParameters::np, 17));
}

TEST(ReadoutParameters, TextHoldsWhatTheReadoutUses) {
  EXPECT_EQ(ReadoutParameters::defaults(Readout::kSifh).to_string(),
            "sifh NP=10 SLOTS=2 NB=6 COUNT_WIDTH=10 WINDOW_CENTRED=0");
  EXPECT_EQ(ReadoutParameters::defaults(Readout::kEzPointer).to_string(),
            "ezpointer NP=10 SLOTS=2 POINTER_STEP=1 FRACTION_BITS=0 CONFIDENCE_WIDTH=4");
  EXPECT_EQ(ReadoutParameters::defaults(Readout::kHisPointer).to_string(),
            "hispointer NP=10 SLOTS=2 NB=5 COUNT_WIDTH=10 POINTER_STEP=1 FRACTION_BITS=0 CONFIDENCE_WIDTH=4 "
            "GUARD=46");
  EXPECT_EQ(ReadoutParameters::defaults(Readout::kHistogram, 8).to_string(),
            "histogram NP=8 SLOTS=2 COUNT_WIDTH=10");
}

}  // namespace
}  // namespace dtof
