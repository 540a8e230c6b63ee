// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/estimate.hpp"

#include <algorithm>
#include <cmath>

#include "dtof/scene/room.hpp"
#include "dtof/sensor/preset.hpp"

// The formulas are those of synth/dtof_synth/estimate.py, which fits the coefficients.

namespace dtof {
namespace {

constexpr double kLeastColumnShare = 0.3;  // of the reference's column
constexpr double kLeastControlShare = 0.1;
// From an SRAM's data to a register, with setup and uncertainty.
constexpr double kAfterAccessNs = 0.5;
constexpr double kAfterPoolAccessNs = 1.24;
// An engine's line crosses all of its columns in a clock; of a synthesised engine of 200 columns.
constexpr double kEngineColumnNs = 0.0196;

double column_um2(const ArrayChoice& array, const ReadoutCoefficients& of, const FamilySlopes& slopes) {
  const ReadoutParameters& p = array.parameters;
  const ReadoutParameters& base = of.reference.parameters;
  const bool pool = is_pool_readout(p.readout);
  double area = of.column_um2 + slopes.np * (p.np - base.np) +
                slopes.count_width * (p.count_width - base.count_width) +
                slopes.time_gate * (p.time_gate ? 1.0 : 0.0) +
                slopes.pixels * std::log2(static_cast<double>(array.rows) * array.columns /
                                          of.reference.rows / of.reference.columns);
  if (pool) {
    area += slopes.labels * (p.pool.labels - base.pool.labels);
  } else {
    area += slopes.nb * (p.nb - base.nb) + slopes.fraction_bits * (p.fraction_bits - base.fraction_bits) +
            slopes.confidence_width * (p.confidence_width - base.confidence_width) +
            slopes.pointer_ports * (array.pointer_ports - of.reference.pointer_ports);
  }
  return std::max(area, kLeastColumnShare * of.column_um2);
}

double control_um2(const ArrayChoice& array, const ReadoutCoefficients& of, const FamilySlopes& slopes) {
  return std::max(of.control_um2 + slopes.control_um2_a_column * (array.columns - of.reference.columns),
                  kLeastControlShare * of.control_um2);
}

/// um2 of an array's cells.
struct Logic {
  double column;
  double control;
  double engines;
  double whole;
  double clocked;  // hold buffers are not: as if all columns were the reference's

  Logic(const ArrayChoice& array, const EstimateCoefficients& coefficients) {
    const ReadoutCoefficients& of = coefficients.of(array.parameters.readout);
    const FamilySlopes& slopes = coefficients.slopes(array.parameters.readout);
    column = column_um2(array, of, slopes);
    control = control_um2(array, of, slopes);
    const int labels = array.parameters.pool.labels - of.reference.parameters.pool.labels;
    engines = array.engines() * (of.engine_um2 + slopes.engine_um2_a_label * labels);
    whole = column * array.columns + control + engines;
    clocked = of.column_um2 * array.columns + control + engines;
  }
};

struct Memories {
  double area_um2 = 0.0;
  double leakage_mw = 0.0;
  double access_pj = 0.0;  // a read and a write of each memory, a column

