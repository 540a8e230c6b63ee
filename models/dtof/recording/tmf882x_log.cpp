// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf882x_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/csv_fields.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/recording/tmf8820_json.hpp"

namespace dtof {
namespace {

constexpr std::string_view kHistogramLine = "#Raw,";
constexpr std::string_view kCalibrationLine = "#Cal,";
constexpr std::string_view kResultLine = "#Obj,";
constexpr std::string_view kConfigurationLine = "#Conf";
constexpr std::string_view kSpadMap = "SPAD=";
constexpr std::size_t kCaptureZones = kTmf8820Zones;
constexpr std::size_t kCaptureBins = kTmf8820Bins;
constexpr std::size_t kChannels = kCaptureZones + 1;
constexpr std::size_t kBytes = 3;
constexpr std::size_t kFieldsBeforeBins = 3;
constexpr std::size_t kFieldsBeforeObjects = 6;
constexpr std::size_t kObjects = 36;
constexpr std::size_t kDistances = 2 * kCaptureZones;  // first objects
constexpr std::uint64_t kEightByEightMap = 15;
constexpr int kFrameSide = 8;
constexpr std::size_t kQuarters = 4;
constexpr std::uint64_t kResultNumbers = 256;
constexpr std::size_t kMostTmf882xBins = std::size_t{1} << 27U;
constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

using Channel = std::array<std::uint32_t, kCaptureBins>;
using Capture = std::array<Channel, kCaptureZones>;

/// A line "#Obj", and the captures before it.
struct Result {
  std::optional<std::uint64_t> number;  ///< none: the log ends before the result's line
  std::size_t begin = 0;                ///< its captures, in the list of all
  std::size_t captures = 0;
  bool broken = false;  ///< lines of a capture are missing
  std::array<double, kDistances> distances{};

  [[nodiscard]] bool has(std::size_t wanted) const { return captures == wanted && !broken; }
};

/// The capture whose lines are being read.
class OpenCapture {
 public:
  /// Returns false if the line is there already.
  bool add(std::size_t index, const std::array<std::uint64_t, kCaptureBins>& numbers) {
    if (have_.test(index)) {
      return false;
    }
    have_.set(index);
    for (std::size_t bin = 0; bin < kCaptureBins; ++bin) {
      counts_.at(index % kChannels).at(bin) += numbers.at(bin) << 8U * (index / kChannels);
    }
    return true;
  }

  [[nodiscard]] bool empty() const { return have_.none(); }
  [[nodiscard]] bool complete() const { return have_.all(); }

  /// The largest count of a bin.
  [[nodiscard]] std::uint64_t largest() const {
    std::uint64_t most = 0;
    for (const auto& channel : counts_) {
      most = std::max(most, *std::ranges::max_element(channel));
    }
    return most;
  }

  [[nodiscard]] Capture capture() const {
    Capture capture{};
    for (std::size_t zone = 0; zone < kCaptureZones; ++zone) {
      std::ranges::transform(counts_.at(zone + 1), capture.at(zone).begin(),
                             [](std::uint64_t count) { return static_cast<std::uint32_t>(count); });
    }
    return capture;
  }

 private:
  std::bitset<kChannels * kBytes> have_;
  std::array<std::array<std::uint64_t, kCaptureBins>, kChannels> counts_{};
};

/// A field; throws InputError unless it is an integer from 0 to `largest`.
std::uint64_t integer_field(const LineReader& lines, std::string_view field, std::uint64_t largest) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || value > largest) {
    lines.fail(fmt::format("\"{}\" is no integer from 0 to {}", field, largest));
  }
  return value;
}

/// Captures and results of a log, in its order.
class Tmf882xLog {
 public:
  explicit Tmf882xLog(LineReader& lines) : lines_(lines) {
    std::string_view line;
    while (lines.next(line)) {
      if (line.starts_with(kHistogramLine)) {
        take_histogram(split_at_commas(line));
      } else if (line.starts_with(kResultLine)) {
        take_result(split_at_commas(line));
      } else if (line.starts_with(kConfigurationLine)) {
        take_configuration(line);
      }
    }
    close();
    end_result({});
  }

