// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/line_reader.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "dtof/io/csv_fields.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/unpacked_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 18U;

}  // namespace

LineReader::LineReader(std::filesystem::path path)
    : path_(std::move(path)), file_(std::make_unique<UnpackedFile>(path_)) {
  if (!refill()) {
    fail_in_file(path_, "the file is empty");
  }
  rest_ = without_byte_order_mark(rest_);
}

LineReader::LineReader(std::filesystem::path path, std::string_view text)
    : path_(std::move(path)), rest_(without_byte_order_mark(text)) {}

LineReader::~LineReader() = default;

void LineReader::fail(std::string_view reason) const { fail_at_line(path_.string(), number_, reason); }

bool LineReader::next(std::string_view& line) {
  std::size_t end = rest_.find('\n');
  while (end == std::string_view::npos && rest_.size() <= kLongestLine && refill()) {
    end = rest_.find('\n');
  }
  if (rest_.empty()) {
    return false;
  }
  ++number_;
  cut_ = end == std::string_view::npos;
  line = rest_.substr(0, end);
  rest_.remove_prefix(cut_ ? rest_.size() : end + 1);
  if (line.size() > kLongestLine) {
    fail(fmt::format("the line is longer than {} bytes", kLongestLine));
  }
  line.remove_suffix(line.ends_with('\r') ? 1 : 0);
  return true;
}

bool LineReader::refill() {
  if (!file_) {
    return false;
  }
  std::string next(rest_);
  const std::size_t kept = next.size();
  next.resize(kept + kPiece);
  const std::size_t count = file_->read(std::span(next).subspan(kept));
  next.resize(kept + count);
  buffer_ = std::move(next);
  rest_ = buffer_;
  return count > 0;
}

}  // namespace dtof
