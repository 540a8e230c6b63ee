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
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"

namespace dtof {
namespace {

constexpr int kLargestExtent = 65535;
// Far more than any depth camera has; a pixel takes 8 bytes while it is read.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26U;
// Deflate packs no better than this: a header that asks for more has too little data behind it.
constexpr std::uint64_t kBestPacking = 1032;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

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
  std::size_t file_size = 0;
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

/// Bits of a pixel that a purpose can take.
enum class GreyBits { k8, k16, kEither };

bool takes(GreyBits bits, int bit_depth) {
  return (bit_depth == 8 && bits != GreyBits::k16) || (bit_depth == 16 && bits != GreyBits::k8);
}

const char* describe(GreyBits bits) {
  return bits == GreyBits::k8 ? "an 8-bit" : bits == GreyBits::k16 ? "a 16-bit" : "an 8-bit or 16-bit";
}

constexpr double kGamma = 2.2;  // of photographs

/// Whether colours are turned into grey or refused.
enum class Colours { kRefused, kLuminance };

/// Returns false after a libpng error; decodes the pixels only when the format is the wanted one.
bool decode_png(PngReader& reader, GreyBits wanted, Colours colours) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) {  // NOLINT(cert-err52-cpp): libpng's error interface
    return false;
  }
  png_read_info(reader.png, reader.info);
  reader.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  reader.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  reader.bit_depth = png_get_bit_depth(reader.png, reader.info);
  reader.colour_type = png_get_color_type(reader.png, reader.info);
  const bool colour = reader.colour_type == PNG_COLOR_TYPE_RGB && colours == Colours::kLuminance;
  if ((reader.colour_type != PNG_COLOR_TYPE_GRAY && !colour) || !takes(wanted, reader.bit_depth)) {
    return true;
  }
  if (colour) {
    constexpr double kUsualWeights = -1.0;
    png_set_gamma(reader.png, kGamma, 1.0 / kGamma);  // the sum is one of light, not of the file's values
    png_set_rgb_to_gray(reader.png, PNG_ERROR_ACTION_NONE, kUsualWeights, kUsualWeights);
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(reader.width) * static_cast<std::uint64_t>(reader.height);
  if (pixels > kMostPixels) {
    png_error(reader.png, "more than 2^26 pixels");
  }
  if (pixels * static_cast<unsigned>(reader.bit_depth / 8) > kBestPacking * reader.file_size) {
    png_error(reader.png, "the file ends early");
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

struct GreyImage {
  int width = 0;
  int height = 0;
  int bit_depth = 0;  ///< 8 or 16
  std::vector<std::uint16_t> values;
};

GreyImage read_grey_png(const std::filesystem::path& path, GreyBits wanted, const char* purpose,
                        Colours colours = Colours::kRefused) {
  const std::string file = read_file(path);
  if (!std::string_view(file).starts_with(kPngSignature)) {
    fail_in_file(path, "not a PNG file");
  }
  PngReader reader;
  reader.rest = file;
  reader.file_size = file.size();
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_png_error, on_png_warning);
  reader.info = png_create_info_struct(reader.png);
  png_set_read_fn(reader.png, &reader, on_png_read);
  png_set_user_limits(reader.png, kLargestExtent, kLargestExtent);
  if (!decode_png(reader, wanted, colours)) {
    fail_in_file(path, fmt::format("damaged PNG: {}", reader.error));
  }
  if (reader.rows.empty()) {
    fail_in_file(path, fmt::format("{}-bit {} PNG: {} must be {} greyscale{} PNG", reader.bit_depth,
                                   colour_type_name(reader.colour_type), purpose, describe(wanted),
                                   colours == Colours::kLuminance ? " or RGB" : ""));
  }
  GreyImage image{
      .width = reader.width, .height = reader.height, .bit_depth = reader.bit_depth, .values = {}};
  image.values.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const auto width = static_cast<std::size_t>(image.width);
  for (const png_byte* const row : reader.rows) {
    for (std::size_t x = 0; x < width; ++x) {
      image.values.push_back(
          image.bit_depth == 8 ? row[x] : static_cast<std::uint16_t>(row[2 * x] << 8U | row[2 * x + 1]));
    }
  }
  return image;
}

/// Numbers of a file, row 0 on top.
struct NumberMap {
  int width = 0;
  int height = 0;
  int png_bits = 0;  ///< 8 or 16; 0: no PNG
  std::vector<double> values = {};
};

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
    fail_in_file(path, "the PFM header is damaged");
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
  if (std::abs(scale) != 1.0) {
    fail_in_file(path, fmt::format("PFM scale {} is not 1 or -1: the values are scaled", scale));
  }
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  if (rest.size() != width * height * sizeof(float)) {
    fail_in_file(path, fmt::format("{} x {} pixels need {} bytes, the file has {}", width, height,
                                   width * height * sizeof(float), rest.size()));
  }
  image.values.resize(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      // PFM stores the bottom row first.
      image.values[y * width + x] =
          read_float(&rest[((height - 1 - y) * width + x) * sizeof(float)], scale < 0.0);
    }
  }
  return image;
}

