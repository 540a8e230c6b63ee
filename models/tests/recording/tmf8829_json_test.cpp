// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf8829_json.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

/// Frame of two rows; `first_bin(list, entry)` tells the histograms apart.
template <typename FirstBin>
nlohmann::json frame(const FirstBin& first_bin, int columns = 2) {
  nlohmann::json results;
  nlohmann::json histograms;
  for (int row = 0; row < 2; ++row) {
    nlohmann::json result_row;
    nlohmann::json histogram_row;
    for (int column = 0; column < columns; ++column) {
      result_row.push_back({{"noise", 1},
                            {"xtalk", 2},
                            {"peaks",
                             {{{"distance", 1000 + 10 * row + column},
                               {"signal", 5},
                               {"snr", 6},
                               {"x", "-1.50"},
                               {"y", "2.0"},
                               {"z", "999.0"}}}}});
      std::vector<int> bins(kTmf8829Bins, 3);
      bins[0] = first_bin(row, column);
      histogram_row.push_back({{"bin", bins}});
    }
    results.push_back(result_row);
    histograms.push_back(histogram_row);
  }
  const nlohmann::json reference = {{{"bin", std::vector<int>(kTmf8829Bins, 9)}}};
  return {{"info", {{"frame_number", 42}}},
          {"results", results},
          {"mp_histo", histograms},
          {"ref_histo", reference}};
}

class Tmf8829Test : public test::IoTest {
 protected:
  std::filesystem::path write_log(const std::vector<nlohmann::json>& frames) {
    return write("a.json", nlohmann::json{{"Result_Set", frames}}.dump());
  }
};

TEST_F(Tmf8829Test, ReadsResultsAndHistograms) {
  const Tmf8829Log log = read_tmf8829_json(write_log({frame([](int i, int j) { return 10 * i + j; })}));
  const auto& frames = log.frames;
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(log.left_out, 0U);
  EXPECT_EQ(frames[0].number, 42);
  EXPECT_NEAR(frames[0].result(1, 0).peaks.at(0).distance.value(), 1.010, 1e-12);
  EXPECT_NEAR(frames[0].result(1, 0).peaks.at(0).x.value(), -0.0015, 1e-12);
  EXPECT_EQ(frames[0].histogram(1, 1)[0], 11U);
  EXPECT_EQ(frames[0].reference.at(0).at(0), 9U);
  EXPECT_FALSE(frames[0].only_row_zero());
  const HistogramCube cube = tmf8829_cube(log);
  EXPECT_NEAR(cube.bin_width, 815e-12, 1e-18);
  EXPECT_EQ(cube.columns, 2);
  EXPECT_EQ(cube.rows, 2);
  EXPECT_EQ(cube.pixel(1, 0)[0], 1.0);
  EXPECT_NEAR(cube.true_distance[1], 1.001, 1e-12);
}

TEST_F(Tmf8829Test, MoreColumnsThanRows) {
  const HistogramCube cube =
      tmf8829_cube(read_tmf8829_json(write_log({frame([](int i, int j) { return 10 * i + j; }, 3)})));
  EXPECT_EQ(cube.columns, 3);
  EXPECT_EQ(cube.rows, 2);
  EXPECT_EQ(cube.pixel(2, 1)[0], 12.0);
}

TEST_F(Tmf8829Test, RepeatedHistogramsBelongToRowZero) {
  auto json = frame([](int i, int) { return 10 * i; });
  json["results"][0][1]["peaks"] = nlohmann::json::array();
  const Tmf8829Log log = read_tmf8829_json(write_log({json, frame([](int i, int) { return 10 * i + 5; })}));
  EXPECT_TRUE(log.frames[0].only_row_zero());
  const HistogramCube cube = tmf8829_cube(log);
  EXPECT_EQ(cube.columns, 2);
  EXPECT_EQ(cube.rows, 2);
  EXPECT_EQ(cube.pixel(0, 1)[0], 10.0);
  EXPECT_EQ(cube.pixel(1, 1)[0], 15.0);
  EXPECT_NEAR(cube.true_distance[0], 1.0, 1e-12);
  EXPECT_TRUE(std::isnan(cube.true_distance[2]));
  EXPECT_NEAR(cube.true_distance[3], 1.001, 1e-12);
}

