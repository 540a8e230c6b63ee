// SPDX-License-Identifier: Apache-2.0
#include "tests/readout/reference_model.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <functional>
#include <map>
#include <string>

namespace dtof {
namespace {

using Keep = std::function<bool(std::int64_t)>;
using Bin = std::function<std::int64_t(std::int64_t)>;

std::int64_t power2(std::int64_t exponent) { return std::int64_t{1} << exponent; }

std::int64_t modulo(std::int64_t value, std::int64_t modulus) {
  return ((value % modulus) + modulus) % modulus;
}

struct Scan {
  std::int64_t peak = 0;
  std::int64_t peak_count = 0;
  std::int64_t confidence = 0;
};

class Frame {
 public:
  Frame(const ReadoutParameters& parameters, const std::vector<Detection>& detections,
        std::int64_t acquisitions)
      : p_(parameters), acquisitions_(acquisitions) {
    for (const Detection& detection : detections) {
      const bool gated = p_.time_gate && (detection.timestamp < p_.time_gate->begin ||
                                          detection.timestamp >= p_.time_gate->end);
      if (!gated && detection.timestamp != p_.no_detection()) {
        detections_.push_back(detection);
      }
    }
  }

  PixelResult result() const {
    switch (p_.readout) {
      case Readout::kEzPointer:
        return pointer(power2(p_.np + p_.fraction_bits - 1), 0, [](std::int64_t) { return true; });
      case Readout::kHisPointer1:
        return his_pointer(false);
      case Readout::kHisPointer:
        return his_pointer(true);
      case Readout::kSifh:
        return sifh();
      case Readout::kFifh:
        return fifh();
      case Readout::kThreeSteps:
        return three_steps();
      case Readout::kPifh:
        return partitioned(p_.nb);
      case Readout::kHistogram:
        return partitioned(p_.np);
      case Readout::kCoarseHistogram:
        return coarse_histogram();
      default:
        break;  // tests of their own
    }
    return {};
  }

  /// The histogram that the last scan of result() has seen.
  std::vector<PixelResult> histogram() const {
    (void)result();
    std::vector<PixelResult> bins;
    for (std::int64_t bin = 0; bin < last_.bins; ++bin) {
      const auto found = last_.counts.find(bin);
      bins.push_back({static_cast<std::uint16_t>(
                          std::clamp<std::int64_t>(last_.first + bin * last_.width, 0, power2(p_.np) - 1)),
                      0, static_cast<std::uint16_t>(found == last_.counts.end() ? 0 : found->second)});
    }
    return bins;
  }

 private:
  struct Histogram {
    std::map<std::int64_t, std::int64_t> counts;
    std::int64_t bins = 0;
    std::int64_t first = 0;  // code of bin 0
    std::int64_t width = 1;  // codes of a bin
  };

  bool freezes() const {
    const bool one_of_runs = p_.readout == Readout::kPifh && p_.nb < p_.np;
    return p_.readout != Readout::kHisPointer1 && !one_of_runs;
  }

  std::int64_t half() const { return acquisitions_ / 2; }

  std::vector<std::int64_t> timestamps(std::int64_t begin, std::int64_t end, const Keep& keep) const {
    std::vector<std::int64_t> kept;
    for (const Detection& detection : detections_) {
      const bool in_pass = detection.acquisition >= begin && detection.acquisition < end;
      if (in_pass && keep(detection.timestamp)) {
        kept.push_back(detection.timestamp);
      }
    }
    return kept;
  }

  Scan scan(std::int64_t begin, std::int64_t end, const Keep& keep, const Bin& bin, std::int64_t bins) const {
    std::map<std::int64_t, std::int64_t> counts;
    for (const std::int64_t timestamp : timestamps(begin, end, keep)) {
      if (++counts[bin(timestamp)] == power2(p_.count_width) - 1 && freezes()) {
        break;  // this bin is full: the histogram has seen enough
      }
    }
    Scan found;
    std::int64_t sum = 0;
    for (auto& [index, count] : counts) {  // ascending index: the lowest wins a tie
      count = std::min(count, power2(p_.count_width) - 1);
      sum += count;
      if (count > found.peak_count) {
        found.peak = index;
        found.peak_count = count;
      }
    }
    found.confidence = std::max<std::int64_t>(0, found.peak_count - (sum - found.peak_count) / bins);
    last_ = {counts, bins, 0, 1};
    return found;
  }

