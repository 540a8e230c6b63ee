// SPDX-License-Identifier: Apache-2.0
#include "on_demand/toolchain.hpp"

#include <fmt/format.h>
#include <verilated.h>

#include <array>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "dtof/core/error.hpp"
#include "on_demand/tool_run.hpp"

namespace dtof {
namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> found;
  for (std::string word; stream >> word;) {
    found.push_back(word);
  }
  return found;
}

/// The first line that the command prints; nothing if it is not there or fails.
std::optional<std::string> said(std::vector<std::string> command, std::string_view option) {
  command.emplace_back(option);
  const std::optional<ToolRun> run = run_tool(command, {});
  if (!run || run->exit_code != 0) {
    return std::nullopt;
  }
  return first_line(run->output);
}

void find_verilator(Toolchain& tools) {
  const std::optional<std::string> version = said({"verilator"}, "--version");
  if (!version) {
    throw InputError("verilator does not run here (it is in the Debian package verilator)");
  }
  const std::string wanted = fmt::format("{} {}", VERILATOR_PRODUCT, VERILATOR_VERSION);
  if (!version->starts_with(wanted)) {
    throw InputError(
        fmt::format("this program has the runtime of {}, but verilator is {}: build the program again",
                    wanted, *version));
  }
  tools.verilator_version = *version;
  const std::optional<std::string> root = said({"verilator", "--getenv"}, "VERILATOR_ROOT");
  if (!root || root->empty()) {
    throw InputError("verilator --getenv VERILATOR_ROOT does not say where its headers are");
  }
  tools.verilator_include = *root + "/include";
}

void find_compiler(Toolchain& tools) {
  std::vector<std::vector<std::string>> commands;
  if (const char* cxx = std::getenv("CXX"); cxx != nullptr && !words(cxx).empty()) {
    commands.push_back(words(cxx));
  } else {
    commands = {{DTOF_CXX_COMPILER}, {"c++"}, {"g++"}, {"clang++"}};
  }
  for (const std::vector<std::string>& command : commands) {
    if (const std::optional<std::string> version = said(command, "--version")) {
      tools.compiler = command;
      tools.compiler_version = *version;
      return;
    }
  }
  throw InputError(
      fmt::format("no C++ compiler runs here: {} (CXX names another)", commands.front().front()));
}

}  // namespace

const Toolchain& Toolchain::find() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::string>, Toolchain> known;
  const std::scoped_lock lock(mutex);
  const std::pair where(variable("PATH"), variable("CXX"));
  if (const auto found = known.find(where); found != known.end()) {
    return found->second;
  }
  Toolchain tools;
  find_verilator(tools);
  find_compiler(tools);
  return known.emplace(where, std::move(tools)).first->second;
}

}  // namespace dtof
