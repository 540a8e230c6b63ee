// SPDX-License-Identifier: Apache-2.0
#include "dtof/convert/conversion.hpp"

#include <matio.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "dtof/container/npz.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/result_csv.hpp"
#include "dtof/recording/picoquant.hpp"
#include "tests/container/hdf5_writer.hpp"
#include "tests/container/photon_hdf5_writer.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class ConversionTest : public test::IoTest {
 protected:
  std::string run(const std::string& in, const std::string& out, ConversionOptions options = {}) const {
    options.recording.file = path(in).string();
    options.out = path(out).string();
    return convert(options, open_conversion(options));
  }
  [[nodiscard]] NpyArray member(const std::string& file, const std::string& name) const {
    return parse_npz(path(file), contents(path(file)), name);
  }
  /// 2 x 2 pixels, one unknown.
  const DepthImage map_{.width = 2, .height = 2, .metres = {1.5F, 0.0F, 3.25F, 2.5F}};
};

TEST_F(ConversionTest, AMapGoesRoundEveryFormatOfMaps) {
  write_depth_png(path("a.png"), map_);
  const std::vector<std::string> chain = {"a.png", "b.pfm", "c.npy", "d.npz", "e.png"};
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    // An array becomes an archive under its own name; with a scale it is a map.
    EXPECT_EQ(run(chain[i], chain[i + 1],
                  {.metres_per_unit = chain[i] == "c.npy" ? std::optional(1.0) : std::nullopt}),
              "2 x 2 pixels, 3 with a distance")
        << chain[i];
  }
  EXPECT_EQ(contents(path("a.png")), contents(path("e.png")));
  EXPECT_EQ(file_count(), chain.size());
}

TEST_F(ConversionTest, PointCloudsTakeTheFieldsAlong) {
  write_pfm(path("a.pfm"), map_);
  write_result_csv(path("sifh.csv"),
                   std::vector<ResultRecord>{{.column = 1, .row = 1, .result = {1, 2, 77}}});
  write_npy(path("light.npy"), std::vector<std::size_t>{2, 2}, std::vector<double>{0.25, 0.5, 0.75, 1.0});
  const ConversionOptions options{
      .confidence = path("sifh.csv").string(), .amplitude = path("light.npy").string(), .text = true};
  EXPECT_EQ(run("a.pfm", "a.pcd", options), "2 x 2 pixels, 3 with a distance, confidence, amplitude");
  const std::string cloud = contents(path("a.pcd"));
  EXPECT_THAT(cloud, HasSubstr("FIELDS x y z confidence amplitude\n"));
  EXPECT_THAT(cloud, HasSubstr(" 0 0.25\n"));
  EXPECT_THAT(cloud, EndsWith(" 77 1\n"));
  EXPECT_EQ(run("a.pfm", "a.npz", options), "2 x 2 pixels, 3 with a distance, confidence, amplitude");
  EXPECT_THAT(member("a.npz", "confidence").values, ElementsAre(0, 0, 0, 77));
  // An archive's map brings what belongs to it.
  EXPECT_EQ(run("a.npz", "c.pfm"), "2 x 2 pixels, 3 with a distance, confidence, amplitude");
  EXPECT_EQ(run("a.npz:depth_m", "b.ply"), "2 x 2 pixels, 3 with a distance, confidence, amplitude");
  EXPECT_THAT(contents(path("b.ply")), HasSubstr("property float confidence\nproperty float amplitude\n"));
}

TEST_F(ConversionTest, ArraysKeepTheirShape) {
  std::vector<double> values(24);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(i);
  }
  write_npy(path("a.npy"), std::vector<std::size_t>{2, 3, 4}, values);
  EXPECT_EQ(run("a.npy", "a.npz"), "an array of shape (2, 3, 4)");
  EXPECT_EQ(run("a.npz", "b.npy"), "an array of shape (2, 3, 4)");
  EXPECT_EQ(contents(path("a.npy")), contents(path("b.npy")));
}

