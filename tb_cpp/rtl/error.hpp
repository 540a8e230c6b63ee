// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace dtof {

/// The RTL misbehaved: a failed assertion or $stop, a broken interface rule, a frame that does not end.
class RtlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace dtof
