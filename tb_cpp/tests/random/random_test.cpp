// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "random/check.hpp"
#include "random/draw.hpp"

namespace dtof {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(DrawnConfiguration, IsLegalAndTheSameAgain) {
  std::set<std::string> texts;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const RtlConfiguration configuration = drawn_configuration(5, i);
    ASSERT_NO_THROW(configuration.parameters.validate()) << configuration.to_string();
    EXPECT_EQ(drawn_configuration(5, i).to_string(), configuration.to_string());
    texts.insert(configuration.to_string());
  }
  EXPECT_GT(texts.size(), 1800U);
  EXPECT_NE(drawn_configuration(6, 0).to_string(), drawn_configuration(5, 0).to_string());
}

TEST(DrawnConfiguration, ReachesEveryReadoutAndTheEndsOfTheRanges) {
  std::set<Readout> readouts;
  std::set<int> np;
  std::set<int> pool_np;
  std::set<int> slots;
  std::set<int> labels;
  std::set<int> cell_shifts;
  bool several_engines = false;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const RtlConfiguration c = drawn_configuration(1, i);
    const bool pool = is_pool_readout(c.parameters.readout);
    readouts.insert(c.parameters.readout);
    (pool ? pool_np : np).insert(c.parameters.np);
    slots.insert(c.parameters.slots);
    if (pool) {
      labels.insert(c.parameters.pool.labels);
      cell_shifts.insert(c.parameters.pool.cell_shift);
      several_engines = several_engines || c.sram_num > c.parameters.pool.engine_columns;
    }
  }
  EXPECT_EQ(readouts.size(), kRtlReadouts.size());
  EXPECT_EQ(np.size(), 14U);
  EXPECT_EQ(pool_np.size(), 9U);
  EXPECT_EQ(slots.size(), 16U);
  EXPECT_EQ(labels.size(), 7U);
  EXPECT_EQ(cell_shifts.size(), 3U);
  EXPECT_TRUE(several_engines);
}

class DrawnArray : public testing::Test {
 protected:
  DrawnArray()
      : folder_(std::filesystem::temp_directory_path() / fmt::format("dtof_random_test_{}", getpid())) {
    setenv("DTOF_CACHE", folder_.c_str(), 1);
  }
  ~DrawnArray() override { std::filesystem::remove_all(folder_); }
  DrawnArray(const DrawnArray&) = delete;
  DrawnArray& operator=(const DrawnArray&) = delete;
  DrawnArray(DrawnArray&&) = delete;
  DrawnArray& operator=(DrawnArray&&) = delete;

 private:
  std::filesystem::path folder_;
};

TEST_F(DrawnArray, OfAReadoutOfTheThesisAndOfAPoolReadoutIsItsModels) {
  for (const std::uint32_t index : {2U, 9U}) {
    const ArrayCheck check = check_array(drawn_configuration(1, index), 1, "again");
    EXPECT_EQ(check.difference, "");
    EXPECT_EQ(check.frames, 7);
    EXPECT_GT(check.results, 0U);
  }
}

TEST(DrawnNetlist, HasFewStatusBits) {
  int without = 0;
  for (std::uint32_t index = 0; index < 300; ++index) {
    const RtlConfiguration drawn = drawn_configuration(3, index);
    const RtlConfiguration netlist = netlist_configuration(drawn);
    const ReadoutParameters& p = drawn.parameters;
    if (p.readout == Readout::kHistogram && drawn.signalled_clear) {
      EXPECT_EQ(netlist.signalled_clear, 3 << p.np <= kMostStatusBits) << drawn.to_string();
    }
    if (p.readout == Readout::kThreeSteps || p.readout == Readout::kEzPointer) {
      EXPECT_EQ(netlist.signalled_clear, drawn.signalled_clear) << "at most 48 bits";
    }
    without += netlist.signalled_clear ? 0 : 1;
    EXPECT_EQ(netlist.parameters, drawn.parameters);
  }
  EXPECT_GT(without, 100);
  EXPECT_LT(without, 290);
}

TEST_F(DrawnArray, WithAFaultIsDescribed) {
  std::vector<SourceFile> sources(project_sources().begin(), project_sources().end());
  const auto update = std::ranges::find(sources, "hdl/thesis/dtof_pointer_update.sv", &SourceFile::path);
  ASSERT_NE(update, sources.end());
  std::string broken(update->text);
  const std::string_view right = "left ? down : up";
  broken.replace(broken.find(right), right.size(), "left ? up : down");
  update->text = broken;
  const ArrayCheck check = check_array(drawn_configuration(1, 0), 1, "the command", sources);
  EXPECT_THAT(check.difference, AllOf(HasSubstr("pixels differ between RTL and model"),
                                      HasSubstr("ezpointer NP="), HasSubstr("reproduce  the command")));
}

}  // namespace
}  // namespace dtof
