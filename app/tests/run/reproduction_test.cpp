// SPDX-License-Identifier: Apache-2.0
#include "run/reproduction.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>

namespace dtof {
namespace {

std::string rest_of(std::string_view command) {
  constexpr std::array<std::string_view, 3> kNames = {"--readout", "-r", "--columns"};
  return without_options(command, kNames);
}

TEST(WithoutOptions, OptionsGoWithTheirValues) {
  EXPECT_EQ(rest_of("dtof frame -r sifh --klux 3"), "dtof frame --klux 3");
  EXPECT_EQ(rest_of("dtof frame --klux 3 --readout sifh,fifh"), "dtof frame --klux 3");
  EXPECT_EQ(rest_of("dtof frame --readout=sifh -rfifh --columns=0-3 --rows 1"), "dtof frame --rows 1");
  EXPECT_EQ(rest_of("dtof product --columns-per-sram 3"), "dtof product --columns-per-sram 3");
}

TEST(WithoutOptions, OtherWordsStayQuoted) {
  const std::string quoted =
      R"(dtof frame --out 'a -r b' --depth 'it'\''s -r x' --map $'\374\' -r y\\' --rows 1)";
  EXPECT_EQ(rest_of(quoted), quoted);
  EXPECT_EQ(rest_of(R"(dtof frame --readout 'a \' --rows 1)"), "dtof frame --rows 1");
}

}  // namespace
}  // namespace dtof