  explicit Memories(const ArrayChoice& array) {
    for (const MacroSize& size : column_memories(array)) {
      const SramMacro macro = sram_macro(size);
      // The cost of a memory that several columns share is divided by the columns of a module, as in the
      // flow's table.
      area_um2 += macro.area_um2 / array.module_columns() * array.columns;
      leakage_mw += 1e-3 * macro.leakage_uw * array.modules();
      access_pj += (macro.read_pj + macro.write_pj) / array.module_columns();
    }
    for (const MacroSize& size : engine_memories(array)) {
      const SramMacro macro = sram_macro(size);
      area_um2 += macro.area_um2 * array.engines();
      leakage_mw += 1e-3 * macro.leakage_uw * array.engines();
    }
  }
};

/// Mean of min(N, slots) over slots, N Poisson.
double taken_slots(double events, int slots) {
  double probability = std::exp(-events);
  double missing = 0.0;
  for (int n = 0; n < slots; ++n) {
    missing += (slots - n) * probability;
    probability *= events / (n + 1);
  }
  return 1.0 - missing / slots;
}

/// Shortest period that the SRAMs allow in the slow corner, ns.
double sram_period_ns(const ArrayChoice& array) {
  double access_ns = 0.0;
  for (const std::vector<MacroSize>& sizes : {column_memories(array), engine_memories(array)}) {
    for (const MacroSize& size : sizes) {
      access_ns = std::max(access_ns, sram_macro(size).access_slow_ns);
    }
  }
  return access_ns + (is_pool_readout(array.parameters.readout) ? kAfterPoolAccessNs : kAfterAccessNs);
}

double between(double dusk, double day, double share) { return std::max(dusk + share * (day - dusk), 0.0); }

}  // namespace

CostEstimate estimate_cost(const ArrayChoice& array, const EstimateCoefficients& coefficients) {
  const ReadoutCoefficients& of = coefficients.of(array.parameters.readout);
  constexpr double kMegahertz = 1e3;  // 1 / ns
  const int beyond = std::max(array.columns - of.reference.columns, 0);
  const int engine = is_pool_readout(array.parameters.readout)
                         ? std::min(array.parameters.pool.engine_columns, array.columns)
                         : 0;
  const double line_ns = kEngineColumnNs * std::max(engine - kWidestEngine, 0);
  return {.mm2 = array.arrays * (Logic(array, coefficients).whole + Memories(array).area_um2) * 1e-6,
          .fmax_mhz = kMegahertz /
                      std::max(kMegahertz / of.fmax_mhz + beyond * coefficients.period_slope_ns + line_ns,
                               sram_period_ns(array)),
          .bits_per_pixel = bits_per_pixel(array)};
}

double slot_rate(const SensorModel& sensor, const TargetMap& targets, double klux) {
  double sum = 0.0;
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      const PixelTarget& target = targets.at(column, row);
      const double signal =
          target.returns_signal() ? sensor.signal_events(target.depth_m, target.reflectivity) : 0.0;
      sum += taken_slots(signal + sensor.background_events(klux, target.reflectivity), sensor.slots);
    }
  }
  return sum / targets.columns() / targets.rows();
}

double reference_slot_rate(double klux) {
  constexpr int kColumns = 4;  // of the arrays that are simulated
  const SensorModel thesis = parse_preset("thesis");
  return slot_rate(thesis, make_room(kColumns, kArrayRows, thesis.default_reflectivity), klux);
}

double estimate_mw(const ArrayChoice& array, double slots_taken, double clock_mhz,
                   const EstimateCoefficients& coefficients) {
  static const double day_rate = reference_slot_rate(kDayKlux);
  static const double dusk_rate = reference_slot_rate(kDuskKlux);
  const ReadoutCoefficients& of = coefficients.of(array.parameters.readout);
  const double share = (slots_taken - dusk_rate) / (day_rate - dusk_rate);
  const Logic logic(array, coefficients);
  const Logic base(of.reference, coefficients);
  const Memories memories(array);
  const Memories base_memories(of.reference);
  const double columns = static_cast<double>(array.columns) / of.reference.columns;
  const double whole = logic.whole / base.whole;
  const double bits = std::pow(static_cast<double>(array.parameters.np) / of.reference.parameters.np,
                               coefficients.data_exponent);
  const double dynamic =
      between(of.dusk.columns, of.day.columns, share) * columns * bits +
      between(of.dusk.shared, of.day.shared, share) * (logic.control + logic.engines) /
          (base.control + base.engines) +
      between(of.dusk.sram, of.day.sram, share) * columns * memories.access_pj / base_memories.access_pj +
      between(of.dusk.clock, of.day.clock, share) * logic.clocked / base.clocked;
  return array.arrays * (dynamic * clock_mhz / kReferenceMhz +
                         (of.day.leakage - base_memories.leakage_mw) * whole + memories.leakage_mw);
}

}  // namespace dtof
