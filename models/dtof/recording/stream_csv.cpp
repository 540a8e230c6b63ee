// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/stream_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/csv_fields.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kLargestSize = 65536;
constexpr std::uint64_t kLargestPixelCount = std::uint64_t{1} << 24U;
constexpr std::uint64_t kLargestAcquisitionCount = std::numeric_limits<std::uint32_t>::max();

struct Line {
  std::uint32_t acquisition;
  std::uint16_t column;
  std::uint16_t row;
  Timestamp timestamp;
  std::size_t number;
};

/// Largest legal index and how a message calls the limit.
struct Limit {
  std::uint64_t count;
  const char* what;
};

template <typename T>
Limit limit(const std::optional<T>& given, std::uint64_t largest, const char* what_given,
            const char* what_largest) {
  return given ? Limit{static_cast<std::uint64_t>(*given), what_given} : Limit{largest, what_largest};
}

void check_index(const std::string& name, std::size_t line, std::string_view field, std::uint64_t value,
                 const Limit& limit) {
  if (value >= limit.count) {
    fail_at_line(name, line,
                 limit.count == 0 ? fmt::format("{} {} is outside {} 0", field, value, limit.what)
                                  : fmt::format("{} {} is outside 0..{} ({} {})", field, value,
                                                limit.count - 1, limit.what, limit.count));
  }
}

/// Sorts the lines of one pixel by acquisition, slots in line order, and returns the first line that is one
/// too many, or 0.
std::size_t sort_pixel(std::span<Line> lines, int slots) {
  const auto by_acquisition = [](const Line& a, const Line& b) { return a.acquisition < b.acquisition; };
  if (!std::is_sorted(lines.begin(), lines.end(), by_acquisition)) {
    std::stable_sort(lines.begin(), lines.end(), by_acquisition);
  }
  std::size_t first = 0;
  const auto depth = static_cast<std::size_t>(slots);
  for (std::size_t i = depth; i < lines.size(); ++i) {
    if (lines[i].acquisition == lines[i - depth].acquisition && (first == 0 || lines[i].number < first)) {
      first = lines[i].number;
    }
  }
  return first;
}

/// Sizes that a file's lines ask for, those without a detection among them.
struct Extent {
  std::uint64_t acquisitions = 0;
  std::uint64_t columns = 0;
  std::uint64_t rows = 0;

  void include(std::span<const std::uint64_t> fields) {
    acquisitions = std::max(acquisitions, fields[0] + 1);
    columns = std::max(columns, fields[1] + 1);
    rows = std::max(rows, fields[2] + 1);
  }
};

void check_options(const StreamCsvOptions& options) {
  const auto check = [](const char* what, std::int64_t value, std::int64_t lowest, std::int64_t highest) {
    if (value < lowest || value > highest) {
      throw InputError(
          fmt::format("recorded stream: {} is {}, must be {}..{}", what, value, lowest, highest));
    }
  };
  check("NP", options.np, 1, 16);
  check("SLOTS", options.slots, 1, std::numeric_limits<int>::max());
  check("columns", options.columns.value_or(1), 1, kLargestSize);
  check("rows", options.rows.value_or(1), 1, kLargestSize);
}

/// Takes the lines of a file and makes the stream. As long as lines come column by column, row by row and by
/// acquisition, as write_stream_csv writes them, they become detections at once. From the first other line on
/// all lines are kept and sorted in the end, which takes six times the memory.
class StreamBuilder {
 public:
  StreamBuilder(std::string name, const StreamCsvOptions& options)
      : name_(std::move(name)), options_(options) {
    check_options(options);
  }

