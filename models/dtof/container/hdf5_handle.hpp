// SPDX-License-Identifier: Apache-2.0
// Wrappers of libhdf5 for all readers. Use them in a process of their own only (read_apart.hpp).
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dtof {

/// Suppresses libhdf5's error output while the object lives.
class QuietHdf5 {
 public:
  QuietHdf5() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;
  QuietHdf5(QuietHdf5&&) = delete;
  QuietHdf5& operator=(QuietHdf5&&) = delete;
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// Owns an identifier that libhdf5 returned, and closes it.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Opens a file for reading. Throws InputError "<path>: <reason>".
Hdf5Handle open_hdf5_file(const std::filesystem::path& path);

/// Text of an attribute, or of a dataset, that holds one string of at most `longest` bytes; none if there is
/// no such text.
std::optional<std::string> hdf5_attribute_text(hid_t object, const char* name, std::size_t longest);
std::optional<std::string> hdf5_text(hid_t dataset, std::size_t longest);

/// Extents as stored in the file; none if the dataset is damaged or is no array.
std::optional<std::vector<std::size_t>> hdf5_extents(hid_t dataset);

}  // namespace dtof
