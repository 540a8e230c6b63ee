// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/npz.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <new>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "dtof/io/input_file.hpp"
#include "dtof/io/npy_reader.hpp"
#include "dtof/io/output_error.hpp"

namespace dtof {
namespace {

constexpr std::string_view kArrayEnding = ".npy";
std::string_view without_ending(std::string_view name) {
  return name.ends_with(kArrayEnding) ? name.substr(0, name.size() - kArrayEnding.size()) : name;
}

std::unique_ptr<archive_entry, void (*)(archive_entry*)> make_entry(const std::string& name,
                                                                    std::uint64_t size) {
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

NpzArchive::NpzArchive(std::filesystem::path path)
    : NpzArchive(path, std::make_shared<const FileBytes>(path)) {}

NpzArchive::NpzArchive(std::filesystem::path path, std::string_view contents)
    : NpzArchive(std::move(path), std::make_shared<const HeldBytes>(contents)) {}

NpzArchive::NpzArchive(std::filesystem::path path, std::shared_ptr<const ByteSource> bytes)
    : path_(std::move(path)), bytes_(std::move(bytes)), members_(read_zip_directory(path_, *bytes_)) {
  for (const ZipMember& member : members_) {
    names_.emplace_back(without_ending(member.name));
  }
}

bool NpzArchive::has(std::string_view name) const { return std::ranges::find(names_, name) != names_.end(); }

std::size_t NpzArchive::find(const std::string& name) const {
  if (names_.empty()) {
    fail_in_file(path_, "the NPZ archive has no array");
  }
  if (name.empty()) {
    if (names_.size() > 1) {
      fail_in_file(path_, fmt::format("the archive has {} arrays ({}); name one, as {}:{}", names_.size(),
                                      fmt::join(names_, ", "), path_.string(), names_.front()));
    }
    return 0;
  }
  const auto found = std::ranges::find(names_, name);
  if (found == names_.end()) {
    fail_in_file(path_, fmt::format("the archive has no array '{}', but {}", name, fmt::join(names_, ", ")));
  }
  return static_cast<std::size_t>(found - names_.begin());
}

std::unique_ptr<ArrayReader> NpzArchive::open(const std::string& name) const {
  const std::size_t index = find(name);
  const std::filesystem::path label = fmt::format("{}:{}", path_.string(), names_[index]);
  return std::make_unique<NpyReader>(label, open_zip_member(label, bytes_, members_[index]));
}

NpyArray NpzArchive::read(const std::string& name) const {
  const std::unique_ptr<ArrayReader> array = open(name);
  return read_whole(fmt::format("{}:{}", path_.string(), names_[find(name)]), *array);
}

std::vector<std::string> npz_names(const std::filesystem::path& path, std::string_view contents) {
  return NpzArchive(path, contents).names();
}

NpyArray parse_npz(const std::filesystem::path& path, std::string_view contents, const std::string& name) {
  return NpzArchive(path, contents).read(name);
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
  begin_member(name, npy_header(dtype, shape), bytes.size());
  write_member(bytes);
}

void NpzWriter::add(const std::string& name, ArrayReader& array) {
  begin_member(name, npy_header("<f8", array.shape()), std::uint64_t{array.count()} * sizeof(double));
  for_each_piece(array, [&](std::span<const double> values) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the bytes of numbers
    write_member({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  });
}

void NpzWriter::begin_member(const std::string& name, const std::string& header, std::uint64_t bytes) {
  const auto entry = make_entry(name, header.size() + bytes);
  check(archive_write_header(archive_.get(), entry.get()));
  write_member(header);
}

void NpzWriter::write_member(std::string_view bytes) {
  while (!bytes.empty()) {
    const la_ssize_t written = archive_write_data(archive_.get(), bytes.data(), bytes.size());
    check(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
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
    throw OutputError(fmt::format("{}: cannot write: {}", path_.string(), reason == nullptr ? "" : reason));
  }
}

}  // namespace dtof
