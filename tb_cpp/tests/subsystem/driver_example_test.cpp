// SPDX-License-Identifier: Apache-2.0
// The driver's example of docs/user/registers.md, which uses the driver's defaults, on the Verilated
// subsystem: two walls.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "dtof.h"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/photon_source.hpp"
#include "tests/subsystem/subsystem_test_support.hpp"

// What the example leaves to its user, and what it gives.
extern "C" {
bool my_read(void* context, std::uint32_t offset, std::uint32_t* value) {
  const dtof::BusResponse response = static_cast<dtof::SubsystemBench*>(context)->read(offset);
  *value = response.data;
  return !response.error;
}

bool my_write(void* context, std::uint32_t offset, std::uint32_t value) {
  return !static_cast<dtof::SubsystemBench*>(context)->write(offset, value).error;
}

bool my_receive(void* context, std::uint64_t* words, std::size_t count) {
  auto& bench = *static_cast<dtof::SubsystemBench*>(context);
  constexpr std::uint64_t kMostClocks = 10000000;
  bench.wait_for_frames(1, kMostClocks);
  const std::vector<std::uint64_t>& frame = bench.sink().frames().back();
  std::ranges::copy_n(frame.begin(), static_cast<std::ptrdiff_t>(std::min(count, frame.size())), words);
  return frame.size() == count;
}

bool read_frame(void* context, std::uint32_t acquisitions, const dtof_point* table, std::size_t points,
                double* distances_mm);
}

