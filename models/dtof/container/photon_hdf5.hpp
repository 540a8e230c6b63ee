// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace dtof {

// Photon-HDF5 (photon-hdf5.readthedocs.io, version 0.5): HDF5 with an array element for each photon. As
// every HDF5 file it is read in a process of its own (read_apart.hpp).

/// The photons of one excitation spot: a group photon_data, or photon_data0, photon_data1 and so on.
struct PhotonHdf5Spot {
  std::string group;
  std::uint64_t photons = 0;
  double timestamps_unit_s = 0.0;  ///< 0: the file does not say
  double tcspc_unit_s = 0.0;       ///< a bin of the times since the laser's pulse
  std::uint64_t tcspc_bins = 0;    ///< 0: the file does not say
};

struct PhotonHdf5Header {
  std::vector<PhotonHdf5Spot> spots;
  std::string measurement;           ///< measurement_type of the first spot, or empty
  double laser_repetition_hz = 0.0;  ///< of the first spot; 0: the file does not say
};

/// One photon.
struct PhotonHdf5Event {
  std::uint32_t spot = 0;       ///< index in PhotonHdf5Header::spots
  std::uint64_t detector = 0;   ///< its ID; 0 in a file of one detector
  std::uint64_t timestamp = 0;  ///< units of timestamps_unit_s
  std::uint64_t nanotime = 0;   ///< units of tcspc_unit_s, since the laser's pulse
};

/// Whether an HDF5 file says of itself that it is Photon-HDF5. Throws InputError for a damaged file.
bool is_photon_hdf5(const std::filesystem::path& path);

/// What stands beside the photons. Throws InputError "<path>: <reason>" for a file that lacks timestamps,
/// nanotimes or their unit, whose arrays have different lengths, several axes or no integers, whose unit
/// is not above 0, or that has no photon.
PhotonHdf5Header read_photon_hdf5_header(const std::filesystem::path& path);

/// Gives every photon to `take`, spot by spot in the file's order, piece by piece: a file may be longer than
/// memory. Throws InputError as above, and for a negative number and a damaged piece.
void read_photon_hdf5(const std::filesystem::path& path,
                      const std::function<void(const PhotonHdf5Event&)>& take);

}  // namespace dtof
