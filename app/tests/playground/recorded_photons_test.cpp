// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/recording/recording.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "playground/recorded_file.hpp"
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
std::vector<std::vector<PixelResult>> shown(const PlaygroundFiles& files,
                                            const PlaygroundRequest& request = some_readouts()) {
  PlaygroundSession session(request, files);
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

/// A file of each kind that a page reads from memory, and what the page must know of it.
struct MemoryFile {
  std::string name;
  std::string format;
  std::string line;  ///< playground_recording_line
  std::string contents;
  double bin_width_ps = 0.0;
  std::optional<double> photons = std::nullopt;
};

/// "20,21,...": so many numbers with a peak.
std::string counts(int bins, int peak, int height) {
  std::string text;
  for (int bin = 0; bin < bins; ++bin) {
    text += fmt::format("{}{}", bin == 0 ? "" : ",", bin == peak ? height : bin % 3);
  }
  return text;
}

template <typename T>
std::string bytes_of(T number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

std::string tmf8820_json() {
  std::string zones;
  for (int zone = 0; zone < 9; ++zone) {
    zones += fmt::format("{}[{}]", zone == 0 ? "" : ",", counts(128, 30 + zone, 60));
  }
  return fmt::format(
      R"([{{"dist_to_plane": 0.4, "hists": [{0}]}}, {{"dist_to_plane": 0.4, "hists": [{0}]}}])", zones);
}

/// Four channels of 10 lines, 30 lines a capture, as the Arduino firmware of a TMF8820 prints them.
std::string tmf8820_log() {
  std::string text = "#Conf,65,SPAD=1\n";
  for (int index = 0; index < 30; ++index) {
    text += fmt::format(
        "#Raw,65,{},{}\n", index, index < 10 ? counts(128, 40, 90) : std::string("0") + [] {
          std::string zeros;
          for (int bin = 1; bin < 128; ++bin) {
            zeros += ",0";
          }
          return zeros;
        }());
  }
  return text;
}

std::string tmf8829_json() {
  std::string rows;
  std::string results;
  for (int row = 0; row < 2; ++row) {
    std::string pixels;
    std::string peaks;
    for (int column = 0; column < 3; ++column) {
      pixels += fmt::format("{}{{\"bin\": [{}]}}", column == 0 ? "" : ",", counts(64, 10 + row + column, 70));
      peaks += fmt::format("{}{{\"peaks\": [{{\"distance\": 900}}]}}", column == 0 ? "" : ",");
    }
    rows += fmt::format("{}[{}]", row == 0 ? "" : ",", pixels);
    results += fmt::format("{}[{}]", row == 0 ? "" : ",", peaks);
  }
  return fmt::format(R"({{"Result_Set": [{{"results": [{}], "mp_histo": [{}]}}]}})", results, rows);
}

std::string vl53l8ch_text() {
  return fmt::format("Agg, 0, Ambient, 1.5, Bins, {0}\nAgg, 1, Ambient, 1.5, Bins, {0}\n",
                     counts(18, 6, 40) + ".25");
}

/// HT3 of format 2.0, T3, a unit of 16 ps: 200 photons of two detectors around 10 ns.
std::string ht3() {
  std::string file(0x2b8, '\0');
  file.replace(0, 9, "HydraHarp");
  file.replace(16, 3, "2.0");
  file.replace(0x14c, 4, bytes_of(std::int32_t{32}));
  file.replace(0x154, 4, bytes_of(std::int32_t{3}));
  file.replace(0x160, 8, bytes_of(16.0));
  file += std::string(16, '\0') + bytes_of(std::int64_t{200});
  for (std::uint32_t photon = 0; photon < 200; ++photon) {
    file += bytes_of((photon % 2) << 25U | (600 + photon % 50) << 10U | photon);
  }
  return file;
}

std::string mat_element(std::uint32_t type, const std::string& data) {
  return bytes_of(type) + bytes_of(static_cast<std::uint32_t>(data.size())) + data +
         std::string((8 - data.size() % 8) % 8, '\0');
}

/// A matrix element of MATLAB 5 of one row.
std::string mat_matrix(std::uint32_t kind, const std::string& name, std::int32_t columns,
                       const std::string& contents) {
  return mat_element(14, mat_element(6, bytes_of(kind) + bytes_of(std::uint32_t{0})) +
                             mat_element(5, bytes_of(std::int32_t{1}) + bytes_of(columns)) +
                             mat_element(1, name) + contents);
}

/// Cells of two pixels, as `save -v6` writes them: photons at ticks 1000, 1001, ..., each 8 ps.
std::string photon_times() {
  std::string cells;
  for (int pixel = 0; pixel < 2; ++pixel) {
    std::string ticks;
    for (int photon = 0; photon < 40; ++photon) {
      ticks += bytes_of(1000.0 + 500.0 * pixel + photon);
    }
    cells += mat_matrix(6, "", 40, mat_element(9, ticks));
  }
  std::string header = "MATLAB 5.0 MAT-file";
  header.resize(124, ' ');
  return header + std::string("\x00\x01IM", 4) + mat_matrix(1, "photon_times", 2, cells);
}

std::vector<MemoryFile> memory_files() {
  return {{"a.json", "tmf8820", "tmf8820\t1\tmay", tmf8820_json()},
          {"thin.json", "tmf8820", "tmf8820\t1\tmay", tmf8820_json(), 0.0, 50.0},
          {"wide.json", "tmf8820", "tmf8820\t1\tmay", tmf8820_json(), 180.0},
          {"log.txt", "tmf8820", "tmf8820\t1\tmay", tmf8820_log()},
          {"b.json", "tmf8829", "tmf8829\t1\tno", tmf8829_json()},
          {"cnh.csv", "vl53l8ch", "vl53l8ch\t1\tmust", vl53l8ch_text(), 500.8, 200.0},
          {"a.ht3", "picoquant", "picoquant\t1\tno", ht3()},
          {"a.mat", "mat", "mat\t1\tmay", photon_times()}};
}

TEST(RecordedPhotons, LogsTimeTagsAndPhotonTimesAreReadAsReplayReadsThem) {
  for (const MemoryFile& one : memory_files()) {
    SCOPED_TRACE(one.name);
    RecordingOptions options{.file = one.name,
                             .acquisitions = 500,
                             .resampling = {.integration_time = 45e-9, .photon_budget = one.photons}};
    if (one.bin_width_ps > 0.0) {
      options.bin_width_s = one.bin_width_ps * 1e-12;
    }
    const auto expected = replayed(options, {.contents = one.contents, .format = one.format});
    const PlaygroundFiles files{
        .recording_name = one.name, .recording = one.contents, .bin_width_ps = one.bin_width_ps};
    PlaygroundRequest request = some_readouts();
    request.photons = one.photons;
    EXPECT_EQ(playground_recording_line(files), one.line);
    EXPECT_EQ(shown(files, request), expected);
    EXPECT_TRUE(std::ranges::any_of(expected.back(), [](const PixelResult& pixel) { return pixel.code > 0; }))
        << "the comparison has results";
    // The comparison sees another shift.
    request.shift_ns = 3.0;
    EXPECT_NE(shown(files, request), expected);
  }
}

TEST(RecordedPhotons, TheLineOfOtherFiles) {
  const auto line = [](const std::string& name, const std::string& contents) {
    return playground_recording_line({.recording_name = name, .recording = contents});
  };
  EXPECT_EQ(line("mine.csv", recorded_csv()), "csv\t0\tno");
  EXPECT_EQ(line("mine.CSV", "hello"), "csv\t0\tno") << "its refusal names the line";
  EXPECT_EQ(line("mine.npz", "\x93NUMPY"), "npy\t1\tmust");
  EXPECT_EQ(line("mine.ptu", std::string("PQTTTR\0\0", 8)), "picoquant\t1\tno");
  EXPECT_EQ(line("mine.txt", "hello"), "");
  constexpr const char* kNoHdf5 =
      ": HDF5 (also MATLAB 7.3 and Photon-HDF5) needs libhdf5, which a page does not have; dtof convert "
      "makes an "
      "NPZ or a CSV of it";
  for (const char* const contents : {"\x89HDF\r\n\x1a\n", "MATLAB 7.3 MAT-file, Platform"}) {
    EXPECT_THAT([&] { (void)line("mine.mat", contents); },
                ThrowsMessage<InputError>(std::string("mine.mat") + kNoHdf5));
  }
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
  const std::string no_syncs = [] {
    std::string file = ht3();
    file.replace(0x154, 4, bytes_of(std::int32_t{2}));
    file.replace(0x288, 8, bytes_of(1.0));
    return file;
  }();
  EXPECT_THAT(with({.recording_name = "t2.ht2", .recording = no_syncs}),
              ThrowsMessage<InputError>(HasSubstr("t2.ht2: the file is of mode T2 and has no syncs")));
  EXPECT_THAT(with({.recording_name = "cut.ht3", .recording = ht3().substr(0, 720)}),
              ThrowsMessage<InputError>("cut.ht3: the file has no photons in its 0 records"));
  EXPECT_THAT(with({.recording_name = "cut.ht3", .recording = ht3().substr(0, 723)}),
              ThrowsMessage<InputError>("cut.ht3: the file ends in record 0"));
  EXPECT_THAT(with({.recording_name = "a.json", .recording = "[{"}),
              ThrowsMessage<InputError>(HasSubstr("a.json: parse error at line 1")));
  EXPECT_THAT(with({.recording_name = "cnh.txt", .recording = vl53l8ch_text()}),
              ThrowsMessage<InputError>(HasSubstr("does not say how wide its bins are")));
  EXPECT_THAT(with({.recording_name = "cnh.txt", .recording = vl53l8ch_text(), .bin_width_ps = 500.0}),
              ThrowsMessage<InputError>(HasSubstr("is not an integer; give a photon budget")));
  std::string many = npy_header("<f8", std::vector<std::size_t>{2, 8, 1});
  for (int i = 0; i < 16; ++i) {
    many += bytes_of(5e6);
  }
  EXPECT_THAT(
      with({.recording_name = "many.npy", .recording = many, .bin_width_ps = 100.0}),
      ThrowsMessage<InputError>(
          "many.npy: its 80000000 photons are more than the 67108864 that a page draws: give the photons "
          "per pixel"));
}

}  // namespace
}  // namespace dtof
