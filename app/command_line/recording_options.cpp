// SPDX-License-Identifier: Apache-2.0
#include "command_line/recording_options.hpp"

#include <vector>

#include "command_line/option_checks.hpp"

namespace dtof {
namespace {

/// What --format may be.
std::vector<std::string> recording_formats() {
  std::vector<std::string> formats = {"auto"};
  formats.insert(formats.end(), kRecordingFormats.begin(), kRecordingFormats.end());
  return formats;
}

}  // namespace

void add_recording_options(CLI::App& command, RecordingOptions& recording,
                           std::optional<double>& bin_width_ps, double& tick_ps) {
  command.add_option("--format", recording.format, "kind of file")
      ->check(CLI::IsMember(recording_formats()))
      ->capture_default_str();
  command.add_option("--bin-width", bin_width_ps, "histograms of arrays, logs: width of a bin in ps")
      ->check(duration_ps());
  command.add_option("--tick", tick_ps, "MAT: duration of a tick in ps")
      ->check(duration_ps())
      ->capture_default_str();
  command.add_option("--variable", recording.variable, "MAT: name of the cell array")->capture_default_str();
}

void refuse_recording_options(const CLI::App& command, const std::string& format) {
  if (format == "csv" || format == "picoquant" || format == "photon-hdf5" || format == "tmf8829") {
    refuse_without_effect(command, "--bin-width", "only arrays, TMF8820 and VL53L8CH lack it");
  }
  if (format != "mat" && format != "hdf5") {
    for (const char* option : {"--tick", "--variable"}) {
      refuse_without_effect(command, option, "only MATLAB files have one");
    }
  }
}

}  // namespace dtof
