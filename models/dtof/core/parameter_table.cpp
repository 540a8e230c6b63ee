// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml and parameters.toml.
// clang-format off
#include "dtof/core/parameter_entry.hpp"

namespace dtof {
namespace {

constexpr auto kEntries = std::to_array<ParameterEntry>({
    entry<&ReadoutParameters::np>("NP",
        "bits of a TDC timestamp",
        "3 to 16 bits; poolPointer: 8 to 16 bits"),
    entry<&ReadoutParameters::nb>("NB",
        "bits of the coarse histogram index",
        "1 to NP"),
    entry<&ReadoutParameters::slots>("SLOTS",
        "timestamps per pixel and acquisition",
        "1 to 16 timestamps; poolPointer: 2 to 4 timestamps"),
    entry<&ReadoutParameters::count_width>("COUNT_WIDTH",
        "bits of a histogram bin, a counter that never wraps",
        "1 to 16 bits; poolPointer: 4 to 8 bits"),
    entry<&ReadoutParameters::pointer_step>("POINTER_STEP",
        "bins a pointer moves per timestamp",
        "1 to 2^(NP-1) - 1"),
    entry<&ReadoutParameters::fraction_bits>("FRACTION_BITS",
        "fractional bits of the pointer",
        "0 to 8 and NP + FRACTION_BITS at most 16"),
    entry<&ReadoutParameters::confidence_width>("CONFIDENCE_WIDTH",
        "bits of a pointer's confidence, 0 for none",
        "0 to 8 bits"),
    entry<&ReadoutParameters::guard>("GUARD",
        "hisPointer: side band beyond half a coarse bin, the FWHM of 2 ns in 45 ns",
        "0 to 2^NP"),
    entry<&ReadoutParameters::window_centred>("WINDOW_CENTRED",
        "SiFH: window centred on the coarse bin (Fig. 3.8) instead of Eq. 2.5",
        "0 or 1"),
    entry<&PoolPointerParameters::group_size>("GROUP_SIZE",
        "rows of a group, which shares a coarse histogram",
        "a power of two from 4 to 32"),
    entry<&PoolPointerParameters::labels>("LABELS",
        "candidates of a group",
        "2 to 8 candidates"),
    entry<&PoolPointerParameters::score_bits>("SCORE_BITS",
        "bits of their scores",
        "1 to 4 bits"),
    entry<&PoolPointerParameters::offset_bits>("OFFSET_BITS",
        "bits of a leader's offset in the track phase, 0 for none",
        "0 or 2 to 6"),
    entry<&PoolPointerParameters::count_bits>("ADVANTAGE_WIDTH",
        "bits of the leader's advantage",
        "4 or 7"),
    entry<&PoolPointerParameters::pointer_shift>("POINTER_SHIFT",
        "a pointer's unit is 2^(POINTER_SHIFT - 11) coarse bins",
        "0 to 2, or 0 to 4 if ADVANTAGE_WIDTH is 4"),
    entry<&PoolPointerParameters::rival_moves>("RIVAL_MOVES",
        "1: the rival has a pointer of its own",
        "0 or 1"),
    entry<&PoolPointerParameters::cell_shift>("CELL_SHIFT",
        "windows of a settled pointer: 8 for pulses below 0.75 coarse bins (FWHM), 10 from 2.25",
        "8 to 10"),
    entry<&PoolPointerParameters::second_target>("SECOND_TARGET",
        "1: a result has the position of the label that lost, too",
        "0 or 1"),
    entry<&PoolPointerParameters::prior>("PRIOR",
        "1: candidates may begin from those that were used in the last frame (`prior_i`)",
        "0 or 1"),
    entry<&PoolPointerParameters::engine_columns>("ENGINE_COLUMNS",
        "columns that share an engine",
        "even and at least 2"),
    entry<&PoolPointerParameters::coarse_share>("COARSE_SHARE",
        "64ths of a frame that the coarse phase is recommended to take",
        "1 to 62 1/64 of a frame"),
    entry<&PoolPointerParameters::track_share>("TRACK_SHARE",
        "64ths of a frame that the track phase is recommended to take",
        "at least 1, and at most 63 together with COARSE_SHARE"),
});

}  // namespace

std::span<const ParameterEntry> parameter_entries() { return kEntries; }

}  // namespace dtof
