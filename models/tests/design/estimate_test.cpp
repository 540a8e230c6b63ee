// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/estimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

const std::filesystem::path kReports = DTOF_REPORTS;

/// Arrays of configurations.toml by what they change; the others keep the defaults.
std::map<std::string, ArrayChoice> named_arrays() {
  std::map<std::string, ArrayChoice> arrays;
  const auto add = [&](const std::string& name, Readout readout, auto change) {
    ArrayChoice array;
    array.parameters = ReadoutParameters::defaults(readout);
    change(array);
    arrays[name] = array;
  };
  const auto none = [](ArrayChoice&) {};
  for (const Readout readout : kRtlReadouts) {
    std::string name(readout_name(readout));
    if (const auto dash = name.find('-'); dash != std::string::npos) {
      name[dash] = '_';
    }
    add(name, readout, none);
  }
  arrays["histogram"].rows = 10;
  add("ezpointer_bare", Readout::kEzPointer, [](ArrayChoice& a) { a.parameters.confidence_width = 0; });
  add("ezpointer_one_port", Readout::kEzPointer, [](ArrayChoice& a) { a.pointer_ports = 1; });
  add("ezpointer_fraction4", Readout::kEzPointer, [](ArrayChoice& a) { a.parameters.fraction_bits = 4; });
  add("hispointer_one_port", Readout::kHisPointer, [](ArrayChoice& a) { a.pointer_ports = 1; });
  add("hispointer_fraction4", Readout::kHisPointer, [](ArrayChoice& a) { a.parameters.fraction_bits = 4; });
  add("hispointer_count8", Readout::kHisPointer, [](ArrayChoice& a) { a.parameters.count_width = 8; });
  add("hispointer_count12", Readout::kHisPointer, [](ArrayChoice& a) { a.parameters.count_width = 12; });
  add("sifh_count8", Readout::kSifh, [](ArrayChoice& a) { a.parameters.count_width = 8; });
  add("sifh_count12", Readout::kSifh, [](ArrayChoice& a) { a.parameters.count_width = 12; });
  add("fifh_count8", Readout::kFifh, [](ArrayChoice& a) { a.parameters.count_width = 8; });
  add("fifh_count12", Readout::kFifh, [](ArrayChoice& a) { a.parameters.count_width = 12; });
  return arrays;
}

TEST(Estimate, MemoriesAreThoseOfTheFlowExactly) {
  const CsvTable table(kReports / "area.csv");
  for (const auto& [name, array] : named_arrays()) {
    const std::vector<std::string> names = table.texts("configuration");
    const auto line = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    ASSERT_LT(line, names.size()) << name;
    double area = 0.0;
    for (const MacroSize& size : column_memories(array)) {
      area += sram_macro(size).area_um2 / array.module_columns();
    }
    EXPECT_NEAR(area, table.column("sram_column_um2")[line], 0.06) << name;
    EXPECT_NEAR(bits_per_pixel(array), table.column("bits_per_pixel")[line], 0.01) << name;
  }
}

// The sizes that dtof_pool_engine.sv asks for: synth/tests/test_configuration.py elaborates the same
// parameters.
TEST(Estimate, AnEngineStoresTheConfidenceOfTheColumnToTheLeftWithSignificances) {
  ArrayChoice array;
  array.parameters = ReadoutParameters::defaults(Readout::kPoolPointerLean);
  array.rows = 39;
  PoolPointerParameters& pool = array.parameters.pool;
  const auto bits = [&] { return engine_memories(array).front().bits; };
  EXPECT_EQ(bits(), 23);  // of choose, with four candidates
  pool.labels = 2;
  EXPECT_EQ(bits(), 20);
  pool.count_bits = 7;
  pool.rival_moves = true;
  EXPECT_EQ(pool.significance_bits(), 3);
  EXPECT_EQ(bits(), 28);
  pool.count_bits = 4;
  EXPECT_EQ(bits(), 20);
}

