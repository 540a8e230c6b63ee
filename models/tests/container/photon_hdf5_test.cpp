// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/photon_hdf5.hpp"

#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "tests/container/photon_hdf5_writer.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using test::PhotonHdf5Writer;
using ::testing::ElementsAre;

using Photon = std::tuple<std::uint32_t, std::uint64_t, std::uint64_t, std::uint64_t>;

class PhotonHdf5Test : public test::IoTest {
 protected:
  [[nodiscard]] std::vector<Photon> photons() const {
    std::vector<Photon> found;
    read_photon_hdf5(path("a.h5"), [&](const PhotonHdf5Event& photon) {
      found.emplace_back(photon.spot, photon.detector, photon.timestamp, photon.nanotime);
    });
    return found;
  }
};

TEST_F(PhotonHdf5Test, ASpotGivesItsPhotonsAndWhatStandsBesideThem) {
  {
    const PhotonHdf5Writer file(path("a.h5"));
    file.spot("/photon_data", {5, 9, 1'000'000'000'000'000'001}, {100, 4095, 0}, {1, 0, 1});
    file.text("/photon_data/measurement_specs/measurement_type", "smFRET-nsALEX");
    file.number("/photon_data/measurement_specs/laser_repetition_rate", 20e6);
  }
  EXPECT_TRUE(is_photon_hdf5(path("a.h5")));
  const PhotonHdf5Header header = read_photon_hdf5_header(path("a.h5"));
  ASSERT_EQ(header.spots.size(), 1U);
  EXPECT_EQ(header.spots[0].group, "/photon_data");
  EXPECT_EQ(header.spots[0].photons, 3U);
  EXPECT_EQ(header.spots[0].timestamps_unit_s, 50e-9);
  EXPECT_EQ(header.spots[0].tcspc_unit_s, 16e-12);
  EXPECT_EQ(header.spots[0].tcspc_bins, 4096U);
  EXPECT_EQ(header.measurement, "smFRET-nsALEX");
  EXPECT_EQ(header.laser_repetition_hz, 20e6);
  EXPECT_THAT(photons(), ElementsAre(Photon{0, 1, 5, 100}, Photon{0, 0, 9, 4095},
                                     Photon{0, 1, 1'000'000'000'000'000'001, 0}));
}

