// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/parameter_entry.hpp"

#include <algorithm>

namespace dtof {

const ParameterEntry* find_parameter_entry(std::string_view name) {
  const auto found = std::ranges::find(parameter_entries(), name, &ParameterEntry::name);
  return found == parameter_entries().end() ? nullptr : &*found;
}

}  // namespace dtof
