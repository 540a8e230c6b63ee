// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/utf8.hpp"

#include <cstddef>

namespace dtof {
namespace {

/// Bytes of the valid sequence with which `text` begins; 0 if there is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t index) { return static_cast<unsigned char>(text[index]); };
  const unsigned lead = byte(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0  // a byte of continuation, or the code of an ASCII letter
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  if (length > text.size()) {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return 0;
    }
  }
  if (length < 3) {
    return length;
  }
  // Too long for their letter, surrogates, or beyond the last letter.
  const unsigned second = byte(1);
  const bool illegal = (lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
                       (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F);
  return illegal ? 0 : length;
}

}  // namespace

std::string as_utf8(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (length == 0) {
      const auto letter = static_cast<unsigned char>(text.front());
      result += static_cast<char>(0xC0U | letter >> 6U);
      result += static_cast<char>(0x80U | (letter & 0x3FU));
      text.remove_prefix(1);
    } else {
      result += text.substr(0, length);
      text.remove_prefix(length);
    }
  }
  return result;
}

}  // namespace dtof
