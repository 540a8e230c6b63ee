// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/enlarge_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "small_arrays/models/enlarger.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A wall at 3 m, and from column `edge` on one at 1.5 m.
TargetMap two_walls(int columns, int rows, int edge) {
  TargetMap map(columns, rows, {3.0, 0.3});
  for (int column = edge; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      map.at(column, row) = {1.5, 0.9};
    }
  }
  return map;
}

EnlargeSettings small_enlarge_study() {
  EnlargeSettings settings;
  settings.sensor = find_sensor("thesis");
  settings.sensor.columns = 24;
  settings.sensor.rows = 20;
  settings.sensor.acquisitions = 1000;
  settings.klux = 1.0;
  settings.arrays = {{12, 10}, {6, 5}};
  settings.readouts = {"hispointer"};
  settings.large_readout = "hispointer";
  settings.weights = trained_weights();
  settings.seeds = 2;
  settings.threads = 2;
  return settings;
}

const EnlargeRow& find_row(const EnlargeStudy& study, const ArraySize& array, const std::string& readout,
                           const std::string& enlarger) {
  for (const EnlargeRow& row : study.rows) {
    if (row.array == array && row.readout == readout && row.enlarger == enlarger) {
      return row;
    }
  }
  throw std::out_of_range(readout + ", " + enlarger);
}

TEST(EnlargeStudy, ArraySizesAreReadAsTheyAreWritten) {
  EXPECT_EQ(parse_array_size("100x80"), (ArraySize{100, 80}));
  EXPECT_EQ(array_size_title({100, 80}), "100 x 80");
  for (const char* text : {"", "x", "100", "100x", "x80", "100x80x", "0x80", "-1x80", "100 x 80", "1e2x80"}) {
    EXPECT_THAT([&] { (void)parse_array_size(text); },
                ThrowsMessage<InputError>("array '" + std::string(text) +
                                          "': expected COLUMNSxROWS, such as 100x80"));
  }
}

TEST(EnlargeStudy, SpotsWithoutAnErrorLeaveTheErrorOfTheEnlarger) {
  // The spots are at the odd columns. Column 14 is the first one of the near wall, and midway between spots
  // of both walls: nearest takes the far one, bilinear the middle.
  const EnlargeScene scene{"walls", two_walls(24, 20, 14), {}};
  EnlargeSettings settings = small_enlarge_study();
  settings.arrays = {{12, 10}};
  const EnlargeStudy study = run_enlarge_study(settings, std::span(&scene, 1));
  const EnlargeRow& nearest = find_row(study, {12, 10}, kNoError, "nearest");
  EXPECT_DOUBLE_EQ(nearest.seeds[0].all.above_10_percent, 1.0 / 24.0);
  EXPECT_DOUBLE_EQ(nearest.seeds[0].edges.above_10_percent, 1.0 / 2.0);
  const EnlargeRow& bilinear = find_row(study, {12, 10}, kNoError, "bilinear");
  EXPECT_DOUBLE_EQ(bilinear.seeds[0].all.above_10_percent, 1.0 / 24.0);
}

TEST(EnlargeStudy, HasEveryArrayReadOutAndEnlarger) {
  const EnlargeScene scene{"walls", two_walls(24, 20, 14), {}};
  EnlargeSettings settings = small_enlarge_study();
  const EnlargeStudy study = run_enlarge_study(settings, std::span(&scene, 1));
  ASSERT_EQ(study.rows.size(), 1U + 2U * 2U * 4U);
  EXPECT_EQ(study.rows[0].enlarger, kNotEnlarged);
  EXPECT_EQ(study.rows[0].array, (ArraySize{24, 20}));
  EXPECT_THAT(enlarger_titles(), ElementsAre("nearest", "bilinear", "joint bilateral", kLearned));
  for (const EnlargeRow& row : study.rows) {
    ASSERT_EQ(row.seeds.size(), 2U);
    EXPECT_EQ(row.seeds[0].all.pixels, 480U);
    EXPECT_EQ(row.seeds[0].edges.pixels, 40U);
  }
  // A measured map cannot be better than its enlarger allows, but for luck.
  for (const ArraySize& array : settings.arrays) {
    EXPECT_GE(find_row(study, array, "hisPointer", "nearest").seeds[0].all.above_10_percent,
              find_row(study, array, kNoError, "nearest").seeds[0].all.above_10_percent);
  }
  EXPECT_TRUE(study.maps.empty());
}

