// SPDX-License-Identifier: Apache-2.0
#include "product/product.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/folded_source.hpp"
#include "dtof/design/array_memories.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_error.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/photon/photon_source.hpp"
#include "product/product_driver.hpp"
#include "product/product_report.hpp"
#include "rtl/settings.hpp"
#include "sources/sources.hpp"
#include "vectors/stimulus.hpp"

namespace dtof {
namespace {

using Files = std::map<std::string, std::string>;
using Values = std::vector<std::pair<std::string, std::string>>;  ///< by the name in a template

constexpr std::string_view kLicence = "SPDX-License-Identifier: Apache-2.0";
constexpr int kMostIcarusPixels =
    4096;  // Icarus Verilog takes minutes for an array of this size, hours for larger ones

std::string source(std::string_view path) {
  const auto files = project_sources();
  const auto found = std::ranges::find(files, path, &SourceFile::path);
  if (found == files.end()) {
    throw std::logic_error(fmt::format("no source '{}'", path));
  }
  return std::string(found->text);
}

/// A template with its @NAMES@ replaced.
std::string filled(std::string_view name, const Values& values) {
  std::string text = source(fmt::format("app/product/templates/{}", name));
  for (const auto& [key, value] : values) {
    const std::string mark = "@" + key + "@";
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + value.size())) {
      text.replace(at, mark.size(), value);
    }
  }
  return text;
}

/// With how many columns for each SRAM the frame fits; nothing if it fits with none.
std::string fewer_columns_text(ProductRequest request) {
  while (--request.columns_per_sram > 0) {
    if (product_fit(request).fits) {
      return fmt::format(" --columns-per-sram {} would do, too.", request.columns_per_sram);
    }
  }
  return "";
}

void check(const ProductRequest& request) {
  request.parameters.validate();
  const RtlConfiguration array = product_array(request);
  const SensorModel& sensor = request.sensor;
  constexpr int kMostColumns = 1024;
  constexpr std::uint32_t kMostAcquisitionsOfRtl = 65535;
  if (array.sram_num > kMostColumns || array.pixels_per_sram > kMostSubsystemRows ||
      array.pixels_per_sram * sensor.slots > kMostSubsystemLines) {
    throw InputError(fmt::format(
        "product: {} x {} pixels of {} slots; dtof_subsystem has at most {} columns, {} rows, and {} "
        "rows times slots",
        array.sram_num, array.pixels_per_sram, sensor.slots, kMostColumns, kMostSubsystemRows,
        kMostSubsystemLines));
  }
  if (sensor.acquisitions > kMostAcquisitionsOfRtl) {
    throw InputError(fmt::format("product: {} acquisitions; the RTL counts 16 bits of them, to {}",
                                 sensor.acquisitions, kMostAcquisitionsOfRtl));
  }
  const FrameFit fit = product_fit(request);
  if (!fit.fits) {
    throw InputError("product: " + fit.sentence + fewer_columns_text(request));
  }
}

/// The parameters of dtof_subsystem; time gate and self-test only where they are asked for.
std::vector<RtlSetting> settings_of(const ProductRequest& request) {
  std::vector<RtlSetting> settings = rtl_settings(product_array(request), RtlTop::kSubsystem);
  std::ranges::find(settings, "TIME_GATE", &RtlSetting::name)->value = request.parameters.time_gate ? 1 : 0;
  if (request.self_test) {
    settings.push_back({"SELF_TEST", 1});
  }
  return settings;
}

