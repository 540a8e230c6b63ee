// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/tdc_codes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {

TdcCodes::TdcCodes(std::vector<std::vector<double>> tables) : tables_(std::move(tables)) {
  if (tables_.empty()) {
    throw InputError("TDC code widths: no table");
  }
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    std::vector<double>& widths = tables_[t];
    for (std::size_t code = 0; code < widths.size(); ++code) {
      if (!std::isfinite(widths[code]) || widths[code] < 0.0) {
        throw InputError(
            fmt::format("TDC code widths: table {}, code {}: the width is {}, but must be at least 0", t,
                        code, widths[code]));
      }
    }
    const auto positive = [](double width) { return width > 0.0; };
    widths.erase(widths.begin(), std::ranges::find_if(widths, positive));
    while (!widths.empty() && widths.back() == 0.0) {
      widths.pop_back();
    }
    if (widths.empty()) {
      throw InputError(fmt::format("TDC code widths: table {}: no code has a width", t));
    }
  }
}

std::vector<double> TdcCodes::boundaries(std::size_t pixel, int np) const {
  const std::vector<double>& widths = tables_[pixel % tables_.size()];
  const auto codes = std::size_t{1} << static_cast<unsigned>(np);
  std::vector<double> begins = {0.0};
  for (std::size_t code = 0; code < codes; ++code) {
    begins.push_back(begins.back() + widths[code % widths.size()]);
  }
  const double scale = static_cast<double>(codes) / begins.back();
  for (double& begin : begins) {
    begin *= scale;
  }
  begins.back() = static_cast<double>(codes);
  return begins;
}

}  // namespace dtof
