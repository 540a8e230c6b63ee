// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/grey_png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <string>

#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr int kLargestPngExtent = 65535;
// Far more than any depth camera has; a pixel takes 8 bytes while it is read.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26U;
// Deflate packs no better than this: a header that asks for more has too little data behind it.
constexpr std::uint64_t kBestPacking = 1032;

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
  int channels = 0;  ///< as decoded: grey or three colours, and alpha behind them
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

bool takes(GreyBits bits, int bit_depth) {
  return (bit_depth == 8 && bits != GreyBits::k16) || (bit_depth == 16 && bits != GreyBits::k8);
}

const char* describe(GreyBits bits) {
  return bits == GreyBits::k8 ? "an 8-bit" : bits == GreyBits::k16 ? "a 16-bit" : "an 8-bit or 16-bit";
}

bool is_readable(int colour_type, Colours colours) {
  switch (colour_type) {
    case PNG_COLOR_TYPE_GRAY:
    case PNG_COLOR_TYPE_RGB:
      return true;
    case PNG_COLOR_TYPE_GRAY_ALPHA:
    case PNG_COLOR_TYPE_RGB_ALPHA:
      return colours == Colours::kEqual;
    default:
      return false;
  }
}

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
  if (!is_readable(reader.colour_type, colours) || !takes(wanted, reader.bit_depth)) {
    return true;
  }
  if (colours == Colours::kEqual && png_get_valid(reader.png, reader.info, PNG_INFO_tRNS) != 0) {
    png_set_tRNS_to_alpha(reader.png);
  }
  if (colours == Colours::kLuminance && reader.colour_type == PNG_COLOR_TYPE_RGB) {
    constexpr double kUsualWeights = -1.0;
    png_set_gamma(reader.png, kPhotographGamma,
                  1.0 / kPhotographGamma);  // the sum is one of light, not of the file's values
    png_set_rgb_to_gray(reader.png, PNG_ERROR_ACTION_NONE, kUsualWeights, kUsualWeights);
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(reader.width) * static_cast<std::uint64_t>(reader.height);
  if (pixels > kMostPixels) {
    png_error(reader.png, "more than 2^26 pixels");
  }
  const auto bytes_per_pixel =
      static_cast<unsigned>(png_get_channels(reader.png, reader.info) * reader.bit_depth / 8);
  if (pixels * bytes_per_pixel > kBestPacking * reader.file_size) {
    png_error(reader.png, "the file ends early");
  }
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  reader.channels = png_get_channels(reader.png, reader.info);
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

/// Takes the grey of every pixel, and which pixels are transparent. Throws InputError for a pixel of a
/// colour.
void take_pixels(const std::filesystem::path& path, const PngReader& reader, GreyImage& image) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto channels = static_cast<std::size_t>(reader.channels);
  const bool alpha = channels % 2 == 0;
  const std::size_t colours = channels - (alpha ? 1 : 0);
  const int largest = (1 << image.bit_depth) - 1;
  image.values.reserve(width * static_cast<std::size_t>(image.height));
  for (std::size_t y = 0; y < reader.rows.size(); ++y) {
    const png_byte* const row = reader.rows[y];
    const auto sample = [&](std::size_t index) {
      return static_cast<std::uint16_t>(image.bit_depth == 8 ? row[index]
                                                             : row[2 * index] << 8U | row[2 * index + 1]);
    };
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t first = x * channels;
      for (std::size_t colour = 1; colour < colours; ++colour) {
        if (sample(first + colour) != sample(first)) {
          fail_in_file(
              path, fmt::format("column {}, row {}: red, green and blue are {}, {} and {}: a map is grey", x,
                                y, sample(first), sample(first + 1), sample(first + 2)));
        }
      }
      image.values.push_back(sample(first));
      if (alpha) {
        image.transparent.push_back(sample(first + colours) != largest);
      }
    }
  }
}

}  // namespace

GreyImage read_grey_png(const std::filesystem::path& path, std::string_view file, GreyBits wanted,
                        const char* purpose, Colours colours) {
  if (!file.starts_with(kPngSignature)) {
    fail_in_file(path, "not a PNG file");
  }
  PngReader reader;
  reader.rest = file;
  reader.file_size = file.size();
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_png_error, on_png_warning);
  reader.info = png_create_info_struct(reader.png);
  png_set_read_fn(reader.png, &reader, on_png_read);
  png_set_user_limits(reader.png, kLargestPngExtent, kLargestPngExtent);
  if (!decode_png(reader, wanted, colours)) {
    fail_in_file(path, fmt::format("damaged PNG: {}", reader.error));
  }
  if (reader.rows.empty()) {
    fail_in_file(path, fmt::format("{}-bit {} PNG: {} must be {} greyscale or RGB PNG", reader.bit_depth,
                                   colour_type_name(reader.colour_type), purpose, describe(wanted)));
  }
  GreyImage image{.width = reader.width,
                  .height = reader.height,
                  .bit_depth = reader.bit_depth,
                  .values = {},
                  .transparent = {}};
  take_pixels(path, reader, image);
  return image;
}

}  // namespace dtof
