// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Header of a recorded stream (spec section 7).
inline constexpr std::string_view kStreamCsvHeader = "acquisition,column,row,timestamp";

/// What a recorded stream is checked against. Sizes left open are the largest index found plus one.
struct StreamCsvOptions {
  int np = 10;    ///< timestamps are 0 .. 2^np - 1
  int slots = 2;  ///< lines of one acquisition, column and row
  std::optional<int> columns = std::nullopt;
  std::optional<int> rows = std::nullopt;
  std::optional<std::uint32_t> acquisitions = std::nullopt;
};

/// A frame held in memory.
class RecordedStream : public StreamSource {
 public:
  /// `columns[c]` has `rows` rows each.
  RecordedStream(std::vector<ColumnStream> columns, int rows, std::uint32_t acquisitions);

  [[nodiscard]] int columns() const override { return static_cast<int>(columns_.size()); }
  [[nodiscard]] int rows() const override { return rows_; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return acquisitions_; }
  [[nodiscard]] ColumnStream column(int index) const override {
    return columns_.at(static_cast<std::size_t>(index));
  }
  [[nodiscard]] std::size_t detection_count() const;

 private:
  std::vector<ColumnStream> columns_;
  int rows_;
  std::uint32_t acquisitions_;
};

/// Reads a recorded stream, plain or gzip. Lines may stand in any order; slot order is line order within one
/// acquisition, column and row. LF or CRLF line ends; the last line may lack one. How a line may be written
/// beside that is parse_integer_csv's (io/csv_fields.hpp); a timestamp of -1 is no event, and its line counts
/// for the sizes alone. At most 65,536 columns, 65,536 rows and 2^24 pixels. Throws InputError
/// "<file>:<line>: <reason>" for the first line that breaks the format.
RecordedStream read_stream_csv(const std::filesystem::path& path, const StreamCsvOptions& options);

/// The same of text that `path` has already given.
RecordedStream parse_stream_csv(const std::filesystem::path& path, std::string_view text,
                                const StreamCsvOptions& options);

/// Writes `source` column by column, row by row; reading it back gives the same stream.
void write_stream_csv(const std::filesystem::path& path, const StreamSource& source);

}  // namespace dtof
