// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/recording/recording.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "playground/session.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A frame of 5 x 8 pixels as `dtof frame --record` writes it.
std::string recorded_csv() {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 600;
  const PhotonSource scene(sensor, make_scene(Scene::kPlane, {.columns = 5, .rows = 8}), 14.0, 3);
  std::string text = fmt::format("{}\n", kStreamCsvHeader);
  for (int column = 0; column < 5; ++column) {
    const ColumnStream stream = scene.column(column);
    for (int row = 0; row < 8; ++row) {
      for (const Detection& detection : stream.row(row)) {
        text += fmt::format("{},{},{},{}\n", detection.acquisition, column, row, detection.timestamp);
      }
    }
  }
  return text;
}

PlaygroundRequest some_readouts() {
  PlaygroundRequest request;
  request.acquisitions = 500;
  request.readouts = {"poolpointer", "hispointer", "sifh"};
  return request;
}

/// Results of each read-out as `dtof replay` has them.
std::vector<std::vector<PixelResult>> replayed(const RecordingOptions& options, const RecordingFile& file) {
  const Recording recording = open_recording(options, file);
  const ModelEngine engine({.threads = 1, .observer = [](std::size_t, std::size_t) {}});
  std::vector<std::vector<PixelResult>> frames;
  for (const std::string& name : some_readouts().readouts) {
    frames.push_back(engine
                         .read(*recording.source, default_parameters(parse_readout(name), {}),
                               Region::whole(recording.source->columns(), recording.source->rows()))
                         .results);
  }
  return frames;
}

/// Results of each read-out on the page.
std::vector<std::vector<PixelResult>> shown(const PlaygroundFiles& files) {
  PlaygroundSession session(some_readouts(), files);
  session.calibrate();
  for (int column = 0; column < session.columns(); ++column) {
    session.read_column(column);
  }
  std::vector<std::vector<PixelResult>> frames;
  for (std::size_t r = 0; r < some_readouts().readouts.size(); ++r) {
    frames.push_back(session.frame(r).results);
  }
  return frames;
}

TEST(RecordedPhotons, AStreamIsReadAsReplayReadsIt) {
  const std::string text = recorded_csv();
  const auto expected = replayed({.file = "mine.csv"}, {.contents = text, .format = "csv"});
  EXPECT_EQ(shown({.recording_name = "mine.csv", .recording = text}), expected);
  // The comparison sees a recording without its last 2,000 lines.
  std::size_t end = text.size();
  for (int line = 0; line < 2000; ++line) {
    end = text.rfind('\n', end - 1);
  }
  EXPECT_NE(shown({.recording_name = "mine.csv", .recording = text.substr(0, end)}), expected);
}

TEST(RecordedPhotons, HistogramsAreReadAsReplayReadsThem) {
  std::string array = npy_header("|u1", std::vector<std::size_t>{8, 3, 64});
  for (int i = 0; i < 8 * 3 * 64; ++i) {
    array += static_cast<char>(i % 64 == 20 ? 90 : 2);
  }
  const auto expected = replayed({.file = "mine.npy",
                                  .bin_width_s = 500e-12,
                                  .acquisitions = 500,
                                  .resampling = {.integration_time = 45e-9}},
                                 {.contents = array, .format = "npy"});
  EXPECT_EQ(shown({.recording_name = "mine.npy", .recording = array, .bin_width_ps = 500.0}), expected);
}

TEST(RecordedPhotons, HaveDetectionsAndDistancesButNoTruth) {
  PlaygroundSession session(some_readouts(), {.recording_name = "mine.csv", .recording = recorded_csv()});
  EXPECT_EQ(session.columns(), 5);
  EXPECT_EQ(session.rows(), 8);
  EXPECT_EQ(session.acquisitions(), 600U);
  EXPECT_TRUE(std::isnan(session.truth_m()[17]));
  EXPECT_EQ(session.brightness()[17], static_cast<float>(session.pixel(2, 3).size()));
  session.calibrate();
  for (int column = 0; column < 5; ++column) {
    session.read_column(column);
  }
  const PlaygroundFrame frame = session.frame(1);
  const ReadoutParameters& readout = session.readout(1);
  ASSERT_GT(frame.results[17].confidence, 0);
  EXPECT_FLOAT_EQ(
      frame.depth_m[17],
      static_cast<float>(
          DepthScale(45e-9, readout.np, 0.0).depth(code_position(frame.results[17], readout.fraction_bits))));
  EXPECT_TRUE(std::isnan(frame.error_m[17]));
}

TEST(RecordedPhotons, RefusesWhatIsNoRecording) {
  const auto with = [](const PlaygroundFiles& files) {
    return [files] { PlaygroundSession(some_readouts(), files); };
  };
  const std::string header = fmt::format("{}\n", kStreamCsvHeader);
  EXPECT_THAT(with({.recording_name = "mine.csv", .recording = "time,x\n1,2\n"}),
              ThrowsMessage<InputError>(HasSubstr("mine.csv:1: ")));
  EXPECT_THAT(with({.recording_name = "mine.csv", .recording = header + "0,0,0,5\n0,1,0,1024\n"}),
              ThrowsMessage<InputError>(HasSubstr("mine.csv:3: timestamp 1024 is outside 0..1023")));
  EXPECT_THAT(with({.recording_name = "mine.csv", .recording = header}),
              ThrowsMessage<InputError>(HasSubstr("no detections")));
  EXPECT_THAT(with({.recording_name = "mine.npy", .recording = "\x93NUMPY"}),
              ThrowsMessage<InputError>(HasSubstr("needs the width of a bin")));
  std::string late = npy_header("|u1", std::vector<std::size_t>{1, 1, 2});
  late += std::string("\0\5", 2);
  EXPECT_THAT(with({.recording_name = "late.npy", .recording = late, .bin_width_ps = 60000.0}),
              ThrowsMessage<InputError>(HasSubstr("all 5 photons are outside the range, 0 to 45 ns")));
}

}  // namespace
}  // namespace dtof
