// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "on_demand/toolchain.hpp"
#include "rtl/settings.hpp"
#include "sources/sources.hpp"

namespace dtof {

/// A Verilated array or subsystem, compiled as a shared library.
class ArrayLibrary {
 public:
  /// C symbol of the function that makes a model in a VerilatedContext; it returns the pointer of a
  /// std::unique_ptr.
  static constexpr const char* kMaker = "dtof_make_model";

  ArrayLibrary(RtlTop top, std::vector<RtlSetting> settings, Toolchain tools,
               std::span<const SourceFile> sources = project_sources());

  /// Everything that the library depends on, as text.
  [[nodiscard]] const std::string& key() const { return key_; }

  /// Called about ten times a second with the current step.
  using Tick = std::function<void(std::string_view doing)>;

  /// Builds the library as `folder`/`file`. Throws InputError with one line if a tool fails; the tool's
  /// output is then in `log`.
  void build(const std::filesystem::path& folder, const std::string& file, const std::filesystem::path& log,
             const Tick& tick) const;

 private:
  void run(std::span<const std::string> command, const std::filesystem::path& folder,
           const std::filesystem::path& log, const std::function<void()>& tick) const;

  RtlTop top_;
  std::vector<RtlSetting> settings_;
  Toolchain tools_;
  std::span<const SourceFile> sources_;
  std::string key_;
};

}  // namespace dtof
