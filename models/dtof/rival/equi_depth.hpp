// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dtof/rival/rival.hpp"

namespace dtof {

// Equi-depth histograms: boundaries divide the detections into n equal parts, so the pulse is where
// boundaries are close together (Ingle and Maier, TPAMI 2023, arXiv 2307.04924; Sadekar et al., ECCV 2024,
// arXiv 2408.16150). Implemented from the papers' equations, in integers.
//
// A binner stores a boundary e and moves it at the end of each acquisition by E and L, the numbers of early
// detections (x < e) and late ones (x >= e). An acquisition without detections does not move it.

/// A tree of binners (HEDH). The frame is cut into log2(n) equal levels; level l places 2^l boundaries. A
/// boundary counts only timestamps between its parents, starts midway between them, and moves by sign(L - E)
/// codes. A move onto or beyond a parent is dropped. Words have NP bits. With two parts there is one binner,
/// whose boundary is the median.
struct HierarchicalChoice {
  int parts = 4;  ///< n, a power of two, 2 .. 64
};
std::unique_ptr<Rival> make_hierarchical_equi_depth(const SensorModel& sensor,
                                                    const HierarchicalChoice& choice);

/// Parallel binners (PEDH). Boundary i of 1 .. n - 1 tracks the quantile q = i / n, starting at i 2^NP / n:
///
///     d = (q L - (1 - q) E) / (L + E)
///
/// plain: e += d, e with 6 fraction bits (NP + 6 bits per boundary).
/// optimised: m = .95 m + .05 d;  s = (.2 (3 B / 100) m + .8 s) D(c);  e = clip(e + s). B = 2^NP, c is the
/// acquisition, and D falls as 0.02^(c / (0.8 N)) to 0.02. Word lengths: e has 8 fraction bits, m 10 bits (9
/// of fraction), s 14 bits (8 of fraction); 42 bits per boundary with NP = 10. D comes from a table of 64
/// steps that all pixels share.
struct ProportionalChoice {
  int parts = 4;  ///< n, a power of two, 2 .. 64
  bool optimised = false;
};
std::unique_ptr<Rival> make_proportional_equi_depth(const SensorModel& sensor,
                                                    const ProportionalChoice& choice);

/// The host's part: the densest position between ascending boundaries. With up to four parts this is the
/// centre of the narrowest part (with two parts: the boundary itself). With more parts it is the vertex of
/// the parabola through 1 / width at the centres of the narrowest part and its neighbours. The confidence is
/// its density divided by the mean density, minus 1.
Measurement densest_place(std::vector<double> boundaries, int code_count);

}  // namespace dtof
