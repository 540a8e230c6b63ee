// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/random.hpp"
#include "dtof/scene/scene.hpp"
#include "vectors/rtl_parameters.hpp"

namespace dtof {

/// Columns of random streams. Each pixel has the next kind (tests/readout/test_streams.hpp), beginning with
/// `kind`; every second column of a pool read-out sees one surface. Frames of 1,000 acquisitions and more
/// begin with a constant code, so that counters saturate.
std::vector<ColumnStream> random_columns(const ArrayParameters& array, std::uint32_t acquisitions,
                                         std::size_t& kind, CounterRandom& random);

/// Writes the stimulus and the expected results of a test bench, frame by frame. Every pixel has another kind
/// of adversarial stream; every second column of a pool read-out sees one surface.
///  - frames.txt: a line per frame with acquisitions, three settings, two percentages and a flag. The
///    settings are gate begin, gate end, 0; for a pool read-out coarse_end, track_end, 1 for S1 plus 2 for
///    the prior plus 4 for a template. With TIME_GATE = 1 the gate of a pool read-out leaves out the first
///    and the last eighth of the range. The percentages are the shares of clocks in which the source pauses
///    between acquisitions, and in which the sink stalls. The flag is 1 if the frame is run again and reset
///    on the way.
///  - timestamps.hex: a line per clock of an acquisition with the timestamps of all columns, column 0 in the
///    lowest bits.
///  - results.hex: a line per pixel, row by row, with code, fraction and confidence of four digits each.
void write_vectors(const ArrayParameters& array, std::span<const std::uint32_t> frames, std::uint64_t seed,
                   const std::filesystem::path& folder);

/// Writes the same files with the photons of a scene, for figures that depend on the sensor's light. The
/// columns are the middle ones of a map of 200 columns. The sensor is the thesis's with the array's NP and
/// SLOTS, at `klux` of background light; source and sink do not pause. Throws InputError as PhotonSource
/// does.
void write_scene_vectors(const ArrayParameters& array, Scene scene, double klux,
                         std::span<const std::uint32_t> frames, std::uint64_t seed,
                         const std::filesystem::path& folder);

/// A frame as text: timestamps.hex and results.hex as written by write_vectors().
struct FrameVectors {
  std::string timestamps;
  std::string results;
};

/// Vectors of the whole frame of a source with the array's rows and columns.
FrameVectors source_vectors(const ArrayParameters& array, const StreamSource& source);

}  // namespace dtof
