// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/suggestion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace dtof {
namespace {

constexpr std::array<std::string_view, 4> kCommands = {"frame", "replay", "reproduce", "list"};

TEST(Suggestion, FindsTheNameThatOneOrTwoEditsAwayWasMeant) {
  EXPECT_EQ(nearest_name("fram", kCommands), "frame");
  EXPECT_EQ(nearest_name("frames", kCommands), "frame");
  EXPECT_EQ(nearest_name("frmae", kCommands), "frame");
  EXPECT_EQ(nearest_name("repaly", kCommands), "replay");
  EXPECT_EQ(nearest_name("reprdouec", kCommands), "reproduce");
  EXPECT_EQ(nearest_name("lsit", kCommands), "list");
}

TEST(Suggestion, FindsNothingForAnotherWord) {
  EXPECT_EQ(nearest_name("moon", kCommands), "");
  EXPECT_EQ(nearest_name("", kCommands), "");
  EXPECT_EQ(nearest_name("x", kCommands), "");
  EXPECT_EQ(nearest_name("frzzz", kCommands), "");
  EXPECT_EQ(nearest_name(std::string(1 << 20, 'f'), kCommands), "");
  EXPECT_EQ(nearest_name("frame", {}), "");
}

TEST(Suggestion, OfTwoNamesTakesTheNearer) {
  constexpr std::array<std::string_view, 2> kScenes = {"planes", "plane"};
  EXPECT_EQ(nearest_name("plan", kScenes), "plane");
  EXPECT_EQ(nearest_name("planess", kScenes), "planes");
}

TEST(Suggestion, TheSentenceNamesWhatIsKnown) {
  EXPECT_EQ(unknown_name("command", "fram", kCommands),
            "unknown command 'fram'; did you mean 'frame'? Known are frame, replay, reproduce, list");
  EXPECT_EQ(unknown_name("command", "moon", kCommands),
            "unknown command 'moon'; known are frame, replay, reproduce, list");
}

}  // namespace
}  // namespace dtof
