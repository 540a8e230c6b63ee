// SPDX-License-Identifier: Apache-2.0
#include "product/product.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/design/bench.hpp"
#include "dtof/design/estimate.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/sensor_file.hpp"
#include "tests/run_shell.hpp"

namespace dtof {
namespace {

using test::Outcome;
using test::run_shell;

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

constexpr const char* kSensor = R"(name = "small"
[array]
columns = 8
rows = 6
field_of_view_deg = 40.0
[tdc]
range_ns = 45.0
timestamp_bits = 9
slots = 2
[laser]
acquisitions = 60
pulse_fwhm_ns = 2.0
[light]
signal_events_at_1m = 0.3
background_events_per_klux = 0.01
default_reflectivity = 1.0
)";

ProductRequest request(Readout readout) {
  ProductRequest request{.sensor_text = kSensor,
                         .sensor = parse_sensor(kSensor, "small.toml"),
                         .parameters = {},
                         .budget = {},
                         .command = "dtof product",
                         .measurements = {}};
  request.parameters = default_parameters(readout, request.sensor);
  return request;
}

class Product : public testing::Test {
 protected:
  Product()
      : folder_(std::filesystem::temp_directory_path() / fmt::format("dtof_product_test_{}", getpid())) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "small.toml") << kSensor;
  }
  ~Product() override { std::filesystem::remove_all(folder_); }
  Product(const Product&) = delete;
  Product& operator=(const Product&) = delete;
  Product(Product&&) = delete;
  Product& operator=(Product&&) = delete;

  [[nodiscard]] Outcome shell(const std::string& command) const {
    return run_shell(fmt::format("cd '{}' && ( {} )", folder_.string(), command));
  }
  /// dtof product of the small sensor.
  [[nodiscard]] Outcome product(const std::string& arguments) const {
    return shell(fmt::format("{} product --sensor small.toml {}", DTOF_PROGRAM, arguments));
  }
  void replace(const std::string& file, const std::string& what, const std::string& by) const {
    std::string text = read_file(folder_ / file);
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
    std::ofstream(folder_ / file) << text;
  }

  std::filesystem::path folder_;
};

TEST_F(Product, OfAReadoutOfTheThesisPassesItsOwnMake) {
  const Outcome made = product("--readout sifh --out chip");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const Outcome checked = shell("make -C chip");
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  EXPECT_THAT(checked.output, HasSubstr("PASS: icarus, verilator, driver"));
  EXPECT_EQ(shell("make -C chip lint").exit_code, 0);
  EXPECT_THAT(read_file(folder_ / "chip/report.md"), HasSubstr("| area of cells and memories, mm2 "));
}

TEST_F(Product, OfAPoolReadoutPassesItsOwnMake) {
  ASSERT_EQ(product("--readout poolpointer --code-gate 20 500 --out chip").exit_code, 0);
  const Outcome checked = shell("make -C chip icarus driver");
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
}

TEST_F(Product, WithASelfTestRunsItInItsBench) {
  std::ofstream(folder_ / "fog.toml") << kSensor << "\n[fog]\nextinction_per_m = 0.1\n";
  const std::string fog =
      fmt::format("{} product --sensor fog.toml --self-test --vector-acquisitions 30 ", DTOF_PROGRAM);
  for (const char* readout :
       {"ezpointer --code-gate 20 500 --columns-per-sram 3", "poolpointer-lean --template"}) {
    SCOPED_TRACE(readout);
    ASSERT_EQ(shell(fmt::format("rm -rf chip; {} --readout {} --out chip", fog, readout)).exit_code, 0);
    const Outcome checked = shell("make -C chip icarus driver");
    EXPECT_EQ(checked.exit_code, 0) << checked.output;
    EXPECT_THAT(checked.output, HasSubstr("self-test: passed, and failed with a wrong checksum"));
    EXPECT_THAT(read_file(folder_ / "chip/driver/dtof_product.h"),
                HasSubstr("#define DTOF_PRODUCT_SELF_TEST_EXPECTED 0x"));
  }
  // A fault that changes results changes the checksum.
  replace("chip/rtl/hdl/subsystem/dtof_self_test.sv", "MIXED = (32'(c) + 32'd1)", "MIXED = (32'(c) + 32'd2)");
  EXPECT_THAT(shell("make -C chip icarus").output, HasSubstr("ERROR.SELF_TEST is not the verdict"));
  ASSERT_EQ(product("--readout ezpointer --out without").exit_code, 0);
  EXPECT_THAT(read_file(folder_ / "without/driver/dtof_product.h"), Not(HasSubstr("SELF_TEST")));
  EXPECT_THAT(read_file(folder_ / "without/rtl/dtof_product.sv"), Not(HasSubstr("SELF_TEST")));
}

