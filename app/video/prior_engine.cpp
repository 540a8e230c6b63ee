// SPDX-License-Identifier: Apache-2.0
#include "video/prior_engine.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"

namespace dtof {

ReadoutRun PriorEngine::read(const StreamSource& source, const ReadoutParameters& parameters,
                             const Region& region) const {
  const auto width = static_cast<std::size_t>(source.columns());
  const auto rows = static_cast<std::size_t>(source.rows());
  if (parameters.readout != Readout::kPoolPointer || region.columns.size() != width ||
      region.rows != RowRange{.first = 0, .count = source.rows()}) {
    throw InputError("a prior is poolPointer's, and of whole frames");
  }
  const auto together = static_cast<std::size_t>(parameters.columns_together());
  const std::size_t engines = (width + together - 1) / together;
  priors_->resize(engines);
  ReadoutRun run;
  run.results.resize(width * rows);
  parallel_for(engines, threads_, [&](std::size_t engine) {
    const std::size_t first = engine * together;
    const std::size_t count = std::min(together, width - first);
    ColumnStream stream;
    std::vector<PoolPrior> prior = {std::move((*priors_)[engine])};
    const auto results = run_pool_pointer(
        static_cast<int>(count),
        [&](int column) -> const ColumnStream& {
          return stream = source.column(static_cast<int>(first) + column);
        },
        parameters.np, source.acquisitions(), pool_pointer_parameters(parameters), &prior);
    (*priors_)[engine] = std::move(prior.front());
    for (std::size_t column = 0; column < count; ++column) {
      for (std::size_t row = 0; row < rows; ++row) {
        run.results[row * width + first + column] = results[column][row];
      }
    }
  });
  return run;
}

}  // namespace dtof
