// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/array_memories.hpp"

#include <algorithm>
#include <cmath>

namespace dtof {
namespace {

int ceiling(int value, int by) { return (value + by - 1) / by; }

/// Bits that number so many labels.
int label_bits(int labels) {
  int bits = 1;
  while (1 << bits < labels) {
    ++bits;
  }
  return bits;
}

constexpr int kCandidateBits = 7;

int pool_pixel_width(const PoolPointerParameters& pool) {
  constexpr int kMovingBits = 16;  // leader and rival's 7
  constexpr int kRestingBits = 12;
  const int label = label_bits(pool.labels);
  const int track = pool.labels * pool.score_bits + (pool.offset_bits > 0 ? label + pool.offset_bits : 0);
  const int point = pool.count_bits + (pool.rival_moves ? kMovingBits : kRestingBits) - pool.pointer_shift +
                    (pool.rival_moves ? kCandidateBits : 2 * label);
  return std::max(track, point);
}

/// Two pixels or a group's word.
int pool_half_width(const PoolPointerParameters& pool) {
  const int two_pixels = 2 * pool_pixel_width(pool);
  const int background = std::clamp(two_pixels - kCandidateBits * pool.labels, 4, 6);
  return std::max(two_pixels, kCandidateBits * pool.labels + background);
}

}  // namespace

int ArrayChoice::module_columns() const {
  if (!is_pool_readout(parameters.readout)) {
    return 1;
  }
  return std::min(parameters.pool.engine_columns > 2 ? 4 : 2, columns);
}

int ArrayChoice::modules() const { return ceiling(columns, module_columns()); }

int ArrayChoice::engines() const {
  return is_pool_readout(parameters.readout) ? ceiling(columns, parameters.pool.engine_columns) : 0;
}

std::vector<MacroSize> column_memories(const ArrayChoice& array) {
  const ReadoutParameters& p = array.parameters;
  const int rows = array.rows;
  const auto histogram = [&](int log2_bins) { return MacroSize{2, rows << log2_bins, p.count_width}; };
  const int pointer = p.np + p.fraction_bits + p.confidence_width;
  switch (p.readout) {
    case Readout::kEzPointer:
      return {{array.pointer_ports, rows, pointer}};
    case Readout::kHisPointer1:
      return {histogram(p.nb), {array.pointer_ports, rows, pointer}};
    case Readout::kHisPointer:
      return {histogram(p.nb), {array.pointer_ports, rows, pointer + p.nb}};
    case Readout::kSifh:
      return {histogram(p.nb), {1, rows, p.nb}};
    case Readout::kFifh:
      return {histogram(std::max(p.nb, p.np - p.nb)), {1, rows, p.nb}};
    case Readout::kThreeSteps:
      return {histogram(4), {1, rows, p.np - std::max(p.np - 9, 0)}};
    case Readout::kPifh:
      if (p.np == p.nb) {
        return {histogram(p.nb)};
      }
      return {histogram(p.nb), {1, rows, 2 * p.count_width + p.np}};
    case Readout::kHistogram:
      return {histogram(p.np)};
    case Readout::kCoarseHistogram:
      return {histogram(p.nb)};
    case Readout::kPoolPointer:
    case Readout::kPoolPointerLean: {
      const int groups = ceiling(rows, p.pool.group_size);
      const int pairs = ceiling(array.module_columns(), 2);
      const int half = pool_half_width(p.pool);
      const int parts = half == 2 * pool_pixel_width(p.pool) ? 4 : 2;
      return {{1, groups * (p.pool.group_size / 2) + ceiling(groups, 2), pairs * 2 * half, pairs * parts}};
    }
  }
  return {};
}

std::vector<MacroSize> engine_memories(const ArrayChoice& array) {
  if (!is_pool_readout(array.parameters.readout)) {
    return {};
  }
  const PoolPointerParameters& pool = array.parameters.pool;
  constexpr int kDecideBits = 20;
  return {{1, array.rows, std::max(4 * pool.labels + 7 + pool.offset_bits, kDecideBits)}};
}

double bits_per_pixel(const ArrayChoice& array) {
  double bits = 0.0;
  for (const MacroSize& size : column_memories(array)) {
    bits += static_cast<double>(size.capacity());
  }
  return bits / array.rows / array.module_columns();
}

}  // namespace dtof
