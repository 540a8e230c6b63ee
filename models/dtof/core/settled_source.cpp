// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/settled_source.hpp"

#include <fmt/format.h>

#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {

SettledSource::SettledSource(std::unique_ptr<StreamSource> source, std::uint32_t settle)
    : source_(std::move(source)), settle_(settle) {
  if (settle >= source_->acquisitions()) {
    throw InputError(fmt::format("{} acquisitions cannot be dropped at the start of a frame of {}", settle,
                                 source_->acquisitions()));
  }
}

}  // namespace dtof
