// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_effect.hpp"

#include <gtest/gtest.h>

namespace dtof {
namespace {

constexpr std::uint32_t kAcquisitions = 200;

std::size_t index_of(PixelPlace pixel) {
  return static_cast<std::size_t>(pixel.row) * kFaultColumns + static_cast<std::size_t>(pixel.column);
}

class Effect : public testing::Test {
 protected:
  FaultScene scene_ = make_fault_scene(kAcquisitions, 1);
  FaultSubject subject_{Readout::kHistogram, scene_};
  std::vector<PixelResult> actual_ = subject_.expected();
};

TEST_F(Effect, NothingChangesWithoutAFault) {
  const FaultReach reach{{0, kFaultColumns}, std::nullopt};
  const FaultEffect effect = fault_effect(subject_, actual_, reach);
  EXPECT_EQ(effect.pixels, kFaultColumns * kFaultRows);
  EXPECT_EQ(effect.changed, 0);
  EXPECT_EQ(effect.largest_m, 0.0);
  EXPECT_EQ(changed_elsewhere(subject_, actual_, {}), 0);
}

// One bin is 6.6 mm; 3 % of the room's distances are 24 to 150 mm.
TEST_F(Effect, CountsWhatChangesWhatMovesAndWhatMovesFar) {
  actual_[index_of({2, 0})].confidence ^= 1;
  actual_[index_of({2, 1})].code ^= 1;
  actual_[index_of({2, 2})].code ^= 512;
  const FaultEffect effect = fault_effect(subject_, actual_, {{2, 1}, std::nullopt});
  EXPECT_EQ(effect.pixels, kFaultRows);
  EXPECT_EQ(effect.changed, 3);
  EXPECT_EQ(effect.moved, 2);
  EXPECT_EQ(effect.beyond, 1);
  EXPECT_NEAR(effect.largest_m, 512 * 6.587e-3, 0.01);
}

TEST_F(Effect, TheFaultyPixelItselfDoesNotCount) {
  actual_[index_of({2, 5})].code ^= 512;
  const FaultReach reach{{2, 1}, PixelPlace{2, 5}};
  EXPECT_EQ(fault_effect(subject_, actual_, reach).changed, 0);
  EXPECT_EQ(changed_elsewhere(subject_, actual_, std::vector{reach}), 0);
}

TEST_F(Effect, APixelOfAnotherColumnIsSeen) {
  actual_[index_of({3, 5})].confidence ^= 1;
  const FaultReach reach{{2, 1}, std::nullopt};
  EXPECT_EQ(fault_effect(subject_, actual_, reach).changed, 0);
  EXPECT_EQ(changed_elsewhere(subject_, actual_, std::vector{reach}), 1);
}

}  // namespace
}  // namespace dtof
