// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// A limit of parameters.toml that the models have, too.
struct ParameterLimit {
  std::string_view parameter;  ///< as in the RTL, e.g. "COUNT_WIDTH"
  std::string_view sentence;   ///< word for word the one with which the RTL stops elaboration
  bool (*legal)(const ReadoutParameters&);
  int (*value)(const ReadoutParameters&);
};

/// Limits of the pool read-outs or of the others, in the order of parameters.toml (parameter_limits.cpp is
/// generated). A later limit may use what an earlier one has checked.
std::span<const ParameterLimit> parameter_limits(bool pool);
/// The first limit, of all or of one parameter, that the parameters break; nullptr if they break none.
const ParameterLimit* broken_limit(const ReadoutParameters& parameters, std::string_view parameter = {});
/// Throws InputError with the sentence of the first broken limit, of all or of one parameter, and the illegal
/// value.
void require_legal(const ReadoutParameters& parameters, std::string_view parameter = {});

}  // namespace dtof
