// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/depth_image.hpp"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "dtof/io/npy.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::FloatEq;
using ::testing::HasSubstr;

std::string png_word(std::uint32_t value) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    bytes += static_cast<char>(value >> shift & 0xFFU);
  }
  return bytes;
}

std::string png_chunk(const std::string& name, const std::string& data) {
  const std::string body = name + data;
  const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return png_word(static_cast<std::uint32_t>(data.size())) + body +
         png_word(static_cast<std::uint32_t>(checksum));
}

class DepthImageTest : public test::IoTest {
 protected:
  /// Any PNG that libpng's simplified interface can make.
  std::filesystem::path write_png(const char* name, png_uint_32 format) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 3;
    image.height = 2;
    image.format = format;
    const std::vector<png_byte> pixels(64, 100);
    png_image_write_to_file(&image, path(name).c_str(), 0, pixels.data(), 0, nullptr);
    return path(name);
  }
  /// One row of 8-bit samples.
  std::filesystem::path write_pixels(const char* name, png_uint_32 format, unsigned width,
                                     const std::vector<png_byte>& samples) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = 1;
    image.format = format;
    png_image_write_to_file(&image, path(name).c_str(), 0, samples.data(), 0, nullptr);
    return path(name);
  }
  std::filesystem::path write_palette(const char* name) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 2;
    image.height = 1;
    image.format = PNG_FORMAT_RGB_COLORMAP;
    image.colormap_entries = 2;
    const std::vector<png_byte> map = {0, 0, 0, 9, 9, 9};
    const std::vector<png_byte> pixels = {0, 1};
    png_image_write_to_file(&image, path(name).c_str(), 0, pixels.data(), 0, map.data());
    return path(name);
  }
  /// A PNG of one row from its samples as they stand in the file; `key`: contents of a tRNS chunk.
  std::filesystem::path write_raw(const char* name, int bits, int colour_type, unsigned width,
                                  const std::string& samples, const std::string& key = "") {
    const std::string row = '\0' + samples;  // no filter
    std::string packed(compressBound(static_cast<uLong>(row.size())), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(row.data()),
             static_cast<uLong>(row.size()));
    packed.resize(size);
    std::string header = png_word(width) + png_word(1);
    header += static_cast<char>(bits);
    header += static_cast<char>(colour_type);
    header += std::string(3, '\0');
    return write(name, "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) +
                           (key.empty() ? "" : png_chunk("tRNS", key)) + png_chunk("IDAT", packed) +
                           png_chunk("IEND", ""));
  }
  void refused(const std::filesystem::path& file, const std::string& reason) {
    test::expect_input_error([&] { (void)read_depth_image(file); }, file.string() + ": " + reason);
  }
};

TEST_F(DepthImageTest, PngRoundTrip) {
  const DepthImage image{
      .width = 3, .height = 2, .metres = {0.0F, 0.001F, 1.2344F, 65.535F, std::nanf(""), -0.3F}};
  write_depth_png(path("a.png"), image);
  const DepthImage back = read_depth_image(path("a.png"));
  EXPECT_EQ(back.width, 3);
  EXPECT_EQ(back.height, 2);
  EXPECT_THAT(back.metres, ElementsAre(0.0F, FloatEq(0.001F), FloatEq(1.234F), FloatEq(65.535F), 0.0F, 0.0F));
  EXPECT_EQ(back.at(0, 1), back.metres[3]);
}

TEST_F(DepthImageTest, PngRoundsToMillimetres) {
  write_depth_png(path("a.png"), {.width = 3, .height = 1, .metres = {1.2344F, 1.2346F, 0.0006F}});
  EXPECT_THAT(read_depth_image(path("a.png")).metres,
              ElementsAre(FloatEq(1.234F), FloatEq(1.235F), FloatEq(0.001F)));
}

