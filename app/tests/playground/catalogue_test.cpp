// SPDX-License-Identifier: Apache-2.0
#include "playground/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "dtof/core/readout.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(PlaygroundCatalogue, NamesWhatThereIs) {
  const std::string text = playground_catalogue();
  EXPECT_THAT(text, StartsWith("readout\tezpointer\tezPointer\t"));
  EXPECT_THAT(text, HasSubstr("\nreadout\tpoolpointer-lean\tpoolPointer lean\t"));
  EXPECT_THAT(text, HasSubstr("\nscene\troom\t"));
  EXPECT_THAT(text, HasSubstr("\nsensor\tphone\t200\t160\t0.5\t3333\t6.75\t10\t2\t45\t0.2998\n"));
  EXPECT_THAT(text, HasSubstr("\nfigure\tabove 3 %\n"));
  EXPECT_EQ(std::ranges::count(text, '\n'), std::ssize(kAllReadouts) + 9 + std::ssize(preset_names()) + 6);
}

}  // namespace
}  // namespace dtof
