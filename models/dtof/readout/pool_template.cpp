// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pool_template.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dtof/core/error.hpp"
#include "dtof/readout/pool_parts.hpp"
#include "dtof/readout/pool_pointer.hpp"

namespace dtof {
namespace {

constexpr double kTemplateMargin = 3.0;
constexpr double kGroupsInSum = 7.0;  // the own group three times, and four neighbours
constexpr double kColumnsOfGroup = 2.0;

}  // namespace

PoolTemplate measured_template(std::span<const ColumnStream> columns, std::uint32_t acquisitions,
                               const ReadoutParameters& parameters) {
  const std::uint32_t coarse_end = PoolSchedule(acquisitions, parameters.pool).coarse_end;
  std::array<std::uint64_t, kCoarseBins> counts{};
  std::uint64_t pairs_of_rows = 0;
  for (const ColumnStream& column : columns) {
    const PoolColumn events = pool_column_events(column, parameters.np, acquisitions);
    for (std::size_t row = 0; row + 1 < events.size(); row += 2) {
      ++pairs_of_rows;
      count_one_of_two_rows<PoolEvent>(events[row], events[row + 1], [&](const PoolEvent& event) {
        if (event.acquisition < coarse_end && event.acquisition % kSweepPeriod != kSweepPeriod - 1) {
          ++counts[event.preferred / kUnitsPerCoarseBin];
        }
      });
    }
  }
  if (pairs_of_rows == 0) {
    throw InputError("a template needs a column of at least two rows");
  }
  const double pairs_in_group = kColumnsOfGroup * parameters.pool.group_size / 2.0;
  const double scale = kTemplateMargin * kGroupsInSum * pairs_in_group /
                       (pool_template_unit(parameters.count_width) * static_cast<double>(pairs_of_rows));
  PoolTemplate taken{};
  std::ranges::transform(counts, taken.begin(), [&](std::uint64_t count) {
    return static_cast<std::uint8_t>(std::min(std::round(scale * static_cast<double>(count)),
                                              double{std::numeric_limits<std::uint8_t>::max()}));
  });
  return taken;
}

}  // namespace dtof