TEST_F(DepthImageTest, PngRefusesWhatMillimetresCannotHold) {
  test::expect_input_error(
      [&] {
        write_depth_png(path("a.png"), {.width = 2, .height = 1, .metres = {1.0F, 65.6F}});
      },
      EndsWith("column 1, row 0: a depth of 65.6 m does not fit 16 bits of millimetres"));
  test::expect_input_error(
      [&] { write_depth_png(path("a.png"), {.width = 2, .height = 2, .metres = {1.0F}}); },
      "image: 1 values for 2 x 2 pixels");
  test::expect_input_error(
      [&] { write_depth_png(path("none/a.png"), {.width = 1, .height = 1, .metres = {1.0F}}); },
      EndsWith("cannot write: No such file or directory"));
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(DepthImageTest, PngRefusesOtherDepthsAndColours) {
  refused(write_png("8.png", PNG_FORMAT_GRAY),
          "8-bit PNG: a depth map of 8 bits needs its scale, the metres that one unit stands for");
  refused(write_pixels("rgb.png", PNG_FORMAT_RGB, 2, {5, 5, 5, 7, 7, 8}),
          "column 1, row 0: red, green and blue are 7, 7 and 8: a map is grey");
  refused(write_pixels("rgba.png", PNG_FORMAT_RGBA, 1, {5, 6, 5, 255}),
          "column 0, row 0: red, green and blue are 5, 6 and 5: a map is grey");
  refused(write_palette("palette.png"),
          "1-bit palette PNG: a depth map must be an 8-bit or 16-bit greyscale or RGB PNG");
  refused(write("text.png", "hello"), "neither a PNG, a PFM nor an NPY file");
  refused(path("none.png"), "cannot read: No such file or directory");
}

TEST_F(DepthImageTest, GreyInOtherFormsIsTheSameMap) {
  constexpr int kRgb = 2;
  constexpr int kGreyAlpha = 4;
  constexpr int kRgbAlpha = 6;
  const auto map = [&](const std::filesystem::path& file) { return read_depth_image(file, 0.001).metres; };
  const auto same = ElementsAre(FloatEq(0.1F), FloatEq(0.2F));
  EXPECT_THAT(map(write_raw("rgb.png", 8, kRgb, 2, "\x64\x64\x64\xc8\xc8\xc8")), same);
  EXPECT_THAT(map(write_raw("ga.png", 8, kGreyAlpha, 2, "\x64\xff\xc8\xff")), same);
  EXPECT_THAT(map(write_raw("rgba.png", 8, kRgbAlpha, 2, "\x64\x64\x64\xff\xc8\xc8\xc8\xff")), same);
  const auto deep = ElementsAre(FloatEq(1.0F), FloatEq(0.258F));
  EXPECT_THAT(map(write_raw("rgb16.png", 16, kRgb, 2, "\x03\xe8\x03\xe8\x03\xe8\x01\x02\x01\x02\x01\x02")),
              deep);
  EXPECT_THAT(map(write_raw("ga16.png", 16, kGreyAlpha, 2, "\x03\xe8\xff\xff\x01\x02\xff\xff")), deep);
}

TEST_F(DepthImageTest, TransparentPixelsAreUnknown) {
  constexpr int kGrey = 0;
  constexpr int kRgb = 2;
  constexpr int kGreyAlpha = 4;
  const auto unknown_first = ElementsAre(0.0F, FloatEq(0.258F));
  const auto map = [&](const std::filesystem::path& file) { return read_depth_image(file, 0.001).metres; };
  // Alpha below its largest value, of which no more than one step is missing.
  EXPECT_THAT(map(write_raw("a16.png", 16, kGreyAlpha, 2, "\x03\xe8\xff\xfe\x01\x02\xff\xff")),
              unknown_first);
  // The key of a tRNS chunk: one grey, or one colour.
  const std::string grey("\x03\xe8\x01\x02", 4);
  EXPECT_THAT(map(write_raw("key.png", 16, kGrey, 2, grey, "\x03\xe8")), unknown_first);
  EXPECT_THAT(map(write_raw("key8.png", 8, kGrey, 2, "\x64\xc8", std::string("\0\x64", 2))),
              ElementsAre(0.0F, FloatEq(0.2F)));
  EXPECT_THAT(map(write_raw("keyrgb.png", 8, kRgb, 2, "\x64\x64\x64\xc8\xc8\xc8",
                            std::string("\0\x64\0\x64\0\x64", 6))),
              ElementsAre(0.0F, FloatEq(0.2F)));
  EXPECT_THAT(read_disparity_png(path("key8.png"), 50.0).metres, ElementsAre(0.0F, FloatEq(0.25F)));
  test::expect_input_error([&] { (void)read_reflectivity_image(path("key.png")); },
                           EndsWith("key.png: column 0, row 0: a transparent pixel has no reflectivity"));
}

TEST_F(DepthImageTest, PngTruncatedAnywhereIsRefused) {
  DepthImage image{.width = 20, .height = 20, .metres = std::vector<float>(400)};
  for (std::size_t i = 0; i < image.metres.size(); ++i) {
    image.metres[i] = static_cast<float>(i % 37) * 0.1F;
  }
  write_depth_png(path("a.png"), image);
  const std::string whole = contents(path("a.png"));
  for (std::size_t size = 8; size < whole.size(); ++size) {
    test::expect_input_error([&] { (void)read_depth_image(write("t.png", whole.substr(0, size))); },
                             HasSubstr("t.png: damaged PNG: "));
  }
  std::string damaged = whole;
  damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] ^ 0x55);
  test::expect_input_error([&] { (void)read_depth_image(write("t.png", damaged)); },
                           HasSubstr("damaged PNG"));
}

