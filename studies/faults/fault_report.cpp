// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/report/table.hpp"

namespace dtof {
namespace {

constexpr double kPercent = 100.0;
constexpr double kMillimetres = 1000.0;
constexpr double kOthers = kFaultEngineColumns * kFaultRows - 1;  // pixels besides the faulty one, at most

struct KindNames {
  FaultKind kind;
  std::string_view title;  ///< in tables
  std::string_view name;   ///< in the CSV file
};
constexpr std::array<KindNames, 8> kKinds = {{
    {FaultKind::kFlippedBit, "any", "flipped_bit"},
    {FaultKind::kFlippedBitAtWork, "engines at work", "flipped_bit_engines_at_work"},
    {FaultKind::kStuckBit, "stuck bit", "stuck_bit"},
    {FaultKind::kStuckTimestamps, "stuck timestamps", "stuck_timestamps"},
    {FaultKind::kHotPixelFixedCode, "hot, one code", "hot_pixel_one_code"},
    {FaultKind::kHotPixelRandomCode, "hot, random codes", "hot_pixel_random_codes"},
    {FaultKind::kDeadPixel, "dead", "dead_pixel"},
    {FaultKind::kReset, "reset", "reset"},
}};

const KindNames& names(FaultKind kind) { return *std::ranges::find(kKinds, kind, &KindNames::kind); }

bool is_flip(FaultKind kind) {
  return kind == FaultKind::kFlippedBit || kind == FaultKind::kFlippedBitAtWork;
}
bool is_column_fault(FaultKind kind) {
  return kind == FaultKind::kStuckBit || kind == FaultKind::kStuckTimestamps;
}
bool is_pixel_fault(FaultKind kind) {
  return kind == FaultKind::kHotPixelFixedCode || kind == FaultKind::kHotPixelRandomCode ||
         kind == FaultKind::kDeadPixel;
}
bool is_hot_pixel(FaultKind kind) { return is_pixel_fault(kind) && kind != FaultKind::kDeadPixel; }

/// What a case's faults did, summed up.
struct Summary {
  std::uint64_t faults = 0;
  std::uint64_t pixels = 0;  ///< within reach, of all faults
  std::uint64_t changing = 0;
  std::uint64_t moving = 0;
  std::uint64_t moving_beyond = 0;
  std::uint64_t pixels_changed = 0;
  std::uint64_t pixels_moved = 0;
  std::uint64_t pixels_beyond = 0;
  int most_changed = 0;
  int most_moved = 0;
  int most_beyond = 0;
  std::vector<double> moves_mm;  ///< of the faults that move a depth, ascending
};

Summary summarise(const std::vector<FaultEffect>& effects) {
  Summary sum;
  for (const FaultEffect& effect : effects) {
    ++sum.faults;
    sum.pixels += static_cast<std::uint64_t>(effect.pixels);
    sum.changing += effect.changed > 0 ? 1 : 0;
    sum.moving += effect.moved > 0 ? 1 : 0;
    sum.moving_beyond += effect.beyond > 0 ? 1 : 0;
    sum.pixels_changed += static_cast<std::uint64_t>(effect.changed);
    sum.pixels_moved += static_cast<std::uint64_t>(effect.moved);
    sum.pixels_beyond += static_cast<std::uint64_t>(effect.beyond);
    sum.most_changed = std::max(sum.most_changed, effect.changed);
    sum.most_moved = std::max(sum.most_moved, effect.moved);
    sum.most_beyond = std::max(sum.most_beyond, effect.beyond);
    if (effect.moved > 0) {
      sum.moves_mm.push_back(kMillimetres * effect.largest_m);
    }
  }
  std::ranges::sort(sum.moves_mm);
  return sum;
}

/// The value that `share` of the sorted values do not exceed; empty text for no values.
std::string quantile(const std::vector<double>& values, double share) {
  if (values.empty()) {
    return "-";
  }
  const auto rank = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  return fmt::format("{:.0f}", values[rank]);
}

std::string percent(std::uint64_t count, std::uint64_t of) {
  if (of == 0) {
    return "-";
  }
  const Estimate share = estimate_share(count, of);
  return fmt::format("{:.1f} ({:.1f} to {:.1f})", kPercent * share.value, kPercent * share.interval.low,
                     kPercent * share.interval.high);
}

/// Mean over the faults of what `of_fault` says of each, 0 to `most`, with its interval where they differ.
template <typename OfFault>
std::string mean(const std::vector<FaultEffect>& effects, const OfFault& of_fault, double most) {
  std::vector<double> values;
  values.reserve(effects.size());
  for (const FaultEffect& effect : effects) {
    values.push_back(of_fault(effect));
  }
  if (values.empty()) {
    return "-";
  }
  if (std::ranges::all_of(values, [&](double value) { return value == values.front(); })) {
    return fmt::format("{}", values.front());
  }
  const Estimate estimate = estimate_mean(values);
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", estimate.value, std::max(estimate.interval.low, 0.0),
                     std::min(estimate.interval.high, most));
}

double moved_percent(const FaultEffect& effect) { return kPercent * effect.moved / effect.pixels; }
double beyond_percent(const FaultEffect& effect) { return kPercent * effect.beyond / effect.pixels; }
double changed_pixels(const FaultEffect& effect) { return effect.changed; }
double beyond_pixels(const FaultEffect& effect) { return effect.beyond; }

std::string title(Readout readout) { return std::string(readout_title(readout)); }

Table flip_table(std::span<const FaultCaseResult> results) {
  Table table({"read-out", "SRAM", "moment", "flips", "result changes, %", "depth moves, %", "beyond 3 %, %",
               "median, mm", "95 %, mm", "largest, mm", "most pixels moved", "other columns"},
              3);
  for (const FaultCaseResult& result : results) {
    if (!is_flip(result.fault.kind)) {
      continue;
    }
    const Summary sum = summarise(result.effects);
    table.add({title(result.fault.readout), std::string(sram_title(*result.fault.sram)),
               std::string(names(result.fault.kind).title), fmt::format("{}", sum.faults),
               percent(sum.changing, sum.faults), percent(sum.moving, sum.faults),
               percent(sum.moving_beyond, sum.faults), quantile(sum.moves_mm, 0.5),
               quantile(sum.moves_mm, 0.95), quantile(sum.moves_mm, 1.0), fmt::format("{}", sum.most_moved),
               fmt::format("{}", result.changed_elsewhere)});
  }
  return table;
}

Table column_table(std::span<const FaultCaseResult> results) {
  Table table({"read-out", "fault", "faults", "pixels within reach", "of them moved, %", "spoilt, %",
               "other columns"},
              2);
  for (const FaultCaseResult& result : results) {
    if (!is_column_fault(result.fault.kind)) {
      continue;
    }
    const Summary sum = summarise(result.effects);
    std::string fault(names(result.fault.kind).title);
    if (result.fault.sram) {
      fault += fmt::format(", {}", sram_title(*result.fault.sram));
    }
    table.add({title(result.fault.readout), fault, fmt::format("{}", sum.faults),
               fmt::format("{}", result.effects.empty() ? 0 : result.effects.front().pixels),
               mean(result.effects, moved_percent, kPercent), mean(result.effects, beyond_percent, kPercent),
               fmt::format("{}", result.changed_elsewhere)});
  }
  return table;
}

Table pixel_table(std::span<const FaultCaseResult> results) {
  Table table({"read-out", "pixel", "pixels tried", "others changed, mean", "most", "others spoilt, mean",
               "most", "spoils any, %", "other columns"},
              2);
  for (const FaultCaseResult& result : results) {
    if (!is_pixel_fault(result.fault.kind)) {
      continue;
    }
    const Summary sum = summarise(result.effects);
    table.add({title(result.fault.readout), std::string(names(result.fault.kind).title),
               fmt::format("{}", sum.faults), mean(result.effects, changed_pixels, kOthers),
               fmt::format("{}", sum.most_changed), mean(result.effects, beyond_pixels, kOthers),
               fmt::format("{}", sum.most_beyond), percent(sum.moving_beyond, sum.faults),
               fmt::format("{}", result.changed_elsewhere)});
  }
  return table;
}

std::vector<Readout> readouts_of(std::span<const FaultCaseResult> results) {
  std::vector<Readout> readouts;
  for (const FaultCaseResult& result : results) {
    if (readouts.empty() || readouts.back() != result.fault.readout) {
      readouts.push_back(result.fault.readout);
    }
  }
  return readouts;
}

/// Sum of all cases of a read-out that `chosen` accepts.
template <typename Chosen>
FaultCaseResult total(std::span<const FaultCaseResult> results, const Chosen& chosen) {
  FaultCaseResult sum;
  for (const FaultCaseResult& result : results) {
    if (chosen(result.fault)) {
      sum.merge(result);
    }
  }
  return sum;
}

Table next_frame_table(std::span<const FaultCaseResult> results) {
  Table table({"read-out", "states reset in", "after a reset", "after flipped bits", "after stuck bits",
               "after stuck timestamps", "after hot pixels", "after dead pixels"});
  for (const Readout readout : readouts_of(results)) {
    const auto cell = [&](const auto& chosen) {
      const FaultCaseResult sum = total(
          results, [&](const FaultCase& fault) { return fault.readout == readout && chosen(fault.kind); });
      return fmt::format("{} of {}", sum.next_frames - sum.wrong_next_frames, sum.frames);
    };
    std::vector<std::string_view> states;
    for (const FaultCaseResult& result : results) {
      if (result.fault.readout == readout && result.fault.state) {
        states.push_back(rtl_state_name(*result.fault.state));
      }
    }
    table.add({title(readout), fmt::format("{}", fmt::join(states, " ")),
               cell([](FaultKind kind) { return kind == FaultKind::kReset; }), cell(is_flip),
               cell([](FaultKind kind) { return kind == FaultKind::kStuckBit; }),
               cell([](FaultKind kind) { return kind == FaultKind::kStuckTimestamps; }), cell(is_hot_pixel),
               cell([](FaultKind kind) { return kind == FaultKind::kDeadPixel; })});
  }
  return table;
}

std::string csv_of(std::span<const FaultCaseResult> results) {
  Table table({"readout",
               "fault",
               "sram",
               "state",
               "frames",
               "broken_frames",
               "model_mismatches",
               "faults",
               "pixels_within_reach",
               "faults_changing_a_result",
               "faults_moving_a_depth",
               "faults_beyond_3_percent",
               "median_mm",
               "percentile_95_mm",
               "largest_mm",
               "pixels_changed",
               "pixels_moved",
               "pixels_beyond_3_percent",
               "most_pixels_changed",
               "most_pixels_moved",
               "most_pixels_beyond_3_percent",
               "pixels_changed_in_other_columns",
               "next_frames",
               "wrong_next_frames"});
  for (const FaultCaseResult& result : results) {
    const FaultCase& fault = result.fault;
    const Summary sum = summarise(result.effects);
    std::vector<std::string> cells = {std::string(readout_name(fault.readout)),
                                      std::string(names(fault.kind).name),
                                      std::string(fault.sram ? sram_title(*fault.sram) : "-"),
                                      std::string(fault.state ? rtl_state_name(*fault.state) : "-")};
    const auto add_count = [&](auto count) { cells.push_back(fmt::format("{}", count)); };
    add_count(result.frames);
    add_count(result.broken_frames);
    add_count(result.model_mismatches);
    add_count(sum.faults);
    add_count(sum.pixels);
    add_count(sum.changing);
    add_count(sum.moving);
    add_count(sum.moving_beyond);
    for (const double share : {0.5, 0.95, 1.0}) {
      cells.push_back(quantile(sum.moves_mm, share));
    }
    add_count(sum.pixels_changed);
    add_count(sum.pixels_moved);
    add_count(sum.pixels_beyond);
    add_count(sum.most_changed);
    add_count(sum.most_moved);
    add_count(sum.most_beyond);
    add_count(result.changed_elsewhere);
    add_count(result.next_frames);
    add_count(result.wrong_next_frames);
    table.add(cells);
  }
  return table.csv();
}

/// {"number": count}, or nothing for 0.
std::optional<PageData> unless_none(std::uint64_t count) {
  return count == 0 ? std::nullopt : std::optional(PageData().set("number", "{}", count));
}

/// What flipped bits and hot pixels did to a read-out; nothing unless both were tried.
std::optional<PageData> readout_data(std::span<const FaultCaseResult> results, Readout readout) {
  const auto flips = total(results, [&](const FaultCase& fault) {
    return fault.readout == readout && fault.kind == FaultKind::kFlippedBit;
  });
  const Summary flip = summarise(flips.effects);
  const auto hot = total(
      results, [&](const FaultCase& fault) { return fault.readout == readout && is_hot_pixel(fault.kind); });
  const Summary spoilt = summarise(hot.effects);
  if (flip.faults == 0 || spoilt.faults == 0) {
    return std::nullopt;
  }
  std::optional<PageData> hot_changes;
  if (spoilt.changing > 0) {
    hot_changes = PageData()
                      .set("changed", "{}", mean(hot.effects, changed_pixels, kOthers))
                      .set("spoilt", "{}", mean(hot.effects, beyond_pixels, kOthers))
                      .set("most_spoilt", "{}", spoilt.most_beyond);
  }
  PageData data;
  data.set("readout", "{}", readout_title(readout))
      .set("moving_flips", "{}", flip.moving)
      .set("flips", "{}", flip.faults)
      .set("flips_beyond", "{}", flip.moving_beyond)
      .set("most_moved", "{}", flip.most_moved)
      .part("hot_changes", std::move(hot_changes));
  return data;
}

PageData page_of(std::span<const FaultCaseResult> results, const FaultStudyOptions& options,
                 const std::string& command_line) {
  const FaultCaseResult all = total(results, [](const FaultCase&) { return true; });
  std::vector<PageData> readouts;
  for (const Readout readout : readouts_of(results)) {
    if (auto data = readout_data(results, readout)) {
      readouts.push_back(*std::move(data));
    }
  }
  const auto count = [](auto number) { return unless_none(static_cast<std::uint64_t>(number)); };
  PageData page;
  page.set("columns", "{}", kFaultColumns)
      .set("rows", "{}", kFaultRows)
      .set("acquisitions", "{}", options.acquisitions)
      .set("command", "{}", command_line)
      .set("seed", "{}", options.seed)
      .set("frames", "{}", all.frames)
      .part("broken_frames", count(all.broken_frames))
      .set("next_frames", "{}", all.next_frames)
      .part("wrong_next_frames", count(all.wrong_next_frames))
      .part("changed_elsewhere", count(all.changed_elsewhere))
      .part("model_mismatches", count(all.model_mismatches))
      .list("readouts", std::move(readouts))
      .set("flipped_bits", flip_table(results))
      .set("stuck_columns", column_table(results))
      .set("other_rows", "{}", kFaultRows - 1)
      .set("faulty_pixels", pixel_table(results))
      .set("next_frame", next_frame_table(results));
  return page;
}

}  // namespace

FaultReport report_faults(std::span<const FaultCaseResult> results, const FaultStudyOptions& options,
                          const std::string& command_line) {
  return {page_of(results, options, command_line), csv_of(results)};
}

bool faults_stay_where_they_are(std::span<const FaultCaseResult> results) {
  return std::ranges::all_of(results, [](const FaultCaseResult& result) {
    return result.broken_frames == 0 && result.model_mismatches == 0 && result.changed_elsewhere == 0 &&
           result.wrong_next_frames == 0;
  });
}

}  // namespace dtof
