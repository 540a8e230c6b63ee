// SPDX-License-Identifier: Apache-2.0
// The functions that the page's worker calls (worker.js), and nothing of C++ that it would have to know: a
// request is text, one "name value" a line; a failure is a sentence.
#include <emscripten.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/sensor/preset.hpp"
#include "dtof/sensor/sensor_file.hpp"
#include "playground/advice.hpp"
#include "playground/catalogue.hpp"
#include "playground/phases.hpp"
#include "playground/recorded_file.hpp"
#include "playground/request.hpp"
#include "playground/session.hpp"

// A function in JavaScript: work that takes long reports its progress to worker.js.
EM_JS(void, tell_worker, (const char* step, int done, int total),
      { adviceProgress(UTF8ToString(step), done, total); });

namespace {

std::unique_ptr<dtof::PlaygroundSession> session;
dtof::PlaygroundFiles files;
dtof::PlaygroundFrame frame;
std::string sensor_line;
std::string recording_line;
std::vector<dtof::Detection> detections;
std::unique_ptr<dtof::PixelTrace> trace;
std::vector<std::uint16_t> results;
std::vector<std::uint16_t> state;
std::vector<dtof::PoolCandidate> candidates;
std::string sentence;
std::string figures;
std::string phases;
std::string advice;

void report_progress(std::string_view step, std::size_t done, std::size_t total) {
  tell_worker(std::string(step).c_str(), static_cast<int>(done), static_cast<int>(total));
}

/// True if `work` succeeded; else `sentence` says why not.
bool attempt(const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const std::bad_alloc&) {
    sentence = "this needs more memory than a page has";
    return false;
  } catch (const std::exception& error) {
    sentence = error.what();
    return false;
  }
}

}  // namespace

