// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace dtof {

/// Figures of one configuration in reports/area.csv and reports/timing.csv.
struct ArrayCost {
  double mm2 = 0.0;
  double mw = 0.0;        ///< typical corner, 330 MHz, stated activity
  double fmax_mhz = 0.0;  ///< slow corner
};

/// Cost of the array without and with parity.
struct ProtectionCost {
  ArrayCost without;
  ArrayCost with;

  /// Area of the protection as a share of the array without.
  [[nodiscard]] double area_share() const { return with.mm2 / without.mm2 - 1.0; }
};

/// Costs of a read-out and of its configuration `<readout>_parity`; none if one of them was not synthesised.
/// Throws InputError if a report is missing or has no such column.
std::optional<ProtectionCost> protection_cost(const std::filesystem::path& reports,
                                              const std::string& readout);

}  // namespace dtof
