// SPDX-License-Identifier: Apache-2.0
// A page has no files. What sensor files, recordings and arrays call of the library io to open one says so
// here; the page hands over contents, and the presets are compiled in.
#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/unpacked_file.hpp"

namespace dtof {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path) {
  throw InputError(path.string() + ": files cannot be read here");
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::size_t /*longest*/) { refuse(path); }

std::string read_file_or_gzip(const std::filesystem::path& path, std::size_t /*longest*/) { refuse(path); }

void fail_in_file(const std::filesystem::path& path, std::string_view reason) {
  throw InputError(path.string() + ": " + with_visible_nul(reason));
}

struct AtomicFile::Packer {};
AtomicFile::AtomicFile(std::filesystem::path target, Packing /*packing*/) : target_(std::move(target)) {
  refuse(target_);
}
AtomicFile::~AtomicFile() = default;
void AtomicFile::append(std::string_view /*bytes*/) { refuse(target_); }
void AtomicFile::commit() { refuse(target_); }

struct GzipUnpacker::Stream {};
GzipUnpacker::~GzipUnpacker() = default;
InputBytes::InputBytes(std::filesystem::path path) : path_(std::move(path)), descriptor_(-1) {
  refuse(path_);
}
InputBytes::~InputBytes() = default;
UnpackedFile::UnpackedFile(std::filesystem::path path) : file_(std::move(path)) {}
std::size_t UnpackedFile::read(std::span<char> /*bytes*/) { return 0; }

CsvTable::CsvTable(std::filesystem::path path) : path_(std::move(path)) { refuse(path_); }
std::vector<double> CsvTable::column(std::string_view /*name*/) const { refuse(path_); }
std::vector<double> CsvTable::row(std::string_view /*name*/) const { refuse(path_); }
std::vector<std::vector<double>> CsvTable::rows() const { refuse(path_); }

}  // namespace dtof
