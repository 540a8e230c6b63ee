// SPDX-License-Identifier: Apache-2.0
#include "playground/phases.hpp"

#include <fmt/format.h>

#include "dtof/readout/pass_schedule.hpp"

namespace dtof {

std::vector<ReadoutPhase> readout_phases(const ReadoutParameters& parameters, std::uint32_t acquisitions) {
  const std::uint32_t half = measurement_1(acquisitions).end;
  switch (parameters.readout) {
    case Readout::kEzPointer:
      return {{"pointer", acquisitions}};
    case Readout::kHistogram:
    case Readout::kCoarseHistogram:
      return {{"histogram", acquisitions}};
    case Readout::kHisPointer1:
    case Readout::kHisPointer:
      return {{"histogram", half}, {"pointer", acquisitions}};
    case Readout::kSifh:
    case Readout::kFifh:
      return {{"coarse histogram", half}, {"fine histogram", acquisitions}};
    case Readout::kThreeSteps: {
      constexpr std::uint32_t kSteps = 3;
      std::vector<ReadoutPhase> phases;
      for (std::uint32_t step = 0; step < kSteps; ++step) {
        phases.push_back({fmt::format("step {}", step + 1), frame_part(half, step, kSteps).end});
      }
      phases.push_back({"fine histogram", acquisitions});
      return phases;
    }
    case Readout::kPifh: {
      const std::uint32_t runs = 1U << static_cast<unsigned>(parameters.np - parameters.nb);
      std::vector<ReadoutPhase> phases;
      for (std::uint32_t run = 0; run < runs; ++run) {
        phases.push_back({fmt::format("run {}", run + 1), frame_part(acquisitions, run, runs).end});
      }
      return phases;
    }
    case Readout::kPoolPointer:
    case Readout::kPoolPointerLean: {
      const PoolSchedule schedule(acquisitions, parameters.pool);
      return {{"coarse", schedule.coarse_end}, {"track", schedule.track_end}, {"pointer", acquisitions}};
    }
  }
  return {};
}

}  // namespace dtof