TEST_F(Product, WithTheMemoriesOfTheShuttleChipPassesItsOwnMake) {
  const std::string root = DTOF_ROOT;
  ASSERT_EQ(shell(fmt::format("{} product --sensor {}/shuttle/sensor.toml --readout ezpointer "
                              "--vector-acquisitions 20 --out chip",
                              DTOF_PROGRAM, root))
                .exit_code,
            0);
  // The library's clock gate is a cell, whose model follows in the same file.
  const Outcome swapped =
      shell(fmt::format("cp {0}/hdl/technology/ihp130/*.sv chip/rtl/hdl/technology/behavioural/ && "
                        "cat {0}/tb_cpp/tests/demonstrator/sg13g2_lgcp_1.sv >> "
                        "chip/rtl/hdl/technology/behavioural/dtof_clock_gate.sv",
                        root));
  ASSERT_EQ(swapped.exit_code, 0) << swapped.output;
  const Outcome checked = shell("make -C chip icarus");
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  replace("chip/rtl/hdl/technology/behavioural/dtof_sram_1r1w.sv", "rdata_o <= memory[raddr_i]",
          "rdata_o <= memory[waddr_i]");
  EXPECT_NE(shell("make -C chip icarus").exit_code, 0) << "the frame does not depend on these memories";
}

TEST_F(Product, ForFogHasItsTemplate) {
  std::ofstream(folder_ / "fog.toml") << kSensor << "\n[fog]\nextinction_per_m = 0.1\n";
  ASSERT_EQ(shell(fmt::format("{} product --sensor fog.toml --readout poolpointer --template --out chip",
                              DTOF_PROGRAM))
                .exit_code,
            0);
  EXPECT_THAT(read_file(folder_ / "chip/driver/dtof_product.h"), HasSubstr("dtof_product_template"));
  const Outcome checked = shell("make -C chip icarus driver");
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  replace("chip/bench/product_bench.sv", "TEMPLATE = 256'h", "TEMPLATE = 256'h0 & 256'h");
  EXPECT_THAT(shell("make -C chip icarus").output, HasSubstr("FAIL"))
      << "the frame does not depend on the template";
}

TEST_F(Product, ItsBenchSeesWhatIsWrong) {
  ASSERT_EQ(product("--readout ezpointer --out chip").exit_code, 0);
  ASSERT_EQ(shell("make -C chip icarus").exit_code, 0);
  const auto fails = [&](const std::string& file, const std::string& what, const std::string& by) {
    SCOPED_TRACE(file);
    const std::string right = read_file(folder_ / file);
    replace(file, what, by);
    const Outcome outcome = shell("make -C chip icarus");
    EXPECT_NE(outcome.exit_code, 0);
    EXPECT_THAT(outcome.output, HasSubstr("FAIL"));
    std::ofstream(folder_ / file) << right;
  };
  fails("chip/rtl/hdl/thesis/dtof_pointer_update.sv", "left ? down : up", "left ? up : down");
  fails("chip/rtl/dtof_product.sv", ".POINTER_STEP(1)", ".POINTER_STEP(2)");
  const std::string first = read_file(folder_ / "chip/vectors/results.hex").substr(0, 12);
  fails("chip/vectors/results.hex", first, first.substr(0, 11) + (first[11] == '0' ? "1" : "0"));
  EXPECT_EQ(shell("make -C chip icarus").exit_code, 0);
  replace("chip/driver/dtof_product.h", "    {", "    {-1e9, -1e9}, {1e9, 1e9}, {");
  EXPECT_NE(shell("make -C chip driver").exit_code, 0);
}

