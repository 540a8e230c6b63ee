// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "product/product.hpp"
#include "rtl/settings.hpp"

namespace dtof {

/// report.md of a product: clocks, accuracy by the model and estimated cost of exactly this configuration,
/// and its parameters. `settings`: the parameters of its dtof_subsystem.
std::string product_report(const ProductRequest& request, std::span<const RtlSetting> settings);

}  // namespace dtof
