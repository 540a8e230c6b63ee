// SPDX-License-Identifier: Apache-2.0
#include "src/photons.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/histogram_stream.hpp"
#include "dtof/recording/stream_csv.hpp"
#include "src/arrays.hpp"
#include "src/bindings.hpp"
#include "src/limits.hpp"
#include "src/work.hpp"

namespace dtof::python {

namespace py = pybind11;
using namespace py::literals;

PhotonSource scene_photons(const SceneMap& scene, const SensorModel& sensor, double klux, std::uint64_t seed,
                           std::uint32_t frame) {
  check_klux(klux);
  require_reachable(*scene.targets, sensor, "scene " + scene.name);
  return {sensor, *scene.targets, klux, seed, scene_frame(frame)};
}

Region choose_region(int columns, int rows, const std::optional<std::vector<int>>& chosen_columns,
                     const std::optional<std::pair<int, int>>& chosen_rows) {
  Region region = Region::whole(columns, rows);
  if (chosen_columns) {
    region.columns = *chosen_columns;
    std::ranges::sort(region.columns);
    for (const int column : region.columns) {
      if (column < 0 || column >= columns) {
        throw InputError(fmt::format("columns: column {} is outside 0 to {}", column, columns - 1));
      }
    }
    const auto twice = std::ranges::adjacent_find(region.columns);
    if (twice != region.columns.end()) {
      throw InputError(fmt::format("columns: column {} is named twice", *twice));
    }
    if (region.columns.empty()) {
      throw InputError("columns: none is named");
    }
  }
  if (chosen_rows) {
    const auto [first, end] = *chosen_rows;
    if (first < 0 || end <= first || end > rows) {
      throw InputError(fmt::format("rows: {} to below {} are no rows of 0 to {}", first, end, rows - 1));
    }
    region.rows = {.first = first, .count = end - first};
  }
  return region;
}

namespace {

/// Detections of one column or of several.
struct Events {
  std::vector<std::int32_t> column;
  std::vector<std::int32_t> row;
  std::vector<std::uint32_t> acquisition;
  std::vector<std::uint16_t> timestamp;
};

struct ColumnEvents {
  std::shared_ptr<const ColumnStream> stream;
};

template <typename T>
py::array_t<T> event_array(const ColumnEvents& events, T Detection::*member) {
  const ColumnStream& stream = *events.stream;
  const auto count = static_cast<py::ssize_t>(stream.detection_count());
  const Detection none{};
  const Detection* first = stream.rows() == 0 || count == 0 ? &none : stream.row(0).data();
  return shared_array<T>(events.stream, &(first->*member), {count},
                         {static_cast<py::ssize_t>(sizeof(Detection))});
}

py::array_t<std::int64_t> row_bounds(const ColumnEvents& events) {
  std::vector<std::int64_t> bounds = {0};
  for (int row = 0; row < events.stream->rows(); ++row) {
    bounds.push_back(bounds.back() + static_cast<std::int64_t>(events.stream->row(row).size()));
  }
  const auto count = static_cast<py::ssize_t>(bounds.size());
  return taken_array(std::move(bounds), {count});
}

ColumnEvents column_events(const StreamSource& source, int column) {
  if (column < 0 || column >= source.columns()) {
    throw InputError(fmt::format("column {} is outside 0 to {}", column, source.columns() - 1));
  }
  return {do_work(py::none(), [&](const Progress::Observer& /*observer*/) {
    return std::make_shared<const ColumnStream>(source.column(column));
  })};
}

py::dict all_events(const StreamSource& source, int threads, const py::object& progress) {
  check_threads(threads);
  const auto width = static_cast<std::size_t>(source.columns());
  Events events = do_work(progress, [&](const Progress::Observer& observer) {
    std::vector<ColumnStream> streams(width);
    Progress work(width, observer);
    parallel_for(width, threads, [&](std::size_t column) {
      streams[column] = source.column(static_cast<int>(column));
      work.advance();
    });
    Events made;
    for (std::size_t column = 0; column < width; ++column) {
      for (int row = 0; row < streams[column].rows(); ++row) {
        for (const Detection& detection : streams[column].row(row)) {
          made.column.push_back(static_cast<std::int32_t>(column));
          made.row.push_back(row);
          made.acquisition.push_back(detection.acquisition);
          made.timestamp.push_back(detection.timestamp);
        }
      }
    }
    return made;
  });
  const auto count = static_cast<py::ssize_t>(events.row.size());
  return py::dict("column"_a = taken_array(std::move(events.column), {count}),
                  "row"_a = taken_array(std::move(events.row), {count}),
                  "acquisition"_a = taken_array(std::move(events.acquisition), {count}),
                  "timestamp"_a = taken_array(std::move(events.timestamp), {count}));
}

using WholeNumbers = InputArray<std::int64_t>;

/// The whole numbers of an array of any type. Throws InputError for numbers that are not whole, and for what
/// is no number.
WholeNumbers whole_numbers(const py::object& argument, const char* name) {
  const py::array array = py::array::ensure(argument);
  const char kind = array ? array.dtype().kind() : 'O';
  if (kind == 'f') {
    const auto numbers = InputArray<double>::ensure(array);
    constexpr double kLargest = 0x1.0p53;
    for (py::ssize_t i = 0; i < numbers.size(); ++i) {
      const double number = numbers.data()[i];
      if (!(std::abs(number) <= kLargest && std::floor(number) == number)) {
        throw InputError(fmt::format("{}[{}]: {} is not a whole number", name, i, number));
      }
    }
  } else if (kind != 'i' && kind != 'u' && kind != 'b') {
    PyErr_Clear();
    throw InputError(fmt::format("{}: needs whole numbers, not {}", name,
                                 array ? py::str(array.dtype()).cast<std::string>()
                                       : py::repr(py::type::of(argument)).cast<std::string>()));
  }
  return WholeNumbers::ensure(array);
}

std::span<const std::int64_t> checked_numbers(const WholeNumbers& array, const char* name, py::ssize_t count,
                                              std::int64_t end) {
  if (array.ndim() != 1 || array.shape(0) != count) {
    throw InputError(fmt::format("{}: needs one axis of {} numbers, one for each column", name, count));
  }
  const std::span numbers(array.data(), static_cast<std::size_t>(count));
  const auto wrong =
      std::ranges::find_if(numbers, [&](std::int64_t number) { return number < 0 || number >= end; });
  if (wrong != numbers.end()) {
    throw InputError(
        fmt::format("{}[{}]: {} is outside 0 to {}", name, wrong - numbers.begin(), *wrong, end - 1));
  }
  return numbers;
}

/// The events of a list, all within their limits.
struct EventList {
  std::span<const std::int64_t> column;
  std::span<const std::int64_t> row;
  std::span<const std::int64_t> acquisition;
  std::span<const std::int64_t> timestamp;
};

/// The detections of each pixel in the list's order, pixel by pixel: `ends` says where a pixel's are over.
std::vector<Detection> by_pixel(const EventList& events, std::size_t rows, std::vector<std::size_t>& ends) {
  const auto pixel = [&](std::size_t i) {
    return static_cast<std::size_t>(events.column[i]) * rows + static_cast<std::size_t>(events.row[i]);
  };
  for (std::size_t i = 0; i < events.row.size(); ++i) {
    ++ends[pixel(i)];
  }
  std::size_t before = 0;
  for (std::size_t& end : ends) {  // for now: where the pixel's next detection goes
    before += std::exchange(end, before);
  }
  std::vector<Detection> detections(events.row.size());
  for (std::size_t i = 0; i < events.row.size(); ++i) {
    detections[ends[pixel(i)]++] = {static_cast<std::uint32_t>(events.acquisition[i]),
                                    static_cast<Timestamp>(events.timestamp[i])};
  }
  return detections;
}

/// Throws InputError if an acquisition of the pixel has more than `slots` events.
void check_slots(std::span<const Detection> pixel, int slots, std::size_t column, std::size_t row) {
  const auto most = static_cast<std::size_t>(slots);
  for (std::size_t i = most; i < pixel.size(); ++i) {
    if (pixel[i].acquisition == pixel[i - most].acquisition) {
      throw InputError(fmt::format("column {}, row {}: acquisition {} has more than {} events (slots)",
                                   column, row, pixel[i].acquisition, slots));
    }
  }
}

std::shared_ptr<StreamSource> make_stream(const EventList& events, int columns, int rows,
                                          std::uint32_t acquisitions, int slots) {
  const auto height = static_cast<std::size_t>(rows);
  std::vector<std::size_t> ends(static_cast<std::size_t>(columns) * height);
  std::vector<Detection> detections = by_pixel(events, height, ends);
  std::vector<ColumnStream> streams(static_cast<std::size_t>(columns));
  parallel_for(streams.size(), 0, [&](std::size_t column) {
    for (std::size_t row = 0; row < height; ++row) {
      const std::size_t place = column * height + row;
      const std::size_t begin = place == 0 ? 0 : ends[place - 1];
      const std::span pixel = std::span(detections).subspan(begin, ends[place] - begin);
      std::ranges::stable_sort(pixel, {}, &Detection::acquisition);
      check_slots(pixel, slots, column, row);
      streams[column].append_row(pixel);
    }
  });
  return std::make_shared<RecordedStream>(std::move(streams), rows, acquisitions);
}

std::shared_ptr<StreamSource> event_list(const py::object& columns_of_events,
                                         const py::object& rows_of_events,
                                         const py::object& acquisitions_of_events,
                                         const py::object& timestamps, int columns, int rows,
                                         std::int64_t acquisitions, int np, int slots) {
  const WholeNumbers column = whole_numbers(columns_of_events, "column");
  const WholeNumbers row = whole_numbers(rows_of_events, "row");
  const WholeNumbers acquisition = whole_numbers(acquisitions_of_events, "acquisition");
  const WholeNumbers timestamp = whole_numbers(timestamps, "timestamp");
  const py::ssize_t count = column.size();
  for (const auto& [name, value] : {std::pair("columns", columns), std::pair("rows", rows)}) {
    if (value < 1) {
      throw InputError(fmt::format("{}: {} is not at least 1", name, value));
    }
  }
  constexpr std::int64_t kMostPixels = std::int64_t{1} << 24U;
  if (std::int64_t{columns} * rows > kMostPixels) {
    throw InputError(fmt::format("{} x {} pixels are more than {}", columns, rows, kMostPixels));
  }
  check_recorded(acquisitions, slots);
  if (np < 1 || np > 16) {
    throw InputError(fmt::format("np: {} is outside 1 to 16", np));
  }
  const EventList events{.column = checked_numbers(column, "column", count, columns),
                         .row = checked_numbers(row, "row", count, rows),
                         .acquisition = checked_numbers(acquisition, "acquisition", count, acquisitions),
                         .timestamp = checked_numbers(timestamp, "timestamp", count,
                                                      std::int64_t{1} << static_cast<unsigned>(np))};
  return do_work(py::none(), [&](const Progress::Observer& /*observer*/) {
    return make_stream(events, columns, rows, static_cast<std::uint32_t>(acquisitions), slots);
  });
}

std::shared_ptr<StreamSource> histogram_photons(const InputArray<double>& counts, double bin_width_s,
                                                double offset_s, int np, double integration_time_s,
                                                std::uint32_t acquisitions, int slots,
                                                const std::optional<double>& photons, double background,
                                                std::uint64_t seed, std::uint32_t frame) {
  check_recorded(acquisitions, slots);
  NpyArray array{{counts.shape(), counts.shape() + counts.ndim()}, to_vector(counts)};
  Resampling resampling{.np = np,
                        .integration_time = integration_time_s,
                        .acquisitions = acquisitions,
                        .slots = slots,
                        .photon_budget = photons,
                        .background = background,
                        .seed = seed,
                        .frame = frame};
  return std::make_shared<HistogramStream>(histogram_cube(array, bin_width_s, offset_s), resampling);
}

std::shared_ptr<StreamSource> photons(const SceneMap& scene, const SensorModel& sensor, double klux,
                                      std::uint64_t seed, std::uint32_t frame, const std::string& fidelity,
                                      bool laser) {
  SensorModel lit = sensor;
  lit.signal_events_1m = laser ? sensor.signal_events_1m : 0.0;
  const PhotonSource exact = scene_photons(scene, lit, klux, seed, frame);
  return make_source(parse_fidelity(fidelity, exact, {}), exact);
}

void bind_sources(py::module_& module) {
  module.def("photons", &photons, "scene"_a, "sensor"_a, "klux"_a = 14.0, py::kw_only(), "seed"_a = 1,
             "frame"_a = 0, "fidelity"_a = "exact", "laser"_a = true,
             "TDC stream of a scene: exact (event by event), fast (times from tables) or analytic "
             "(expected\ndetections, no noise). Columns are drawn when they are read, with the same photons "
             "each time. laser=False: background light alone.");
  module.def("event_list", &event_list, "column"_a, "row"_a, "acquisition"_a, "timestamp"_a, py::kw_only(),
             "columns"_a, "rows"_a, "acquisitions"_a, "np"_a = 10, "slots"_a = 2,
             "TDC stream from your own events: four arrays of equally many whole numbers, in any order. "
             "Events of one pixel and\nacquisition keep their order, and are at most `slots`. A timestamp is "
             "0 to 2^NP - 1; the largest value means no detection.");
  module.def("histogram_photons", &histogram_photons, "counts"_a, "bin_width_s"_a, py::kw_only(),
             "offset_s"_a = 0.0, "np"_a = 10, "integration_time_s"_a = 45e-9, "acquisitions"_a = 3333,
             "slots"_a = 2, "photons"_a = py::none(), "background"_a = 0.0, "seed"_a = 1, "frame"_a = 0,
             "TDC stream of a frame from measured histograms, (rows, columns, bins), (columns, bins) or "
             "(bins): every photon goes to\na random acquisition. `photons`: mean number of photons per "
             "pixel and frame, drawn from the pixel's histogram.");
}

}  // namespace

void bind_photons(py::module_& module) {
  py::class_<ColumnEvents>(module, "ColumnEvents",
                           "Detections of one column, pixel by pixel, sorted by acquisition.")
      .def_property_readonly(
          "acquisition",
          [](const ColumnEvents& events) { return event_array(events, &Detection::acquisition); },
          "uint32 (events). No copy.")
      .def_property_readonly(
          "timestamp", [](const ColumnEvents& events) { return event_array(events, &Detection::timestamp); },
          "uint16 (events), bins of T_int / 2^NP. No copy.")
      .def_property_readonly(
          "row_bounds", &row_bounds,
          "int64 (rows + 1): the events of row r are those from row_bounds[r] to below row_bounds[r + 1].")
      .def("__len__", [](const ColumnEvents& events) { return events.stream->detection_count(); });
  py::class_<StreamSource, std::shared_ptr<StreamSource>>(
      module, "Photons",
      "TDC stream of a frame. Made by photons(), event_list(), histogram_photons() or read_recording().")
      .def_property_readonly("columns", &StreamSource::columns)
      .def_property_readonly("rows", &StreamSource::rows)
      .def_property_readonly("acquisitions", &StreamSource::acquisitions)
      .def("column", &column_events, "column"_a, "The detections of a column.")
      .def("events", &all_events, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           "All detections, as event_list() takes them: a dict of the arrays column and row (int32), "
           "acquisition (uint32) and\n"
           "timestamp (uint16).")
      .def(
          "write_csv",
          [](const StreamSource& source, const std::filesystem::path& file) {
            run_work(py::none(),
                     [&](const Progress::Observer& /*observer*/) { write_stream_csv(file, source); });
          },
          "file"_a, "Writes the stream to a file, as `dtof frame --record` does.")
      .def("__repr__", [](const StreamSource& source) {
        return fmt::format("<dtof.Photons: {} x {} pixels, {} acquisitions>", source.columns(), source.rows(),
                           source.acquisitions());
      });
  bind_sources(module);
}

}  // namespace dtof::python
