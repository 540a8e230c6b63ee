// SPDX-License-Identifier: Apache-2.0
#include "on_demand/on_demand.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/select_columns.hpp"
#include "on_demand/array_cache.hpp"
#include "on_demand/array_library.hpp"
#include "on_demand/toolchain.hpp"
#include "rtl/registry.hpp"
#include "rtl/run_frame.hpp"
#include "subsystem/registry.hpp"

namespace dtof {
namespace {

/// What is being built, on standard error: a line, and on a terminal what is done and for how long.
class BuildLine {
 public:
  explicit BuildLine(std::string what) : what_(std::move(what)) {}
  BuildLine(const BuildLine&) = delete;
  BuildLine& operator=(const BuildLine&) = delete;
  BuildLine(BuildLine&&) = delete;
  BuildLine& operator=(BuildLine&&) = delete;
  ~BuildLine() { erase(); }

  void say(const std::string& line) {
    erase();
    std::fputs((line + "\n").c_str(), stderr);
  }

  void tick(std::string_view doing) {
    if (!terminal_) {
      return;
    }
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_).count();
    const std::string line = fmt::format("{}: {}, {} s", what_, doing, seconds);
    if (line != drawn_) {
      drawn_ = line;
      std::fputs(("\r\033[K" + line).c_str(), stderr);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  void erase() {
    if (!drawn_.empty()) {
      std::fputs("\r\033[K", stderr);
      drawn_.clear();
    }
  }

  std::string what_;
  Clock::time_point start_ = Clock::now();
  bool terminal_ = isatty(STDERR_FILENO) == 1;
  std::string drawn_;
};

/// The maker in a library, which stays loaded to the program's end; null if it cannot be loaded.
void* load_maker(const std::filesystem::path& file) {
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  return library != nullptr ? dlsym(library, ArrayLibrary::kMaker) : nullptr;
}

void* maker_of(const RtlConfiguration& configuration, RtlTop top, std::span<const SourceFile> sources) {
  const std::optional<ArrayCache> cache = ArrayCache::of_user();
  const ArrayLibrary library(top, rtl_settings(configuration, top), Toolchain::find(), sources);
  BuildLine line(fmt::format("RTL of {}", configuration.to_string()));
  const auto say = [&](const std::string& text) { line.say(text); };
  const std::filesystem::path log = cache->entry(library.key()).string() + ".log";
  const auto make = [&](const std::filesystem::path& folder) {
    line.say(fmt::format("Builds the RTL of {}, once; kept in {}", configuration.to_string(),
                         cache->folder().string()));
    library.build(folder, ArrayCache::kFile, log, [&](std::string_view doing) { line.tick(doing); });
  };
  if (void* maker = load_maker(cache->get(library.key(), make, say))) {
    return maker;
  }
  // Whole, but of no use here.
  void* maker = load_maker(cache->get(library.key(), make, say, true));
  if (maker == nullptr) {
    const char* reason = dlerror();
    throw InputError(
        fmt::format("the RTL that was built cannot be loaded: {}", reason != nullptr ? reason : "no maker"));
  }
  return maker;
}

/// What is set with every frame has its default.
ReadoutParameters built_parameters(ReadoutParameters parameters) {
  const PoolPointerParameters defaults = PoolPointerParameters::defaults(parameters.readout);
  parameters.pool.coarse_share = defaults.coarse_share;
  parameters.pool.track_share = defaults.track_share;
  parameters.pool.smooth = defaults.smooth;
  parameters.pool.coarse_template = defaults.coarse_template;
  return parameters;
}

void require_buildable(const std::string& missing) {
  const std::string obstacle = obstacle_to_building();
  if (!obstacle.empty()) {
    throw InputError(fmt::format("{}; none is built: {}", missing, obstacle));
  }
}

/// Columns of each array that is needed, each number once.
std::set<int> widths(const ReadoutParameters& parameters, int columns, std::span<const int> selected) {
  const int together = parameters.columns_together();
  if (together == 1) {
    return {std::min(columns, kMostColumnsOnDemand)};
  }
  std::set<int> found;
  for (const ColumnGroup& engine : column_groups(selected, together, columns)) {
    found.insert(engine.count);
  }
  return found;
}

/// Why `find` throws InputError; empty if it does not.
template <typename Find>
std::string refusal(const Find& find) {
  try {
    (void)find();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// The array of so many columns with its parameters legal.
RtlConfiguration configuration_of(const ReadoutParameters& parameters, int rows, int width) {
  parameters.validate();
  RtlConfiguration configuration;
  configuration.parameters = built_parameters(parameters);
  configuration.pixels_per_sram = rows;
  configuration.sram_num = width;
  configuration.records_waveform = false;
  return configuration;
}

void load_array(const RtlConfiguration& configuration, std::span<const SourceFile> sources) {
  auto* make = reinterpret_cast<ArrayModel* (*)(VerilatedContext&)>(
      maker_of(configuration, array_top(configuration.parameters.readout), sources));
  register_rtl_configuration(configuration, [make](VerilatedContext& context) {
    return std::unique_ptr<ArrayModel>(make(context));
  });
}

}  // namespace

std::string obstacle_to_building() {
  try {
    if (!ArrayCache::of_user()) {
      return "DTOF_CACHE is off";
    }
    (void)Toolchain::find();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

void build_missing_arrays(const ReadoutParameters& parameters, int rows, int columns,
                          std::span<const int> selected, std::span<const SourceFile> sources) {
  const std::string missing =
      refusal([&] { return find_rtl_configurations(parameters, rows, columns, selected); });
  if (missing.empty()) {
    return;
  }
  require_buildable(missing);
  for (const int width : widths(parameters, columns, selected)) {
    if (refusal([&] { return find_rtl_configuration(parameters, rows, width); }).empty()) {
      continue;
    }
    load_array(configuration_of(parameters, rows, width), sources);
  }
}

void build_missing_array(const RtlConfiguration& configuration, std::span<const SourceFile> sources) {
  configuration.parameters.validate();
  if (!has_array(configuration)) {
    require_buildable(fmt::format("no RTL is compiled for {}", configuration.to_string()));
    load_array(configuration, sources);
  }
}

void build_missing_subsystems(const ReadoutParameters& parameters, int rows, int columns,
                              std::span<const int> selected, std::span<const SourceFile> sources) {
  const std::string missing = refusal([&] { return find_subsystems(parameters, rows, columns, selected); });
  if (missing.empty()) {
    return;
  }
  require_buildable(missing);
  constexpr int kMostLines = 65535;  // of an acquisition in dtof_subsystem
  constexpr int kMostRows = 4096;
  if (rows > kMostRows || rows * parameters.slots > kMostLines) {
    throw InputError(
        fmt::format("--engine subsystem: {} rows of {} slots; dtof_subsystem has at most {} rows, and {} "
                    "rows times slots",
                    rows, parameters.slots, kMostRows, kMostLines));
  }
  for (const int width : widths(parameters, columns, selected)) {
    const RtlConfiguration configuration = configuration_of(parameters, rows, width);
    auto* make = reinterpret_cast<SubsystemModel* (*)(VerilatedContext&)>(
        maker_of(configuration, RtlTop::kSubsystem, sources));
    register_subsystem(configuration, [make](VerilatedContext& context) {
      return std::unique_ptr<SubsystemModel>(make(context));
    });
  }
}

}  // namespace dtof
