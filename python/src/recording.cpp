// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/recording.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "dtof/convert/conversion.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/io/result_csv.hpp"
#include "dtof/recording/recorded_array.hpp"
#include "src/arrays.hpp"
#include "src/bindings.hpp"
#include "src/limits.hpp"
#include "src/work.hpp"

namespace dtof::python {
namespace {

namespace py = pybind11;
using namespace py::literals;

/// A recording as Python holds it.
struct HeldRecording {
  std::string description;
  std::string format;
  std::shared_ptr<StreamSource> photons;
  std::vector<double> true_distance;
};

HeldRecording read(const std::filesystem::path& file, const std::string& format,
                   const std::optional<double>& bin_width_s, double tick_s, const std::string& variable,
                   const std::optional<std::uint32_t>& acquisitions, const std::optional<int>& columns,
                   const std::optional<int>& rows, int np, int slots, double integration_time_s,
                   double time_shift_s, const std::optional<double>& photons, double background,
                   std::uint64_t seed, std::uint32_t frame) {
  check_recorded(acquisitions.value_or(1), slots);
  const RecordingOptions options{.file = file.string(),
                                 .format = format,
                                 .bin_width_s = bin_width_s,
                                 .tick_s = tick_s,
                                 .variable = variable,
                                 .acquisitions = acquisitions,
                                 .columns = columns,
                                 .rows = rows,
                                 .resampling = {.np = np,
                                                .integration_time = integration_time_s,
                                                .time_shift = time_shift_s,
                                                .slots = slots,
                                                .photon_budget = photons,
                                                .background = background,
                                                .seed = seed,
                                                .frame = frame}};
  return do_work(py::none(), [&](const Progress::Observer& /*observer*/) {
    RecordingFile contents = read_recording(options);
    std::string kind = contents.format;
    const bool stream = kind == "csv";
    refuse_without_effect(stream && photons, "photons", "a TDC stream is replayed as it was recorded");
    refuse_without_effect(stream && bin_width_s, "bin_width_s", "a TDC stream has none");
    for (const auto& [argument, given] : {std::pair("columns", columns), std::pair("rows", rows)}) {
      refuse_without_effect(!stream && given, argument,
                            "only a TDC stream (CSV) lacks the size of its array");
    }
    Recording recording = open_recording(options, std::move(contents));
    return HeldRecording{std::move(recording.description), std::move(kind), std::move(recording.source),
                         std::move(recording.true_distance)};
  });
}

py::object true_distances(const HeldRecording& recording) {
  if (recording.true_distance.empty()) {
    return py::none();
  }
  return taken_array(std::vector<double>(recording.true_distance),
                     {recording.photons->rows(), recording.photons->columns()});
}

/// A result file as arrays of its lines.
py::dict read_results(const std::filesystem::path& file) {
  std::vector<std::int32_t> column;
  std::vector<std::int32_t> row;
  std::vector<std::uint16_t> code;
  std::vector<std::uint16_t> fraction;
  std::vector<std::uint16_t> confidence;
  for (const ResultRecord& record : read_result_csv(file)) {
    column.push_back(record.column);
    row.push_back(record.row);
    code.push_back(record.result.code);
    fraction.push_back(record.result.fraction);
    confidence.push_back(record.result.confidence);
  }
  const auto count = static_cast<py::ssize_t>(row.size());
  return py::dict("column"_a = taken_array(std::move(column), {count}),
                  "row"_a = taken_array(std::move(row), {count}),
                  "code"_a = taken_array(std::move(code), {count}),
                  "fraction"_a = taken_array(std::move(fraction), {count}),
                  "confidence"_a = taken_array(std::move(confidence), {count}));
}

/// An array of a file, as it stands there.
py::object read_array(const std::filesystem::path& file, const std::string& variable) {
  const RecordingOptions options{.file = file.string(), .variable = variable};
  const NpyArray array = do_work(py::none(), [&](const Progress::Observer& /*observer*/) {
    const RecordingFile contents = read_recording(options);
    if (contents.format != "npy" && contents.format != "npz" && contents.format != "mat" &&
        contents.format != "hdf5") {
      throw InputError(options.file + ": neither NPY, NPZ, MAT nor HDF5");
    }
    return open_array(options, contents);
  });
  return taken_array(std::vector<double>(array.values), Shape(array.shape.begin(), array.shape.end()));
}

std::string convert_file(const std::filesystem::path& source, const std::filesystem::path& target,
                         const std::string& format, const std::optional<double>& metres_per_unit,
                         const std::optional<std::filesystem::path>& confidence,
                         const std::optional<std::filesystem::path>& amplitude, double degrees_per_pixel,
                         bool text, const std::optional<double>& bin_width_s) {
  const ConversionOptions options{
      .out = target.string(),
      .recording = {.file = source.string(), .format = format, .bin_width_s = bin_width_s},
      .metres_per_unit = metres_per_unit,
      .confidence = confidence ? confidence->string() : "",
      .amplitude = amplitude ? amplitude->string() : "",
      .degrees_per_pixel = degrees_per_pixel,
      .text = text};
  return do_work(py::none(), [&](const Progress::Observer& /*observer*/) {
    return convert(options, open_conversion(options));
  });
}

}  // namespace

void bind_recordings(py::module_& module) {
  py::class_<HeldRecording>(module, "Recording", "A recorded frame.")
      .def_readonly("description", &HeldRecording::description, "Short description of the file.")
      .def_readonly("format", &HeldRecording::format,
                    "csv, npy, npz, mat, hdf5, photon-hdf5, picoquant, tmf8820, tmf8821, tmf8828, tmf8829 or "
                    "vl53l8ch.")
      .def_readonly("photons", &HeldRecording::photons)
      .def_property_readonly(
          "true_distance_m", &true_distances,
          "True distances in m, float64 (rows, columns), NaN if unknown; None if the file has none.");
  module.def("read_recording", &read, "file"_a, py::kw_only(), "format"_a = "auto",
             "bin_width_s"_a = py::none(), "tick_s"_a = 8e-12, "variable"_a = "photon_times",
             "acquisitions"_a = py::none(), "columns"_a = py::none(), "rows"_a = py::none(), "np"_a = 10,
             "slots"_a = 2, "integration_time_s"_a = 45e-9, "time_shift_s"_a = 0.0, "photons"_a = py::none(),
             "background"_a = 0.0, "seed"_a = 1, "frame"_a = 0,
             "Reads a recording as `dtof replay` does: a TDC stream (CSV), histograms (NPY, NPZ, HDF5, MAT, "
             "TMF8820, TMF8821, TMF8828, TMF8829, VL53L8CH), photon times (MAT), time tags (PTU, HT3, "
             "Photon-HDF5).");
  module.def("read_array", &read_array, "file"_a, py::kw_only(), "variable"_a = "photon_times",
             "Reads an array of an NPY, NPZ, HDF5 or MAT file (5 and 7.3, axes as in MATLAB) as float64. A "
             "colon and the array's name select one of several: \"a.npz:depth_m\", \"a.h5:/group/cube\", "
             "\"a.mat:counts\".");
  module.def("convert", &convert_file, "source"_a, "target"_a, py::kw_only(), "format"_a = "auto",
             "metres_per_unit"_a = py::none(), "confidence"_a = py::none(), "amplitude"_a = py::none(),
             "degrees_per_pixel"_a = kPixelAngle, "text"_a = false, "bin_width_s"_a = py::none(),
             "Converts a file to another format, as `dtof convert` does; returns that command's sentence.");
  module.def("read_results", &read_results, "file"_a,
             "Arrays of a result file's lines: column, row, code, fraction, confidence.");
}

}  // namespace dtof::python
