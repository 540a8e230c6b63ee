// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "dtof/core/readout.hpp"
#include "dtof/design/array_memories.hpp"

namespace dtof {

/// mW of an array while acquisitions stream in, at kReferenceMhz.
struct PowerParts {
  double columns = 0.0;
  double shared = 0.0;  ///< engines and control
  double sram = 0.0;    ///< accesses
  double clock = 0.0;
  double leakage = 0.0;
};

/// Clock of the synthesised points and lights of their power.
inline constexpr double kReferenceMhz = 330.0;
inline constexpr double kDayKlux = 50.0;
inline constexpr double kDuskKlux = 2.0;

/// A read-out's defaults as the flow has them.
struct ReadoutCoefficients {
  ArrayChoice reference;
  double column_um2 = 0.0;
  double control_um2 = 0.0;
  double engine_um2 = 0.0;
  double fmax_mhz = 0.0;
  PowerParts day;
  PowerParts dusk;
};

/// What a column's logic costs for a step of a parameter, um2.
struct FamilySlopes {
  double np = 0.0;
  double nb = 0.0;
  double count_width = 0.0;
  double fraction_bits = 0.0;
  double confidence_width = 0.0;
  double pointer_ports = 0.0;
  double time_gate = 0.0;
  double pixels = 0.0;  ///< of a doubling of the array's
  double control_um2_a_column = 0.0;
};

/// Relative errors of estimates, of configurations that no fit has seen.
struct EstimateErrors {
  double area = 0.0;  ///< the largest
  double power = 0.0;
  double fmax = 0.0;
};

/// coefficients.toml, which `synth/synth.py estimate` writes.
struct EstimateCoefficients {
  std::string digest;
  double period_slope_ns = 0.0;  ///< of each column beyond the reference's
  EstimateErrors errors;
  double data_exponent = 0.0;  ///< of NP, to which a column's data power is proportional
  FamilySlopes pointer;        ///< read-outs without a histogram
  FamilySlopes histogram;
  FamilySlopes pool;
  std::map<Readout, ReadoutCoefficients> readouts;

  /// Throws InputError for a text that is not such a file.
  static EstimateCoefficients parse(std::string_view toml);
  /// Those that the program was built with.
  static const EstimateCoefficients& built_in();

  [[nodiscard]] const FamilySlopes& slopes(Readout readout) const {
    return is_pool_readout(readout) ? pool : readout == Readout::kEzPointer ? pointer : histogram;
  }
  /// Throws InputError for a read-out that has none.
  [[nodiscard]] const ReadoutCoefficients& of(Readout readout) const;
};

}  // namespace dtof
