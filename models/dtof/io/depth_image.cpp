// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/depth_image.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/grey_png.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"

namespace dtof {
namespace {

constexpr const char* kDepthMap = "a depth map";  // in refusals
constexpr int kLargestExtent = 65535;

/// Numbers of a file, row 0 on top.
struct NumberMap {
  int width = 0;
  int height = 0;
  int png_bits = 0;  ///< 8 or 16; 0: no PNG
  std::vector<double> values = {};
  std::vector<bool> transparent = {};  ///< pixels without a value; empty: there are none
};

float read_float(const char* bytes, bool little_endian) {
  std::array<char, sizeof(float)> raw{};
  std::memcpy(raw.data(), bytes, raw.size());
  if (little_endian != (std::endian::native == std::endian::little)) {
    std::ranges::reverse(raw);
  }
  return std::bit_cast<float>(raw);
}

/// Takes the next token of a PFM header, and what stands in front: white space, and comments from # to the
/// end of a line.
std::string_view next_token(const std::filesystem::path& path, std::string_view& rest) {
  constexpr std::string_view kWhiteSpace = " \t\r\n";
  while (!rest.empty() && (rest.front() == '#' || kWhiteSpace.find(rest.front()) != std::string_view::npos)) {
    rest.remove_prefix(rest.front() == '#' ? std::min(rest.find('\n'), rest.size()) : 1);
  }
  const std::size_t end = rest.substr(0, 64).find_first_of(kWhiteSpace);
  if (end == std::string_view::npos || end == 0) {
    fail_in_file(path, "the PFM header is damaged");
  }
  const std::string_view token = rest.substr(0, end);
  rest.remove_prefix(end);
  return token;
}

template <typename T>
T parse_token(const std::filesystem::path& path, std::string_view token, const char* what) {
  T value{};
  const std::string_view digits = token.substr(token.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    fail_in_file(path, fmt::format("PFM {} \"{}\" is not a number", what, token));
  }
  return value;
}

NumberMap read_pfm(const std::filesystem::path& path, std::string_view file) {
  std::string_view rest = file;
  const std::string_view magic = next_token(path, rest);
  if (magic == "PF") {
    fail_in_file(path, "colour PFM: a map must be a greyscale PFM (\"Pf\")");
  }
  NumberMap image;
  image.width = parse_token<int>(path, next_token(path, rest), "width");
  image.height = parse_token<int>(path, next_token(path, rest), "height");
  const auto scale = parse_token<double>(path, next_token(path, rest), "scale");
  if (image.width < 1 || image.height < 1 || image.width > kLargestExtent || image.height > kLargestExtent) {
    fail_in_file(
        path, fmt::format("{} x {} pixels: each must be 1..{}", image.width, image.height, kLargestExtent));
  }
  if (!std::isfinite(scale) || scale == 0.0) {
    fail_in_file(path, fmt::format("PFM scale {} is not a finite number other than 0", scale));
  }
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  const std::size_t bytes = width * height * sizeof(float);
  // One white space ends the header; a line end of CR LF is two characters, unless LF is the first byte of a
  // number.
  rest.remove_prefix(rest.starts_with("\r\n") && rest.size() >= bytes + 2 ? 2 : 1);
  if (rest.size() != bytes) {
    fail_in_file(path, fmt::format("{} x {} pixels need {} bytes, the file has {}", width, height, bytes,
                                   rest.size()));
  }
  image.values.resize(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      // PFM stores the bottom row first.
      image.values[y * width + x] =
          std::abs(scale) *
          double{read_float(&rest[((height - 1 - y) * width + x) * sizeof(float)], scale < 0.0)};
    }
  }
  return image;
}

NumberMap map_of_array(const std::filesystem::path& path, NpyArray array) {
  std::vector<std::size_t> shape = array.shape;
  while (shape.size() > 2 && shape.back() == 1) {
    shape.pop_back();
  }
  while (shape.size() > 2 && shape.front() == 1) {
    shape.erase(shape.begin());
  }
  if (shape.size() != 2 || shape[0] > kLargestExtent || shape[1] > kLargestExtent) {
    fail_in_file(path, fmt::format("NPY shape ({}): a map has rows and columns, each 1..{}",
                                   fmt::join(array.shape, ", "), kLargestExtent));
  }
  return {.width = static_cast<int>(shape[1]),
          .height = static_cast<int>(shape[0]),
          .png_bits = 0,
          .values = std::move(array.values)};
}

void check_scale(const std::filesystem::path& path, const char* purpose, std::optional<double> scale) {
  if (scale && (!std::isfinite(*scale) || *scale <= 0.0)) {
    fail_in_file(path, fmt::format("the scale of {} is {}, must be a positive number", purpose, *scale));
  }
}

/// Tells the kinds of file apart by content.
NumberMap read_number_map(const std::filesystem::path& path, const char* purpose,
                          std::optional<double> scale) {
  check_scale(path, purpose, scale);
  const std::string file = read_file(path);
  const std::string_view start(file);
  if (start.starts_with(kPngSignature)) {
    GreyImage grey = read_grey_png(path, file, GreyBits::kEither, purpose);
    return {.width = grey.width,
            .height = grey.height,
            .png_bits = grey.bit_depth,
            .values = {grey.values.begin(), grey.values.end()},
            .transparent = std::move(grey.transparent)};
  }
  if (start.starts_with("Pf") || start.starts_with("PF")) {
    return read_pfm(path, file);
  }
  if (start.starts_with("\x93NUMPY")) {
    return map_of_array(path, parse_npy(path, file));
  }
  fail_in_file(path, "neither a PNG, a PFM nor an NPY file");
}

std::string pixel_name(const NumberMap& map, std::size_t index) {
  const auto width = static_cast<std::size_t>(map.width);
  return fmt::format("column {}, row {}", index % width, index / width);
}

void check_extent(const DepthImage& image) {
  if (image.width < 1 || image.height < 1 ||
      image.metres.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    throw InputError(
        fmt::format("image: {} values for {} x {} pixels", image.metres.size(), image.width, image.height));
  }
}

/// A known depth in whole millimetres, else 0.
double millimetres(float metres) { return metres > 0.0F ? std::round(double{metres} * 1000.0) : 0.0; }

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void append_to_string(png_structp png, png_bytep data, std::size_t length) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), length);
}

