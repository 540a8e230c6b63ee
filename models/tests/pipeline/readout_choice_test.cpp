// SPDX-License-Identifier: Apache-2.0
#include "dtof/pipeline/readout_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;

std::string refusal(Readout readout, std::string_view name, int value) {
  try {
    ReadoutParameters parameters = ReadoutParameters::defaults(readout);
    set_parameter(parameters, name, value);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ReadoutChoice, NamesAreThoseOfReadoutsToml) {
  EXPECT_THAT(parameter_names(Readout::kSifh),
              ElementsAre("NP", "SLOTS", "NB", "COUNT_WIDTH", "WINDOW_CENTRED"));
  EXPECT_THAT(parameter_names(Readout::kPoolPointer),
              ElementsAre("NP", "SLOTS", "COUNT_WIDTH", "GROUP_SIZE", "LABELS", "SCORE_BITS", "CELL_SHIFT",
                          "ENGINE_COLUMNS"));
}

TEST(ReadoutChoice, WhatIsSetIsThereAndNothingElseChanges) {
  for (const Readout readout : kAllReadouts) {
    for (const std::string_view name : parameter_names(readout)) {
      ReadoutParameters parameters = ReadoutParameters::defaults(readout);
      const int value = name == "WINDOW_CENTRED" ? 1 : get_parameter(parameters, name) + 1;
      set_parameter(parameters, name, value);
      for (const std::string_view other : parameter_names(readout)) {
        const int expected =
            other == name ? value : get_parameter(ReadoutParameters::defaults(readout), other);
        EXPECT_EQ(get_parameter(parameters, other), expected) << readout_name(readout) << ' ' << name;
      }
    }
  }
}

TEST(ReadoutChoice, AParameterOfAnotherReadoutIsRefusedWithThoseThatItHas) {
  EXPECT_EQ(refusal(Readout::kFifh, "POINTER_STEP", 2),
            "fifh has no parameter POINTER_STEP; it has NP, SLOTS, NB, COUNT_WIDTH");
  EXPECT_EQ(refusal(Readout::kFifh, "nb", 2), "fifh has no parameter nb; it has NP, SLOTS, NB, COUNT_WIDTH");
  EXPECT_EQ(refusal(Readout::kSifh, "WINDOW_CENTRED", 2), "WINDOW_CENTRED must be 0 or 1, is 2");
}

}  // namespace
}  // namespace dtof
