// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"

namespace dtof {

/// What the page's controls say: a frame as `dtof frame` with these options makes it.
struct PlaygroundRequest {
  std::string sensor = "thesis";
  std::string scene = "room";
  std::optional<int> columns;  ///< of the array; else the sensor's
  std::optional<int> rows;
  double distance_m = 1.0;  ///< flat
  double near_m = 0.8;      ///< staircase and plane
  double far_m = 5.0;
  int steps = 8;  ///< staircase
  std::optional<double> reflectivity;
  double klux = 14.0;
  std::optional<std::uint32_t> acquisitions;
  std::uint64_t seed = 1;
  std::vector<std::string> readouts;  ///< names
};

/// Files that a visitor of the page gives.
struct PlaygroundFiles {
  std::string sensor_name = {};  ///< the file's, for messages
  std::string sensor_text = {};  ///< a sensor file; empty: the request's preset
  int map_columns = 0;           ///< of a depth map; 0: the request's scene
  int map_rows = 0;
  std::vector<float> map_m = {};  ///< [row][column], row 0 on top; 0: unknown
};

/// A frame of one read-out, row-major.
struct PlaygroundFrame {
  std::vector<PixelResult> results;
  std::vector<float> depth_m;
  std::vector<float> error_m;        ///< NaN where the truth is unknown
  std::vector<std::string> figures;  ///< as `summary.csv` has them (figure_names)
};

/// A scene that several read-outs see at once: its photons are drawn once, column by column, so that a page
/// can show how far it is.
class PlaygroundSession {
 public:
  /// Throws InputError.
  explicit PlaygroundSession(const PlaygroundRequest& request, const PlaygroundFiles& files = {});
  PlaygroundSession(const PlaygroundSession&) = delete;
  PlaygroundSession& operator=(const PlaygroundSession&) = delete;
  PlaygroundSession(PlaygroundSession&&) = delete;
  PlaygroundSession& operator=(PlaygroundSession&&) = delete;
  ~PlaygroundSession() = default;

  [[nodiscard]] int columns() const { return pipeline_.scene().columns(); }
  [[nodiscard]] int rows() const { return pipeline_.scene().rows(); }
  [[nodiscard]] const std::vector<float>& truth_m() const { return pipeline_.truth().metres; }
  [[nodiscard]] const std::vector<float>& reflectivity() const { return reflectivity_; }

  /// Fits the look-up tables.
  void calibrate();
  /// Reads a column out; all of them are to be read, from left to right. Columns that hear each other wait
  /// for the last of them.
  void read_column(int column);
  /// What a read-out of the request (by its place there) made of the columns, after all were read.
  [[nodiscard]] PlaygroundFrame frame(std::size_t readout) const;
  /// What the TDC of a pixel delivered over the frame.
  [[nodiscard]] std::vector<Detection> pixel(int column, int row) const;
  [[nodiscard]] std::uint32_t acquisitions() const { return pipeline_.scene().acquisitions(); }
  /// Codes that a timestamp can have.
  [[nodiscard]] int codes() const;

 private:
  ModelEngine engine_;
  FramePipeline pipeline_;
  std::vector<float> reflectivity_;
  std::vector<ReadoutParameters> readouts_;
  std::vector<TabledReadout> tabled_;
  std::vector<int> read_;                          // of each read-out, the first column not yet read
  int forgotten_ = 0;                              // the first column whose photons are kept
  std::vector<std::vector<PixelResult>> results_;  // of each read-out, row-major
};

}  // namespace dtof
