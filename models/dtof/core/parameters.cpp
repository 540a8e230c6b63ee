// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parameter_entry.hpp"
#include "dtof/core/parameter_limits.hpp"
#include "dtof/core/suggestion.hpp"

namespace dtof {
namespace {

constexpr int kPoolCoarseBits = 5;
constexpr int kPoolPositionBits = 16;
constexpr int kPoolRivalBits = 7;
constexpr int kPoolCellBits = 7;
constexpr int kMostPoolSignificanceBits = 3;
constexpr int kFewestPoolBackgroundBits = 4;

void require(bool legal, std::string_view sentence, int value) {
  if (!legal) {
    throw InputError(fmt::format("{}, not {}", sentence, value));
  }
}

void require_range(std::string_view name, int value, int lowest, int highest) {
  require(value >= lowest && value <= highest, fmt::format("{} must be {} to {}", name, lowest, highest),
          value);
}

/// Limits that depend on the width of a pixel word (word for word those of the RTL).
void require_memory(const PoolPointerParameters& pool, int count_width) {
  const int group_bits = kPoolCellBits * pool.labels + pool.background_bits();
  const int half_bits = std::max(2 * pool.word_bits(), group_bits);
  require(!pool.prior || group_bits + pool.labels <= half_bits,
          "a group's word and a bit for each candidate must fit two pixel words if PRIOR is 1", pool.labels);
  const int line_halves = pool.bin_halves(count_width);
  require(8 * count_width < line_halves * half_bits && pool.group_size >= 4 * line_halves,
          "32 bins of COUNT_WIDTH and a bit more must fit the words of GROUP_SIZE rows", count_width);
}

}  // namespace

const ParameterLimit* broken_limit(const ReadoutParameters& parameters, std::string_view parameter) {
  const std::span<const ParameterLimit> limits = parameter_limits(is_pool_readout(parameters.readout));
  const auto broken = std::ranges::find_if(limits, [&](const ParameterLimit& limit) {
    return (parameter.empty() || limit.parameter == parameter) && !limit.legal(parameters);
  });
  return broken == limits.end() ? nullptr : &*broken;
}

void require_legal(const ReadoutParameters& parameters, std::string_view parameter) {
  if (const ParameterLimit* const broken = broken_limit(parameters, parameter)) {
    require(false, broken->sentence, broken->value(parameters));
  }
}

Readout parse_readout(std::string_view name) {
  std::vector<std::string_view> known;
  for (const Readout readout : kAllReadouts) {
    if (readout_name(readout) == name) {
      return readout;
    }
    known.push_back(readout_name(readout));
  }
  throw InputError(unknown_name("read-out", name, known));
}

PoolPointerParameters PoolPointerParameters::defaults(Readout readout) {
  return ReadoutParameters::defaults(readout).pool;  // none of these depends on NP
}

void PoolPointerParameters::validate(int count_width) const {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPoolPointer);
  parameters.count_width = count_width;
  parameters.pool = *this;
  parameters.validate();
}

int PoolPointerParameters::word_bits() const {
  const auto label_bits = static_cast<int>(std::bit_width(static_cast<unsigned>(labels - 1)));
  const int track_word = labels * score_bits + (offset_bits > 0 ? label_bits + offset_bits : 0);
  const int pointer_word = count_bits + (rival_moves ? kPoolPositionBits - pointer_shift + kPoolRivalBits
                                                     : 12 - pointer_shift + 2 * label_bits);
  return std::max(track_word, pointer_word);
}

int PoolPointerParameters::background_bits() const {
  return std::clamp(2 * word_bits() - kPoolCellBits * labels, kFewestPoolBackgroundBits, kPoolBackgroundBits);
}

int PoolPointerParameters::significance_bits() const {
  const int flags = 1 + (prior ? labels : 0);  // the background is tilted; candidates that were used
  const int room = 2 * word_bits() - kPoolCellBits * labels - background_bits() - flags;
  const int bits = std::min(room / labels, kMostPoolSignificanceBits);
  return count_bits == 7 && rival_moves && bits >= 2 ? bits : 0;
}

int PoolPointerParameters::bin_halves(int count_width) const {
  const int half_bits = std::max(2 * word_bits(), kPoolCellBits * labels + background_bits());
  return 8 * count_width < half_bits ? 1 : 2;
}

