// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace dtof {

// Photon-HDF5 (photon-hdf5.readthedocs.io, version 0.5): HDF5 with one array element per photon. All
// functions read the file in a process of its own (read_apart.hpp).

/// Photons of one excitation spot, stored in a group photon_data, photon_data0, photon_data1 and so on.
struct PhotonHdf5Spot {
  std::string group;
  std::uint64_t photons = 0;
  double timestamps_unit_s = 0.0;  ///< s; 0: the file does not say
  double tcspc_unit_s = 0.0;       ///< width of a nanotime bin, s
  std::uint64_t tcspc_bins = 0;    ///< bins of the nanotimes; 0: the file does not say
};

struct PhotonHdf5Header {
  std::vector<PhotonHdf5Spot> spots;
  std::string measurement;           ///< measurement_type of the first spot, or empty
  double laser_repetition_hz = 0.0;  ///< of the first spot, Hz; 0: the file does not say
};

/// One photon.
struct PhotonHdf5Event {
  std::uint32_t spot = 0;       ///< index in PhotonHdf5Header::spots
  std::uint64_t detector = 0;   ///< detector ID; 0 in a file with one detector
  std::uint64_t timestamp = 0;  ///< in units of timestamps_unit_s
  std::uint64_t nanotime = 0;   ///< time since the laser pulse, in units of tcspc_unit_s
};

/// True if an HDF5 file declares itself as Photon-HDF5. Throws InputError for a damaged file.
bool is_photon_hdf5(const std::filesystem::path& path);

/// Reads everything but the photons. Throws InputError "<path>: <reason>" for a file without photons,
/// timestamps, nanotimes or their unit. Also refused are arrays that differ in length, have several axes or
/// are not integers, and a unit that is not above 0.
PhotonHdf5Header read_photon_hdf5_header(const std::filesystem::path& path);

/// Passes every photon to `take`, spot by spot in file order. The file is read piece by piece and may be
/// larger than memory. Throws InputError as read_photon_hdf5_header does, and for a negative number or a
/// damaged piece.
void read_photon_hdf5(const std::filesystem::path& path,
                      const std::function<void(const PhotonHdf5Event&)>& take);

}  // namespace dtof
