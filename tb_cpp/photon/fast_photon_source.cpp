// SPDX-License-Identifier: Apache-2.0
#include "photon/fast_photon_source.hpp"

#include <algorithm>
#include <boost/random/binomial_distribution.hpp>
#include <boost/random/exponential_distribution.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/random.hpp"
#include "photon/arrival_table.hpp"

namespace dtof {
namespace {

// With more mean events per acquisition, pairs of one acquisition are so common that pointers notice if they
// are drawn apart (bias, outliers); then the sampler walks as the streams do.
constexpr double kWalkFrom = 0.7;

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

/// Walks the kept events of `acquisitions` acquisitions in time order: `keep(acquisition, time)`.
template <typename Keep>
void walk(const ArrivalTable& table, std::uint32_t acquisitions, int slots, SplitMix64& random,
          const Keep& keep) {
  // `walked` is measured in mean events on the axis of all acquisitions one after the other.
  const double events = table.total();
  const double end = events * acquisitions;
  const double acquisitions_per_event = 1.0 / events;
  const auto last = static_cast<std::int64_t>(acquisitions) - 1;
  double walked = 0.0;
  std::int64_t before = -1;
  int kept = 0;
  while ((walked += draw_exponential(random)) < end) {
    const std::int64_t acquisition =
        std::min(static_cast<std::int64_t>(walked * acquisitions_per_event), last);
    const double begin = static_cast<double>(acquisition) * events;
    kept = acquisition == before ? kept + 1 : 1;
    before = acquisition;
    keep(static_cast<std::uint32_t>(acquisition), table.inverse(std::clamp(walked - begin, 0.0, events)));
    // The process has no memory: what the TDC would not keep is passed over.
    if (kept == slots) {
      walked = begin + events;
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
    walk(events_, acquisitions, exact_.model().slots, random_, [&](std::uint32_t, double time) {
      make_room(codes_, count);
      const auto code = static_cast<std::int32_t>(time);
      codes_[count] = static_cast<Timestamp>(code);
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
    const double begin = kept_.cumulative(first);
    const double end = kept_.cumulative(last);
    if (begin > 0.0 || end < total) {
      count = draw_binomial(count, (end - begin) / total, random_);
    }
    make_room(codes_, count);
    const double step = (end - begin) * 0x1.0p-32;
    for (std::uint32_t i = 0; i < count; i += 2) {
      const std::uint64_t word = random_();
      codes_[i] = code(begin + step * static_cast<double>(word >> 32U));
      codes_[i + 1] = code(begin + step * static_cast<double>(word & 0xFFFFFFFFU));
    }
    return std::span<const Timestamp>(codes_).first(count);
  }

  [[nodiscard]] Timestamp code(double cumulative) const {
    return static_cast<Timestamp>(static_cast<std::int32_t>(kept_.inverse(cumulative)));
  }

  PhotonSource exact_;
  ArrivalTable events_;
  ArrivalTable kept_;
  SplitMix64 random_;
  bool walk_ = false;
  std::vector<double> slot_probability_;
  std::vector<Timestamp> codes_;
};

}  // namespace

FastPhotonSource::FastPhotonSource(PhotonSource exact) : exact_(std::move(exact)) {
  if (!supports(exact_.model())) {
    throw InputError(
        "the fast photon model has no dead time, afterpulsing, binning, coincidence, measured pulse or TDC "
        "code "
        "widths: use the exact one");
  }
}

bool FastPhotonSource::supports(const SensorModel& model) {
  return model.dead_time_s == 0.0 && model.afterpulse_probability == 0.0 && model.binning == 1 &&
         !model.coincidence_window_s && !model.pulse_response && !model.tdc_codes;
}

ColumnStream FastPhotonSource::column_rows(int index, RowRange range) const {
  ArrivalTable table(exact_.model());
  ColumnStream stream;
  std::vector<Detection> detections;
  for (int row = range.first; row < range.first + range.count; ++row) {
    table.build(exact_.rates(index, row));
    std::size_t count = 0;
    if (table.total() > 0.0) {
      SplitMix64 random = pixel_random(exact_, index, row);
      walk(table, acquisitions(), exact_.model().slots, random, [&](std::uint32_t acquisition, double time) {
        make_room(detections, count);
        detections[count++] = {acquisition, static_cast<Timestamp>(static_cast<std::int32_t>(time))};
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
