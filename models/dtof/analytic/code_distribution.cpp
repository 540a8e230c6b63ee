// SPDX-License-Identifier: Apache-2.0
#include "dtof/analytic/code_distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/log_gamma.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/readout/pass_schedule.hpp"

namespace dtof {
namespace {

// Branches of a read-out that are less likely are left out.
constexpr double kNegligible = 1e-12;

/// Counts from `first` on that matter for a Poisson number of mean `mean`, and P(N <= first + i) for each.
struct PoissonTable {
  std::int64_t first = 0;
  std::vector<double> exactly;
  std::vector<double> at_most;
};

PoissonTable tabulate_poisson(double mean, std::int64_t from, std::int64_t to) {
  PoissonTable table;
  table.first = from;
  const auto size = static_cast<std::size_t>(to - from + 1);
  table.exactly.resize(size);
  table.at_most.resize(size);
  double below = 0.0;
  if (from > 0) {
    below = mean > 0.0 ? boost::math::gamma_q(static_cast<double>(from), mean) : 1.0;
  }
  for (std::size_t i = 0; i < size; ++i) {
    const double n = static_cast<double>(from) + static_cast<double>(i);
    const double exactly =
        mean > 0.0 ? std::exp(n * std::log(mean) - mean - log_gamma(n + 1.0)) : (n == 0.0 ? 1.0 : 0.0);
    below = std::min(below + exactly, 1.0);
    table.exactly[i] = exactly;
    table.at_most[i] = below;
  }
  return table;
}

/// Nine standard deviations and a bit: how far a Poisson number of this mean lies from it at most.
double poisson_margin(double mean) { return 9.0 * std::sqrt(mean) + 40.0; }

/// P(bin i is the first whose Poisson process reaches `limit`, and before its end).
std::vector<double> first_full_distribution(const std::vector<double>& means, unsigned limit) {
  std::vector<double> result(means.size(), 0.0);
  const double full = limit;
  std::vector<std::size_t> candidates;
  for (std::size_t bin = 0; bin < means.size(); ++bin) {
    if (means[bin] > 0.0 && means[bin] + poisson_margin(means[bin]) >= full) {
      candidates.push_back(bin);
    }
  }
  if (candidates.empty()) {
    return result;
  }
  // The bin of the largest mean is full at about limit / mean of the time.
  const double largest = *std::max_element(means.begin(), means.end());
  const double begin = std::max(full - poisson_margin(full), 0.0) / largest;
  const double end = std::min((full + poisson_margin(full)) / largest, 1.0);
  if (begin >= end) {
    return result;
  }
  constexpr int kPanels = 64;
  const double half_panel = 0.5 * (end - begin) / kPanels;
  std::vector<double> not_full_behind(candidates.size() + 1, 1.0);
  const auto add = [&](double time, double weight) {
    for (std::size_t k = candidates.size(); k-- > 0;) {
      not_full_behind[k] = not_full_behind[k + 1] * boost::math::gamma_q(full, means[candidates[k]] * time);
    }
    double not_full_before = 1.0;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const double mean = means[candidates[k]];
      const double density =
          mean * std::exp((full - 1.0) * std::log(mean * time) - mean * time - log_gamma(full));
      result[candidates[k]] += weight * density * not_full_before * not_full_behind[k + 1];
      not_full_before *= boost::math::gamma_q(full, mean * time);
    }
  };
  using Gauss = boost::math::quadrature::gauss<double, 15>;
  for (int panel = 0; panel < kPanels; ++panel) {
    const double middle = begin + (2 * panel + 1) * half_panel;
    for (std::size_t k = 0; k < Gauss::abscissa().size(); ++k) {
      const double offset = half_panel * Gauss::abscissa()[k];
      const double weight = half_panel * Gauss::weights()[k];
      add(middle + offset, weight);
      if (offset != 0.0) {
        add(middle - offset, weight);
      }
    }
  }
  return result;
}

double sum_of(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Walks a read-out's passes over the expected detections.
class ReadoutDistribution {
 public:
  ReadoutDistribution(const ReadoutParameters& parameters, std::vector<std::vector<double>> slots,
                      std::uint32_t acquisitions)
      : parameters_(parameters),
        slots_(std::move(slots)),
        acquisitions_(acquisitions),
        limit_((1U << static_cast<unsigned>(parameters.count_width)) - 1),
        positions_(static_cast<std::size_t>(parameters.code_count())
                   << static_cast<unsigned>(parameters.fraction_bits)) {
    for (auto& slot : slots_) {
      slot.back() = 0.0;  // no detection
      for (int code = 0; parameters.time_gate && code < parameters.no_detection(); ++code) {
        if (!parameters.time_gate->contains(code)) {
          slot[static_cast<std::size_t>(code)] = 0.0;
        }
      }
    }
    means_ = slots_.front();
    for (std::size_t k = 1; k < slots_.size(); ++k) {
      for (std::size_t code = 0; code < means_.size(); ++code) {
        means_[code] += slots_[k][code];
      }
    }
  }

  std::vector<double> run() {
    switch (parameters_.readout) {
      case Readout::kEzPointer:
        follow({0, acquisitions_}, static_cast<std::uint32_t>(parameters_.code_count()) / 2, -1,
               parameters_.no_detection(), 1.0);
        break;
      case Readout::kHisPointer1:
      case Readout::kHisPointer:
        his_pointer();
        break;
      case Readout::kSifh:
        sifh();
        break;
      case Readout::kFifh:
        fifh();
        break;
      case Readout::kThreeSteps:
        three_steps();
        break;
      case Readout::kPifh:
      case Readout::kHistogram:
        partitioned();
        break;
      case Readout::kPoolPointer:
      case Readout::kPoolPointerLean:
        throw InputError("the analytic model has no read-out that pools pixels");
      default:
        throw InputError(fmt::format("the analytic model has no {}", readout_title(parameters_.readout)));
    }
    return std::move(positions_);
  }

 private:
  /// Peak of `bins` bins of `width` codes from code `first` on (which may be outside the range).
  [[nodiscard]] std::vector<double> peak(std::uint32_t acquisitions, std::int64_t first, std::int64_t width,
                                         std::int64_t bins, FullBin full) const {
    std::vector<double> counts(static_cast<std::size_t>(bins), 0.0);
    const auto codes = static_cast<std::int64_t>(means_.size());
    for (std::int64_t code = std::max<std::int64_t>(first, 0); code < std::min(first + width * bins, codes);
         ++code) {
      counts[static_cast<std::size_t>((code - first) / width)] +=
          acquisitions * means_[static_cast<std::size_t>(code)];
    }
    return peak_distribution(counts, limit_, full);
  }

  /// Fine pass of single-code bins; adds to the result.
  void fine(std::uint32_t acquisitions, std::int64_t first, std::int64_t bins, double probability) {
    const std::vector<double> share = peak(acquisitions, first, 1, bins, FullBin::kFreezes);
    for (std::int64_t bin = 0; bin < bins; ++bin) {
      const std::int64_t code = std::clamp<std::int64_t>(first + bin, 0, parameters_.no_detection() - 1);
      positions_[static_cast<std::size_t>(code)] += probability * share[static_cast<std::size_t>(bin)];
    }
  }

  [[nodiscard]] std::vector<double> coarse() const {
    return peak(measurement_1(acquisitions_).size(), 0, std::int64_t{1} << (parameters_.np - parameters_.nb),
                std::int64_t{1} << parameters_.nb,
                parameters_.readout == Readout::kHisPointer1 ? FullBin::kStays : FullBin::kFreezes);
  }

  void sifh() {
    const std::int64_t step = std::int64_t{1} << (parameters_.np - parameters_.nb);
    const std::int64_t window = std::int64_t{1} << parameters_.nb;
    const std::int64_t centring = parameters_.window_centred ? std::max<std::int64_t>(step / 2 - 1, 0) : 0;
    const std::vector<double> share = coarse();
    for (std::size_t bin = 0; bin < share.size(); ++bin) {
      if (share[bin] > kNegligible) {
        fine(measurement_2(acquisitions_).size(),
             static_cast<std::int64_t>(bin) * step + centring - window / 2 + 1, window, share[bin]);
      }
    }
  }

  void fifh() {
    const std::int64_t step = std::int64_t{1} << (parameters_.np - parameters_.nb);
    const std::vector<double> share = coarse();
    for (std::size_t bin = 0; bin < share.size(); ++bin) {
      if (share[bin] > kNegligible) {
        fine(measurement_2(acquisitions_).size(), static_cast<std::int64_t>(bin) * step, step, share[bin]);
      }
    }
  }

  void three_steps() {
    const std::uint32_t zoom = measurement_1(acquisitions_).size();
    zoom_in(zoom, 0, 0, parameters_.np, 1.0);
  }

  void zoom_in(std::uint32_t zoom, std::uint32_t step, std::int64_t begin, int shift, double probability) {
    constexpr std::uint32_t kSteps = 3;
    constexpr int kStepBits = 3;
    constexpr std::int64_t kFineBins = 16;
    const std::int64_t section = std::int64_t{1} << shift;
    if (step == kSteps) {
      fine(measurement_2(acquisitions_).size(), begin + section / 2 - kFineBins / 2, kFineBins, probability);
      return;
    }
    const int next_shift = std::max(shift - kStepBits, 0);
    const std::int64_t width = std::int64_t{1} << next_shift;
    const std::vector<double> share =
        peak(frame_part(zoom, step, kSteps).size(), begin, width, section / width, FullBin::kFreezes);
    for (std::size_t bin = 0; bin < share.size(); ++bin) {
      if (probability * share[bin] > kNegligible) {
        zoom_in(zoom, step + 1, begin + static_cast<std::int64_t>(bin) * width, next_shift,
                probability * share[bin]);
      }
    }
  }

  void partitioned() {
    // A later run must be strictly better, and so must a later bin: all runs are one histogram.
    const int bin_bits = parameters_.readout == Readout::kHistogram ? parameters_.np : parameters_.nb;
    const auto runs = static_cast<std::uint32_t>(1U << static_cast<unsigned>(parameters_.np - bin_bits));
    std::vector<double> counts(means_.size());
    for (std::size_t code = 0; code < counts.size(); ++code) {
      counts[code] =
          means_[code] *
          frame_part(acquisitions_, static_cast<std::uint32_t>(code >> static_cast<unsigned>(bin_bits)), runs)
              .size();
    }
    positions_ = peak_distribution(counts, limit_, runs == 1 ? FullBin::kFreezes : FullBin::kStays);
  }

  void his_pointer() {
    const std::int32_t step = 1 << (parameters_.np - parameters_.nb);
    const std::int32_t reach = parameters_.readout == Readout::kHisPointer1
                                   ? parameters_.code_count()
                                   : (1 << parameters_.nb) / 2 + parameters_.guard;
    const std::vector<double> share = coarse();
    // One chain from all starts at once where the window is everything.
    for (std::size_t bin = 0; bin < share.size(); ++bin) {
      if (share[bin] > kNegligible) {
        const std::int32_t centre = static_cast<std::int32_t>(bin) * step + step / 2;
        follow(measurement_2(acquisitions_), static_cast<std::uint32_t>(centre), centre - reach,
               centre + reach, share[bin]);
      }
    }
  }

  /// Moves a pointer from code `start` over codes above < x <= up_to; adds to the result.
  void follow(AcquisitionRange measurement, std::uint32_t start, std::int64_t above, std::int64_t up_to,
              double probability) {
    const auto fraction_bits = static_cast<unsigned>(parameters_.fraction_bits);
    const std::size_t size = positions_.size();
    std::vector<double> state(size, 0.0);
    state[static_cast<std::size_t>(start) << fraction_bits] = probability;
    std::vector<double> next(size);
    std::vector<std::pair<std::vector<double>, std::vector<double>>> moves;
    for (const auto& slot : slots_) {
      moves.push_back(move_probabilities(slot, above, up_to));
    }
    std::uint32_t acquisition = measurement.begin;
    for (unsigned gear = 0; gear <= fraction_bits; ++gear) {
      const std::uint32_t left = gear == fraction_bits ? 0 : measurement.size() >> (gear + 1);
      const std::size_t step = (static_cast<std::size_t>(parameters_.pointer_step) << fraction_bits) >> gear;
      for (; acquisition < measurement.end - left; ++acquisition) {
        for (const auto& [right, leftward] : moves) {
          advance(state, next, right, leftward, step);
        }
      }
    }
    for (std::size_t i = 0; i < size; ++i) {
      positions_[i] += state[i];
    }
  }

  static void advance(std::vector<double>& state, std::vector<double>& next, const std::vector<double>& right,
                      const std::vector<double>& left, std::size_t step) {
    const std::size_t size = state.size();
    if (step == 0) {
      return;  // POINTER_STEP below one unit of the last gear does not happen: step >= 1 bin >> gears
    }
    const auto one = [&](std::size_t i) {
      const std::size_t below = (i + size - step) % size;
      const std::size_t above = (i + step) % size;
      next[i] = state[i] * std::max(1.0 - right[i] - left[i], 0.0) + state[below] * right[below] +
                state[above] * left[above];
    };
    for (std::size_t i = 0; i < step; ++i) {
      one(i);
    }
    for (std::size_t i = step; i < size - step; ++i) {
      next[i] = state[i] * std::max(1.0 - right[i] - left[i], 0.0) + state[i - step] * right[i - step] +
                state[i + step] * left[i + step];
    }
    for (std::size_t i = size - step; i < size; ++i) {
      one(i);
    }
    state.swap(next);
  }

  /// Per word: probability of a move to the right and to the left by one slot of one acquisition.
  [[nodiscard]] std::pair<std::vector<double>, std::vector<double>> move_probabilities(
      const std::vector<double>& slot, std::int64_t above, std::int64_t up_to) const {
    const std::size_t size = positions_.size();
    const auto fraction_bits = static_cast<unsigned>(parameters_.fraction_bits);
    // Running sum over words of the timestamps' probability, twice around.
    std::vector<double> before(2 * size + 1, 0.0);
    for (std::size_t word = 0; word < 2 * size; ++word) {
      const std::size_t position = word % size;
      const auto code = static_cast<std::int64_t>(position >> fraction_bits);
      const bool timestamp = (position & ((std::size_t{1} << fraction_bits) - 1)) == 0;
      const bool inside = timestamp && code > above && code <= up_to;
      before[word + 1] = before[word] + (inside ? slot[static_cast<std::size_t>(code)] : 0.0);
    }
    std::pair<std::vector<double>, std::vector<double>> moves{std::vector<double>(size),
                                                              std::vector<double>(size)};
    for (std::size_t word = 0; word < size; ++word) {
      // Distances 1 .. size/2 are right.
      moves.first[word] = before[word + size / 2 + 1] - before[word + 1];
      moves.second[word] = before[word + size] - before[word + size / 2 + 1];
    }
    return moves;
  }

  ReadoutParameters parameters_;
  std::vector<std::vector<double>> slots_;
  std::vector<double> means_;
  std::uint32_t acquisitions_;
  unsigned limit_;
  std::vector<double> positions_;
};

}  // namespace

std::vector<double> peak_distribution(const std::vector<double>& means, unsigned limit, FullBin full) {
  const std::size_t bins = means.size();
  const bool freezes = full == FullBin::kFreezes;
  std::vector<double> result =
      freezes ? first_full_distribution(means, limit) : std::vector<double>(bins, 0.0);
  const unsigned most = freezes ? limit - 1 : limit;  // of a peak that is still to be found by its count
  // Counts outside mean -+ 9 standard deviations of the largest bin decide nothing.
  const double largest = *std::max_element(means.begin(), means.end());
  const double margin = poisson_margin(largest);
  const auto top = std::min<std::int64_t>(static_cast<std::int64_t>(std::min(largest + margin, 1e9)), most);
  const auto bottom = std::min(std::max<std::int64_t>(static_cast<std::int64_t>(largest - margin), 0), top);
  std::vector<PoissonTable> tables;
  tables.reserve(bins);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    tables.push_back(tabulate_poisson(means[bin], bottom, top));
  }
  std::vector<double> higher_bins(bins + 1);  // all bins from here on have at most `count`
  for (std::int64_t count = bottom; count <= top; ++count) {
    const auto i = static_cast<std::size_t>(count - bottom);
    const bool saturated = count == static_cast<std::int64_t>(limit);
    const auto at_most = [&](std::size_t bin) { return saturated ? 1.0 : tables[bin].at_most[i]; };
    const auto below = [&](std::size_t bin) {
      return std::max(tables[bin].at_most[i] - tables[bin].exactly[i], 0.0);
    };
    higher_bins[bins] = 1.0;
    for (std::size_t bin = bins; bin-- > 0;) {
      higher_bins[bin] = higher_bins[bin + 1] * at_most(bin);
    }
    double lower_bins = 1.0;  // all bins before have less than `count`
    for (std::size_t bin = 0; bin < bins && lower_bins > 0.0; ++bin) {
      const double exactly = saturated ? 1.0 - below(bin) : tables[bin].exactly[i];
      result[bin] += exactly * lower_bins * higher_bins[bin + 1];
      lower_bins *= below(bin);
    }
  }
  return result;
}

