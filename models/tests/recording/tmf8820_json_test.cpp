// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf8820_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dtof/io/json_file.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

nlohmann::json capture(double distance) {
  const std::vector<int> bins(kTmf8820Bins, 7);
  return {{"dist_to_plane", distance},
          {"reference_hist", bins},
          {"hists", std::vector<std::vector<int>>(kTmf8820Zones, bins)}};
}

class Tmf8820Test : public test::IoTest {
 protected:
  void refused(const std::string& text, const std::string& reason) {
    test::expect_input_error([&] { (void)read_tmf8820_json(write("a.json", text)); },
                             path("a.json").string() + reason);
  }
};

TEST_F(Tmf8820Test, ReadsCapturesIntoACube) {
  nlohmann::json json = {capture(0.1), capture(0.2)};
  json[1]["hists"][3][5] = 1000000;
  json[0]["hists"][0][1] = 55;
  const auto captures = read_tmf8820_json(write("a.json", json.dump()));
  ASSERT_EQ(captures.size(), 2U);
  EXPECT_EQ(captures[1].histograms[3][5], 1000000U);
  EXPECT_EQ(captures[0].reference[127], 7U);
  const HistogramCube cube = tmf8820_cube(captures);
  EXPECT_EQ(cube.columns, 2);
  EXPECT_EQ(cube.rows, 9);
  EXPECT_EQ(cube.pixel(1, 3)[5], 1e6);
  EXPECT_EQ(cube.pixel(0, 0)[1], 55.0);
  EXPECT_EQ(cube.true_distance[3 * 2 + 1], 0.2);
}

TEST_F(Tmf8820Test, CountsMayHaveAFractionOfZeros) {
  nlohmann::json json = {capture(0.1)};
  json[0]["hists"][3][5] = 12.0;
  json[0]["hists"][3][6] = 4294967295.0;
  const auto captures = read_tmf8820_json(write("a.json", json.dump()));
  EXPECT_EQ(captures[0].histograms[3][5], 12U);
  EXPECT_EQ(captures[0].histograms[3][6], 4294967295U);
  json[0]["hists"][3][6] = 4294967296.0;
  refused(json.dump(), "[0].hists[3][6]: 4294967296.0 is not a photon count (0..2^32-1)");
}

TEST_F(Tmf8820Test, UnknownDistancesAndNoReference) {
  nlohmann::json json = {capture(0.1), capture(0.0), capture(0.3), capture(0.4), capture(0.5)};
  json[1]["hists"][0][0] = 99;
  json[2]["dist_to_plane"] = "NaN";
  json[3]["dist_to_plane"] = nullptr;
  json[4]["dist_to_plane"] = "0.5";
  json[4].erase("reference_hist");
  std::string text = json.dump();
  // As Python's json writes it: no string.
  text.replace(text.find("\"NaN\""), 5, "NaN");
  const auto captures = read_tmf8820_json(write("a.json", text));
  ASSERT_EQ(captures.size(), 5U);
  EXPECT_EQ(captures[0].distance, 0.1);
  for (const std::size_t unknown : {1, 2, 3}) {
    EXPECT_TRUE(std::isnan(captures[unknown].distance)) << unknown;
    EXPECT_EQ(captures[unknown].histograms[4][100], 7U);
  }
  EXPECT_EQ(captures[1].histograms[0][0], 99U);
  EXPECT_EQ(captures[4].distance, 0.5);
  EXPECT_EQ(captures[4].reference[5], 0U);
  const HistogramCube cube = tmf8820_cube(captures);
  EXPECT_TRUE(std::isnan(cube.true_distance[1]));
  EXPECT_EQ(cube.true_distance[4], 0.5);
}