std::string top(const ProductRequest& request) {
  std::string parameters;
  std::string list;
  for (const RtlSetting& setting : settings_of(request)) {
    parameters +=
        fmt::format("{}      .{}({})", parameters.empty() ? "" : ",\n", setting.name, setting.value);
  }
  const int width = 8 * ((product_array(request).sram_num * request.parameters.np + 7) / 8);
  struct Port {
    const char* direction;
    std::string type;
    const char* name;
  };
  const std::string cfg = "[dtof_pkg::SRAM_CFG_WIDTH-1:0]";
  const std::vector<Port> ports = {{"input ", "", "clk_i"},
                                   {"input ", "", "rst_ni"},
                                   {"input ", "", "scan_mode_i"},
                                   {"input ", cfg, "sram_cfg_i"},
                                   {"output", cfg, "sram_cfg_o"},
                                   {"input ", "", "psel_i"},
                                   {"input ", "", "penable_i"},
                                   {"input ", "", "pwrite_i"},
                                   {"input ", "[11:0]", "paddr_i"},
                                   {"input ", "[31:0]", "pwdata_i"},
                                   {"input ", "[3:0]", "pstrb_i"},
                                   {"output", "", "pready_o"},
                                   {"output", "[31:0]", "prdata_o"},
                                   {"output", "", "pslverr_o"},
                                   {"output", "", "irq_o"},
                                   {"output", "", "shot_o"},
                                   {"input ", "", "s_axis_tvalid_i"},
                                   {"output", "", "s_axis_tready_o"},
                                   {"input ", fmt::format("[{}:0]", width - 1), "s_axis_tdata_i"},
                                   {"input ", "", "s_axis_tlast_i"},
                                   {"output", "", "m_axis_tvalid_o"},
                                   {"input ", "", "m_axis_tready_i"},
                                   {"output", "[63:0]", "m_axis_tdata_o"},
                                   {"output", "", "m_axis_tuser_o"},
                                   {"output", "", "m_axis_tlast_o"}};
  std::string connections;
  for (const Port& port : ports) {
    const char* end = &port == &ports.back() ? "\n" : ",\n";
    list += fmt::format("    {} logic {}{}{}{}", port.direction, port.type, port.type.empty() ? "" : " ",
                        port.name, end);
    connections += fmt::format("      .{0}({0}){1}", port.name, end);
  }
  return fmt::format(
      "// {}\n// {} for the sensor {}: dtof_subsystem with the parameters of that sensor, written by dtof "
      "product.\n"
      "// verilator lint_off TIMESCALEMOD\n`default_nettype none\n\nmodule dtof_product (\n{});\n\n  "
      "dtof_subsystem #(\n{}\n  ) u_subsystem "
      "(\n{}  );\n\nendmodule\n\n"
      "`default_nettype wire\n",
      kLicence, readout_title(request.parameters.readout), request.sensor.name, list, parameters,
      connections);
}

/// Paths of hdl/dtof.f, leaf first, and the included files.
struct RtlFiles {
  std::vector<std::string> modules;
  std::vector<std::string> technology;  ///< of modules
  std::vector<std::string> includes;
};

RtlFiles rtl_files() {
  RtlFiles files;
  const std::string list = source("hdl/dtof.f");
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find('\n', begin), list.size());
    const std::string line = list.substr(begin, end - begin);
    begin = end + 1;
    if (line.ends_with(".sv") && !line.starts_with("//")) {
      (line.starts_with("technology/") ? files.technology : files.modules).push_back(line);
    }
  }
  for (const SourceFile& file : project_sources()) {
    if (file.path.starts_with("hdl/common/") && file.path.ends_with(".svh")) {
      files.includes.emplace_back(file.path.substr(4));
    }
  }
  return files;
}

