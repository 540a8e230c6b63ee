// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/colour_png.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "dtof/report/colour_map.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

using Rgb = std::array<int, 3>;

struct RgbPicture {
  int width = 0;
  int height = 0;
  std::vector<png_byte> pixels;

  [[nodiscard]] Rgb at(int x, int y) const {
    const std::size_t i =
        (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3;
    return {pixels.at(i), pixels.at(i + 1), pixels.at(i + 2)};
  }
  [[nodiscard]] std::ptrdiff_t count(const Rgb& colour) const {
    std::ptrdiff_t found = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        found += at(x, y) == colour ? 1 : 0;
      }
    }
    return found;
  }
};

RgbPicture read_picture(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  RgbPicture picture{
      .width = static_cast<int>(image.width), .height = static_cast<int>(image.height), .pixels = {}};
  picture.pixels.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr), 0) << image.message;
  return picture;
}

Rgb bytes(const Colour& colour) {
  return {static_cast<int>(std::lround(colour[0] * 255.0)), static_cast<int>(std::lround(colour[1] * 255.0)),
          static_cast<int>(std::lround(colour[2] * 255.0))};
}

class ColourPngTest : public test::IoTest {};

TEST(ColourMap, ViridisMatchesItsPublishedEndsAndBrightens) {
  // matplotlib's viridis: #440154 at 0, #21918c in the middle, #fde725 at 1; the fit is good to about 1 %.
  const auto near = [](const Colour& colour, const Rgb& expected) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(colour.at(i) * 255.0, expected.at(i), 5.0) << i;
    }
  };
  near(viridis(0.0), {0x44, 0x01, 0x54});
  near(viridis(0.5), {0x21, 0x91, 0x8c});
  near(viridis(1.0), {0xfd, 0xe7, 0x25});
  EXPECT_EQ(viridis(-3.0), viridis(0.0));
  EXPECT_EQ(viridis(7.0), viridis(1.0));
  double previous = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const Colour colour = viridis(i / 100.0);
    const double luma = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
    EXPECT_GT(luma, previous);
    previous = luma;
  }
}

TEST(ColourMap, ErrorColoursAreBlueBelowAndRedAbove) {
  EXPECT_GT(blue_white_red(0.1)[2], blue_white_red(0.1)[0]);
  EXPECT_GT(blue_white_red(0.9)[0], blue_white_red(0.9)[2]);
  EXPECT_EQ(blue_white_red(0.5)[0], blue_white_red(0.5)[2]);
}

TEST_F(ColourPngTest, EveryPixelIsDrawnAsASquareOfItsColour) {
  const MapPanel panel{
      .image = {.width = 3, .height = 2, .metres = {1.0F, 2.0F, 0.0F, 1.5F, std::nanf(""), 2.0F}},
      .label = "map"};
  write_map_picture(path("a.png"), std::vector{panel}, {.title = "title", .pixel_size = 10});
  const RgbPicture picture = read_picture(path("a.png"));
  constexpr Rgb kGrey = {158, 158, 158};
  // The map's third pixel is the first whole grey square in reading order (a text edge may be as grey).
  const auto is_grey_square = [&](int x, int y) {
    for (int i = 0; i < 100; ++i) {
      if (picture.at(x + i % 10, y + i / 10) != kGrey) {
        return false;
      }
    }
    return true;
  };
  int x0 = -1;
  int y0 = -1;
  int squares = 0;
  for (int y = 0; y + 10 <= picture.height; ++y) {
    for (int x = 0; x + 10 <= picture.width; ++x) {
      if (is_grey_square(x, y) && ++squares == 1) {
        x0 = x - 20;
        y0 = y;
      }
    }
  }
  ASSERT_EQ(squares, 2);
  EXPECT_EQ(picture.at(x0 + 15, y0 + 15), kGrey);
  EXPECT_EQ(picture.at(x0, y0), bytes(viridis(0.0)));
  EXPECT_EQ(picture.at(x0 + 9, y0 + 9), bytes(viridis(0.0)));
  EXPECT_EQ(picture.at(x0 + 10, y0), bytes(viridis(1.0)));
  EXPECT_EQ(picture.at(x0, y0 + 10), bytes(viridis(0.5)));
  EXPECT_EQ(picture.at(x0 + 29, y0 + 19), bytes(viridis(1.0)));
}

TEST_F(ColourPngTest, APictureIsAByteAPixelHoweverManyValuesAndKindsItHas) {
  DepthImage ramp{.width = 100, .height = 40, .metres = {}};
  for (int i = 0; i < 4000; ++i) {
    ramp.metres.push_back(static_cast<float>(i + 1) * 1e-3F);
  }
  DepthImage errors = ramp;
  for (float& error : errors.metres) {
    error -= 2.0F;
  }
  write_map_picture(
      path("a.png"),
      std::vector<MapPanel>{{ramp, "ramp", MapKind::kDepth}, {errors, "error", MapKind::kError}},
      {.title = "title", .caption = "caption", .panels_per_row = 2, .largest_error = 1.0});
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, path("a.png").c_str()), 0) << image.message;
  EXPECT_EQ(image.format & PNG_FORMAT_FLAG_COLORMAP, PNG_FORMAT_FLAG_COLORMAP);
  EXPECT_EQ(image.colormap_entries, 256U);
  png_image_free(&image);
  // Each of a scale's colours occurs.
  const RgbPicture picture = read_picture(path("a.png"));
  for (const double position : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    EXPECT_GT(picture.count(bytes(viridis(position))), 100) << position;
    EXPECT_GT(picture.count(bytes(blue_white_red(position))), 100) << position;
  }
}

