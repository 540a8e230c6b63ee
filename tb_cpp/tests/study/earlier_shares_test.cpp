// SPDX-License-Identifier: Apache-2.0
#include "study/earlier_shares.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class EarlierSharesFile : public testing::Test {
 public:
  EarlierSharesFile(const EarlierSharesFile&) = delete;
  EarlierSharesFile& operator=(const EarlierSharesFile&) = delete;
  EarlierSharesFile(EarlierSharesFile&&) = delete;
  EarlierSharesFile& operator=(EarlierSharesFile&&) = delete;

 protected:
  EarlierSharesFile() = default;
  ~EarlierSharesFile() override { std::filesystem::remove(path_); }

  [[nodiscard]] EarlierShares read(const std::string& lines) const {
    std::ofstream(path_) << "klux,scene,estimator,above_3_percent,above_3_percent_low,above_3_percent_high\n"
                         << lines;
    return EarlierShares(path_);
  }

  std::filesystem::path path_ = std::filesystem::path(testing::TempDir()) / "before.csv";
};

TEST_F(EarlierSharesFile, HasSharesByLightAndScene) {
  const EarlierShares before = read("2,room,old,0.1,0.05,0.2\n14,room,old,0.3,0.2,0.4\n14,poles,old,,,\n");
  EXPECT_EQ(before.estimator(), "old");
  ASSERT_TRUE(before.share(14.0, "room", "above_3_percent"));
  EXPECT_EQ(before.share(14.0, "room", "above_3_percent")->value, 0.3);
  EXPECT_EQ(before.share(2.0, "room", "above_3_percent")->interval.low, 0.05);
  EXPECT_EQ(before.share(2.0, "room", "above_3_percent")->interval.high, 0.2);
  EXPECT_FALSE(before.share(14.0, "poles", "above_3_percent")) << "no such pixels";
  EXPECT_FALSE(before.share(50.0, "room", "above_3_percent"));
  EXPECT_FALSE(before.share(2.0, "poles", "above_3_percent"));
}

TEST_F(EarlierSharesFile, RefusesWhatItCannotCompare) {
  EXPECT_THAT([&] { (void)read("2,room,old,0.1,0,1\n2,room,new,0.1,0,1\n"); },
              ThrowsMessage<InputError>(HasSubstr("one estimator is expected, not old and new")));
  const EarlierShares before = read("2,room,old,0.1,x,0.2\n");
  EXPECT_THAT([&] { (void)before.share(2.0, "room", "above_3_percent"); },
              ThrowsMessage<InputError>(HasSubstr("column above_3_percent: 'x' is no number")));
  EXPECT_THAT([&] { (void)before.share(2.0, "room", "above_10_percent"); },
              ThrowsMessage<InputError>(HasSubstr("no column is called 'above_10_percent'")));
}

}  // namespace
}  // namespace dtof
