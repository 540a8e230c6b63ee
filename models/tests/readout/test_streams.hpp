// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/random.hpp"

namespace dtof {

/// Streams of one pixel that are difficult for a read-out.
enum class StreamKind : int {
  kUniform,       ///< any code, any number of slots filled
  kSameInSlots,   ///< all slots of an acquisition hold the same code
  kPingPong,      ///< either side of mid-range and opposite points in turn
  kExtremes,      ///< codes 0, 1, M - 2 and the no-detection code
  kNoDetection,   ///< only the no-detection code
  kConstant,      ///< one code in every slot: counters saturate
  kTies,          ///< few codes, equally often
  kBellAtEnds,    ///< a bell across code 0 or M - 1, wrapped
  kBellAtBorder,  ///< a bell centred on the border of a coarse bin, over background
};

inline constexpr std::array<StreamKind, 9> kStreamKinds = {
    StreamKind::kUniform,  StreamKind::kSameInSlots, StreamKind::kPingPong,
    StreamKind::kExtremes, StreamKind::kNoDetection, StreamKind::kConstant,
    StreamKind::kTies,     StreamKind::kBellAtEnds,  StreamKind::kBellAtBorder};

inline std::string_view stream_name(StreamKind kind) {
  constexpr std::array<std::string_view, kStreamKinds.size()> kNames = {
      "uniform",  "same in slots", "ping-pong",    "extremes",      "no detection",
      "constant", "ties",          "bell at ends", "bell at border"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// Uniform integer 0 .. count - 1 (the bias of the remainder does not matter for tests).
inline int pick(CounterRandom& random, int count) {
  return static_cast<int>(random() % static_cast<std::uint32_t>(count));
}

inline std::vector<Detection> make_stream(StreamKind kind, const ReadoutParameters& parameters,
                                          std::uint32_t acquisitions, CounterRandom& random) {
  const int codes = parameters.code_count();
  const int constant = pick(random, codes - 1);
  const int coarse_bin = std::max(codes >> parameters.nb, 1);
  const int border = pick(random, codes / coarse_bin) * coarse_bin;
  const int end = pick(random, 2) * (codes - 1);
  const double width = 1.0 + 0.02 * codes;
  const auto bell = [&](int centre) {
    const double sum = random.uniform() + random.uniform() + random.uniform() + random.uniform() - 2.0;
    return (centre + static_cast<int>(std::lround(sum * width)) + codes) % codes;
  };

  std::vector<Detection> stream;
  for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
    const int same = pick(random, codes);
    for (int slot = 0; slot < parameters.slots; ++slot) {
      int code = 0;
      bool detected = true;
      switch (kind) {
        case StreamKind::kUniform:
          code = pick(random, codes);
          detected = pick(random, 4) != 0;
          break;
        case StreamKind::kSameInSlots:
          code = same;
          break;
        case StreamKind::kPingPong: {
          const std::array<int, 4> sides = {codes / 2 - 1, codes / 2 + 1, 0, codes / 2};
          code = sides[(acquisition * static_cast<std::uint32_t>(parameters.slots) +
                        static_cast<std::uint32_t>(slot)) %
                       sides.size()];
          break;
        }
        case StreamKind::kExtremes: {
          const std::array<int, 4> extremes = {0, 1, codes - 2, codes - 1};
          code = extremes[static_cast<std::size_t>(pick(random, 4))];
          break;
        }
        case StreamKind::kNoDetection:
          code = codes - 1;
          break;
        case StreamKind::kConstant:
          code = constant;
          break;
        case StreamKind::kTies:
          code = (constant + slot * (codes / 4)) % codes;
          break;
        case StreamKind::kBellAtEnds:
          code = bell(end);
          break;
        case StreamKind::kBellAtBorder:
          code = pick(random, 3) == 0 ? pick(random, codes) : bell(border);
          detected = pick(random, 2) != 0;
          break;
      }
      if (detected) {
        stream.push_back({acquisition, static_cast<Timestamp>(code)});
      }
    }
  }
  return stream;
}

}  // namespace dtof
