// SPDX-License-Identifier: Apache-2.0
// Speed of the Verilated full-size arrays with their driver, in column-cycles per second (one clock of one
// column), at the photon density of the thesis's 14 klux. One array per thread.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/random.hpp"
#include "rtl/registry.hpp"
#include "rtl/rtl_readout.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kAcquisitions = 2000;
constexpr double kEventsPerWindow = 0.3;

// Signal and background alike are spread over the range: what the bus carries matters little for speed.
std::vector<ColumnStream> make_columns(const RtlConfiguration& configuration) {
  std::vector<ColumnStream> columns(static_cast<std::size_t>(configuration.sram_num));
  for (std::size_t index = 0; index < columns.size(); ++index) {
    CounterRandom random(1, static_cast<std::uint32_t>(RandomPurpose::kTestStream),
                         static_cast<std::uint32_t>(index), 0);
    for (int row = 0; row < configuration.pixels_per_sram; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
        if (random.uniform() < kEventsPerWindow) {
          const std::uint32_t code =
              random() % static_cast<std::uint32_t>(configuration.parameters.no_detection());
          columns[index].append({acquisition, static_cast<Timestamp>(code)});
        }
      }
      columns[index].finish_row();
    }
  }
  return columns;
}

void run_array(benchmark::State& state, Readout readout) {
  const RtlConfiguration configuration =
      find_rtl_configuration(ReadoutParameters::defaults(readout), 160, 200);
  const std::vector<ColumnStream> columns = make_columns(configuration);
  RtlReadout rtl(configuration);
  double column_cycles = 0;
  for (auto _ : state) {
    const RtlFrame frame = rtl.run(columns, kAcquisitions);
    column_cycles += static_cast<double>(frame.statistics.column_cycles);
    benchmark::DoNotOptimize(frame.results.data());
  }
  state.counters["column_cycles/s"] = benchmark::Counter(column_cycles, benchmark::Counter::kIsRate);
}

}  // namespace
}  // namespace dtof

int main(int argc, char** argv) {
  for (const dtof::Readout readout : dtof::kRtlReadouts) {
    benchmark::RegisterBenchmark(std::string("rtl/").append(dtof::readout_name(readout)).c_str(),
                                 dtof::run_array, readout)
        ->Threads(1)
        ->Threads(2)
        ->UseRealTime()
        ->MinTime(2.0)  // the first frame touches the streams' memory
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