  void take(std::size_t number, std::span<const std::uint64_t> fields) {
    check_index(name_, number, "acquisition", fields[0], acquisitions_limit_);
    check_index(name_, number, "column", fields[1], columns_limit_);
    check_index(name_, number, "row", fields[2], rows_limit_);
    found_.include(fields);
    if (fields[3] == kNoCsvValue || fields[3] == codes_ - 1) {  // all ones: no detection
      return;
    }
    if (fields[3] >= codes_) {
      fail_at_line(
          name_, number,
          fmt::format("timestamp {} is outside 0..{} (NP = {})", fields[3], codes_ - 1, options_.np));
    }
    if (pixels() <= kLargestPixelCount) {  // finish() refuses the others
      keep({static_cast<std::uint32_t>(fields[0]), static_cast<std::uint16_t>(fields[1]),
            static_cast<std::uint16_t>(fields[2]), static_cast<Timestamp>(fields[3]), number});
    }
  }

  RecordedStream finish() {
    if (found_.columns == 0 && (!options_.columns || !options_.rows || !options_.acquisitions)) {
      throw InputError(
          fmt::format("{}: no detections: columns, rows and acquisitions cannot be found and must be given "
                      "(--array-columns, --array-rows, --acquisitions)",
                      name_));
    }
    if (pixels() > kLargestPixelCount) {
      throw InputError(
          fmt::format("{}: {} x {} pixels are more than {}", name_, columns(), rows(), kLargestPixelCount));
    }
    if (!in_order_) {
      sort();
    }
    streams_.resize(columns());
    for (ColumnStream& stream : streams_) {
      finish_rows(stream, rows());
    }
    return {std::move(streams_), static_cast<int>(rows()),
            options_.acquisitions.value_or(static_cast<std::uint32_t>(found_.acquisitions))};
  }

 private:
  [[nodiscard]] std::uint64_t columns() const {
    return options_.columns ? static_cast<std::uint64_t>(*options_.columns) : found_.columns;
  }
  [[nodiscard]] std::uint64_t rows() const {
    return options_.rows ? static_cast<std::uint64_t>(*options_.rows) : found_.rows;
  }
  [[nodiscard]] std::uint64_t pixels() const { return columns() * rows(); }

  static void finish_rows(ColumnStream& stream, std::uint64_t rows) {
    while (static_cast<std::uint64_t>(stream.rows()) < rows) {
      stream.finish_row();
    }
  }

  [[noreturn]] void refuse_slot(const Line& line) const {
    fail_at_line(name_, line.number,
                 fmt::format("more than {} timestamps for acquisition {}, column {}, row {} (SLOTS = {})",
                             options_.slots, line.acquisition, line.column, line.row, options_.slots));
  }

  void keep(const Line& line) {
    const auto place = [](const Line& of) { return std::tuple(of.column, of.row, of.acquisition); };
    if (in_order_ && place(line) < place(last_)) {
      in_order_ = false;
      unfold();
    }
    if (!in_order_) {
      lines_.push_back(line);
      return;
    }
    slots_ = place(line) == place(last_) ? slots_ + 1 : 1;
    if (slots_ > options_.slots) {
      refuse_slot(line);
    }
    last_ = line;
    streams_.resize(std::max<std::size_t>(streams_.size(), line.column + std::size_t{1}));
    finish_rows(streams_[line.column], line.row);
    streams_[line.column].append({line.acquisition, line.timestamp});
  }

  /// Makes lines of the detections so far. None of them is one too many, so their numbers are not needed.
  void unfold() {
    for (std::size_t column = 0; column < streams_.size(); ++column) {
      ColumnStream& stream = streams_[column];
      stream.finish_row();
      for (int row = 0; row < stream.rows(); ++row) {
        for (const Detection& detection : stream.row(row)) {
          lines_.push_back({detection.acquisition, static_cast<std::uint16_t>(column),
                            static_cast<std::uint16_t>(row), detection.timestamp, 0});
        }
      }
      stream = {};
    }
    streams_.clear();
  }

