// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/array_memories.hpp"

#include <algorithm>
#include <cmath>

namespace dtof {
namespace {

int ceiling(int value, int by) { return (value + by - 1) / by; }

constexpr int kCandidateBits = 7;
constexpr int kPositionBits = 16;

/// Bits of a half of the SRAM word of a pair of columns: two pixels of a column, or a group
/// (dtof_pkg::pool_half_width).
int pool_half_width(const PoolPointerParameters& pool) {
  return std::max(2 * pool.word_bits(), kCandidateBits * pool.labels + pool.background_bits());
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
      const int parts = half == 2 * p.pool.word_bits() ? 4 : 2;
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
  // Messages of choose with cell and offset chosen in the column to the left, or of decide with the winner
  // there: its position, and its confidence if a group's word has significances (dtof_pool_engine.sv).
  constexpr int kDecideMessageBits = 4;
  constexpr int kConfidenceBits = 8;  // of advantages of 7 bits, without which there are no significances
  const int choose = 4 * pool.labels + kCandidateBits + pool.offset_bits;
  const int decide =
      kDecideMessageBits + kPositionBits + (pool.significance_bits() > 0 ? kConfidenceBits : 0);
  return {{1, array.rows, std::max(choose, decide)}};
}

double bits_per_pixel(const ArrayChoice& array) {
  double bits = 0.0;
  for (const MacroSize& size : column_memories(array)) {
    bits += static_cast<double>(size.capacity());
  }
  return bits / array.rows / array.module_columns();
}

}  // namespace dtof
