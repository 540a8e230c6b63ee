// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/stream_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/csv_fields.hpp"
#include "dtof/io/input_file.hpp"

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

/// Sizes that a file's lines ask for, those without an event among them.
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

RecordedStream read_stream_csv(const std::filesystem::path& path, const StreamCsvOptions& options) {
  // A frame as text is longer than what other files may unpack to.
  return parse_stream_csv(path, read_file_or_gzip(path, kLongestFile), options);
}

RecordedStream parse_stream_csv(const std::filesystem::path& path, std::string_view text,
                                const StreamCsvOptions& options) {
  check_options(options);
  const std::string name = path.string();
  const Limit columns_limit = limit(options.columns, kLargestSize, "columns:", "largest array:");
  const Limit rows_limit = limit(options.rows, kLargestSize, "rows:", "largest array:");
  const Limit acquisitions_limit =
      limit(options.acquisitions, kLargestAcquisitionCount, "acquisitions:", "largest frame:");
  const std::uint64_t codes = std::uint64_t{1} << static_cast<unsigned>(options.np);

  Extent found;
  std::vector<Line> lines;
  lines.reserve(text.size() / 12);
  const auto take = [&](std::size_t number, std::span<const std::uint64_t> fields) {
    check_index(name, number, "acquisition", fields[0], acquisitions_limit);
    check_index(name, number, "column", fields[1], columns_limit);
    check_index(name, number, "row", fields[2], rows_limit);
    found.include(fields);
    if (fields[3] == kNoCsvValue) {
      return;
    }
    if (fields[3] >= codes) {
      fail_at_line(name, number,
                   fmt::format("timestamp {} is outside 0..{} (NP = {})", fields[3], codes - 1, options.np));
    }
    lines.push_back({static_cast<std::uint32_t>(fields[0]), static_cast<std::uint16_t>(fields[1]),
                     static_cast<std::uint16_t>(fields[2]), static_cast<Timestamp>(fields[3]), number});
  };
  parse_integer_csv(name, text, kStreamCsvHeader, take, "timestamp");
  if (found.columns == 0 && (!options.columns || !options.rows || !options.acquisitions)) {
    throw InputError(
        fmt::format("{}: no detections: columns, rows and acquisitions cannot be found and must be given "
                    "(--array-columns, --array-rows, --acquisitions)",
                    name));
  }

  const int columns = options.columns.value_or(static_cast<int>(found.columns));
  const int rows = options.rows.value_or(static_cast<int>(found.rows));
  const auto pixels = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
  if (pixels > kLargestPixelCount) {
    throw InputError(
        fmt::format("{}: {} x {} pixels are more than {}", name, columns, rows, kLargestPixelCount));
  }

  // A counting sort by pixel keeps line order and costs one pass, whatever the order of the file.
  const auto pixel_of = [&](const Line& line) {
    return static_cast<std::size_t>(line.column) * static_cast<std::size_t>(rows) + line.row;
  };
  std::vector<std::size_t> begin(pixels + 1, 0);
  for (const Line& line : lines) {
    ++begin[pixel_of(line) + 1];
  }
  for (std::size_t i = 1; i < begin.size(); ++i) {
    begin[i] += begin[i - 1];
  }
  std::vector<Line> sorted(lines.size());
  std::vector<std::size_t> next(begin.begin(), std::prev(begin.end()));
  for (const Line& line : lines) {
    sorted[next[pixel_of(line)]++] = line;
  }

  std::size_t first_excess = 0;
  std::vector<ColumnStream> streams(static_cast<std::size_t>(columns));
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const std::span<Line> of_pixel = std::span(sorted).subspan(begin[pixel], begin[pixel + 1] - begin[pixel]);
    const std::size_t excess = sort_pixel(of_pixel, options.slots);
    if (excess != 0 && (first_excess == 0 || excess < first_excess)) {
      first_excess = excess;
    }
    ColumnStream& stream = streams[pixel / static_cast<std::size_t>(rows)];
    for (const Line& line : of_pixel) {
      stream.append({line.acquisition, line.timestamp});
    }
    stream.finish_row();
  }
  if (first_excess != 0) {
    const auto line = std::find_if(sorted.begin(), sorted.end(),
                                   [&](const Line& candidate) { return candidate.number == first_excess; });
    fail_at_line(name, first_excess,
                 fmt::format("more than {} timestamps for acquisition {}, column {}, row {} (SLOTS = {})",
                             options.slots, line->acquisition, line->column, line->row, options.slots));
  }
  return {std::move(streams), rows,
          options.acquisitions.value_or(static_cast<std::uint32_t>(found.acquisitions))};
}

void write_stream_csv(const std::filesystem::path& path, const StreamSource& source) {
  AtomicFile file(path);
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
