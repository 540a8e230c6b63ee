// SPDX-License-Identifier: Apache-2.0
#include "io/depth_image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"

namespace dtof {
namespace {

constexpr int kLargestExtent = 65535;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view reason) {
  throw InputError(fmt::format("{}: {}", path.string(), reason));
}

const char* colour_type_name(int type) {
  switch (type) {
    case PNG_COLOR_TYPE_GRAY:
      return "greyscale";
    case PNG_COLOR_TYPE_GRAY_ALPHA:
      return "greyscale with alpha";
    case PNG_COLOR_TYPE_PALETTE:
      return "palette";
    case PNG_COLOR_TYPE_RGB:
      return "RGB";
    case PNG_COLOR_TYPE_RGB_ALPHA:
      return "RGB with alpha";
    default:
      return "unknown";
  }
}

/// State shared with libpng's callbacks. libpng leaves errors by longjmp, which must not cross a destructor:
/// everything that owns memory lives here, outside the function that sets the jump.
struct PngReader {
  std::string_view rest;
  std::string error;
  png_structp png = nullptr;
  png_infop info = nullptr;
  int width = 0;
  int height = 0;
  int bit_depth = 0;
  int colour_type = 0;
  std::vector<png_byte> pixels;
  std::vector<png_bytep> rows;

  PngReader() = default;
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  PngReader(PngReader&&) = delete;
  PngReader& operator=(PngReader&&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_png_error(png_structp png, png_const_charp message) {
  static_cast<PngReader*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}

void on_png_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void on_png_read(png_structp png, png_bytep data, std::size_t length) {
  auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
  if (length > reader.rest.size()) {
    png_error(png, "the file ends early");
  }
  std::memcpy(data, reader.rest.data(), length);
  reader.rest.remove_prefix(length);
}

/// Returns false after a libpng error; decodes the pixels only when the format is the wanted one.
bool decode_png(PngReader& reader, int wanted_bit_depth) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) {  // NOLINT(cert-err52-cpp): libpng's error interface
    return false;
  }
  png_read_info(reader.png, reader.info);
  reader.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  reader.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  reader.bit_depth = png_get_bit_depth(reader.png, reader.info);
  reader.colour_type = png_get_color_type(reader.png, reader.info);
  if (reader.colour_type != PNG_COLOR_TYPE_GRAY || reader.bit_depth != wanted_bit_depth) {
    return true;
  }
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  reader.pixels.resize(row_bytes * static_cast<std::size_t>(reader.height));
  reader.rows.resize(static_cast<std::size_t>(reader.height));
  for (std::size_t row = 0; row < reader.rows.size(); ++row) {
    reader.rows[row] = &reader.pixels[row * row_bytes];
  }
  png_read_image(reader.png, reader.rows.data());
  png_read_end(reader.png, nullptr);
  return true;
}

/// Pixels of a greyscale PNG of `wanted_bit_depth` 8 or 16.
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> values;
};

GreyImage read_grey_png(const std::filesystem::path& path, int wanted_bit_depth, const char* purpose) {
  const std::string file = read_file(path);
  if (!std::string_view(file).starts_with(kPngSignature)) {
    fail(path, "not a PNG file");
  }
  PngReader reader;
  reader.rest = file;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_png_error, on_png_warning);
  reader.info = png_create_info_struct(reader.png);
  png_set_read_fn(reader.png, &reader, on_png_read);
  if (!decode_png(reader, wanted_bit_depth)) {
    fail(path, fmt::format("damaged PNG: {}", reader.error));
  }
  if (reader.rows.empty()) {
    fail(path, fmt::format("{}-bit {} PNG: {} must be a {}-bit greyscale PNG", reader.bit_depth,
                           colour_type_name(reader.colour_type), purpose, wanted_bit_depth));
  }
  GreyImage image{.width = reader.width, .height = reader.height, .values = {}};
  image.values.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const auto width = static_cast<std::size_t>(image.width);
  for (const png_byte* const row : reader.rows) {
    for (std::size_t x = 0; x < width; ++x) {
      image.values.push_back(
          wanted_bit_depth == 8 ? row[x] : static_cast<std::uint16_t>(row[2 * x] << 8U | row[2 * x + 1]));
    }
  }
  return image;
}

float read_float(const char* bytes, bool little_endian) {
  std::array<char, sizeof(float)> raw{};
  std::memcpy(raw.data(), bytes, raw.size());
  if (little_endian != (std::endian::native == std::endian::little)) {
    std::ranges::reverse(raw);
  }
  return std::bit_cast<float>(raw);
}

/// Takes the next token of a PFM header and the one white space behind it.
std::string_view next_token(const std::filesystem::path& path, std::string_view& rest) {
  const std::size_t end = rest.substr(0, 64).find_first_of(" \t\r\n");
  if (end == std::string_view::npos || end == 0) {
    fail(path, "the PFM header is damaged");
  }
  const std::string_view token = rest.substr(0, end);
  rest.remove_prefix(end + 1);
  return token;
}

