// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/npz.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::string_view kArrayEnding = ".npy";
/// An archive of tiny members would take long to list.
constexpr std::size_t kMostMembers = 65536;

[[noreturn]] void fail_damaged(const std::filesystem::path& path) {
  fail_in_file(path, "the NPZ archive is damaged or encrypted");
}

/// The members of an archive in memory, one behind the other.
class ZipReader {
 public:
  ZipReader(std::filesystem::path path, std::string_view contents)
      : path_(std::move(path)), archive_(archive_read_new(), archive_read_free) {
    if (!archive_) {
      throw std::bad_alloc();
    }
    if (archive_read_support_format_zip(archive_.get()) != ARCHIVE_OK ||
        archive_read_open_memory(archive_.get(), contents.data(), contents.size()) != ARCHIVE_OK) {
      fail_damaged(path_);
    }
  }

  /// Name of the next member; none behind the last.
  std::optional<std::string> next() {
    archive_entry* entry = nullptr;
    const int code = archive_read_next_header(archive_.get(), &entry);
    if (code == ARCHIVE_EOF) {
      return std::nullopt;
    }
    const char* const name = code == ARCHIVE_OK ? archive_entry_pathname(entry) : nullptr;
    if (name == nullptr || ++members_ > kMostMembers) {
      fail_damaged(path_);
    }
    return name;
  }

  /// Contents of the member that `next` has named.
  std::string contents() {
    std::string bytes;
    std::array<char, std::size_t{1} << 16U> chunk{};
    for (;;) {
      const la_ssize_t count = archive_read_data(archive_.get(), chunk.data(), chunk.size());
      if (count < 0) {
        fail_damaged(path_);
      }
      if (count == 0) {
        return bytes;
      }
      bytes.append(chunk.data(), static_cast<std::size_t>(count));
      if (bytes.size() > kLongestFile) {
        fail_in_file(path_, fmt::format("an array has more than {} MiB", kLongestFile >> 20U));
      }
    }
  }

 private:
  std::filesystem::path path_;
  std::unique_ptr<archive, int (*)(archive*)> archive_;
  std::size_t members_ = 0;
};

std::string_view without_ending(std::string_view name) {
  return name.ends_with(kArrayEnding) ? name.substr(0, name.size() - kArrayEnding.size()) : name;
}

std::unique_ptr<archive_entry, void (*)(archive_entry*)> make_entry(const std::string& name,
                                                                    std::size_t size) {
  std::unique_ptr<archive_entry, void (*)(archive_entry*)> entry(archive_entry_new(), archive_entry_free);
  if (!entry) {
    throw std::bad_alloc();
  }
  constexpr int kReadableByAll = 0644;
  constexpr time_t kFirstDayOfZip = 315532800;  // 1980-01-01; ZIP knows no earlier one
  archive_entry_set_pathname(entry.get(), (name + std::string(kArrayEnding)).c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(size));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), kReadableByAll);
  archive_entry_set_mtime(entry.get(), kFirstDayOfZip, 0);
  return entry;
}

}  // namespace

bool is_zip(std::string_view contents) {
  return contents.starts_with("PK\x03\x04") || contents.starts_with("PK\x05\x06");
}

std::vector<std::string> npz_names(const std::filesystem::path& path, std::string_view contents) {
  ZipReader reader(path, contents);
  std::vector<std::string> names;
  while (const auto name = reader.next()) {
    names.emplace_back(without_ending(*name));
  }
  return names;
}

NpyArray parse_npz(const std::filesystem::path& path, std::string_view contents, const std::string& name) {
  const std::vector<std::string> names = npz_names(path, contents);
  if (names.empty()) {
    fail_in_file(path, "the NPZ archive has no array");
  }
  if (name.empty() && names.size() > 1) {
    fail_in_file(path, fmt::format("the archive has {} arrays ({}); name one, as {}:{}", names.size(),
                                   fmt::join(names, ", "), path.string(), names.front()));
  }
  const std::string& wanted = name.empty() ? names.front() : name;
  ZipReader reader(path, contents);
  while (const auto member = reader.next()) {
    if (without_ending(*member) == wanted) {
      return parse_npy(path, reader.contents());
    }
  }
  fail_in_file(path, fmt::format("the archive has no array '{}', but {}", wanted, fmt::join(names, ", ")));
}

NpzWriter::NpzWriter(const std::filesystem::path& path)
    : path_(path), file_(path), archive_(archive_write_new(), archive_write_free) {
  if (!archive_) {
    throw std::bad_alloc();
  }
  const auto write = [](archive* /*archive*/, void* self, const void* bytes,
                        std::size_t count) -> la_ssize_t {
    // The library frees all it has only where writing never fails: `check` tells of the failure instead.
    auto* const writer = static_cast<NpzWriter*>(self);
    try {
      if (!writer->failure_ && !writer->abandoned_) {
        writer->file_.append({static_cast<const char*>(bytes), count});
      }
    } catch (...) {
      writer->failure_ = std::current_exception();
    }
    return static_cast<la_ssize_t>(count);
  };
  check(archive_write_set_format_zip(archive_.get()));
  check(archive_write_zip_set_compression_deflate(archive_.get()));
  check(archive_write_set_bytes_in_last_block(archive_.get(), 1));  // without zeros behind the end
  check(archive_write_open(archive_.get(), this, nullptr, write, nullptr));
}

// Freeing the archive ends it; what is not committed need not be written any more.
NpzWriter::~NpzWriter() { abandoned_ = true; }

void NpzWriter::add(const std::string& name, std::span<const std::size_t> shape,
                    std::span<const double> values) {
  add_bytes(name, "<f8", shape, values.size(),
            {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
}

void NpzWriter::add(const std::string& name, std::span<const std::size_t> shape,
                    std::span<const float> values) {
  add_bytes(name, "<f4", shape, values.size(),
            {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
}

void NpzWriter::add_bytes(const std::string& name, std::string_view dtype, std::span<const std::size_t> shape,
                          std::size_t count, std::string_view bytes) {
  if (std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>()) != count) {
    throw std::logic_error("NpzWriter: shape and number of values disagree");
  }
  const std::string header = npy_header(dtype, shape);
  const auto entry = make_entry(name, header.size() + bytes.size());
  check(archive_write_header(archive_.get(), entry.get()));
  for (std::string_view rest : {std::string_view(header), bytes}) {
    while (!rest.empty()) {
      const la_ssize_t written = archive_write_data(archive_.get(), rest.data(), rest.size());
      check(written);
      rest.remove_prefix(static_cast<std::size_t>(written));
    }
  }
}

void NpzWriter::commit() {
  check(archive_write_close(archive_.get()));
  file_.commit();
}

void NpzWriter::check(long long code) {
  if (failure_) {
    std::rethrow_exception(failure_);
  }
  if (code < ARCHIVE_OK) {
    const char* const reason = archive_error_string(archive_.get());
    throw InputError(fmt::format("{}: cannot write: {}", path_.string(), reason == nullptr ? "" : reason));
  }
}

}  // namespace dtof
