// SPDX-License-Identifier: Apache-2.0
#include "common/independent_photons.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <span>
#include <utility>

#include "dtof/core/detection.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/random.hpp"
#include "dtof/metrics/cramer_rao.hpp"

namespace dtof {
namespace {

constexpr double kFromTheEnds = 5.0;  // standard deviations of the pulse
const double kFwhmOfSigma = 2.0 * std::sqrt(2.0 * std::log(2.0));

void check(const IndependentPhotons& photons) {
  if (!(photons.signal_share >= 0.0 && photons.signal_share <= 1.0)) {
    throw InputError(
        fmt::format("independent photons: the signal's share must be 0 to 1, not {}", photons.signal_share));
  }
  if (!(photons.pulse_sigma > 0.0 && photons.pulse_sigma < 0.5 / kFromTheEnds)) {
    throw InputError(
        fmt::format("independent photons: the pulse's standard deviation must be above 0 and below {} of the "
                    "range, not {}",
                    0.5 / kFromTheEnds, photons.pulse_sigma));
  }
}

/// A pixel's frame with the pulse at `centre`, in codes from the range's begin on.
void draw(const IndependentPhotons& photons, double centre, SplitMix64& random,
          std::vector<Detection>& detections) {
  const double codes = std::ldexp(1.0, photons.np);
  boost::random::normal_distribution<double> pulse(centre, photons.pulse_sigma * codes);
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1.0p-53; };
  detections.clear();
  for (std::uint32_t acquisition = 0; acquisition < photons.detections; ++acquisition) {
    const double time = uniform() < photons.signal_share ? pulse(random) : uniform() * codes;
    // The last code means "no detection"; none is lost, so that all frames have as many.
    const double code = std::clamp(std::floor(time), 0.0, codes - 2.0);
    detections.push_back({acquisition, static_cast<Timestamp>(code)});
  }
}

}  // namespace

SensorModel IndependentPhotons::sensor() const {
  SensorModel sensor;
  sensor.np = np;
  sensor.slots = 1;
  sensor.acquisitions = detections;
  sensor.pulse_fwhm_s = pulse_sigma * sensor.integration_time_s * kFwhmOfSigma;
  return sensor;
}

double IndependentPhotons::cramer_rao_bound() const {
  const double codes = std::ldexp(1.0, np);
  return dtof::cramer_rao_bound({.signal_events = signal_share,
                                 .background_events = 1.0 - signal_share,
                                 .centre_bins = 0.5 * codes,
                                 .sigma_bins = pulse_sigma * codes,
                                 .np = np,
                                 .acquisitions = static_cast<double>(detections),
                                 .kept_events = 0});
}

PlaceEstimator estimator_of(std::unique_ptr<Rival> rival) {
  return [kept = std::shared_ptr<const Rival>(std::move(rival))](PixelFrames frames) {
    return kept->decode(kept->read_pixel(frames.last(static_cast<std::size_t>(kept->frames())))).position;
  };
}

PlaceErrors place_errors(const IndependentPhotons& photons, const std::vector<PlaceEstimator>& estimators,
                         std::size_t pixels, std::uint64_t seed, int threads, std::size_t frames) {
  check(photons);
  PlaceErrors result{std::vector<double>(pixels),
                     std::vector<std::vector<double>>(estimators.size(), std::vector<double>(pixels))};
  constexpr std::size_t kTogether = 16;  // pixels of a thread's turn, which share their memory
  parallel_for((pixels + kTogether - 1) / kTogether, threads, [&](std::size_t turn) {
    std::vector<std::vector<Detection>> drawn(frames);
    const double codes = std::ldexp(1.0, photons.np);
    const double margin = kFromTheEnds * photons.pulse_sigma * codes;
    for (std::size_t pixel = turn * kTogether; pixel < std::min(pixels, (turn + 1) * kTogether); ++pixel) {
      CounterRandom pixels_random(seed, static_cast<std::uint32_t>(RandomPurpose::kIndependentPhotons),
                                  static_cast<std::uint32_t>(pixel), 0);
      const double centre = margin + pixels_random.uniform() * (codes - 2.0 * margin);
      SplitMix64 random(pixels_random);
      std::vector<std::span<const Detection>> seen;
      for (std::vector<Detection>& frame : drawn) {
        draw(photons, centre, random, frame);
        seen.emplace_back(frame);
      }
      const double place = centre - 0.5;
      result.places[pixel] = place;
      for (std::size_t i = 0; i < estimators.size(); ++i) {
        result.errors[i][pixel] = estimators[i](seen) - place;
      }
    }
  });
  return result;
}

}  // namespace dtof
