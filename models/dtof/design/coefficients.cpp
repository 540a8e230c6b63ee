// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/coefficients.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include "dtof/core/error.hpp"
#include "dtof/design/coefficients_text.hpp"

namespace dtof {
namespace {

/// A part of the file, with its place for messages.
struct Part {
  const toml::table& table;
  std::string place;

  [[nodiscard]] double number(std::string_view key) const {
    const auto value = table[key].value<double>();
    if (!value) {
      throw InputError(fmt::format("coefficients: {} has no number {}", place, key));
    }
    return *value;
  }
  [[nodiscard]] Part part(std::string_view key) const {
    const toml::table* found = table[key].as_table();
    if (found == nullptr) {
      throw InputError(fmt::format("coefficients: {} has no table {}", place, key));
    }
    return {*found, fmt::format("{}.{}", place, key)};
  }
};

FamilySlopes read_slopes(const Part& part) {
  return {.np = part.number("NP"),
          .nb = part.number("NB"),
          .count_width = part.number("COUNT_WIDTH"),
          .fraction_bits = part.number("FRACTION_BITS"),
          .confidence_width = part.number("CONFIDENCE_WIDTH"),
          .pointer_ports = part.number("POINTER_PORTS"),
          .time_gate = part.number("TIME_GATE"),
          .labels = part.number("LABELS"),
          .pixels = part.number("PIXELS"),
          .control_um2_a_column = part.number("control_um2_a_column"),
          .engine_um2_a_label = part.number("engine_um2_a_label")};
}

PowerParts read_power(const Part& part) {
  return {.columns = part.number("columns"),
          .shared = part.number("shared"),
          .sram = part.number("sram"),
          .clock = part.number("clock"),
          .leakage = part.number("leakage")};
}

ArrayChoice read_reference(Readout readout, const Part& part) {
  ArrayChoice array;
  array.parameters = ReadoutParameters::defaults(readout);
  const auto set = [&](std::string_view key, int& value) {
    if (part.table.contains(key)) {
      value = static_cast<int>(part.number(key));
    }
  };
  set("NP", array.parameters.np);
  set("NB", array.parameters.nb);
  set("COUNT_WIDTH", array.parameters.count_width);
  set("FRACTION_BITS", array.parameters.fraction_bits);
  set("CONFIDENCE_WIDTH", array.parameters.confidence_width);
  set("POINTER_PORTS", array.pointer_ports);
  set("PIXELS_PER_SRAM", array.rows);
  set("SRAM_NUM", array.columns);
  set("LABELS", array.parameters.pool.labels);
  set("ENGINE_COLUMNS", array.parameters.pool.engine_columns);
  return array;
}

}  // namespace

EstimateCoefficients EstimateCoefficients::parse(std::string_view toml) {
  toml::table table;
  try {
    table = toml::parse(toml);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("coefficients: {}", error.description()));
  }
  const Part all{table, "the file"};
  EstimateCoefficients found;
  found.digest = table["digest"].value_or(std::string());
  found.period_slope_ns = all.number("period_slope_ns");
  const Part errors = all.part("error");
  found.errors = {errors.number("area"), errors.number("power"), errors.number("fmax")};
  found.data_exponent = all.number("data_exponent");
  found.pointer = read_slopes(all.part("family").part("pointer"));
  found.histogram = read_slopes(all.part("family").part("histogram"));
  found.pool = read_slopes(all.part("family").part("pool"));
  const Part readouts = all.part("readout");
  for (const auto& [key, node] : readouts.table) {
    const Part part = readouts.part(key.str());
    const Readout readout = parse_readout(key.str());
    found.readouts[readout] = {.reference = read_reference(readout, part.part("reference")),
                               .column_um2 = part.number("column_um2"),
                               .control_um2 = part.number("control_um2"),
                               .engine_um2 = part.number("engine_um2"),
                               .fmax_mhz = part.number("fmax_mhz"),
                               .day = read_power(part.part("day")),
                               .dusk = read_power(part.part("dusk"))};
  }
  return found;
}

const EstimateCoefficients& EstimateCoefficients::built_in() {
  static const EstimateCoefficients coefficients = parse(coefficients_text());
  return coefficients;
}

const ReadoutCoefficients& EstimateCoefficients::of(Readout readout) const {
  const auto found = readouts.find(readout);
  if (found == readouts.end()) {
    throw InputError(fmt::format("there is no estimate of {}", readout_name(readout)));
  }
  return found->second;
}

}  // namespace dtof
