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

/// A Verilated array or subsystem as a shared library.
class ArrayLibrary {
 public:
  /// C symbol of the library: std::unique_ptr's pointer of a new model in a VerilatedContext.
  static constexpr const char* kMaker = "dtof_make_model";

  ArrayLibrary(RtlTop top, std::vector<RtlSetting> settings, Toolchain tools,
               std::span<const SourceFile> sources = project_sources());

  /// Everything that the library depends on, as text.
  [[nodiscard]] const std::string& key() const { return key_; }

  /// Says what is done now; called about ten times a second.
  using Tick = std::function<void(std::string_view doing)>;

  /// Writes the library into `folder`/`file`. Throws InputError with one line if a tool refuses; that tool's
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
