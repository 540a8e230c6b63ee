// SPDX-License-Identifier: Apache-2.0
// The functions that the page's worker calls (worker.js), and nothing of C++ that it would have to know: a
// request is text, one "name value" a line; a failure is a sentence.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>

#include "playground/catalogue.hpp"
#include "playground/request.hpp"
#include "playground/session.hpp"

namespace {

std::unique_ptr<dtof::PlaygroundSession> session;
dtof::PlaygroundFrame frame;
std::string sentence;
std::string figures;

/// True if `work` succeeded; else `sentence` says why not.
bool attempt(const std::function<void()>& work) {
  try {
    work();
    return true;
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
/// Begins a scene.
bool playground_begin(const char* request) {
  return attempt(
      [&] { session = std::make_unique<dtof::PlaygroundSession>(dtof::parse_playground_request(request)); });
}
/// Why the last call failed.
const char* playground_error() { return sentence.c_str(); }
int playground_columns() { return session->columns(); }
int playground_rows() { return session->rows(); }
const float* playground_truth() { return session->truth_m().data(); }
const float* playground_reflectivity() { return session->reflectivity().data(); }

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
    figures.clear();
    for (const std::string& figure : frame.figures) {
      figures += figures.empty() ? figure : "\n" + figure;
    }
  });
}
const float* playground_depth() { return frame.depth_m.data(); }
const float* playground_error_map() { return frame.error_m.data(); }
/// Four numbers a pixel: code, fraction, confidence, second position.
const std::uint16_t* playground_results() {
  static_assert(sizeof(dtof::PixelResult) == 4 * sizeof(std::uint16_t));
  return &frame.results.front().code;
}
/// The figures of summary.csv, one a line.
const char* playground_figures() { return figures.c_str(); }
}