TEST_F(Tmf8829Test, EveryListMustRepeatItsHistogram) {
  const auto only_row_zero = [&](int odd_list) {
    const auto first_bin = [&](int i, int j) { return 10 * i + (i == odd_list ? j : 0); };
    return read_tmf8829_json(write_log({frame(first_bin)})).frames.at(0).only_row_zero();
  };
  EXPECT_FALSE(only_row_zero(0));
  EXPECT_FALSE(only_row_zero(1));
  EXPECT_TRUE(only_row_zero(2));
}

TEST_F(Tmf8829Test, EveryMemberOfAResultMayBeMissing) {
  auto json = frame([](int i, int j) { return 10 * i + j; });
  json.erase("info");
  json.erase("ref_histo");
  json["results"][0][0] = {{"peaks", {{{"distance", 1234.5}}}}};
  json["results"][0][1] = nlohmann::json::object();
  json["results"][1][0] = {{"peaks", {{{"snr", 3}, {"distance", nullptr}}}}, {"noise", 4.0}};
  const Tmf8829Log log = read_tmf8829_json(write_log({json}));
  ASSERT_EQ(log.frames.size(), 1U);
  const Tmf8829Frame& read = log.frames[0];
  EXPECT_FALSE(read.number.has_value());
  EXPECT_TRUE(read.reference.empty());
  EXPECT_NEAR(read.result(0, 0).peaks.at(0).distance.value(), 1.2345, 1e-12);
  EXPECT_FALSE(read.result(0, 0).peaks.at(0).x.has_value());
  EXPECT_FALSE(read.result(0, 0).noise.has_value());
  EXPECT_TRUE(read.result(0, 1).peaks.empty());
  EXPECT_EQ(read.result(1, 0).noise, 4);
  EXPECT_EQ(read.result(1, 0).peaks.at(0).snr, 3);
  const HistogramCube cube = tmf8829_cube(log);
  EXPECT_NEAR(cube.true_distance[0], 1.2345, 1e-12);
  EXPECT_TRUE(std::isnan(cube.true_distance[1]));
  EXPECT_TRUE(std::isnan(cube.true_distance[2]));
  EXPECT_NEAR(cube.true_distance[3], 1.011, 1e-12);
  EXPECT_EQ(cube.pixel(1, 0)[0], 1.0);
}

TEST_F(Tmf8829Test, FramesWithoutResultsOrHistogramsAreLeftOutAndCounted) {
  const auto first_bin = [](int i, int j) { return 10 * i + j; };
  auto no_results = frame(first_bin);
  no_results.erase("results");
  auto empty_results = frame(first_bin);
  empty_results["results"] = nlohmann::json::array();
  auto no_histograms = frame(first_bin);
  no_histograms["mp_histo"] = nullptr;
  const Tmf8829Log log = read_tmf8829_json(
      write_log({no_results, frame(first_bin), empty_results, no_histograms, frame(first_bin)}));
  EXPECT_EQ(log.frames.size(), 2U);
  EXPECT_EQ(log.left_out, 3U);
  EXPECT_EQ(tmf8829_cube(log).columns, 4);
  test::expect_input_error(
      [&] {
        (void)read_tmf8829_json(write_log({no_results, no_histograms}));
      },
      EndsWith("a.json.Result_Set: none of 2 frames has both results and histograms"));
}

