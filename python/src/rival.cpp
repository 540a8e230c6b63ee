// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/rival.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/rival/coarse_histogram.hpp"
#include "dtof/rival/equi_depth.hpp"
#include "dtof/rival/guided_window.hpp"
#include "dtof/rival/legendre_memory.hpp"
#include "dtof/rival/linear_code.hpp"
#include "src/arrays.hpp"
#include "src/bindings.hpp"
#include "src/limits.hpp"
#include "src/photons.hpp"
#include "src/work.hpp"

namespace dtof::python {
namespace {

namespace py = pybind11;
using namespace py::literals;

using Numbers = std::map<std::string, int>;

/// A number that a family can be given.
struct NumberChoice {
  std::string name;
  int standard;
  int lowest;
  int highest;
};

/// Rivals that differ in some numbers.
struct Family {
  std::string name;
  std::vector<NumberChoice> numbers;
  std::unique_ptr<Rival> (*make)(const SensorModel& sensor, const Numbers& numbers);
};

std::unique_ptr<Rival> hedh(const SensorModel& sensor, const Numbers& n) {
  return make_hierarchical_equi_depth(sensor, {.parts = n.at("parts")});
}
std::unique_ptr<Rival> pedh(const SensorModel& sensor, const Numbers& n) {
  return make_proportional_equi_depth(sensor, {.parts = n.at("parts"), .optimised = n.at("optimised") == 1});
}
std::unique_ptr<Rival> histogram(const SensorModel& sensor, const Numbers& n) {
  return make_coarse_histogram(sensor, {.bin_bits = n.at("bin_bits"), .count_bits = n.at("count_bits")});
}
std::unique_ptr<Rival> guided(const SensorModel& sensor, const Numbers& n) {
  return make_guided_window(sensor, {.count_bits = n.at("count_bits")});
}
std::unique_ptr<Rival> fourier(const SensorModel& sensor, const Numbers& n) {
  return make_fourier(sensor, truncated_fourier(n.at("counters")), n.at("bits"));
}
std::unique_ptr<Rival> gray(const SensorModel& sensor, const Numbers& n) {
  return make_fourier(sensor, gray_fourier(n.at("counters"), largest_harmonic(sensor)), n.at("bits"));
}
std::unique_ptr<Rival> correlations(const SensorModel& sensor, const Numbers& n) {
  return make_two_correlations(sensor, n.at("shift"));
}
std::unique_ptr<Rival> sketch(const SensorModel& sensor, const Numbers& n) {
  return make_sketch(sensor, n.at("size"));
}
std::unique_ptr<Rival> spline(const SensorModel& sensor, const Numbers& n) {
  return make_spline_sketch(sensor, n.at("knots"), n.at("count_bits"));
}
std::unique_ptr<Rival> legendre(const SensorModel& sensor, const Numbers& n) {
  return make_legendre_memory(sensor, n.at("order"));
}

const std::vector<Family>& families() {
  static const std::vector<Family> known = {
      {"histogram", {{"bin_bits", 5, 2, 16}, {"count_bits", 8, 1, 16}}, histogram},
      {"hedh", {{"parts", 4, 2, 64}}, hedh},
      {"pedh", {{"parts", 4, 2, 64}, {"optimised", 0, 0, 1}}, pedh},
      {"fourier", {{"counters", 8, 2, 64}, {"bits", 4, 1, 12}}, fourier},
      {"gray", {{"counters", 8, 2, 64}, {"bits", 4, 1, 12}}, gray},
      {"correlations", {{"shift", 8, 1, 24}}, correlations},
      {"guided", {{"count_bits", 10, 1, 16}}, guided},
      {"sketch", {{"size", 2, 1, 32}}, sketch},
      {"spline", {{"knots", 4, 2, 64}, {"count_bits", 12, 2, 24}}, spline},
      {"legendre", {{"order", 8, 2, 32}}, legendre},
  };
  return known;
}

/// A rival for a sensor.
struct NamedRival {
  std::string name;
  std::string title;
  std::string citation;
  Numbers numbers;
  SensorModel sensor;
  std::shared_ptr<const Rival> rival;
};

Numbers choose_numbers(const Family& family, const py::kwargs& changes) {
  Numbers numbers;
  std::vector<std::string> names;
  for (const NumberChoice& number : family.numbers) {
    numbers[number.name] = number.standard;
    names.push_back(number.name);
  }
  for (const auto& [key, value] : changes) {
    const auto word = key.cast<std::string>();
    const auto choice = std::ranges::find(family.numbers, word, &NumberChoice::name);
    if (choice == family.numbers.end()) {
      throw InputError(
          fmt::format("rival {} has no parameter {}; it has {}", family.name, word, fmt::join(names, ", ")));
    }
    int number = 0;
    try {
      number = value.cast<int>();
    } catch (const py::cast_error&) {
      throw InputError(fmt::format("{}: {} is no whole number", word, py::repr(value).cast<std::string>()));
    }
    if (number < choice->lowest || number > choice->highest) {
      throw InputError(fmt::format("rival {}: {} must be {} to {}, is {}", family.name, word, choice->lowest,
                                   choice->highest, number));
    }
    numbers[word] = number;
  }
  return numbers;
}

NamedRival make_rival(const std::string& name, const std::optional<SensorModel>& for_sensor,
                      const py::kwargs& changes) {
  const SensorModel sensor = for_sensor.value_or(SensorModel());
  const bool listed = std::ranges::find(all_rivals(), name, &RivalEntry::name) != all_rivals().end();
  const auto family = std::ranges::find(families(), name, &Family::name);
  if (family == families().end() || (listed && changes.empty())) {
    const RivalEntry& entry = find_rival(name);
    if (!changes.empty()) {
      throw InputError(fmt::format("rival {} has no parameters; rival_families() has those that do", name));
    }
    return {name, std::string(entry.title), std::string(entry.citation), {}, sensor, entry.make(sensor)};
  }
  Numbers numbers = choose_numbers(*family, changes);
  std::shared_ptr<const Rival> rival = family->make(sensor, numbers);
  std::string title = name;
  for (const auto& [word, number] : numbers) {
    title += fmt::format(" {}={}", word, number);
  }
  return {name, std::move(title), "", std::move(numbers), sensor, std::move(rival)};
}

/// What a rival made of a frame, row by row.
struct RivalFrame {
  std::vector<double> position;
  std::vector<double> confidence;
  std::vector<std::int32_t> words;
};

using Sources = std::vector<std::shared_ptr<StreamSource>>;

Sources to_sources(const NamedRival& named, const py::object& photons) {
  const bool one = py::isinstance<StreamSource>(photons);
  auto sources = (one ? py::object(py::list(py::make_tuple(photons))) : photons).cast<Sources>();
  if (static_cast<int>(sources.size()) != named.rival->frames()) {
    throw InputError(fmt::format("rival {} needs {} frames, the oldest first; these are {}", named.name,
                                 named.rival->frames(), sources.size()));
  }
  for (const std::shared_ptr<StreamSource>& source : sources) {
    if (source->columns() != sources.front()->columns() || source->rows() != sources.front()->rows()) {
      throw InputError(fmt::format("rival {}: its frames are not of one size", named.name));
    }
  }
  return sources;
}

RivalFrame read_frame(const Rival& rival, std::span<const StreamSource* const> sources,
                      std::span<const int> columns, int rows, int threads,
                      const Progress::Observer& observer) {
  const std::size_t width = columns.size();
  std::vector<Measurement> measurements(width * static_cast<std::size_t>(rows));
  std::vector<RivalWords> words(measurements.size());
  Progress progress(width, observer);
  parallel_for(width, threads, [&](std::size_t i) {
    std::vector<ColumnStream> streams;
    for (const StreamSource* source : sources) {
      streams.push_back(source->column(columns[i]));
    }
    for (int row = 0; row < rows; ++row) {
      std::vector<std::span<const Detection>> pixel;
      pixel.reserve(streams.size());
      for (const ColumnStream& stream : streams) {
        pixel.push_back(stream.row(row));
      }
      const std::size_t place = static_cast<std::size_t>(row) * width + i;
      words[place] = rival.read_pixel(pixel);
      measurements[place] = rival.decode(words[place]);
    }
    progress.advance();
  });
  RivalFrame frame;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    frame.position.push_back(measurements[i].position);
    frame.confidence.push_back(measurements[i].confidence);
    frame.words.insert(frame.words.end(), words[i].begin(), words[i].end());
  }
  return frame;
}

py::dict read_rival(const NamedRival& named, const py::object& photons, int threads,
                    const py::object& progress) {
  const Sources sources = to_sources(named, photons);
  std::vector<const StreamSource*> read;
  for (const std::shared_ptr<StreamSource>& source : sources) {
    read.push_back(source.get());
  }
  const Region whole = Region::whole(sources.front()->columns(), sources.front()->rows());
  RivalFrame frame = do_work(progress, [&](const Progress::Observer& observer) {
    return read_frame(*named.rival, read, whole.columns, whole.rows.count, threads, observer);
  });
  const py::ssize_t rows = whole.rows.count;
  const auto columns = static_cast<py::ssize_t>(whole.columns.size());
  const py::ssize_t words = static_cast<py::ssize_t>(frame.words.size()) / (rows * columns);
  return py::dict("position"_a = taken_array(std::move(frame.position), {rows, columns}),
                  "confidence"_a = taken_array(std::move(frame.confidence), {rows, columns}),
                  "words"_a = taken_array(std::move(frame.words), {rows, columns, words}));
}

/// The table that `dtof-study rivals` gives a rival: of the same flat targets and photons as a read-out's.
RangeConverter rival_table(const NamedRival& named, double klux, std::uint64_t seed, int threads) {
  check_klux(klux);
  check_threads(threads);
  return do_work(py::none(), [&](const Progress::Observer& observer) {
    const FlatCalibration calibration(named.sensor);
    const auto count = static_cast<std::size_t>(named.rival->frames());
    const auto first_lit = count - static_cast<std::size_t>(named.rival->laser_off_frames());
    SensorModel without_laser = named.sensor;
    without_laser.signal_events_1m = 0.0;
    std::vector<PhotonSource> frames;
    for (std::size_t before = count; before-- > 0;) {
      frames.emplace_back(before < first_lit ? named.sensor : without_laser, calibration.targets(), klux,
                          seed, FlatCalibration::kFrame + 2 * static_cast<std::uint32_t>(before));
    }
    std::vector<const StreamSource*> sources;
    sources.reserve(count);
    for (const PhotonSource& frame : frames) {
      sources.push_back(&frame);
    }
    std::vector<int> columns;
    for (std::size_t d = 0; d < calibration.distances_m().size(); ++d) {
      columns.push_back(calibration.column(d));
    }
    const RivalFrame frame =
        read_frame(*named.rival, sources, columns, calibration.targets().rows(), threads, observer);
    std::vector<Measurement> measurements;
    for (std::size_t i = 0; i < frame.position.size(); ++i) {
      measurements.push_back({frame.position[i], frame.confidence[i]});
    }
    return calibration.fit(measurements, 0.0, seed);
  });
}

}  // namespace