void no_flush(png_structp /*png*/) {}

DepthImage depth_image_of_map(const std::filesystem::path& path, const NumberMap& map,
                              std::optional<double> metres_per_unit) {
  if (map.png_bits == 8 && !metres_per_unit) {
    fail_in_file(path,
                 "8-bit PNG: a depth map of 8 bits needs its scale, the metres that one unit stands for");
  }
  constexpr double kMillimetre = 1e-3;
  const double scale = metres_per_unit.value_or(map.png_bits == 16 ? kMillimetre : 1.0);
  DepthImage image{.width = map.width, .height = map.height};
  image.metres.reserve(map.values.size());
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const bool transparent = !map.transparent.empty() && map.transparent[i];
    const double metres = transparent ? 0.0 : map.values[i] * scale;
    if (metres < 0.0) {
      fail_in_file(path, fmt::format("{}: negative depth {} m", pixel_name(map, i), metres));
    }
    if (std::isfinite(metres) && metres > std::numeric_limits<float>::max()) {
      fail_in_file(path,
                   fmt::format("{}: a depth of {:g} m is too large a number", pixel_name(map, i), metres));
    }
    image.metres.push_back(std::isfinite(metres) ? static_cast<float>(metres) : 0.0F);
  }
  return image;
}

}  // namespace

DepthImage read_depth_image(const std::filesystem::path& path, std::optional<double> metres_per_unit) {
  return depth_image_of_map(path, read_number_map(path, kDepthMap, metres_per_unit), metres_per_unit);
}

DepthImage depth_image_of(const std::filesystem::path& path, NpyArray array,
                          std::optional<double> metres_per_unit) {
  check_scale(path, kDepthMap, metres_per_unit);
  return depth_image_of_map(path, map_of_array(path, std::move(array)), metres_per_unit);
}

