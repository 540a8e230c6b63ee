// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml.
// clang-format off
#include "dtof/core/parameter_entry.hpp"

namespace dtof {
namespace {

constexpr auto kEntries = std::to_array<ParameterEntry>({
    entry<&ReadoutParameters::np>("NP",
        "bits of a TDC timestamp"),
    entry<&ReadoutParameters::nb>("NB",
        "bits of the coarse histogram index"),
    entry<&ReadoutParameters::slots>("SLOTS",
        "timestamps per pixel and acquisition"),
    entry<&ReadoutParameters::count_width>("COUNT_WIDTH",
        "bits of a histogram bin, a counter that never wraps"),
    entry<&ReadoutParameters::pointer_step>("POINTER_STEP",
        "bins a pointer moves per timestamp"),
    entry<&ReadoutParameters::fraction_bits>("FRACTION_BITS",
        "fractional bits of the pointer"),
    entry<&ReadoutParameters::confidence_width>("CONFIDENCE_WIDTH",
        "bits of a pointer's confidence, 0 for none"),
    entry<&ReadoutParameters::guard>("GUARD",
        "hisPointer: side band beyond half a coarse bin, the FWHM of 2 ns in 45 ns"),
    entry<&ReadoutParameters::window_centred>("WINDOW_CENTRED",
        "SiFH: window centred on the coarse bin (Fig. 3.8) instead of Eq. 2.5"),
    entry<&PoolPointerParameters::group_size>("GROUP_SIZE",
        "rows of a group, which shares a coarse histogram"),
    entry<&PoolPointerParameters::labels>("LABELS",
        "candidates of a group"),
    entry<&PoolPointerParameters::score_bits>("SCORE_BITS",
        "bits of their scores"),
    entry<&PoolPointerParameters::offset_bits>("OFFSET_BITS",
        "bits of a leader's offset in the track phase, 0 for none"),
    entry<&PoolPointerParameters::count_bits>("ADVANTAGE_WIDTH",
        "bits of the leader's advantage"),
    entry<&PoolPointerParameters::pointer_shift>("POINTER_SHIFT",
        "a pointer's unit is 2^(POINTER_SHIFT - 11) coarse bins"),
    entry<&PoolPointerParameters::rival_moves>("RIVAL_MOVES",
        "1: the rival has a pointer of its own"),
    entry<&PoolPointerParameters::cell_shift>("CELL_SHIFT",
        "windows of a settled pointer: 8 for pulses below 0.75 coarse bins (FWHM), 10 from 2.25"),
    entry<&PoolPointerParameters::second_target>("SECOND_TARGET",
        "1: a result has the position of the label that lost, too"),
    entry<&PoolPointerParameters::amplitude>("AMPLITUDE",
        "1: a result has amplitude and ambient, too"),
    entry<&PoolPointerParameters::prior>("PRIOR",
        "1: candidates may begin from those that were used in the last frame (`prior_i`)"),
    entry<&PoolPointerParameters::engine_columns>("ENGINE_COLUMNS",
        "columns that share an engine"),
    entry<&PoolPointerParameters::coarse_share>("COARSE_SHARE",
        "64ths of a frame that the coarse phase is recommended to take"),
    entry<&PoolPointerParameters::track_share>("TRACK_SHARE",
        "64ths of a frame that the track phase is recommended to take"),
});

}  // namespace

std::span<const ParameterEntry> parameter_entries() { return kEntries; }

}  // namespace dtof
