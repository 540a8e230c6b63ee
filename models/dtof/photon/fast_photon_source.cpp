// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/fast_photon_source.hpp"

#include <algorithm>
#include <array>
#include <boost/random/binomial_distribution.hpp>
#include <boost/random/exponential_distribution.hpp>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "dtof/photon/arrival_table.hpp"
#include "dtof/photon/ziggurat.hpp"

namespace dtof {
namespace {

// With more mean events per acquisition, pairs of one acquisition are so common that pointers notice if they
// are drawn apart (bias, outliers); then the sampler walks as the streams do.
constexpr double kWalkFrom = 0.7;
// Up to so many mean events per acquisition few are beyond the slots, and drawing all of them exactly takes
// less time than walking from table to table (measured).
constexpr double kExactUpTo = 2.0;

double draw_exponential(SplitMix64& random) {
  return boost::random::exponential_distribution<double>(1.0)(random);
}

std::uint32_t draw_binomial(std::uint32_t trials, double p, SplitMix64& random) {
  return static_cast<std::uint32_t>(
      boost::random::binomial_distribution<std::int64_t, double>(trials, std::min(p, 1.0))(random));
}

template <typename T>
void make_room(std::vector<T>& values, std::size_t count) {
  if (count >= values.size()) {
    values.resize(std::max<std::size_t>(4096, 2 * count));
  }
}

/// Walks the kept events of some acquisitions in time order.
class Walk {
 public:
  static constexpr std::size_t kMost = 64;

  struct Events {
    std::span<const std::uint32_t> acquisitions;
    std::span<const double> cumulative;  // mean events of the acquisition before each
  };

  /// `events`: mean events of an acquisition.
  Walk(double events, std::uint32_t acquisitions, int slots)
      : events_(events), end_(events * acquisitions), slots_(slots), last_(std::int64_t{acquisitions} - 1) {}

  /// The next events; none: that was all. Valid until the next call.
  Events next(SplitMix64& random) {
    if (over_) {
      return {};
    }
    // Without a call in a loop, what is summed up stays in registers: a batch begins with a draw of Boost's,
    // and ends before the next draw that needs Boost. Gaps come first, apart from the branches of the walk.
    const Ziggurat& exponential = Ziggurat::exponential();
    gaps_[0] = draw_exponential(random);
    SplitMix64 words = random;
    std::size_t drawn = 1;
    for (; drawn < kMost; ++drawn) {
      const Ziggurat::Draw gap = exponential.draw(words());
      if (!gap.decided) {
        break;
      }
      gaps_[drawn] = gap.value;
    }
    const double acquisitions_per_event = 1.0 / events_;
    const double events = events_;
    const double end = end_;
    const int slots = slots_;
    double walked = walked_;
    std::int64_t before = before_;
    int kept = kept_;
    std::size_t count = 0;
    for (; count < drawn; ++count) {
      walked += gaps_[count];
      if (walked >= end) {
        over_ = true;
        break;
      }
      const std::int64_t acquisition =
          std::min(static_cast<std::int64_t>(walked * acquisitions_per_event), last_);
      const double begin = static_cast<double>(acquisition) * events;
      const double since = walked - begin;
      kept = acquisition == before ? kept + 1 : 1;
      before = acquisition;
      acquisitions_[count] = static_cast<std::uint32_t>(acquisition);
      cumulative_[count] = since < 0.0 ? 0.0 : since > events ? events : since;
      // The process has no memory: what the TDC would not keep is passed over.
      if (kept == slots) {
        walked = begin + events;
      }
    }
    walked_ = walked;
    before_ = before;
    kept_ = kept;
    const std::size_t taken = over_ ? count : drawn - 1;
    for (std::size_t i = 0; i < taken; ++i) {
      random();
    }
    return {std::span(acquisitions_).first(count), std::span(cumulative_).first(count)};
  }

 private:
  // Mean events on the axis of all acquisitions one after the other.
  double events_;
  double end_;
  double walked_ = 0.0;
  int slots_;
  int kept_ = 0;
  std::int64_t last_;
  std::int64_t before_ = -1;
  bool over_ = false;
  std::array<double, kMost> gaps_{};
  std::array<std::uint32_t, kMost> acquisitions_{};
  std::array<double, kMost> cumulative_{};
};

/// `keep(acquisition, code)` for every kept event, in time order.
template <typename Keep>
void walk(const ArrivalTable& table, std::uint32_t acquisitions, int slots, SplitMix64& random,
          const Keep& keep) {
  Walk events(table.total(), acquisitions, slots);
  std::array<Timestamp, Walk::kMost> codes{};
  for (auto batch = events.next(random); !batch.acquisitions.empty(); batch = events.next(random)) {
    table.inverse_codes(batch.cumulative, codes);
    for (std::size_t i = 0; i < batch.acquisitions.size(); ++i) {
      keep(batch.acquisitions[i], codes[i]);
    }
  }
}

SplitMix64 pixel_random(const PhotonSource& exact, int column, int row) {
  return SplitMix64(exact.random(column, row, RandomPurpose::kFastPhotons));
}

class FastPixelSampler final : public PixelSampler {
 public:
  explicit FastPixelSampler(const PhotonSource& exact)
      : exact_(exact),
        events_(exact.model()),
        kept_(exact.model()),
        random_(pixel_random(exact, 0, 0)),
        codes_(1) {}

