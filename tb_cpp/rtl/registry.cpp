// SPDX-License-Identifier: Apache-2.0
#include "rtl/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

struct Entry {
  RtlConfiguration configuration;
  ArrayModelFactory factory;
};

// What an array simulates besides its columns takes about as long as this many of them.
constexpr int kControlColumns = 3;

// By key(): configurations that differ only in unused parameters are one.
std::map<std::string, Entry>& registry() {
  static std::map<std::string, Entry> entries;
  return entries;
}

// The gate's ends, a pool read-out's schedule, TEMPLATE and S1 are set with every frame.
ReadoutParameters compiled_parameters(ReadoutParameters parameters) {
  const PoolPointerParameters defaults = PoolPointerParameters::defaults(parameters.readout);
  parameters.pool.coarse_share = defaults.coarse_share;
  parameters.pool.track_share = defaults.track_share;
  parameters.pool.smooth = defaults.smooth;
  parameters.pool.coarse_template = defaults.coarse_template;
  if (parameters.time_gate) {
    parameters.time_gate = CodeGate{0, parameters.no_detection()};
  }
  return parameters;
}

std::string key(RtlConfiguration configuration) {
  configuration.parameters = compiled_parameters(configuration.parameters);
  return configuration.to_string();
}

/// Compiled CELL_SHIFTs of an array that is `wanted` in all else; empty if there is none.
std::string other_cell_shifts(ReadoutParameters wanted, int rows, int columns) {
  std::set<int> found;
  for (const auto& [text, entry] : registry()) {
    const RtlConfiguration& candidate = entry.configuration;
    wanted.pool.cell_shift = candidate.parameters.pool.cell_shift;
    if (compiled_parameters(candidate.parameters).to_string() == compiled_parameters(wanted).to_string() &&
        candidate.pixels_per_sram == rows && candidate.sram_num == columns) {
      found.insert(wanted.pool.cell_shift);
    }
  }
  return fmt::format("{}", fmt::join(found, ", "));
}

InputError not_compiled(const std::string& wanted) {
  std::string compiled;
  for (const auto& [text, entry] : registry()) {
    compiled += fmt::format("{}{}", compiled.empty() ? "" : " | ", text);
  }
  return InputError{fmt::format("no RTL is compiled for {}; compiled are: {}", wanted, compiled)};
}

/// `wanted` begins with the read-out's name, as the keys do.
InputError no_engine_compiled(const std::string& wanted, int rows, int columns) {
  const std::string name = wanted.substr(0, wanted.find(' ') + 1);
  std::string compiled;
  for (const auto& [text, entry] : registry()) {
    if (text.starts_with(name)) {
      compiled += fmt::format("{}{}", compiled.empty() ? "" : " | ", text);
    }
  }
  return InputError{
      fmt::format("no RTL is compiled for {} with just {} rows and an engine of just {} columns, which "
                  "use each other's results; compiled are: {}",
                  wanted, rows, columns, compiled.empty() ? "none" : compiled)};
}

}  // namespace

bool register_rtl_configuration(const RtlConfiguration& configuration, ArrayModelFactory factory) {
  registry().insert_or_assign(key(configuration), Entry{configuration, std::move(factory)});
  return true;
}

std::vector<RtlConfiguration> compiled_rtl_configurations() {
  std::vector<RtlConfiguration> configurations;
  for (const auto& [text, entry] : registry()) {
    configurations.push_back(entry.configuration);
  }
  return configurations;
}

RtlConfiguration find_rtl_configuration(const ReadoutParameters& parameters, int rows, int columns,
                                        bool waveform) {
  const bool whole_engine = parameters.columns_together() > 1;
  const auto records = [whole_engine](const auto& entry) {
    const RtlConfiguration& candidate = entry.second.configuration;
    return candidate.records_waveform && (candidate.parameters.columns_together() > 1) == whole_engine;
  };
  if (waveform && std::ranges::none_of(registry(), records)) {
    const std::string_view name = readout_name(parameters.readout);
    throw InputError(
        fmt::format("this program's arrays of {} record no waveforms, those of {} do (make wave READOUT={})",
                    name, whole_engine ? "dtof-wave-pool" : "dtof-wave", name));
  }
  const std::string wanted = compiled_parameters(parameters).to_string();
  std::optional<RtlConfiguration> best;
  const auto cost = [columns](const RtlConfiguration& candidate) {
    const int groups = (columns + candidate.sram_num - 1) / candidate.sram_num;
    const bool variant = candidate.pointer_ports != 2 || candidate.signalled_clear || candidate.parity ||
                         candidate.raw_histogram;
    return std::tuple(variant, candidate.pixels_per_sram, groups * (candidate.sram_num + kControlColumns));
  };
  for (const auto& [text, entry] : registry()) {
    const RtlConfiguration& candidate = entry.configuration;
    if (compiled_parameters(candidate.parameters).to_string() == wanted &&
        candidate.pixels_per_sram >= rows &&
        (!whole_engine || (candidate.sram_num == columns && candidate.pixels_per_sram == rows)) &&
        (candidate.records_waveform || !waveform) && (!best.has_value() || cost(candidate) < cost(*best))) {
      best = candidate;
    }
  }
  if (!best.has_value()) {
    if (whole_engine) {
      const std::string others = other_cell_shifts(parameters, rows, columns);
      if (!others.empty()) {
        throw InputError(fmt::format(
            "no RTL of {} is compiled for CELL_SHIFT={}, the windows that the pulse asks for; compiled: {}",
            readout_name(parameters.readout), parameters.pool.cell_shift, others));
      }
      throw no_engine_compiled(wanted, rows, columns);
    }
    throw not_compiled(fmt::format("{} with at least {} rows", wanted, rows));
  }
  best->parameters.time_gate = parameters.time_gate;
  const int engine_columns = best->parameters.pool.engine_columns;
  best->parameters.pool = parameters.pool;
  best->parameters.pool.engine_columns = engine_columns;
  return *best;
}

bool has_array(const RtlConfiguration& configuration) { return registry().contains(key(configuration)); }

std::unique_ptr<ArrayModel> make_array_model(const RtlConfiguration& configuration,
                                             VerilatedContext& context) {
  const auto entry = registry().find(key(configuration));
  if (entry == registry().end()) {
    throw not_compiled(key(configuration));
  }
  return entry->second.factory(context);
}

}  // namespace dtof