TEST_F(ColourPngTest, RangesOfPanels) {
  const std::vector<MapPanel> panels = {
      {.image = {.width = 2, .height = 1, .metres = {1.0F, 0.0F}}, .label = ""},
      {.image = {.width = 2, .height = 1, .metres = {3.0F, -1.0F}}, .label = ""},
      {.image = {.width = 2, .height = 1, .metres = {-0.5F, 0.25F}}, .label = "", .kind = MapKind::kError}};
  EXPECT_EQ(depth_range(panels).lowest, 1.0);
  EXPECT_EQ(depth_range(panels).highest, 3.0);
  EXPECT_EQ(error_range(panels), 0.25);
  const std::vector<MapPanel> flat = {{.image = {.width = 1, .height = 1, .metres = {2.0F}}, .label = ""}};
  EXPECT_NEAR(depth_range(flat).lowest, 1.98, 1e-9);
  EXPECT_EQ(error_range(flat), 1e-3);
  const std::vector<MapPanel> dark = {{.image = {.width = 1, .height = 1, .metres = {0.0F}}, .label = ""}};
  EXPECT_EQ(depth_range(dark).highest, 1.0);
}

TEST_F(ColourPngTest, Refusals) {
  const MapPanel panel{.image = {.width = 1, .height = 1, .metres = {1.0F}}, .label = ""};
  const auto refused = [&](const std::vector<MapPanel>& panels, const PictureLayout& layout,
                           const auto& matcher) {
    test::expect_input_error([&] { write_map_picture(path("a.png"), panels, layout); }, matcher);
  };
  refused({}, {.title = ""}, HasSubstr("0 maps"));
  refused({{.image = {.width = 2, .height = 1, .metres = {1.0F}}, .label = ""}}, {.title = ""},
          "picture: 1 values for 2 x 1 pixels");
  refused({panel}, {.title = "", .depth_range = ColourRange{2.0, 1.0}},
          "picture: colour range 2..1 m is empty or not finite");
  refused({{.image = {.width = 5000, .height = 1, .metres = std::vector<float>(5000, 1.0F)}, .label = ""}},
          {.title = "", .pixel_size = 10}, HasSubstr("at most 32767 are possible"));
  test::expect_input_error([&] { write_map_picture(path("none/a.png"), std::vector{panel}, {.title = ""}); },
                           EndsWith("cannot write: No such file or directory"));
  EXPECT_EQ(file_count(), 0U);
}

/// A sphere before a tilted wall with a dark corner. DTOF_KEEP_PICTURES=<folder> keeps the pictures to look
/// at.
TEST_F(ColourPngTest, PicturesOfASceneUseTheWholeScale) {
  DepthImage depth{.width = 100, .height = 80, .metres = std::vector<float>(8000)};
  DepthImage error{.width = 100, .height = 80, .metres = std::vector<float>(8000)};
  for (int row = 0; row < 80; ++row) {
    for (int column = 0; column < 100; ++column) {
      const auto i = static_cast<std::size_t>(row) * 100 + static_cast<std::size_t>(column);
      const double distance = std::hypot(column - 45, row - 40);
      const double wall = 3.0 + 0.02 * column;
      const double value = distance < 25.0 ? 1.4 - 0.4 * std::sqrt(1.0 - distance * distance / 625.0) : wall;
      depth.metres[i] = row < 15 && column > 80 ? 0.0F : static_cast<float>(value);
      error.metres[i] = row < 15 && column > 80
                            ? std::nanf("")
                            : static_cast<float>(0.06 * std::sin(column / 100.0 * 4.0 * std::numbers::pi));
    }
  }
  const char* const keep = std::getenv("DTOF_KEEP_PICTURES");
  const auto target = [&](const char* name) {
    return keep == nullptr ? path(name) : std::filesystem::path(keep) / name;
  };
  const MapPanel depth_panel{.image = depth, .label = "hisPointer"};
  const MapPanel error_panel{.image = error, .label = "hisPointer, error", .kind = MapKind::kError};
  write_map_picture(
      target("depth.png"), std::vector{depth_panel},
      {.title = "Sphere before a wall, hisPointer",
       .caption = "dtof frame --scene sphere --readout hispointer --preset thesis --klux 14 --seed 1"});
  write_map_picture(target("error.png"), std::vector{error_panel}, {.title = "Error", .largest_error = 0.05});
  std::vector<MapPanel> grid;
  for (int i = 0; i < 3; ++i) {
    grid.push_back(depth_panel);
    grid.push_back(error_panel);
  }
  grid.push_back(
      {.image = {.width = 60, .height = 50, .metres = std::vector<float>(3000, 2.0F)}, .label = "small"});
  write_map_picture(
      target("grid.png"), grid,
      {.title = "All read-outs on one scene", .caption = "caption", .panels_per_row = 4, .pixel_size = 2});

  const RgbPicture picture = read_picture(target("depth.png"));
  std::set<Rgb> colours;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      colours.insert(picture.at(x, y));
    }
  }
  EXPECT_GT(colours.size(), 150U);
  EXPECT_GT(picture.count({158, 158, 158}), 19 * 15 * 15);
  const RgbPicture all = read_picture(target("grid.png"));
  EXPECT_GE(all.width, 4 * 200 + 2 * 60);
  EXPECT_GE(all.height, 2 * 160);
  EXPECT_GT(all.count(bytes(blue_white_red(0.0))), 0);
  EXPECT_GT(all.count(bytes(viridis(1.0))), 0);
}

}  // namespace
}  // namespace dtof