TEST_F(Product, TheSameInputsGiveTheSameBytes) {
  for (const char* folder : {"one", "two"}) {
    ASSERT_EQ(product(fmt::format("--readout coarsehistogram --out {}", folder)).exit_code, 0);
  }
  const Outcome same = shell("diff -r one two");
  EXPECT_EQ(same.exit_code, 0) << same.output;
  ASSERT_EQ(product("--readout coarsehistogram --seed 2 --out three").exit_code, 0);
  EXPECT_NE(shell("diff -rq one/vectors three/vectors").exit_code, 0);
  // Whatever the number of threads, in the library, too.
  ProductRequest few = request(Readout::kFifh);
  few.threads = 1;
  EXPECT_EQ(product_files(few), product_files(request(Readout::kFifh)));
}

TEST_F(Product, WritesNothingIfAnythingIsWrong) {
  const auto refused = [&](const std::string& arguments, const std::string& reason) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = product(arguments + " --out chip");
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(reason));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "chip"));
  };
  refused("--readout sifh,fifh", "a product has one");
  refused("--readout sifh --nb 12", "NB must be 1 to NP, not 12");
  refused("--readout sifh --frame-rate 300000", "so that the frame does not fit. What would, one of: ");
  refused("--readout sifh --measure", "run the command in the project's folder");
  refused("--readout nothing", "unknown read-out");
  refused("--readout sifh --vector-acquisitions 0",
          "--vector-acquisitions is 0, must be 1 to the sensor's 60 acquisitions");
  refused("--readout sifh --vector-acquisitions 61", "--vector-acquisitions is 61, must be 1 to");
  std::filesystem::create_directories(folder_ / "full");
  std::ofstream(folder_ / "full" / "file") << "mine";
  const Outcome there = product("--readout sifh --out full");
  EXPECT_EQ(there.exit_code, 1);
  EXPECT_THAT(there.output, HasSubstr("full is there and not empty"));
  EXPECT_EQ(read_file(folder_ / "full" / "file"), "mine");
  // A disk that is full.
  const Outcome full = shell(fmt::format(
      "trap '' XFSZ; ulimit -f 20; {} product --sensor small.toml --readout sifh --out chip", DTOF_PROGRAM));
  EXPECT_EQ(full.exit_code, 4);
  EXPECT_THAT(full.output, HasSubstr("cannot write: File too large"));
  EXPECT_THAT(full.output, HasSubstr("/chip/"));
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    EXPECT_THAT(entry.path().filename().string(), AnyOf("small.toml", "full"));
  }
}

TEST_F(Product, LeavesWhatIsNotItsOwn) {
  std::ofstream(folder_ / "file").close();
  std::filesystem::create_directories(folder_ / "empty");
  std::filesystem::create_symlink("file", folder_ / "to_file");
  std::filesystem::create_symlink("empty", folder_ / "to_folder");
  std::filesystem::create_symlink("nowhere", folder_ / "to_nothing");
  for (const std::string name : {"file", "to_file", "to_folder", "to_folder/", "to_nothing"}) {
    const Outcome outcome = product("--readout sifh --out " + name);
    EXPECT_EQ(outcome.exit_code, 1) << name;
    EXPECT_EQ(outcome.output,
              "dtof: error: product: " + name + " is there and no folder; choose another name\n");
  }
  EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / "file"));
  for (const char* link : {"to_file", "to_folder", "to_nothing"}) {
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / link)) << link;
  }
  std::filesystem::create_directories(folder_ / "empty.partial");
  std::ofstream(folder_ / "empty.partial" / "file") << "mine";
  EXPECT_EQ(product("--readout sifh --out empty").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "empty" / "Makefile"));
  EXPECT_EQ(read_file(folder_ / "empty.partial" / "file"), "mine");
  EXPECT_EQ(std::filesystem::status(folder_ / "empty").permissions(),
            std::filesystem::status(folder_ / "empty.partial").permissions());
}