void add_rtl(Files& files) {
  const RtlFiles rtl = rtl_files();
  std::string list =
      fmt::format("// {}\n// Leaf first, relative to this folder.\n+incdir+rtl/hdl/common\n", kLicence);
  std::string core = fmt::format(
      "CAPI=2:\n# {}\nname: dtof:product:dtof_product:1.0.0\ndescription: Read-out of a SPAD array for one "
      "sensor\nfilesets:\n"
      "  rtl:\n    files:\n",
      kLicence);
  std::string technology = "  technology:\n    files:\n";
  std::string bender = fmt::format(
      "# {}\npackage:\n  name: dtof_product\n\nexport_include_dirs:\n  - rtl/hdl/common\n\nsources:\n",
      kLicence);
  std::string bender_technology = "  - target: not(tech_override)\n    files:\n";
  std::string bender_rtl = "  - include_dirs: [rtl/hdl/common]\n    files:\n";
  for (const std::string& path : rtl.includes) {
    files["rtl/hdl/" + path] = source("hdl/" + path);
    core +=
        fmt::format("      - rtl/hdl/{}: {{is_include_file: true, include_path: rtl/hdl/common}}\n", path);
  }
  const auto packages = [](const std::string& path) { return path.ends_with("_pkg.sv"); };
  std::vector<std::string> all = rtl.modules;
  all.insert(std::stable_partition(all.begin(), all.end(), packages), rtl.technology.begin(),
             rtl.technology.end());
  for (const std::string& path : all) {
    files["rtl/hdl/" + path] = source("hdl/" + path);
    list += fmt::format("rtl/hdl/{}\n", path);
    const bool swapped = path.starts_with("technology/");
    (swapped ? technology : core) += fmt::format("      - rtl/hdl/{}\n", path);
    (swapped ? bender_technology : bender_rtl) += fmt::format("      - rtl/hdl/{}\n", path);
  }
  files["rtl/hdl/lint/verilator.vlt"] = source("hdl/lint/verilator.vlt");
  files["product.f"] = list + "rtl/dtof_product.sv\n";
  files["dtof_product.core"] = core + "      - rtl/dtof_product.sv\n    file_type: systemVerilogSource\n" +
                               technology +
                               "    file_type: systemVerilogSource\ntargets:\n  default:\n    filesets: "
                               "[rtl, \"!own_srams? (technology)\"]\n"
                               "    toplevel: dtof_product\n";
  files["Bender.yml"] = bender + bender_rtl + "      - rtl/dtof_product.sv\n" + bender_technology;
}

/// The same as a number in hexadecimal digits, entry 0 lowest.
std::string template_digits(const PoolTemplate& coarse_template) {
  std::string digits;
  for (auto entry = coarse_template.rbegin(); entry != coarse_template.rend(); ++entry) {
    digits += fmt::format("{:02x}", *entry);
  }
  return digits;
}

/// Which pixels a column of the array has; nothing if a column of the array is one of the sensor.
std::string folded_text(const ProductRequest& request) {
  const int together = request.columns_per_sram;
  return together == 1 ? ""
                       : fmt::format(
                             " {0} columns of the sensor share an SRAM, one after the other: column c of the "
                             "array has the\n"
                             "sensor's columns {0} c to {0} c + {1}, and its row r is row r mod {2} of the "
                             "sensor's column "
                             "{0} c + r / {2}.\nThis is the order of the lines that the source sends, and of "
                             "the results. "
                             "`dtof_product.h` has functions for it.",
                             together, together - 1, request.sensor.rows);
}

/// What stands for the names in the templates. `acquisitions`: of the vectors.
Values template_values(const ProductRequest& request, const ArrayParameters& array,
                       std::uint32_t acquisitions, const SelfTest& self_test) {
  const PoolSchedule schedule(acquisitions, request.parameters.pool);
  const bool pool = is_pool_readout(request.parameters.readout);
  const bool small = array.columns * array.rows <= kMostIcarusPixels;
  const CodeGate gate = request.parameters.time_gate.value_or(CodeGate{0, request.parameters.no_detection()});
  const std::uint64_t clocks =
      predicted_frame_clocks(request.parameters, array.rows, array.columns, acquisitions);
  const auto number = [](auto value) { return fmt::format("{}", value); };
  return {
      {"TITLE", std::string(readout_title(request.parameters.readout))},
      {"SENSOR", request.sensor.name},
      {"COLUMNS", number(array.columns)},
      {"ROWS", number(array.rows)},
      {"SENSOR_COLUMNS", number(request.sensor.columns)},
      {"SENSOR_ROWS", number(request.sensor.rows)},
      {"FOLDED", folded_text(request)},
      {"NP", number(request.parameters.np)},
      {"SLOTS", number(request.parameters.slots)},
      {"ACQUISITIONS", number(acquisitions)},
      {"TEMPLATE", template_digits(request.parameters.pool.coarse_template)},
      {"COARSE_END", number(pool ? schedule.coarse_end : 0)},
      {"TRACK_END", number(pool ? schedule.track_end : 0)},
      {"TIME_GATE", number(request.parameters.time_gate ? 1 : 0)},
      {"GATE_BEGIN", number(gate.begin)},
      {"GATE_END", number(gate.end)},
      {"FRACTION_BITS", number(result_fraction_bits(request.parameters))},
      {"SELF_TEST", number(request.self_test ? 1 : 0)},
      {"SELF_TEST_SEED", fmt::format("{:08x}", self_test.seed)},
      {"SELF_TEST_EXPECTED", fmt::format("{:08x}", self_test.expected)},
      {"MOST_CLOCKS", number((request.self_test ? 4 : 2) * clocks + 20000)},
      {"PERIOD", fmt::format("{:.4f}", 1e9 / request.budget.clock_hz)},
      {"MHZ", fmt::format("{:g}", request.budget.clock_hz * 1e-6)},
      {"SCENE", std::string(scene_name(request.scene))},
      {"KLUX", fmt::format("{:g}", request.klux)},
      {"PAIRS", pool ? "bench/pairs.vlt " : ""},
      {"CHECKS", small ? "icarus verilator driver" : "verilator driver"},
      {"PASSED", small ? "icarus, verilator, driver" : "verilator, driver"},
      {"SIMULATORS", small ? "Icarus Verilog and in Verilator"
                           : "Verilator (`make icarus` does the same in Icarus Verilog, which is slow for an "
                             "array of this size)"},
      {"COMMAND", request.command}};
}

