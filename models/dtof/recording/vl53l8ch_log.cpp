// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/vl53l8ch_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/csv_fields.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::string_view kBinColumn = "cnh__hist_bin_";
constexpr std::string_view kTextLine = "Agg,";
constexpr std::size_t kMostAggregates = 64;
constexpr std::size_t kMostBinsOfAggregate = 255;  // the driver's limit of the length of a histogram
constexpr std::size_t kMostCnhBins = std::size_t{1} << 27U;
constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();
constexpr double kUnknownDistance = std::numeric_limits<double>::quiet_NaN();

/// Text without blanks and quotation marks around it.
std::string_view bare(std::string_view text) {
  constexpr std::string_view kAround = " \t\"";
  const std::size_t begin = text.find_first_not_of(kAround);
  return begin == std::string_view::npos ? ""
                                         : text.substr(begin, text.find_last_not_of(kAround) + 1 - begin);
}

/// Removes `prefix` and the integer that follows from a name; none, and the name as it was, if it has none.
std::optional<std::size_t> take_index(std::string_view& name, std::string_view prefix) {
  if (!name.starts_with(prefix)) {
    return std::nullopt;
  }
  const std::string_view digits = name.substr(prefix.size());
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc()) {
    return std::nullopt;
  }
  name = digits.substr(static_cast<std::size_t>(end - digits.data()));
  return index;
}

/// A number, or NaN; throws InputError for another text and for infinity.
double number_field(const LineReader& lines, std::string_view field, std::string_view what) {
  const std::string_view text = bare(field);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || std::isinf(value)) {
    lines.fail(fmt::format("{}: \"{}\" is no number", what, text));
  }
  return value;
}

/// CnhFrames that were read: aggregates of equally many bins each.
class CnhFrames {
 public:
  /// Adds the bins [aggregate][bin] of a frame; negative ones become 0.
  void add(const LineReader& lines, std::span<const double> bins, std::span<const double> distances) {
    if (bins_.size() + bins.size() > kMostCnhBins) {
      lines.fail("more than 2^27 bins");
    }
    std::ranges::transform(bins, std::back_inserter(bins_), [](double bin) { return std::max(bin, 0.0); });
    distances_.insert(distances_.end(), distances.begin(), distances.end());
  }

  /// Cube of frames that have `columns` columns of `rows` aggregates, row by row.
  [[nodiscard]] HistogramCube cube(const std::filesystem::path& path, std::size_t columns, std::size_t rows,
                                   std::size_t bins, double bin_width) const {
    const std::size_t frames = distances_.size() / (columns * rows);
    HistogramCube cube;
    cube.name = path.string();
    cube.columns = static_cast<int>(frames * columns);
    cube.rows = static_cast<int>(rows);
    cube.bins = static_cast<int>(bins);
    cube.bin_width = bin_width;
    cube.counts.reserve(bins_.size());
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t frame = 0; frame < frames; ++frame) {
        const std::size_t first = (frame * rows + row) * columns;
        const auto part = std::span(bins_).subspan(first * bins, columns * bins);
        cube.counts.insert(cube.counts.end(), part.begin(), part.end());
        const auto known = std::span(distances_).subspan(first, columns);
        cube.true_distance.insert(cube.true_distance.end(), known.begin(), known.end());
      }
    }
    cube.validate();
    return cube;
  }

  /// Leaves out what was added.
  void leave_out_all(std::size_t aggregates) {
    left_out += count(aggregates);
    bins_.clear();
    distances_.clear();
  }

  [[nodiscard]] bool empty() const { return distances_.empty(); }
  [[nodiscard]] std::size_t count(std::size_t aggregates) const { return distances_.size() / aggregates; }

  std::size_t left_out = 0;

 private:
  std::vector<double> bins_;       ///< [frame][aggregate][bin]
  std::vector<double> distances_;  ///< [frame][aggregate], m
};

std::string describe_cnh(const CnhFrames& frames, std::size_t columns, std::size_t rows,
                         std::string_view lack) {
  return fmt::format("ST VL53L8CH, {} frames of {} histograms{}", frames.count(columns * rows),
                     columns * rows,
                     frames.left_out == 0 ? "" : fmt::format(", {} {} left out", frames.left_out, lack));
}

