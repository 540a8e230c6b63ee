// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace dtof {

/// Verilator and the C++ compiler of this machine.
struct Toolchain {
  std::string verilator_version;  ///< from `verilator --version`
  std::string verilator_include;  ///< folder of verilated.h
  /// First words of the compiler command: CXX, or the compiler of this program.
  std::vector<std::string> compiler;
  std::string compiler_version;  ///< the first line of its --version

  /// Toolchain by PATH and CXX, found once. Throws InputError with one line that names the missing tool, or
  /// if Verilator and this program's Verilator runtime differ in version.
  static const Toolchain& find();
};

}  // namespace dtof
