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

/// A pixel's memory at the end of a frame, as it leaves the chip: counters or positions, on the rival's own
/// scale.
using RivalWords = std::vector<std::int32_t>;

/// Detections of one pixel, frame by frame, the oldest first.
using PixelFrames = std::span<const std::span<const Detection>>;

/// What a rival's column would be made of, for an estimate of its area (synth/dtof_synth/rival_area.py says
/// what each part takes). Like the project's columns it takes a timestamp per clock and serves all rows.
struct RivalHardware {
  int words = 1;      ///< of a pixel in the column's SRAM; a timestamp reads and writes one of them
  int word_bits = 0;  ///< words * word_bits is at least bits_per_pixel()
  int adder_bits =
      0;  ///< full adders beyond one for each bit of a word; a times b bits of a product or quotient
  int table_bits = 0;  ///< of tables that the timestamps address, which each column needs for itself
};

/// A read-out that others have proposed, as an architect could choose it instead of the project's: what the
/// pixel's memory does, bit for bit, and apart from it what the host makes of the words. It has no RTL, and
/// its bits are those that the pixel keeps; what all pixels share (code tables, dividers, schedules) is not
/// counted. Instances hold no state of a frame: all functions are thread-safe.
class Rival {
 public:
  Rival() = default;
  Rival(const Rival&) = delete;
  Rival& operator=(const Rival&) = delete;
  Rival(Rival&&) = delete;
  Rival& operator=(Rival&&) = delete;
  virtual ~Rival() = default;

  /// Bits of memory that a pixel keeps.
  [[nodiscard]] virtual int bits_per_pixel() const = 0;
  [[nodiscard]] virtual RivalHardware hardware() const = 0;
  /// Multiply-adds and comparisons of decode() for one pixel, to two digits. The look-up table of distances,
  /// which every read-out has, is not counted.
  [[nodiscard]] virtual int host_operations() const = 0;
  /// Frames that one result needs; those before the last one saw the same scene.
  [[nodiscard]] virtual int frames() const { return 1; }

  /// On the chip, integers only. `frames` has frames() of them; the no-detection code is dropped. Throws
  /// InputError for a timestamp beyond 2^NP - 1 or an acquisition beyond the frame.
  [[nodiscard]] virtual RivalWords read_pixel(PixelFrames frames) const = 0;

  /// On the host: where the words put the pulse, on the code axis in bins (metrics/depth.hpp), and how sure
  /// that is, on the rival's own scale. A pixel without detections has some position and confidence 0.
  [[nodiscard]] virtual Measurement decode(std::span<const std::int32_t> words) const = 0;

  /// On the host: for each code 0 .. 2^NP - 2 the logarithm of the likelihood that the pulse is there, but
  /// for a constant, in natural units. Empty for a rival whose words tell only one place.
  [[nodiscard]] virtual std::vector<double> evidence(std::span<const std::int32_t> words) const {
    (void)words;
    return {};
  }
};

/// Per cent of a flat wall's pixels whose relative error is larger.
struct WallShares {
  double above_3_percent;
  double above_10_percent;
};
/// What a first estimate says of a rival, which `dtof-study rivals --claims` puts beside its own figures:
/// preset thesis, 50 klux, kClaimedPixels pixels a distance, counters without limits, the median's bias
/// removed at each distance.
struct RivalClaim {
  WallShares at_3_m;
  WallShares at_4_m;
};
inline constexpr std::uint64_t kClaimedPixels = 500;

/// What the list knows of a rival.
struct RivalEntry {
  std::string_view name;      ///< on the command line
  std::string_view title;     ///< in tables; begins with its family's title in scripts/plot_styles.toml
  std::string_view citation;  ///< where it is defined
  std::unique_ptr<Rival> (*make)(const SensorModel& sensor);
  std::optional<RivalClaim> claim = std::nullopt;
};

/// All rivals, in the order of the reports (rival_list.cpp).
std::span<const RivalEntry> all_rivals();
/// Throws InputError naming the legal names.
const RivalEntry& find_rival(std::string_view name);

/// Throws InputError unless the pixel's detections fit the sensor's codes and frame.
void check_rival_frame(std::span<const Detection> detections, const SensorModel& sensor);

}  // namespace dtof
