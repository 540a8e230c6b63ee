// SPDX-License-Identifier: Apache-2.0
#include "on_demand/array_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_error.hpp"
#include "on_demand/sha256.hpp"

namespace dtof {
namespace {

constexpr const char* kManifest = "manifest";
constexpr std::size_t kNameDigits = 32;

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string manifest_of(const std::string& key, std::string_view bytes) {
  return fmt::format("{} {}\n{}", sha256(bytes), bytes.size(), key);
}

enum class EntryState { kAbsent, kDamaged, kWhole };

EntryState state_of(const std::filesystem::path& entry, const std::string& key) {
  std::error_code error;
  if (!std::filesystem::exists(entry, error)) {
    return EntryState::kAbsent;
  }
  const std::string bytes = contents(entry / ArrayCache::kFile);
  return contents(entry / kManifest) == manifest_of(key, bytes) ? EntryState::kWhole : EntryState::kDamaged;
}

/// An exclusive lock between programs, on a file that stays.
class Lock {
 public:
  Lock(const std::filesystem::path& file, const ArrayCache::Say& say)
      : descriptor_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) {
      throw OutputError(fmt::format("{}: cannot write: {}", file.string(), std::strerror(errno)));
    }
    constexpr auto kPause = std::chrono::milliseconds(100);
    for (bool said = false; flock(descriptor_, LOCK_EX | LOCK_NB) != 0; said = true) {
      if (errno != EWOULDBLOCK && errno != EINTR) {
        const int reason = errno;
        close(descriptor_);
        throw InputError(fmt::format("{}: cannot lock: {}", file.string(), std::strerror(reason)));
      }
      if (!said) {
        say("Another program builds the same array; waiting for it.");
      }
      std::this_thread::sleep_for(kPause);
      try {
        check_interruption();
      } catch (...) {
        close(descriptor_);
        throw;
      }
    }
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  Lock(Lock&&) = delete;
  Lock& operator=(Lock&&) = delete;
  ~Lock() { close(descriptor_); }

 private:
  int descriptor_;
};

/// A folder that is gone at the end unless it was renamed.
class WorkFolder {
 public:
  explicit WorkFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);  // of a program that was killed
    std::filesystem::create_directories(folder_, error);
    if (error) {
      throw InputError(fmt::format("{}: cannot make the folder: {}", folder_.string(), error.message()));
    }
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  WorkFolder(WorkFolder&&) = delete;
  WorkFolder& operator=(WorkFolder&&) = delete;
  ~WorkFolder() {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot make the folder: {} (DTOF_CACHE names another)", folder.string(),
                                 error.message()));
  }
}

}  // namespace

std::optional<ArrayCache> ArrayCache::of_user() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  const std::string own = variable("DTOF_CACHE");
  if (own == "off") {
    return std::nullopt;
  }
  if (!own.empty()) {
    return ArrayCache(std::filesystem::absolute(own));
  }
  const std::filesystem::path shared = variable("XDG_CACHE_HOME");
  if (shared.is_absolute()) {
    return ArrayCache(shared / "dtof");
  }
  const std::filesystem::path home = variable("HOME");
  if (home.is_absolute()) {
    return ArrayCache(home / ".cache" / "dtof");
  }
  throw InputError("no folder to keep arrays in: neither DTOF_CACHE nor XDG_CACHE_HOME nor HOME names one");
}

std::filesystem::path ArrayCache::entry(std::string_view key) const {
  return folder_ / sha256(key).substr(0, kNameDigits);
}

std::filesystem::path ArrayCache::get(const std::string& key, const Make& make, const Say& say,
                                      bool again) const {
  const std::filesystem::path place = entry(key);
  if (!again && state_of(place, key) == EntryState::kWhole) {
    return place / kFile;
  }
  make_folder(folder_);
  const Lock lock(place.string() + ".lock", say);
  const EntryState state = state_of(place, key);  // again: another program may have made it
  if (state == EntryState::kWhole && !again) {
    return place / kFile;
  }
  if (state != EntryState::kAbsent) {
    say(fmt::format("{} is damaged and is built again.", place.string()));
  }
  const WorkFolder work(place.string() + ".building");
  make(work.path());
  write_file(work.path() / kManifest, manifest_of(key, contents(work.path() / kFile)));
  std::error_code error;
  std::filesystem::remove_all(place, error);
  std::filesystem::rename(work.path(), place, error);
  if (error) {
    throw OutputError(fmt::format("{}: cannot write: {}", place.string(), error.message()));
  }
  return place / kFile;
}

}  // namespace dtof
