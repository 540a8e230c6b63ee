// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/surroundings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/expint.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"

namespace dtof {
namespace {

constexpr int kMostOffsetBits = 12;
constexpr double kMostPixelsPerFrame = 1000.0;
constexpr double kLargest = std::numeric_limits<double>::max();

/// Written so that a NaN fails.
void require(bool legal, std::string_view what, double value) {
  if (!legal || !std::isfinite(value)) {
    throw InputError(fmt::format("sensor model: {}, not {}", what, value));
  }
}

/// Uniform between -1 and 1.
double skew_draw(std::uint64_t seed, std::uint32_t column, std::uint32_t row) {
  return 2.0 * CounterRandom(seed, static_cast<std::uint32_t>(RandomPurpose::kTimingSkew), column, row)
                   .uniform() -
         1.0;
}

/// Pulses after the first that the laser sends, over the frame's length.
double settled_share(double silent_share, std::uint32_t acquisition, std::uint32_t acquisitions) {
  return static_cast<double>(acquisition) / acquisitions - silent_share;
}

}  // namespace

double LaserSettling::power(std::uint32_t acquisition, std::uint32_t acquisitions) const {
  const double since = settled_share(silent_share, acquisition, acquisitions);
  if (since < 0.0) {
    return 0.0;
  }
  double power = 1.0 + power_drift * ((acquisition + 0.5) / acquisitions - 0.5);
  if (power_drop != 0.0) {
    power *= 1.0 - power_drop * std::exp(-since / time_share);
  }
  return power;
}

double LaserSettling::delay(std::uint32_t acquisition, std::uint32_t acquisitions) const {
  const double since = settled_share(silent_share, acquisition, acquisitions);
  return delay_s == 0.0 || since < 0.0 ? 0.0 : delay_s * std::exp(-since / time_share);
}

double TimingSkew::of_pixel(int column, int row, int columns) const {
  double skew = 0.0;
  if (column_s != 0.0) {
    switch (pattern) {
      case SkewPattern::kAlternating:
        skew = column % 2 == 0 ? column_s : -column_s;
        break;
      case SkewPattern::kRamp:
        skew = columns > 1 ? column_s * (2.0 * column / (columns - 1) - 1.0) : 0.0;
        break;
      case SkewPattern::kRandom:
        // Rows count from 1 below, so that a column's number is no pixel's.
        skew = column_s * skew_draw(seed, static_cast<std::uint32_t>(column), 0);
        break;
    }
  }
  if (pixel_s != 0.0) {
    skew +=
        pixel_s * skew_draw(seed, static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row) + 1);
  }
  return skew;
}

std::vector<double> FiringOffsets::delays(std::uint32_t acquisitions) const {
  std::vector<double> delays;
  if (bits == 0) {
    return delays;
  }
  delays.reserve(acquisitions);
  constexpr int kStepsPerPulse = 16;
  const std::uint32_t mask = (1U << static_cast<unsigned>(bits)) - 1U;
  std::uint32_t state = seed;
  for (std::uint32_t i = 0; i < acquisitions; ++i) {
    delays.push_back(step_s * (state & mask));
    for (int step = 0; step < kStepsPerPulse; ++step) {
      const std::uint32_t feedback = (state ^ (state >> 2U) ^ (state >> 3U) ^ (state >> 5U)) & 1U;
      state = (state >> 1U) | (feedback << 15U);
    }
  }
  return delays;
}

namespace {

/// Place of a moving pixel in the scene, in pixels from its own.
double place(double pixels_per_frame, std::uint32_t acquisition, std::uint32_t acquisitions) {
  return pixels_per_frame * (acquisition - 0.5 * (acquisitions - 1.0)) / acquisitions;
}

}  // namespace

double seen_share(const LateralMotion& motion, const SeenPixel& seen, std::uint32_t acquisition,
                  std::uint32_t acquisitions) {
  // Two squares of side 1 whose centres are `apart` share this part of a side.
  const auto overlap = [](double apart) { return std::max(0.0, 1.0 - std::abs(apart)); };
  return overlap(place(motion.columns_per_frame, acquisition, acquisitions) - seen.columns) *
         overlap(place(motion.rows_per_frame, acquisition, acquisitions) - seen.rows);
}

std::vector<SeenPixel> seen_pixels(const LateralMotion& motion, std::uint32_t acquisitions) {
  std::vector<SeenPixel> seen;
  if (motion.none()) {
    return seen;
  }
  for (std::uint32_t i = 0; i < acquisitions; ++i) {
    const auto left = static_cast<int>(std::floor(place(motion.columns_per_frame, i, acquisitions)));
    const auto upper = static_cast<int>(std::floor(place(motion.rows_per_frame, i, acquisitions)));
    for (const int columns : {left, left + 1}) {
      for (const int rows : {upper, upper + 1}) {
        const SeenPixel now{.columns = columns, .rows = rows, .first = i, .end = i + 1};
        const double share = seen_share(motion, now, i, acquisitions);
        if (share == 0.0) {
          continue;
        }
        // The place moves on a straight line: a pixel that was left does not come back.
        const auto known = std::find_if(seen.rbegin(), seen.rend(), [&](const SeenPixel& earlier) {
          return earlier.columns == columns && earlier.rows == rows;
        });
        SeenPixel& pixel = known == seen.rend() ? seen.emplace_back(now) : *known;
        pixel.end = i + 1;
        pixel.largest_share = std::max(pixel.largest_share, share);
      }
    }
  }
  return seen;
}

