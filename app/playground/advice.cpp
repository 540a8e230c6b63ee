// SPDX-License-Identifier: Apache-2.0
#include "playground/advice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "design/design_page.hpp"
#include "dtof/design/design.hpp"
#include "playground/photons.hpp"

namespace dtof {
namespace {

DesignRequest design_request(const AdviceRequest& request, const PlaygroundFiles& files,
                             const AdviceObserver& observer) {
  PlaygroundRequest frame;
  frame.sensor = request.sensor;
  DesignRequest design;
  design.bench.sensor = playground_sensor(frame, files);
  design.bench.seed = request.seed;
  design.bench.threads = kOneThread;
  design.limits.most_mm2 = request.most_mm2.value_or(design.limits.most_mm2);
  design.limits.most_mw = request.most_mw.value_or(design.limits.most_mw);
  design.limits.budget = {.clock_hz = request.clock_mhz * 1e6, .frames_per_s = request.frames_per_s};
  design.observer = observer;
  return quick_design(std::move(design));
}

/// Each line of a text as a line of this kind, without the "* " of a list.
std::string lines_of(std::string_view kind, const std::string& text) {
  std::string lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines += fmt::format("{}\t{}\n", kind, line.starts_with("* ") ? line.substr(2) : line);
  }
  return lines;
}

}  // namespace

std::string playground_advice(const AdviceRequest& asked, const PlaygroundFiles& files,
                              const AdviceObserver& observer) {
  const DesignRequest request = design_request(asked, files, observer);
  const DesignResult result = run_design(request);
  std::string text;
  const Table table = design_rows(request, result);
  for (const std::vector<std::string>& cells : table.cells()) {
    text += fmt::format("{}\t{}\n", text.empty() ? "head" : "row", fmt::join(cells, "\t"));
  }
  text += lines_of("recommendation", design_recommendation(request, result));
  text += lines_of("change", design_consequences(request, result));
  for (const std::string& sentence : design_clocks(request, result)) {
    text += lines_of("clocks", sentence);
  }
  for (const LeftOut& one : result.left_out) {
    text += fmt::format("left\t{}\t{}\n", readout_title(one.readout), one.reason);
  }
  const DesignCandidate& chosen = result.options[*result.recommendation.chosen].candidate;
  text += fmt::format("readout\t{}\n", readout_name(chosen.readout()));
  text += fmt::format("product\t{}\n", product_options(chosen.array, request.bench.sensor));
  return text;
}

}  // namespace dtof
