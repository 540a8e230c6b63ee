// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "dtof/container/photon_hdf5.hpp"
#include "dtof/recording/histogram_stream.hpp"

namespace dtof {

/// "Photon-HDF5, smFRET-nsALEX, 2 spots, 44141 photons".
std::string photon_hdf5_description(const PhotonHdf5Header& header);

/// Histograms of the times since the laser's pulse: each spot of the file is a row, each detector's ID a
/// column, a bin is tcspc_unit. Bins are tcspc_num_bins, or, where the file does not say, up to the latest
/// photon, and at most 2^20; photons beyond are left out, and the description says how many. Throws
/// InputError for spots of different units, more than 2^27 bins in all, and as read_photon_hdf5 does.
HistogramCube photon_hdf5_cube(const std::filesystem::path& path, std::string& description);

}  // namespace dtof
