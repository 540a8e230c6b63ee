// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/hdf5_reader.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "dtof/container/asked_apart.hpp"
#include "dtof/container/hdf5_handle.hpp"
#include "dtof/container/hdf5_names.hpp"
#include "dtof/container/hdf5_numbers.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

/// Elements that are read at once from first to last, and those at any place. They have rooms of their own.
constexpr std::size_t kWindow = std::size_t{1} << 22U;
constexpr std::size_t kPlace = std::size_t{1} << 16U;

/// The dataset with room for the chunks that are in use.
Hdf5Handle with_chunk_cache(const std::filesystem::path& path, hid_t file, const std::string& name) {
  std::size_t bytes = 0;
  {
    const Hdf5Handle dataset = open_hdf5_dataset(path, file, name);
    bytes = Hdf5Numbers(path, dataset.id(), name).chunk_cache_bytes();
  }
  const Hdf5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  if (bytes > 0) {
    constexpr std::size_t kSlots = 100'003;  // a prime, above the number of chunks that are in use
    H5Pset_chunk_cache(access.id(), kSlots, bytes, H5D_CHUNK_CACHE_W0_DEFAULT);
  }
  return open_hdf5_dataset(path, file, name, access.id());
}

/// What the other process has open.
class OpenDataset {
 public:
  OpenDataset(const std::filesystem::path& path, std::string name)
      : path_(path),
        name_(std::move(name)),
        file_(open_hdf5_file(path)),
        file_bytes_(bytes_of_file()),
        dataset_(with_chunk_cache(path, file_.id(), name_)),
        numbers_(path, dataset_.id(), name_) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Hdf5Numbers& numbers() const { return numbers_; }

  /// A request for 0 elements asks for the next window.
  [[nodiscard]] std::size_t answer(const ReadRequest& request, std::span<double> room) const {
    const auto first = static_cast<std::size_t>(request.first);
    const std::size_t count = request.count == 0 ? numbers_.window(first, kWindow) : request.count;
    numbers_.read(first, room.subspan(request.count == 0 ? 0 : kWindow, count));
    if (bytes_of_file() < file_bytes_) {  // the library reads zeros behind the end
      fail_in_file(path_, "the HDF5 file is damaged or ends early");
    }
    return count;
  }

 private:
  [[nodiscard]] std::uintmax_t bytes_of_file() const {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path_, error);
    return error ? std::numeric_limits<std::uintmax_t>::max() : bytes;  // it may be removed while it is open
  }

  QuietHdf5 quiet_;
  std::filesystem::path path_;
  std::string name_;
  Hdf5Handle file_;
  std::uintmax_t file_bytes_;
  Hdf5Handle dataset_;
  Hdf5Numbers numbers_;
};

AskedApart::Opened open_dataset(const std::filesystem::path& path, const std::string& name) {
  const auto dataset = std::make_shared<OpenDataset>(path, name.empty() ? only_hdf5_name(path) : name);
  ReadAnswer said{.sizes = dataset->numbers().shape(), .names = {dataset->name()}};
  said.sizes.push_back(dataset->numbers().any_place() ? 1 : 0);
  return {.said = std::move(said), .answer = [dataset](const ReadRequest& request, std::span<double> room) {
            return dataset->answer(request, room);
          }};
}

std::vector<std::size_t> shape_of(const ReadAnswer& said) {
  return {said.sizes.begin(), said.sizes.end() - 1};
}

class Hdf5Reader final : public ArrayReader {
 public:
  Hdf5Reader(const std::filesystem::path& path, std::unique_ptr<AskedApart> apart)
      : ArrayReader(shape_of(apart->opened())),
        label_(fmt::format("{}: {}", path.string(), apart->opened().names.at(0))),
        any_place_(apart->opened().sizes.back() == 1),
        apart_(std::move(apart)) {}

  void next(std::span<double> values) override {
    while (!values.empty()) {
      if (window_.empty()) {
        window_ = answer({.first = next_, .count = 0}, 0, std::min(kWindow, count() - next_));
      }
      const std::size_t now = std::min(values.size(), window_.size());
      std::ranges::copy(window_.first(now), values.begin());
      window_ = window_.subspan(now);
      values = values.subspan(now);
      next_ += now;
    }
  }

  [[nodiscard]] bool any_place() const override { return any_place_; }

  void read_at(std::size_t first, std::span<double> values) const override {
    const std::lock_guard lock(asking_);
    while (!values.empty()) {
      const std::size_t most = std::min(kPlace, values.size());
      const std::span<const double> now = answer({.first = first, .count = most}, kWindow, most);
      std::ranges::copy(now, values.begin());
      first += now.size();
      values = values.subspan(now.size());
    }
  }

 private:
  /// Elements from `place` of the room on; at least one.
  std::span<const double> answer(const ReadRequest& request, std::size_t place, std::size_t most) const {
    const std::size_t count = apart_->ask(label_, request);
    if (count == 0 || count > most) {  // a process that is damaged says anything
      fail_in_file(label_, "the dataset is damaged, or packed by a filter that is not here");
    }
    return apart_->room().subspan(place, count);
  }

  std::filesystem::path label_;
  bool any_place_;
  std::unique_ptr<AskedApart> apart_;
  mutable std::mutex asking_;
  std::span<const double> window_;  ///< read, and not yet asked for
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<ArrayReader> open_hdf5_array(const std::filesystem::path& path, const std::string& name) {
  return std::make_unique<Hdf5Reader>(
      path, std::make_unique<AskedApart>(path, kWindow + kPlace, [&] { return open_dataset(path, name); }));
}

}  // namespace dtof
