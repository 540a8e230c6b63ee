// SPDX-License-Identifier: Apache-2.0
#include "playground/request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(PlaygroundRequest, SaysWhatItsLinesSay) {
  const PlaygroundRequest request = parse_playground_request(
      "scene flat\nsensor phone\ncolumns 20\nrows 10\ndistance 2.5\nreflectivity 0.3\nklux 20\n"
      "acquisitions 100\nseed 9007199254740991\nreadout sifh\nreadout fifh");
  EXPECT_EQ(request.scene, "flat");
  EXPECT_EQ(request.sensor, "phone");
  EXPECT_EQ(request.columns, 20);
  EXPECT_EQ(request.rows, 10);
  EXPECT_EQ(request.distance_m, 2.5);
  EXPECT_EQ(request.reflectivity, 0.3);
  EXPECT_EQ(request.klux, 20.0);
  EXPECT_EQ(request.acquisitions, 100U);
  EXPECT_EQ(request.seed, 9007199254740991U);
  EXPECT_THAT(request.readouts, ElementsAre("sifh", "fifh"));
  EXPECT_EQ(request.near_m, PlaygroundRequest().near_m);
}

TEST(PlaygroundRequest, RefusesWhatMakesNoSense) {
  for (const std::string line :
       {"colour red", "klux", "klux bright", "klux nan", "klux -1", "klux 201", "klux ", "seed 1.5",
        "seed -1", "seed 99999999999999999999", "columns 0", "acquisitions 65536"}) {
    EXPECT_THAT([&] { parse_playground_request("seed 1\n" + line); },
                ThrowsMessage<InputError>(HasSubstr(line.substr(0, line.find(' ')))))
        << line;
  }
}

}  // namespace
}  // namespace dtof