/// A position in a list that grows to contain it.
std::size_t& entry_of(std::vector<std::size_t>& list, std::size_t index) {
  list.resize(std::max(list.size(), index + 1), kNoColumn);
  return list[index];
}

/// Columns of the evaluation software's CSV.
class CsvColumns {
 public:
  CsvColumns(const LineReader& lines, std::string_view header) {
    const std::vector<std::string_view> names = split_at_commas(header);
    count_ = names.size();
    std::vector<std::vector<std::size_t>> bins;
    for (std::size_t column = 0; column < names.size(); ++column) {
      std::string_view name = bare(names[column]);
      const std::string_view whole = name;
      if (const auto bin = take_index(name, kBinColumn)) {
        const auto aggregate = take_index(name, "_a");
        if (!aggregate || !name.empty()) {
          continue;
        }
        if (*bin >= kMostBinsOfAggregate || *aggregate >= kMostAggregates) {
          lines.fail(fmt::format("column {}: bins are 0 to {}, aggregates 0 to {}", whole,
                                 kMostBinsOfAggregate - 1, kMostAggregates - 1));
        }
        bins.resize(std::max(bins.size(), *aggregate + 1));
        claim(lines, whole, entry_of(bins[*aggregate], *bin), column);
        bins_ = std::max(bins_, *bin + 1);
      } else {
        take_zone(lines, whole, column);
      }
    }
    for (std::size_t aggregate = 0; aggregate < bins.size(); ++aggregate) {
      for (std::size_t bin = 0; bin < bins_; ++bin) {
        const std::size_t column = entry_of(bins[aggregate], bin);
        if (column == kNoColumn) {
          lines.fail(fmt::format("no column {}{}_a{}", kBinColumn, bin, aggregate));
        }
        columns_.push_back(column);
      }
    }
    aggregates_ = bins.size();
  }

  /// Number of fields in a line.
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t aggregates() const { return aggregates_; }
  [[nodiscard]] std::size_t bins() const { return bins_; }

  /// Bins of a frame, [aggregate][bin]; none if the frame has no histograms.
  [[nodiscard]] std::vector<double> frame(const LineReader& lines,
                                          std::span<const std::string_view> fields) const {
    std::vector<double> frame(columns_.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      frame[i] =
          number_field(lines, fields[columns_[i]], fmt::format("{}{}_a{}", kBinColumn, i % bins_, i / bins_));
    }
    return std::ranges::any_of(frame, [](double bin) { return std::isnan(bin); }) ? std::vector<double>()
                                                                                  : frame;
  }

  /// Aggregate of each zone, kNoColumn for a zone without one; empty if the log does not say.
  [[nodiscard]] std::vector<std::size_t> aggregate_of_zones(const LineReader& lines,
                                                            std::span<const std::string_view> fields) const {
    std::vector<std::size_t> found;
    for (const std::size_t column : aggregate_of_zone_) {
      const double aggregate =
          column == kNoColumn ? kUnknownDistance : number_field(lines, fields[column], "mi__agg_id");
      found.push_back(aggregate >= 0.0 && aggregate < static_cast<double>(aggregates_)
                          ? static_cast<std::size_t>(aggregate)
                          : kNoColumn);
    }
    return found;
  }

  /// Distance in m of each aggregate of one zone, NaN if it is unknown.
  [[nodiscard]] std::vector<double> distances(const LineReader& lines,
                                              std::span<const std::string_view> fields) const {
    std::vector<double> metres(aggregates_, kUnknownDistance);
    std::vector<int> zones(aggregates_, 0);
    const std::vector<std::size_t> aggregates = aggregate_of_zones(lines, fields);
    for (std::size_t zone = 0; zone < aggregates.size(); ++zone) {
      if (aggregates[zone] != kNoColumn) {
        ++zones[aggregates[zone]];
        metres[aggregates[zone]] = distance(lines, fields, zone);
      }
    }
    for (std::size_t aggregate = 0; aggregate < aggregates_; ++aggregate) {
      if (zones[aggregate] != 1) {
        metres[aggregate] = kUnknownDistance;
      }
    }
    return metres;
  }

