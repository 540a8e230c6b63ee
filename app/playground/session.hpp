// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "playground/photons.hpp"
#include "playground/pixel_trace.hpp"

namespace dtof {

/// Settings of the page: a frame as from `dtof frame` or, with a recording, `dtof replay` with the same
/// options.
struct PlaygroundRequest {
  std::string sensor = "thesis";
  std::string scene = "room";
  std::optional<int> columns;  ///< columns of the array; none: the sensor's
  std::optional<int> rows;
  double distance_m = 1.0;  ///< flat
  double near_m = 0.8;      ///< staircase and plane
  double far_m = 5.0;
  int steps = 8;  ///< staircase
  std::optional<double> reflectivity;
  double klux = 14.0;
  std::optional<std::uint32_t> acquisitions;
  std::uint64_t seed = 1;
  std::optional<double> photons;      ///< of a recording: mean number per pixel; none: all
  double shift_ns = 0.0;              ///< of a recording: added to every time
  std::vector<std::string> readouts;  ///< names
};

/// Files that a visitor of the page opens.
struct PlaygroundFiles {
  std::string sensor_name = {};  ///< name of the sensor file, for error messages
  std::string sensor_text = {};  ///< text of the sensor file; empty: use the request's preset
  std::string map_name = "map";  ///< name of the depth map's file, for error messages
  int map_columns = 0;           ///< columns of a depth map; 0: use the request's scene
  int map_rows = 0;
  std::vector<float> map_m = {};  ///< [row][column], row 0 on top; 0: unknown
  std::string recording_name = {};
  /// Contents of a recording (recorded_file.hpp), unpacked; empty: use the scene or depth map.
  std::string recording = {};
  double bin_width_ps = 0.0;  ///< of the recording's histograms; 0: not given
};

/// Results of one read-out for a frame, row-major.
struct PlaygroundFrame {
  std::vector<PixelResult> results;
  std::vector<float> depth_m;
  std::vector<float> error_m;        ///< NaN without a true distance
  std::vector<std::string> figures;  ///< as in `summary.csv` (figure_names)
};

/// A scene or recording that several read-outs process together, column by column, so that the page can show
/// progress. Photons are drawn once.
class PlaygroundSession {
 public:
  /// Throws InputError for an illegal request or file.
  explicit PlaygroundSession(const PlaygroundRequest& request, const PlaygroundFiles& files = {});
  PlaygroundSession(const PlaygroundSession&) = delete;
  PlaygroundSession& operator=(const PlaygroundSession&) = delete;
  PlaygroundSession(PlaygroundSession&&) = delete;
  PlaygroundSession& operator=(PlaygroundSession&&) = delete;
  ~PlaygroundSession() = default;

  [[nodiscard]] int columns() const { return photons_->source().columns(); }
  [[nodiscard]] int rows() const { return photons_->source().rows(); }
  [[nodiscard]] const std::vector<float>& truth_m() const { return photons_->truth_m(); }
  /// Reflectivity of each pixel's target, or of a recording the number of a pixel's detections.
  [[nodiscard]] const std::vector<float>& brightness() const { return brightness_; }

  /// Fits the look-up tables; a recording has none.
  void calibrate();
  /// Reads out a column; call it for all columns, from left to right. Columns that depend on each other are
  /// processed together with the last of them.
  void read_column(int column);
  /// Frame of the read-out with this index in the request, after all columns were read.
  [[nodiscard]] PlaygroundFrame frame(std::size_t readout) const;
  /// Detections of a pixel over the frame.
  [[nodiscard]] std::vector<Detection> pixel(int column, int row) const;
  [[nodiscard]] std::uint32_t acquisitions() const { return photons_->source().acquisitions(); }
  /// Number of codes of a timestamp.
  [[nodiscard]] int codes() const { return 1 << photons_->sensor().np; }
  /// Trace of a pixel. The session must outlive it.
  [[nodiscard]] std::unique_ptr<PixelTrace> trace(int column, int row) const;
  /// Parameters of the read-out with this index in the request.
  [[nodiscard]] const ReadoutParameters& readout(std::size_t index) const { return readouts_.at(index); }

 private:
  void require_pixel(int column, int row) const;

  ModelEngine engine_;
  std::unique_ptr<PlaygroundPhotons> photons_;
  std::vector<float> brightness_;
  std::vector<ReadoutParameters> readouts_;
  std::vector<int> read_;                          // of each read-out, the first column not yet read
  int dropped_ = 0;                                // the first column whose photons are kept
  std::vector<std::vector<PixelResult>> results_;  // of each read-out, row-major
};

}  // namespace dtof
