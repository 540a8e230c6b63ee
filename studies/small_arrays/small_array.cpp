// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/small_array.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/array_size.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/kept_streams.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

/// Null if no rival has the name.
const RivalEntry* rival_or_none(std::string_view name) {
  const std::span<const RivalEntry> rivals = all_rivals();
  const auto entry = std::ranges::find(rivals, name, &RivalEntry::name);
  return entry == rivals.end() ? nullptr : &*entry;
}

std::unique_ptr<StreamSource> make_source(const SensorModel& sensor, const TargetMap& targets, double klux,
                                          std::uint64_t seed, std::uint32_t frame) {
  PhotonSource exact(sensor, targets, klux, seed, frame);
  if (FastPhotonSource::supports(sensor)) {
    return std::make_unique<FastPhotonSource>(std::move(exact));
  }
  return std::make_unique<PhotonSource>(std::move(exact));
}

}  // namespace

SensorModel sharing_the_laser(const SensorModel& sensor, const SpotGrid& grid) {
  const auto pixels = [](int columns, int rows) { return static_cast<double>(columns) * rows; };
  SensorModel changed =
      with_sensors(sensor, kThesisSensors * pixels(grid.small_columns(), grid.small_rows()) /
                               pixels(grid.columns, grid.rows));
  changed.columns = grid.small_columns();
  changed.rows = grid.small_rows();
  return changed;
}

void check_small_readout(const std::string& name, const SensorModel& sensor) {
  const RivalEntry* const entry = rival_or_none(name);
  if (entry == nullptr) {
    (void)parse_readout(name);
  } else if (const int frames = entry->make(sensor)->frames(); frames != 1) {
    throw InputError(fmt::format("small array: {} needs {} frames, not one", name, frames));
  }
}

SmallArray::SmallArray(const SensorModel& sensor, SpotGrid grid, double klux,
                       std::span<const std::string> readouts, std::uint64_t calibration_seed, int threads)
    : sensor_(sharing_the_laser(sensor, grid)), grid_(std::move(grid)), klux_(klux), threads_(threads) {
  const FlatCalibration calibration(sensor_);
  const auto photons = [&](const TargetMap& targets) {
    return make_source(sensor_, targets, klux_, calibration_seed, FlatCalibration::kFrame);
  };
  for (const std::string& name : readouts) {
    check_small_readout(name, sensor_);
    const RivalEntry* const entry = rival_or_none(name);
    Reader& reader = readers_.emplace_back();
    if (entry == nullptr) {
      reader.readout = {default_parameters(parse_readout(name), sensor_)};
      titles_.emplace_back(readout_title(reader.readout.front().readout));
      tables_.push_back(calibration.fit(photons, reader.readout, calibration_seed, threads_).front());
      continue;
    }
    reader.rival = entry->make(sensor_);
    titles_.emplace_back(entry->title);
    const std::vector<Measurement> measured = read_rival(*reader.rival, *photons(calibration.targets()));
    tables_.push_back(calibration.fit(measured, 0.0, calibration_seed));
  }
}

std::vector<Measurement> SmallArray::read_rival(const Rival& rival, const StreamSource& source) const {
  const auto width = static_cast<std::size_t>(source.columns());
  std::vector<Measurement> measured(width * static_cast<std::size_t>(source.rows()));
  parallel_for(width, threads_, [&](std::size_t column) {
    const ColumnStream stream = source.column(static_cast<int>(column));
    for (int row = 0; row < source.rows(); ++row) {
      const std::array<std::span<const Detection>, 1> frames = {stream.row(row)};
      measured[static_cast<std::size_t>(row) * width + column] = rival.decode(rival.read_pixel(frames));
    }
  });
  return measured;
}

std::vector<SmallMap> SmallArray::measure(const TargetMap& targets, std::uint64_t seed) const {
  const TargetMap spots = spots_of(targets, grid_);
  const std::unique_ptr<StreamSource> source = make_source(sensor_, spots, klux_, seed, scene_frame(0));
  const KeptStreams kept(*source);
  std::vector<SmallMap> maps;
  for (std::size_t i = 0; i < readers_.size(); ++i) {
    std::vector<Measurement> measured;
    if (readers_[i].rival) {
      measured = read_rival(*readers_[i].rival, kept);
    } else {
      const ReadoutParameters& readout = readers_[i].readout.front();
      for (const PixelResult& result : run_frame(kept, readout, threads_)) {
        measured.push_back(to_measurement(result, readout.fraction_bits));
      }
    }
    SmallMap map{grid_, {}, {}};
    for (const Measurement& pixel : measured) {
      map.distance_m.push_back(tables_[i].distance(pixel.position));
      map.confidence.push_back(pixel.confidence);
    }
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace dtof
