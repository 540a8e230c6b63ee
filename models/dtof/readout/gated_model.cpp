// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {
namespace {

/// Asks the sampler behind it for timestamps inside the gate only.
class GatedSampler final : public PixelSampler {
 public:
  GatedSampler(PixelSampler& sampler, CodeGate gate) : sampler_(sampler), gate_(gate) {}

  void start_pixel(int column, int row) override { sampler_.start_pixel(column, row); }
  std::span<const Timestamp> draw(std::uint32_t acquisitions, std::int32_t first,
                                  std::int32_t last) override {
    return sampler_.draw(acquisitions, std::max(first, gate_.begin), std::min(last, gate_.end));
  }

 private:
  PixelSampler& sampler_;
  CodeGate gate_;
};

/// A read-out that never sees the timestamps outside its time gate.
class GatedModel final : public ReadoutModel {
 public:
  GatedModel(const ReadoutParameters& parameters, std::unique_ptr<ReadoutModel> model)
      : parameters_(parameters), gate_(*parameters.time_gate), model_(std::move(model)) {}

  [[nodiscard]] std::vector<PixelResult> run_column(const ColumnStream& column,
                                                    std::uint32_t acquisitions) override {
    keep(column, acquisitions, kept_);
    return model_->run_column(kept_, acquisitions);
  }

  [[nodiscard]] std::vector<std::vector<PixelResult>> run_columns(int count, const ColumnReader& column,
                                                                  std::uint32_t acquisitions) override {
    return model_->run_columns(
        count,
        [&](int i) -> const ColumnStream& {
          keep(column(i), acquisitions, kept_);
          return kept_;
        },
        acquisitions);
  }

  [[nodiscard]] std::vector<std::vector<PixelResult>> run_raw_column(const ColumnStream& column,
                                                                     std::uint32_t acquisitions) override {
    keep(column, acquisitions, kept_);
    return model_->run_raw_column(kept_, acquisitions);
  }

  void run_sampled_column(PixelSampler& sampler, int column, std::uint32_t acquisitions,
                          std::span<PixelResult> results) override {
    GatedSampler gated(sampler, gate_);
    model_->run_sampled_column(gated, column, acquisitions, results);
  }

 private:
  void keep(const ColumnStream& column, std::uint32_t acquisitions, ColumnStream& kept) const {
    kept.clear();
    for (int row = 0; row < column.rows(); ++row) {
      const std::span<const Detection> detections = column.row(row);
      check_detections(detections, row, parameters_, acquisitions);
      for (const Detection& detection : detections) {
        if (gate_.contains(detection.timestamp)) {
          kept.append(detection);
        }
      }
      kept.finish_row();
    }
  }

  ReadoutParameters parameters_;
  CodeGate gate_;
  std::unique_ptr<ReadoutModel> model_;
  ColumnStream kept_;
};

}  // namespace

std::unique_ptr<ReadoutModel> make_gated_model(const ReadoutParameters& parameters,
                                               std::unique_ptr<ReadoutModel> model) {
  return std::make_unique<GatedModel>(parameters, std::move(model));
}

}  // namespace dtof
