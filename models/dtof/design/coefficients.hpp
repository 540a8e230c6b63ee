// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "dtof/core/readout.hpp"
#include "dtof/design/array_memories.hpp"

namespace dtof {

/// Power of an array in mW while acquisitions stream in, at kReferenceMhz.
struct PowerParts {
  double columns = 0.0;
  double shared = 0.0;  ///< engines and control
  double sram = 0.0;    ///< memory accesses
  double clock = 0.0;
  double leakage = 0.0;
};

/// Clock of the synthesised configurations, and the light levels of their power figures.
inline constexpr double kReferenceMhz = 330.0;
inline constexpr double kDayKlux = 50.0;
inline constexpr double kDuskKlux = 2.0;

/// Cost of a read-out's default configuration, as synthesised.
struct ReadoutCoefficients {
  ArrayChoice reference;
  double column_um2 = 0.0;
  double control_um2 = 0.0;
  double engine_um2 = 0.0;
  double fmax_mhz = 0.0;
  PowerParts day;
  PowerParts dusk;
};

/// Change of a column's logic area per step of a parameter, um2.
struct FamilySlopes {
  double np = 0.0;
  double nb = 0.0;
  double count_width = 0.0;
  double fraction_bits = 0.0;
  double confidence_width = 0.0;
  double pointer_ports = 0.0;
  double time_gate = 0.0;
  double labels = 0.0;
  double pixels = 0.0;  ///< per doubling of the array's pixels
  double control_um2_a_column = 0.0;
  double engine_um2_a_label = 0.0;  ///< of an engine, per candidate (LABELS)
};

/// Relative errors of estimates for configurations that were not used in the fit.
struct EstimateErrors {
  double area = 0.0;  ///< largest of all configurations
  double power = 0.0;
  double fmax = 0.0;
};

/// Contents of coefficients.toml, which `synth/synth.py estimate` writes.
struct EstimateCoefficients {
  std::string digest;
  double period_slope_ns = 0.0;  ///< per column beyond the reference's columns
  EstimateErrors errors;
  double data_exponent = 0.0;  ///< a column's data power grows as NP to this exponent
  FamilySlopes pointer;        ///< read-outs without a histogram
  FamilySlopes histogram;
  FamilySlopes pool;
  std::map<Readout, ReadoutCoefficients> readouts;

  /// Parses coefficients.toml. Throws InputError for any other text.
  static EstimateCoefficients parse(std::string_view toml);
  /// Coefficients compiled into the program.
  static const EstimateCoefficients& built_in();

  [[nodiscard]] const FamilySlopes& slopes(Readout readout) const {
    return is_pool_readout(readout) ? pool : readout == Readout::kEzPointer ? pointer : histogram;
  }
  /// Throws InputError for a read-out without coefficients.
  [[nodiscard]] const ReadoutCoefficients& of(Readout readout) const;
};

}  // namespace dtof