NumberMap read_npy_map(const std::filesystem::path& path) {
  NpyArray array = read_npy(path);
  if (array.shape.size() != 2 || array.shape[0] > kLargestExtent || array.shape[1] > kLargestExtent) {
    fail_in_file(path, fmt::format("NPY shape ({}): a map has rows and columns, each 1..{}",
                                   fmt::join(array.shape, ", "), kLargestExtent));
  }
  return {.width = static_cast<int>(array.shape[1]),
          .height = static_cast<int>(array.shape[0]),
          .png_bits = 0,
          .values = std::move(array.values)};
}

/// Tells the kinds of file apart by content.
NumberMap read_number_map(const std::filesystem::path& path, const char* purpose,
                          std::optional<double> scale) {
  if (scale && (!std::isfinite(*scale) || *scale <= 0.0)) {
    fail_in_file(path, fmt::format("the scale of {} is {}, must be a positive number", purpose, *scale));
  }
  const std::string file = read_file(path);
  const std::string_view start(file);
  if (start.starts_with(kPngSignature)) {
    const GreyImage grey = read_grey_png(path, GreyBits::kEither, purpose);
    return {.width = grey.width,
            .height = grey.height,
            .png_bits = grey.bit_depth,
            .values = {grey.values.begin(), grey.values.end()}};
  }
  if (start.starts_with("Pf") || start.starts_with("PF")) {
    return read_pfm(path, file);
  }
  if (start.starts_with("\x93NUMPY")) {
    return read_npy_map(path);
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

void append_to_string(png_structp png, png_bytep data, std::size_t length) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), length);
}

void no_flush(png_structp /*png*/) {}

}  // namespace

DepthImage read_depth_image(const std::filesystem::path& path, std::optional<double> metres_per_unit) {
  const NumberMap map = read_number_map(path, "a depth map", metres_per_unit);
  if (map.png_bits == 8 && !metres_per_unit) {
    fail_in_file(path,
                 "8-bit PNG: a depth map of 8 bits needs its scale, the metres that one unit stands for");
  }
  constexpr double kMillimetre = 1e-3;
  const double scale = metres_per_unit.value_or(map.png_bits == 16 ? kMillimetre : 1.0);
  DepthImage image{.width = map.width, .height = map.height};
  image.metres.reserve(map.values.size());
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const double metres = map.values[i] * scale;
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

ReflectivityImage read_reflectivity_image(const std::filesystem::path& path, std::optional<double> per_unit) {
  const NumberMap map = read_number_map(path, "a reflectivity map", per_unit);
  const double full_range =
      map.png_bits == 0 ? 1.0 : static_cast<double>((1U << static_cast<unsigned>(map.png_bits)) - 1);
  const double scale = per_unit.value_or(1.0 / full_range);
  ReflectivityImage image{.width = map.width, .height = map.height};
  image.values.reserve(map.values.size());
  for (std::size_t i = 0; i < map.values.size(); ++i) {
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
  const GreyImage grey = read_grey_png(path, GreyBits::k8, "a disparity map");
  DepthImage image{.width = grey.width, .height = grey.height};
  image.metres.reserve(grey.values.size());
  for (const std::uint16_t disparity : grey.values) {
    image.metres.push_back(disparity == 0 ? 0.0F : static_cast<float>(metres_at_one / disparity));
  }
  return image;
}

ReflectivityImage read_photograph(const std::filesystem::path& path) {
  const GreyImage grey = read_grey_png(path, GreyBits::k8, "a photograph", Colours::kLuminance);
  constexpr double kWhite = 255.0;
  ReflectivityImage image{.width = grey.width, .height = grey.height};
  image.values.reserve(grey.values.size());
  for (const std::uint16_t value : grey.values) {
    image.values.push_back(static_cast<float>(std::pow(value / kWhite, kGamma)));
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
