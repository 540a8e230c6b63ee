// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dtof/readout/histogram.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/pass_schedule.hpp"

namespace dtof {

/// Throws InputError for a timestamp or an acquisition outside the frame's range.
void check_detections(std::span<const Detection> detections, int row, const ReadoutParameters& parameters,
                      std::uint32_t acquisitions);

/// ReadoutModel for a `Pixel` class with `start_frame(acquisitions)` and `read(cursor) -> PixelResult`. The
/// virtual call is per column; the loop over detections is inlined. A Pixel with histograms also has
/// `histogram()`, and `bins()`, the position of the bins of the last histogram that `read` built.
template <typename Pixel>
class PixelwiseModel final : public ReadoutModel {
 public:
  explicit PixelwiseModel(const ReadoutParameters& parameters)
      : parameters_(parameters), pixel_(parameters) {}

  /// Throws InputError for a timestamp or an acquisition outside the frame's range.
  [[nodiscard]] std::vector<PixelResult> run_column(const ColumnStream& column,
                                                    std::uint32_t acquisitions) override {
    pixel_.start_frame(acquisitions);
    std::vector<PixelResult> results;
    results.reserve(static_cast<std::size_t>(column.rows()));
    for (int row = 0; row < column.rows(); ++row) {
      const std::span<const Detection> detections = column.row(row);
      check_detections(detections, row, parameters_, acquisitions);
      results.push_back(
          pixel_.read(PassCursor(detections, static_cast<std::uint32_t>(parameters_.no_detection()))));
    }
    return results;
  }

  [[nodiscard]] std::vector<std::vector<PixelResult>> run_raw_column(const ColumnStream& column,
                                                                     std::uint32_t acquisitions) override {
    if constexpr (requires { pixel_.histogram(); }) {
      const auto bins = static_cast<std::size_t>(parameters_.raw_bins());
      if (bins > 0) {
        std::vector<std::uint16_t> counts;
        std::vector<std::vector<PixelResult>> rows;
        pixel_.histogram().copy_counts_to(&counts);
        pixel_.start_frame(acquisitions);
        for (int row = 0; row < column.rows(); ++row) {
          const std::span<const Detection> detections = column.row(row);
          check_detections(detections, row, parameters_, acquisitions);
          pixel_.read(PassCursor(detections, static_cast<std::uint32_t>(parameters_.no_detection())));
          std::vector<PixelResult>& results = rows.emplace_back();
          const HistogramBins place = pixel_.bins();
          for (std::size_t bin = 0; bin < bins; ++bin) {
            const std::int32_t code =
                place.first + (static_cast<std::int32_t>(bin) << static_cast<unsigned>(place.shift));
            results.push_back(
                {.code = static_cast<std::uint16_t>(std::clamp(code, 0, parameters_.no_detection())),
                 .fraction = 0,
                 .confidence = counts[bin]});
          }
        }
        pixel_.histogram().copy_counts_to(nullptr);
        return rows;
      }
    }
    return ReadoutModel::run_raw_column(column, acquisitions);
  }

  void run_sampled_column(PixelSampler& sampler, int column, std::uint32_t acquisitions,
                          std::span<PixelResult> results) override {
    pixel_.start_frame(acquisitions);
    for (std::size_t row = 0; row < results.size(); ++row) {
      sampler.start_pixel(column, static_cast<int>(row));
      results[row] =
          pixel_.read(SampledCursor(sampler, static_cast<std::uint32_t>(parameters_.no_detection())));
    }
  }

 private:
  ReadoutParameters parameters_;
  Pixel pixel_;
};

/// Makes the read-out's model without its time gate (model_table.cpp, written from readouts.toml). Throws
/// InputError for an unknown read-out.
std::unique_ptr<ReadoutModel> make_ungated_model(const ReadoutParameters& parameters);
/// Puts the time gate of `parameters` in front of `model`.
std::unique_ptr<ReadoutModel> make_gated_model(const ReadoutParameters& parameters,
                                               std::unique_ptr<ReadoutModel> model);

}  // namespace dtof
