// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Memory of a pixel at the end of a frame, as it leaves the chip: counters or positions, on the rival's own
/// scale.
using RivalWords = std::vector<std::int32_t>;

/// Detections of one pixel by frame, oldest first.
using PixelFrames = std::span<const std::span<const Detection>>;

/// Parts of a rival's column, for an estimate of its area (synth/dtof_synth/rival_area.py has the area of
/// each part). Like the project's columns, it takes one timestamp per clock and serves all rows.
struct RivalHardware {
  int words = 1;      ///< words of a pixel in the column's SRAM; a timestamp reads and writes one of them
  int word_bits = 0;  ///< words * word_bits is at least bits_per_pixel()
  int adder_bits =
      0;  ///< full adders beyond one for each bit of a word; a times b bits of a product or quotient
  int table_bits = 0;  ///< bits of tables addressed by timestamps, which each column needs
};

/// A read-out from the literature that an architect could choose instead of the project's. The model covers
/// the pixel's memory bit by bit and, separately, the host's decoding. It has no RTL. Bits that all pixels
/// share (code tables, dividers, schedules) are not counted. Instances hold no state of a frame: all
/// functions are thread-safe.
class Rival {
 public:
  Rival() = default;
  Rival(const Rival&) = delete;
  Rival& operator=(const Rival&) = delete;
  Rival(Rival&&) = delete;
  Rival& operator=(Rival&&) = delete;
  virtual ~Rival() = default;

  /// Memory bits of a pixel.
  [[nodiscard]] virtual int bits_per_pixel() const = 0;
  [[nodiscard]] virtual RivalHardware hardware() const = 0;
  /// Multiply-adds and comparisons of decode() for one pixel, to two digits. Excludes the look-up table of
  /// distances, which every read-out has.
  [[nodiscard]] virtual int host_operations() const = 0;
  /// Frames per result; all of them see the same scene.
  [[nodiscard]] virtual int frames() const { return 1; }
  /// The first frames of a result that are taken without laser light; fewer than frames().
  [[nodiscard]] virtual int laser_off_frames() const { return 0; }

  /// The chip's part, in integers. `frames` holds frames() frames; the no-detection code is dropped. Throws
  /// InputError for a timestamp above 2^NP - 1 or an acquisition outside the frame.
  [[nodiscard]] virtual RivalWords read_pixel(PixelFrames frames) const = 0;

  /// The host's part: position of the pulse on the code axis in bins (metrics/depth.hpp), and a confidence on
  /// the rival's own scale. A pixel without detections has any position and confidence 0.
  [[nodiscard]] virtual Measurement decode(std::span<const std::int32_t> words) const = 0;

  /// The host's part: for each code 0 .. 2^NP - 2 the natural logarithm of the likelihood of a pulse there,
  /// up to a constant. Empty if the rival's words give only one position.
  [[nodiscard]] virtual std::vector<double> evidence(std::span<const std::int32_t> words) const {
    (void)words;
    return {};
  }
};

/// Shares of a flat wall's pixels whose relative error exceeds a limit, in per cent.
struct WallShares {
  double above_3_percent;
  double above_10_percent;
};
/// First estimates of a rival's errors, to which `dtof-study rivals --claims` compares its own figures.
/// Conditions: preset thesis, 50 klux, kClaimedPixels pixels per distance, counters without limits, the
/// median's bias removed at each distance.
struct RivalClaim {
  WallShares at_3_m;
  WallShares at_4_m;
};
inline constexpr std::uint64_t kClaimedPixels = 500;

/// Entry of a rival in the list.
struct RivalEntry {
  std::string_view name;      ///< on the command line
  std::string_view title;     ///< in tables; begins with its family's title in scripts/plot_styles.toml
  std::string_view citation;  ///< publication that defines it
  std::unique_ptr<Rival> (*make)(const SensorModel& sensor);
  std::optional<RivalClaim> claim = std::nullopt;
};

/// All rivals, in the order of the reports (rival_list.cpp).
std::span<const RivalEntry> all_rivals();
/// Rival by its command-line name. Throws InputError that lists the known names.
const RivalEntry& find_rival(std::string_view name);

/// Throws InputError unless the pixel's detections fit the sensor's codes and frame.
void check_rival_frame(std::span<const Detection> detections, const SensorModel& sensor);

}  // namespace dtof
