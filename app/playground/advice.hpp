// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "playground/session.hpp"

namespace dtof {

/// Settings of the page's advice: those of `dtof design --quick` with the same options.
struct AdviceRequest {
  std::string sensor = "thesis";
  std::optional<double> most_mm2;
  std::optional<double> most_mw;
  double frames_per_s = 30.0;
  double clock_mhz = 330.0;
  std::uint64_t seed = 1;
};

/// Parses a request of one "name value" a line: sensor, max-mm2, max-mw, frame-rate, clock-mhz, seed. Throws
/// InputError for any other line.
AdviceRequest parse_advice_request(std::string_view text);

/// Called while the advice is computed: name of the step, work done, total work.
using AdviceObserver = std::function<void(std::string_view step, std::size_t done, std::size_t total)>;

/// Advice of run_design() on the sensor file, or else the preset, as lines of fields between tabs:
///
///     head, row           cells of the table of read-outs, best first
///     recommendation      sentences on the recommended read-out
///     change              effect of a limit that is 10 % tighter or looser
///     clocks              clocks of a read-out's frame, in the order of the rows
///     left                a read-out that was left out, and the reason
///     readout             command-line name of the recommended read-out
///     product             options of `dtof product` for this read-out
///
/// Throws InputError for an illegal sensor, and, with one line that says what would be needed, if no read-out
/// keeps the limits.
std::string playground_advice(const AdviceRequest& request, const PlaygroundFiles& files,
                              const AdviceObserver& observer = {});

}  // namespace dtof