/// PNG of a 16-bit greyscale header and no pixels.
std::string png_header(std::uint32_t width, std::uint32_t height) {
  return "\x89PNG\r\n\x1a\n" +
         png_chunk("IHDR", png_word(width) + png_word(height) + std::string("\x10\0\0\0\0", 5)) +
         png_chunk("IDAT", "") + png_chunk("IEND", "");
}

TEST_F(DepthImageTest, PngHeadersThatAskForMuchMemoryAreRefusedBeforeItIsSpent) {
  test::expect_input_error([&] { (void)read_depth_image(write("a.png", png_header(900000, 900000))); },
                           HasSubstr("a.png: damaged PNG: "));
  refused(write("a.png", png_header(65535, 65535)), "damaged PNG: more than 2^26 pixels");
  refused(write("a.png", png_header(8192, 8192)), "damaged PNG: the file ends early");
}

TEST_F(DepthImageTest, PfmRoundTripAndBothByteOrders) {
  const DepthImage image{.width = 2, .height = 2, .metres = {1.5F, 0.0F, 3.25F, 100.0F}};
  write_pfm(path("a.pfm"), image);
  const DepthImage back = read_depth_image(path("a.pfm"));
  EXPECT_EQ(back.metres, image.metres);

  std::string big = contents(path("a.pfm"));
  big.replace(big.find("-1.0"), 4, "1.0");
  for (auto value = big.end() - 16; value != big.end(); value += 4) {
    std::reverse(value, value + 4);
  }
  EXPECT_EQ(read_depth_image(write("big.pfm", big)).metres, image.metres);
}

TEST_F(DepthImageTest, PfmHeadersThatOthersWrite) {
  // 1.5 and 4.0, little-endian.
  const std::string data("\0\0\xc0\x3f\0\0\x80\x40", 8);
  const auto read = [&](const std::string& file) { return read_depth_image(write("a.pfm", file)).metres; };
  for (const char* header : {"Pf\n2 1\n-1.0\n", "Pf\r\n2 1\r\n-1.0\r\n", "Pf\n# made by me, 3 3\n2 1\n-1\n",
                             "Pf 2  1 \t -1.0 ", "Pf\n\n2\n1\n#\n# two\n-1e0\n"}) {
    EXPECT_THAT(read(header + data), ElementsAre(1.5F, 4.0F)) << header;
  }
  // The magnitude of the scale multiplies, the sign is the byte order.
  EXPECT_THAT(read("Pf\n2 1\n-0.5\n" + data), ElementsAre(0.75F, 2.0F));
  const std::string big("\x3f\xc0\0\0\x40\x80\0\0", 8);
  EXPECT_THAT(read("Pf\n2 1\n+1.0\n" + big), ElementsAre(1.5F, 4.0F));
  EXPECT_THAT(read("Pf\n2 1\n2\n" + big), ElementsAre(3.0F, 8.0F));
  // CR alone ends the header, and LF is the first byte of a number.
  const std::string line_feed("\n\0\x80\x3f\0\0\x80\x40", 8);
  EXPECT_THAT(read("Pf\n2 1\n-1.0\r" + line_feed), ElementsAre(FloatEq(1.0F + 10 * 0x1p-23F), 4.0F));
}

TEST_F(DepthImageTest, PfmUnknownValuesBecomeZero) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  write_pfm(path("a.pfm"), {.width = 3, .height = 1, .metres = {std::nanf(""), kInfinity, 0.0F}});
  EXPECT_THAT(read_depth_image(path("a.pfm")).metres, ElementsAre(0.0F, 0.0F, 0.0F));
  write_pfm(path("a.pfm"), {.width = 1, .height = 1, .metres = {-kInfinity}});
  refused(path("a.pfm"), "column 0, row 0: negative depth -inf m");
}