void bind_rivals(py::module_& module) {
  py::class_<NamedRival>(module, "Rival",
                         "A read-out from the literature: a name of rivals(), or a name of rival_families() "
                         "with its numbers as keywords\n(Rival(\"hedh\", sensor, parts=8)).")
      .def(py::init(&make_rival), "name"_a, "sensor"_a = py::none())
      .def_readonly("name", &NamedRival::name)
      .def_readonly("title", &NamedRival::title)
      .def_readonly("citation", &NamedRival::citation)
      .def_readonly("parameters", &NamedRival::numbers)
      .def_property_readonly(
          "bits_per_pixel", [](const NamedRival& r) { return r.rival->bits_per_pixel(); },
          "Memory bits per pixel.")
      .def_property_readonly(
          "frames", [](const NamedRival& r) { return r.rival->frames(); }, "Number of frames per result.")
      .def_property_readonly(
          "laser_off_frames", [](const NamedRival& r) { return r.rival->laser_off_frames(); },
          "How many of the first frames are taken without laser light (photons(..., laser=False)).")
      .def("read_out", &read_rival, "photons"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           "Reads out a frame, or a list of `frames` frames, the oldest first. Returns a dict of arrays "
           "(rows, columns): position\n(float64, bins) and confidence (float64); and words (rows, columns, "
           "words), int32, as they leave the chip.")
      .def("flat_table", &rival_table, "klux"_a = 14.0, py::kw_only(), "seed"_a = 1, "threads"_a = 0,
           "Fits the LookupTable of flat targets, as for a read-out.")
      .def("__repr__", [](const NamedRival& r) {
        return fmt::format("<dtof.Rival {}: {} bits a pixel>", r.title, r.rival->bits_per_pixel());
      });
  module.def(
      "rivals",
      [] {
        py::dict found;
        for (const RivalEntry& entry : all_rivals()) {
          found[py::str(std::string(entry.name))] = std::string(entry.citation);
        }
        return found;
      },
      "Rivals that the studies compare: name and publication.");
  module.def(
      "rival_families",
      [] {
        py::dict found;
        for (const Family& family : families()) {
          py::dict numbers;
          for (const NumberChoice& number : family.numbers) {
            numbers[py::str(number.name)] = py::make_tuple(number.standard, number.lowest, number.highest);
          }
          found[py::str(family.name)] = numbers;
        }
        return found;
      },
      "Families of rivals with free numbers: name, and for each number its default, lowest and highest "
      "value.");
}

}  // namespace dtof::python
