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
/// Per acquisition and pixel: Poisson numbers of signal events (Gaussian, or a measured pulse with its
/// centroid, at 2R/c + FWHM) and background events (flat); events outside [0, T_int) are lost. Dead pixels
/// have none; hot ones have more dark counts. Then, in this order:
///  1. time gate: only events inside count;
///  2. dead time: an event within it after the pixel's last counted event is lost; it ends with the
///     acquisition; afterpulses: a counted event draws another one behind the dead time, which is counted
///     unless the acquisition or the gate is over or a dead time is under way, and may draw the next;
///  3. coincidence window: an event counts only if one of the four neighbouring pixels has an event of the
///     same acquisition at most W away;
///  4. binning: the B x B pixels of a block (cut at the array's border) share one stream, the union of
///  theirs;
///  5. the TDC keeps the first SLOTS events in time order, code = floor(t / T_res), or by its own code widths
///  (TdcCodes; those of a block's pixels stay their own).
/// An event in the last bin gets the no-detection code: it takes its slot, and read-outs drop it.
///
/// What surrounds the sensor (photon/surroundings.hpp) adds to the events before 1.; a plain sensor's photons
/// are the same with the program that knows it and without.
///
/// Random numbers depend on seed, frame and pixel alone. Copies are cheap. Some rows of a column
/// (column_rows) draw no other pixel's events, but for coincidence and binning, which need those of
/// neighbours and of the block.
class PhotonSource final : public StreamSource {
 public:
  /// Throws InputError for illegal physics (SensorModel::validate, TargetMap::validate; `klux` finite and
  /// >= 0; rates that overflow).
  PhotonSource(SensorModel model, TargetMap targets, double klux, std::uint64_t seed,
               std::uint32_t frame = 0);

  /// The same scene and seed at another frame.
  [[nodiscard]] PhotonSource at_frame(std::uint32_t frame) const;

  [[nodiscard]] int columns() const override { return targets_->columns(); }
  [[nodiscard]] int rows() const override { return targets_->rows(); }
  [[nodiscard]] std::uint32_t acquisitions() const override { return model_.acquisitions; }
  [[nodiscard]] ColumnStream column(int index) const override { return column_rows(index, {0, rows()}); }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange range) const override;

  [[nodiscard]] const SensorModel& model() const { return model_; }
  [[nodiscard]] const TargetMap& targets() const { return *targets_; }
  [[nodiscard]] double klux() const { return klux_; }
  /// Mean events of a pixel before any loss, of a hot or dead pixel its own: background and the target's
  /// return, as fog, a pane and skew leave them. Other returns and what changes in the frame are not in it.
  [[nodiscard]] PixelRates rates(int column, int row) const;
  /// All that a pixel receives.
  [[nodiscard]] PixelReturns returns(int column, int row) const;
  /// Random numbers of a pixel in this frame.
  [[nodiscard]] CounterRandom random(int column, int row,
                                     RandomPurpose purpose = RandomPurpose::kPhotons) const;
  /// What `sampler`, of this source's model, draws of a pixel. Valid until its next call.
  std::span<const double> sample(EventSampler& sampler, int column, int row,
                                 RandomPurpose purpose = RandomPurpose::kPhotons) const;

  /// Row by row.
  [[nodiscard]] std::size_t pixel_number(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns()) +
           static_cast<std::size_t>(column);
  }

 private:
  void validate_surroundings() const;
  [[nodiscard]] ColumnStream plain_column(int index, RowRange range) const;
  [[nodiscard]] ColumnStream combined_column(int index, RowRange range) const;

  SensorModel model_;
  std::shared_ptr<const TargetMap> targets_;
  double klux_;
  std::uint64_t seed_;
  std::uint32_t frame_;
  bool plain_ = true;  // nothing surrounds the sensor
};

/// Streams of single pixels of a PhotonSource without binning and coincidence, one after the other: keeps its
/// buffers between them. The source must outlive it. Not thread-safe.
class PixelStreams {
 public:
  explicit PixelStreams(const PhotonSource& source);
  PixelStreams(const PixelStreams&) = delete;
  PixelStreams& operator=(const PixelStreams&) = delete;
  PixelStreams(PixelStreams&&) = delete;
  PixelStreams& operator=(PixelStreams&&) = delete;
  ~PixelStreams();

  /// Appends the pixel's row to `stream`, drawn from random numbers of `purpose`.
  void append(int column, int row, ColumnStream& stream, RandomPurpose purpose = RandomPurpose::kPhotons);

 private:
  struct Buffers;

  const PhotonSource& source_;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace dtof
