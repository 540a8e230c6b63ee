// SPDX-License-Identifier: Apache-2.0
#include "rivals/flux_photons.hpp"

#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <limits>
#include <span>

#include "dtof/core/detection.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/random.hpp"

namespace dtof {
namespace {

/// Draws frames of one pixel.
class FluxPixel {
 public:
  FluxPixel(const FluxPhotons& photons, double centre, SplitMix64 random)
      : photons_(photons),
        codes_(std::ldexp(1.0, photons.np)),
        random_(random),
        pulse_(centre, photons.pulse_sigma * codes_) {}

  void draw(bool lit, std::vector<Detection>& detections) {
    detections.clear();
    double armed = -std::numeric_limits<double>::infinity();  // in codes from the frame's begin on
    for (std::uint32_t acquisition = 0; acquisition < photons_.acquisitions; ++acquisition) {
      const double begin = acquisition * codes_;
      if (photons_.kept == FluxPhotons::Kept::kSynchronous) {
        armed = begin;
      }
      draw_times(lit);
      for (const double time : times_) {
        if (photons_.kept != FluxPhotons::Kept::kAll) {
          if (begin + time < armed) {
            continue;
          }
          armed = begin + time + photons_.dead_time * codes_;
        }
        // The last code means "no detection".
        detections.push_back(
            {acquisition, static_cast<Timestamp>(std::clamp(std::floor(time), 0.0, codes_ - 2.0))});
      }
    }
  }

 private:
  double uniform() { return static_cast<double>(random_() >> 11U) * 0x1.0p-53; }

  /// A Poisson number, by the waiting times of its events.
  int poisson(double mean) {
    int number = -1;
    for (double time = 0.0; time < mean; ++number) {
      time -= std::log1p(-uniform());
    }
    return mean > 0.0 ? number : 0;
  }

  /// The photons of an acquisition, in order.
  void draw_times(bool lit) {
    times_.clear();
    for (int left = poisson(photons_.background_events); left > 0; --left) {
      times_.push_back(uniform() * codes_);
    }
    for (int left = lit ? poisson(photons_.signal_events) : 0; left > 0; --left) {
      times_.push_back(std::clamp(pulse_(random_), 0.0, std::nextafter(codes_, 0.0)));
    }
    std::ranges::sort(times_);
  }

  const FluxPhotons& photons_;
  double codes_;
  SplitMix64 random_;
  boost::random::normal_distribution<double> pulse_;
  std::vector<double> times_;
};

}  // namespace

SensorModel FluxPhotons::sensor() const {
  SensorModel sensor =
      IndependentPhotons{.np = np, .pulse_sigma = pulse_sigma, .detections = acquisitions}.sensor();
  sensor.dead_time_s = dead_time * sensor.integration_time_s;
  return sensor;
}

PlaceErrors flux_errors(const FluxPhotons& photons, const std::vector<PlaceEstimator>& estimators,
                        std::size_t pixels, std::uint64_t seed, int threads, std::size_t frames,
                        std::size_t laser_off_frames) {
  constexpr double kMargin = 5.0;  // standard deviations of the pulse
  PlaceErrors result{std::vector<double>(pixels),
                     std::vector<std::vector<double>>(estimators.size(), std::vector<double>(pixels))};
  parallel_for(pixels, threads, [&](std::size_t pixel) {
    const double codes = std::ldexp(1.0, photons.np);
    const double margin = kMargin * photons.pulse_sigma * codes;
    CounterRandom pixels_random(seed, static_cast<std::uint32_t>(RandomPurpose::kIndependentPhotons),
                                static_cast<std::uint32_t>(pixel), 1);
    const double centre = margin + pixels_random.uniform() * (codes - 2.0 * margin);
    FluxPixel source(photons, centre, SplitMix64(pixels_random));
    std::vector<std::vector<Detection>> drawn(frames);
    std::vector<std::span<const Detection>> seen;
    for (std::size_t frame = 0; frame < frames; ++frame) {
      source.draw(frame >= laser_off_frames, drawn[frame]);
      seen.emplace_back(drawn[frame]);
    }
    const double place = centre - 0.5;
    result.places[pixel] = place;
    for (std::size_t i = 0; i < estimators.size(); ++i) {
      result.errors[i][pixel] = estimators[i](seen) - place;
    }
  });
  return result;
}

}  // namespace dtof