TEST_F(Product, NamesItsFolderForAShell) {
  const Outcome made = product("--readout sifh --out 'p 2/x'");
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_THAT(made.output, HasSubstr("`make -C 'p 2/x'` runs"));
  EXPECT_THAT(read_file(folder_ / "p 2/x/README.md"), HasSubstr("--out chip"));
}

TEST_F(Product, TheSensorCommandSaysWhichFramesFit) {
  const auto fits = [&](const std::string& arguments) {
    return shell(fmt::format("{} sensor small.toml {}", DTOF_PROGRAM, arguments));
  };
  EXPECT_THAT(fits("--frame-rate 30").output, Not(HasSubstr("does not fit")));
  const Outcome fast = fits("--frame-rate 300000 --clock-mhz 100");
  EXPECT_EQ(fast.exit_code, 0);
  EXPECT_THAT(fast.output, HasSubstr("SiFH: a frame of 60 acquisitions takes "));
  EXPECT_THAT(fast.output,
              HasSubstr("at 100 MHz; 300000 frames/s leave 333, so that the frame does not fit."));
  EXPECT_EQ(fits("--clock-mhz 100").exit_code, 1);
}

TEST(ProductFiles, RefuseWhatTheSubsystemCannotBe) {
  ProductRequest wide = request(Readout::kSifh);
  wide.sensor.columns = 1025;
  EXPECT_THAT([&] { (void)product_files(wide); },
              ThrowsMessage<InputError>(HasSubstr("at most 1024 columns")));
  ProductRequest lengthy = request(Readout::kSifh);
  lengthy.sensor.acquisitions = 65536;
  EXPECT_THAT([&] { (void)product_files(lengthy); }, ThrowsMessage<InputError>(HasSubstr("to 65535")));
}