TEST_F(Tmf8829Test, HistogramsOfThe8x8ModesHaveFineBins) {
  auto json = frame([](int i, int j) { return 10 * i + j; });
  int number = 0;
  for (auto& row : json["mp_histo"]) {
    for (auto& pixel : row) {
      std::vector<int> bins(kTmf8829FineBins, 3);
      bins[200] = 70 + number++;
      pixel["bin"] = bins;
    }
  }
  const Tmf8829Log log = read_tmf8829_json(write_log({json}));
  const HistogramCube cube = tmf8829_cube(log);
  EXPECT_EQ(cube.bins, 256);
  EXPECT_NEAR(cube.bin_width, 203.75e-12, 1e-18);  // the range of 64 bins of 815 ps
  EXPECT_EQ(cube.pixel(1, 1)[200], 73.0);
  json["mp_histo"][1][1]["bin"] = std::vector<int>(kTmf8829Bins, 3);
  test::expect_input_error([&] { (void)read_tmf8829_json(write_log({json})); },
                           EndsWith("Result_Set[0].mp_histo[1][1].bin: 64 elements instead of 256"));
}

TEST_F(Tmf8829Test, TheConfigurationSaysHowWideABinIs) {
  const auto width = [&](const nlohmann::json& shift) {
    const nlohmann::json log = {{"Result_Set", {frame([](int i, int j) { return 10 * i + j; })}},
                                {"configuration", {{"bin_shift", shift}}}};
    return read_tmf8829_json(write("a.json", log.dump())).bin_width;
  };
  EXPECT_NEAR(width(2), 815e-12, 1e-18);
  EXPECT_NEAR(width(0), 203.75e-12, 1e-18);
  EXPECT_NEAR(width(3), 1630e-12, 1e-18);
  test::expect_input_error([&] { (void)width(8); },
                           EndsWith("a.json.configuration.bin_shift: 8 is not within 0 to 7"));
}

TEST_F(Tmf8829Test, AByteOrderMarkStandsInFront) {
  const std::string text =
      nlohmann::json{{"Result_Set", {frame([](int i, int j) { return 10 * i + j; })}}}.dump();
  EXPECT_EQ(read_tmf8829_json(write("a.json", "\xEF\xBB\xBF" + text)).frames.at(0).histogram(1, 1)[0], 11U);
}

TEST_F(Tmf8829Test, Refusals) {
  const auto plain = [](int, int) { return 1; };
  const auto refused = [&](const nlohmann::json& broken, const std::string& reason) {
    test::expect_input_error([&] { (void)read_tmf8829_json(write_log({broken})); }, EndsWith(reason));
  };
  test::expect_input_error([&] { (void)read_tmf8829_json(write("a.json", "{}")); },
                           EndsWith("a.json: \"Result_Set\" is missing"));
  test::expect_input_error([&] { (void)read_tmf8829_json(write_log({})); },
                           EndsWith("a.json.Result_Set: no frames"));
  auto json = frame(plain);
  json["mp_histo"][1][0]["bin"].push_back(1);
  refused(json, "Result_Set[0].mp_histo[1][0].bin: 65 elements instead of 64");
  json = frame(plain);
  json["mp_histo"].erase(1);
  refused(json, "Result_Set[0].mp_histo: 1 elements instead of 2");
  json = frame(plain);
  json["mp_histo"][1].push_back(json["mp_histo"][1][0]);
  refused(json, "Result_Set[0].mp_histo[1]: 3 elements instead of 2");
  json = frame(plain);
  json["results"][0][1]["peaks"][0]["x"] = "left";
  refused(json, "Result_Set[0].results[0][1].peaks[0].x: \"left\" is not a number");
  json = frame(plain);
  json["results"][0][1]["noise"] = "2";
  refused(json, "Result_Set[0].results[0][1].noise: not an integer");
  test::expect_input_error([] { (void)tmf8829_cube({}); }, "histograms: no frames");
  const Tmf8829Log sizes = read_tmf8829_json(write_log({frame(plain), frame(plain, 3)}));
  test::expect_input_error([&] { (void)tmf8829_cube(sizes, 0.0, "a.json"); },
                           "a.json: frames of different size");
  json = frame(plain);
  json["results"][0][1]["peaks"][0]["distance"] = "near";
  refused(json, "Result_Set[0].results[0][1].peaks[0].distance: \"near\" is not a number");
}

