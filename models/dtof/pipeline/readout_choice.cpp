// SPDX-License-Identifier: Apache-2.0
#include "dtof/pipeline/readout_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dtof/core/error.hpp"
#include "dtof/core/parameter_entry.hpp"

namespace dtof {
namespace {

bool belongs_to(Readout readout, std::string_view parameter) {
  return parameter == "NP" || parameter == "SLOTS" || has_parameter(readout, parameter);
}

const ParameterEntry& find_choice(Readout readout, std::string_view name) {
  const ParameterEntry* const found = find_parameter_entry(name);
  if (found == nullptr || !belongs_to(readout, name)) {
    throw InputError(fmt::format("{} has no parameter {}; it has {}", readout_name(readout), name,
                                 fmt::join(parameter_names(readout), ", ")));
  }
  return *found;
}

}  // namespace

std::vector<std::string_view> parameter_names(Readout readout) {
  std::vector<std::string_view> names = {"NP", "SLOTS"};
  for (const ParameterEntry& entry : parameter_entries()) {
    if (has_parameter(readout, entry.name)) {
      names.push_back(entry.name);
    }
  }
  return names;
}

int get_parameter(const ReadoutParameters& parameters, std::string_view name) {
  return find_choice(parameters.readout, name).get(parameters);
}

void set_parameter(ReadoutParameters& parameters, std::string_view name, int value) {
  const ParameterEntry& entry = find_choice(parameters.readout, name);
  if (entry.flag && value != 0 && value != 1) {
    throw InputError(fmt::format("{} must be 0 or 1, is {}", name, value));
  }
  entry.set(parameters, value);
}

}  // namespace dtof