std::vector<double> code_distribution(const SensorModel& sensor, const PixelRates& rates,
                                      const ReadoutParameters& parameters) {
  sensor.validate();
  parameters.validate();
  if (parameters.np != sensor.np || parameters.slots != sensor.slots) {
    throw InputError(fmt::format("the sensor has NP = {} and SLOTS = {}, the read-out {} and {}", sensor.np,
                                 sensor.slots, parameters.np, parameters.slots));
  }
  return ReadoutDistribution(parameters, expected_slot_detections(sensor, rates), sensor.acquisitions).run();
}

PredictedErrors predict_errors(const std::vector<double>& distribution, const SensorModel& sensor,
                               const ReadoutParameters& parameters, double distance_m) {
  const DepthScale scale(sensor.integration_time_s, parameters.np, sensor.pulse_fwhm_s);
  const double total = sum_of(distribution);
  const auto error = [&](std::size_t i) {
    return scale.depth(std::ldexp(static_cast<double>(i), -parameters.fraction_bits)) - distance_m;
  };
  PredictedErrors errors{};
  double mean_size = 0.0;
  for (std::size_t i = 0; i < distribution.size(); ++i) {
    const double share = distribution[i] / total;
    const double relative = std::abs(error(i)) / distance_m;
    errors.bias_m += share * error(i);
    mean_size += share * relative;
    errors.share_above_3_percent += relative > 0.03 ? share : 0.0;
    errors.share_above_10_percent += relative > 0.10 ? share : 0.0;
  }
  double variance = 0.0;
  double size_variance = 0.0;
  for (std::size_t i = 0; i < distribution.size(); ++i) {
    const double share = distribution[i] / total;
    const double deviation = error(i) - errors.bias_m;
    const double size_deviation = std::abs(error(i)) / distance_m - mean_size;
    variance += share * deviation * deviation;
    size_variance += share * size_deviation * size_deviation;
  }
  errors.standard_deviation_m = std::sqrt(variance);
  errors.relative_precision = std::sqrt(size_variance);
  return errors;
}

}  // namespace dtof
