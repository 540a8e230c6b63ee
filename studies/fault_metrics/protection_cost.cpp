// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/protection_cost.hpp"

#include <vector>

#include "dtof/io/csv_table.hpp"

namespace dtof {
namespace {

/// Number in `figures` on the line where every key column has its value; none without such a line.
std::optional<double> figure(const CsvTable& table, const std::string& name, const std::string& corner,
                             const char* column) {
  const std::vector<std::string> names = table.texts("configuration");
  const std::vector<std::string> figures = table.texts(column);
  const std::vector<std::string> corners =
      corner.empty() ? std::vector<std::string>(names.size()) : table.texts("corner");
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name && corners[i] == corner && !figures[i].empty()) {
      return std::stod(figures[i]);
    }
  }
  return std::nullopt;
}

std::optional<ArrayCost> array_cost(const CsvTable& area, const CsvTable& timing, const std::string& name) {
  const auto mm2 = figure(area, name, "", "total_mm2");
  const auto logic = figure(timing, name, "typical", "logic_mw");
  const auto sram = figure(timing, name, "typical", "sram_mw");
  const auto clock = figure(timing, name, "typical", "clock_mw");
  const auto fmax = figure(timing, name, "slow", "fmax_mhz");
  if (!mm2 || !logic || !sram || !clock || !fmax) {
    return std::nullopt;
  }
  return ArrayCost{.mm2 = *mm2, .mw = *logic + *sram + *clock, .fmax_mhz = *fmax};
}

}  // namespace

std::optional<ProtectionCost> protection_cost(const std::filesystem::path& reports,
                                              const std::string& readout) {
  const CsvTable area(reports / "area.csv");
  const CsvTable timing(reports / "timing.csv");
  const auto without = array_cost(area, timing, readout);
  const auto with = array_cost(area, timing, readout + "_parity");
  if (!without || !with) {
    return std::nullopt;
  }
  return ProtectionCost{.without = *without, .with = *with};
}

}  // namespace dtof
