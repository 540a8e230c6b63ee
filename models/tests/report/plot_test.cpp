// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/plot.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <set>
#include <string>

#include "dtof/core/parameters.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

PlotSeries line(const std::string& label) { return {label, {1.0, 2.0}, {1.0, 2.0}}; }

std::string drawn(const std::vector<PlotSeries>& series, const PlotLayout& layout) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "plot_test.svg";
  write_plot(file, series, layout);
  std::string picture = read_file(file);
  std::filesystem::remove(file);
  return picture;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

/// As gnuplot writes it.
std::string svg_colour(std::string_view colour) {
  const auto channel = [&](std::size_t at) {
    return std::stoi(std::string(colour.substr(at, 2)), nullptr, 16);
  };
  return fmt::format("rgb({:3}, {:3}, {:3})", channel(1), channel(3), channel(5));
}

TEST(Plot, EveryReadoutHasAStyleOfItsOwn) {
  std::set<int> markers;
  std::set<std::string_view> colours;
  for (const Readout readout : kAllReadouts) {
    const std::optional<PlotStyle> style = plot_style(readout_title(readout));
    ASSERT_TRUE(style) << readout_title(readout);
    EXPECT_EQ(style->title, readout_title(readout));
    markers.insert(style->marker);
    colours.insert(style->colour);
  }
  EXPECT_EQ(markers.size(), kAllReadouts.size());
  EXPECT_EQ(colours.size(), kAllReadouts.size());
}

TEST(Plot, ALabelHasTheStyleOfTheLongestTitle) {
  EXPECT_EQ(plot_style("hisPointer, corrected")->title, "hisPointer");
  EXPECT_EQ(plot_style("hisPointer v1")->title, "hisPointer v1");
  EXPECT_EQ(plot_style("poolPointer lean: rmse")->title, "poolPointer lean");
  EXPECT_EQ(plot_style("matched filter (single pixel)")->title, "matched filter");
  EXPECT_FALSE(plot_style("hisPointers"));
  EXPECT_FALSE(plot_style("exact"));
}

TEST(Plot, AReadoutLooksTheSameWhateverElseIsInThePicture) {
  const std::string sifh = svg_colour(plot_style("SiFH")->colour);
  const PlotLayout layout{.title = "t", .x_label = "x", .y_label = "y"};
  EXPECT_THAT(drawn({line("SiFH")}, layout), HasSubstr(sifh));
  EXPECT_THAT(drawn({line("ezPointer"), line("PiFH"), line("SiFH")}, layout), HasSubstr(sifh));
  EXPECT_THAT(drawn({line("ezPointer"), line("PiFH")}, layout), Not(HasSubstr(sifh)));
}

TEST(Plot, FurtherSeriesOfAReadoutHaveItsColourAndOtherDashes) {
  const std::string picture = drawn({line("SiFH: precision"), line("SiFH: rmse")},
                                    {.title = "t", .x_label = "x", .y_label = "y", .markers = false});
  EXPECT_GE(count(picture, svg_colour(plot_style("SiFH")->colour)), 2U);
  EXPECT_EQ(count(drawn({line("SiFH")}, {.title = "t", .x_label = "x", .y_label = "y", .markers = false}),
                  "stroke-dasharray") +
                1U,
            count(picture, "stroke-dasharray"));
}

TEST(Plot, PanelsShowEachSeriesAloneWithItsBand) {
  PlotSeries banded = line("SiFH");
  banded.low = {0.5, 1.5};
  banded.high = {1.5, 9.5};
  const std::string picture =
      drawn({banded, line("PiFH")},
            {.title = "all of them", .x_label = "x", .y_label = "y", .y_limits = {0.0}, .panels = true});
  EXPECT_EQ(count(picture, "all of them"), 1U);
  EXPECT_EQ(count(picture, ">SiFH<"), 1U);
  EXPECT_EQ(count(picture, ">PiFH<"), 1U);
  EXPECT_THAT(picture, HasSubstr("fill-opacity"));
  // Both have the axis that the band needs.
  EXPECT_EQ(count(picture, "> 8<"), 2U);
}

}  // namespace
}  // namespace dtof
