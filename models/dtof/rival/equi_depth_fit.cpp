// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/equi_depth_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "dtof/readout/matched_filter.hpp"
#include "dtof/rival/equi_depth.hpp"
#include "dtof/rival/pulse_shape.hpp"

namespace dtof {
namespace {

constexpr std::array kBackgrounds = {0.05, 0.4, 1.0, 3.0};              // B
constexpr std::array kSignalShares = {0.03, 0.08, 0.2, 0.5, 1.5, 5.0};  // S / B
constexpr std::size_t kGrid = 1024;  // places of a table; codes in between are interpolated

/// Kept events before each code, of rates for each code, if the first `slots` events of an acquisition are
/// kept: the mean of min(N, slots) for a Poisson number N.
void keep_first_events(std::vector<double>& rates, int slots) {
  double events = 0.0;
  for (double& rate : rates) {
    events += rate;
    double kept = slots;
    double exactly = std::exp(-events);
    for (int n = 0; n < slots; ++n) {
      kept -= (slots - n) * exactly;
      exactly *= events / (n + 1);
    }
    rate = kept;
  }
}

/// The same for free-running capture. The equation of d is solved by going round the circle until it is
/// settled.
void keep_free_running(std::vector<double>& rates, double dead_codes) {
  constexpr int kRounds = 40;
  const std::size_t codes = rates.size();
  const auto dead = static_cast<std::size_t>(std::lround(dead_codes));
  std::vector<double> density(codes, 0.0);
  std::vector<double> settled(codes, 0.0);
  for (int round = 0; round < kRounds; ++round) {
    // Detections of the last `dead` codes: whole rounds, and the rest before code 0.
    double recent = static_cast<double>(dead / codes) * std::accumulate(density.begin(), density.end(), 0.0);
    for (std::size_t back = 1; back <= dead % codes; ++back) {
      recent += density[codes - back];
    }
    for (std::size_t x = 0; x < codes; ++x) {
      const double now = rates[x] * std::clamp(1.0 - recent, 0.0, 1.0);
      const std::size_t gone = (x + codes - dead % codes) % codes;
      recent += (dead > 0 ? now : 0.0) - (dead > 0 ? density[gone] : 0.0);
      settled[x] = 0.5 * (density[x] + now);  // damped: long dead times swing
    }
    density = settled;
  }
  std::partial_sum(density.begin(), density.end(), rates.begin());
}

class FittedEquiDepth final : public Rival {
 public:
  FittedEquiDepth(const SensorModel& sensor, int parts)
      : chip_(make_hierarchical_equi_depth(sensor, {.parts = parts})),
        parts_(parts),
        no_detections_(chip_->read_pixel(std::array{std::span<const Detection>()})),
        fit_(sensor, Capture::kFirstEvents) {}

  [[nodiscard]] int bits_per_pixel() const override { return chip_->bits_per_pixel(); }
  [[nodiscard]] RivalHardware hardware() const override { return chip_->hardware(); }
  [[nodiscard]] int host_operations() const override { return fit_.operations(parts_); }
  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override { return chip_->read_pixel(frames); }
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    Measurement found = fit_.decode({words.begin(), words.end()});
    found.confidence = std::ranges::equal(words, no_detections_) ? 0.0 : found.confidence;
    return found;
  }

 private:
  std::unique_ptr<Rival> chip_;
  int parts_;
  RivalWords no_detections_;
  EquiDepthFit fit_;
};

}  // namespace

EquiDepthFit::EquiDepthFit(const SensorModel& sensor, Capture capture) : codes_(std::ldexp(1.0, sensor.np)) {
  constexpr double kMostPositions = 512.0;
  const PulseShape pulse(sensor);
  const auto codes = static_cast<int>(codes_);
  step_ = std::max(0.5 * pulse.sigma(), codes_ / kMostPositions);
  positions_ = static_cast<std::size_t>((codes_ - 2.0) / step_) + 1;
  tables_ = kBackgrounds.size() * kSignalShares.size() * positions_;
  shares_.resize((kGrid + 1) * tables_);
  std::size_t table = 0;
  for (const double background : kBackgrounds) {
    for (const double share : kSignalShares) {
      for (std::size_t position = 0; position < positions_; ++position, ++table) {
        std::vector<double> events(static_cast<std::size_t>(codes), background / codes_);
        const int centre = static_cast<int>(std::lround(step_ * static_cast<double>(position)));
        for (int x = centre - pulse.reach(); x <= centre + pulse.reach(); ++x) {
          if (capture == Capture::kFreeRunning || (x >= 0 && x < codes)) {
            const int place = (x % codes + codes) % codes;
            events[static_cast<std::size_t>(place)] += share * background * pulse.share(x - centre);
          }
        }
        if (capture == Capture::kFreeRunning) {
          keep_free_running(events, sensor.dead_time_s / sensor.time_resolution_s());
        } else {
          keep_first_events(events, sensor.slots);
        }
        for (std::size_t place = 1; place <= kGrid; ++place) {
          const auto code =
              static_cast<std::size_t>(std::lround(codes_ * static_cast<double>(place) / kGrid));
          shares_[place * tables_ + table] =
              code == 0 ? 0.0F : static_cast<float>(events[code - 1] / events.back());
        }
      }
    }
  }
}

Measurement EquiDepthFit::decode(std::vector<double> boundaries) const {
  constexpr double kLeastShare = 1e-4;
  std::ranges::sort(boundaries);
  std::vector<double> product(tables_, 1.0);  // of the parts' shares
  std::vector<double> before(tables_, 0.0);
  for (const double boundary : boundaries) {
    const double place = std::clamp(boundary / codes_, 0.0, 1.0) * kGrid;
    const std::size_t left = std::min(static_cast<std::size_t>(place), kGrid - 1);
    const double inside = place - static_cast<double>(left);
    const float* const first = shares_.data() + left * tables_;
    const float* const second = first + tables_;
    for (std::size_t table = 0; table < tables_; ++table) {
      const double until =
          (1.0 - inside) * static_cast<double>(first[table]) + inside * static_cast<double>(second[table]);
      product[table] *= std::max(until - before[table], kLeastShare);
      before[table] = until;
    }
  }
  std::vector<double> best(positions_, 0.0);  // over all pairs
  for (std::size_t table = 0; table < tables_; ++table) {
    const double found = product[table] * std::max(1.0 - before[table], kLeastShare);
    best[table % positions_] = std::max(best[table % positions_], found);
  }
  for (double& value : best) {
    value = std::log(value) / static_cast<double>(boundaries.size() + 1);
  }
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(best) - best.begin());
  const double mean = std::accumulate(best.begin(), best.end(), 0.0) / static_cast<double>(best.size());
  return {std::clamp(step_ * refined_peak(best, peak), 0.0, codes_ - 2.0), best[peak] - mean};
}

std::unique_ptr<Rival> make_fitted_equi_depth(const SensorModel& sensor, int parts) {
  return std::make_unique<FittedEquiDepth>(sensor, parts);
}

}  // namespace dtof