TEST_F(Tmf8829Test, GzipIsUnpackedAndDamageIsRefused) {
  const std::string text = nlohmann::json{{"Result_Set", {frame([](int, int) { return 1; })}}}.dump();
  const auto file = path("a.json.gz");
  gzFile gzip = gzopen(file.c_str(), "wb");
  gzwrite(gzip, text.data(), static_cast<unsigned>(text.size()));
  gzclose(gzip);
  EXPECT_EQ(read_tmf8829_json(file).frames.size(), 1U);
  const std::string whole = contents(file);
  test::expect_input_error([&] { (void)read_tmf8829_json(write("t.gz", whole.substr(0, whole.size() / 2))); },
                           EndsWith("t.gz: damaged gzip data: the file ends early"));
  std::string damaged = whole;
  damaged[whole.size() - 6] = static_cast<char>(~damaged[whole.size() - 6]);
  test::expect_input_error([&] { (void)read_tmf8829_json(write("d.gz", damaged)); },
                           HasSubstr("d.gz: damaged gzip data: "));
}

TEST_F(Tmf8829Test, PublishedLogHoldsRowZeroAndFollowsTheOnChipDistances) {
  const auto file = test::shared_data("ams_tmf8829_log.json.gz");
  DTOF_SKIP_IF_ABSENT(file);
  const Tmf8829Log log = read_tmf8829_json(file);
  const auto& frames = log.frames;
  ASSERT_EQ(frames.size(), 26U);
  EXPECT_EQ(log.bin_width, kTmf8829BinWidth);  // bin_shift is 2
  EXPECT_EQ(frames[0].rows, 16);
  EXPECT_EQ(frames[0].columns, 16);
  EXPECT_EQ(frames[0].reference.size(), 8U);
  EXPECT_TRUE(std::ranges::all_of(frames, &Tmf8829Frame::only_row_zero));
  const HistogramCube cube = tmf8829_cube(log);
  EXPECT_EQ(cube.columns, 26);
  EXPECT_EQ(cube.rows, 16);

  // The peak next to where the reported distance puts it, as a distance: within a quarter bin of it, all of
  // them.
  constexpr double kMetresPerBin = kTmf8829BinWidth * 299792458.0 / 2.0;
  double largest = 0.0;
  for (int row = 0; row < cube.rows; ++row) {
    for (int column = 0; column < cube.columns; ++column) {
      const double reported = cube.true_distance[static_cast<std::size_t>(row) * frames.size() +
                                                 static_cast<std::size_t>(column)];
      const auto bins = cube.pixel(column, row);
      std::vector<double> first_bins(bins.begin(), bins.begin() + 50);
      std::ranges::nth_element(first_bins, first_bins.begin() + 25);
      const double floor = first_bins[25];
      const auto expected = static_cast<int>(std::lround(reported / kMetresPerBin + kTmf8829ZeroDistanceBin));
      const auto peak =
          std::max_element(bins.begin() + expected - 2, bins.begin() + expected + 3) - bins.begin();
      double weight = 0.0;
      double moment = 0.0;
      for (auto k = peak - 1; k <= peak + 1; ++k) {
        const double count = std::max(0.0, bins[static_cast<std::size_t>(k)] - floor);
        weight += count;
        moment += count * static_cast<double>(k);
      }
      const double distance = (moment / weight - kTmf8829ZeroDistanceBin) * kMetresPerBin;
      largest = std::max(largest, std::abs(distance - reported));
    }
  }
  EXPECT_LT(largest, kMetresPerBin / 4.0);
}

}  // namespace
}  // namespace dtof
