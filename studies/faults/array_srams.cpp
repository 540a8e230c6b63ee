// SPDX-License-Identifier: Apache-2.0
#include "faults/array_srams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace dtof {
namespace {

constexpr std::array<std::pair<std::string_view, SramKind>, 6> kInstances = {{
    {"u_histogram_sram", SramKind::kHistogram},
    {"u_word_sram", SramKind::kPointer},
    {"u_peak_sram", SramKind::kCoarsePeak},
    {"u_best_sram", SramKind::kBestPeak},
    {"u_sram", SramKind::kPoolQuad},
    {"u_scratch_sram", SramKind::kEngineScratch},
}};

SramKind kind_of(const std::string& path) {
  const std::string instance = path.substr(path.rfind('.') + 1);
  const auto* entry = std::ranges::find(kInstances, instance, &std::pair<std::string_view, SramKind>::first);
  if (entry == kInstances.end()) {
    throw std::logic_error(fmt::format("SRAM '{}' is of no known kind", path));
  }
  return entry->second;
}

/// The index of the generate block, e.g. 3 of "g_column[3]".
int block_index(const std::string& path, const std::string& block) {
  const std::size_t begin = path.find(block + '[');
  if (begin == std::string::npos) {
    throw std::logic_error(fmt::format("SRAM '{}' is in no '{}'", path, block));
  }
  return std::stoi(path.substr(begin + block.size() + 1));
}

ColumnRange columns_of(SramKind kind, const std::string& path, const RtlConfiguration& configuration) {
  const auto clipped = [&](int first, int count) {
    return ColumnRange{first, std::min(count, configuration.sram_num - first)};
  };
  const int engine_columns = configuration.parameters.pool.engine_columns;
  if (kind == SramKind::kEngineScratch) {
    return clipped(block_index(path, "g_engine") * engine_columns, engine_columns);
  }
  if (kind == SramKind::kPoolQuad) {
    const int columns = engine_columns == 2 ? 2 : 4;
    return clipped(columns * block_index(path, "g_quad"), columns);
  }
  return {block_index(path, "g_column"), 1};
}

}  // namespace

ColumnRange affected_columns(ColumnRange columns, int together, int sram_num) {
  const int first = columns.first / together * together;
  const int groups = (columns.first + columns.count - first + together - 1) / together;
  return {first, std::min(groups * together, sram_num - first)};
}

std::string_view sram_title(SramKind kind) {
  switch (kind) {
    case SramKind::kHistogram:
      return "histogram";
    case SramKind::kPointer:
      return "pointer";
    case SramKind::kCoarsePeak:
      return "coarse peak";
    case SramKind::kBestPeak:
      return "best peak";
    case SramKind::kPoolQuad:
      return "four columns";
    case SramKind::kEngineScratch:
      return "engine scratch";
  }
  throw std::logic_error("an SRAM of no kind");
}

std::vector<ArraySram> array_srams(const RtlReadout& rtl) {
  std::vector<ArraySram> srams;
  for (const RtlSram& sram : rtl.srams()) {
    const SramKind kind = kind_of(sram.path());
    srams.push_back({kind, columns_of(kind, sram.path(), rtl.configuration()), sram});
  }
  std::ranges::stable_sort(srams, {}, [](const ArraySram& sram) { return sram.columns.first; });
  return srams;
}

std::vector<SramKind> sram_kinds(const std::vector<ArraySram>& srams) {
  std::vector<SramKind> kinds;
  for (const ArraySram& sram : srams) {
    if (std::ranges::find(kinds, sram.kind) == kinds.end()) {
      kinds.push_back(sram.kind);
    }
  }
  return kinds;
}

}  // namespace dtof