namespace dtof {
namespace {

constexpr double kNearWall = 1.5;  // m: the upper half of the rows
constexpr double kFarWall = 3.0;
constexpr double kKlux = 50.0;            // so much that 33,333 acquisitions fill a counter of either product
constexpr std::uint64_t kPhotonSeed = 1;  // the depths that are expected rest on it

/// A frame of the example, and what it should be.
struct ExampleFrame {
  bool read = false;
  std::vector<ResultFields> received;
  std::vector<ResultFields> expected;  ///< the model's, with the recommended schedule
  std::vector<double> distances_m;     ///< pixels row by row
  std::vector<double> walls_m;
};

ExampleFrame example_frame(const CompiledSubsystem& subsystem, std::uint32_t acquisitions) {
  SubsystemBench bench(subsystem, test_seed());
  const RtlConfiguration& configuration = bench.configuration();
  const ReadoutParameters& parameters = configuration.parameters;
  SensorModel sensor;
  sensor.columns = configuration.sram_num;
  sensor.rows = configuration.pixels_per_sram;
  sensor.np = parameters.np;
  sensor.slots = parameters.slots;
  sensor.acquisitions = acquisitions;

  ExampleFrame frame;
  TargetMap walls(sensor.columns, sensor.rows);
  for (int row = 0; row < sensor.rows; ++row) {
    for (int column = 0; column < sensor.columns; ++column) {
      walls.at(column, row) = {.depth_m = row < sensor.rows / 2 ? kNearWall : kFarWall};
      frame.walls_m.push_back(walls.at(column, row).depth_m);
    }
  }
  const PhotonSource photons(sensor, walls, kKlux, kPhotonSeed);
  std::vector<Line> lines = dark_lines(configuration, acquisitions);
  for (int column = 0; column < sensor.columns; ++column) {
    const ColumnStream stream = photons.column(column);
    for (int row = 0; row < sensor.rows; ++row) {
      put_pixel(lines, configuration, static_cast<std::size_t>(column), static_cast<std::size_t>(row),
                stream.row(row));
    }
  }
  push_lines(bench, lines);

  const DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  std::array<dtof_point, 2> table{};
  for (std::size_t end = 0; end < table.size(); ++end) {
    table[end].position = end == 0 ? 0.0 : parameters.code_count();
    table[end].distance_mm = 1000.0 * scale.depth(table[end].position);
  }
  frame.distances_m.resize(frame.walls_m.size());
  frame.read = read_frame(&bench, acquisitions, table.data(), table.size(), frame.distances_m.data());
  for (double& distance : frame.distances_m) {
    distance /= 1000.0;
  }
  if (frame.read) {
    frame.received = received_results(bench, 0);
    const FrameSettings settings{
        .acquisitions = acquisitions, .gate = {0, parameters.no_detection()}, .enabled = {}};
    frame.expected = expected_results(bench, settings, lines);
  }
  return frame;
}

/// A frame is simulated once for all tests of this file.
const ExampleFrame& frame_of(const CompiledSubsystem& subsystem, std::uint32_t acquisitions) {
  static std::map<std::pair<std::string, std::uint32_t>, ExampleFrame> frames;
  const auto key = std::pair(subsystem.configuration.to_string(), acquisitions);
  const auto found = frames.find(key);
  return found != frames.end() ? found->second
                               : frames.emplace(key, example_frame(subsystem, acquisitions)).first->second;
}

/// One subsystem of either product of poolPointer, with several groups in a column.
std::vector<CompiledSubsystem> both_products() {
  constexpr int kFewestRows = 8;
  std::vector<CompiledSubsystem> products = compiled_subsystems();
  std::erase_if(products, [](const CompiledSubsystem& subsystem) {
    const ReadoutParameters& parameters = subsystem.configuration.parameters;
    return !is_pool_readout(parameters.readout) || subsystem.configuration.pixels_per_sram < kFewestRows ||
           parameters.pool.prior;
  });
  return products;
}

void expect_what_the_model_says(const CompiledSubsystem& subsystem, std::uint32_t acquisitions) {
  const ExampleFrame& frame = frame_of(subsystem, acquisitions);
  ASSERT_TRUE(frame.read);
  ASSERT_EQ(frame.received, frame.expected);
}

class DriverExample : public testing::TestWithParam<CompiledSubsystem> {};

INSTANTIATE_TEST_SUITE_P(All, DriverExample, testing::ValuesIn(compiled_subsystems()), subsystem_test_name);

TEST_P(DriverExample, IsTheModelBitForBit) {
  if (!SubsystemBench(GetParam(), test_seed()).source_waits()) {
    GTEST_SKIP() << "the example's source waits";
  }
  expect_what_the_model_says(GetParam(), 64);
}

class DriverExampleOfBothProducts
    : public testing::TestWithParam<std::tuple<CompiledSubsystem, std::uint32_t>> {};

INSTANTIATE_TEST_SUITE_P(Long, DriverExampleOfBothProducts,
                         testing::Combine(testing::ValuesIn(both_products()), testing::Values(3333U, 33333U)),
                         [](const testing::TestParamInfo<DriverExampleOfBothProducts::ParamType>& tested) {
                           const testing::TestParamInfo<CompiledSubsystem> subsystem(
                               std::get<0>(tested.param), tested.index);
                           return fmt::format("{}_acquisitions_{}", subsystem_test_name(subsystem),
                                              std::get<1>(tested.param));
                         });

TEST(DriverExampleProducts, AreBoth) {
  std::vector<Readout> readouts;
  for (const CompiledSubsystem& subsystem : both_products()) {
    readouts.push_back(subsystem.configuration.parameters.readout);
  }
  EXPECT_EQ(readouts, (std::vector<Readout>{Readout::kPoolPointer, Readout::kPoolPointerLean}));
}

TEST_P(DriverExampleOfBothProducts, IsTheModelBitForBit) {
  expect_what_the_model_says(std::get<0>(GetParam()), std::get<1>(GetParam()));
}

TEST_P(DriverExampleOfBothProducts, SeesBothWalls) {
  const ExampleFrame& frame = frame_of(std::get<0>(GetParam()), std::get<1>(GetParam()));
  ASSERT_TRUE(frame.read);
  for (std::size_t pixel = 0; pixel < frame.walls_m.size(); ++pixel) {
    EXPECT_NEAR(frame.distances_m[pixel], frame.walls_m[pixel], 0.03 * frame.walls_m[pixel])
        << "pixel " << pixel;
  }
}

}  // namespace
}  // namespace dtof