  [[nodiscard]] const std::vector<Capture>& captures() const { return captures_; }
  [[nodiscard]] const std::vector<Result>& results() const { return results_; }
  /// Number of captures with missing lines.
  [[nodiscard]] std::size_t incomplete() const { return incomplete_; }

  /// The mode that the log says. Throws InputError if two modes are possible.
  [[nodiscard]] Tmf882xMode mode() const {
    const auto numbered = [&](std::size_t captures) {
      return std::ranges::count_if(
          results_, [&](const Result& result) { return result.number && result.has(captures); });
    };
    if (numbered(2) <= numbered(1)) {
      return Tmf882xMode::kOneCapture;
    }
    if (!spad_map_) {
      fail_in_file(
          lines_.path(),
          "two captures before each line \"#Obj\" and no \"SPAD=\" in a line \"#Conf\": 4 x 4 or 3 x 6 "
          "zones (--format tmf8821), or 8 x 8 (--format tmf8828)?");
    }
    return *spad_map_ == kEightByEightMap ? Tmf882xMode::kEightByEight : Tmf882xMode::kTwoCaptures;
  }

 private:
  void take_histogram(const std::vector<std::string_view>& fields) {
    constexpr std::size_t kFields = kFieldsBeforeBins + kCaptureBins;
    if (lines_.cut() && fields.size() < kFields) {
      return;  // the recording ended in this line
    }
    if (fields.size() != kFields) {
      lines_.fail(fmt::format("{} fields instead of {} (#Raw, address, index and {} bins)", fields.size(),
                              kFields, kCaptureBins));
    }
    const std::size_t index = integer_field(lines_, fields[2], kChannels * kBytes - 1);
    std::array<std::uint64_t, kCaptureBins> numbers{};
    for (std::size_t bin = 0; bin < kCaptureBins; ++bin) {
      numbers.at(bin) =
          integer_field(lines_, fields[kFieldsBeforeBins + bin], std::numeric_limits<std::uint16_t>::max());
    }
    if (index == 0) {
      close();
    }
    if (!open_.add(index, numbers)) {
      close();
      open_.add(index, numbers);
    }
    if (open_.complete()) {
      close();
    }
  }

  void take_result(const std::vector<std::string_view>& fields) {
    constexpr std::size_t kFields = kFieldsBeforeObjects + 2 * kObjects;
    if (lines_.cut() && fields.size() < kFields) {
      return;
    }
    if (fields.size() <= 2) {
      lines_.fail(
          fmt::format("{} fields: a line \"#Obj\" has an address and a result number", fields.size()));
    }
    Result result;
    result.number = integer_field(lines_, fields[2], kResultNumbers - 1);
    result.distances.fill(kNoDistance);
    if (fields.size() == kFields) {  // otherwise the firmware prints other objects
      for (std::size_t i = 0; i < kDistances; ++i) {
        const std::uint64_t millimetres = integer_field(lines_, fields[kFieldsBeforeObjects + 2 * i],
                                                        std::numeric_limits<std::uint16_t>::max());
        if (millimetres > 0) {
          result.distances.at(i) = static_cast<double>(millimetres) * 1e-3;
        }
      }
    }
    close();
    end_result(std::move(result));
  }

  void take_configuration(std::string_view line) {
    const std::size_t at = line.find(kSpadMap);
    if (at == std::string_view::npos) {
      return;
    }
    line.remove_prefix(at + kSpadMap.size());
    const std::uint64_t map = integer_field(lines_, line.substr(0, line.find_first_of(" ,")),
                                            std::numeric_limits<std::uint8_t>::max());
    if (spad_map_ && *spad_map_ != map && !captures_.empty()) {
      lines_.fail(
          fmt::format("SPAD map {} after captures with map {}: a recording has one map", map, *spad_map_));
    }
    spad_map_ = map;
  }

  /// Ends the open capture.
  void close() {
    if (open_.complete()) {
      if (open_.largest() > std::numeric_limits<std::uint32_t>::max()) {
        lines_.fail(fmt::format("a bin has {} photons, more than 2^32-1", open_.largest()));
      }
      if (captures_.size() >= kMostTmf882xBins / (kCaptureZones * kCaptureBins)) {
        lines_.fail("more than 2^27 bins");
      }
      captures_.push_back(open_.capture());
    } else if (!open_.empty()) {
      ++incomplete_;
      broken_ = true;
    }
    open_ = OpenCapture();
  }