/// The cells of the table's line that begins with `begin`.
std::vector<std::string> cells(const std::string& text, const std::string& begin) {
  const std::size_t at = text.find("\n| " + begin + " ");
  std::istringstream line(at == std::string::npos ? ""
                                                  : text.substr(at + 1, text.find('\n', at + 1) - at - 1));
  std::vector<std::string> found;
  for (std::string cell; std::getline(line, cell, '|');) {
    const std::size_t first = cell.find_first_not_of(' ');
    found.push_back(first == std::string::npos ? ""
                                               : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
  }
  return found;
}

TEST(ProductReport, HasErrorsAndCostOfThisConfiguration) {
  ProductRequest made = request(Readout::kHisPointer);
  made.pointer_ports = 1;
  made.seed = 3;
  const std::string text = product_files(made).at("report.md");
  const ReadoutScore score = run_bench({.sensor = made.sensor, .seed = 3}, std::vector{made.parameters},
                                       {.frames = 42, .detection = true})
                                 .front();
  EXPECT_THAT(text, HasSubstr("42 frames of 96 pixels in each light, 60 acquisitions"));
  for (const LightScore& light : score.lights) {
    const std::vector<std::string> row = cells(text, fmt::format("{:g}", light.klux));
    ASSERT_EQ(row.size(), 7U);
    EXPECT_THAT(row[2], StartsWith(fmt::format("{:.2f} [", 100.0 * light.above_3_percent.value)));
    EXPECT_THAT(row[3], StartsWith(fmt::format("{:.2f} [", 100.0 * light.above_10_percent.value)));
    EXPECT_EQ(row[4], fmt::format("{:.1f}", 1e3 * light.rmse_m));
    EXPECT_THAT(row[5], StartsWith(fmt::format("{:.2f} [", 100.0 * light.detected->value)));
    EXPECT_THAT(row[6], StartsWith(fmt::format("{:.2f} [", 100.0 * light.false_alarms->value)));
  }
  const ArrayChoice one{.parameters = made.parameters, .rows = 6, .columns = 8, .pointer_ports = 1};
  EXPECT_EQ(cells(text, "area of cells and memories, mm2").at(2),
            fmt::format("{:.4g}", estimate_cost(one).mm2));
  const double dark = std::stod(cells(text, "power at 2 klux while acquisitions stream in, mW").at(2));
  const double bright = std::stod(cells(text, "power at 50 klux while acquisitions stream in, mW").at(2));
  EXPECT_LT(dark, bright);
  made.pointer_ports = 2;
  EXPECT_GT(std::stod(cells(product_files(made).at("report.md"), "area of cells and memories, mm2").at(2)),
            estimate_cost(one).mm2);
}

TEST(ProductFiles, HaveAPointerMemoryOfOnePortIfAskedFor) {
  ProductRequest made = request(Readout::kHisPointer);
  EXPECT_THAT(product_files(made).at("rtl/dtof_product.sv"), HasSubstr(".POINTER_PORTS(2)"));
  made.pointer_ports = 1;
  EXPECT_THAT(product_files(made).at("rtl/dtof_product.sv"), HasSubstr(".POINTER_PORTS(1)"));
  made.parameters.slots = 1;
  made.sensor.slots = 1;
  EXPECT_THAT(
      [&] { (void)product_files(made); },
      ThrowsMessage<InputError>("product: --pointer-ports is 1, must be 2, or 1 with SLOTS of at least 2"));
  ProductRequest without = request(Readout::kSifh);
  without.pointer_ports = 1;
  EXPECT_THAT([&] { (void)product_files(without); },
              ThrowsMessage<InputError>("product: --pointer-ports has no effect: SiFH has no pointers"));
}

/// The lines of a text.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

// The results are those of the product with an SRAM for each column, in another order.
TEST(ProductFiles, SeveralColumnsOfTheSensorShareAnSram) {
  ProductRequest made = request(Readout::kHisPointer);
  const std::vector<std::string> apart = lines_of(product_files(made).at("vectors/results.hex"));
  made.columns_per_sram = 3;
  const auto files = product_files(made);
  EXPECT_THAT(files.at("rtl/dtof_product.sv"), HasSubstr(".PIXELS_PER_SRAM(18)"));
  EXPECT_THAT(files.at("rtl/dtof_product.sv"), HasSubstr(".SRAM_NUM(3)"));
  EXPECT_THAT(files.at("README.md"), HasSubstr("8 x 6 pixels"));
  EXPECT_THAT(files.at("README.md"), HasSubstr("columns 3 c to 3 c + 2, and its row r is row r mod 6"));
  EXPECT_THAT(files.at("driver/dtof_product.h"), HasSubstr("#define DTOF_PRODUCT_COLUMNS_PER_SRAM 3\n"));
  const std::vector<std::string> shared = lines_of(files.at("vectors/results.hex"));
  ASSERT_EQ(apart.size(), 6U * 8U);
  ASSERT_EQ(shared.size(), 18U * 3U);
  for (std::size_t row = 0; row < 18; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      const std::size_t of_sensor = 3 * column + row / 6;
      if (of_sensor < 8) {
        EXPECT_EQ(shared[3 * row + column], apart[8 * (row % 6) + of_sensor]) << row << ' ' << column;
      }
    }
  }
}

