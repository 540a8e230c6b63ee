// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/photon_hdf5_cube.hpp"

#include <string>
#include <vector>

#include "dtof/recording/recorded_array.hpp"
#include "dtof/recording/recording.hpp"
#include "tests/container/photon_hdf5_writer.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using test::PhotonHdf5Writer;

class PhotonHdf5CubeTest : public test::IoTest {
 protected:
  [[nodiscard]] HistogramCube cube(std::string& description) const {
    return photon_hdf5_cube(path("a.h5"), description);
  }
  void refused(const std::string& sentence) const {
    std::string description;
    test::expect_input_error([&] { (void)cube(description); }, path("a.h5").string() + ": " + sentence);
  }
};

TEST_F(PhotonHdf5CubeTest, ASpotIsARowADetectorAColumn) {
  {
    const PhotonHdf5Writer file(path("a.h5"));
    file.spot("/photon_data0", {1, 2, 3, 4}, {2, 2, 0, 4}, {0, 0, 2, 0}, 25e-12, 4);
    file.spot("/photon_data1", {5}, {3}, {1}, 25e-12, 4);
    file.text("/photon_data0/measurement_specs/measurement_type", "generic");
    file.number("/photon_data0/measurement_specs/laser_repetition_rate", 40e6);
  }
  std::string description;
  const HistogramCube made = cube(description);
  EXPECT_EQ(description,
            "Photon-HDF5, generic, laser at 40 MHz, 2 spots, 5 photons, 1 beyond 4 bins left out");
  EXPECT_EQ(made.rows, 2);
  EXPECT_EQ(made.columns, 3);
  EXPECT_EQ(made.bins, 4);
  EXPECT_EQ(made.bin_width, 25e-12);
  EXPECT_EQ(made.counts, (std::vector<double>{0, 0, 2, 0, 0, 0, 0, 0, 1, 0, 0, 0,     // spot 0
                                              0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0}));  // spot 1
}

TEST_F(PhotonHdf5CubeTest, WithoutANumberOfBinsTheLatestPhotonIsTheLast) {
  {
    const PhotonHdf5Writer file(path("a.h5"));
    file.array("/photon_data/timestamps", {1, 2});
    file.array("/photon_data/nanotimes", {6, 1});
    file.number("/photon_data/nanotimes_specs/tcspc_unit", 1e-12);
  }
  std::string description;
  EXPECT_EQ(cube(description).bins, 7);
  EXPECT_EQ(description, "Photon-HDF5, 2 photons");
}

TEST_F(PhotonHdf5CubeTest, WhatIsNoCubeIsRefused) {
  {
    const PhotonHdf5Writer file(path("a.h5"));
    file.spot("/photon_data0", {1}, {1}, {1}, 25e-12);
    file.spot("/photon_data1", {1}, {1}, {1}, 26e-12);
  }
  refused("tcspc_unit is 25 ps in /photon_data0 and 26 ps in /photon_data1: one width of bins is needed");
  PhotonHdf5Writer(path("a.h5")).spot("/photon_data", {1}, {9}, {1}, 1e-12, 9);
  refused("no photon is within 9 bins behind a pulse");
  {
    const PhotonHdf5Writer file(path("a.h5"));
    file.array("/photon_data/timestamps", {1});
    file.array("/photon_data/nanotimes", {1});
    file.array("/photon_data/detectors", {70000});
    file.number("/photon_data/nanotimes_specs/tcspc_unit", 1e-12);
  }
  refused("detector 70000 is beyond 65535");
  {
    const PhotonHdf5Writer file(path("a.h5"));
    file.array("/photon_data/timestamps", {1, 1});
    file.array("/photon_data/nanotimes", {1, 5000});
    file.array("/photon_data/detectors", {60000, 0});
    file.number("/photon_data/nanotimes_specs/tcspc_unit", 1e-12);
  }
  refused("1 spots, 60001 detectors and 5001 bins are more than 2^27 counts");
}

TEST_F(PhotonHdf5CubeTest, ARecordingIsKnownByItsContent) {
  PhotonHdf5Writer(path("a.h5")).spot("/photon_data", {1, 2}, {6, 1}, {}, 1e-12, 8);
  const RecordingOptions options{.file = path("a.h5").string()};
  const RecordingFile file = read_recording(options);
  EXPECT_EQ(file.format, "photon-hdf5");
  const Recording recording = open_recording(options, file);
  EXPECT_EQ(recording.source->columns(), 1);
  EXPECT_EQ(recording.source->rows(), 1);
  // An array that is named is read as it is, as is every array where the format says so.
  RecordingOptions array = options;
  array.file += ":/photon_data/nanotimes";
  const RecordingFile named = read_recording(array);
  EXPECT_EQ(named.format, "hdf5");
  EXPECT_EQ(open_array(array, named).values, (std::vector<double>{6, 1}));
  RecordingOptions plain = options;
  plain.format = "hdf5";
  EXPECT_EQ(read_recording(plain).format, "hdf5");
  RecordingOptions wrong = options;
  wrong.format = "photon-hdf5";
  wrong.file = write("b.h5", "nothing of the kind").string();
  test::expect_input_error([&] { (void)read_recording(wrong); },
                           path("b.h5").string() + ": not an HDF5 file, or a pipe");
}

}  // namespace
}  // namespace dtof
