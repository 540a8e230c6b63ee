// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "dtof/core/detection.hpp"
#include "dtof/core/random.hpp"
#include "dtof/photon/event_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {

/// TDC stream of a modelled scene, exact event by event (spec section 4).
///
/// Each pixel and acquisition has Poisson numbers of signal events and of background events. Signal events
/// follow a Gaussian at 2R/c + FWHM, or a measured pulse with its centroid there; background is flat. Events
/// outside [0, T_int) are lost. Dead pixels have no events, hot pixels have more dark counts. Then, in this
/// order:
///  1. Time gate: only events inside count.
///  2. Dead time: an event within the dead time after the pixel's last counted event is lost; dead time ends
///     with the acquisition. Afterpulses: a counted event may draw another one after the dead time. It is
///     counted unless the acquisition or the gate is over or the pixel is dead again, and may draw the next.
///  3. Coincidence window: an event counts only if one of the four neighbouring pixels has an event at most W
///     away in the same acquisition.
///  4. Binning: the B x B pixels of a block (cut at the array's border) share one stream, the union of their
///     events.
///  5. TDC: the first SLOTS events in time order are kept, with code = floor(t / T_res) or by the pixel's own
///     code widths (TdcCodes).
/// An event in the last bin gets the no-detection code: it takes a slot, and read-outs drop it.
///
/// With a transient cube (TargetMap::cube), a signal event's time is its time in the cube, uniform within its
/// bin, plus the pulse's deviation and FWHM; the number of its events is the cube's own.
///
/// Surroundings (photon/surroundings.hpp) add events before step 1. Without surroundings the photons are the
/// same as if the program had no such model.
///
/// Random numbers depend on seed, frame and pixel alone. Copies are cheap. column_rows draws only the events
/// of the requested rows, except for coincidence (also their neighbours) and binning (the whole blocks).
class PhotonSource final : public StreamSource {
 public:
  /// Throws InputError for illegal physics: see SensorModel::validate and TargetMap::validate; `klux` must be
  /// finite and >= 0, and no rate may overflow.
  PhotonSource(SensorModel model, TargetMap targets, double klux, std::uint64_t seed,
               std::uint32_t frame = 0);

  /// Same scene and seed, another frame.
  [[nodiscard]] PhotonSource at_frame(std::uint32_t frame) const;

  [[nodiscard]] int columns() const override { return targets_->columns(); }
  [[nodiscard]] int rows() const override { return targets_->rows(); }
  [[nodiscard]] std::uint32_t acquisitions() const override { return model_.acquisitions; }
  [[nodiscard]] ColumnStream column(int index) const override { return column_rows(index, {0, rows()}); }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange range) const override;

  [[nodiscard]] const SensorModel& model() const { return model_; }
  [[nodiscard]] const TargetMap& targets() const { return *targets_; }
  [[nodiscard]] double klux() const { return klux_; }
  /// Mean events of a pixel before any loss: background and the target's return, after fog, pane and skew.
  /// Includes a hot pixel's dark counts; 0 for a dead pixel. Excludes other returns and changes during the
  /// frame.
  [[nodiscard]] PixelRates rates(int column, int row) const;
  /// All mean events of a pixel, returns of the surroundings included.
  [[nodiscard]] PixelReturns returns(int column, int row) const;
  /// Random generator of a pixel in this frame.
  [[nodiscard]] CounterRandom random(int column, int row,
                                     RandomPurpose purpose = RandomPurpose::kPhotons) const;
  /// Events of a pixel, drawn by `sampler`, which must have this source's model. Valid until the sampler's
  /// next call.
  std::span<const double> sample(EventSampler& sampler, int column, int row,
                                 RandomPurpose purpose = RandomPurpose::kPhotons) const;

  /// Index of a pixel, row by row.
  [[nodiscard]] std::size_t pixel_number(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns()) +
           static_cast<std::size_t>(column);
  }

 private:
  void validate_cube() const;
  void validate_surroundings() const;
  /// Mean events of pixel (column, row) if it sees the scene's pixel (seen_column, seen_row).
  [[nodiscard]] PixelRates rates_from(int column, int row, int seen_column, int seen_row) const;
  [[nodiscard]] PixelReturns returns_from(int column, int row, int seen_column, int seen_row) const;
  /// A pixel's light in a transient cube as arrival times in units of T_res, skew included.
  [[nodiscard]] TransientLight arriving_light(int column, int row, double skew_bins) const;
  [[nodiscard]] MovingReturns moving_returns(std::span<const SeenPixel> seen, int column, int row) const;
  [[nodiscard]] ColumnStream plain_column(int index, RowRange range) const;
  [[nodiscard]] ColumnStream combined_column(int index, RowRange range) const;

  SensorModel model_;
  std::shared_ptr<const TargetMap> targets_;
  double klux_;
  std::uint64_t seed_;
  std::uint32_t frame_;
  bool plain_ = true;  // no surroundings
};

/// Draws the streams of single pixels of a PhotonSource without binning and coincidence, and keeps its
/// buffers between them. The source must outlive this object. Not thread-safe.
class PixelStreams {
 public:
  explicit PixelStreams(const PhotonSource& source);
  PixelStreams(const PixelStreams&) = delete;
  PixelStreams& operator=(const PixelStreams&) = delete;
  PixelStreams(PixelStreams&&) = delete;
  PixelStreams& operator=(PixelStreams&&) = delete;
  ~PixelStreams();

  /// Appends the pixel's row to `stream`. `purpose` selects the random numbers.
  void append(int column, int row, ColumnStream& stream, RandomPurpose purpose = RandomPurpose::kPhotons);

 private:
  struct Buffers;

  const PhotonSource& source_;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace dtof
