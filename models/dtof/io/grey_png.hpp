// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace dtof {

inline constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
inline constexpr double kPhotographGamma = 2.2;

/// Accepted bits per pixel.
enum class GreyBits { k8, k16, kEither };

/// kEqual: red, green and blue must be equal. kLuminance: colours are converted to grey.
enum class Colours { kEqual, kLuminance };

struct GreyImage {
  int width = 0;
  int height = 0;
  int bit_depth = 0;                  ///< 8 or 16
  std::vector<std::uint16_t> values;  ///< [row][column], row 0 on top
  std::vector<bool> transparent;      ///< empty: no pixel is transparent
};

/// Decodes a PNG to grey values and marks transparent pixels (alpha below its largest value, or the key of a
/// tRNS chunk). `file` holds the contents of `path`; `purpose`, e.g. "a depth map", is for error messages. At
/// most 65535 pixels in a row or column and 2^26 in all. Throws InputError "<path>: <reason>" for anything
/// else, for a coloured pixel with kEqual, and for alpha with kLuminance.
GreyImage read_grey_png(const std::filesystem::path& path, std::string_view file, GreyBits wanted,
                        const char* purpose, Colours colours = Colours::kEqual);

}  // namespace dtof
