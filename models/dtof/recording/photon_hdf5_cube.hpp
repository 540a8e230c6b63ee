// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "dtof/container/photon_hdf5.hpp"
#include "dtof/recording/histogram_stream.hpp"

namespace dtof {

/// Text, e.g. "Photon-HDF5, smFRET-nsALEX, 2 spots, 44141 photons".
std::string photon_hdf5_description(const PhotonHdf5Header& header);

/// Reads histograms of the times since the laser pulse. Each spot of the file is a row, each detector ID a
/// column; a bin is tcspc_unit wide. The number of bins is tcspc_num_bins or, if the file has none, reaches
/// to the latest photon; at most 2^20. Photons beyond are left out, and `description` receives their number.
/// Throws InputError as read_photon_hdf5 does, for spots with different units, and for more than 2^27 bins in
/// all.
HistogramCube photon_hdf5_cube(const std::filesystem::path& path, std::string& description);

}  // namespace dtof
