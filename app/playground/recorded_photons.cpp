// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <utility>

#include "playground/photons.hpp"
#include "playground/recorded_file.hpp"
#include "playground/session.hpp"

namespace dtof {
namespace {

/// The recording as `dtof replay` replays it.
std::unique_ptr<StreamSource> open(const PlaygroundRequest& request, const PlaygroundFiles& files,
                                   const SensorModel& sensor) {
  return open_recorded_file(files, {.np = sensor.np,
                                    .integration_time = sensor.integration_time_s,
                                    .time_shift = request.shift_ns * 1e-9,
                                    .acquisitions = request.acquisitions.value_or(sensor.acquisitions),
                                    .slots = sensor.slots,
                                    .photon_budget = request.photons,
                                    .seed = request.seed});
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
