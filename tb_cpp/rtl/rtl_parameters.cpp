// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml.
// clang-format off
#include "rtl/rtl_parameters.hpp"

namespace dtof {
namespace {

constexpr auto kParameters = std::to_array<RtlParameter>({
    {"NP", true, true},
    {"NB", true, false},
    {"PIXELS_PER_SRAM", true, true},
    {"SRAM_NUM", true, true},
    {"SLOTS", true, true},
    {"COUNT_WIDTH", true, true},
    {"POINTER_STEP", true, false},
    {"FRACTION_BITS", true, false},
    {"CONFIDENCE_WIDTH", true, false},
    {"GUARD", true, false},
    {"WINDOW_CENTRED", true, false},
    {"POINTER_PORTS", true, false},
    {"SIGNALLED_CLEAR", true, false},
    {"PARITY", true, true},
    {"TIME_GATE", true, true},
    {"RAW_HISTOGRAM", true, false},
    {"GROUP_SIZE", false, true},
    {"LABELS", false, true},
    {"SCORE_BITS", false, true},
    {"OFFSET_BITS", false, true},
    {"ADVANTAGE_WIDTH", false, true},
    {"POINTER_SHIFT", false, true},
    {"RIVAL_MOVES", false, true},
    {"CELL_SHIFT", false, true},
    {"SECOND_TARGET", false, true},
    {"AMPLITUDE", false, true},
    {"PRIOR", false, true},
    {"ENGINE_COLUMNS", false, true},
    {"COARSE_SHARE", false, false},
    {"TRACK_SHARE", false, false},
    {"ACQ_WIDTH", false, false},
    {"BROADCAST_STAGES", true, true},
});

}  // namespace

std::span<const RtlParameter> rtl_parameters() { return kParameters; }

}  // namespace dtof