TEST_F(ConversionTest, MatlabsHistogramsOfBothVersionsAreTheSame) {
  std::array<size_t, 3> extents = {2, 3, 4};
  std::vector<std::uint16_t> values(24);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<std::uint16_t>(i);
  }
  for (const auto& [name, version] : {std::pair{"five.mat", MAT_FT_MAT5}, {"seven.mat", MAT_FT_MAT73}}) {
    mat_t* const file = Mat_CreateVer(path(name).c_str(), nullptr, version);
    matvar_t* const variable =
        Mat_VarCreate("h", MAT_C_UINT16, MAT_T_UINT16, 3, extents.data(), values.data(), 0);
    Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
    Mat_Close(file);
  }
  EXPECT_EQ(run("five.mat:h", "five.npy"), "an array of shape (2, 3, 4)");
  EXPECT_EQ(run("seven.mat:h", "seven.npy"), "an array of shape (2, 3, 4)");
  EXPECT_EQ(contents(path("five.npy")), contents(path("seven.npy")));
  const NpyArray array = read_npy(path("five.npy"));
  EXPECT_EQ(array.values[1], 6.0);   // row 0, column 0, bin 1
  EXPECT_EQ(array.values[4], 2.0);   // row 0, column 1, bin 0
  EXPECT_EQ(array.values[12], 1.0);  // row 1
}

TEST_F(ConversionTest, AStreamBecomesItsHistograms) {
  (void)write("a.csv", "acquisition,column,row,timestamp\n0,0,0,5\n1,0,0,5\n2,1,0,6\n");
  ConversionOptions options;
  options.recording.resampling.np = 3;
  options.recording.resampling.integration_time = 8e-9;
  EXPECT_EQ(run("a.csv", "a.npz", options),
            "recorded stream, 3 detections: histograms of 1 rows, 2 columns and 8 bins of 1000 ps");
  EXPECT_THAT(member("a.npz", "histograms").values,
              ElementsAre(0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0));
  // The archive says how wide its bins are: no --bin-width.
  options.recording.acquisitions = 1000;
  EXPECT_THAT(run("a.npz", "b.csv", options), EndsWith("2 columns, 1 rows and 1000 acquisitions"));
  EXPECT_EQ(run("b.csv", "b.npy", options),
            "recorded stream, 3 detections: histograms of 1 rows, 2 columns and 8 bins of 1000 ps");
  EXPECT_EQ(read_npy(path("b.npy")).values, member("a.npz", "histograms").values);
}

TEST_F(ConversionTest, ALogOfHistogramsBecomesAnArchiveAndAStream) {
  (void)write(
      "a.csv",
      "mi__agg_id_z0,distance_mm_z0,cnh__hist_bin_0_a0,cnh__hist_bin_1_a0\n0,100.5,3,-0.25\n0,nan,0,5\n");
  ConversionOptions options;
  options.recording.bin_width_s = 1e-9;
  EXPECT_EQ(run("a.csv", "a.npz", options),
            "ST VL53L8CH, 2 frames of 1 histograms: histograms of 1 rows, 2 columns and 2 bins of 1000 ps");
  EXPECT_THAT(member("a.npz", "histograms").values, ElementsAre(3, 0, 0, 5));
  EXPECT_EQ(member("a.npz", "true_distance_m").values.front(), 100.5 * 1e-3);
  EXPECT_THAT(run("a.csv", "b.csv", options), HasSubstr("a TDC stream of 2 columns, 1 rows"));
  EXPECT_THAT(contents(path("b.csv")), HasSubstr("acquisition,column,row,timestamp\n"));
}

TEST_F(ConversionTest, TimeTagsBecomeTheEventsOfAnotherLibrary) {
  const std::filesystem::path sample = test::shared_data("picoquant/v10.ht3");
  DTOF_SKIP_IF_ABSENT(sample);
  const ConversionOptions options{.out = path("a.csv").string(), .recording = {.file = sample.string()}};
  EXPECT_EQ(
      convert(options, open_conversion(options)),
      "PicoQuant HydraHarp 400, T3, 32 photons, 72462541 of the 72463591 records that the header names are "
      "missing");
  EXPECT_EQ(contents(path("a.csv")),
            "channel,sync,time_ps\n" + contents(test::shared_data("picoquant/v10.ht3.data")));
}

TEST_F(ConversionTest, AnHdf5DatasetBecomesWhatItsNpyBecomes) {
  const std::vector<std::size_t> shape = {3, 5, 64};
  std::vector<double> counts(3 * 5 * 64);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    counts[i] = static_cast<double>(i % 7 == 0 ? i % 3 : 0);
  }
  write_npy(path("a.npy"), shape, counts);
  const ConversionOptions options{.recording = {.file = "", .bin_width_s = 100e-12}};
  (void)run("a.npy", "npy.csv", options);
  for (const test::Hdf5Layout& layout :
       {test::Hdf5Layout{},
        {.chunk = {2, 2, 33}, .deflate = true},
        {.matlab = true},
        {.chunk = {1, 5, 1}, .shuffle = true, .fletcher32 = true, .matlab = true}}) {
    test::write_hdf5(path("a.h5"), {3, 5, 64}, counts, H5T_STD_U16LE, layout);
    EXPECT_EQ(run("a.h5", "h5.npy"), "an array of shape (3, 5, 64)");
    EXPECT_EQ(contents(path("h5.npy")), contents(path("a.npy")));
    (void)run("a.h5:/a", "h5.npz");
    EXPECT_EQ(member("h5.npz", "a").values, counts);
    (void)run("a.h5", "h5.csv", options);
    EXPECT_EQ(contents(path("h5.csv")), contents(path("npy.csv")));
  }
}