TEST(Estimate, AreaIsThatOfTheFlowWithinTheStatedError) {
  const CsvTable table(kReports / "area.csv");
  const std::vector<std::string> names = table.texts("configuration");
  const std::vector<double> measured = table.column("total_mm2");
  const double error = EstimateCoefficients::built_in().errors.area;
  EXPECT_GT(error, 0.0);
  for (const auto& [name, array] : named_arrays()) {
    const auto line = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    ASSERT_LT(line, names.size()) << name;
    EXPECT_NEAR(estimate_cost(array).mm2 / measured[line], 1.0, error) << name;
  }
}

TEST(Estimate, AreaOfTheDefaultsIsTheFlowsOwn) {
  const CsvTable table(kReports / "area.csv");
  const std::vector<std::string> names = table.texts("configuration");
  const std::vector<double> measured = table.column("total_mm2");
  for (const auto& [readout, of] : EstimateCoefficients::built_in().readouts) {
    std::string name(readout_name(readout));
    std::ranges::replace(name, '-', '_');
    const auto line = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    ASSERT_LT(line, names.size()) << name;
    EXPECT_NEAR(estimate_cost(of.reference).mm2 / measured[line], 1.0, 0.001) << name;
  }
}

TEST(Estimate, PowerOfTheDefaultsIsTheReportsInBothLights) {
  const CsvTable table(kReports / "power.csv");
  const std::vector<std::string> names = table.texts("configuration");
  const std::vector<std::string> phases = table.texts("phase");
  const std::vector<double> klux = table.column("klux");
  const std::vector<double> total = table.column("total_mw");
  int compared = 0;
  for (std::size_t line = 0; line < names.size(); ++line) {
    for (const auto& [readout, of] : EstimateCoefficients::built_in().readouts) {
      std::string name(readout_name(readout));
      std::ranges::replace(name, '-', '_');
      if (names[line] == name && phases[line] == "streaming") {
        EXPECT_NEAR(estimate_mw(of.reference, reference_slot_rate(klux[line]), kReferenceMhz) / total[line],
                    1.0, 0.002)
            << name;
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 2 * static_cast<int>(EstimateCoefficients::built_in().readouts.size()));
}

TEST(Estimate, PowerGrowsWithTheClockLightAndColumns) {
  ArrayChoice array = EstimateCoefficients::built_in().of(Readout::kSifh).reference;
  const double base = estimate_mw(array, 0.1, 330.0);
  EXPECT_GT(estimate_mw(array, 0.2, 330.0), base);
  EXPECT_GT(estimate_mw(array, 0.1, 360.0), base);
  array.columns *= 2;
  EXPECT_NEAR(estimate_mw(array, 0.1, 330.0) / base, 2.0, 0.1);
}

TEST(Estimate, SlotRateIsTheMeanOfWhatPoissonEventsLeave) {
  SensorModel sensor = parse_preset("thesis");
  sensor.dark_count_rate_hz = 0.0;
  const TargetMap dark(2, 2, {0.0, 1.0});
  EXPECT_DOUBLE_EQ(slot_rate(sensor, dark, 0.0), 0.0);
  sensor.slots = 1;
  const double events = sensor.background_events(50.0, 1.0);
  EXPECT_NEAR(slot_rate(sensor, dark, 50.0), 1.0 - std::exp(-events), 1e-12);
  sensor.slots = 2;
  EXPECT_NEAR(slot_rate(sensor, dark, 50.0), 1.0 - std::exp(-events) * (1.0 + events / 2), 1e-12);
}

TEST(Estimate, RefusesAFileThatIsNone) {
  EXPECT_THROW(EstimateCoefficients::parse("a = "), InputError);
  EXPECT_THROW(EstimateCoefficients::parse("period_slope_ns = 1"), InputError);
  EXPECT_THROW(sram_macro({3, 10, 10}), InputError);
}

}  // namespace
}  // namespace dtof