TEST_F(DepthImageTest, PfmRefusals) {
  const std::string one(4, '\0');
  refused(write("a.pfm", "PF\n1 1\n-1.0\n" + one + one + one),
          "colour PFM: a map must be a greyscale PFM (\"Pf\")");
  refused(write("a.pfm", "Pf\n1 1\n0\n" + one), "PFM scale 0 is not a finite number other than 0");
  refused(write("a.pfm", "Pf\n1 1\n-inf\n" + one), "PFM scale -inf is not a finite number other than 0");
  refused(write("a.pfm", "Pf\n1 1\n++1\n" + one), "PFM scale \"++1\" is not a number");
  refused(write("a.pfm", "Pf\n# a comment without an end"), "the PFM header is damaged");
  refused(write("a.pfm", "Pf\n1 x\n-1.0\n" + one), "PFM height \"x\" is not a number");
  refused(write("a.pfm", "Pf\n0 1\n-1.0\n"), "0 x 1 pixels: each must be 1..65535");
  refused(write("a.pfm", "Pf\n65536 1\n-1.0\n"), "65536 x 1 pixels: each must be 1..65535");
  refused(write("a.pfm", "Pf\n65535 1\n-1.0\n" + one), "65535 x 1 pixels need 262140 bytes, the file has 4");
  refused(write("a.pfm", "Pf\n1"), "the PFM header is damaged");
  refused(write("a.pfm", "Pf\n2 1\n-1.0\n" + one), "2 x 1 pixels need 8 bytes, the file has 4");
  refused(write("a.pfm", "Pf\n1 1\n-1.0\n" + one + "x"), "1 x 1 pixels need 4 bytes, the file has 5");
  write_pfm(path("n.pfm"), {.width = 2, .height = 1, .metres = {1.0F, -2.0F}});
  refused(path("n.pfm"), "column 1, row 0: negative depth -2 m");
}

TEST_F(DepthImageTest, TheSameMapInEveryFormat) {
  // 2 rows, 3 columns; the third pixel of row 1 is unknown.
  const std::vector<double> metres = {0.5, 1.0, 1.5, 2.0, 2.5, 0.0};
  const std::vector<float> expected(metres.begin(), metres.end());
  const std::vector<std::size_t> shape = {2, 3};
  write_depth_png(path("a.png"), {.width = 3, .height = 2, .metres = expected});
  write_pfm(path("a.pfm"), {.width = 3, .height = 2, .metres = expected});
  write_npy(path("a.npy"), shape, metres);
  for (const char* name : {"a.png", "a.pfm", "a.npy"}) {
    const DepthImage image = read_depth_image(path(name));
    EXPECT_EQ(image.width, 3) << name;
    EXPECT_EQ(image.height, 2) << name;
    EXPECT_THAT(image.metres, ::testing::Pointwise(::testing::FloatEq(), expected)) << name;
    // A scale replaces the default: a PNG's unit, else a factor.
    const double unit = std::string(name) == "a.png" ? 0.002 : 2.0;
    EXPECT_THAT(read_depth_image(path(name), unit).metres[3], FloatEq(4.0F)) << name;
  }
}

TEST_F(DepthImageTest, EightBitsOfDepthNeedAScale) {
  EXPECT_THAT(read_depth_image(write_png("8.png", PNG_FORMAT_GRAY), 0.02).metres,
              ::testing::Each(FloatEq(2.0F)));
  for (const double scale : {0.0, -1.0, static_cast<double>(std::nanf(""))}) {
    test::expect_input_error([&] { (void)read_depth_image(path("8.png"), scale); },
                             EndsWith("must be a positive number"));
  }
}

TEST_F(DepthImageTest, NpyUnknownNegativeAndOddShapes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  write_npy(path("u.npy"), std::vector<std::size_t>{1, 3}, std::vector<double>{std::nan(""), kInfinity, 0.0});
  EXPECT_THAT(read_depth_image(path("u.npy")).metres, ElementsAre(0.0F, 0.0F, 0.0F));
  write_npy(path("n.npy"), std::vector<std::size_t>{2, 2}, std::vector<double>{1.0, 1.0, -2.0, 1.0});
  refused(path("n.npy"), "column 0, row 1: negative depth -2 m");
  write_npy(path("d.npy"), std::vector<std::size_t>{1, 2, 2}, std::vector<double>{1.0, 1.0, 2.0, 1.0});
  EXPECT_THAT(read_depth_image(path("d.npy")).metres, ElementsAre(1.0F, 1.0F, 2.0F, 1.0F));
  write_npy(path("d.npy"), std::vector<std::size_t>{2, 1, 2}, std::vector<double>{1.0, 1.0, 2.0, 1.0});
  refused(path("d.npy"), "NPY shape (2, 1, 2): a map has rows and columns, each 1..65535");
}

