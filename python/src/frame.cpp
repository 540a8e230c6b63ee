// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"
#include "src/arrays.hpp"
#include "src/bindings.hpp"
#include "src/engine.hpp"
#include "src/limits.hpp"
#include "src/photons.hpp"
#include "src/readout.hpp"
#include "src/work.hpp"

namespace dtof::python {
namespace {

namespace py = pybind11;
using namespace py::literals;

/// What `dtof frame` shows of one read-out.
struct ReadoutFrame {
  Results results;
  std::shared_ptr<const MeasuredFrame> frame;
  std::optional<RangeConverter> table;

  [[nodiscard]] py::array_t<float> map(const std::vector<float>& metres) const {
    const auto width = static_cast<py::ssize_t>(sizeof(float)) * results.shape()[1];
    return shared_array<float>(frame, metres.data(), results.shape(), {width, sizeof(float)});
  }
};

struct Frame {
  std::shared_ptr<const FrameTruth> truth;
  Region region;
  std::vector<ReadoutFrame> readouts;

  [[nodiscard]] const ReadoutFrame& find(const std::string& name) const {
    const auto found = std::ranges::find_if(readouts, [&](const ReadoutFrame& readout) {
      return readout_name(readout.frame->parameters.readout) == name;
    });
    if (found == readouts.end()) {
      throw py::key_error(name);
    }
    return *found;
  }
  [[nodiscard]] py::array_t<float> truth_map() const {
    const auto width = static_cast<py::ssize_t>(region.columns.size());
    return shared_array<float>(truth, truth->metres.data(), {region.rows.count, width},
                               {static_cast<py::ssize_t>(sizeof(float)) * width, sizeof(float)});
  }
};

/// A rule's name, or a table (or none: Eq. 3.11) of each read-out by its name.
using TableChoice = std::variant<std::string, std::map<std::string, std::optional<RangeConverter>>>;

/// What a frame is made of, beside scene, sensor and read-outs.
struct FrameChoice {
  double klux;
  std::uint64_t seed;
  std::uint32_t frame;
  TableChoice table;
  std::string fidelity;
  double tolerance;
  std::optional<std::vector<int>> columns;
  std::optional<std::pair<int, int>> rows;
  std::optional<double> precision_percent;
  int max_frames;
  std::string engine;
  int threads;
};

SensorModel to_sensor(const std::variant<std::string, SensorModel>& sensor) {
  const auto* name = std::get_if<std::string>(&sensor);
  return name == nullptr ? std::get<SensorModel>(sensor) : find_sensor(*name);
}

/// `with_rtl`: "all" are those that have RTL.
std::vector<ReadoutParameters> to_readouts(const py::object& asked, const SensorModel& sensor,
                                           bool with_rtl) {
  std::vector<ReadoutParameters> readouts;
  if (py::isinstance<py::str>(asked) && asked.cast<std::string>() == "all") {
    const std::span<const Readout> all =
        with_rtl ? std::span<const Readout>(kRtlReadouts) : std::span<const Readout>(kAllReadouts);
    for (const Readout readout : all) {
      readouts.push_back(to_readout(py::str(std::string(readout_name(readout))), sensor));
    }
    return readouts;
  }
  const bool one = py::isinstance<py::str>(asked) || py::isinstance<ReadoutParameters>(asked);
  for (const py::handle& readout : one ? py::list(py::make_tuple(asked)) : py::list(asked)) {
    readouts.push_back(to_readout(readout, sensor));
  }
  if (readouts.empty()) {
    throw InputError("readouts: none is named");
  }
  for (std::size_t i = 0; i < readouts.size(); ++i) {
    if (readouts[i].np != readouts.front().np || readouts[i].slots != readouts.front().slots) {
      throw InputError("readouts: all of a frame see the same timestamps, so NP and SLOTS must be the same");
    }
    for (std::size_t before = 0; before < i; ++before) {
      if (readouts[before].readout == readouts[i].readout) {
        throw InputError(fmt::format("readouts: {} is named twice", readout_name(readouts[i].readout)));
      }
    }
  }
  return readouts;
}

SceneMap to_scene(const std::variant<std::string, SceneMap>& scene, const SensorModel& sensor) {
  const auto* name = std::get_if<std::string>(&scene);
  if (name == nullptr) {
    return std::get<SceneMap>(scene);
  }
  return {make_scene(
              parse_scene(*name),
              {.columns = sensor.columns, .rows = sensor.rows, .reflectivity = sensor.default_reflectivity}),
          *name};
}

std::vector<ReadoutFrame> measure_all(const FramePipeline& pipeline, const std::vector<TabledReadout>& tabled,
                                      const FrameChoice& choice) {
  std::optional<FramePrecision> precision;
  if (choice.precision_percent) {
    precision =
        FramePrecision{.relative = *choice.precision_percent / 100.0, .most_frames = choice.max_frames};
  }
  std::vector<ReadoutFrame> readouts;
  for (const TabledReadout& readout : tabled) {
    MeasuredFrame frame = pipeline.measure(readout, precision);
    Results results(frame.parameters, pipeline.region(), frame.run);
    readouts.push_back(
        {std::move(results), std::make_shared<const MeasuredFrame>(std::move(frame)), readout.table});
  }
  return readouts;
}

/// The read-outs with tables that were given; empty if a rule was. Throws InputError for an unknown rule.
std::vector<TabledReadout> given_tables(const std::vector<ReadoutParameters>& readouts,
                                        const TableChoice& choice) {
  std::vector<TabledReadout> tabled;
  if (const auto* rule = std::get_if<std::string>(&choice)) {
    (void)parse_table_rule(*rule);
    return tabled;
  }
  const auto& tables = std::get<std::map<std::string, std::optional<RangeConverter>>>(choice);
  for (const ReadoutParameters& parameters : readouts) {
    const auto found = tables.find(std::string(readout_name(parameters.readout)));
    if (found == tables.end()) {
      throw InputError(fmt::format("table: there is none for {}", readout_name(parameters.readout)));
    }
    tabled.push_back({parameters, found->second});
  }
  return tabled;
}

Frame make_frame(const SceneMap& scene, SensorModel sensor, const std::vector<ReadoutParameters>& readouts,
                 const FrameChoice& choice, const py::object& progress) {
  check_threads(choice.threads);
  check_precision(choice.precision_percent, choice.max_frames);
  sensor.np = readouts.front().np;
  sensor.slots = readouts.front().slots;
  sensor.validate();
  check_frame_memory(sensor, scene.targets->rows());
  const std::vector<TabledReadout> given = given_tables(readouts, choice.table);
  const PhotonSource photons = scene_photons(scene, sensor, choice.klux, choice.seed, choice.frame);
  const Region region = choose_region(photons.columns(), photons.rows(), choice.columns, choice.rows);
  return do_work(progress, [&](const Progress::Observer& observer) {
    std::size_t before = 0;  // columns of the read-outs that are done
    const std::unique_ptr<const FrameEngine> engine = make_engine(
        choice.engine, photons, readouts, region, choice.threads, [&](std::size_t done, std::size_t total) {
          observer(before + done, total * readouts.size());
          before += done == total && !choice.precision_percent ? total : 0;
        });
    const Fidelity fidelity = frame_fidelity(choice.fidelity, choice.tolerance, photons, readouts, *engine);
    refuse_without_effect(choice.precision_percent && fidelity == Fidelity::kAnalytic, "precision_percent",
                          "the analytic photon model has no noise; choose exact, fast or auto");
    const FramePipeline pipeline(photons, *engine,
                                 {.region = region,
                                  .fidelity = fidelity,
                                  .seed = choice.seed,
                                  .threads = choice.threads,
                                  .keep_photons = readouts.size() > 1});
    return Frame{
        std::make_shared<const FrameTruth>(pipeline.truth()), region,
        measure_all(pipeline,
                    given.empty()
                        ? pipeline.tables(readouts, parse_table_rule(std::get<std::string>(choice.table)))
                        : given,
                    choice)};
  });
}

Frame frame(const std::variant<std::string, SceneMap>& scene,
            const std::variant<std::string, SensorModel>& sensor, const py::object& readouts, double klux,
            std::uint64_t seed, std::uint32_t frame_number, const TableChoice& table,
            const std::string& fidelity, double tolerance, const std::optional<std::vector<int>>& columns,
            const std::optional<std::pair<int, int>>& rows, const std::optional<double>& precision_percent,
            int max_frames, const std::string& engine, int threads, const py::object& progress) {
  const SensorModel model = to_sensor(sensor);
  return make_frame(to_scene(scene, model), model, to_readouts(readouts, model, engine == "rtl"),
                    {klux, seed, frame_number, table, fidelity, tolerance, columns, rows, precision_percent,
                     max_frames, engine, threads},
                    progress);
}

/// The figures of the pixels that are judged, as numbers; none if no pixel is.
py::dict figures(const ReadoutFrame& readout) {
  const FrameFigures& figures = readout.frame->maps.figures;
  py::dict found;
  found["pixels"] = figures.errors.count();
  if (figures.errors.count() == 0) {
    return found;
  }
  const ErrorSummary summary = figures.errors.summary();
  found["rmse_m"] = summary.rmse_m;
  found["bias_m"] = summary.bias_m;
  found["bias_before_table_m"] = figures.before.mean();
  found["relative_precision"] = summary.relative_precision;
  found["share_above_3_percent"] = summary.share_above_3_percent;
  found["share_above_10_percent"] = summary.share_above_10_percent;
  found["share_without_distance"] =
      static_cast<double>(figures.without_distance) / static_cast<double>(figures.errors.count());
  return found;
}

/// The same as the row of `summary.csv` has them.
py::dict summary(const ReadoutFrame& readout) {
  const bool tabled = readout.table.has_value();
  const std::vector<std::string> names = figure_names(tabled);
  const std::vector<std::string> values = figure_values(readout.frame->maps.figures, tabled);
  py::dict found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    found[py::str(names[i])] = values[i];
  }
  return found;
}

void bind_readout_frame(py::module_& module) {
  py::class_<ReadoutFrame>(module, "ReadoutFrame",
                           "Results of one read-out for a frame; arrays are (rows, columns).")
      .def_readonly("results", &ReadoutFrame::results, "Codes, fractions and confidences.")
      .def_property_readonly(
          "depth_m", [](const ReadoutFrame& r) { return r.map(r.frame->maps.depth); },
          "float32, m, at least 0; NaN without a distance. No copy.")
      .def_property_readonly(
          "error_m", [](const ReadoutFrame& r) { return r.map(r.frame->maps.error); },
          "float32, m, measured - true; NaN without a distance or a true distance. No copy.")
      .def_property_readonly(
          "confidence", [](const ReadoutFrame& r) { return r.results.field(&PixelResult::confidence); },
          "uint16; the scale depends on the read-out. No copy.")
      .def_readonly("table", &ReadoutFrame::table, "The look-up table; None without one.")
      .def_property_readonly("readout", [](const ReadoutFrame& r) { return r.frame->parameters; })
      .def_property_readonly("figures", &figures,
                             "Error figures over the judged pixels of all frames, with or without a "
                             "distance: pixels, rmse_m, bias_m,\nbias_before_table_m, relative_precision, "
                             "share_above_3_percent, share_above_10_percent,\nshare_without_distance.")
      .def_property_readonly("summary", &summary, "The figures as text, as in the row of `summary.csv`.")
      .def_property_readonly(
          "frames", [](const ReadoutFrame& r) { return r.frame->frames; },
          "Number of frames read, which precision_percent decides.")
      .def_property_readonly("precision_reached",
                             [](const ReadoutFrame& r) { return r.frame->precision_reached; })
      .def_property_readonly("seconds", [](const ReadoutFrame& r) { return r.frame->run.seconds; });
}

}  // namespace