  /// Gives the captures since the last result to this one.
  void end_result(Result result) {
    result.begin = next_result_;
    result.captures = captures_.size() - next_result_;
    result.broken = std::exchange(broken_, false);
    next_result_ = captures_.size();
    if (result.captures > 0 || result.broken) {
      if (!result.number) {
        result.distances.fill(kNoDistance);
      }
      results_.push_back(result);
    }
  }

  LineReader& lines_;
  OpenCapture open_;
  bool broken_ = false;
  std::vector<Capture> captures_;
  std::vector<Result> results_;
  std::size_t next_result_ = 0;
  std::size_t incomplete_ = 0;
  std::optional<std::uint64_t> spad_map_;
};

/// A zone of a cube: its histogram, and the distance that the sensor reported.
struct ReportedZone {
  const Channel* histogram = nullptr;
  double distance = kNoDistance;
};

/// ZoneList of a cube, [column][row].
struct ZoneList {
  int rows = 0;
  std::vector<ReportedZone> zones;
  std::size_t left_out = 0;
};

/// ReportedZone `zone` of capture `index` of a result.
ReportedZone zone_of(const Tmf882xLog& log, const Result& result, std::size_t index, std::size_t zone) {
  return {&log.captures()[result.begin + index].at(zone), result.distances.at(index * kCaptureZones + zone)};
}

/// Each capture as a column.
ZoneList single_captures(const Tmf882xLog& log) {
  ZoneList zones{.rows = static_cast<int>(kCaptureZones), .zones = {}, .left_out = log.incomplete()};
  for (const Result& result : log.results()) {
    for (std::size_t index = 0; index < result.captures; ++index) {
      const bool reported = result.number && index + 1 == result.captures;  // the result is of the last one
      for (std::size_t zone = 0; zone < kCaptureZones; ++zone) {
        zones.zones.push_back({&log.captures()[result.begin + index].at(zone),
                               reported ? result.distances.at(zone) : kNoDistance});
      }
    }
  }
  return zones;
}

/// Each result of two captures as a column.
ZoneList pairs_of_captures(const Tmf882xLog& log) {
  ZoneList zones;
  std::vector<const Result*> pairs;
  for (const Result& result : log.results()) {
    if (result.has(2)) {
      pairs.push_back(&result);
    } else {
      ++zones.left_out;
    }
  }
  // 4 x 4 zones leave the last channel of each capture empty.
  const bool all = std::ranges::any_of(pairs, [&](const Result* result) {
    return std::ranges::any_of(log.captures()[result->begin].back(), [](auto count) { return count > 0; }) ||
           std::ranges::any_of(log.captures()[result->begin + 1].back(),
                               [](auto count) { return count > 0; });
  });
  const std::size_t used = all ? kCaptureZones : kCaptureZones - 1;
  zones.rows = static_cast<int>(2 * used);
  for (const Result* const result : pairs) {
    for (std::size_t index = 0; index < 2; ++index) {
      for (std::size_t zone = 0; zone < used; ++zone) {
        zones.zones.push_back(zone_of(log, *result, index, zone));
      }
    }
  }
  return zones;
}

/// EightByEightFrames of four results as 8 columns each. Capture i = 0..7 of a frame has every fourth column,
/// from i % 4 on, of every second row: from row 7 upwards for i < 4, else from row 6. Its zones alternate
/// between these two columns.
class EightByEightFrames {
 public:
  explicit EightByEightFrames(const Tmf882xLog& log)
      : log_(log), zones_{.rows = kFrameSide, .zones = {}, .left_out = 0} {
    for (const Result& result : log.results()) {
      const bool follows = !run_.empty() && result.number && run_.back()->number &&
                           *result.number % kQuarters != 0 && *result.number == *run_.back()->number + 1;
      if (!follows) {
        end_run();
      }
      run_.push_back(&result);
    }
    end_run();
  }

  [[nodiscard]] ZoneList take() { return std::move(zones_); }

