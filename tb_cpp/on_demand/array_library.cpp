// SPDX-License-Identifier: Apache-2.0
#include "on_demand/array_library.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "on_demand/sha256.hpp"
#include "on_demand/tool_run.hpp"

namespace dtof {
namespace {

/// What belongs to a top: its testbench, its C++ class, and the type that the program knows.
struct Harness {
  std::string_view top;
  std::string_view folder;  ///< of tb_cpp
  std::string_view header;
  std::string_view model;
  std::string_view base;
};

const Harness& harness(RtlTop top) {
  static constexpr std::array<Harness, 3> kHarnesses = {{
      {"dtof_array_testbench", "rtl", "rtl/verilated_array.hpp", "VerilatedArray", "ArrayModel"},
      {"pool_pointer_testbench", "rtl", "rtl/verilated_array.hpp", "VerilatedArray", "ArrayModel"},
      {"subsystem_testbench", "subsystem", "subsystem/verilated_subsystem.hpp", "VerilatedSubsystem",
       "SubsystemModel"},
  }};
  return kHarnesses.at(static_cast<std::size_t>(top));
}

/// As cmake/verilate.cmake has them, but that a warning is none: `make lint` is where warnings are errors.
const std::vector<std::string>& verilator_flags() {
  static const std::vector<std::string> flags = {"--cc",
                                                 "--assert",
                                                 "--x-initial",
                                                 "unique",
                                                 "--x-assign",
                                                 "unique",
                                                 "-O3",
                                                 "-Wno-lint",
                                                 "-Wno-style",
                                                 "-Wno-SYNCASYNCNET",
                                                 "--timescale",
                                                 "1ns/1ps",
                                                 "+define+DTOF_ASSERT_AS_IF"};
  return flags;
}

const std::vector<std::string>& compiler_flags() {
  static const std::vector<std::string> flags = {"-std=c++20",
                                                 "-O2",
                                                 "-fPIC",
                                                 "-shared",
                                                 "-w",
                                                 "-DVM_SC=0",
                                                 "-DVM_TRACE=1",
                                                 "-DVM_TRACE_FST=1",
                                                 fmt::format("-DVM_COVERAGE={}", DTOF_RTL_COVERAGE)};
  return flags;
}

bool belongs(const SourceFile& file) {
  return file.path.starts_with("tb_cpp/") ||
         (file.path.starts_with("hdl/") && !file.path.starts_with("hdl/technology/fpga/") &&
          !file.path.starts_with("hdl/assertions/") && !file.path.ends_with(".toml"));
}

/// The line of a tool's output that says what is wrong.
std::string complaint(const std::string& output) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < output.size();) {
    const std::size_t end = std::min(output.find('\n', begin), output.size());
    lines.push_back(output.substr(begin, end - begin));
    begin = end + 1;
  }
  for (const std::string_view word : {"No space left on device", "%Error", "rror:", "atal"}) {
    const auto found = std::ranges::find_if(
        lines, [&](const std::string& line) { return line.find(word) != std::string::npos; });
    if (found != lines.end()) {
      return *found;
    }
  }
  return lines.empty() ? "it says nothing" : lines.back();
}

/// Model and maker as one file, as cmake/unity.cmake makes it: what runs once is not worth the optimiser's
/// time.
std::string joined(const std::filesystem::path& folder, const Harness& harness, const std::string& prefix) {
  std::vector<std::string> often;
  std::vector<std::string> rare;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (!name.ends_with(".cpp")) {
      continue;
    }
    const bool seldom = name.ends_with("Slow.cpp") || name.ends_with("__Syms.cpp") ||
                        name.find("__ConstPool_") != std::string::npos;
    (seldom ? rare : often).push_back(name);
  }
  std::ranges::sort(often);
  std::ranges::sort(rare);
  std::string text;
  for (const std::string& name : often) {
    text += fmt::format("#include \"{}\"\n", name);
  }
  text += "#pragma GCC push_options\n#pragma GCC optimize(\"O0\")\n";
  for (const std::string& name : rare) {
    text += fmt::format("#include \"{}\"\n", name);
  }
  return text + fmt::format(
                    "#pragma GCC pop_options\n"
                    "#include \"{0}.h\"\n#include \"{1}\"\n"
                    "extern \"C\" dtof::{2}* {3}(VerilatedContext& context) {{\n"
                    "  return new dtof::{4}<{0}>(context);\n}}\n",
                    prefix, harness.header, harness.base, ArrayLibrary::kMaker, harness.model);
}