  std::int64_t coarse_peak() const {
    const std::int64_t width = power2(p_.np - p_.nb);
    const std::int64_t peak = scan(
                                  0, half(), [](std::int64_t) { return true; },
                                  [=](std::int64_t x) { return x / width; }, power2(p_.nb))
                                  .peak;
    last_.width = width;
    return peak;
  }

  PixelResult clamped(std::int64_t code, std::int64_t confidence) const {
    code = std::clamp<std::int64_t>(code, 0, power2(p_.np) - 2);
    return {static_cast<std::uint16_t>(code), 0, static_cast<std::uint16_t>(confidence)};
  }

  PixelResult sifh() const {
    std::int64_t low = coarse_peak() * power2(p_.np - p_.nb) - power2(p_.nb - 1);
    if (p_.window_centred && p_.np > p_.nb) {
      low += power2(p_.np - p_.nb - 1) - 1;
    }
    const std::int64_t high = low + power2(p_.nb);
    const Scan fine = scan(
        half(), acquisitions_, [=](std::int64_t x) { return low < x && x <= high; },
        [=](std::int64_t x) { return x - low - 1; }, power2(p_.nb));
    last_.first = low + 1;
    return clamped(fine.peak + low + 1, fine.confidence);
  }

  PixelResult fifh() const {
    const std::int64_t width = power2(p_.np - p_.nb);
    const std::int64_t coarse = coarse_peak();
    const Scan fine = scan(
        half(), acquisitions_, [=](std::int64_t x) { return x / width == coarse; },
        [=](std::int64_t x) { return x % width; }, width);
    last_.first = coarse * width;
    return {static_cast<std::uint16_t>(coarse * width + fine.peak), 0,
            static_cast<std::uint16_t>(fine.confidence)};
  }

  PixelResult three_steps() const {
    std::int64_t prefix = 0;
    std::int64_t section = power2(p_.np);  // codes that share the prefix
    for (int k = 0; k < 3; ++k) {
      const std::int64_t smaller = std::max<std::int64_t>(section / 8, 1);
      const Scan step = scan(
          half() * k / 3, half() * (k + 1) / 3, [=](std::int64_t x) { return x / section == prefix; },
          [=](std::int64_t x) { return x / smaller - prefix * (section / smaller); }, 8);
      prefix = prefix * (section / smaller) + step.peak;
      section = smaller;
    }
    const std::int64_t start = prefix * section + section / 2 - 8;
    const Scan fine = scan(
        half(), acquisitions_, [=](std::int64_t x) { return start <= x && x < start + 16; },
        [=](std::int64_t x) { return x - start; }, 16);
    last_.first = start;
    return clamped(start + fine.peak, fine.confidence);
  }

  PixelResult partitioned(int bin_bits) const {
    const std::int64_t width = power2(bin_bits);
    const std::int64_t runs = power2(p_.np - bin_bits);
    PixelResult best;
    std::int64_t best_count = 0;
    for (std::int64_t run = 0; run < runs; ++run) {
      const Scan found = scan(
          acquisitions_ * run / runs, acquisitions_ * (run + 1) / runs,
          [=](std::int64_t x) { return x / width == run; }, [=](std::int64_t x) { return x % width; }, width);
      if (found.peak_count > best_count) {
        best_count = found.peak_count;
        best = {static_cast<std::uint16_t>(run * width + found.peak), 0,
                static_cast<std::uint16_t>(found.confidence)};
      }
    }
    return best;
  }

