// SPDX-License-Identifier: Apache-2.0
// Replacements for what Debian 12's emscripten lacks. Every file of the emscripten build (make playground)
// includes this file first.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <range/v3/algorithm.hpp>
#include <string>
#include <system_error>

// Random123 refuses processors that it does not know. Its code for RISC-V is portable C++.
#define __riscv
#include <Random123/philox.h>
#undef __riscv

// The C++ library has no std::bit_cast and no constrained algorithms. range-v3, their origin, provides them.
namespace std {

template <typename To, typename From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

// The C++ library reads integers alone. The readers hand over a whole field.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  // strtod reads blanks, a plus sign and hexadecimal digits, too.
  const bool legal = text.find_first_of("xX") == string::npos && text.find_first_of("+ \t\r\n") != 0;
  char* end = nullptr;
  const double read = legal ? strtod(text.c_str(), &end) : 0.0;
  if (!legal || end == text.c_str()) {
    return {first, errc::invalid_argument};
  }
  value = read;
  return {first + (end - text.c_str()), errc()};
}

}  // namespace std

namespace std::ranges {

using ::ranges::adjacent_find;
using ::ranges::all_of;
using ::ranges::any_of;
using ::ranges::binary_search;
using ::ranges::copy;
using ::ranges::count;
using ::ranges::count_if;
using ::ranges::equal;
using ::ranges::fill;
using ::ranges::find;
using ::ranges::find_if;
using ::ranges::max;
using ::ranges::max_element;
using ::ranges::merge;
using ::ranges::min;
using ::ranges::min_element;
using ::ranges::minmax;
using ::ranges::none_of;
using ::ranges::nth_element;
using ::ranges::partition_point;
using ::ranges::replace_if;
using ::ranges::reverse;
using ::ranges::sort;
using ::ranges::stable_sort;
using ::ranges::transform;
using ::ranges::upper_bound;

}  // namespace std::ranges