 private:
  void end_run() {
    const bool whole = run_.size() == kQuarters &&
                       std::ranges::all_of(run_, [](const Result* result) { return result->has(2); });
    if (whole) {
      add_frame();
    } else if (!run_.empty()) {
      ++zones_.left_out;
    }
    run_.clear();
  }

  void add_frame() {
    const std::size_t begin = zones_.zones.size();
    zones_.zones.resize(begin + kFrameSide * kFrameSide);
    for (std::size_t capture = 0; capture < 2 * kQuarters; ++capture) {
      for (std::size_t zone = 0; zone + 1 < kCaptureZones; ++zone) {
        const std::size_t row = (capture < kQuarters ? 7 : 6) - 2 * (zone / 2);
        const std::size_t column = 4 * (zone % 2) + capture % kQuarters;
        zones_.zones[begin + column * kFrameSide + row] =
            zone_of(log_, *run_[capture / 2], capture % 2, zone);
      }
    }
  }

  const Tmf882xLog& log_;
  ZoneList zones_;
  std::vector<const Result*> run_;
};

HistogramCube cube_of(const ZoneList& zones, const std::filesystem::path& path, double bin_width) {
  HistogramCube cube;
  cube.name = path.string();
  cube.rows = zones.rows;
  cube.columns = static_cast<int>(zones.zones.size()) / zones.rows;
  cube.bins = static_cast<int>(kCaptureBins);
  cube.bin_width = bin_width;
  cube.counts.reserve(zones.zones.size() * kCaptureBins);
  for (int row = 0; row < cube.rows; ++row) {
    for (int column = 0; column < cube.columns; ++column) {
      const ReportedZone& zone =
          zones.zones[static_cast<std::size_t>(column) * static_cast<std::size_t>(cube.rows) +
                      static_cast<std::size_t>(row)];
      cube.counts.insert(cube.counts.end(), zone.histogram->begin(), zone.histogram->end());
      cube.true_distance.push_back(zone.distance);
    }
  }
  cube.validate();
  return cube;
}

}  // namespace

bool is_tmf882x_log(std::string_view text) {
  text = without_byte_order_mark(text);
  return std::ranges::any_of(
      std::array{kHistogramLine, kCalibrationLine, kResultLine}, [&](std::string_view begin) {
        return text.starts_with(begin) || text.find("\n" + std::string(begin)) != std::string_view::npos;
      });
}

HistogramCube read_tmf882x_log(LineReader& lines, const Tmf882xOptions& options, std::string& description) {
  const Tmf882xLog log(lines);
  if (log.captures().empty()) {
    fail_in_file(lines.path(),
                 fmt::format("no whole capture: one has {} lines \"#Raw\"", kChannels * kBytes));
  }
  const Tmf882xMode mode = options.mode ? *options.mode : log.mode();
  if (mode != Tmf882xMode::kOneCapture && !options.bin_width_s) {
    fail_in_file(lines.path(),
                 "a log of more than 9 zones does not say how wide its bins are; give --bin-width");
  }
  const ZoneList zones = mode == Tmf882xMode::kOneCapture    ? single_captures(log)
                         : mode == Tmf882xMode::kTwoCaptures ? pairs_of_captures(log)
                                                             : EightByEightFrames(log).take();
  if (zones.zones.empty()) {
    fail_in_file(lines.path(),
                 mode == Tmf882xMode::kTwoCaptures
                     ? "no whole result: two captures, then a line \"#Obj\""
                     : "no whole frame: four results of two captures, with consecutive numbers");
  }
  HistogramCube cube = cube_of(zones, lines.path(), options.bin_width_s.value_or(kTmf8820BinWidth));
  const std::string left_out =
      zones.left_out == 0 ? "" : fmt::format(", {} incomplete left out", zones.left_out);
  description =
      mode == Tmf882xMode::kEightByEight
          ? fmt::format("ams-OSRAM TMF8828, {} frames of 8 x 8 zones{}", cube.columns / kFrameSide, left_out)
          : fmt::format("ams {}, {} captures of {} zones{}",
                        mode == Tmf882xMode::kOneCapture ? "TMF8820" : "TMF8821", cube.columns, cube.rows,
                        left_out);
  return cube;
}

}  // namespace dtof
