// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/lane_memory.hpp"

#include <gtest/gtest.h>

namespace dtof {
namespace {

constexpr std::uint32_t kDepth = 3;  // of the four words that two address bits select
constexpr std::size_t kOther = 200;  // a lane

/// A memory of three words of one bit. Nets 2 and 3: enables; 4, 5: read address; 6, 7: write address.
Memory small_memory(bool two_ports) {
  Memory memory;
  memory.two_ports = two_ports;
  memory.depth = kDepth;
  memory.read_enable = 2;
  memory.write_enable = 3;
  memory.read_address = {4, 5};
  memory.write_address = two_ports ? std::vector<Net>{6, 7} : memory.read_address;
  memory.read_data = {8};
  memory.write_data = {9};
  return memory;
}

class LaneMemoryTest : public testing::TestWithParam<bool> {
 protected:
  void access(bool read, int read_address, bool write, int write_address = 0, bool data = false) {
    values_[2] = Lanes::all(read || (write && !GetParam()));
    values_[3] = Lanes::all(write);
    const int shared = write && !GetParam() ? write_address : read_address;
    values_[4] = Lanes::all((shared & 1) != 0);
    values_[5] = Lanes::all((shared & 2) != 0);
    values_[6] = Lanes::all((write_address & 1) != 0);
    values_[7] = Lanes::all((write_address & 2) != 0);
    values_[9] = Lanes::all(data);
  }
  bool read(int address, std::size_t lane) {
    access(true, address, false);
    lanes_.clock(values_);
    return lanes_.read_data()[0].get(lane);
  }
  void write(int address, bool data) {
    access(false, 0, true, address, data);
    lanes_.clock(values_);
  }

  Memory memory_ = small_memory(GetParam());
  std::vector<Lanes> values_ = std::vector<Lanes>(10);
  LaneMemory lanes_{memory_, 1};
};
INSTANTIATE_TEST_SUITE_P(Ports, LaneMemoryTest, testing::Bool());

TEST_P(LaneMemoryTest, KeepsWhatIsWritten) {
  write(0, true);
  write(1, false);
  write(2, true);
  EXPECT_TRUE(read(0, 0) && read(0, kOther) && read(2, kOther));
  EXPECT_FALSE(read(1, 0) || read(1, kOther));
}

TEST_P(LaneMemoryTest, AnAddressOfOneLaneAlone) {
  write(0, false);
  write(1, true);
  access(true, 0, false);
  values_[4].set(kOther, true);
  lanes_.clock(values_);
  EXPECT_FALSE(lanes_.read_data()[0].get(0));
  EXPECT_TRUE(lanes_.read_data()[0].get(kOther));
  access(false, 0, true, 0, true);
  values_[GetParam() ? 6 : 4].set(kOther, true);
  values_[9].set(kOther, false);
  lanes_.clock(values_);
  EXPECT_TRUE(read(0, 0) && read(1, 0));
  EXPECT_FALSE(read(0, kOther) || read(1, kOther));
}

TEST(LaneMemory, OnlyPartsWithTheirEnableAreWritten) {
  // One word of four bits in two parts. Nets 2: enable of the port, 3: write, 4, 5: enables of the parts.
  Memory memory;
  memory.two_ports = false;
  memory.depth = 1;
  memory.read_enable = 2;
  memory.write_enable = 3;
  memory.write_parts = {4, 5};
  memory.read_data = {6, 7, 8, 9};
  memory.write_data = {10, 11, 12, 13};
  std::vector<Lanes> values(14);
  LaneMemory lanes(memory, 1);
  const auto write = [&](bool lower, bool upper, bool data) {
    values[2] = values[3] = Lanes::all(true);
    values[4] = Lanes::all(lower);
    values[5] = Lanes::all(upper);
    for (std::size_t net = 10; net < 14; ++net) {
      values[net] = Lanes::all(data);
    }
    lanes.clock(values);
    values[3] = Lanes::all(false);
    lanes.clock(values);
  };
  write(true, true, false);
  write(false, true, true);
  for (std::size_t bit = 0; bit < 4; ++bit) {
    EXPECT_EQ(lanes.read_data()[bit].get(0), bit >= 2) << bit;
  }
}

TEST_P(LaneMemoryTest, AFlipIsOverwrittenAndAStuckBitIsNot) {
  write(0, false);
  write(1, false);
  lanes_.flip(0, kOther);
  lanes_.stick(1, kOther, true);
  EXPECT_TRUE(read(0, kOther) && read(1, kOther));
  EXPECT_FALSE(read(0, 0) || read(1, 0));
  write(0, false);
  write(1, false);
  EXPECT_FALSE(read(0, kOther));
  EXPECT_TRUE(read(1, kOther));
}

TEST_P(LaneMemoryTest, AnAddressBeyondTheDepthChangesNothing) {
  write(0, true);
  EXPECT_TRUE(read(0, 0));
  write(3, false);
  EXPECT_TRUE(read(3, 0)) << "shows the word before";
  EXPECT_TRUE(read(0, 0));
}

TEST_P(LaneMemoryTest, AWordThatIsReadWhileItIsWrittenIsShownInverted) {
  if (!GetParam()) {
    GTEST_SKIP() << "a single port cannot";
  }
  write(1, true);
  access(true, 1, true, 1, true);
  lanes_.clock(values_);
  EXPECT_FALSE(lanes_.read_data()[0].get(0));
}

}  // namespace
}  // namespace dtof