PoolSchedule::PoolSchedule(std::uint32_t acquisitions, const PoolPointerParameters& parameters) {
  const auto share = [&](int share_64ths) {
    return static_cast<std::uint32_t>(
        (std::uint64_t{acquisitions} * static_cast<std::uint64_t>(share_64ths)) >> 6U);
  };
  coarse_end = share(parameters.coarse_share);
  track_end = share(parameters.coarse_share + parameters.track_share);
}

ReadoutParameters ReadoutParameters::defaults(Readout readout, int np) {
  ReadoutParameters bits;
  bits.np = np;
  require_legal(bits, "NP");
  ReadoutParameters parameters;
  parameters.readout = readout;
  parameters.np = np;
  for (const ParameterEntry& entry : parameter_entries()) {
    if (entry.name != "NP") {
      entry.set(parameters, default_value(readout, entry.name, np));
    }
  }
  return parameters;
}

void ReadoutParameters::validate() const {
  require_legal(*this);
  if (is_pool_readout(readout)) {  // NB and FRACTION_BITS of its RTL follow from NP
    require(nb == kPoolCoarseBits, "NB must be 5", nb);
    require(fraction_bits == kPoolPositionBits - np, "FRACTION_BITS must be 16 - NP", fraction_bits);
    require_memory(pool, count_width);
  }
  if (time_gate) {
    require_range("gate begin", time_gate->begin, 0, no_detection());
    require_range("gate end", time_gate->end, 0, no_detection());
  }
}

int ReadoutParameters::raw_bins() const {
  constexpr int kFineBinsOfThreeSteps = 16;
  switch (readout) {
    case Readout::kHisPointer1:
    case Readout::kHisPointer:
    case Readout::kSifh:
    case Readout::kCoarseHistogram:
      return 1 << nb;
    case Readout::kFifh:
      return 1 << (np - nb);
    case Readout::kThreeSteps:
      return kFineBinsOfThreeSteps;
    case Readout::kPifh:
      return nb == np ? code_count() : 0;
    case Readout::kHistogram:
      return code_count();
    default:
      return 0;
  }
}

std::string ReadoutParameters::to_string() const {
  std::string out = fmt::format("{} NP={} SLOTS={}", readout_name(readout), np, slots);
  if (time_gate) {
    out += fmt::format(" TIME_GATE=1 GATE={}-{}", time_gate->begin, time_gate->end);
  }
  if (is_pool_readout(readout)) {
    const bool has_template = pool.coarse_template != PoolTemplate{};
    return out + fmt::format(
                     " COUNT_WIDTH={} G={} LABELS={}x{} OFFSET={} COUNT={} SHIFT={} RIVAL={} CELL_SHIFT={} "
                     "ENGINE_COLUMNS={} SHARES={},{} S1={}{}{}{}{}",
                     count_width, pool.group_size, pool.labels, pool.score_bits, pool.offset_bits,
                     pool.count_bits, pool.pointer_shift, pool.rival_moves ? "moves" : "stays",
                     pool.cell_shift, pool.engine_columns, pool.coarse_share, pool.track_share,
                     pool.smooth ? 1 : 0, pool.second_target ? " SECOND_TARGET=1" : "",
                     pool.amplitude ? " AMPLITUDE=1" : "", pool.prior ? " PRIOR=1" : "",
                     has_template ? fmt::format(" TEMPLATE={}", fmt::join(pool.coarse_template, ",")) : "");
  }
  if (has_parameter(readout, "NB")) {
    out += fmt::format(" NB={}", nb);
  }
  if (has_parameter(readout, "COUNT_WIDTH")) {
    out += fmt::format(" COUNT_WIDTH={}", count_width);
  }
  if (is_pointer_readout(readout)) {
    out += fmt::format(" POINTER_STEP={} FRACTION_BITS={} CONFIDENCE_WIDTH={}", pointer_step, fraction_bits,
                       confidence_width);
  }
  if (readout == Readout::kCoarseHistogram) {
    out += fmt::format(" FRACTION_BITS={}", fraction_bits);
  }
  if (has_parameter(readout, "GUARD")) {
    out += fmt::format(" GUARD={}", guard);
  }
  if (has_parameter(readout, "WINDOW_CENTRED")) {
    out += fmt::format(" WINDOW_CENTRED={}", window_centred ? 1 : 0);
  }
  return out;
}

}  // namespace dtof