bool Surroundings::none() const {
  Surroundings other = *this;
  other.firing_offsets = {};
  if (cover_glass.events == 0.0) {
    other.cover_glass = {};
  }
  if (fog.extinction_per_m == 0.0) {
    other.fog = {};
  }
  if (pane.distance_m == 0.0) {
    other.pane = {};
  }
  if (other_laser.events == 0.0) {
    other.other_laser = {};
  }
  if (skew.none()) {
    other.skew = {};
  }
  if (!signal_changes()) {
    other.settling = {};
  }
  return other == Surroundings();
}

bool Surroundings::signal_changes() const {
  return motion.velocity_m_per_s != 0.0 || !lateral.none() || settling.silent_share != 0.0 ||
         settling.power_drop != 0.0 || settling.delay_s != 0.0 || settling.power_drift != 0.0;
}

double Surroundings::two_way_transmittance(double distance_m) const {
  double share = fog.extinction_per_m > 0.0 ? std::exp(-2.0 * fog.extinction_per_m * distance_m) : 1.0;
  if (pane.distance_m > 0.0 && distance_m > pane.distance_m) {
    share *= pane.transmittance * pane.transmittance;
  }
  return share;
}

double Surroundings::sunlight_share(double distance_m, bool target) const {
  return pane.distance_m > 0.0 && (!target || distance_m > pane.distance_m) ? pane.transmittance : 1.0;
}

void Surroundings::validate() const {
  require(cover_glass.events >= 0.0,
          "the cover glass's crosstalk must be a finite number of at least 0 events", cover_glass.events);
  require(cover_glass.distance_m >= 0.0, "the cover glass must be at least 0 m away", cover_glass.distance_m);
  require(fog.extinction_per_m >= 0.0, "the fog's extinction must be a finite number of at least 0 per m",
          fog.extinction_per_m);
  require(fog.lidar_ratio_sr > 0.0, "the fog's lidar ratio must be above 0 sr", fog.lidar_ratio_sr);
  require(fog.overlap_m > 0.0, "the fog's overlap must begin above 0 m", fog.overlap_m);
  require(pane.distance_m >= 0.0, "the pane must be at least 0 m away", pane.distance_m);
  require(pane.reflectivity >= 0.0, "the pane's reflectivity must be at least 0", pane.reflectivity);
  require(pane.transmittance >= 0.0 && pane.transmittance <= 1.0, "the pane's transmittance must be 0 to 1",
          pane.transmittance);
  require(other_laser.events >= 0.0, "the other laser must have a finite number of at least 0 events",
          other_laser.events);
  require(other_laser.rate_offset > -1.0 && other_laser.rate_offset < kLargest,
          "the other laser's rate offset must be above -1", other_laser.rate_offset);
  require(true, "the other laser's first arrival must be finite", other_laser.first_arrival_s);
  require(other_laser.pulse_fwhm_s >= 0.0, "the other laser's pulse must have an FWHM of at least 0 s",
          other_laser.pulse_fwhm_s);
  require(true, "a target's velocity must be finite", motion.velocity_m_per_s);
  for (const double pixels : {lateral.columns_per_frame, lateral.rows_per_frame}) {
    require(std::abs(pixels) <= kMostPixelsPerFrame,
            "the camera must move by at most 1000 pixels per frame in each direction", pixels);
  }
  require(settling.silent_share >= 0.0 && settling.silent_share <= 1.0,
          "the laser's silent share of the frame must be 0 to 1", settling.silent_share);
  require(settling.power_drop >= 0.0 && settling.power_drop <= 1.0, "the laser's power drop must be 0 to 1",
          settling.power_drop);
  require(settling.time_share >= 0.0, "the laser's time constant must be at least 0", settling.time_share);
  require(settling.power_drift >= -2.0 && settling.power_drift <= 2.0,
          "the laser's power drift must be -2 to 2", settling.power_drift);
  require(true, "the laser's delay must be finite", settling.delay_s);
  if (settling.power_drop != 0.0 || settling.delay_s != 0.0) {
    require(settling.time_share > 0.0, "a laser that settles needs a time constant above 0",
            settling.time_share);
  }
  require(skew.column_s >= 0.0, "the columns' skew must be at least 0 s", skew.column_s);
  require(skew.pixel_s >= 0.0, "the pixels' skew must be at least 0 s", skew.pixel_s);
  require(firing_offsets.bits >= 0 && firing_offsets.bits <= kMostOffsetBits,
          "firing offsets must have 0 to 12 bits", firing_offsets.bits);
  require(firing_offsets.step_s >= 0.0, "a step of the firing offsets must be at least 0 s",
          firing_offsets.step_s);
  require(firing_offsets.seed != 0, "the firing offsets' seed must not be 0", firing_offsets.seed);
}

double fog_events(const Fog& fog, double signal_events_1m, double distance_m) {
  if (fog.extinction_per_m == 0.0 || distance_m <= fog.overlap_m) {
    return 0.0;
  }
  const auto from = [&](double metres) {
    return std::isinf(metres) ? 0.0 : boost::math::expint(2U, 2.0 * fog.extinction_per_m * metres) / metres;
  };
  return signal_events_1m * std::numbers::pi * fog.extinction_per_m / fog.lidar_ratio_sr *
         (from(fog.overlap_m) - from(distance_m));
}

}  // namespace dtof
