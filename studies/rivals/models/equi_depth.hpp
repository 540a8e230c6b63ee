// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rivals/models/rival.hpp"

namespace dtof {

// Equi-depth histograms: boundaries that divide the detections into n parts of equally many, so that the
// pulse is where they are close together (Ingle and Maier, TPAMI 2023, arXiv 2307.04924; Sadekar et al., ECCV
// 2024, arXiv 2408.16150). Written from the papers' equations, in integers.
//
// A binner keeps a boundary, e, and moves it at the end of each acquisition by its early detections (x < e)
// and its late ones (x >= e), E and L of them. An acquisition without detections moves nothing.

/// Binners in a tree (HEDH). The frame is cut into log2(n) equal levels; level l places 2^l boundaries. A
/// boundary counts only timestamps between its parents, starts in their middle, and moves by sign(L - E)
/// codes; a move onto or across a parent is dropped. Words of NP bits. With two parts it is the one binner,
/// whose boundary is the median.
struct HierarchicalChoice {
  int parts = 4;  ///< n, a power of two, 2 .. 64
};
std::unique_ptr<Rival> make_hierarchical_equi_depth(const SensorModel& sensor,
                                                    const HierarchicalChoice& choice);

/// Binners side by side (PEDH). Boundary i of 1 .. n - 1 tracks the quantile q = i / n from i 2^NP / n on:
///
///     d = (q L - (1 - q) E) / (L + E)
///
/// plain: e += d, e with 6 fraction bits (NP + 6 bits a boundary).
/// optimised: m = .95 m + .05 d;  s = (.2 (3 B / 100) m + .8 s) D(c);  e = clip(e + s), with B = 2^NP, c the
/// acquisition and D falling as 0.02^(c / (0.8 N)) to 0.02. In numbers: e with 8 fraction bits, m of 10 bits
/// (9 of fraction), s of 14 bits (8 of fraction), 42 bits a boundary with NP = 10; D from a table of 64 steps
/// that all pixels share.
struct ProportionalChoice {
  int parts = 4;  ///< n, a power of two, 2 .. 64
  bool optimised = false;
};
std::unique_ptr<Rival> make_proportional_equi_depth(const SensorModel& sensor,
                                                    const ProportionalChoice& choice);

/// The host's part: the densest place between ascending boundaries. With up to four parts it is the centre of
/// the narrowest part (two parts: the boundary itself), with more the top of the parabola through 1 / width
/// at the centres of the narrowest part and its neighbours. The confidence is its density over the mean one,
/// less 1.
Measurement densest_place(std::vector<double> boundaries, int code_count);

}  // namespace dtof