template <typename T>
T parse_token(const std::filesystem::path& path, std::string_view token, const char* what) {
  T value{};
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc() || end != token.data() + token.size()) {
    fail(path, fmt::format("PFM {} \"{}\" is not a number", what, token));
  }
  return value;
}

void check_extent(const DepthImage& image) {
  if (image.width < 1 || image.height < 1 ||
      image.metres.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    throw InputError(
        fmt::format("image: {} values for {} x {} pixels", image.metres.size(), image.width, image.height));
  }
}

void append_to_string(png_structp png, png_bytep data, std::size_t length) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), length);
}

void no_flush(png_structp /*png*/) {}

}  // namespace

DepthImage read_depth_image(const std::filesystem::path& path) {
  const std::string file = read_file(path);
  if (std::string_view(file).starts_with(kPngSignature)) {
    return read_depth_png(path);
  }
  if (std::string_view(file).starts_with("Pf") || std::string_view(file).starts_with("PF")) {
    return read_depth_pfm(path);
  }
  fail(path, "neither a PNG nor a PFM file");
}

DepthImage read_depth_png(const std::filesystem::path& path) {
  const GreyImage grey = read_grey_png(path, 16, "a depth image");
  DepthImage image{.width = grey.width, .height = grey.height};
  image.metres.reserve(grey.values.size());
  for (const std::uint16_t millimetres : grey.values) {
    image.metres.push_back(static_cast<float>(millimetres) / 1000.0F);
  }
  return image;
}

DepthImage read_disparity_png(const std::filesystem::path& path, double metres_at_one) {
  if (!std::isfinite(metres_at_one) || metres_at_one <= 0.0) {
    fail(path, fmt::format("depth at disparity 1 is {}, must be a positive number of metres", metres_at_one));
  }
  const GreyImage grey = read_grey_png(path, 8, "a disparity map");
  DepthImage image{.width = grey.width, .height = grey.height};
  image.metres.reserve(grey.values.size());
  for (const std::uint16_t disparity : grey.values) {
    image.metres.push_back(disparity == 0 ? 0.0F : static_cast<float>(metres_at_one / disparity));
  }
  return image;
}

DepthImage read_depth_pfm(const std::filesystem::path& path) {
  const std::string file = read_file(path);
  std::string_view rest = file;
  const std::string_view magic = next_token(path, rest);
  if (magic == "PF") {
    fail(path, "colour PFM: a depth image must be a greyscale PFM (\"Pf\")");
  }
  if (magic != "Pf") {
    fail(path, "not a PFM file");
  }
  DepthImage image;
  image.width = parse_token<int>(path, next_token(path, rest), "width");
  image.height = parse_token<int>(path, next_token(path, rest), "height");
  const auto scale = parse_token<double>(path, next_token(path, rest), "scale");
  if (image.width < 1 || image.height < 1 || image.width > kLargestExtent || image.height > kLargestExtent) {
    fail(path, fmt::format("{} x {} pixels: each must be 1..{}", image.width, image.height, kLargestExtent));
  }
  if (std::abs(scale) != 1.0) {
    fail(path, fmt::format("PFM scale {} is not 1 or -1: the values are not metres", scale));
  }
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  if (rest.size() != width * height * sizeof(float)) {
    fail(path, fmt::format("{} x {} pixels need {} bytes, the file has {}", width, height,
                           width * height * sizeof(float), rest.size()));
  }
  image.metres.resize(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      // PFM stores the bottom row first.
      const float value = read_float(&rest[((height - 1 - y) * width + x) * sizeof(float)], scale < 0.0);
      if (value < 0.0F && std::isfinite(value)) {
        fail(path, fmt::format("column {}, row {}: negative depth {} m", x, y, value));
      }
      image.metres[y * width + x] = std::isfinite(value) ? value : 0.0F;
    }
  }
  return image;
}

void write_depth_png(const std::filesystem::path& path, const DepthImage& image) {
  check_extent(image);
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<png_byte> pixels;
  pixels.reserve(image.metres.size() * 2);
  for (std::size_t i = 0; i < image.metres.size(); ++i) {
    const double millimetres = image.metres[i] > 0.0F ? std::round(double{image.metres[i]} * 1000.0) : 0.0;
    if (millimetres > std::numeric_limits<std::uint16_t>::max()) {
      fail(path, fmt::format("column {}, row {}: a depth of {} m does not fit 16 bits of millimetres",
                             i % width, i / width, image.metres[i]));
    }
    const auto value = static_cast<std::uint16_t>(millimetres);
    pixels.push_back(static_cast<png_byte>(value >> 8U));
    pixels.push_back(static_cast<png_byte>(value & 0xFFU));
  }
  std::string encoded;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, on_png_warning);
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