TEST_F(DepthImageTest, NpyAxesOfOneElementAreLeftOut) {
  const std::vector<double> metres = {1, 2, 3, 4, 5, 6};
  for (const std::vector<std::size_t>& shape :
       {std::vector<std::size_t>{2, 3, 1}, std::vector<std::size_t>{1, 2, 3},
        std::vector<std::size_t>{1, 2, 3, 1}}) {
    write_npy(path("a.npy"), shape, metres);
    const DepthImage image = read_depth_image(path("a.npy"));
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.at(1, 1), 5.0F);
  }
  write_npy(path("a.npy"), std::vector<std::size_t>{1, 6, 1}, metres);
  EXPECT_EQ(read_depth_image(path("a.npy")).height, 1);
}

TEST_F(DepthImageTest, APipeIsReadOnce) {
  write_pfm(path("a.pfm"), {.width = 2, .height = 1, .metres = {1.5F, 4.0F}});
  write_depth_png(path("a.png"), {.width = 2, .height = 1, .metres = {1.5F, 4.0F}});
  write_npy(path("a.npy"), std::vector<std::size_t>{1, 2}, std::vector<double>{1.5, 4.0});
  for (const char* name : {"a.pfm", "a.png", "a.npy"}) {
    EXPECT_THAT(read_depth_image(pipe_of(contents(path(name)))).metres, ElementsAre(1.5F, 4.0F)) << name;
  }
}

TEST_F(DepthImageTest, ReflectivityOfEveryFormat) {
  EXPECT_THAT(read_reflectivity_image(write_png("8.png", PNG_FORMAT_GRAY)).values,
              ::testing::Each(FloatEq(100.0F / 255.0F)));
  EXPECT_THAT(read_reflectivity_image(path("8.png"), 0.005).values, ::testing::Each(FloatEq(0.5F)));
  // write_depth_png writes millimetres: 65.535 m is the full range of 16 bits.
  write_depth_png(path("16.png"), {.width = 2, .height = 1, .metres = {65.535F, 13.107F}});
  EXPECT_THAT(read_reflectivity_image(path("16.png")).values, ElementsAre(FloatEq(1.0F), FloatEq(0.2F)));
  write_pfm(path("r.pfm"), {.width = 2, .height = 1, .metres = {0.0F, 0.25F}});
  EXPECT_THAT(read_reflectivity_image(path("r.pfm")).values, ElementsAre(0.0F, 0.25F));
  write_npy(path("r.npy"), std::vector<std::size_t>{1, 2}, std::vector<double>{0.75, 1.0});
  const ReflectivityImage image = read_reflectivity_image(path("r.npy"));
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 1);
  EXPECT_THAT(image.values, ElementsAre(0.75F, 1.0F));
  for (const double bad : {-0.1, std::nan(""), std::numeric_limits<double>::infinity()}) {
    write_npy(path("b.npy"), std::vector<std::size_t>{1, 2}, std::vector<double>{0.5, bad});
    test::expect_input_error([&] { (void)read_reflectivity_image(path("b.npy")); },
                             HasSubstr("b.npy: column 1, row 0: a reflectivity of "));
  }
}

TEST_F(DepthImageTest, WritersRefuseSizesThatDoNotFit) {
  const DepthImage image{.width = 2, .height = 1, .metres = {1.0F}};
  for (const auto writer : {write_pfm, write_depth_png}) {
    test::expect_input_error([&] { writer(path("a"), image); }, EndsWith("image: 1 values for 2 x 1 pixels"));
  }
}

TEST_F(DepthImageTest, Disparity) {
  const DepthImage image = read_disparity_png(write_png("8.png", PNG_FORMAT_GRAY), 50.0);
  EXPECT_THAT(image.metres, ::testing::Each(FloatEq(0.5F)));
  test::expect_input_error([&] { (void)read_disparity_png(path("8.png"), -1.0); },
                           EndsWith("depth at disparity 1 is -1, must be a positive number of metres"));
  EXPECT_THAT(read_disparity_png(write_png("rgb.png", PNG_FORMAT_RGB), 50.0).metres,
              ::testing::Each(FloatEq(0.5F)));
  test::expect_input_error(
      [&] { (void)read_disparity_png(write_png("16.png", PNG_FORMAT_LINEAR_Y), 1.0); },
      EndsWith("16-bit greyscale PNG: a disparity map must be an 8-bit greyscale or RGB PNG"));
}