 private:
  static void claim(const LineReader& lines, std::string_view name, std::size_t& entry, std::size_t column) {
    if (entry != kNoColumn) {
      lines.fail(fmt::format("two columns {}", name));
    }
    entry = column;
  }

  void take_zone(const LineReader& lines, std::string_view name, std::size_t column) {
    for (const auto& [prefix, list] :
         {std::pair<std::string_view, std::vector<std::size_t>*>{"mi__agg_id_z", &aggregate_of_zone_},
          {"distance_mm_z", &distance_of_zone_},
          {".is_valid_range_z", &validity_of_zone_}}) {
      std::string_view rest = name;
      const auto zone = take_index(rest, prefix);
      if (zone && rest.empty() && *zone < kMostAggregates) {
        claim(lines, name, entry_of(*list, *zone), column);
      }
    }
  }

  [[nodiscard]] double distance(const LineReader& lines, std::span<const std::string_view> fields,
                                std::size_t zone) const {
    const auto column_of = [&](const std::vector<std::size_t>& list) {
      return zone < list.size() ? list[zone] : kNoColumn;
    };
    const std::size_t column = column_of(distance_of_zone_);
    const std::size_t validity = column_of(validity_of_zone_);
    if (column == kNoColumn ||
        (validity != kNoColumn && number_field(lines, fields[validity], ".is_valid_range") != 1.0)) {
      return kUnknownDistance;
    }
    const double millimetres = number_field(lines, fields[column], "distance_mm");
    return millimetres > 0.0 ? millimetres * 1e-3 : kUnknownDistance;
  }

  std::size_t count_ = 0;
  std::size_t aggregates_ = 0;
  std::size_t bins_ = 0;
  std::vector<std::size_t> columns_;  ///< [aggregate][bin]
  std::vector<std::size_t> aggregate_of_zone_;
  std::vector<std::size_t> distance_of_zone_;
  std::vector<std::size_t> validity_of_zone_;
};

/// Number of columns of an array of aggregates whose numbers ascend row by row over a square of zones; 1 if
/// the zones do not tell.
std::size_t columns_of(const std::vector<std::size_t>& aggregate_of_zones, std::size_t aggregates) {
  std::size_t side = 1;
  while (side * side < aggregate_of_zones.size()) {
    ++side;
  }
  for (std::size_t row = 0; row * side < aggregate_of_zones.size(); ++row) {
    std::size_t columns = 0;
    std::size_t last = kNoColumn;
    for (std::size_t zone = row * side; zone < std::min((row + 1) * side, aggregate_of_zones.size());
         ++zone) {
      if (aggregate_of_zones[zone] != kNoColumn && aggregate_of_zones[zone] != last) {
        last = aggregate_of_zones[zone];
        ++columns;
      }
    }
    if (columns > 0) {
      return aggregates % columns == 0 ? columns : 1;
    }
  }
  return 1;
}

HistogramCube read_cnh_csv(LineReader& lines, std::string_view header, double bin_width,
                           std::string& description) {
  const CsvColumns columns(lines, header);
  if (columns.aggregates() == 0) {
    lines.fail(fmt::format("no column {}<bin>_a<aggregate>", kBinColumn));
  }
  CnhFrames frames;
  std::size_t width = 1;
  std::string_view line;
  while (lines.next(line)) {
    const std::vector<std::string_view> fields = split_at_commas(line);
    if (line.empty() || (lines.cut() && fields.size() < columns.count())) {
      continue;  // the recording ended in this line
    }
    if (fields.size() != columns.count()) {
      lines.fail(fmt::format("{} fields instead of {}", fields.size(), columns.count()));
    }
    const std::vector<double> frame = columns.frame(lines, fields);
    if (frame.empty()) {
      ++frames.left_out;
      continue;
    }
    if (frames.empty()) {
      width = columns_of(columns.aggregate_of_zones(lines, fields), columns.aggregates());
    }
    frames.add(lines, frame, columns.distances(lines, fields));
  }
  if (frames.empty()) {
    fail_in_file(lines.path(), "no frame with histograms");
  }
  const std::size_t rows = columns.aggregates() / width;
  description = describe_cnh(frames, width, rows, "without histograms");
  return frames.cube(lines.path(), width, rows, columns.bins(), bin_width);
}

/// CnhFrames of the driver's example.
class TextFrames {
 public:
  explicit TextFrames(LineReader& lines) : lines_(lines) {}

