// SPDX-License-Identifier: Apache-2.0
#include "video/prior_engine.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {
namespace {

/// Columns of an engine that begins from `prior` and leaves the next frame's prior there.
class PriorModel final : public ReadoutModel {
 public:
  PriorModel(const ReadoutParameters& parameters, std::vector<PoolPrior>& prior)
      : np_(parameters.np), numbers_(pool_pointer_parameters(parameters)), prior_(&prior) {}

  [[nodiscard]] std::vector<PixelResult> run_column(const ColumnStream& column,
                                                    std::uint32_t acquisitions) override {
    return std::move(run_columns(
                         1, [&](int) -> const ColumnStream& { return column; }, acquisitions)
                         .front());
  }

  [[nodiscard]] std::vector<std::vector<PixelResult>> run_columns(int count, const ColumnReader& column,
                                                                  std::uint32_t acquisitions) override {
    return run_pool_pointer(count, column, np_, acquisitions, numbers_, prior_);
  }

  void run_sampled_column(PixelSampler& /*sampler*/, int /*column*/, std::uint32_t /*acquisitions*/,
                          std::span<PixelResult> /*results*/) override {
    throw InputError("a prior needs whole streams");
  }

 private:
  int np_;
  PoolNumbers numbers_;
  std::vector<PoolPrior>* prior_;
};

}  // namespace

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
    std::unique_ptr<ReadoutModel> model = std::make_unique<PriorModel>(parameters, prior);
    if (parameters.time_gate) {
      model = make_gated_model(parameters, std::move(model));
    }
    const auto results = model->run_columns(
        static_cast<int>(count),
        [&](int column) -> const ColumnStream& {
          return stream = source.column(static_cast<int>(first) + column);
        },
        source.acquisitions());
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
