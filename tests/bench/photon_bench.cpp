// SPDX-License-Identifier: Apache-2.0
// Speed of the photon models and of a frame through the read-out models: thesis preset, 14 klux, 200 x 160
// pixels, 3,333 acquisitions; a plane from 0.8 to 5 m (columns of equal pixels) and the room (every pixel
// different). CPU time adds the threads up; scripts/photon_baseline.py sets it beside NumPy. --small: frames
// of few acquisitions.

#include <benchmark/benchmark.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/small_option.hpp"
#include "dtof/analytic/code_distribution.hpp"
#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

constexpr std::array kReadouts = {Readout::kEzPointer, Readout::kHisPointer, Readout::kSifh,
                                  Readout::kFifh,      Readout::kThreeSteps, Readout::kHistogram};

constexpr std::uint32_t kFewAcquisitions = 50;

SensorModel bench_sensor(bool small) {
  SensorModel sensor = parse_preset("thesis");
  if (small) {
    sensor.acquisitions = kFewAcquisitions;
  }
  return sensor;
}

PhotonSource full_frame(const SensorModel& sensor, Scene scene) {
  return {sensor, make_scene(scene, {}), 14.0, 1};
}

/// The same light as a transient cube with one return of each pixel, in one bin of 10 ps.
PhotonSource cube_frame(const SensorModel& sensor, Scene scene) {
  constexpr double kBinWidth = 10e-12;
  TargetMap targets = make_scene(scene, {});
  auto cube = std::make_shared<TransientCube>(targets.columns(), targets.rows(),
                                              TransientScale{.bin_width_s = kBinWidth});
  std::vector<double> events(static_cast<std::size_t>(sensor.integration_time_s / kBinWidth));
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      const PixelTarget& target = targets.at(column, row);
      double& bin = events.at(static_cast<std::size_t>(2.0 * target.depth_m / kSpeedOfLight / kBinWidth));
      bin = sensor.signal_events(target.depth_m, target.reflectivity);
      cube->set(column, row, events);
      bin = 0.0;
    }
  }
  targets.set_cube(std::move(cube));
  return {sensor, std::move(targets), 14.0, 1};
}

void set_rate(benchmark::State& state, std::uint64_t detections) {
  state.counters["detections/s"] =
      benchmark::Counter(static_cast<double>(detections), benchmark::Counter::kIsRate);
}

/// Streams of all columns, not read.
void photons(benchmark::State& state, const PhotonSource& exact, Fidelity fidelity, int threads) {
  const auto source = make_source(fidelity, exact);
  std::atomic<std::uint64_t> detections = 0;
  for ([[maybe_unused]] auto _ : state) {
    parallel_for(static_cast<std::size_t>(source->columns()), threads, [&](std::size_t column) {
      detections += source->column(static_cast<int>(column)).detection_count();
    });
  }
  set_rate(state, detections);
}

/// The sampler's timestamps of all pixels over the whole range, not read.
void sampled_photons(benchmark::State& state, const SensorModel& sensor, Scene scene, int threads) {
  const auto source = make_source(Fidelity::kFast, full_frame(sensor, scene));
  const auto& sampled = dynamic_cast<const SampledSource&>(*source);
  std::atomic<std::uint64_t> detections = 0;
  for ([[maybe_unused]] auto _ : state) {
    parallel_for(static_cast<std::size_t>(source->columns()), threads, [&](std::size_t column) {
      const auto sampler = sampled.pixel_sampler();
      std::uint64_t count = 0;
      for (int row = 0; row < source->rows(); ++row) {
        sampler->start_pixel(static_cast<int>(column), row);
        count += sampler->draw(source->acquisitions(), 0, 1 << 10).size();
      }
      detections += count;
    });
  }
  set_rate(state, detections);
}

/// Photons and read-out of a frame, as `dtof frame` does it.
void frame(benchmark::State& state, const SensorModel& sensor, Fidelity fidelity, Scene scene,
           Readout readout) {
  const auto source = make_source(fidelity, full_frame(sensor, scene));
  const ReadoutParameters parameters = ReadoutParameters::defaults(readout);
  const auto* sampled = dynamic_cast<const SampledSource*>(source.get());
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(sampled != nullptr ? run_sampled_frame(*sampled, parameters)
                                                : run_frame(*source, parameters));
  }
}

/// One point of a distance sweep without drawing anything.
void distribution(benchmark::State& state, const SensorModel& sensor, Readout readout) {
  const PhotonSource source(sensor, TargetMap(1, 1, {.depth_m = 3.0, .reflectivity = 1.0}), 14.0, 1);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(
        code_distribution(sensor, source.rates(0, 0), ReadoutParameters::defaults(readout)));
  }
}

void register_benchmarks(bool small) {
  constexpr double kSeconds = 0.5;
  const SensorModel sensor = bench_sensor(small);
  const auto add = [small](const std::string& name, auto function) {
    auto* bench = benchmark::RegisterBenchmark(name.c_str(), function);
    bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
    run_for(*bench, kSeconds, small);
  };
  for (const Scene scene : {Scene::kPlane, Scene::kRoom}) {
    const std::string name(scene_name(scene));
    for (const int threads : {1, hardware_threads()}) {
      const std::string suffix = name + "/threads:" + std::to_string(threads);
      add("photons/exact/" + suffix,
          [=](auto& state) { photons(state, full_frame(sensor, scene), Fidelity::kExact, threads); });
      add("photons/exact_cube/" + suffix,
          [=](auto& state) { photons(state, cube_frame(sensor, scene), Fidelity::kExact, threads); });
      add("photons/fast_stream/" + suffix,
          [=](auto& state) { photons(state, full_frame(sensor, scene), Fidelity::kFast, threads); });
      add("photons/fast_sampler/" + suffix,
          [=](auto& state) { sampled_photons(state, sensor, scene, threads); });
    }
    for (const Fidelity fidelity : {Fidelity::kExact, Fidelity::kFast, Fidelity::kAnalytic}) {
      for (const Readout readout : kReadouts) {
        add("frame/" + std::string(fidelity_name(fidelity)) + "/" + name + "/" +
                std::string(readout_name(readout)),
            [=](auto& state) { frame(state, sensor, fidelity, scene, readout); });
      }
    }
  }
  for (const Readout readout : kReadouts) {
    add("distribution/" + std::string(readout_name(readout)),
        [=](auto& state) { distribution(state, sensor, readout); });
  }
}

}  // namespace
}  // namespace dtof

int main(int argc, char** argv) {
  dtof::register_benchmarks(dtof::take_small_option(argc, argv));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
