// SPDX-License-Identifier: Apache-2.0
#include "command_line/version_text.hpp"

#include <sys/utsname.h>

#include <nlohmann/json.hpp>
#include <thread>

namespace dtof {

std::string version_json(const std::string& program, const std::string& version) {
  utsname system{};
  const bool known = ::uname(&system) == 0;
  nlohmann::ordered_json text;
  text["program"] = program;
  text["version"] = version;
  text["compiler"] = __VERSION__;
  text["build_type"] = DTOF_BUILD_TYPE;
  text["cplusplus"] = __cplusplus;
  text["system"] = known ? std::string(system.sysname) + " " + system.release : "unknown";
  text["machine"] = known ? system.machine : "unknown";
  text["processors"] = std::thread::hardware_concurrency();
  return text.dump(2);
}

}  // namespace dtof
