// SPDX-License-Identifier: Apache-2.0
// A page has no files. What sensor_file.cpp calls of the library io to read a sensor file, and the files that
// one names, says so here; the presets are compiled in and name none.
#include "dtof/core/error.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"

namespace dtof {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path) {
  throw InputError(path.string() + ": files cannot be read here");
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::size_t /*longest*/) { refuse(path); }

NpyArray read_npy(const std::filesystem::path& path) { refuse(path); }

CsvTable::CsvTable(std::filesystem::path path) : path_(std::move(path)) { refuse(path_); }
std::vector<double> CsvTable::column(std::string_view /*name*/) const { refuse(path_); }
std::vector<double> CsvTable::row(std::string_view /*name*/) const { refuse(path_); }
std::vector<std::vector<double>> CsvTable::rows() const { refuse(path_); }

}  // namespace dtof