TEST_F(Tmf8820Test, WhatIsNoNumberIsNullOutsideOfStringsOnly) {
  EXPECT_EQ(
      parse_json("a", R"({"a": NaN, "b": [-Infinity, Infinity, -1], "c": "NaN \" Infinity", "NaN": 1})"),
      nlohmann::json::parse(R"({"a": null, "b": [null, null, -1], "c": "NaN \" Infinity", "NaN": 1})"));
  EXPECT_EQ(parse_json("a", "\xEF\xBB\xBF[1]"), nlohmann::json::parse("[1]"));
  test::expect_input_error([] { (void)parse_json("a", "[NaN, Nothing]"); }, HasSubstr("a: parse error"));
}

TEST_F(Tmf8820Test, Refusals) {
  refused("{}", ": not an array");
  refused("[]", ": no captures");
  refused(R"([{"hists": []}])", R"([0]: "dist_to_plane" is missing)");
  nlohmann::json json = {capture(0.1), capture(-0.2)};
  refused(json.dump(), "[1].dist_to_plane: negative distance");
  json[1] = capture(0.2);
  json[1]["hists"].erase(8);
  refused(json.dump(), "[1].hists: 8 elements instead of 9");
  json[1] = capture(0.2);
  json[1]["hists"][2].push_back(1);
  refused(json.dump(), "[1].hists[2]: 129 elements instead of 128");
  json[1] = capture(0.2);
  json[1]["hists"][2][4] = -3;
  refused(json.dump(), "[1].hists[2][4]: -3 is not a photon count (0..2^32-1)");
  json[1]["hists"][2][4] = 1.5;
  refused(json.dump(), "[1].hists[2][4]: 1.5 is not a photon count (0..2^32-1)");
  const std::string whole = nlohmann::json({capture(0.1)}).dump();
  test::expect_input_error([&] { (void)read_tmf8820_json(write("a.json", whole.substr(0, 900))); },
                           HasSubstr("a.json: parse error at line 1, column"));
  test::expect_input_error([&] { (void)read_tmf8820_json(path("none.json")); },
                           EndsWith("cannot read: No such file or directory"));
}

TEST_F(Tmf8820Test, PublishedCapturesFollowTheGroundTruth) {
  const auto file = test::shared_data("sifferman_tmf8820_distance_data.json");
  DTOF_SKIP_IF_ABSENT(file);
  const auto captures = read_tmf8820_json(file);
  ASSERT_EQ(captures.size(), 159U);
  EXPECT_NEAR(captures.front().distance, 0.005, 1e-9);
  EXPECT_NEAR(captures.back().distance, 0.400, 1e-9);
  // Centre of gravity of three bins about the peak of the middle zone, against the truth beyond 50 mm.
  double n = 0.0;
  double sum_x = 0.0;
  double sum_y = 0.0;
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (const auto& one : captures) {
    if (one.distance < 0.05) {
      continue;
    }
    const auto& bins = one.histograms[4];
    const auto peak = std::max_element(bins.begin() + 1, bins.end() - 1) - bins.begin();
    double weight = 0.0;
    double moment = 0.0;
    for (auto k = peak - 1; k <= peak + 1; ++k) {
      weight += bins.at(static_cast<std::size_t>(k));
      moment += static_cast<double>(k) * bins.at(static_cast<std::size_t>(k));
    }
    const double x = moment / weight;
    n += 1.0;
    sum_x += x;
    sum_y += one.distance;
    sum_xx += x * x;
    sum_xy += x * one.distance;
  }
  const double slope = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
  constexpr double kHalfSpeedOfLight = 299792458.0 / 2.0;
  EXPECT_NEAR(slope / (kTmf8820BinWidth * kHalfSpeedOfLight), 1.0, 0.02);
  const HistogramStream stream(tmf8820_cube(captures), {.photon_budget = 1000.0});
  EXPECT_EQ(stream.columns(), 159);
  const ColumnStream column = stream.column(100);
  for (int zone = 0; zone < 9; ++zone) {
    EXPECT_NEAR(static_cast<double>(column.row(zone).size()), 1000.0, 250.0);
  }
}

}  // namespace
}  // namespace dtof
