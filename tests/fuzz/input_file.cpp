// SPDX-License-Identifier: Apache-2.0
#include "fuzz/input_file.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

namespace dtof::fuzz {

std::filesystem::path input_file(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("fuzz input", 0);
  if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) {
    std::abort();
  }
  return fmt::format("/proc/self/fd/{}", file);
}

}  // namespace dtof::fuzz
