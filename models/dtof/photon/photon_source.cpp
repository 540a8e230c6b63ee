// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/photon_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/random.hpp"
#include "dtof/photon/physics.hpp"

namespace dtof {

/// The TDC: appends a row that keeps the first SLOTS events of every acquisition.
class TdcRow {
 public:
  explicit TdcRow(const SensorModel& model)
      : np_(model.np),
        slots_(static_cast<std::size_t>(model.slots)),
        codes_(model.tdc_codes.get()),
        acquisitions_(slots_, kNone) {}

  /// `pixel`: row * columns + column.
  void append(std::span<const double> events, std::size_t pixel, ColumnStream& stream) {
    if (acquisitions_.size() < slots_ + events.size()) {
      acquisitions_.resize(slots_ + events.size());
    }
    const std::span<Detection> detections = stream.next_row(events.size());
    const auto shift = static_cast<unsigned>(np_);
    const std::uint64_t code_mask = (std::uint64_t{1} << shift) - 1;
    // The slots are full if the event SLOTS places earlier is of the same acquisition.
    std::uint32_t* const own = &acquisitions_[slots_];
    const std::uint32_t* const earlier = acquisitions_.data();
    Detection* kept = detections.data();
    for (std::size_t i = 0; i < events.size(); ++i) {
      const auto position = static_cast<std::uint64_t>(static_cast<std::int64_t>(events[i]));
      const auto acquisition = static_cast<std::uint32_t>(position >> shift);
      *kept = {acquisition, static_cast<Timestamp>(position & code_mask)};
      own[i] = acquisition;
      kept += static_cast<std::size_t>(earlier[i] != acquisition);
    }
    if (codes_ != nullptr) {
      kept = detections.data();
      for (std::size_t i = 0; i < events.size(); ++i) {
        if (earlier[i] != own[i]) {
          (kept++)->timestamp = unequal_code(events[i], own[i], pixel);
        }
      }
    }
    stream.finish_row(static_cast<std::size_t>(kept - detections.data()));
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  [[nodiscard]] Timestamp unequal_code(double position, std::uint64_t acquisition, std::size_t pixel) {
    const std::size_t table = pixel % codes_->tables();
    if (boundaries_.empty() || table != table_) {
      boundaries_ = codes_->boundaries(pixel, np_);
      table_ = table;
    }
    const double time = position - std::ldexp(static_cast<double>(acquisition), np_);
    const auto after = std::upper_bound(boundaries_.begin() + 1, boundaries_.end() - 1, time);
    return static_cast<Timestamp>(after - boundaries_.begin() - 1);
  }

  int np_;
  std::size_t slots_;
  const TdcCodes* codes_;
  std::vector<double> boundaries_;  // of the table `table_`
  std::size_t table_ = 0;
  std::vector<std::uint32_t> acquisitions_;  // of the row's events, SLOTS times kNone before
};

namespace {

using Events = std::vector<double>;

/// Marks the events that have one of `neighbour` in the same acquisition at most `window` away (bins).
void mark_coincident(std::span<const double> events, std::span<const double> neighbour, double window,
                     double code_count, std::vector<bool>& marks) {
  std::size_t candidate = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const double acquisition_begin = std::floor(events[i] / code_count) * code_count;
    const double earliest = std::max(events[i] - window, acquisition_begin);
    while (candidate < neighbour.size() && neighbour[candidate] < earliest) {
      ++candidate;
    }
    if (candidate < neighbour.size() && neighbour[candidate] <= events[i] + window &&
        neighbour[candidate] < acquisition_begin + code_count) {
      marks[i] = true;
    }
  }
}

}  // namespace

PhotonSource::PhotonSource(SensorModel model, TargetMap targets, double klux, std::uint64_t seed,
                           std::uint32_t frame)
    : model_(std::move(model)),
      targets_(std::make_shared<const TargetMap>(std::move(targets))),
      klux_(klux),
      seed_(seed),
      frame_(frame) {
  model_.validate();
  targets_->validate();
  plain_ = model_.surroundings.none();
  if (!std::isfinite(klux) || klux < 0.0) {
    throw InputError(fmt::format("illuminance must be a finite number of at least 0 klux, not {}", klux));
  }
  // Coincidence needs every event at once; the others stop at SLOTS events per acquisition.
  constexpr double kMaxEventsInMemory = 1e8;
  for (int column = 0; column < columns(); ++column) {
    for (int row = 0; row < rows(); ++row) {
      const PixelRates mean = rates(column, row);
      const double events = mean.signal + mean.background;
      if (!std::isfinite(events)) {
        throw InputError(fmt::format(
            "pixel (column {}, row {}): the mean number of events overflows (depth {} m, reflectivity {})",
            column, row, targets_->at(column, row).depth_m, targets_->at(column, row).reflectivity));
      }
      if (model_.coincidence_window_s && events * model_.acquisitions > kMaxEventsInMemory) {
        throw InputError(fmt::format(
            "pixel (column {}, row {}): {:.3g} mean events a frame are too many for a coincidence "
            "window (at most {:.0g})",
            column, row, events * model_.acquisitions, kMaxEventsInMemory));
      }
    }
  }
  if (targets_->cube()) {
    validate_cube();
  }
  if (!plain_) {
    validate_surroundings();
  }
}

/// A cube has its own fog and panes, and no distances that could change.
void PhotonSource::validate_cube() const {
  constexpr double kMostEventsInMemory = 1e8;
  const Surroundings& around = model_.surroundings;
  if (around.fog.extinction_per_m > 0.0 || around.pane.distance_m > 0.0 ||
      around.motion.velocity_m_per_s != 0.0) {
    throw InputError(
        "a sensor with fog, pane or radial motion cannot see a transient cube, whose light has all "
        "scatterers "
        "in it and no distances");
  }
  for (int column = 0; column < columns(); ++column) {
    for (int row = 0; row < rows(); ++row) {
      const PixelRates mean = rates(column, row);
      const double events = (mean.signal + mean.background) * model_.acquisitions;
      if (!(events <= kMostEventsInMemory)) {
        throw InputError(
            fmt::format("pixel (column {}, row {}): {:.3g} mean events a frame are too many for a transient "
                        "cube (at most "
                        "{:.0g}); its scale is in detected events of a pixel and pulse",
                        column, row, events, kMostEventsInMemory));
      }
    }
  }
}

/// All events of a frame with surroundings are drawn at once, and a target stays before the sensor.
void PhotonSource::validate_surroundings() const {
  constexpr double kMostEventsInMemory = 1e8;
  const Surroundings& around = model_.surroundings;
  const double travel =
      0.5 * std::abs(around.motion.velocity_m_per_s) * model_.pulse_period() * model_.acquisitions;
  for (int column = 0; column < columns(); ++column) {
    for (int row = 0; row < rows(); ++row) {
      const PixelTarget& target = targets_->at(column, row);
      if (target.returns_signal() && travel >= target.depth_m) {
        throw InputError(fmt::format(
            "pixel (column {}, row {}): a target at {:g} m that moves by {:g} m from the frame's middle "
            "to its ends runs into the sensor",
            column, row, target.depth_m, travel));
      }
      const PixelRates mean = rates(column, row);
      const double events =
          mean.signal + mean.background + around.cover_glass.events + around.other_laser.events +
          fog_events(around.fog, model_.signal_events_1m, std::numeric_limits<double>::infinity());
      if (!(events * model_.acquisitions <= kMostEventsInMemory)) {
        throw InputError(
            fmt::format("pixel (column {}, row {}): {:.3g} mean events a frame are too many for a sensor "
                        "with surroundings "
                        "(at most {:.0g})",
                        column, row, events * model_.acquisitions, kMostEventsInMemory));
      }
    }
  }
}

PhotonSource PhotonSource::at_frame(std::uint32_t frame) const {
  PhotonSource copy = *this;
  copy.frame_ = frame;
  return copy;
}

PixelRates PhotonSource::rates(int column, int row) const { return rates_from(column, row, column, row); }

PixelReturns PhotonSource::returns(int column, int row) const {
  return returns_from(column, row, column, row);
}

PixelRates PhotonSource::rates_from(int column, int row, int seen_column, int seen_row) const {
  const PixelTarget& target = targets_->at(seen_column, seen_row);
  PixelRates rates;
  const double sunlit = plain_ ? target.reflectivity
                               : target.reflectivity * model_.surroundings.sunlight_share(
                                                           target.depth_m, target.returns_signal());
  rates.background = model_.background_events(klux_, sunlit);
  if (!model_.defects.none()) {
    if (model_.defects.is_dead(column, row)) {
      return {};
    }
    if (model_.defects.is_hot(column, row)) {
      rates.background +=
          (model_.defects.hot_dark_count_rate_hz - model_.dark_count_rate_hz) * model_.integration_time_s;
    }
  }
  if (target.returns_signal()) {
    rates.signal = model_.signal_events(target.depth_m, target.reflectivity);
    rates.centre_bins = arrival_centre_s(target.depth_m, model_.pulse_fwhm_s) / model_.time_resolution_s();
  }
  if (!plain_) {
    const Surroundings& around = model_.surroundings;
    if (target.returns_signal()) {
      rates.signal *= around.two_way_transmittance(target.depth_m);
      rates.centre_bins += around.skew.of_pixel(column, row, columns()) / model_.time_resolution_s();
    }
  }
  if (targets_->cube()) {
    rates.signal = targets_->cube()->light(seen_column, seen_row).events();
  }
  return rates;
}

TransientLight PhotonSource::arriving_light(int column, int row, double skew_bins) const {
  TransientLight light = targets_->cube()->light(column, row);
  light.begin = (light.begin + model_.pulse_fwhm_s) / model_.time_resolution_s() + skew_bins;
  light.bin_width /= model_.time_resolution_s();
  return light;
}

PixelReturns PhotonSource::returns_from(int column, int row, int seen_column, int seen_row) const {
  PixelReturns returns;
  returns.rates = rates_from(column, row, seen_column, seen_row);
  returns.dead = !model_.defects.none() && model_.defects.is_dead(column, row);
  const PixelTarget& target = targets_->at(seen_column, seen_row);
  if (target.returns_signal()) {
    returns.distance_m = target.depth_m;
  }
  returns.skew_bins = model_.surroundings.skew.of_pixel(column, row, columns()) / model_.time_resolution_s();
  if (targets_->cube() && !returns.dead) {
    returns.light = arriving_light(seen_column, seen_row, returns.skew_bins);
  }
  return returns;
}

MovingReturns PhotonSource::moving_returns(std::span<const SeenPixel> seen, int column, int row) const {
  MovingReturns moving;
  moving.own = returns(column, row);
  moving.own.rates.background = model_.background_events(0.0, 0.0);
  if (!model_.defects.none() && model_.defects.is_hot(column, row)) {
    moving.own.rates.background +=
        (model_.defects.hot_dark_count_rate_hz - model_.dark_count_rate_hz) * model_.integration_time_s;
  }
  if (moving.own.dead) {
    moving.own.rates = {};
  }
  for (const SeenPixel& pixel : seen) {
    moving.seen.push_back(returns_from(column, row, std::clamp(column + pixel.columns, 0, columns() - 1),
                                       std::clamp(row + pixel.rows, 0, rows() - 1)));
    moving.seen.back().rates.background -= moving.own.rates.background;
  }
  return moving;
}

std::span<const double> PhotonSource::sample(EventSampler& sampler, int column, int row,
                                             RandomPurpose purpose) const {
  if (plain_ && targets_->cube()) {
    const PixelReturns lit = returns(column, row);
    return sampler.sample(lit.rates.background, lit.light, random(column, row, purpose));
  }
  if (plain_) {
    return sampler.sample(rates(column, row), random(column, row, purpose));
  }
  if (!model_.surroundings.lateral.none()) {
    return sampler.sample(moving_returns(sampler.seen(), column, row), random(column, row, purpose),
                          random(column, row, RandomPurpose::kFurtherReturns));
  }
  return sampler.sample(returns(column, row), random(column, row, purpose),
                        random(column, row, RandomPurpose::kFurtherReturns));
}

ColumnStream PhotonSource::column_rows(int index, RowRange range) const {
  return model_.binning == 1 && !model_.coincidence_window_s ? plain_column(index, range)
                                                             : combined_column(index, range);
}

ColumnStream PhotonSource::plain_column(int index, RowRange range) const {
  PixelStreams pixels(*this);
  ColumnStream stream;
  double expected = 0.0;
  const int end = range.first + range.count;
  for (int row = range.first; row < end; ++row) {
    const PixelRates mean = rates(index, row);
    expected += std::min(mean.background + mean.signal, static_cast<double>(model_.slots));
  }
  // A twentieth more than the mean is rarely exceeded, and costs a copy then.
  stream.reserve(static_cast<std::size_t>(1.05 * expected * model_.acquisitions));
  for (int row = range.first; row < end; ++row) {
    pixels.append(index, row, stream);
  }
  return stream;
}

struct PixelStreams::Buffers {
  EventSampler sampler;
  TdcRow tdc;
};

PixelStreams::PixelStreams(const PhotonSource& source)
    : source_(source),
      buffers_(std::make_unique<Buffers>(
          Buffers{EventSampler(source.model(), static_cast<std::size_t>(source.model().slots)),
                  TdcRow(source.model())})) {}

PixelStreams::~PixelStreams() = default;

void PixelStreams::append(int column, int row, ColumnStream& stream, RandomPurpose purpose) {
  buffers_->tdc.append(source_.sample(buffers_->sampler, column, row, purpose),
                       source_.pixel_number(column, row), stream);
}

ColumnStream PhotonSource::combined_column(int index, RowRange range) const {
  const bool coincidence = model_.coincidence_window_s.has_value();
  const double code_count = std::ldexp(1.0, model_.np);
  const int binning = model_.binning;
  const int block_begin = index / binning * binning;
  const int block_end = std::min(block_begin + binning, columns());
  const int range_end = range.first + range.count;
  const int blocks_begin = range.first / binning * binning;
  const int blocks_end = std::min((range_end - 1) / binning * binning + binning, rows());
  // Coincidence looks one pixel further on all sides, and needs the events that the TDC would not keep.
  const int border = coincidence ? 1 : 0;
  const int first = std::max(block_begin - border, 0);
  const int last = std::min(block_end + border, columns());
  const int first_row = std::max(blocks_begin - border, 0);
  const int last_row = std::min(blocks_end + border, rows());
  EventSampler sampler(model_, coincidence ? EventSampler::kAll : static_cast<std::size_t>(model_.slots));

  std::vector<std::vector<Events>> events(static_cast<std::size_t>(last - first));
  for (int column = first; column < last; ++column) {
    check_interruption();
    for (int row = first_row; row < last_row; ++row) {
      const auto drawn = sample(sampler, column, row);
      events[static_cast<std::size_t>(column - first)].emplace_back(drawn.begin(), drawn.end());
    }
  }
  const auto pixel = [&](int column, int row) -> const Events& {
    return events[static_cast<std::size_t>(column - first)][static_cast<std::size_t>(row - first_row)];
  };

  const auto coincident_events = [&](int column, int row) {
    const Events& own = pixel(column, row);
    const double window = *model_.coincidence_window_s / model_.time_resolution_s();
    std::vector<bool> marks(own.size(), false);
    constexpr std::array<std::pair<int, int>, 4> kNeighbours = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
    for (const auto& [right, down] : kNeighbours) {
      const int x = column + right;
      const int y = row + down;
      if (x >= 0 && x < columns() && y >= 0 && y < rows()) {
        mark_coincident(own, pixel(x, y), window, code_count, marks);
      }
    }
    Events kept;
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (marks[i]) {
        kept.push_back(own[i]);
      }
    }
    return kept;
  };

  TdcRow tdc(model_);
  ColumnStream stream;
  for (int row_begin = blocks_begin; row_begin < blocks_end; row_begin += binning) {
    const int row_end = std::min(row_begin + binning, blocks_end);
    Events block;
    for (int column = block_begin; column < block_end; ++column) {
      for (int row = row_begin; row < row_end; ++row) {
        const Events filtered = coincidence ? coincident_events(column, row) : Events();
        const Events& own = coincidence ? filtered : pixel(column, row);
        block.insert(block.end(), own.begin(), own.end());
      }
    }
    std::ranges::sort(block);
    for (int row = std::max(row_begin, range.first); row < std::min(row_end, range_end); ++row) {
      tdc.append(block, pixel_number(index, row), stream);
    }
  }
  return stream;
}

CounterRandom PhotonSource::random(int column, int row, RandomPurpose purpose) const {
  return {seed_, static_cast<std::uint32_t>(purpose), frame_,
          static_cast<std::uint32_t>(pixel_number(column, row))};
}

}  // namespace dtof
