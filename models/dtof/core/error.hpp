// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace dtof {

/// Bad input from outside (file, flag, parameter): one line that says where and what.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user asked to stop (SIGINT/SIGTERM) during long work.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace dtof
