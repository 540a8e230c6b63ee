// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace dtof {

inline constexpr std::size_t kLaneWords = 4;
/// Copies of a circuit that are simulated together, each with its own faults.
inline constexpr std::size_t kLanes = 64 * kLaneWords;

/// The value of one net in every lane: a bit per lane.
struct Lanes {
  std::array<std::uint64_t, kLaneWords> words{};

  static constexpr Lanes all(bool value) {
    Lanes lanes;
    lanes.words.fill(value ? ~std::uint64_t{0} : 0);
    return lanes;
  }
  static constexpr Lanes one(std::size_t lane) {
    Lanes lanes;
    lanes.set(lane, true);
    return lanes;
  }

  [[nodiscard]] constexpr bool get(std::size_t lane) const {
    return (words[lane / 64] >> (lane % 64) & 1U) != 0;
  }
  constexpr void set(std::size_t lane, bool value) {
    const std::uint64_t bit = std::uint64_t{1} << (lane % 64);
    words[lane / 64] = value ? words[lane / 64] | bit : words[lane / 64] & ~bit;
  }
  [[nodiscard]] constexpr bool any() const {
    std::uint64_t seen = 0;
    for (const std::uint64_t word : words) {
      seen |= word;
    }
    return seen != 0;
  }
  /// Calls `body(lane)` for every lane whose bit is set, in ascending order.
  template <typename Body>
  void for_each(const Body& body) const {
    for (std::size_t word = 0; word < kLaneWords; ++word) {
      for (std::uint64_t left = words[word]; left != 0; left &= left - 1) {
        body(64 * word + static_cast<std::size_t>(std::countr_zero(left)));
      }
    }
  }

  bool operator==(const Lanes&) const = default;
};

constexpr Lanes operator&(Lanes a, const Lanes& b) {
  for (std::size_t i = 0; i < kLaneWords; ++i) {
    a.words[i] &= b.words[i];
  }
  return a;
}
constexpr Lanes operator|(Lanes a, const Lanes& b) {
  for (std::size_t i = 0; i < kLaneWords; ++i) {
    a.words[i] |= b.words[i];
  }
  return a;
}
constexpr Lanes operator^(Lanes a, const Lanes& b) {
  for (std::size_t i = 0; i < kLaneWords; ++i) {
    a.words[i] ^= b.words[i];
  }
  return a;
}
constexpr Lanes operator~(Lanes a) {
  for (std::uint64_t& word : a.words) {
    word = ~word;
  }
  return a;
}
/// `high` where `select` is set, else `low`.
constexpr Lanes choose(const Lanes& select, const Lanes& high, const Lanes& low) {
  return (select & high) | (~select & low);
}

}  // namespace dtof