  void start_pixel(int column, int row) override {
    const PixelRates rates = exact_.rates(column, row);
    const int slots = exact_.model().slots;
    random_ = pixel_random(exact_, column, row);
    walk_ = rates.background + rates.signal > kWalkFrom;
    if (walk_) {
      events_.build(rates);
      return;
    }
    kept_.build_kept(rates, slots);
    last_ = -1;
    slot_probability_.clear();
    double at_least_before = 1.0;
    for (int k = 1; k <= slots; ++k) {
      const double probability = at_least(k, kept_.events());
      slot_probability_.push_back(at_least_before > 0.0 ? probability / at_least_before : 0.0);
      at_least_before = probability;
    }
  }

  std::span<const Timestamp> draw(std::uint32_t acquisitions, std::int32_t first,
                                  std::int32_t last) override {
    first = std::max(first, 0);
    last = std::min(last, 1 << exact_.model().np);
    if (first >= last || acquisitions == 0) {
      return {};
    }
    return walk_ ? draw_walking(acquisitions, first, last) : draw_from_counts(acquisitions, first, last);
  }

 private:
  std::span<const Timestamp> draw_walking(std::uint32_t acquisitions, std::int32_t first, std::int32_t last) {
    std::size_t count = 0;
    walk(events_, acquisitions, exact_.model().slots, random_, [&](std::uint32_t, Timestamp code) {
      make_room(codes_, count);
      codes_[count] = code;
      count += code >= first && code < last ? 1 : 0;
    });
    return std::span<const Timestamp>(codes_).first(count);
  }

  std::span<const Timestamp> draw_from_counts(std::uint32_t acquisitions, std::int32_t first,
                                              std::int32_t last) {
    const double total = kept_.total();
    if (total == 0.0) {
      return {};
    }
    std::uint32_t count = 0;
    std::uint32_t filled = acquisitions;
    for (const double probability : slot_probability_) {
      filled = draw_binomial(filled, probability, random_);
      count += filled;
      if (filled == 0) {
        break;
      }
    }
    if (first != first_ || last != last_) {
      begin_ = kept_.cumulative(first);
      end_ = kept_.cumulative(last);
      first_ = first;
      last_ = last;
    }
    const double begin = begin_;
    const double end = end_;
    if (begin > 0.0 || end < total) {
      count = draw_binomial(count, (end - begin) / total, random_);
    }
    make_room(codes_, count);
    const double step = (end - begin) * 0x1.0p-32;
    cumulative_.resize(std::size_t{count} + 1);
    for (std::uint32_t i = 0; i < count; i += 2) {
      const std::uint64_t word = random_();
      cumulative_[i] = begin + step * static_cast<double>(word >> 32U);
      cumulative_[i + 1] = begin + step * static_cast<double>(word & 0xFFFFFFFFU);
    }
    const auto codes = std::span<Timestamp>(codes_).first(count);
    kept_.inverse_codes(std::span<const double>(cumulative_).first(count), codes);
    if (begin == 0.0 && end == total) {
      return codes;
    }
    // At the window's ends the table's inverse does not meet the table exactly.
    const auto width = static_cast<std::uint32_t>(last - first);
    std::size_t inside = 0;
    for (const Timestamp code : codes) {
      codes_[inside] = code;
      inside += static_cast<std::size_t>(static_cast<std::uint32_t>(code - first) < width);
    }
    return codes.first(inside);
  }

  PhotonSource exact_;
  ArrivalTable events_;
  ArrivalTable kept_;
  SplitMix64 random_;
  bool walk_ = false;
  std::vector<double> slot_probability_;
  // A pointer asks for the same window in each of its steps: `kept_` before its ends; last_ < 0: none yet.
  std::int32_t first_ = 0;
  std::int32_t last_ = -1;
  double begin_ = 0.0;
  double end_ = 0.0;
  std::vector<double> cumulative_;
  std::vector<Timestamp> codes_;
};

}  // namespace

FastPhotonSource::FastPhotonSource(PhotonSource exact) : exact_(std::move(exact)) {
  if (!supports(exact_)) {
    throw InputError(
        "the fast photon model has no dead time, afterpulsing, binning, coincidence, measured pulse, TDC "
        "code "
        "widths, surroundings or transient cube: use the exact one");
  }
}

bool FastPhotonSource::supports(const SensorModel& model) {
  return model.dead_time_s == 0.0 && model.afterpulse_probability == 0.0 && model.binning == 1 &&
         !model.coincidence_window_s && !model.pulse_response && !model.tdc_codes &&
         model.surroundings.none();
}

bool FastPhotonSource::supports(const PhotonSource& exact) {
  return supports(exact.model()) && !exact.targets().cube();
}

ColumnStream FastPhotonSource::column_rows(int index, RowRange range) const {
  ArrivalTable table(exact_.model());
  PixelStreams pixels(exact_);
  ColumnStream stream;
  std::vector<Detection> detections;
  for (int row = range.first; row < range.first + range.count; ++row) {
    const PixelRates rates = exact_.rates(index, row);
    if (rates.background + rates.signal <= kExactUpTo) {
      pixels.append(index, row, stream, RandomPurpose::kFastPhotons);
      continue;
    }
    table.build(rates);
    std::size_t count = 0;
    if (table.total() > 0.0) {
      SplitMix64 random = pixel_random(exact_, index, row);
      walk(table, acquisitions(), exact_.model().slots, random,
           [&](std::uint32_t acquisition, Timestamp code) {
             make_room(detections, count);
             detections[count++] = {acquisition, code};
           });
    }
    stream.append_row(std::span<const Detection>(detections).first(count));
  }
  return stream;
}

std::unique_ptr<PixelSampler> FastPhotonSource::pixel_sampler() const {
  return std::make_unique<FastPixelSampler>(exact_);
}

}  // namespace dtof
