// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pool_evidence.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace dtof {
namespace {

// Eighths of a standard deviation that a significance stands for, by the bits that the group's word keeps.
constexpr std::array<int, 8> kWeights = {0, 13, 16, 20, 24, 29, 35, 64};
constexpr std::array<int, 4> kShortWeights = {0, 22, 32, 64};

// Margins of a sky: their mean and how steeply what is above it counts, by B >> 2.
struct SkyMargin {
  int mean;
  int shift;         // what is above counts 2^-shift
  int second_shift;  // and 2^-second_shift
};
constexpr std::array<SkyMargin, 10> kSky = {{{18, 2, 3},
                                             {10, 2, 3},
                                             {14, 2, 4},
                                             {22, 3, 4},
                                             {36, 3, 9},
                                             {64, 4, 6},
                                             {128, 4, 9},
                                             {200, 5, 6},
                                             {255, 5, 6},
                                             {255, 5, 6}}};
constexpr int kMostPooled = 127;
constexpr int kPerOwnMargin = 4;
constexpr int kClearMargin = 12;  // own margin from which the confidence has a least value: itself

constexpr std::uint32_t kShortFrame = 3333;
constexpr int kMostOffset = 31;
constexpr int kLeastVariance = 64;
constexpr int kFirstLevel = 12;   // eighth octaves of the square below which nothing is significant
constexpr int kPerMissing = 4;    // what a missing neighbour costs
constexpr int kSquareScale = 24;  // D is four times the height, V twice the variance's part

}  // namespace

int eighth_octaves(std::uint32_t x) {
  const int exponent = std::bit_width(x) - 1;
  return 8 * exponent + static_cast<int>(((std::uint64_t{x} << 3U) >> static_cast<unsigned>(exponent)) & 7U);
}

int significance_offset(std::uint32_t acquisitions) {
  return acquisitions <= kShortFrame
             ? 0
             : std::min((eighth_octaves(acquisitions) - eighth_octaves(kShortFrame)) >> 1, kMostOffset);
}

int significance(const PairSums& sums, const PairSums& before, const CandidatePeak& peak, int prior_weight,
                 int offset) {
  const std::size_t i = peak.pair;
  const bool has_low = i >= 4;
  const bool has_high = i + 4 < kCoarsePairs;
  const int low = has_low ? sums[i - 4] + sums[i - 3] : 0;
  const int high = has_high ? before[i + 3] + before[i + 4] : 0;
  const int around = !has_low ? 2 * high + (high >> 2) : !has_high ? 2 * low : low + high;
  const int height = 4 * (sums[i] - (peak.raised ? prior_weight : 0)) - around;
  if (height <= 0) {
    return 0;
  }
  const int variance = around + (around >> 3) + kLeastVariance;
  const int square = 2 * eighth_octaves(static_cast<std::uint32_t>(height)) -
                     eighth_octaves(static_cast<std::uint32_t>(variance)) - kSquareScale - offset -
                     kPerMissing * peak.missing;
  return std::clamp((square - kFirstLevel) >> 2, 0, kMostSignificance);
}

int kept_significance(int significance, int bits) {
  return bits == 3 ? significance : bits == 2 ? std::max(significance - 1, 0) >> 1 : 0;
}

int pool_confidence(int significance, int bits, const PooledMargin& margin, int background, bool tilted) {
  const auto z = static_cast<std::size_t>(significance);
  const int weight = std::min(bits == 3 ? kWeights[z] : kShortWeights[z], kPerOwnMargin * margin.own);
  const int least = margin.own >= kClearMargin ? kClearMargin : 0;
  if (tilted) {
    return std::max(weight, least);
  }
  const SkyMargin& sky = kSky[static_cast<std::size_t>(background >> 2)];
  const int above = std::max(margin.own + margin.others - sky.mean, 0);
  const int pooled = std::min((above >> sky.shift) + (above >> sky.second_shift), kMostPooled);
  return std::max(weight + pooled, least);
}

}  // namespace dtof
