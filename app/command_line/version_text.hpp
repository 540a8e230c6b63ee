// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace dtof {

/// JSON object with program, version, compiler, build type, C++ standard, system, machine and processors.
std::string version_json(const std::string& program, const std::string& version);

}  // namespace dtof