void write_sources(std::span<const SourceFile> sources, const std::filesystem::path& folder) {
  for (const SourceFile& file : sources) {
    if (!belongs(file)) {
      continue;
    }
    const std::filesystem::path target = folder / file.path;
    std::error_code error;
    std::filesystem::create_directories(target.parent_path(), error);
    if (error) {
      throw InputError(
          fmt::format("{}: cannot make the folder: {}", target.parent_path().string(), error.message()));
    }
    write_file(target, file.text);
  }
}

}  // namespace

ArrayLibrary::ArrayLibrary(RtlTop top, std::vector<RtlSetting> settings, Toolchain tools,
                           std::span<const SourceFile> sources)
    : top_(top), settings_(std::move(settings)), tools_(std::move(tools)), sources_(sources) {
  std::string texts;
  for (const SourceFile& file : sources) {
    if (belongs(file)) {
      texts += fmt::format("{} {}\n{}", file.path, file.text.size(), file.text);
    }
  }
  std::string parameters;
  for (const RtlSetting& setting : settings_) {
    parameters += fmt::format(" {}={}", setting.name, setting.value);
  }
  utsname machine{};
  uname(&machine);
  key_ = fmt::format("dtof array 1\n{}{}\n{} {}\n{} {} {}\n{}\nsources {}\n", harness(top).top, parameters,
                     tools_.verilator_version, fmt::join(verilator_flags(), " "),
                     fmt::join(tools_.compiler, " "), tools_.compiler_version,
                     fmt::join(compiler_flags(), " "), std::string(machine.machine), sha256(texts));
}

void ArrayLibrary::run(std::span<const std::string> command, const std::filesystem::path& folder,
                       const std::filesystem::path& log, const std::function<void()>& tick) const {
  const std::optional<ToolRun> done = run_tool(command, folder, tick);
  if (!done) {
    throw InputError(fmt::format("{} does not run here", command.front()));
  }
  if (done->exit_code == 0) {
    return;
  }
  std::string kept;
  try {
    write_file(log, done->output);
    kept = fmt::format(" ({} has all)", log.string());
  } catch (const InputError&) {  // a full disk: the line says so
  }
  throw InputError(fmt::format("the RTL could not be built, {} failed: {}{}",
                               std::filesystem::path(command.front()).filename().string(),
                               complaint(done->output), kept));
}

void ArrayLibrary::build(const std::filesystem::path& folder, const std::string& file,
                         const std::filesystem::path& log, const Tick& tick) const {
  const Harness& parts = harness(top_);
  const std::filesystem::path work = folder / "work";
  write_sources(sources_, work);
  // Classes of two libraries in one program need two names.
  constexpr std::size_t kNameDigits = 16;
  const std::string prefix = "Vd" + sha256(key_).substr(0, kNameDigits);
  std::vector<std::string> verilate = {
      "verilator", "--top-module", std::string(parts.top), "--prefix", prefix, "--Mdir", "model"};
  verilate.insert(verilate.end(), verilator_flags().begin(), verilator_flags().end());
  for (const RtlSetting& setting : settings_) {
    verilate.push_back(fmt::format("-G{}={}", setting.name, setting.value));
  }
  for (const char* word :
       {"hdl/lint/verilator.vlt", "+incdir+hdl/common", "hdl/common/dtof_pkg.sv", "hdl/pool/dtof_pool_pkg.sv",
        "hdl/subsystem/dtof_registers_pkg.sv", "-y", "hdl/subsystem", "-y", "hdl/thesis", "-y", "hdl/pool",
        "-y", "hdl/common", "-y", "hdl/technology/behavioural"}) {
    verilate.emplace_back(word);
  }
  const bool pool = std::ranges::any_of(settings_, [](const RtlSetting& setting) {
    return setting.name == "READOUT" && setting.value == rtl_readout_number(Readout::kPoolPointer);
  });
  if (top_ == RtlTop::kPoolArray || pool) {
    verilate.emplace_back("tb_cpp/rtl/pairs.vlt");
  }
  verilate.push_back(fmt::format("tb_cpp/{}/{}.sv", parts.folder, parts.top));
  run(verilate, work, log, [&] { tick("Verilator"); });

  write_file(work / "model" / "model.cc", joined(work / "model", parts, prefix));
  std::vector<std::string> compile = tools_.compiler;
  compile.insert(compile.end(), compiler_flags().begin(), compiler_flags().end());
  for (const std::string& word :
       {std::string("-I."), std::string("-I../tb_cpp"), std::string("-isystem"), tools_.verilator_include,
        std::string("-isystem"), tools_.verilator_include + "/vltstd", std::string("-o"), "../../" + file,
        std::string("model.cc")}) {
    compile.push_back(word);
  }
  run(compile, work / "model", log, [&] { tick("C++ compiler"); });
  std::error_code error;
  std::filesystem::remove_all(work, error);
}

}  // namespace dtof
