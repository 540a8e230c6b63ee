// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/recording/line_reader.hpp"

namespace dtof {

/// Header of a recorded stream (spec section 7).
inline constexpr std::string_view kStreamCsvHeader = "acquisition,column,row,timestamp";

/// Sizes against which a recorded stream is checked. A size that is not set becomes the largest index found
/// plus one.
struct StreamCsvOptions {
  int np = 10;    ///< timestamps are 0 .. 2^np - 1
  int slots = 2;  ///< most detections per acquisition, column and row
  std::optional<int> columns = std::nullopt;
  std::optional<int> rows = std::nullopt;
  std::optional<std::uint32_t> acquisitions = std::nullopt;
};

/// A recorded frame, held in memory.
class RecordedStream : public StreamSource {
 public:
  /// Each of `columns` must have `rows` rows.
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

/// Reads a recorded stream, plain or gzip, in pieces: only the detections are held. Lines may have any order;
/// lines in the order of write_stream_csv take least memory, 8 bytes for each. Slots follow the order of
/// lines with the same acquisition, column and row. Line ends are LF or CRLF, and the last may be missing.
/// The format of a line is that of IntegerCsv (io/csv_fields.hpp). A timestamp of -1 or of 2^np - 1 (all
/// ones) is no detection; its line counts for the sizes only. At most 65,536 columns, 65,536 rows and 2^24
/// pixels. Throws InputError
/// "<file>:<line>: <reason>" for the first illegal line.
RecordedStream read_stream_csv(const std::filesystem::path& path, const StreamCsvOptions& options);
/// The same of lines from a file or from memory.
RecordedStream read_stream_csv(LineReader& lines, const StreamCsvOptions& options);

/// Writes `source` column by column, row by row, packed with gzip if the name ends with .gz. read_stream_csv
/// returns the same stream.
void write_stream_csv(const std::filesystem::path& path, const StreamSource& source);

}  // namespace dtof