void bind_frames(py::module_& module) {
  bind_readout_frame(module);
  py::class_<Frame>(
      module, "Frame",
      "A frame of a scene, read out by one or several read-outs: frame[\"sifh\"] holds the results of SiFH.")
      .def_property_readonly(
          "truth_m", &Frame::truth_map,
          "True distances in m, float32 (rows, columns); NaN for pixels that are not judged. No copy.")
      .def_property_readonly(
          "columns", [](const Frame& f) { return f.region.columns; }, "The sensor's columns that were read.")
      .def_property_readonly("first_row", [](const Frame& f) { return f.region.rows.first; })
      .def("keys",
           [](const Frame& f) {
             std::vector<std::string> names;
             for (const ReadoutFrame& readout : f.readouts) {
               names.emplace_back(readout_name(readout.frame->parameters.readout));
             }
             return names;
           })
      .def("__len__", [](const Frame& f) { return f.readouts.size(); })
      .def("__getitem__", &Frame::find, py::return_value_policy::reference_internal)
      .def("__iter__", [](const py::object& f) { return py::iter(f.attr("keys")()); });
  module.def(
      "frame", &frame, "scene"_a = "room", "sensor"_a = "thesis", "readouts"_a = "all", py::kw_only(),
      "klux"_a = 14.0, "seed"_a = 1, "frame"_a = 0, "table"_a = "flat", "fidelity"_a = "exact",
      "tolerance"_a = 0.01, "columns"_a = py::none(), "rows"_a = py::none(),
      "precision_percent"_a = py::none(), "max_frames"_a = 1000, "engine"_a = "model", "threads"_a = 0,
      "progress"_a = py::none(),
      "Makes one frame of a scene as `dtof frame` does: photons, TDC stream, read-outs, look-up tables, "
      "distances, errors.\nArguments are that command's options; scene, sensor and readouts may be names or "
      "objects. table: flat, none, or a dict of\nLookupTables by the read-outs' names. engine: model, or "
      "rtl, which simulates\nthe RTL with Verilator; tables are made with the models. progress(done, total) "
      "is called every few hundredths of a\nsecond. An exception from it, or Control-C, ends the work.");
}

}  // namespace dtof::python
