// SPDX-License-Identifier: Apache-2.0
// Archives of NumPy.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "dtof/container/npz.hpp"
#include "dtof/core/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file(reinterpret_cast<const char*>(data), size);
  try {
    for (const std::string& name : dtof::npz_names("a.npz", file)) {
      (void)dtof::parse_npz("a.npz", file, name);
    }
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