extern "C" {

/// What the page offers.
const char* playground_catalogue() {
  static const std::string catalogue = dtof::playground_catalogue();
  return catalogue.c_str();
}
/// The sensor file that scenes have from now on; without text they have their preset.
bool playground_take_sensor(const char* name, const char* text) {
  return attempt([&] {
    sensor_line = *text == '\0' ? "" : dtof::playground_sensor_line(name, dtof::parse_sensor(text, name));
    files.sensor_name = name;
    files.sensor_text = text;
  });
}
/// The catalogue's line of that sensor.
const char* playground_sensor() { return sensor_line.c_str(); }
/// Text of a preset's sensor file, to begin a file of one's own with.
const char* playground_preset_text(const char* name) {
  static std::string text;
  text = "";
  return attempt([&] { text = dtof::preset_text(name); }) ? text.c_str() : "";
}
/// Advice for that sensor, or for the request's preset (playground/advice.hpp). Reports progress by
/// `report_progress`.
bool playground_advise(const char* request) {
  return attempt(
      [&] { advice = dtof::playground_advice(dtof::parse_advice_request(request), files, report_progress); });
}
const char* playground_advice_text() { return advice.c_str(); }
/// The depth map that scenes have from now on: its place, for metres row by row. Of 0 columns: none.
float* playground_take_map(int columns, int rows, const char* name) {
  files.map_name = name;
  files.map_columns = columns;
  files.map_rows = rows;
  files.map_m.assign(
      static_cast<std::size_t>(std::max(columns, 0)) * static_cast<std::size_t>(std::max(rows, 0)), 0.0F);
  return files.map_m.data();
}
/// The recording that stands for scenes from now on: its place, for the contents. Of 0 bytes: none.
char* playground_take_recording(const char* name, int bytes, double bin_width_ps) {
  files.recording_name = name;
  files.recording.assign(static_cast<std::size_t>(std::max(bytes, 0)), '\0');
  files.bin_width_ps = bin_width_ps;
  return files.recording.data();
}
/// Looks what the recording is: its line (playground_recording_line) is then in playground_recording.
bool playground_recognise() {
  return attempt([] { recording_line = dtof::playground_recording_line(files); });
}
const char* playground_recording() { return recording_line.c_str(); }
/// Begins a scene or a recording.
bool playground_begin(const char* request) {
  return attempt([&] {
    trace.reset();  // it belongs to the session
    session.reset();
    session = std::make_unique<dtof::PlaygroundSession>(dtof::parse_playground_request(request), files);
  });
}
/// Why the last call failed.
const char* playground_error() { return sentence.c_str(); }
int playground_columns() { return session->columns(); }
int playground_rows() { return session->rows(); }
const float* playground_truth() { return session->truth_m().data(); }
const float* playground_brightness() { return session->brightness().data(); }

bool playground_calibrate() {
  return attempt([] { session->calibrate(); });
}
bool playground_read_column(int column) {
  return attempt([&] { session->read_column(column); });
}

/// After the last column: the frame of a read-out, by its place in the request.
bool playground_frame(int readout) {
  return attempt([&] {
    frame = session->frame(static_cast<std::size_t>(readout));
    results.clear();
    for (const dtof::PixelResult& result : frame.results) {
      results.insert(results.end(), {result.code, result.fraction, result.confidence, result.second});
    }
    figures.clear();
    for (const std::string& figure : frame.figures) {
      figures += figures.empty() ? figure : "\n" + figure;
    }
  });
}
const float* playground_depth() { return frame.depth_m.data(); }
const float* playground_error_map() { return frame.error_m.data(); }
/// Four numbers a pixel: code, fraction, confidence, second position.
const std::uint16_t* playground_results() { return results.data(); }
/// What a pixel's TDC delivered over the frame: reads it, says how many detections there are, and where. A
/// detection is an acquisition of 32 bits and a timestamp of 16, in 8 bytes.
bool playground_pixel(int column, int row) {
  return attempt([&] {
    detections = session->pixel(column, row);
    trace = session->trace(column, row);
  });
}
int playground_detections() { return static_cast<int>(detections.size()); }
const dtof::Detection* playground_detection() {
  static_assert(sizeof(dtof::Detection) == 8 && offsetof(dtof::Detection, timestamp) == 4);
  return detections.data();
}
int playground_acquisitions() { return static_cast<int>(session->acquisitions()); }
int playground_codes() { return session->codes(); }
/// What a read-out, by its place in the request, makes of that pixel if the light ends before an acquisition
/// (PixelTrace). Its four numbers are those of playground_results.
bool playground_state(int readout, int until) {
  return attempt([&] {
    const dtof::PixelResult result =
        trace->result(session->readout(static_cast<std::size_t>(readout)), static_cast<std::uint32_t>(until));
    state = {result.code, result.fraction, result.confidence, result.second};
  });
}
const std::uint16_t* playground_state_numbers() { return state.data(); }
/// Candidates of the pixel's group at that time: a cell and a score each, in 8 bytes.
bool playground_candidates(int readout, int until) {
  return attempt([&] {
    candidates = trace->candidates(session->readout(static_cast<std::size_t>(readout)),
                                   static_cast<std::uint32_t>(until));
  });
}
int playground_candidate_count() { return static_cast<int>(candidates.size()); }
const dtof::PoolCandidate* playground_candidate() {
  static_assert(sizeof(dtof::PoolCandidate) == 8);
  return candidates.data();
}
/// Bits of a read-out's fraction.
int playground_fraction_bits(int readout) {
  return session->readout(static_cast<std::size_t>(readout)).fraction_bits;
}
/// Phases of a read-out's frame, one a line: the first acquisition after it, a tab, its name.
const char* playground_phases(int readout) {
  phases.clear();
  for (const dtof::ReadoutPhase& phase :
       dtof::readout_phases(session->readout(static_cast<std::size_t>(readout)), session->acquisitions())) {
    phases += (phases.empty() ? "" : "\n") + std::to_string(phase.end) + "\t" + phase.name;
  }
  return phases.c_str();
}
/// The figures of summary.csv, one a line.
const char* playground_figures() { return figures.c_str(); }
}
