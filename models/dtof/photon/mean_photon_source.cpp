// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/mean_photon_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/photon/arrival_table.hpp"
#include "dtof/photon/fast_photon_source.hpp"

namespace dtof {
namespace {

/// Evenly spread points in [0, 1) in 32-bit fixed point.
class WeylSequence {
 public:
  double operator()() { return static_cast<double>(state_ += kStep) * 0x1.0p-32; }

 private:
  static constexpr auto kStep = static_cast<std::uint32_t>((std::numbers::phi - 1.0) * 0x1.0p32);
  std::uint32_t state_ = kStep / 2;
};

class MeanPixelSampler final : public PixelSampler {
 public:
  explicit MeanPixelSampler(const PhotonSource& exact) : exact_(exact), table_(exact.model()) {}

  void start_pixel(int column, int row) override {
    table_.build_kept(exact_.rates(column, row), exact_.model().slots);
    points_ = WeylSequence();
  }

  std::span<const Timestamp> draw(std::uint32_t acquisitions, std::int32_t first,
                                  std::int32_t last) override {
    const double begin = table_.cumulative(first);
    const double end = table_.cumulative(last);
    codes_.resize(static_cast<std::size_t>(std::lround(std::max(end - begin, 0.0) * acquisitions)));
    for (Timestamp& code : codes_) {
      code = static_cast<Timestamp>(table_.inverse(begin + (end - begin) * points_()));
    }
    return codes_;
  }

 private:
  PhotonSource exact_;
  ArrivalTable table_;
  WeylSequence points_;
  std::vector<Timestamp> codes_;
};

}  // namespace

MeanPhotonSource::MeanPhotonSource(PhotonSource exact) : exact_(std::move(exact)) {
  if (!FastPhotonSource::supports(exact_)) {
    throw InputError(
        "the analytic photon model has no dead time, afterpulsing, binning, coincidence, measured pulse, TDC "
        "code widths, surroundings or transient cube: use the exact one");
  }
}

ColumnStream MeanPhotonSource::column_rows(int index, RowRange range) const {
  MeanPixelSampler sampler(exact_);
  const SensorModel& model = exact_.model();
  const double acquisition_count = model.acquisitions;
  ColumnStream stream;
  std::vector<Detection> row_detections;
  for (int row = range.first; row < range.first + range.count; ++row) {
    sampler.start_pixel(index, row);
    const auto codes = sampler.draw(model.acquisitions, 0, 1 << model.np);
    const double spacing = acquisition_count / static_cast<double>(codes.size());
    row_detections.clear();
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const double acquisition = std::min((static_cast<double>(i) + 0.5) * spacing, acquisition_count - 1.0);
      row_detections.push_back({static_cast<std::uint32_t>(acquisition), codes[i]});
    }
    // The slots of an acquisition are in time order.
    std::ranges::sort(row_detections, {}, [](const Detection& detection) {
      return std::pair(detection.acquisition, detection.timestamp);
    });
    stream.append_row(row_detections);
  }
  return stream;
}

std::unique_ptr<PixelSampler> MeanPhotonSource::pixel_sampler() const {
  return std::make_unique<MeanPixelSampler>(exact_);
}

}  // namespace dtof