std::uint32_t vector_acquisitions(const ProductRequest& request) {
  constexpr std::uint64_t kMostDigits = 4U << 20U;
  const SensorModel& sensor = request.sensor;
  const RtlConfiguration array = product_array(request);
  const std::uint64_t digits = static_cast<std::uint64_t>(array.pixels_per_sram) *
                               static_cast<std::uint64_t>(sensor.slots) *
                               (static_cast<std::uint64_t>(array.sram_num * sensor.np) / 4 + 2);
  const std::uint32_t most =
      request.vector_acquisitions != 0
          ? request.vector_acquisitions
          : static_cast<std::uint32_t>(std::max<std::uint64_t>(kMostDigits / digits, 4));
  return std::min(most, sensor.acquisitions);
}

/// A new folder beside `target`, of a name that nothing else has, with the permissions of any new folder.
std::filesystem::path folder_beside(const std::filesystem::path& target) {
  create_output_folder(target.parent_path());
  std::string name = (target.parent_path() / fmt::format(".{}.XXXXXX", target.filename().string())).string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw OutputError(
        fmt::format("{}: cannot write: {}", target.string(), std::generic_category().message(errno)));
  }
  const mode_t mask = ::umask(0);
  ::umask(mask);
  std::filesystem::permissions(name,
                               std::filesystem::perms::all & ~static_cast<std::filesystem::perms>(mask));
  return name;
}

}  // namespace

RtlConfiguration product_array(const ProductRequest& request) {
  if (request.pointer_ports != 2) {
    if (!is_pointer_readout(request.parameters.readout)) {
      throw InputError(fmt::format("product: --pointer-ports has no effect: {} has no pointers",
                                   readout_title(request.parameters.readout)));
    }
    if (request.pointer_ports != 1 || request.parameters.slots < 2) {
      throw InputError(fmt::format("product: --pointer-ports is {}, must be 2, or 1 with SLOTS of at least 2",
                                   request.pointer_ports));
    }
  }
  const int together = request.columns_per_sram;
  if (together < 1 || together > request.sensor.columns) {
    throw InputError(fmt::format("product: --columns-per-sram is {}, must be 1 to the sensor's {} columns",
                                 together, request.sensor.columns));
  }
  if (together > 1 && is_pool_readout(request.parameters.readout)) {
    throw InputError(
        fmt::format("product: --columns-per-sram is {}, must be 1: columns of {} help each other", together,
                    readout_title(request.parameters.readout)));
  }
  RtlConfiguration configuration;
  configuration.parameters = request.parameters;
  configuration.pixels_per_sram = request.sensor.rows * together;
  configuration.sram_num = (request.sensor.columns + together - 1) / together;
  configuration.pointer_ports = request.pointer_ports;
  return configuration;
}

