// SPDX-License-Identifier: Apache-2.0
#include "command_line/truth_map.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/depth_image.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;
using testing::ThrowsMessage;

class TruthMap : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  void write(int width, int height, const std::vector<float>& metres) const {
    write_pfm(file_, {.width = width, .height = height, .metres = metres});
  }
  std::string file_ = std::filesystem::temp_directory_path() / fmt::format("dtof_truth_{}.pfm", getpid());
};

TEST_F(TruthMap, OfTheRecordingsSize) {
  write(3, 2, {1.0F, 2.0F, 3.0F, 4.0F, 0.0F, 6.0F});
  EXPECT_THAT(read_truth_map(file_, std::nullopt, 3, 2, Region::whole(3, 2)),
              ElementsAre(1.0, 2.0, 3.0, 4.0, IsNan(), 6.0));
  // A region does not move it.
  const Region region{.columns = {1}, .rows = {.first = 1, .count = 1}};
  EXPECT_THAT(read_truth_map(file_, 0.5, 3, 2, region), ElementsAre(0.5, 1.0, 1.5, 2.0, IsNan(), 3.0));
}

TEST_F(TruthMap, OfTheRegionsSize) {
  write(2, 1, {7.0F, 8.0F});
  const Region region{.columns = {0, 2}, .rows = {.first = 1, .count = 1}};
  EXPECT_THAT(read_truth_map(file_, std::nullopt, 3, 2, region),
              ElementsAre(IsNan(), IsNan(), IsNan(), 7.0, IsNan(), 8.0));
}

TEST_F(TruthMap, AnyOtherSizeIsRefusedInOneSentence) {
  write(2, 2, {1.0F, 1.0F, 1.0F, 1.0F});
  EXPECT_THAT(
      [&] { (void)read_truth_map(file_, std::nullopt, 3, 2, Region::whole(3, 2)); },
      ThrowsMessage<InputError>(file_ + ": the truth map has 2 x 2 pixels, but the recording has 3 x 2"));
  const Region region{.columns = {1}, .rows = {.first = 0, .count = 2}};
  EXPECT_THAT([&] { (void)read_truth_map(file_, std::nullopt, 3, 2, region); },
              ThrowsMessage<InputError>(HasSubstr("the recording has 3 x 2 and the region 1 x 2")));
  write(2, 1, {0.0F, std::nanf("")});
  EXPECT_THAT([&] { (void)read_truth_map(file_, std::nullopt, 2, 1, Region::whole(2, 1)); },
              ThrowsMessage<InputError>(HasSubstr("no pixel of the truth map has a distance")));
}

}  // namespace
}  // namespace dtof