TEST(EnlargeStudy, GuessedPixelsAreNotJudged) {
  EnlargeScene scene{"walls", two_walls(24, 20, 14), std::vector<bool>(480)};
  for (std::size_t row = 0; row < 20; ++row) {
    scene.guessed[row * 24 + 14] = true;  // those that nearest gets wrong
  }
  EnlargeSettings settings = small_enlarge_study();
  settings.arrays = {{12, 10}};
  const EnlargeStudy study = run_enlarge_study(settings, std::span(&scene, 1));
  const SceneScore& nearest = find_row(study, {12, 10}, kNoError, "nearest").seeds[0];
  EXPECT_EQ(nearest.all.pixels, 460U);
  EXPECT_EQ(nearest.all.above_10_percent, 0.0);
}

TEST(EnlargeStudy, ThreadsDoNotChangeAResult) {
  const EnlargeScene scene{"walls", two_walls(24, 20, 14), {}};
  EnlargeSettings settings = small_enlarge_study();
  const EnlargeStudy two = run_enlarge_study(settings, std::span(&scene, 1));
  settings.threads = 1;
  const EnlargeStudy one = run_enlarge_study(settings, std::span(&scene, 1));
  const EnlargeLight first{50.0, one};
  const EnlargeLight second{50.0, two};
  EXPECT_EQ(enlarge_csv(std::span(&first, 1)), enlarge_csv(std::span(&second, 1)));
}

TEST(EnlargeStudy, PicturesTruthLargeArrayAndEachEnlarger) {
  const EnlargeScene scene{"walls", two_walls(24, 20, 14), {}};
  EnlargeSettings settings = small_enlarge_study();
  settings.readouts = {"histogram32", "hispointer"};
  settings.pictured_scene = "walls";
  settings.pictured_array = {6, 5};
  const EnlargeStudy study = run_enlarge_study(settings, std::span(&scene, 1));
  std::vector<std::string> labels;
  for (const LabelledMap& map : study.maps) {
    labels.push_back(map.label);
    EXPECT_EQ(map.distance_m.size(), 480U);
  }
  EXPECT_THAT(labels, ElementsAre("truth", "24 x 20", "6 x 5, nearest", "6 x 5, bilinear",
                                  "6 x 5, joint bilateral", "6 x 5, learned"));
  EXPECT_EQ(study.maps[0].distance_m[13], 3.0);
  EXPECT_EQ(study.maps[0].distance_m[14], 1.5);
}

TEST(EnlargeStudy, RefusesScenesAndArraysThatDoNotFit) {
  const EnlargeScene narrow{"walls", two_walls(23, 20, 14), {}};
  EXPECT_THAT(
      [&] { (void)run_enlarge_study(small_enlarge_study(), std::span(&narrow, 1)); },
      ThrowsMessage<InputError>(HasSubstr("walls: 23 x 20 pixels are not the 24 x 20 of the large array")));
  const EnlargeScene scene{"walls", two_walls(24, 20, 14), {}};
  EnlargeSettings settings = small_enlarge_study();
  settings.arrays = {{24, 20}};
  EXPECT_THAT([&] { (void)run_enlarge_study(settings, std::span(&scene, 1)); },
              ThrowsMessage<InputError>(HasSubstr("a small array of 24 x 20 is the large one")));
}

}  // namespace
}  // namespace dtof
