// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/result.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/pipeline/region.hpp"

namespace dtof::python {

/// The engine of this name, "model" or "rtl", for a region of `source`. Throws InputError for another name,
/// and as make_rtl_engine.
std::unique_ptr<FrameEngine> make_engine(const std::string& name, const StreamSource& source,
                                         std::span<const ReadoutParameters> readouts, const Region& region,
                                         int threads, Progress::Observer observer);

/// A frame of one read-out as Python holds it: arrays may show its results.
class Results {
 public:
  Results(ReadoutParameters parameters, Region region, ReadoutRun run)
      : parameters_(parameters),
        region_(std::move(region)),
        clocks_(run.cycles),
        results_(std::make_shared<const std::vector<PixelResult>>(std::move(run.results))) {}

  [[nodiscard]] const ReadoutParameters& parameters() const { return parameters_; }
  [[nodiscard]] const Region& region() const { return region_; }
  /// Clocks of a frame of the RTL; nothing for the model, or if unknown.
  [[nodiscard]] std::optional<std::uint64_t> clocks() const {
    return clocks_ == 0 ? std::nullopt : std::optional(clocks_);
  }
  [[nodiscard]] const std::vector<PixelResult>& pixels() const { return *results_; }
  [[nodiscard]] std::vector<pybind11::ssize_t> shape() const {
    return {region_.rows.count, static_cast<pybind11::ssize_t>(region_.columns.size())};
  }
  /// One number of each pixel, where it lies in the results.
  [[nodiscard]] pybind11::array_t<std::uint16_t> field(std::uint16_t PixelResult::*member) const;
  /// Places on the code axis in bins.
  [[nodiscard]] pybind11::array_t<double> positions() const;

 private:
  ReadoutParameters parameters_;
  Region region_;
  std::uint64_t clocks_;
  std::shared_ptr<const std::vector<PixelResult>> results_;
};

}  // namespace dtof::python
