// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace dtof {

/// Fault of the RTL: a failed assertion, $stop, a violated interface rule, or a frame that does not end.
class RtlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace dtof
