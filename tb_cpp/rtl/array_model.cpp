// SPDX-License-Identifier: Apache-2.0
#include "rtl/array_model.hpp"

#include <fmt/format.h>

#include "dtof/core/error.hpp"

namespace dtof {

void ArrayModel::open_trace(const std::filesystem::path& file) {
  throw InputError(fmt::format("cannot write '{}': this array was built without waveforms", file.string()));
}

void ArrayModel::dump_trace(std::uint64_t /*time*/) {}

void ArrayModel::close_trace() {}

}  // namespace dtof
