// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <type_traits>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// A parameter of readouts.toml that changes a model's result.
struct ParameterEntry {
  std::string_view name;  ///< as in the RTL, e.g. "COUNT_WIDTH"
  std::string_view help;  ///< meaning, from readouts.toml
  std::string_view
      legal;  ///< legal values, from parameters.toml, e.g. "3 to 16 bits; poolPointer: 8 to 16 bits"
  bool flag;  ///< true if the value is 0 or 1
  int (*get)(const ReadoutParameters&);
  void (*set)(ReadoutParameters&, int);
};

/// All parameters of the models, in the order of readouts.toml (parameter_table.cpp is generated).
std::span<const ParameterEntry> parameter_entries();
/// The entry of a parameter; nullptr if the models have no such parameter.
const ParameterEntry* find_parameter_entry(std::string_view name);

namespace detail {

template <typename Type, typename Owner>
Owner owner_of(Type Owner::*member);
template <typename Type, typename Owner>
Type type_of(Type Owner::*member);

/// The part of the parameters with a member.
template <typename Owner, typename Parameters>
constexpr auto& part(Parameters& parameters) {
  if constexpr (std::is_same_v<Owner, ReadoutParameters>) {
    return parameters;
  } else {
    return parameters.pool;
  }
}

}  // namespace detail

/// Entry of a member of ReadoutParameters or PoolPointerParameters, a number or a bool.
template <auto Member>
constexpr ParameterEntry entry(std::string_view name, std::string_view help, std::string_view legal) {
  using Owner = decltype(detail::owner_of(Member));
  using Type = decltype(detail::type_of(Member));
  return {
      .name = name,
      .help = help,
      .legal = legal,
      .flag = std::is_same_v<Type, bool>,
      .get =
          [](const ReadoutParameters& from) { return static_cast<int>(detail::part<Owner>(from).*Member); },
      .set =
          [](ReadoutParameters& to, int value) {
            if constexpr (std::is_same_v<Type, bool>) {
              detail::part<Owner>(to).*Member = value != 0;
            } else {
              detail::part<Owner>(to).*Member = value;
            }
          }};
}

}  // namespace dtof
