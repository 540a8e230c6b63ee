// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "product/product.hpp"

namespace dtof {

/// Fractional bits of the read-out's results.
int result_fraction_bits(const ReadoutParameters& parameters);

/// A self-test: with the default settings, the product's schedule and `seed`, the words of the frame have the
/// checksum `expected`.
struct SelfTest {
  std::uint32_t acquisitions;
  std::uint32_t seed;
  std::uint32_t expected;
};

/// The self-test of the product's array. `acquisitions`: of its frame.
SelfTest product_self_test(const ProductRequest& request, std::uint32_t acquisitions);

/// Text of driver/dtof_product.h: sizes, settings and the look-up table from flat targets, as `dtof frame
/// --table flat` fits the table, and with a self-test its settings and checksum.
std::string product_driver_header(const ProductRequest& request, const SelfTest& self_test);

}  // namespace dtof
