// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/vl53l8ch_log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::Each;
using ::testing::IsNan;

struct Read {
  HistogramCube cube;
  std::string description;
};

Read read(const std::string& text, std::optional<double> bin_width_s = 1e-9) {
  LineReader lines("a.csv", text);
  Read read;
  read.cube = read_vl53l8ch_log(lines, bin_width_s, read.description);
  return read;
}

void refused(const std::string& text, const std::string& reason) {
  test::expect_input_error([&] { (void)read(text); }, "a.csv:" + reason);
}

/// Zones 0 to 15, of which 2 x 2 aggregates have the zones 5, 6, 9 and 10; two bins; bins before aggregates.
std::string header() {
  std::string text = ".HostDateTime,streamcount";
  for (const char* name : {"distance_mm_z", "mi__agg_id_z", ".is_valid_range_z"}) {
    for (int zone = 0; zone < 16; ++zone) {
      text += fmt::format(",{}{}", name, zone);
    }
  }
  for (int bin = 0; bin < 2; ++bin) {
    for (int aggregate = 0; aggregate < 4; ++aggregate) {
      text += fmt::format(",cnh__hist_bin_{}_a{}", bin, aggregate);
    }
  }
  return text + "\n";
}

/// A frame whose bins are first, first + 1, ...; zone 6 is not valid.
std::string frame(int first, const std::string& bins = "") {
  std::string text = "6052025.183919,0";
  for (int zone = 0; zone < 16; ++zone) {
    text += fmt::format(",{}.25", 100 + zone);
  }
  for (int zone = 0; zone < 16; ++zone) {
    text += fmt::format(",{}", zone == 5 ? 0 : zone == 6 ? 1 : zone == 9 ? 2 : zone == 10 ? 3 : -1);
  }
  for (int zone = 0; zone < 16; ++zone) {
    text += zone == 6 ? ",0" : ",1";
  }
  for (int i = 0; i < 8 && bins.empty(); ++i) {
    text += fmt::format(",{}.5", first + i);
  }
  return text + bins + "\n";
}

TEST(Vl53l8chLog, FramesOfTheEvaluationSoftwareStandSideBySide) {
  const auto [cube, description] = read(header() + frame(1) + frame(11));
  EXPECT_EQ(description, "ST VL53L8CH, 2 frames of 4 histograms");
  ASSERT_EQ(cube.columns, 4);
  ASSERT_EQ(cube.rows, 2);
  ASSERT_EQ(cube.bins, 2);
  EXPECT_EQ(cube.bin_width, 1e-9);
  EXPECT_EQ(cube.pixel(0, 0)[0], 1.5);  // aggregate 0
  EXPECT_EQ(cube.pixel(0, 0)[1], 5.5);
  EXPECT_EQ(cube.pixel(1, 0)[0], 2.5);
  EXPECT_EQ(cube.pixel(0, 1)[0], 3.5);
  EXPECT_EQ(cube.pixel(3, 1)[1], 18.5);
  EXPECT_DOUBLE_EQ(cube.true_distance[0], 0.10525);
  EXPECT_THAT(cube.true_distance[1], IsNan());  // not valid
  EXPECT_DOUBLE_EQ(cube.true_distance[5], 0.11025);
}

TEST(Vl53l8chLog, NegativeBinsAreZeroAndFramesWithoutHistogramsAreLeftOut) {
  const auto [cube, description] =
      read(header() + frame(0, ",-0.25,1,2,3,4,5,6,7") + frame(0, ",nan,nan,nan,nan,nan,nan,nan,nan") + "\n" +
           "6052025.1,1,5");
  EXPECT_EQ(description, "ST VL53L8CH, 1 frames of 4 histograms, 1 without histograms left out");
  EXPECT_EQ(cube.pixel(0, 0)[0], 0.0);
  EXPECT_EQ(cube.pixel(0, 0)[1], 4.0);
}

TEST(Vl53l8chLog, WithoutTheZonesEachFrameIsAColumn) {
  const auto [cube, description] =
      read("\"cnh__hist_bin_0_a1\", cnh__hist_bin_0_a0,cnh__hist_bin_x\n1,2,q\n3,4,q\n");
  EXPECT_EQ(description, "ST VL53L8CH, 2 frames of 2 histograms");
  ASSERT_EQ(cube.columns, 2);
  ASSERT_EQ(cube.rows, 2);
  EXPECT_EQ(cube.pixel(0, 0)[0], 2.0);
  EXPECT_EQ(cube.pixel(1, 1)[0], 3.0);
  EXPECT_THAT(cube.true_distance, Each(IsNan()));
}

