// SPDX-License-Identifier: Apache-2.0
#include "design_judgement/random_sensor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include "dtof/core/error.hpp"
#include "dtof/core/frame_time.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/core/random.hpp"
#include "dtof/sensor/sensor_file.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kRandomSensors = 1000;  // purpose of the random numbers: none of RandomPurpose
constexpr int kMostDraws = 100;
constexpr double kNanoseconds = 1e9;
constexpr double kReferenceKlux = 14.0;

struct Range {
  double low;
  double high;
};
constexpr Range kRangeNs{20.0, 200.0};
constexpr Range kPulseNs{0.5, 5.0};
constexpr double kLongestPulse = 1.0 / 12.0;  // of the range
constexpr Range kFarEvents{8.0, 80.0};   // signal events of a frame from a white target at the range's end
constexpr Range kBackground{0.03, 0.5};  // events of a pixel and range at kReferenceKlux
constexpr Range kReflectivity{0.3, 1.0};
constexpr Range kQuantile{0.15, 0.85};  // of the grid's costs, at which a limit lies

class Draw {
 public:
  Draw(std::uint64_t seed, int number, int attempt)
      : random_(seed, kRandomSensors, static_cast<std::uint32_t>(number),
                static_cast<std::uint32_t>(attempt)) {}

  double even(Range range) { return range.low + (range.high - range.low) * random_.uniform(); }
  double by_logarithm(Range range) { return range.low * std::pow(range.high / range.low, random_.uniform()); }
  int whole(int low, int high) { return low + static_cast<int>((high - low + 1) * random_.uniform()); }

 private:
  CounterRandom random_;
};

/// Three significant digits, so that the file is easy to read.
double three_digits(double value) { return std::stod(fmt::format("{:.3g}", value)); }

std::string sensor_text(Draw& draw, int number, const SensorRanges& ranges) {
  const auto size = [&](int low, int high) {
    return static_cast<int>(
        std::lround(draw.by_logarithm({static_cast<double>(low), static_cast<double>(high)})));
  };
  const int columns = size(kLeastColumns, ranges.most_columns);
  const int rows = size(kLeastRows, ranges.most_rows);
  const double range_ns = three_digits(draw.by_logarithm(kRangeNs));
  const int np = draw.whole(8, 12);
  const int slots = draw.whole(1, 3);
  const int acquisitions =
      size(static_cast<int>(kLeastAcquisitions), static_cast<int>(ranges.most_acquisitions));
  const double pulse_ns = three_digits(std::min(draw.by_logarithm(kPulseNs), kLongestPulse * range_ns));
  const double far_m = 0.5 * kSpeedOfLight * (range_ns - pulse_ns) / kNanoseconds;
  const double signal = three_digits(draw.by_logarithm(kFarEvents) * far_m * far_m / acquisitions);
  const double background = three_digits(draw.by_logarithm(kBackground) / kReferenceKlux);
  const double reflectivity = three_digits(draw.even(kReflectivity));
  return fmt::format(
      "# A random sensor of `dtof-study design-judgement`.\nname = \"random_{:02}\"\n\n"
      "[array]\ncolumns = {}\nrows = {}\n\n[tdc]\nrange_ns = {}\ntimestamp_bits = {}\nslots = {}\n\n"
      "[laser]\nacquisitions = {}\npulse_fwhm_ns = {}\n\n"
      "[light]\nsignal_events_at_1m = {}\nbackground_events_per_klux = {}\ndefault_reflectivity = {}\n\n"
      "[detector]\ndark_count_rate_hz = 1e4\n",
      number, columns, rows, range_ns, np, slots, acquisitions, pulse_ns, signal, background, reflectivity);
}

/// Three digits, rounded so that the candidate with this cost keeps the limit.
double rounded(double value, bool up) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return std::stod(fmt::format("{:.6g}", (up ? std::ceil(value / step) : std::floor(value / step)) * step));
}

