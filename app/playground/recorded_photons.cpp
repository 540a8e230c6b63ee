// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <limits>
#include <numeric>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/stream_csv.hpp"
#include "playground/photons.hpp"
#include "playground/session.hpp"

namespace dtof {
namespace {

/// Throws InputError if photons were measured, but none of them within T_int.
void require_photons_in_range(const HistogramStream& stream, const std::string& name, double range_s) {
  std::vector<int> columns(static_cast<std::size_t>(stream.columns()));
  std::iota(columns.begin(), columns.end(), 0);
  const PhotonCount photons = stream.count_photons(columns, {0, stream.rows()});
  if (photons.all > 0 && photons.outside == photons.all) {
    throw InputError(fmt::format("{}: all {} photons are outside the range, 0 to {:g} ns", name, photons.all,
                                 range_s * 1e9));
  }
}

/// The recording as `dtof replay` replays it.
std::unique_ptr<StreamSource> open(const PlaygroundRequest& request, const PlaygroundFiles& files,
                                   const SensorModel& sensor) {
  const std::string& name = files.recording_name;
  if (!files.recording.starts_with("\x93NUMPY")) {
    return std::make_unique<RecordedStream>(
        parse_stream_csv(name, files.recording, {.np = sensor.np, .slots = sensor.slots}));
  }
  if (!(files.bin_width_ps > 0.0)) {
    throw InputError(fmt::format("{}: an NPY histogram needs the width of a bin in ps", name));
  }
  auto stream = std::make_unique<HistogramStream>(
      histogram_cube(parse_npy(name, files.recording), files.bin_width_ps * 1e-12, 0.0, name),
      Resampling{.np = sensor.np,
                 .integration_time = sensor.integration_time_s,
                 .acquisitions = request.acquisitions.value_or(sensor.acquisitions),
                 .slots = sensor.slots,
                 .seed = request.seed});
  require_photons_in_range(*stream, name, sensor.integration_time_s);
  return stream;
}

/// What the page's sensor means for a recording: T_int, NP and SLOTS. As in `dtof replay`, all else is that
/// of the thesis, and no pulse width is subtracted from a distance.
SensorModel recording_sensor(const PlaygroundRequest& request, const PlaygroundFiles& files) {
  const SensorModel chosen = playground_sensor(request, files);
  SensorModel sensor;
  sensor.np = chosen.np;
  sensor.slots = chosen.slots;
  sensor.integration_time_s = chosen.integration_time_s;
  sensor.acquisitions = chosen.acquisitions;
  return sensor;
}

class RecordedPhotons final : public PlaygroundPhotons {
 public:
  RecordedPhotons(const PlaygroundRequest& request, const PlaygroundFiles& files, const FrameEngine& engine)
      : engine_(engine),
        sensor_(recording_sensor(request, files)),
        source_(open(request, files, sensor_)),
        truth_m_(static_cast<std::size_t>(source_->columns()) * static_cast<std::size_t>(source_->rows()),
                 std::numeric_limits<float>::quiet_NaN()) {}

  [[nodiscard]] const StreamSource& source() const override { return *source_; }
  [[nodiscard]] const SensorModel& sensor() const override { return sensor_; }
  [[nodiscard]] const std::vector<float>& truth_m() const override { return truth_m_; }
  [[nodiscard]] std::vector<float> brightness() const override {
    std::vector<float> counts(truth_m_.size());
    const auto width = static_cast<std::size_t>(source_->columns());
    for (int column = 0; column < source_->columns(); ++column) {
      const ColumnStream stream = source_->column(column);
      for (int row = 0; row < stream.rows(); ++row) {
        counts[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)] =
            static_cast<float>(stream.row(row).size());
      }
    }
    return counts;
  }

  void calibrate(std::span<const ReadoutParameters> readouts) override {
    readouts_.assign(readouts.begin(), readouts.end());
  }
  [[nodiscard]] std::vector<PixelResult> read(const ReadoutParameters& readout,
                                              std::vector<int> columns) const override {
    return engine_.read(*source_, readout, {.columns = std::move(columns), .rows = {0, source_->rows()}})
        .results;
  }
  void drop(int /*column*/) override {}
  [[nodiscard]] FrameMaps judge(std::span<const PixelResult> results, std::size_t readout) const override {
    SensorModel without_pulse = sensor_;
    without_pulse.pulse_fwhm_s = 0.0;
    return frame_maps(results, readouts_.at(readout), without_pulse, std::nullopt, truth_m_);
  }

 private:
  const FrameEngine& engine_;
  SensorModel sensor_;
  std::unique_ptr<StreamSource> source_;
  std::vector<float> truth_m_;
  std::vector<ReadoutParameters> readouts_;
};

}  // namespace

std::unique_ptr<PlaygroundPhotons> make_recorded_photons(const PlaygroundRequest& request,
                                                         const PlaygroundFiles& files,
                                                         const FrameEngine& engine) {
  return std::make_unique<RecordedPhotons>(request, files, engine);
}

}  // namespace dtof
