// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "dtof/core/error.hpp"

namespace dtof {

/// Returns the message of the InputError that `action` throws, or "accepted" if `action` throws nothing.
inline std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace dtof
