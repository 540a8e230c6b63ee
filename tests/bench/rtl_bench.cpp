// SPDX-License-Identifier: Apache-2.0
// Speed of the Verilated arrays that `dtof` simulates, with their driver, in column-cycles per second (one
// clock of one column), at the photon density of the thesis's 14 klux. One array per thread. --small: frames
// of few acquisitions.
#include <benchmark/benchmark.h>

#include <vector>

#include "bench/small_option.hpp"
#include "dtof/core/random.hpp"
#include "rtl/registry.hpp"
#include "rtl/rtl_readout.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kAcquisitions = 2000;
constexpr std::uint32_t kFewAcquisitions = 50;
constexpr int kColumns = 200;
constexpr double kEventsPerWindow = 0.3;

// Signal and background alike are spread over the range: what the bus carries matters little for speed.
std::vector<ColumnStream> make_columns(const RtlConfiguration& configuration, std::uint32_t acquisitions) {
  std::vector<ColumnStream> columns(static_cast<std::size_t>(configuration.sram_num));
  for (std::size_t index = 0; index < columns.size(); ++index) {
    CounterRandom random(1, static_cast<std::uint32_t>(RandomPurpose::kTestStream),
                         static_cast<std::uint32_t>(index), 0);
    for (int row = 0; row < configuration.pixels_per_sram; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
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

/// The columns of a pool read-out's array are those of one engine.
void run_array(benchmark::State& state, Readout readout, std::uint32_t acquisitions) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(readout);
  const int columns_of_array = parameters.columns_together() > 1 ? parameters.columns_together() : kColumns;
  const RtlConfiguration configuration = find_rtl_configuration(parameters, kArrayRows, columns_of_array);
  const std::vector<ColumnStream> columns = make_columns(configuration, acquisitions);
  RtlReadout rtl(configuration);
  double column_cycles = 0;
  for (auto _ : state) {
    const RtlFrame frame = rtl.run(columns, acquisitions);
    column_cycles += static_cast<double>(frame.statistics.column_cycles);
    benchmark::DoNotOptimize(frame.results.data());
  }
  state.counters["column_cycles/s"] = benchmark::Counter(column_cycles, benchmark::Counter::kIsRate);
}

}  // namespace
}  // namespace dtof

int main(int argc, char** argv) {
  const bool small = dtof::take_small_option(argc, argv);
  const std::uint32_t acquisitions = small ? dtof::kFewAcquisitions : dtof::kAcquisitions;
  for (const dtof::Readout readout : dtof::kRtlReadouts) {
    auto* bench =
        benchmark::RegisterBenchmark(std::string("rtl/").append(dtof::readout_name(readout)).c_str(),
                                     dtof::run_array, readout, acquisitions);
    bench->Threads(1)->Threads(2)->UseRealTime()->Unit(benchmark::kMillisecond);
    dtof::run_for(*bench, 2.0, small);  // the first frame touches the streams' memory
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