TEST_F(PhotonHdf5Test, ALongFileComesInPiecesAndInItsOrder) {
  constexpr std::int64_t kPhotons = 150'000;  // three pieces
  std::vector<std::int64_t> times;
  std::vector<std::int64_t> nanotimes;
  for (std::int64_t i = 0; i < kPhotons; ++i) {
    times.push_back(i * i);
    nanotimes.push_back(i * 7 % 4093);
  }
  {
    const PhotonHdf5Writer file(path("a.h5"));
    file.spot("/photon_data0", {1}, {2}, {3});
    file.spot("/photon_data1", times, nanotimes, {});
    file.array("/photon_data2/timestamps", times, H5T_STD_U64LE, {}, 1000);
    file.array("/photon_data2/nanotimes", nanotimes, H5T_STD_U32BE, {}, 777);
    file.number("/photon_data2/nanotimes_specs/tcspc_unit", 8e-12, H5T_IEEE_F32LE);
    file.spot("/photon_data4", {9}, {9}, {9});  // there is no spot 3 before it
  }
  const PhotonHdf5Header header = read_photon_hdf5_header(path("a.h5"));
  ASSERT_EQ(header.spots.size(), 3U);
  EXPECT_EQ(header.spots[2].tcspc_bins, 0U);
  EXPECT_EQ(header.spots[2].timestamps_unit_s, 0.0);
  const std::vector<Photon> found = photons();
  ASSERT_EQ(found.size(), 300'001U);
  EXPECT_EQ(found[0], (Photon{0, 3, 1, 2}));
  for (const std::uint32_t spot : {1U, 2U}) {
    for (std::size_t i = 0; i < kPhotons; ++i) {
      ASSERT_EQ(found[1 + (spot - 1) * kPhotons + i], (Photon{spot, 0, i * i, i * 7 % 4093}));
    }
  }
}

TEST_F(PhotonHdf5Test, AnExceptionOfTheReaderEndsTheOtherProcess) {
  PhotonHdf5Writer(path("a.h5"))
      .spot("/photon_data", std::vector<std::int64_t>(200'000, 1), std::vector<std::int64_t>(200'000, 1), {});
  std::size_t taken = 0;
  EXPECT_THROW(read_photon_hdf5(path("a.h5"),
                                [&](const PhotonHdf5Event& /*photon*/) {
                                  if (++taken == 10) {
                                    throw std::runtime_error("the disk is full");
                                  }
                                }),
               std::runtime_error);
  EXPECT_EQ(taken, 10U);
}

TEST_F(PhotonHdf5Test, OtherHdf5FilesAreNone) {
  PhotonHdf5Writer(path("a.h5"), "Photons").spot("/photon_data", {1}, {2}, {3});
  EXPECT_FALSE(is_photon_hdf5(path("a.h5")));
  PhotonHdf5Writer(path("b.h5"), "").spot("/photon_data", {1}, {2}, {3});
  EXPECT_FALSE(is_photon_hdf5(path("b.h5")));
}

struct RefusedFile {
  std::function<void(const PhotonHdf5Writer&)> write;
  std::string sentence;
};

std::vector<RefusedFile> refused_files() {
  const auto without = [](const char* missing) {
    return [missing](const PhotonHdf5Writer& file) {
      for (const char* const name : {"timestamps", "nanotimes"}) {
        if (std::string(name) != missing) {
          file.array(std::string("/photon_data/") + name, {1, 2});
        }
      }
      if (std::string("tcspc_unit") != missing) {
        file.number("/photon_data/nanotimes_specs/tcspc_unit", 1e-12);
      }
    };
  };
  const auto with_unit = [](double unit_s) {
    return [unit_s](const PhotonHdf5Writer& file) { file.spot("/photon_data", {1}, {1}, {1}, unit_s); };
  };
  const auto with_bins = [](double bins) {
    return [bins](const PhotonHdf5Writer& file) {
      file.array("/photon_data/timestamps", {1});
      file.array("/photon_data/nanotimes", {1});
      file.number("/photon_data/nanotimes_specs/tcspc_unit", 1e-12);
      file.number("/photon_data/nanotimes_specs/tcspc_num_bins", bins);
    };
  };
  return {
      {[](const PhotonHdf5Writer& file) { file.number("/acquisition_duration", 1.0); },
       "the file has neither /photon_data nor /photon_data0"},
      {without("timestamps"), "/photon_data has no timestamps"},
      {without("nanotimes"), "/photon_data has no nanotimes: no photon has a time since the laser's pulse"},
      {without("tcspc_unit"), "/photon_data/nanotimes_specs has no tcspc_unit: no bin has a width"},
      {with_unit(0.0), "/photon_data/nanotimes_specs/tcspc_unit is 0 s, must be above 0"},
      {with_unit(-1e-12), "/photon_data/nanotimes_specs/tcspc_unit is -1e-12 s, must be above 0"},
      {[](const PhotonHdf5Writer& file) {
         file.spot("/photon_data", {1}, {1}, {1});
         file.text("/photon_data/measurement_specs/laser_repetition_rate", "fast");
       },
       "/photon_data/measurement_specs/laser_repetition_rate is not a number"},
      {with_bins(0.5), "/photon_data/nanotimes_specs/tcspc_num_bins is 0.5, no number of bins"},
      {with_bins(0.0), "/photon_data/nanotimes_specs/tcspc_num_bins is 0, no number of bins"},
      {[](const PhotonHdf5Writer& file) {
         file.spot("/photon_data", {1, 2, 3}, {1, 2}, {});
       },
       "/photon_data has 3 timestamps and 2 nanotimes"},
      {[](const PhotonHdf5Writer& file) {
         file.spot("/photon_data0", {1, 2, 3}, {1, 2, 3}, {1});
       },
       "/photon_data0 has 3 timestamps and 1 detectors"},
      {[](const PhotonHdf5Writer& file) {
         file.array("/photon_data/detectors", {1, 2, 3, 4}, H5T_STD_U8LE, {2, 2});
         file.spot("/photon_data", {1, 2}, {1, 2}, {});
       },
       "/photon_data/detectors has 2 axes, not one"},
      {[](const PhotonHdf5Writer& file) {
         file.array("/photon_data/timestamps", {1}, H5T_IEEE_F64LE);
         file.array("/photon_data/nanotimes", {1});
       },
       "/photon_data/timestamps holds no integers"},
      {[](const PhotonHdf5Writer& file) {
         file.spot("/photon_data0", {}, {}, {});
         file.spot("/photon_data1", {}, {}, {});
       },
       "the file has no photons"},
  };
}

TEST_F(PhotonHdf5Test, EachLackHasItsSentence) {
  for (const RefusedFile& refused : refused_files()) {
    refused.write(PhotonHdf5Writer(path("a.h5")));
    test::expect_input_error([&] { (void)read_photon_hdf5_header(path("a.h5")); },
                             path("a.h5").string() + ": " + refused.sentence);
  }
}

TEST_F(PhotonHdf5Test, ANegativeNumberIsRefusedAtItsPlace) {
  PhotonHdf5Writer(path("a.h5")).spot("/photon_data", {1, -2}, {1, 2}, {});
  test::expect_input_error([&] { (void)photons(); },
                           path("a.h5").string() + ": /photon_data/timestamps: element 1 is negative, -2");
}

TEST_F(PhotonHdf5Test, ADamagedPieceIsRefused) {
  {
    const PhotonHdf5Writer file(path("a.h5"));
    std::vector<std::int64_t> numbers(5000);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = static_cast<std::int64_t>(i * i % 4001);
    }
    file.array("/photon_data/timestamps", numbers);
    file.array("/photon_data/nanotimes", numbers, H5T_STD_U16LE, {}, 5000);
    file.number("/photon_data/nanotimes_specs/tcspc_unit", 1e-12);
  }
  std::string bytes = contents(path("a.h5"));
  const std::size_t packed = bytes.find("\x78\x5e");  // zlib's beginning at level 6
  const std::size_t begin = packed == std::string::npos ? bytes.find("\x78\x9c") : packed;
  ASSERT_NE(begin, std::string::npos);
  bytes.replace(begin + 100, 200, std::string(200, '\xff'));
  (void)write("a.h5", bytes);
  test::expect_input_error(
      [&] { (void)photons(); },
      path("a.h5").string() + ": /photon_data/nanotimes is damaged, or packed by a filter that is not here");
}

}  // namespace
}  // namespace dtof