FrameFit product_fit(const ProductRequest& request) {
  const RtlConfiguration array = product_array(request);
  return frame_fit(request.parameters, array.pixels_per_sram, array.sram_num, request.sensor.acquisitions,
                   request.budget);
}

std::map<std::string, std::string> product_files(const ProductRequest& request) {
  check(request);
  Files files;
  add_rtl(files);
  SensorModel sensor = request.sensor;
  sensor.acquisitions = vector_acquisitions(request);
  const TargetMap targets = make_scene(
      request.scene,
      {.columns = sensor.columns, .rows = sensor.rows, .reflectivity = sensor.default_reflectivity});
  const PhotonSource photons(sensor, targets, request.klux, request.seed);
  const FoldedSource streams(photons, request.columns_per_sram);
  const ArrayParameters array{
      .readout = request.parameters, .rows = streams.rows(), .columns = streams.columns()};
  FrameVectors vectors = source_vectors(array, streams);
  const SelfTest self_test = request.self_test ? product_self_test(request, sensor.acquisitions) : SelfTest{};
  const Values values = template_values(request, array, sensor.acquisitions, self_test);
  if (is_pool_readout(request.parameters.readout)) {
    files["bench/pairs.vlt"] = source("tb_cpp/rtl/pairs.vlt");
  }
  files["rtl/dtof_product.sv"] = top(request);
  files["bench/product_bench.sv"] = filled("product_bench.sv", values);
  files["Makefile"] = filled("Makefile", values);
  files["README.md"] = filled("README.md", values);
  files["constraints/dtof_product.sdc"] = filled("dtof_product.sdc", values);
  for (const char* name : {"dtof_array.upf", "dtof_subsystem.upf"}) {
    const std::string path = fmt::format("constraints/power_intent/{}", name);
    files[path] = source(path);
  }
  files["driver/check.c"] = filled("check.c", values);
  files["driver/dtof_product.h"] = product_driver_header(request, self_test);
  for (const SourceFile& file : project_sources()) {
    if (file.path.starts_with("driver/") && !file.path.starts_with("driver/dtof_filter.")) {
      files[std::string(file.path)] = file.text;
    }
  }
  files["vectors/timestamps.hex"] = std::move(vectors.timestamps);
  files["vectors/results.hex"] = std::move(vectors.results);
  files["sensor.toml"] = request.sensor_text;
  files["LICENSE"] = source("LICENSE");
  files["report.md"] = product_report(request, settings_of(request));
  return files;
}

void check_product_folder(const std::filesystem::path& folder) {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(folder.has_filename() ? folder : folder.parent_path(),
                                                      error);  // "link/" would be the link's target
  if (!std::filesystem::exists(status)) {
    return;
  }
  if (!std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("product: {} is there and no folder; choose another name", folder.string()));
  }
  if (!std::filesystem::is_empty(folder, error)) {
    throw InputError(
        fmt::format("product: {} is there and not empty; choose another folder", folder.string()));
  }
}

void write_product(const std::map<std::string, std::string>& files, const std::filesystem::path& folder) {
  check_product_folder(folder);
  std::filesystem::path target = std::filesystem::absolute(folder);
  if (!target.has_filename()) {
    target = target.parent_path();
  }
  const std::filesystem::path partial = folder_beside(target);
  std::error_code error;
  const auto fail = [&](const std::filesystem::path& path) {
    throw OutputError(fmt::format("{}: cannot write: {}", path.string(), error.message()));
  };
  try {
    for (const auto& [path, text] : files) {
      std::filesystem::create_directories((partial / path).parent_path(), error);
      if (error) {
        fail((partial / path).parent_path());
      }
      write_file(partial / path, text);
    }
    std::filesystem::rename(partial, target, error);  // takes the place of an empty folder, of nothing else
    if (error) {
      fail(target);
    }
  } catch (const OutputError& failure) {
    std::filesystem::remove_all(partial, error);
    std::string reason = failure.what();
    if (reason.starts_with(partial.string())) {  // a name that the user did not give
      reason.replace(0, partial.string().size(), target.string());
    }
    throw OutputError(reason);
  } catch (...) {
    std::filesystem::remove_all(partial, error);
    throw;
  }
}

}  // namespace dtof
