// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace dtof {

/// Verilator and the C++ compiler of this machine.
struct Toolchain {
  std::string verilator_version;      ///< as `verilator --version` says
  std::string verilator_include;      ///< folder of verilated.h
  std::vector<std::string> compiler;  ///< the command's first words: CXX, or what the program was built with
  std::string compiler_version;       ///< the first line of its --version

  /// Those of PATH and CXX, asked once. Throws InputError with one line that names what is missing, or a
  /// Verilator that is not the one of this program's runtime.
  static const Toolchain& find();
};

}  // namespace dtof
