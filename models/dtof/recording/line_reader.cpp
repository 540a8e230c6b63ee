// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/line_reader.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "dtof/io/csv_fields.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 18U;

gzFile open_text(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    fail_in_file(path, "cannot read: it is a directory");
  }
  if (std::filesystem::is_character_file(path, error)) {
    fail_in_file(path, "cannot read: it is a device");
  }
  gzFile file = gzopen(path.c_str(), "rbe");
  if (file == nullptr) {
    fail_in_file(path, fmt::format("cannot read: {}", std::generic_category().message(errno)));
  }
  gzbuffer(file, kPiece);
  return file;
}

int close_nothing(gzFile_s* /*file*/) { return 0; }

}  // namespace

LineReader::LineReader(std::filesystem::path path)
    : path_(std::move(path)), file_(open_text(path_), gzclose_r) {
  if (!refill()) {
    fail_in_file(path_, "the file is empty");
  }
  rest_ = without_byte_order_mark(rest_);
}

LineReader::LineReader(std::filesystem::path path, std::string_view text)
    : path_(std::move(path)), file_(nullptr, close_nothing), rest_(without_byte_order_mark(text)) {}

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
  const int count = gzread(file_.get(), &next[kept], static_cast<unsigned>(kPiece));
  int code = Z_OK;
  const char* const reason = gzerror(file_.get(), &code);
  if (count < 0 || (code != Z_OK && code != Z_STREAM_END)) {
    fail_in_file(path_, code == Z_ERRNO
                            ? fmt::format("cannot read: {}", std::generic_category().message(errno))
                        : code == Z_BUF_ERROR ? "damaged gzip data: the file ends early"
                                              : fmt::format("damaged gzip data: {}", reason));
  }
  next.resize(kept + static_cast<std::size_t>(count));
  buffer_ = std::move(next);
  rest_ = buffer_;
  return count > 0;
}

}  // namespace dtof
