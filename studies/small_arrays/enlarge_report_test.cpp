// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "small_arrays/enlarge_study.hpp"

namespace dtof {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A score whose pixels above 3 % are `share`, and whose other figures are far from it.
SceneScore score(double share) {
  const ErrorShares all{1000, share, share / 2.0, share * 3.0};
  return {all, {200, share, share, share}, {800, share, share, share}, {}, {}, {}};
}

EnlargeRow row(const std::string& scene, const ArraySize& array, const std::string& readout,
               const std::string& enlarger, const std::vector<double>& shares) {
  EnlargeRow row{scene, array, readout, enlarger, {}};
  for (const double share : shares) {
    row.seeds.push_back(score(share));
  }
  return row;
}

/// A large array with 10 % of its pixels above 3 %, one small array that is better by the network, one that
/// is worse by all means, and one whose seeds disagree.
EnlargeStudy made_up() {
  EnlargeStudy study;
  const ArraySize large{8, 8};
  for (const std::string scene : {"hill", "town"}) {
    study.rows.push_back(row(scene, large, "poolPointer", kNotEnlarged, {0.10, 0.11, 0.09, 0.10}));
    const auto add = [&](const ArraySize& array, const std::string& readout, double nearest, double learned,
                         double spread) {
      for (const std::string& enlarger : enlarger_titles()) {
        const double share = enlarger == kLearned ? learned : nearest;
        study.rows.push_back(
            row(scene, array, readout, enlarger, {share, share + spread, share - spread, share}));
      }
    };
    add({4, 4}, "hisPointer", 0.09, 0.05, 0.01);
    add({4, 4}, "poolPointer", 0.12, 0.06, 0.01);
    add({4, 4}, kNoError, 0.02, 0.01, 0.0);
    add({2, 2}, "hisPointer", 0.20, 0.30, 0.01);
    add({2, 2}, kNoError, 0.15, 0.16, 0.0);
    add({2, 1}, "hisPointer", 0.40, 0.11, 0.09);
    add({2, 1}, kNoError, 0.03, 0.04, 0.0);
  }
  return study;
}

TEST(EnlargeReport, PoolsSharesByPixelsAndErrorsBySquares) {
  EnlargeRow first = row("hill", {8, 8}, "a", "-", {0.1, 0.2});
  EnlargeRow second = row("town", {8, 8}, "a", "-", {0.4, 0.2});
  second.seeds[0].all.pixels = 3000;
  const std::vector<const EnlargeRow*> rows = {&first, &second};
  const auto figure = [](const std::string& column) -> const EnlargeFigure& {
    for (const EnlargeFigure& one : enlarge_figures()) {
      if (column == one.column) {
        return one;
      }
    }
    throw std::out_of_range(column);
  };
  EXPECT_THAT(pooled_figure(rows, figure("above_3_percent")),
              ElementsAre(DoubleNear((0.1 + 3.0 * 0.4) / 4.0, 1e-12), DoubleNear(0.2, 1e-12)));
  EXPECT_THAT(pooled_figure(rows, figure("rmse")),
              ElementsAre(DoubleNear(std::sqrt((0.09 + 3.0 * 1.44) / 4.0), 1e-12), DoubleNear(0.6, 1e-12)));
  EXPECT_THAT(pooled_figure(rows, figure("edge_above_3_percent")),
              ElementsAre(DoubleNear(0.25, 1e-12), DoubleNear(0.2, 1e-12)));
}

TEST(EnlargeReport, EntriesHaveARowOfEachScene) {
  const EnlargeStudy study = made_up();
  const std::vector<EnlargeEntry> entries = entries_of(study);
  ASSERT_EQ(entries.size(), 1U + 7U * 4U);
  EXPECT_EQ(entries.front().enlarger, kNotEnlarged);
  for (const EnlargeEntry& entry : entries) {
    ASSERT_EQ(entry.rows.size(), 2U);
    EXPECT_EQ(entry.rows[0]->scene, "hill");
    EXPECT_EQ(entry.rows[1]->scene, "town");
  }
}

/// The page with these results; the rest is made up.
std::string page_with(const std::vector<EnlargeLight>& lights) {
  PageData data;
  add_enlarge_results(lights, data);
  for (const char* const name : {"columns", "rows", "sensor", "first_seed", "last_seed", "no_error", "maps",
                                 "nearest_m", "darkest", "picture_title", "picture", "command"}) {
    data.set(name, "{}", name);
  }
  return page_text("enlarge", data);
}

TEST(EnlargeReport, TheAnswerFollowsFromTheFigures) {
  std::vector<EnlargeLight> lights;
  lights.push_back({50.0, made_up()});
  const std::string answer = page_with(lights);
  EXPECT_THAT(answer,
              HasSubstr("has fewer pixels above 3 % than the map of the large array: **50 klux: 4 x 4**"));
  EXPECT_THAT(answer, HasSubstr("is the best of the four in 3 of 4 cases"));
  EXPECT_THAT(answer, HasSubstr("with the large array 10.00 +-1.30 % of all pixels"));
  EXPECT_THAT(answer,
              HasSubstr("* 4 x 4, learned: 5.00 +-1.30 % at best (hisPointer), **better** than the large "
                        "array and better than the best of the other enlargers (9.00 +-1.30 %, "
                        "hisPointer, nearest). Spots measured without an error would leave 1.00 %"));
  EXPECT_THAT(answer,
              HasSubstr("* 2 x 2, learned: 30.00 +-1.30 % at best (hisPointer), **worse** than the large "
                        "array and worse than the best of the other enlargers (20.00"));
  EXPECT_THAT(answer,
              HasSubstr("* 2 x 1, learned: 11.00 +-11.69 % at best (hisPointer), **not better or worse**"));
  EXPECT_THAT(answer, HasSubstr("2 of 2 maps"));
}

TEST(EnlargeReport, WithoutABetterArrayTheAnswerSaysNone) {
  EnlargeStudy study = made_up();
  std::erase_if(study.rows, [](const EnlargeRow& one) { return one.array == ArraySize{4, 4}; });
  std::vector<EnlargeLight> lights;
  lights.push_back({14.0, study});
  lights.push_back({50.0, made_up()});
  EXPECT_THAT(page_with(lights), HasSubstr("**14 klux: none; 50 klux: 4 x 4**"));
}

TEST(EnlargeReport, TablesAndCsvHaveEveryRow) {
  std::vector<EnlargeLight> lights;
  lights.push_back({50.0, made_up()});
  const std::string csv = enlarge_csv(lights);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * (1 + 7 * 4));
  EXPECT_THAT(csv, HasSubstr("klux,scene,array,readout,enlarger,pixels,rmse,rmse_low,rmse_high"));
  EXPECT_THAT(csv, HasSubstr("50,hill,8 x 8,poolPointer,-,1000,0.300000,"));
  const std::string tables = page_with(lights);
  EXPECT_THAT(tables, HasSubstr("## 50 klux"));
  const std::string by_map = tables.substr(tables.find("### Map by map"));
  EXPECT_THAT(by_map, HasSubstr("6.00 / 3.00"));      // poolPointer, as the large array
  EXPECT_THAT(by_map, Not(HasSubstr("hisPointer")));  // another read-out
}

}  // namespace
}  // namespace dtof