/// Sets one limit, or none, and returns its option.
std::string draw_limit(Draw& draw, DesignRequest& request) {
  enum Kind { kNone, kArea, kPower, kFrameRate };
  const int kind = draw.whole(kNone, kFrameRate);
  const double quantile = draw.even(kQuantile);
  const std::vector<DesignCandidate> candidates = kept_of(design_candidates(request), request.limits);
  if (candidates.empty()) {
    throw InputError("no read-out keeps the clock and the default frame rate");
  }
  const auto cost = [&](const std::function<double(const DesignCandidate&)>& of, bool up) {
    std::vector<double> costs;
    std::ranges::transform(candidates, std::back_inserter(costs), of);
    std::ranges::sort(costs);
    return rounded(costs[static_cast<std::size_t>(quantile * static_cast<double>(costs.size()))], up);
  };
  DesignLimits& limits = request.limits;
  const double clock_hz = limits.budget.clock_hz;
  switch (kind) {
    case kArea:
      limits.most_mm2 = cost([](const DesignCandidate& c) { return c.cost.mm2; }, true);
      return fmt::format("--max-mm2 {:g}", limits.most_mm2);
    case kPower:
      limits.most_mw = cost([=](const DesignCandidate& c) { return c.mw(clock_hz); }, true);
      return fmt::format("--max-mw {:g}", limits.most_mw);
    case kFrameRate:
      limits.budget.frames_per_s =
          cost([=](const DesignCandidate& c) { return c.frames_per_s(clock_hz); }, false);
      return fmt::format("--frame-rate {:g}", limits.budget.frames_per_s);
    default:
      return "";
  }
}

}  // namespace

std::vector<DesignCandidate> kept_of(const std::vector<DesignCandidate>& grid, const DesignLimits& limits) {
  std::vector<DesignCandidate> kept;
  std::ranges::copy_if(grid, std::back_inserter(kept),
                       [&](const DesignCandidate& c) { return limits_kept(c, limits).all(); });
  return kept;
}

std::vector<DesignCandidate> smallest_of_each(const std::vector<DesignCandidate>& candidates) {
  std::vector<DesignCandidate> smallest;
  for (const DesignCandidate& one : candidates) {
    const auto found =
        std::ranges::find(smallest, compared_parameters(one.array.parameters),
                          [](const DesignCandidate& c) { return compared_parameters(c.array.parameters); });
    if (found == smallest.end()) {
      smallest.push_back(one);
    } else if (one.cost.mm2 < found->cost.mm2) {
      *found = one;
    }
  }
  return smallest;
}

RandomSensor draw_sensor(std::uint64_t seed, int number, const SensorRanges& ranges) {
  for (int attempt = 0; attempt < kMostDraws; ++attempt) {
    Draw draw(seed, number, attempt);
    RandomSensor drawn;
    drawn.refused = attempt;
    drawn.toml = sensor_text(draw, number, ranges);
    try {
      drawn.request.bench.sensor = parse_sensor(drawn.toml, fmt::format("random_{:02}.toml", number));
      drawn.options = draw_limit(draw, drawn.request);
      return drawn;
    } catch (const InputError&) {
      continue;
    }
  }
  throw InputError("design judgement: no sensor of these ranges suits a read-out");
}

std::string sensor_line(const SensorModel& sensor) {
  return fmt::format(
      "{} x {}, NP {}, {} SLOTS, {:g} ns in bins of {:.3g} ps, pulse {:g} ns, {} acquisitions, "
      "signal {:g} / R^2, background {:g} a klux, reflectivity {:g}",
      sensor.columns, sensor.rows, sensor.np, sensor.slots, sensor.integration_time_s * kNanoseconds,
      sensor.time_resolution_s() * 1e12, sensor.pulse_fwhm_s * kNanoseconds, sensor.acquisitions,
      sensor.signal_events_1m, sensor.background_events_per_klux, sensor.default_reflectivity);
}

std::string ranges_text(const SensorRanges& ranges) {
  return fmt::format(
      "columns {} to {}, rows {} to {}, range {:g} to {:g} ns, NP 8 to 12, SLOTS 1 to 3, acquisitions {} to "
      "{}, pulse {:g} to {:g} ns (at most a twelfth of the range), {:g} to {:g} signal events a frame from a "
      "white target at the range's end, {:g} to {:g} background events a range at {:g} klux, reflectivity "
      "{:g} to {:g}",
      kLeastColumns, ranges.most_columns, kLeastRows, ranges.most_rows, kRangeNs.low, kRangeNs.high,
      kLeastAcquisitions, ranges.most_acquisitions, kPulseNs.low, kPulseNs.high, kFarEvents.low,
      kFarEvents.high, kBackground.low, kBackground.high, kReferenceKlux, kReflectivity.low,
      kReflectivity.high);
}

}  // namespace dtof
