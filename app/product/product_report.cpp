// SPDX-License-Identifier: Apache-2.0
#include "product/product_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/latency.hpp"
#include "dtof/design/bench.hpp"
#include "dtof/design/estimate.hpp"
#include "dtof/report/table.hpp"

namespace dtof {
namespace {

constexpr double kPerCent = 100.0;

BenchSettings bench_of(const ProductRequest& request) {
  return {.sensor = request.sensor, .seed = request.seed, .threads = request.threads};
}

/// As many frames as `dtof design` reads, with so few pixels of a large array that the bench takes seconds.
BenchEffort effort_of(const BenchSettings& bench, const ReadoutParameters& readout) {
  constexpr int kFrames = 4;
  constexpr double kWork = 1e9;  // pixels x acquisitions
  const auto scenes = static_cast<double>(bench.scenes.size());
  const SensorModel& sensor = bench.sensor;
  const int frames = bench_frames(bench, kFrames);
  const double each = kWork / (frames * scenes * static_cast<double>(bench.klux.size()));
  return {.pixels = each / std::max(sensor.acquisitions, 1U),
          .frames = frames,
          .detection = true,
          .engine_columns = bench_engine_columns(std::span(&readout, 1))};
}

std::string share(const std::optional<Estimate>& estimate) {
  return estimate ? fmt::format("{:.2f} [{:.2f}, {:.2f}]", kPerCent * estimate->value,
                                kPerCent * estimate->covering().low, kPerCent * estimate->covering().high)
                  : "-";
}

std::string accuracy(const ProductRequest& request) {
  const BenchSettings bench = bench_of(request);
  const BenchEffort effort = effort_of(bench, request.parameters);
  const ReadoutScore score = run_bench(bench, std::vector{request.parameters}, effort).front();
  Table table({"klux", "off by > 3 % in %", "> 10 % in %", "rmse mm", "P_d in %", "P_fa in %"});
  for (const LightScore& light : score.lights) {
    table.add({fmt::format("{:g}", light.klux), share(light.above_3_percent), share(light.above_10_percent),
               fmt::format("{:.1f}", 1e3 * light.rmse_m), share(light.detected), share(light.false_alarms)});
  }
  return fmt::format(
      "The model, which the bench compares with the RTL, reads the scenes room and poles, with distances in "
      "proportion to\nthe sensor's range: {} frames of {} pixels in each light, {} acquisitions, exact "
      "photons, "
      "a look-up table from flat targets,\nseed {}. In brackets: intervals at 95 %. {}\n\n{}",
      effort.frames, score.pixels, bench.sensor.acquisitions, bench.seed,
      score.threshold
          ? fmt::format(
                "P_d: pixels with a confidence of at least {} that are at most 10 % off; P_fa: pixels "
                "of the sky with such a confidence.",
                *score.threshold)
          : "",
      table.markdown());
}

std::string cost(const ProductRequest& request) {
  constexpr double kMegahertz = 1e-6;
  const SensorModel& sensor = request.sensor;
  const double clock_hz = request.budget.clock_hz;
  const RtlConfiguration product = product_array(request);
  const ArrayChoice array{.parameters = request.parameters,
                          .rows = product.pixels_per_sram,
                          .columns = product.sram_num,
                          .arrays = 1,
                          .pointer_ports = request.pointer_ports,
                          .columns_per_sram = request.columns_per_sram};
  const CostEstimate estimate = estimate_cost(array);
  const EstimateErrors& errors = EstimateCoefficients::built_in().errors;
  const auto clocks = predicted_latency_clocks(request.parameters, array.rows, array.columns);
  Table table({"figure of the array", "value"});
  table.add({"area of cells and memories, mm2", fmt::format("{:.4g}", estimate.mm2)});
  table.add({"fastest clock in the slow corner, MHz", fmt::format("{:.0f}", estimate.fmax_mhz)});
  const BenchSettings bench = bench_of(request);
  for (const double klux : bench.klux) {
    double taken = 0.0;
    for (const Scene scene : bench.scenes) {
      taken += slot_rate(sensor, scaled_scene(scene, sensor, bench.seed), klux);
    }
    taken /= static_cast<double>(bench.scenes.size());
    table.add({fmt::format("power at {:g} klux while acquisitions stream in, mW", klux),
               fmt::format("{:.4g}", estimate_mw(array, taken, clock_hz * kMegahertz))});
  }
  table.add({"memory, bits a pixel", fmt::format("{:g}", estimate.bits_per_pixel)});
  table.add({"latency, from the last timestamps to the last result, ms",
             fmt::format("{:.3g}", 1e3 * static_cast<double>(clocks) / clock_hz)});
  return fmt::format(
      "Area, clock and power are estimates at {:g} MHz in the project's generated 40 nm library, without the "
      "registers and buffers of\ndtof_subsystem. Of arrays that the estimates have not seen they were off by "
      "at "
      "most {:.1f} % (area), {:.1f} % (power) and\n{:.1f} % (clock). `--measure` measures area and "
      "clock.\n\n{}",
      clock_hz * kMegahertz, kPerCent * errors.area, kPerCent * errors.power, kPerCent * errors.fmax,
      table.markdown());
}

/// The section, or why there is none.
std::string section(const ProductRequest& request, std::string (*text)(const ProductRequest&)) {
  try {
    return text(request);
  } catch (const InputError& error) {
    return fmt::format("Not computed: {}.\n", error.what());
  }
}

}  // namespace

std::string product_report(const ProductRequest& request, std::span<const RtlSetting> settings) {
  std::string parameters;
  for (const RtlSetting& setting : settings) {
    parameters += fmt::format("| {} | {} |\n", setting.name, setting.value);
  }
  return fmt::format(
      "# Report\n\n{}\n\n## Accuracy\n\n{}\n## Area, timing and power\n\n{}{}\n## Parameters\n\n"
      "| parameter of dtof_subsystem | value |\n|---|---:|\n{}",
      product_fit(request).sentence, section(request, accuracy),
      request.measurements.empty() ? "" : "### Measured\n\n" + request.measurements + "\n\n### Estimated\n\n",
      section(request, cost), parameters);
}

}  // namespace dtof
