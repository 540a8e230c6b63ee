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

/// Columns of random streams, each pixel of another kind (tests/readout/test_streams.hpp), from `kind` on;
/// every second column of a pool read-out sees one surface. Frames of 1,000 acquisitions and more begin with
/// a constant code, so that counters saturate.
std::vector<ColumnStream> random_columns(const ArrayParameters& array, std::uint32_t acquisitions,
                                         std::size_t& kind, CounterRandom& random);

/// Writes what a test bench drives and expects, for one frame after the other:
///   frames.txt      a line per frame: acquisitions, three settings (gate begin, gate end, 0, or of
///                   a pool read-out coarse_end, track_end, 1 for S1 plus 2 for the prior), per cent of
///                   clocks in which the source pauses between acquisitions, per cent of clocks in which the
///                   sink stalls, 1 if the frame is then run again and reset on the way
///   timestamps.hex  a line per clock of an acquisition: the timestamps of all columns, column 0 in the
///   lowest bits results.hex     a line per pixel, row by row: code, fraction, confidence, four digits each
/// Every pixel gets another kind of adversarial stream; every second column of a pool read-out sees one
/// surface.
void write_vectors(const ArrayParameters& array, std::span<const std::uint32_t> frames, std::uint64_t seed,
                   const std::filesystem::path& folder);

/// The same files with the photons of a scene instead, for figures that depend on what a sensor sees: the
/// columns in the middle of a map of 200 columns, sensor of the thesis with the array's NP and SLOTS, `klux`
/// of background light, source and sink without pauses. Throws InputError as PhotonSource does.
void write_scene_vectors(const ArrayParameters& array, Scene scene, double klux,
                         std::span<const std::uint32_t> frames, std::uint64_t seed,
                         const std::filesystem::path& folder);

/// A frame as text: timestamps.hex and results.hex of write_vectors().
struct FrameVectors {
  std::string timestamps;
  std::string results;
};

/// The whole frame of a source that has the array's rows and columns.
FrameVectors source_vectors(const ArrayParameters& array, const StreamSource& source);

}  // namespace dtof
