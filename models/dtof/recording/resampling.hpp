// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/random.hpp"

namespace dtof {

/// How the photon number of a pixel and frame follows from the photon budget.
enum class PhotonNumber {
  kPoisson,  ///< Poisson with the budget as mean, as in a sensor
  kFixed,    ///< the budget, rounded to an integer, in every frame
};

/// Most photons, and most background events, of a pixel and frame. Each takes 16 bytes while the pixel's
/// stream is made. A TDC keeps at most acquisitions * SLOTS of them, 6666 for 3333 acquisitions.
inline constexpr double kLargestPhotonNumber = 1e7;

/// How measured photons become the TDC stream of a frame.
struct Resampling {
  int np = 10;                        ///< bits of a timestamp, 1..16
  double integration_time = 45e-9;    ///< T_int, s; T_res = T_int / 2^np
  double time_shift = 0.0;            ///< s, added to every measured time; times outside [0, T_int) are lost
  std::uint32_t acquisitions = 3333;  ///< per frame
  int slots = 2;                      ///< events kept per pixel and acquisition, earliest first
  std::optional<double> photon_budget =
      std::nullopt;  ///< photons per pixel and frame; none: all measured ones
  PhotonNumber photon_number = PhotonNumber::kPoisson;
  double background = 0.0;  ///< additional background events per acquisition (mean), flat over T_int
  std::uint64_t seed = 1;
  std::uint32_t frame = 0;  ///< number of the frame; each number gives other random draws

  /// Throws InputError with one sentence if a field is outside its range.
  void validate() const;
};

/// Number of measured photons in a frame.
struct PhotonCount {
  std::uint64_t all = 0;
  std::uint64_t outside = 0;  ///< photons outside [0, T_int), which are lost
};

/// What is lost of `file`'s photons because they lie outside of `integration_time`, s; empty if nothing is.
/// Throws InputError if everything is.
std::string lost_photons_sentence(const std::string& file, const PhotonCount& photons,
                                  double integration_time);

/// A measurement replayed as a TDC stream. Every photon goes to a uniformly random acquisition, and each
/// acquisition keeps its first `slots` events in time (pile-up, thesis 2.2.2). A pixel's random numbers
/// depend on seed, frame and the pixel's address alone.
class ResampledStream : public StreamSource {
 public:
  [[nodiscard]] int columns() const override { return columns_; }
  [[nodiscard]] int rows() const override { return rows_; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return resampling_.acquisitions; }
  [[nodiscard]] ColumnStream column(int index) const override { return column_rows(index, {0, rows_}); }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange range) const override;
  /// Number of photons in these rows and columns, without background.
  [[nodiscard]] PhotonCount count_photons(std::span<const int> columns, RowRange rows) const;

 protected:
  ResampledStream(int columns, int rows, const Resampling& resampling);
  [[nodiscard]] const Resampling& resampling() const { return resampling_; }
  /// Draws the number of photons of a pixel in this frame for the given budget.
  [[nodiscard]] std::uint64_t draw_photon_number(double budget, CounterRandom& random) const;

 private:
  /// Appends the measured arrival times of one pixel in this frame, in s, before `time_shift`.
  virtual void draw_times(int column, int row, CounterRandom& random, std::vector<double>& times) const = 0;

  /// Random generator of a pixel in this frame.
  [[nodiscard]] CounterRandom random(int column, int row) const;

  int columns_;
  int rows_;
  Resampling resampling_;
};

/// Assigns arrival times (s, `time_shift` included) to random acquisitions: T_int has 2^np codes, and an
/// acquisition keeps `slots` events. Returns detections sorted as in a ColumnStream row.
std::vector<Detection> assign_to_acquisitions(std::span<const double> times, const Resampling& resampling,
                                              CounterRandom& random);

}  // namespace dtof
