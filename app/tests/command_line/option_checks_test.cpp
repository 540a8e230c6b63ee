// SPDX-License-Identifier: Apache-2.0
#include "command_line/option_checks.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

TEST(NumberError, TakesWhatTheTypeHolds) {
  for (const char* number : {"0", "-1.5", "+2", "1e-3", "1e300"}) {
    EXPECT_EQ(number_error(number, "FLOAT"), "") << number;
  }
  for (const char* number : {"0", "-7", "+7", "123"}) {
    EXPECT_EQ(number_error(number, "INT:INT in [0 - 9]"), "") << number;
  }
  EXPECT_EQ(number_error("18446744073709551615", "UINT"), "");
  EXPECT_EQ(number_error("anything", "TEXT"), "");
}

TEST(NumberError, SaysWhatIsWrong) {
  for (const char* text : {"", "abc", "1x", " 1", "nan", "inf", "-inf", "1,5", "--1", "+"}) {
    EXPECT_EQ(number_error(text, "FLOAT"), "'" + std::string(text) + "' is not a number");
  }
  EXPECT_EQ(number_error("1e400", "FLOAT"), "'1e400' is too large or too small a number");
  for (const char* text : {"", "abc", "1.5", "1e3", "0x10", "-", "+"}) {
    EXPECT_EQ(number_error(text, "INT"), "'" + std::string(text) + "' is not a whole number");
  }
  EXPECT_EQ(number_error("-1", "UINT"), "'-1' is negative");
  EXPECT_EQ(number_error("18446744073709551616", "UINT"), "'18446744073709551616' is too large");
  EXPECT_EQ(number_error("010", "INT"), "'010' begins with 0; write a decimal number without");
  EXPECT_EQ(number_error("-01", "INT"), "'-01' begins with 0; write a decimal number without");
}

TEST(Within, BothEndsAreLegal) {
  const CLI::Validator validator = within(0.0, 2.0, "2: reason");
  const auto error = [&](std::string text) { return validator(text); };
  EXPECT_EQ(error("0"), "");
  EXPECT_EQ(error("2"), "");
  EXPECT_EQ(error("2.001"), "2.001 is not within 0 to 2: reason");
  EXPECT_EQ(error("-0.1"), "-0.1 is not within 0 to 2: reason");
  EXPECT_EQ(error("x"), "'x' is not a number");
}

TEST(AboveZero, NamesTheNumber) {
  const auto error = [](const CLI::Validator& validator, std::string text) { return validator(text); };
  EXPECT_EQ(error(above_zero(), "1e-300"), "");
  EXPECT_EQ(error(above_zero(), "0"), "0 is not above 0");
  EXPECT_EQ(error(above_zero(), "-2"), "-2 is not above 0");
  EXPECT_EQ(error(above_zero(), "x"), "'x' is not a number");
  EXPECT_EQ(error(not_negative(), "0"), "");
  EXPECT_EQ(error(not_negative(), "-2"), "-2 is negative");
}

TEST(SensibleBudget, HasEnds) {
  const auto error = [](const CLI::Validator& validator, std::string text) { return validator(text); };
  for (const char* rate : {"0.001", "30", "1000000"}) {
    EXPECT_EQ(error(sensible_frame_rate(), rate), "");
  }
  EXPECT_EQ(error(sensible_frame_rate(), "1e-300"), "1e-300 is not within 0.001 to 1000000 frames/s");
  EXPECT_EQ(error(sensible_clock_mhz(), "100000"), "");
  EXPECT_EQ(error(sensible_clock_mhz(), "1e308"), "1e308 is not within 0.001 to 100000 MHz");
}

TEST(CheckNumbers, MinusZeroIsZero) {
  CLI::App app;
  double real = 1.0;
  unsigned whole = 1;
  std::vector<double> several;
  app.add_option("--real", real);
  app.add_option_group("group")->add_option("--whole", whole);
  app.add_option("--several", several);
  check_numbers(app);
  app.parse("--real -0.0 --whole -0 --several -1 -0e3 2");
  EXPECT_FALSE(std::signbit(real));
  EXPECT_EQ(whole, 0U);
  ASSERT_EQ(several.size(), 3U);
  EXPECT_EQ(several[0], -1.0);
  EXPECT_FALSE(std::signbit(several[1]));
}

TEST(RefuseWithoutEffect, OnlyOptionsThatWereGiven) {
  CLI::App app;
  int value = 0;
  app.add_option_group("group")->add_option("--steps", value);
  app.parse("");
  EXPECT_NO_THROW(refuse_without_effect(app, "--steps", "reason"));
  app.parse("--steps 3");
  try {
    refuse_without_effect(app, "--steps", "reason");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--steps has no effect: reason");
  }
}

}  // namespace
}  // namespace dtof
