// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml and parameters.toml.
// clang-format off
#include "dtof/core/parameter_limits.hpp"

#include <algorithm>
#include <array>

namespace dtof {
namespace {

constexpr auto kArrayLimits = std::to_array<ParameterLimit>({
    {"NP", "NP must be 3 to 16",
     [](const ReadoutParameters& p) { return ((p.np >= 3) && (p.np <= 16)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.np); }},
    {"NB", "NB must be 1 to NP",
     [](const ReadoutParameters& p) { return ((p.nb >= 1) && (p.nb <= p.np)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.nb); }},
    {"SLOTS", "SLOTS must be 1 to 16",
     [](const ReadoutParameters& p) { return ((p.slots >= 1) && (p.slots <= 16)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.slots); }},
    {"COUNT_WIDTH", "COUNT_WIDTH must be 1 to 16",
     [](const ReadoutParameters& p) { return ((p.count_width >= 1) && (p.count_width <= 16)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.count_width); }},
    {"POINTER_STEP", "POINTER_STEP must be 1 to 2^(NP-1) - 1",
     [](const ReadoutParameters& p) { return ((p.pointer_step >= 1) && (p.pointer_step <= ((1 << (p.np - 1)) - 1))); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pointer_step); }},
    {"FRACTION_BITS", "FRACTION_BITS must be 0 to 8 and NP + FRACTION_BITS at most 16",
     [](const ReadoutParameters& p) { return ((p.fraction_bits >= 0) && (p.fraction_bits <= std::min(8, (16 - p.np)))); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.fraction_bits); }},
    {"CONFIDENCE_WIDTH", "CONFIDENCE_WIDTH must be 0 to 8",
     [](const ReadoutParameters& p) { return ((p.confidence_width >= 0) && (p.confidence_width <= 8)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.confidence_width); }},
    {"GUARD", "GUARD must be 0 to 2^NP",
     [](const ReadoutParameters& p) { return p.readout != Readout::kHisPointer || ((p.guard >= 0) && (p.guard <= (1 << p.np))); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.guard); }},
});

constexpr auto kPoolLimits = std::to_array<ParameterLimit>({
    {"NP", "NP must be 8 to 16",
     [](const ReadoutParameters& p) { return ((p.np >= 8) && (p.np <= 16)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.np); }},
    {"SLOTS", "SLOTS must be 2 to 4",
     [](const ReadoutParameters& p) { return ((p.slots >= 2) && (p.slots <= 4)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.slots); }},
    {"COUNT_WIDTH", "COUNT_WIDTH must be 4 to 8",
     [](const ReadoutParameters& p) { return ((p.count_width >= 4) && (p.count_width <= 8)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.count_width); }},
    {"GROUP_SIZE", "GROUP_SIZE must be a power of two from 4 to 32",
     [](const ReadoutParameters& p) { return ((p.pool.group_size >= 4) && (p.pool.group_size <= 32) && ((p.pool.group_size & (p.pool.group_size - 1)) == 0)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.group_size); }},
    {"LABELS", "LABELS must be 2 to 8",
     [](const ReadoutParameters& p) { return ((p.pool.labels >= 2) && (p.pool.labels <= 8)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.labels); }},
    {"SCORE_BITS", "SCORE_BITS must be 1 to 4",
     [](const ReadoutParameters& p) { return ((p.pool.score_bits >= 1) && (p.pool.score_bits <= 4)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.score_bits); }},
    {"OFFSET_BITS", "OFFSET_BITS must be 0 or 2 to 6",
     [](const ReadoutParameters& p) { return ((p.pool.offset_bits == 0) || ((p.pool.offset_bits >= 2) && (p.pool.offset_bits <= 6))); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.offset_bits); }},
    {"ADVANTAGE_WIDTH", "ADVANTAGE_WIDTH must be 4 or 7",
     [](const ReadoutParameters& p) { return ((p.pool.count_bits == 4) || (p.pool.count_bits == 7)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.count_bits); }},
    {"POINTER_SHIFT", "POINTER_SHIFT must be 0 to 2, or 0 to 4 if ADVANTAGE_WIDTH is 4",
     [](const ReadoutParameters& p) { return ((p.pool.pointer_shift >= 0) && (p.pool.pointer_shift <= ((p.pool.count_bits == 4) ? 4 : 2))); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.pointer_shift); }},
    {"OFFSET_BITS", "OFFSET_BITS must be 0 if RIVAL_MOVES is 0",
     [](const ReadoutParameters& p) { return ((p.pool.rival_moves == 1) || (p.pool.offset_bits == 0)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.offset_bits); }},
    {"CELL_SHIFT", "CELL_SHIFT must be 8 to 10",
     [](const ReadoutParameters& p) { return ((p.pool.cell_shift >= 8) && (p.pool.cell_shift <= 10)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.cell_shift); }},
    {"ENGINE_COLUMNS", "ENGINE_COLUMNS must be even and at least 2, for two columns share an SRAM",
     [](const ReadoutParameters& p) { return ((p.pool.engine_columns >= 2) && ((p.pool.engine_columns & 1) == 0)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.engine_columns); }},
    {"COARSE_SHARE", "COARSE_SHARE must be 1 to 62",
     [](const ReadoutParameters& p) { return ((p.pool.coarse_share >= 1) && (p.pool.coarse_share <= 62)); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.coarse_share); }},
    {"TRACK_SHARE", "TRACK_SHARE must be at least 1, and at most 63 together with COARSE_SHARE",
     [](const ReadoutParameters& p) { return ((p.pool.track_share >= 1) && (p.pool.track_share <= (63 - p.pool.coarse_share))); },
     [](const ReadoutParameters& p) { return static_cast<int>(p.pool.track_share); }},
});

}  // namespace

std::span<const ParameterLimit> parameter_limits(bool pool) {
  return pool ? std::span<const ParameterLimit>(kPoolLimits) : std::span<const ParameterLimit>(kArrayLimits);
}

}  // namespace dtof