  void take(std::string_view line) {
    std::vector<std::string_view> fields = split_at_commas(line);
    if (!fields.empty() && bare(fields.back()).empty()) {
      fields.pop_back();  // a comma follows the last bin
    }
    constexpr std::size_t kBefore = 5;
    if (fields.size() <= kBefore || bare(fields[2]) != "Ambient" || bare(fields[4]) != "Bins") {
      if (!lines_.cut()) {
        lines_.fail("not \"Agg, <aggregate>, Ambient, <level>, Bins, <bin>, ...\"");
      }
      return;
    }
    const double aggregate = number_field(lines_, fields[1], "aggregate");
    if (!(aggregate >= 0.0 && aggregate < static_cast<double>(kMostAggregates)) ||
        aggregate != std::floor(aggregate)) {
      lines_.fail(
          fmt::format("aggregate \"{}\" is no integer from 0 to {}", bare(fields[1]), kMostAggregates - 1));
    }
    const std::size_t bins = fields.size() - kBefore;
    if (bins_ != 0 && bins != bins_) {
      if (!lines_.cut()) {
        lines_.fail(fmt::format("{} bins instead of {}", bins, bins_));
      }
      return;
    }
    bins_ = bins;
    const auto index = static_cast<std::size_t>(aggregate);
    if (index == 0) {
      end_frame();
    }
    complete_ = complete_ && index == next_;
    next_ = index + 1;
    for (std::size_t i = kBefore; i < fields.size(); ++i) {
      const double bin = number_field(lines_, fields[i], fmt::format("bin {}", i - kBefore));
      complete_ = complete_ && !std::isnan(bin);
      frame_.push_back(bin);
    }
  }

  HistogramCube finish(double bin_width, std::string& description) {
    end_frame();
    if (frames_.empty()) {
      fail_in_file(lines_.path(), "no whole frame: its lines \"Agg,\" ascend from 0");
    }
    description = describe_cnh(frames_, 1, aggregates_, "incomplete");
    return frames_.cube(lines_.path(), 1, aggregates_, bins_, bin_width);
  }

 private:
  /// Ends a frame. The one with the most aggregates says how many there are.
  void end_frame() {
    if (complete_ && next_ > aggregates_) {
      frames_.leave_out_all(std::max<std::size_t>(aggregates_, 1));
      aggregates_ = next_;
    }
    if (complete_ && next_ == aggregates_ && next_ != 0) {
      frames_.add(lines_, frame_, std::vector<double>(aggregates_, kUnknownDistance));
    } else if (next_ != 0) {
      ++frames_.left_out;
    }
    frame_.clear();
    next_ = 0;
    complete_ = true;
  }

  LineReader& lines_;
  CnhFrames frames_;
  std::vector<double> frame_;
  std::size_t bins_ = 0;
  std::size_t aggregates_ = 0;
  std::size_t next_ = 0;  ///< number of the aggregate that follows; 0: no frame is open
  bool complete_ = true;
};

}  // namespace

bool is_vl53l8ch_log(std::string_view text) {
  text = without_byte_order_mark(text);
  return text.substr(0, text.find('\n')).find(kBinColumn) != std::string_view::npos ||
         text.starts_with(kTextLine) || text.find("\n" + std::string(kTextLine)) != std::string_view::npos;
}

HistogramCube read_vl53l8ch_log(LineReader& lines, std::optional<double> bin_width_s,
                                std::string& description) {
  if (!bin_width_s) {
    fail_in_file(lines.path(),
                 fmt::format("the log does not say how wide its bins are; give --bin-width: {:.1f} ps "
                             "for each bin that the sensor sums",
                             kVl53l8chBinWidth * 1e12));
  }
  std::string_view line;
  if (!lines.next(line)) {
    fail_in_file(lines.path(), "no lines");
  }
  if (line.find(kBinColumn) != std::string_view::npos) {
    return read_cnh_csv(lines, std::string(line), *bin_width_s, description);
  }
  TextFrames frames(lines);
  do {
    if (line.starts_with(kTextLine)) {
      frames.take(line);
    }
  } while (lines.next(line));
  return frames.finish(*bin_width_s, description);
}

}  // namespace dtof
