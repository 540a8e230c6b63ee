// SPDX-License-Identifier: Apache-2.0
// Streams of sensors without measured effects stay what they were, photon for photon: checksums of the
// streams, taken before the first of these effects was added to the model.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

/// FNV-1a (from another start) over the numbers of a source's streams, 64 bits each, lowest byte first.
std::uint64_t checksum(const StreamSource& source) {
  std::uint64_t hash = 1469598103934665603U;
  const auto mix = [&hash](std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) {
      hash ^= (word >> (8 * byte)) & 255U;
      hash *= 1099511628211U;
    }
  };
  for (int column = 0; column < source.columns(); ++column) {
    const ColumnStream stream = source.column(column);
    for (int row = 0; row < stream.rows(); ++row) {
      mix(stream.row(row).size());
      for (const Detection& detection : stream.row(row)) {
        mix(detection.acquisition);
        mix(detection.timestamp);
      }
    }
  }
  return hash;
}

struct Streams {
  const char* preset;
  double depth_m;
  std::uint64_t exact;
  std::uint64_t fast;
  std::uint64_t mean;
  std::uint64_t with_dead_time;
};

constexpr auto kStreams = std::to_array<Streams>({
    {"thesis", 0.2, 0x2f9b0d5810660cc9, 0x7b2353805314e0f8, 0x94c6c3473bb3cd9b, 0xea8f2084ec698d7a},
    {"thesis", 1.0, 0x9e39bc2b48bb61e5, 0x781f48b09f8a9ef0, 0x9a4e332618a12fd3, 0x2cf908538c8302e1},
    {"thesis", 4.0, 0x18d5ddcbfe975e3f, 0xd500599b6127ee65, 0x04c85a4ec229ee5b, 0xaf3568d4b4195da7},
    {"phone", 0.2, 0x8fd09932be9f41c0, 0xc4d17ffb3318c7b4, 0x5766f83dbcac5edb, 0x9802b3a57e06c03a},
    {"phone", 1.0, 0x7c8c37d208c99d4c, 0x4c8b7702ba9c6c20, 0x57dd9b83e2684d43, 0x0d2e7fb016b9246a},
    {"phone", 4.0, 0x360a26643bb5f4bc, 0x3184f09928c57961, 0x3ddee15c4c948023, 0x1e9e6d32c8140c28},
});

TEST(StreamIdentity, PresetsKeepTheirPhotons) {
  for (const Streams& expected : kStreams) {
    SensorModel sensor = parse_preset(expected.preset);
    sensor.acquisitions = 700;
    const TargetMap targets(3, 4, {.depth_m = expected.depth_m, .reflectivity = sensor.default_reflectivity});
    const PhotonSource exact(sensor, targets, 14.0, 7);
    EXPECT_EQ(checksum(exact), expected.exact) << expected.preset << ' ' << expected.depth_m;
    EXPECT_EQ(checksum(FastPhotonSource(exact)), expected.fast) << expected.preset << ' ' << expected.depth_m;
    EXPECT_EQ(checksum(MeanPhotonSource(exact)), expected.mean) << expected.preset << ' ' << expected.depth_m;
    sensor.dead_time_s = 5e-9;
    EXPECT_EQ(checksum(PhotonSource(sensor, targets, 14.0, 7)), expected.with_dead_time)
        << expected.preset << ' ' << expected.depth_m;
  }
}

TEST(StreamIdentity, GatedBinnedCoincidentAndDenseStreamsKeepTheirPhotons) {
  SensorModel sensor;
  sensor.acquisitions = 300;
  sensor.binning = 2;
  sensor.coincidence_window_s = 1e-9;
  sensor.time_gate = TimeGate{3.3e-9, 27.7e-9};
  EXPECT_EQ(checksum(PhotonSource(sensor, TargetMap(4, 4, {.depth_m = 1.0, .reflectivity = 1.0}), 14.0, 7)),
            0x9a3e4528c7a1643bU);
  sensor.slots = 1;
  EXPECT_EQ(checksum(PhotonSource(sensor, TargetMap(4, 4, {.depth_m = 0.1, .reflectivity = 1.0}), 200.0, 7)),
            0x3721e63359e25993U);
}

}  // namespace
}  // namespace dtof
