// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace dtof {

inline constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
inline constexpr double kPhotographGamma = 2.2;

/// Bits of a pixel that a purpose can take.
enum class GreyBits { k8, k16, kEither };

/// Whether colours are turned into grey, or red, green and blue must be equal.
enum class Colours { kEqual, kLuminance };

struct GreyImage {
  int width = 0;
  int height = 0;
  int bit_depth = 0;                  ///< 8 or 16
  std::vector<std::uint16_t> values;  ///< row 0 on top
  std::vector<bool> transparent;      ///< empty: no pixel is
};

/// The grey of a PNG, and which pixels are transparent: by alpha below its largest value, or by the key of a
/// tRNS chunk. `file`: what `path` has given; `purpose`, e.g. "a depth map", is for refusals. At most 65535
/// pixels in a row or column and 2^26 in all. Throws InputError "<path>: <reason>" for anything else, and for
/// a pixel of a colour where colours must be equal; alpha is refused where they become grey.
GreyImage read_grey_png(const std::filesystem::path& path, std::string_view file, GreyBits wanted,
                        const char* purpose, Colours colours = Colours::kEqual);

}  // namespace dtof