TEST(Vl53l8chLog, AggregatesOfSeveralZonesHaveNoDistance) {
  std::string text;
  std::string names;
  for (int zone = 0; zone < 16; ++zone) {
    names += fmt::format("distance_mm_z{},mi__agg_id_z{},", zone, zone);
    text += fmt::format("100,{},", (zone / 8) * 2 + (zone % 4) / 2);  // 2 x 2 zones each
  }
  names += "cnh__hist_bin_0_a0,cnh__hist_bin_0_a1,cnh__hist_bin_0_a2,cnh__hist_bin_0_a3\n";
  const auto [cube, description] = read(names + text + "1,2,3,4\n");
  ASSERT_EQ(cube.columns, 2);
  ASSERT_EQ(cube.rows, 2);
  EXPECT_EQ(cube.pixel(0, 1)[0], 3.0);
  EXPECT_THAT(cube.true_distance, Each(IsNan()));
}

std::string agg(int aggregate, const std::string& bins) {
  return fmt::format("Agg, {:2}, Ambient, 1.5, Bins, {}, \n", aggregate, bins);
}

TEST(Vl53l8chLog, LinesOfTheDriversExampleAreFrames) {
  // The recording begins and ends in a frame, and a line of another one is lost.
  const auto [cube, description] =
      read("VL53LMZ ULD ready!\r\n" + agg(2, "9.0, 9.0") + "Data Count :   1\n" + agg(0, "9.0, 9.0") +
           agg(1, "9.0, 9.0") + "Data Count :   2\n" + agg(0, "1.0, 2.0") + agg(1, "3.0, -4.0") +
           agg(2, "5.0, 6.0") + agg(0, "9, 9") + agg(2, "9, 9") + agg(0, "1.5, 2.0") + agg(1, "3.5, 4") +
           agg(2, "5.5, 6") + agg(0, "9, 9") + "Agg,  1, Ambient, 1.5, Bins, 3.");
  EXPECT_EQ(description, "ST VL53L8CH, 2 frames of 3 histograms, 4 incomplete left out");
  ASSERT_EQ(cube.columns, 2);
  ASSERT_EQ(cube.rows, 3);
  EXPECT_EQ(cube.pixel(0, 1)[0], 3.0);
  EXPECT_EQ(cube.pixel(0, 1)[1], 0.0);
  EXPECT_EQ(cube.pixel(1, 2)[0], 5.5);
  EXPECT_THAT(cube.true_distance, Each(IsNan()));
}

TEST(Vl53l8chLog, IsRecognisedByItsLines) {
  EXPECT_TRUE(is_vl53l8ch_log("a,cnh__hist_bin_0_a0\n"));
  EXPECT_TRUE(
      is_vl53l8ch_log("\xEF\xBB\xBF"
                      "Agg, 0"));
  EXPECT_TRUE(is_vl53l8ch_log("ready\nAgg,  0, Ambient"));
  EXPECT_FALSE(is_vl53l8ch_log("a\ncnh__hist_bin_0_a0\n"));
  EXPECT_FALSE(is_vl53l8ch_log("Aggregate"));
}

TEST(Vl53l8chLog, Refusals) {
  test::expect_input_error(
      [&] { (void)read(header(), std::nullopt); },
      "a.csv: the log does not say how wide its bins are; give --bin-width: 250.4 ps for each "
      "bin that the sensor sums");
  refused("", " no lines");
  refused("what?\n", " no whole frame: its lines \"Agg,\" ascend from 0");
  refused(header(), " no frame with histograms");
  refused("cnh__hist_bin_a\n1\n", "1: no column cnh__hist_bin_<bin>_a<aggregate>");
  refused("cnh__hist_bin_0_a0,cnh__hist_bin_1_a1,cnh__hist_bin_1_a0\n", "1: no column cnh__hist_bin_0_a1");
  refused("cnh__hist_bin_0_a1\n", "1: no column cnh__hist_bin_0_a0");
  refused("cnh__hist_bin_0_a0,cnh__hist_bin_0_a0\n", "1: two columns cnh__hist_bin_0_a0");
  refused("cnh__hist_bin_0_a64\n", "1: column cnh__hist_bin_0_a64: bins are 0 to 254, aggregates 0 to 63");
  refused("cnh__hist_bin_255_a0\n", "1: column cnh__hist_bin_255_a0: bins are 0 to 254, aggregates 0 to 63");
  refused("cnh__hist_bin_0_a0\n1\n1,2\n", "3: 2 fields instead of 1");
  refused("cnh__hist_bin_0_a0\n1x\n", "2: cnh__hist_bin_0_a0: \"1x\" is no number");
  refused("cnh__hist_bin_0_a0\n\ninf\n", "3: cnh__hist_bin_0_a0: \"inf\" is no number");
  refused("Agg, 0, Ambient, 1.0, Bin, 1.0\n",
          "1: not \"Agg, <aggregate>, Ambient, <level>, Bins, <bin>, ...\"");
  refused(agg(64, "1"), "1: aggregate \"64\" is no integer from 0 to 63");
  refused(agg(0, "1, 2") + agg(1, "1"), "2: 1 bins instead of 2");
  refused(agg(0, "1, y"), "1: bin 1: \"y\" is no number");
}

}  // namespace
}  // namespace dtof