  // In fractions of numbers, from a list of all bins with an empty one at either end.
  PixelResult coarse_histogram() const {
    const std::int64_t bins = power2(p_.nb);
    const std::int64_t width = power2(p_.np - p_.nb);
    (void)scan(
        0, acquisitions_, [](std::int64_t) { return true; }, [=](std::int64_t x) { return x / width; }, bins);
    last_.width = width;
    std::vector<std::int64_t> counts(static_cast<std::size_t>(bins) + 2, 0);
    std::int64_t sum = 0;
    for (const auto& [bin, count] : last_.counts) {
      counts[static_cast<std::size_t>(bin) + 1] = count;
      sum += count;
    }
    std::vector<std::int64_t> pairs;  // pair k: bins k - 1 and k
    for (std::size_t k = 0; k + 1 < counts.size(); ++k) {
      pairs.push_back(counts[k] + counts[k + 1]);
    }
    const auto highest = std::max_element(pairs.begin() + 1, pairs.end() - 1);  // the first of a tie
    const std::int64_t height = std::max<std::int64_t>(0, *highest - (sum - *highest) / (bins / 2));
    const std::int64_t lean = *(highest + 1) - *(highest - 1);

    const std::int64_t parts = width * power2(p_.fraction_bits);  // of a bin
    std::int64_t offset = 0;
    while (height > 0 && 3 * height * (offset + 1) <= 2 * parts * std::min(std::abs(lean), height)) {
      ++offset;
    }
    const std::int64_t edge = (highest - pairs.begin()) * parts;
    const std::int64_t position = lean >= 0 ? edge + offset : edge - 1 - offset;
    return {static_cast<std::uint16_t>(position / power2(p_.fraction_bits)),
            static_cast<std::uint16_t>(position % power2(p_.fraction_bits)),
            static_cast<std::uint16_t>(std::min(height, power2(p_.count_width) - 1))};
  }

  PixelResult his_pointer(bool filter) const {
    const std::int64_t width = power2(p_.np - p_.nb);
    const std::int64_t centre = coarse_peak() * width + width / 2;
    const std::int64_t reach = power2(p_.nb - 1) + p_.guard;
    return pointer(centre * power2(p_.fraction_bits), half(),
                   [=](std::int64_t x) { return !filter || (centre - reach < x && x <= centre + reach); });
  }

  PixelResult pointer(std::int64_t word, std::int64_t begin, const Keep& keep) const {
    const int bits = p_.np + p_.fraction_bits;
    const std::int64_t range = power2(bits);
    const std::int64_t length = acquisitions_ - begin;
    std::int64_t confidence = 0;
    for (const Detection& detection : detections_) {
      const std::int64_t index = detection.acquisition - begin;
      if (index < 0 || !keep(detection.timestamp)) {
        continue;
      }
      int gear = 0;
      for (int g = 0; g <= p_.fraction_bits; ++g) {
        if (index >= length - length / power2(g)) {
          gear = g;
        }
      }
      const std::int64_t step = p_.pointer_step * power2(p_.fraction_bits) / power2(gear);
      const std::int64_t d = modulo(detection.timestamp * power2(p_.fraction_bits) - word, range);

      const std::string text = std::bitset<16>(static_cast<std::uint64_t>(d))
                                   .to_string()
                                   .substr(static_cast<std::size_t>(16 - bits));
      const std::string top = text.substr(0, static_cast<std::size_t>(std::min(5, bits)));
      const bool near = top.find('1') == std::string::npos || top.find('0') == std::string::npos;
      if (near) {
        confidence = std::min(confidence + 1, power2(p_.confidence_width) - 1);
      } else if (detection.timestamp % 8 == 0) {
        confidence = std::max<std::int64_t>(confidence - 1, 0);
      }

      if (d >= 1 && d <= range / 2) {
        word = modulo(word + step, range);
      } else if (d > range / 2) {
        word = modulo(word - step, range);
      }
    }
    return {static_cast<std::uint16_t>(word / power2(p_.fraction_bits)),
            static_cast<std::uint16_t>(word % power2(p_.fraction_bits)),
            static_cast<std::uint16_t>(confidence)};
  }

  ReadoutParameters p_;
  std::int64_t acquisitions_;
  std::vector<Detection> detections_;
  mutable Histogram last_;
};

}  // namespace

bool has_reference(Readout readout) {
  using enum Readout;
  constexpr std::array kKnown = {kEzPointer,  kHisPointer1, kHisPointer, kSifh,           kFifh,
                                 kThreeSteps, kPifh,        kHistogram,  kCoarseHistogram};
  return std::ranges::find(kKnown, readout) != kKnown.end();
}

PixelResult reference_result(const ReadoutParameters& parameters, const std::vector<Detection>& detections,
                             std::int64_t acquisitions) {
  return Frame(parameters, detections, acquisitions).result();
}

std::vector<PixelResult> reference_histogram(const ReadoutParameters& parameters,
                                             const std::vector<Detection>& detections,
                                             std::int64_t acquisitions) {
  return Frame(parameters, detections, acquisitions).histogram();
}

}  // namespace dtof
