// SPDX-License-Identifier: Apache-2.0
#include "dtof/pipeline/frame_engine.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "dtof/core/pixel_sampler.hpp"
#include "dtof/frame/array_rows.hpp"
#include "dtof/readout/run_frame.hpp"

namespace dtof {

ReadoutRun ModelEngine::read(const StreamSource& source, const ReadoutParameters& parameters,
                             const Region& region) const {
  const auto start = std::chrono::steady_clock::now();
  const std::size_t columns = region.columns.size();
  const auto progress =
      settings_.observer
          ? std::make_unique<Progress>(columns, settings_.observer)
          : std::make_unique<Progress>(fmt::format("{} (model)", readout_title(parameters.readout)), columns);
  const ArrayRows array = array_rows(source, region.rows, parameters.readout, settings_.own_rows);
  const auto* sampled = dynamic_cast<const SampledSource*>(array.source.get());
  ReadoutRun run;
  run.results = array.read(
      sampled != nullptr && reads_samples(parameters.readout)
          ? run_sampled_frame(*sampled, parameters, settings_.threads, region.columns, progress.get())
          : run_frame(*array.source, parameters, settings_.threads, region.columns, progress.get()));
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

}  // namespace dtof