/// A PNG without its chunks that say how values follow from light.
std::string without_gamma(const std::string& png) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kAround = 12;  // length, name and checksum
  std::string kept = png.substr(0, kSignature);
  for (std::size_t at = kSignature; at < png.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      length = length << 8U | static_cast<unsigned char>(png[at + i]);
    }
    const std::string name = png.substr(at + 4, 4);
    if (name != "sRGB" && name != "gAMA") {
      kept += png.substr(at, length + kAround);
    }
    at += length + kAround;
  }
  return kept;
}

TEST_F(DepthImageTest, APhotographsLuminanceIsThatOfItsLight) {
  const auto light = [](int value) { return std::pow(value / 255.0, 2.2); };
  const ReflectivityImage grey = read_photograph(write_png("grey.png", PNG_FORMAT_GRAY));
  EXPECT_EQ(grey.width, 3);
  EXPECT_EQ(grey.height, 2);
  EXPECT_THAT(grey.values, ::testing::Each(::testing::FloatNear(static_cast<float>(light(100)), 1e-6F)));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 5;
  image.height = 1;
  image.format = PNG_FORMAT_RGB;
  const std::vector<png_byte> pixels = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 200, 100, 50};
  png_image_write_to_file(&image, path("rgb.png").c_str(), 0, pixels.data(), 0, nullptr);
  const std::vector<double> luminances = {0.2126, 0.7152, 0.0722, 1.0,
                                          0.2126 * light(200) + 0.7152 * light(100) + 0.0722 * light(50)};
  const std::string whole = contents(path("rgb.png"));
  EXPECT_THAT(whole, HasSubstr("sRGB"));
  const std::string bare = without_gamma(whole);
  EXPECT_LT(bare.size(), whole.size());
  for (const std::string& png : {whole, bare}) {
    const ReflectivityImage colour = read_photograph(write("read.png", png));
    ASSERT_EQ(colour.values.size(), 5U);
    for (std::size_t i = 0; i < luminances.size(); ++i) {
      EXPECT_NEAR(colour.values[i], luminances[i], 0.008) << i;  // the luminance has 8 bits, too
    }
  }
}

TEST_F(DepthImageTest, WhatIsNoPhotographIsRefused) {
  for (const auto& [format, name] : {std::pair{PNG_FORMAT_RGBA, "8-bit RGB with alpha"},
                                     {PNG_FORMAT_LINEAR_Y, "16-bit greyscale"},
                                     {PNG_FORMAT_GA, "8-bit greyscale with alpha"}}) {
    test::expect_input_error([&] { (void)read_photograph(write_png("other.png", format)); },
                             HasSubstr(std::string("other.png: ") + name +
                                       " PNG: a photograph must be an 8-bit greyscale or RGB PNG"));
  }
  test::expect_input_error([&] { (void)read_photograph(write("text.png", "hello")); },
                           EndsWith("text.png: not a PNG file"));
  test::expect_input_error([&] { (void)read_photograph(path("none.png")); },
                           HasSubstr("none.png: cannot read"));
}

TEST_F(DepthImageTest, ReadsTheMiddleburyPhotograph) {
  const auto file = test::shared_data("middlebury_Art_view1.png");
  DTOF_SKIP_IF_ABSENT(file);
  const ReflectivityImage image = read_photograph(file);
  EXPECT_EQ(image.width, 695);
  EXPECT_EQ(image.height, 555);
  EXPECT_GE(*std::ranges::min_element(image.values), 0.0F);
  EXPECT_LE(*std::ranges::max_element(image.values), 1.0F);
  EXPECT_GT(*std::ranges::max_element(image.values), 0.5F);
}

TEST_F(DepthImageTest, ReadsTheMiddleburyScene) {
  const auto file = test::shared_data("middlebury_Art_disp1.png");
  DTOF_SKIP_IF_ABSENT(file);
  const DepthImage image = read_disparity_png(file, 200.0);
  EXPECT_EQ(image.width, 695);
  EXPECT_EQ(image.height, 555);
  const auto unknown = std::ranges::count(image.metres, 0.0F);
  EXPECT_GT(unknown, 0);
  EXPECT_LT(unknown, std::ssize(image.metres) / 5);
  refused(file, "8-bit PNG: a depth map of 8 bits needs its scale, the metres that one unit stands for");
}

}  // namespace
}  // namespace dtof
