// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/recording.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "dtof/io/npy.hpp"
#include "dtof/io/result_csv.hpp"
#include "src/arrays.hpp"
#include "src/bindings.hpp"
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

}  // namespace

void bind_recordings(py::module_& module) {
  py::class_<HeldRecording>(module, "Recording", "A recorded frame.")
      .def_readonly("description", &HeldRecording::description, "A few words on the file.")
      .def_readonly("format", &HeldRecording::format, "csv, npy, npz, mat, hdf5, picoquant, tmf8820 or tmf8829.")
      .def_readonly("photons", &HeldRecording::photons)
      .def_property_readonly("true_distance_m", &true_distances,
                             "float64 (rows, columns), m, NaN is unknown; None if the file knows none.");
  module.def("read_recording", &read, "file"_a, py::kw_only(), "format"_a = "auto",
             "bin_width_s"_a = py::none(), "tick_s"_a = 8e-12, "variable"_a = "photon_times",
             "acquisitions"_a = py::none(), "columns"_a = py::none(), "rows"_a = py::none(), "np"_a = 10,
             "slots"_a = 2, "integration_time_s"_a = 45e-9, "time_shift_s"_a = 0.0, "photons"_a = py::none(),
             "background"_a = 0.0, "seed"_a = 1, "frame"_a = 0,
             "Reads a recording as `dtof replay` does: a TDC stream (CSV), histograms (NPY, NPZ, HDF5, MAT, "
             "TMF8820, TMF8829), photon times (MAT), time tags (PTU, HT3).");
  module.def("read_results", &read_results, "file"_a,
             "Arrays of a result file's lines: column, row, code, fraction, confidence.");
}

}  // namespace dtof::python
