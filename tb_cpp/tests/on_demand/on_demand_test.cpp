// SPDX-License-Identifier: Apache-2.0
#include "on_demand/on_demand.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "rtl/registry.hpp"
#include "rtl/run_frame.hpp"
#include "subsystem/subsystem_frame.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A sensor of its own size and bits.
PhotonSource small_scene(int columns, int rows, int np) {
  SensorModel sensor = parse_preset("thesis");
  sensor.np = np;
  sensor.columns = columns;
  sensor.rows = rows;
  sensor.acquisitions = 200;
  return {sensor, make_scene(Scene::kRoom, {.columns = columns, .rows = rows}), 14.0, 1};
}

std::vector<int> all_columns(int columns) {
  std::vector<int> all(static_cast<std::size_t>(columns));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

class OnDemand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder() = std::filesystem::temp_directory_path() / fmt::format("dtof_on_demand_test_{}", getpid());
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder()); }
  void SetUp() override { setenv("DTOF_CACHE", folder().c_str(), 1); }

  static std::filesystem::path& folder() {
    static std::filesystem::path path;
    return path;
  }
};

TEST_F(OnDemand, ArraysOfAnySizeAndBitsAgreeWithTheModel) {
  struct Case {
    Readout readout;
    int columns;
    int rows;
    int np;
  };
  for (const Case& c : {Case{Readout::kSifh, 8, 6, 8}, Case{Readout::kPoolPointer, 8, 6, 8},
                        Case{Readout::kHisPointer, 5, 7, 12}, Case{Readout::kPoolPointerLean, 7, 9, 12},
                        Case{Readout::kEzPointer, 13, 3, 3}}) {
    SCOPED_TRACE(fmt::format("{} {} x {}, {} bits", readout_name(c.readout), c.columns, c.rows, c.np));
    const PhotonSource source = small_scene(c.columns, c.rows, c.np);
    const ReadoutParameters parameters = default_parameters(c.readout, source.model());
    EXPECT_THROW((void)find_rtl_configurations(parameters, c.rows, c.columns, all_columns(c.columns)),
                 InputError);
    build_missing_arrays(parameters, c.rows, c.columns, all_columns(c.columns));
    EXPECT_EQ(run_frame_rtl(source, parameters).results, run_frame(source, parameters));
  }
}

TEST_F(OnDemand, SubsystemsAgreeWithTheModel) {
  for (const Readout readout : {Readout::kFifh, Readout::kPoolPointer}) {
    SCOPED_TRACE(readout_name(readout));
    const PhotonSource source = small_scene(6, 5, 9);
    const ReadoutParameters parameters = default_parameters(readout, source.model());
    build_missing_subsystems(parameters, 5, 6, all_columns(6));
    EXPECT_EQ(run_frame_subsystem(source, parameters, 1, all_columns(6), nullptr).results,
              run_frame(source, parameters));
  }
}

TEST_F(OnDemand, ABrokenArrayIsSeen) {
  std::vector<SourceFile> sources(project_sources().begin(), project_sources().end());
  const auto update = std::ranges::find(sources, "hdl/thesis/dtof_pointer_update.sv", &SourceFile::path);
  ASSERT_NE(update, sources.end());
  std::string broken(update->text);
  const std::string_view right = "left ? down : up";
  ASSERT_NE(broken.find(right), std::string::npos);
  broken.replace(broken.find(right), right.size(), "left ? up : down");
  update->text = broken;
  const PhotonSource source = small_scene(4, 3, 7);
  const ReadoutParameters parameters = default_parameters(Readout::kEzPointer, source.model());
  build_missing_arrays(parameters, 3, 4, all_columns(4), sources);
  EXPECT_NE(run_frame_rtl(source, parameters).results, run_frame(source, parameters));
}

TEST_F(OnDemand, SaysWhatIsWrongWithTheRtl) {
  std::vector<SourceFile> sources(project_sources().begin(), project_sources().end());
  for (SourceFile& file : sources) {
    if (file.path == "hdl/thesis/dtof_array.sv") {
      file.text = "module dtof_array;\n  nonsense\nendmodule\n";
    }
  }
  const PhotonSource source = small_scene(4, 3, 6);
  const ReadoutParameters parameters = default_parameters(Readout::kEzPointer, source.model());
  EXPECT_THAT(
      [&] { build_missing_arrays(parameters, 3, 4, all_columns(4), sources); },
      ThrowsMessage<InputError>(testing::AllOf(
          HasSubstr("verilator failed: %Error: hdl/thesis/dtof_array.sv:3"), HasSubstr(".log has all"))));
}

TEST_F(OnDemand, IllegalParametersAreRefused) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 9);
  parameters.nb = 12;
  EXPECT_THAT([&] { build_missing_arrays(parameters, 3, 4, all_columns(4)); },
              ThrowsMessage<InputError>(HasSubstr("NB must be 1 to NP, not 12")));
  EXPECT_THAT(
      [] {
        build_missing_subsystems(ReadoutParameters::defaults(Readout::kSifh, 9), 4097, 4, all_columns(4));
      },
      ThrowsMessage<InputError>(HasSubstr("at most 4096 rows")));
}

TEST_F(OnDemand, WithoutToolsOneLineSaysSo) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 5);
  const auto build = [&] { build_missing_arrays(parameters, 2, 2, all_columns(2)); };
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  EXPECT_THAT(build, ThrowsMessage<InputError>(HasSubstr("none is built: verilator does not run here")));
  setenv("PATH", path.c_str(), 1);
  setenv("CXX", "/nowhere/c++", 1);
  EXPECT_THAT(build,
              ThrowsMessage<InputError>(HasSubstr("none is built: no C++ compiler runs here: /nowhere/c++")));
  unsetenv("CXX");
  setenv("DTOF_CACHE", "off", 1);
  EXPECT_THAT(build, ThrowsMessage<InputError>(HasSubstr("none is built: DTOF_CACHE is off")));
}

}  // namespace
}  // namespace dtof