TEST_F(ConversionTest, PhotonHdf5BecomesEventsAndHistograms) {
  {
    const test::PhotonHdf5Writer file(path("a.hdf5"));
    file.spot("/photon_data0", {5, 900'719'925'474'099'3}, {2, 0}, {1, 0}, 16e-12, 3);
    file.spot("/photon_data1", {7}, {1}, {}, 16e-12, 3);
  }
  EXPECT_EQ(run("a.hdf5", "a.csv"), "Photon-HDF5, 2 spots, 3 photons");
  EXPECT_EQ(contents(path("a.csv")),
            "spot,detector,timestamp,time_ps\n0,1,5,32\n0,0,9007199254740993,0\n1,0,7,16\n");
  EXPECT_EQ(run("a.hdf5", "a.npz"),
            "Photon-HDF5, 2 spots, 3 photons: histograms of 2 rows, 2 columns and 3 bins of 16 ps");
  EXPECT_THAT(member("a.npz", "histograms").values, ElementsAre(1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0));
  EXPECT_EQ(run("a.hdf5:/photon_data0/nanotimes", "b.npy"), "an array of shape (2)");
  test::PhotonHdf5Writer(path("b.hdf5")).spot("/photon_data", {3}, {3}, {}, 12.5e-12);
  EXPECT_EQ(run("b.hdf5", "b.csv"), "Photon-HDF5, 1 photons");
  EXPECT_EQ(contents(path("b.csv")), "spot,detector,timestamp,time_ps\n0,0,3,37.5\n");
}

TEST_F(ConversionTest, PhotonTimesOfASampleAreCounted) {
  const std::filesystem::path sample = test::shared_data("shin2016_two_layer_photon_times.mat");
  DTOF_SKIP_IF_ABSENT(sample);
  ConversionOptions options{.out = path("a.npz").string(), .recording = {.file = sample.string()}};
  options.recording.bin_width_s = std::nullopt;
  options.recording.resampling.integration_time = 80e-9;
  EXPECT_EQ(convert(options, open_conversion(options)),
            "photon times, 507713 photons of 100 x 100 pixels: histograms of 100 rows, 100 columns and 1024 "
            "bins of "
            "78.125 ps");
  double photons = 0.0;
  for (const double count : member("a.npz", "histograms").values) {
    photons += count;
  }
  EXPECT_EQ(photons, 507713.0);
}

TEST_F(ConversionTest, WhatCannotBecomeAnotherIsRefusedAndNothingIsWritten) {
  write_pfm(path("a.pfm"), map_);
  (void)write("a.csv", "acquisition,column,row,timestamp\n0,0,0,5\n");
  write_npy(path("wide.npy"), std::vector<std::size_t>{1, 3}, std::vector<double>{1, 2, 3});
  const std::size_t files = file_count();
  const auto refused = [&](const std::string& in, const std::string& out, const std::string& sentence,
                           const ConversionOptions& options = {}) {
    test::expect_input_error([&] { (void)run(in, out, options); }, EndsWith(sentence));
    EXPECT_EQ(file_count(), files);
  };
  refused("a.csv", "a.ply",
          "a.csv: photons and histograms have no distances before they are read out: dtof replay does that");
  refused("a.pfm", "b.csv",
          "a.pfm: a map of distances is no TDC stream: dtof frame --depth makes photons of it");
  refused("a.pfm", "a.jpg",
          "a.jpg: what to write follows from the name's ending: .png, .pfm, .ply, .pcd, .npy, .npz or .csv");
  refused("a.pfm", "none/a.pcd", "cannot write: No such file or directory");
  refused("a.pfm", "a.pcd", "wide.npy: shape (1, 3) is not that of the map, (2, 2)",
          {.confidence = path("wide.npy").string()});
  refused("wide.npy", "a.csv", "wide.npy: an NPY histogram needs --bin-width");
}

}  // namespace
}  // namespace dtof