TEST(ProductFiles, RefuseColumnsThatCannotShareAnSram) {
  ProductRequest made = request(Readout::kEzPointer);
  made.columns_per_sram = 9;
  EXPECT_THAT(
      [&] { (void)product_files(made); },
      ThrowsMessage<InputError>("product: --columns-per-sram is 9, must be 1 to the sensor's 8 columns"));
  made.columns_per_sram = 0;
  EXPECT_THROW((void)product_files(made), InputError);
  made.columns_per_sram = 8;
  made.sensor.rows = 513;
  EXPECT_THAT([&] { (void)product_files(made); },
              ThrowsMessage<InputError>(
                  HasSubstr("product: 1 x 4104 pixels of 2 slots; dtof_subsystem has at most")));
  made.sensor.rows = 6;
  made.budget.frames_per_s = 120000.0;
  made.columns_per_sram = 4;
  const auto message = [&] {
    try {
      (void)product_files(made);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(), HasSubstr(" --columns-per-sram 3 would do, too."));
  made.columns_per_sram = 3;
  EXPECT_TRUE(product_fit(made).fits);
  made.budget.frames_per_s = 1e6;
  EXPECT_THAT(message(), Not(HasSubstr("columns-per-sram")));
  ProductRequest pool = request(Readout::kPoolPointer);
  pool.columns_per_sram = 2;
  EXPECT_THAT([&] { (void)product_files(pool); },
              ThrowsMessage<InputError>(
                  "product: --columns-per-sram is 2, must be 1: columns of poolPointer help each other"));
}

TEST(ProductFiles, OfALargeArrayLeaveIcarusVerilogOutOfMake) {
  ProductRequest made = request(Readout::kEzPointer);
  made.vector_acquisitions = 1;
  made.sensor.columns = 64;
  made.sensor.rows = 64;
  EXPECT_THAT(product_files(made).at("Makefile"), HasSubstr("\nall: icarus verilator driver\n"));
  made.sensor.rows = 65;
  const auto files = product_files(made);
  EXPECT_THAT(files.at("Makefile"), HasSubstr("\nall: verilator driver\n"));
  EXPECT_THAT(files.at("Makefile"), HasSubstr("PASS: verilator, driver"));
  EXPECT_THAT(files.at("README.md"), HasSubstr("`make icarus` does the same"));
}

TEST(ProductFiles, HaveTheDriverWithoutTheFilter) {
  std::vector<std::string> names;
  for (const auto& [path, text] : product_files(request(Readout::kEzPointer))) {
    if (path.starts_with("driver/")) {
      names.push_back(path.substr(7));
    }
  }
  EXPECT_THAT(names, ElementsAre("check.c", "dtof.h", "dtof_access.h", "dtof_control.c", "dtof_product.h",
                                 "dtof_registers.h", "dtof_results.c", "dtof_setup.c"));
}

TEST(ProductFiles, NameEachOther) {
  const std::map<std::string, std::string> files = product_files(request(Readout::kPoolPointerLean));
  for (const char* list : {"product.f", "dtof_product.core", "Bender.yml"}) {
    SCOPED_TRACE(list);
    for (const auto& [path, text] : files) {
      if (path.starts_with("rtl/") && path.ends_with(".sv")) {
        EXPECT_THAT(files.at(list), HasSubstr(path));
      }
    }
  }
  EXPECT_THAT(files.at("constraints/power_intent/dtof_subsystem.upf"),
              HasSubstr("load_upf [file join [file dirname [info script]] dtof_array.upf]"));
  EXPECT_THAT(files.at("constraints/power_intent/dtof_array.upf"), HasSubstr("create_power_domain PD_ARRAY"));
  EXPECT_THAT(files.at("README.md"), HasSubstr("| `constraints/power_intent/` |"));
  for (const auto& [path, text] : files) {
    if (path != "LICENSE" && !path.starts_with("vectors/") && path != "sensor.toml") {
      EXPECT_THAT(text, Not(HasSubstr("@COLUMNS@"))) << path;
    }
  }
}

}  // namespace
}  // namespace dtof
