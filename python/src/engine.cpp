// SPDX-License-Identifier: Apache-2.0
#include "src/engine.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/error.hpp"
#include "dtof/frame/frame_maps.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "src/arrays.hpp"
#include "src/bindings.hpp"
#include "src/limits.hpp"
#include "src/photons.hpp"
#include "src/readout.hpp"
#include "src/rtl_engine.hpp"
#include "src/work.hpp"

namespace dtof::python {

namespace py = pybind11;
using namespace py::literals;

py::array_t<std::uint16_t> Results::field(std::uint16_t PixelResult::*member) const {
  constexpr auto kStep = static_cast<py::ssize_t>(sizeof(PixelResult));
  return shared_array<std::uint16_t>(results_, &(results_->front().*member), shape(),
                                     {kStep * shape()[1], kStep});
}

py::array_t<double> Results::positions() const {
  std::vector<double> positions;
  positions.reserve(results_->size());
  for (const PixelResult& pixel : *results_) {
    positions.push_back(code_position(pixel, parameters_.fraction_bits));
  }
  return taken_array(std::move(positions), shape());
}

std::unique_ptr<FrameEngine> make_engine(const std::string& name, const StreamSource& source,
                                         std::span<const ReadoutParameters> readouts, const Region& region,
                                         int threads, Progress::Observer observer) {
  check_threads(threads);
  if (name == "model") {
    return std::make_unique<ModelEngine>(
        ModelEngine::Settings{.threads = threads, .observer = std::move(observer)});
  }
  if (name == "rtl") {
    return make_rtl_engine(source, readouts, region, threads, std::move(observer));
  }
  throw InputError(fmt::format("engine: '{}' is neither model nor rtl", name));
}

namespace {

Results read_out(const StreamSource& photons, const py::object& readout,
                 const std::optional<std::vector<int>>& columns,
                 const std::optional<std::pair<int, int>>& rows, const std::string& engine, int threads,
                 const py::object& progress) {
  const std::vector<ReadoutParameters> readouts = {to_readout(readout, SensorModel())};
  Region region = choose_region(photons.columns(), photons.rows(), columns, rows);
  ReadoutRun run = do_work(progress, [&](const Progress::Observer& observer) {
    return make_engine(engine, photons, readouts, region, threads, observer)
        ->read(photons, readouts.front(), region);
  });
  return {readouts.front(), std::move(region), std::move(run)};
}

/// 1 where a result has a distance, row by row.
py::array_t<bool> distance_mask(const Results& results) {
  py::array_t<bool> mask(results.shape());
  bool* next = mask.mutable_data();
  for (const PixelResult& pixel : results.pixels()) {
    *next++ = has_distance(pixel, results.parameters());
  }
  return mask;
}

py::array_t<float> distances(const Results& results, const SensorModel& sensor,
                             const std::optional<RangeConverter>& table) {
  const std::vector<float> unknown(results.pixels().size(), std::numeric_limits<float>::quiet_NaN());
  return taken_array(frame_maps(results.pixels(), results.parameters(), sensor, table, unknown).depth,
                     results.shape());
}

/// `function` of each number of an array of any shape.
template <typename Function>
py::array_t<double> for_each(const InputArray<double>& values, const Function& function) {
  std::vector<double> made;
  made.reserve(static_cast<std::size_t>(values.size()));
  for (const double value : std::span(values.data(), static_cast<std::size_t>(values.size()))) {
    made.push_back(function(value));
  }
  return taken_array(std::move(made), {values.shape(), values.shape() + values.ndim()});
}

RangeConverter flat_table(const py::object& readout, const SensorModel& sensor, double klux,
                          std::uint64_t seed, const std::string& fidelity, int threads) {
  check_klux(klux);
  check_threads(threads);
  const std::vector<ReadoutParameters> readouts = {to_readout(readout, sensor)};
  SensorModel seen = sensor;
  seen.np = readouts.front().np;
  seen.slots = readouts.front().slots;
  return do_work(py::none(), [&](const Progress::Observer& /*observer*/) {
    const PhotonSource any(seen, TargetMap(1, 1, {.depth_m = 1.0}), klux, seed);
    return flat_tables(seen, klux, parse_fidelity(fidelity, any, {}), readouts, seed, threads).front();
  });
}

RangeConverter fitted_table(const std::vector<double>& distances_m, const InputArray<double>& positions,
                            double code_step) {
  if (positions.ndim() != 2 || positions.shape(0) != static_cast<py::ssize_t>(distances_m.size())) {
    throw InputError(fmt::format("positions: needs two axes, measurements of each of the {} distances",
                                 distances_m.size()));
  }
  std::vector<TargetRun> runs;
  for (py::ssize_t d = 0; d < positions.shape(0); ++d) {
    TargetRun run{{0, static_cast<std::uint32_t>(d)}, distances_m[static_cast<std::size_t>(d)], {}};
    for (py::ssize_t i = 0; i < positions.shape(1); ++i) {
      run.measurements.push_back({positions.at(d, i), 0.0});
    }
    runs.push_back(std::move(run));
  }
  return RangeConverter::calibrate(runs, code_step);
}

py::array_t<double> knots(const RangeConverter& table) {
  std::vector<double> numbers;
  for (const CalibrationPoint& knot : table.table().knots()) {
    numbers.push_back(knot.position);
    numbers.push_back(knot.distance_m);
  }
  const auto count = static_cast<py::ssize_t>(numbers.size() / 2);
  return taken_array(std::move(numbers), {count, 2});
}

void bind_tables(py::module_& module) {
  py::class_<RangeConverter>(
      module, "LookupTable",
      "The host's monotone table from positions on the code axis to distances. flat() makes the table "
      "of\n`dtof frame --table flat`; fit() makes a table from your own measurements.")
      .def_static("flat", &flat_table, "readout"_a, "sensor"_a, "klux"_a = 14.0, py::kw_only(), "seed"_a = 1,
                  "fidelity"_a = "exact", "threads"_a = 0,
                  "Fits a table with the read-out's model on flat targets of the sensor's reflectivity.")
      .def_static("fit", &fitted_table, "distances_m"_a, "positions"_a, "code_step"_a = 1.0,
                  "Fits a table to an array of positions in bins (distances, measurements). code_step: "
                  "resolution of a position, bins.")
      .def(
          "distance",
          [](const RangeConverter& table, const InputArray<double>& positions) {
            return for_each(positions, [&](double position) { return table.distance(position); });
          },
          "position"_a, "Distances in m; float64 with the shape of `positions`.")
      .def_property_readonly("knots", &knots, "float64 (knots, 2): position in bins, distance in m.");
  module.def(
      "depth",
      [](const InputArray<double>& positions, double integration_time_s, int np, double pulse_fwhm_s) {
        const DepthScale scale(integration_time_s, np, pulse_fwhm_s);
        return for_each(positions, [&](double position) { return scale.depth(position); });
      },
      "position"_a, "integration_time_s"_a = 45e-9, "np"_a = 10, "pulse_fwhm_s"_a = 0.0,
      "Distances in m by Eq. 3.11: c/2 (T_res (position + 0.5) - FWHM). float64 with the shape of "
      "`positions`.");
}

}  // namespace

void bind_engine(py::module_& module) {
  bind_tables(module);
  py::class_<Results>(module, "Results",
                      "Results of a read-out: arrays (rows, columns) with one number per pixel.")
      .def_property_readonly(
          "code", [](const Results& r) { return r.field(&PixelResult::code); }, "uint16, bins. No copy.")
      .def_property_readonly(
          "fraction", [](const Results& r) { return r.field(&PixelResult::fraction); },
          "uint16, 2^-FRACTION_BITS bins. No copy.")
      .def_property_readonly(
          "confidence", [](const Results& r) { return r.field(&PixelResult::confidence); },
          "uint16; 0 means no confidence, the scale depends on the read-out. No copy.")
      .def_property_readonly(
          "second", [](const Results& r) { return r.field(&PixelResult::second); },
          "uint16: second target of poolPointer, else 0. No copy.")
      .def_property_readonly(
          "amplitude", [](const Results& r) { return r.field(&PixelResult::amplitude); },
          "uint16: amplitude of poolPointer, else 0. No copy.")
      .def_property_readonly(
          "ambient", [](const Results& r) { return r.field(&PixelResult::ambient); },
          "uint16: ambient of poolPointer, else 0. No copy.")
      .def_property_readonly("position", &Results::positions, "float64, bins: code and fraction.")
      .def_property_readonly("has_distance", &distance_mask, "bool: True if the pixel has a distance.")
      .def_property_readonly("readout", &Results::parameters)
      .def_property_readonly(
          "columns", [](const Results& r) { return r.region().columns; },
          "The sensor's columns that were read.")
      .def_property_readonly("first_row", [](const Results& r) { return r.region().rows.first; })
      .def_property_readonly("clocks", &Results::clocks,
                             "With engine=\"rtl\": clocks of a frame in an array with all of the sensor's "
                             "columns. None for the model,\nor if only the columns of a narrower last engine "
                             "of a pool read-out were read.")
      .def("distance_m", &distances, "sensor"_a, "table"_a = py::none(),
           "Distances in m, at least 0, float32 (rows, columns); NaN without a distance. Without a table Eq. "
           "3.11 is used.")
      .def("__repr__", [](const Results& r) {
        return fmt::format("<dtof.Results of {}: {} x {} pixels>", readout_name(r.parameters().readout),
                           r.shape()[1], r.shape()[0]);
      });
  module.def("read_out", &read_out, "photons"_a, "readout"_a, py::kw_only(), "columns"_a = py::none(),
             "rows"_a = py::none(), "engine"_a = "model", "threads"_a = 0, "progress"_a = py::none(),
             "Reads out a frame with a Readout, or a read-out's name. columns: a list; rows: (first, last + "
             "1). engine: model, or rtl, which\nsimulates the RTL with Verilator and gives the same results; "
             "it builds the array first if the cache lacks it.\nprogress(done, total) is called every few "
             "hundredths of a second. An exception from it, or Control-C, ends the work.");
}

}  // namespace dtof::python
