// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/option_checks.hpp"
#include "commands/commands.hpp"
#include "commands/json_result.hpp"
#include "dtof/convert/conversion.hpp"
#include "dtof/core/error.hpp"

namespace dtof {
namespace {

struct ConvertCommand {
  ConversionOptions conversion;
  std::optional<double> bin_width_ps;
  double tick_ps = 8.0;
  double t_int_ns = 45.0;
  double shift_ns = 0.0;
  bool json = false;
  std::string command_line;
};

/// Options that say nothing about such an input or output.
void check_convert_options(const CLI::App& command, const ConversionInput& input, OutputKind output) {
  const auto refuse = [&](bool without_effect, const std::vector<const char*>& options, const char* reason) {
    for (const char* const option : options) {
      if (without_effect) {
        refuse_without_effect(command, option, reason);
      }
    }
  };
  const bool map = input.kind == InputKind::kMap;
  const bool array = input.kind == InputKind::kArray;
  const bool tags = input.kind == InputKind::kTimeTags;
  const bool stream = output == OutputKind::kCsv && !tags;
  const bool times =
      input.kind == InputKind::kMeasurement && (input.file.format == "mat" || input.file.format == "hdf5");
  refuse(output != OutputKind::kPoints, {"--degrees", "--text"}, "only point clouds (.ply, .pcd) have it");
  refuse(output != OutputKind::kPoints && output != OutputKind::kNpz, {"--confidence", "--amplitude"},
         "only point clouds (.ply, .pcd) and archives (.npz) have fields");
  refuse((!map && !array) || output == OutputKind::kCsv, {"--depth-scale", "--confidence", "--amplitude"},
         "only a map of distances has it");
  refuse(!stream, {"--acquisitions", "--photons", "--background", "--seed", "--slots"},
         "only a TDC stream (.csv) of histograms or photon times has it");
  refuse(!times, {"--tick"}, "only photon times (MAT) have it");
  refuse(map || tags, {"--bin-width"}, "neither maps nor time tags need it");
  refuse(!stream && input.kind != InputKind::kMeasurement, {"--t-int", "--np", "--shift"},
         "only TDC streams and photon times have it");
}

void run_convert_command(const CLI::App& command, ConvertCommand& options, JsonResult& result) {
  ConversionOptions& conversion = options.conversion;
  const OutputKind output = output_kind(conversion.out);
  if (options.bin_width_ps) {
    conversion.recording.bin_width_s = *options.bin_width_ps * 1e-12;
  }
  conversion.recording.tick_s = options.tick_ps * 1e-12;
  conversion.recording.resampling.integration_time = options.t_int_ns * 1e-9;
  conversion.recording.resampling.time_shift = options.shift_ns * 1e-9;
  ConversionInput input = open_conversion(conversion);
  if (const std::string obstacle = conversion_obstacle(input.kind, output); !obstacle.empty()) {
    throw InputError(fmt::format("{}: {}", conversion.recording.file, obstacle));
  }
  check_convert_options(command, input, output);
  const std::string sentence = convert(conversion, std::move(input));
  result["in"] = conversion.recording.file;
  result["out"] = conversion.out;
  result["says"] = sentence;
  fmt::print("{}: {}\n", conversion.out, sentence);
}

}  // namespace

void add_convert_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ConvertCommand>();
  options->command_line = command_line;
  RecordingOptions& recording = options->conversion.recording;
  CLI::App* command =
      app.add_subcommand("convert",
                         "A file of one format as one of another: maps (PNG, PFM), arrays "
                         "(NPY, NPZ, HDF5, MAT), sensors' logs, photon\n"
                         "times and time tags (PTU, HT3, Photon-HDF5) into maps, point clouds (PLY, PCD), "
                         "arrays, TDC streams and events (CSV)");
  command
      ->add_option(
          "in", recording.file,
          "what to read; an array of an archive is file.npz:name, file.h5:/group/name or file.mat:name")
      ->required();
  command
      ->add_option("out", options->conversion.out,
                   "what to write, by its ending: .png, .pfm, .ply, .pcd, .npy, .npz, .csv")
      ->required();
  std::vector<std::string> formats = {"auto"};
  formats.insert(formats.end(), kRecordingFormats.begin(), kRecordingFormats.end());
  command->add_option("--format", recording.format, "kind of the input")
      ->check(CLI::IsMember(formats))
      ->capture_default_str();
  command
      ->add_option("--depth-scale", options->conversion.metres_per_unit,
                   "maps: metres that one unit stands for")
      ->check(above_zero());
  command->add_option(
      "--confidence", options->conversion.confidence,
      ".ply, .pcd, .npz: the confidence of each pixel, a map or array file, or results (CSV)");
  command->add_option("--amplitude", options->conversion.amplitude,
                      ".ply, .pcd, .npz: the amplitude of each pixel, a map or array file");
  command
      ->add_option("--degrees", options->conversion.degrees_per_pixel,
                   ".ply, .pcd: field of view of a pixel in degrees")
      ->check(above_zero())
      ->capture_default_str();
  command->add_flag("--text", options->conversion.text, ".ply, .pcd: numbers as text");
  command
      ->add_option("--bin-width", options->bin_width_ps, "histograms of arrays, logs: width of a bin in ps")
      ->check(duration_ps());
  command->add_option("--variable", recording.variable, "MAT: name of the variable")->capture_default_str();
  command->add_option("--tick", options->tick_ps, "photon times: duration of a tick in ps")
      ->check(duration_ps())
      ->capture_default_str();
  command->add_option("--t-int", options->t_int_ns, "T_int in ns; T_res = T_int / 2^NP")
      ->check(duration_ns())
      ->capture_default_str();
  command->add_option("--np", recording.resampling.np, "bits of a timestamp")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command
      ->add_option("--slots", recording.resampling.slots, "TDC stream: events kept per pixel and acquisition")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command->add_option("--shift", options->shift_ns, "ns to add to every time")
      ->check(shift_ns())
      ->capture_default_str();
  command->add_option("-a,--acquisitions", recording.acquisitions, "TDC stream: laser pulses per frame")
      ->check(sensible_acquisitions());
  command->add_option("--photons", recording.resampling.photon_budget,
                      "TDC stream: thin to this mean number of photons per pixel and frame");
  command
      ->add_option("--background", recording.resampling.background,
                   "TDC stream: background events to add per acquisition and T_int")
      ->capture_default_str();
  command->add_option("--seed", recording.resampling.seed, "TDC stream: seed of the random numbers")
      ->capture_default_str();
  JsonResult::add_to(*command, options->json);
  command->callback([options, command] {
    JsonResult result(options->json, "convert", options->command_line);
    run_convert_command(*command, *options, result);
    result.finish();
  });
}

}  // namespace dtof