ReflectivityImage read_reflectivity_image(const std::filesystem::path& path, std::optional<double> per_unit) {
  const NumberMap map = read_number_map(path, "a reflectivity map", per_unit);
  const double full_range =
      map.png_bits == 0 ? 1.0 : static_cast<double>((1U << static_cast<unsigned>(map.png_bits)) - 1);
  const double scale = per_unit.value_or(1.0 / full_range);
  ReflectivityImage image{.width = map.width, .height = map.height};
  image.values.reserve(map.values.size());
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    if (!map.transparent.empty() && map.transparent[i]) {
      fail_in_file(path, fmt::format("{}: a transparent pixel has no reflectivity", pixel_name(map, i)));
    }
    const double reflectivity = map.values[i] * scale;
    if (!std::isfinite(reflectivity) || reflectivity < 0.0) {
      fail_in_file(path, fmt::format("{}: a reflectivity of {} is not a finite number of at least 0",
                                     pixel_name(map, i), reflectivity));
    }
    image.values.push_back(static_cast<float>(reflectivity));
  }
  return image;
}

DepthImage read_disparity_png(const std::filesystem::path& path, double metres_at_one) {
  if (!std::isfinite(metres_at_one) || metres_at_one <= 0.0) {
    fail_in_file(
        path, fmt::format("depth at disparity 1 is {}, must be a positive number of metres", metres_at_one));
  }
  const GreyImage grey = read_grey_png(path, read_file(path), GreyBits::k8, "a disparity map");
  DepthImage image{.width = grey.width, .height = grey.height};
  image.metres.reserve(grey.values.size());
  for (std::size_t i = 0; i < grey.values.size(); ++i) {
    const bool known = grey.values[i] != 0 && (grey.transparent.empty() || !grey.transparent[i]);
    image.metres.push_back(known ? static_cast<float>(metres_at_one / grey.values[i]) : 0.0F);
  }
  return image;
}

ReflectivityImage read_photograph(const std::filesystem::path& path) {
  const GreyImage grey =
      read_grey_png(path, read_file(path), GreyBits::k8, "a photograph", Colours::kLuminance);
  constexpr double kWhite = 255.0;
  ReflectivityImage image{.width = grey.width, .height = grey.height};
  image.values.reserve(grey.values.size());
  for (const std::uint16_t value : grey.values) {
    image.values.push_back(static_cast<float>(std::pow(value / kWhite, kPhotographGamma)));
  }
  return image;
}

std::string depth_png_obstacle(const DepthImage& image) {
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.metres.size(); ++i) {
    if (millimetres(image.metres[i]) > std::numeric_limits<std::uint16_t>::max()) {
      return fmt::format("column {}, row {}: a depth of {} m does not fit 16 bits of millimetres", i % width,
                         i / width, image.metres[i]);
    }
  }
  return "";
}

void write_depth_png(const std::filesystem::path& path, const DepthImage& image) {
  check_extent(image);
  if (const std::string obstacle = depth_png_obstacle(image); !obstacle.empty()) {
    fail_in_file(path, obstacle);
  }
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<png_byte> pixels;
  pixels.reserve(image.metres.size() * 2);
  for (const float metres : image.metres) {
    const auto value = static_cast<std::uint16_t>(millimetres(metres));
    pixels.push_back(static_cast<png_byte>(value >> 8U));
    pixels.push_back(static_cast<png_byte>(value & 0xFFU));
  }
  std::string encoded;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, ignore_warning);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &encoded, append_to_string, no_flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 16,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (std::size_t row = 0; row < static_cast<std::size_t>(image.height); ++row) {
    png_write_row(png, &pixels[row * width * 2]);
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  write_file(path, encoded);
}

void write_pfm(const std::filesystem::path& path, const DepthImage& image) {
  static_assert(std::endian::native == std::endian::little);
  check_extent(image);
  const auto width = static_cast<std::size_t>(image.width);
  AtomicFile file(path);
  file.append(fmt::format("Pf\n{} {}\n-1.0\n", image.width, image.height));
  for (auto row = static_cast<std::size_t>(image.height); row-- > 0;) {
    file.append({reinterpret_cast<const char*>(&image.metres[row * width]), width * sizeof(float)});
  }
  file.commit();
}

}  // namespace dtof
