// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/metrics/depth.hpp"
#include "rtl/configuration.hpp"

namespace dtof {

/// Scene of a fault study: part of the scene `room` with neighbouring pixels as in the full array; preset
/// `thesis` at 14 klux.
struct FaultScene {
  std::uint32_t acquisitions;
  std::uint32_t next_acquisitions;
  std::vector<ColumnStream> frame;  ///< the frame in which faults occur
  std::vector<ColumnStream> next;   ///< the following frame: the same targets, other photons, a third as long
  std::vector<double> distances_m;  ///< index = row * columns + column
};

inline constexpr int kFaultRows = 64;
inline constexpr int kFaultColumns = 12;
inline constexpr int kFaultEngineColumns = 6;

/// Throws InputError unless `acquisitions` is 1 to 65,535.
FaultScene make_fault_scene(std::uint32_t acquisitions, std::uint64_t seed);

/// A read-out on the array compiled for fault studies, and its frames without a fault. May be shared by
/// threads. Results: index = row * columns + column.
class FaultSubject {
 public:
  /// `scene` must outlive the subject. Throws InputError if no array is compiled for the read-out, RtlError
  /// if the array differs from the model without a fault.
  FaultSubject(Readout readout, const FaultScene& scene);

  [[nodiscard]] const RtlConfiguration& configuration() const { return configuration_; }
  [[nodiscard]] const ReadoutParameters& parameters() const { return configuration_.parameters; }
  [[nodiscard]] const FaultScene& scene() const { return scene_; }
  [[nodiscard]] const std::vector<PixelResult>& expected() const { return expected_; }
  [[nodiscard]] const std::vector<PixelResult>& expected_next() const { return expected_next_; }
  /// Clocks of the frame in which the array is in this state, counted from the frame's start.
  [[nodiscard]] const std::vector<std::uint64_t>& clocks(RtlState state) const {
    return clocks_[static_cast<std::size_t>(state)];
  }
  /// Results of the model for these columns in a frame of `acquisitions`.
  [[nodiscard]] std::vector<PixelResult> model(std::span<const ColumnStream> columns,
                                               std::uint32_t acquisitions) const;
  /// Depth of a result in m.
  [[nodiscard]] double depth(const PixelResult& result) const;

 private:
  const FaultScene& scene_;
  RtlConfiguration configuration_;
  DepthScale scale_;
  std::vector<PixelResult> expected_;
  std::vector<PixelResult> expected_next_;
  std::array<std::vector<std::uint64_t>, kRtlStateCount> clocks_;
};

}  // namespace dtof