  /// A counting sort by pixel, which keeps the order of lines and takes one pass, whatever that order is.
  void sort() {
    const auto pixel_of = [&](const Line& line) { return std::size_t{line.column} * rows() + line.row; };
    std::vector<std::size_t> begin(pixels() + 1, 0);
    for (const Line& line : lines_) {
      ++begin[pixel_of(line) + 1];
    }
    for (std::size_t i = 1; i < begin.size(); ++i) {
      begin[i] += begin[i - 1];
    }
    std::vector<Line> sorted(lines_.size());
    std::vector<std::size_t> next(begin.begin(), std::prev(begin.end()));
    for (const Line& line : lines_) {
      sorted[next[pixel_of(line)]++] = line;
    }
    lines_ = {};
    std::size_t first_excess = 0;
    streams_.resize(columns());
    for (std::size_t pixel = 0; pixel < pixels(); ++pixel) {
      const std::span<Line> of_pixel =
          std::span(sorted).subspan(begin[pixel], begin[pixel + 1] - begin[pixel]);
      const std::size_t excess = sort_pixel(of_pixel, options_.slots);
      if (excess != 0 && (first_excess == 0 || excess < first_excess)) {
        first_excess = excess;
      }
      ColumnStream& stream = streams_[pixel / rows()];
      for (const Line& line : of_pixel) {
        stream.append({line.acquisition, line.timestamp});
      }
      stream.finish_row();
    }
    if (first_excess != 0) {
      refuse_slot(*std::ranges::find(sorted, first_excess, &Line::number));
    }
  }

  std::string name_;
  StreamCsvOptions options_;
  Limit columns_limit_ = limit(options_.columns, kLargestSize, "columns:", "largest array:");
  Limit rows_limit_ = limit(options_.rows, kLargestSize, "rows:", "largest array:");
  Limit acquisitions_limit_ =
      limit(options_.acquisitions, kLargestAcquisitionCount, "acquisitions:", "largest frame:");
  std::uint64_t codes_ = std::uint64_t{1} << static_cast<unsigned>(options_.np);
  Extent found_;
  bool in_order_ = true;
  std::vector<ColumnStream> streams_;  ///< while lines are in order; their last rows may be unfinished
  Line last_{};                        ///< while lines are in order: the last one
  int slots_ = 0;                      ///< lines of its acquisition, column and row
  std::vector<Line> lines_;            ///< from the first line on that is not in order: all
};

}  // namespace

RecordedStream::RecordedStream(std::vector<ColumnStream> columns, int rows, std::uint32_t acquisitions)
    : columns_(std::move(columns)), rows_(rows), acquisitions_(acquisitions) {}

std::size_t RecordedStream::detection_count() const {
  std::size_t count = 0;
  for (const ColumnStream& column : columns_) {
    count += column.detection_count();
  }
  return count;
}

RecordedStream read_stream_csv(LineReader& lines, const StreamCsvOptions& options) {
  const std::string name = lines.path().string();
  StreamBuilder builder(name, options);
  IntegerCsv csv(
      name, kStreamCsvHeader,
      [&](std::size_t number, std::span<const std::uint64_t> fields) { builder.take(number, fields); },
      "timestamp");
  for (std::string_view line; lines.next(line);) {
    csv.take(line);
  }
  return builder.finish();
}

RecordedStream read_stream_csv(const std::filesystem::path& path, const StreamCsvOptions& options) {
  LineReader lines(path);
  return read_stream_csv(lines, options);
}

void write_stream_csv(const std::filesystem::path& path, const StreamSource& source) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  AtomicFile file(path, ending == ".gz" ? AtomicFile::Packing::kGzip : AtomicFile::Packing::kPlain);
  file.append(kStreamCsvHeader);
  file.append("\n");
  fmt::memory_buffer text;
  for (int column = 0; column < source.columns(); ++column) {
    const ColumnStream stream = source.column(column);
    for (int row = 0; row < stream.rows(); ++row) {
      text.clear();
      for (const Detection& detection : stream.row(row)) {
        fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", detection.acquisition, column, row,
                       detection.timestamp);
      }
      file.append({text.data(), text.size()});
    }
  }
  file.commit();
}

}  // namespace dtof
