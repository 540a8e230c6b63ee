// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dtof/core/error.hpp"

namespace dtof {

/// An output that cannot be written, for instance on a full disk: one line that says where and why.
class OutputError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace dtof
