// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/metrics/error_estimates.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "src/arrays.hpp"
#include "src/bindings.hpp"

namespace dtof::python {
namespace {

namespace py = pybind11;
using namespace py::literals;

using Values = InputArray<double>;

py::tuple pair_of(const Interval& interval) { return py::make_tuple(interval.low, interval.high); }

/// The pixels of two maps that both know, as flat lists.
std::pair<std::vector<double>, std::vector<double>> known_pairs(const Values& truth, const Values& measured) {
  if (truth.size() != measured.size()) {
    throw InputError(fmt::format("{} true and {} measured distances: the numbers must be equal", truth.size(),
                                 measured.size()));
  }
  std::pair<std::vector<double>, std::vector<double>> known;
  for (py::ssize_t i = 0; i < truth.size(); ++i) {
    const double true_m = truth.data()[i];
    const double measured_m = measured.data()[i];
    if (!std::isnan(true_m) && !std::isnan(measured_m)) {
      known.first.push_back(true_m);
      known.second.push_back(measured_m);
    }
  }
  return known;
}

ErrorSummary error_summary(const Values& truth, const Values& measured) {
  const auto [true_m, measured_m] = known_pairs(truth, measured);
  return summarise_errors(true_m, measured_m);
}

py::dict target_errors(double true_m, const Values& measured, const std::pair<double, double>& range_m) {
  const ErrorEstimates errors = estimate_errors(true_m, to_vector(measured), {range_m.first, range_m.second});
  return py::dict("relative_precision"_a = errors.relative_precision, "bias_m"_a = errors.bias_m,
                  "rmse_m"_a = errors.rmse_m, "share_above_3_percent"_a = errors.above_3_percent,
                  "share_above_10_percent"_a = errors.outlier_rate);
}

void bind_estimates(py::module_& module) {
  module.def(
      "estimate_mean", [](const Values& values) { return estimate_mean(to_vector(values)); }, "values"_a,
      "Mean of at least 2 independent values, with Student's t interval.");
  module.def(
      "estimate_standard_deviation",
      [](const Values& values) { return estimate_standard_deviation(to_vector(values)); }, "values"_a,
      "Standard deviation of at least 4 independent values.");
  module.def(
      "estimate_root_mean_square",
      [](const Values& values) { return estimate_root_mean_square(to_vector(values)); }, "values"_a,
      "Root mean square of at least 2 independent values.");
  module.def("estimate_share", &estimate_rare_share, "successes"_a, "trials"_a,
             "Share of independent events that may be rare: Wilson's interval, or Clopper and Pearson's if "
             "events are few.");
  module.def(
      "estimate_share_of_frames",
      [](const Values& frames, std::uint64_t pixels) {
        return estimate_share_of_frames(to_vector(frames), pixels);
      },
      "shares"_a, "pixels_of_a_frame"_a,
      "Share of pixels over several frames, from the share in each frame: pixels of one frame may be "
      "correlated, frames are independent.");
}

}  // namespace

void bind_metrics(py::module_& module) {
  py::class_<Estimate>(module, "Estimate", "A figure estimated from a random sample, with its 95 % interval.")
      .def_readonly("value", &Estimate::value)
      .def_property_readonly(
          "interval", [](const Estimate& e) { return pair_of(e.covering()); },
          "(low, high); with few outliers it also allows for outliers that were too rare to appear.")
      .def_property_readonly(
          "interval_as_seen", [](const Estimate& e) { return pair_of(e.interval); },
          "(low, high), assuming that all outliers resemble those in the sample.")
      .def("__float__", [](const Estimate& e) { return e.value; })
      .def("__repr__", [](const Estimate& e) {
        return fmt::format("<dtof.Estimate {:g} ({:g} to {:g})>", e.value, e.covering().low,
                           e.covering().high);
      });
  py::class_<ErrorSummary>(module, "ErrorSummary", "Error figures of a set of distances.")
      .def_readonly("count", &ErrorSummary::count)
      .def_readonly("relative_precision", &ErrorSummary::relative_precision,
                    "Standard deviation of |measured - true| / true.")
      .def_readonly("bias_m", &ErrorSummary::bias_m)
      .def_readonly("standard_deviation_m", &ErrorSummary::standard_deviation_m)
      .def_readonly("rmse_m", &ErrorSummary::rmse_m)
      .def_readonly("share_above_3_percent", &ErrorSummary::share_above_3_percent)
      .def_readonly("share_above_10_percent", &ErrorSummary::share_above_10_percent);
  module.def("error_summary", &error_summary, "true_m"_a, "measured_m"_a,
             "Error figures from two maps of equal size; pixels that are NaN in either map are left out.");
  module.def("target_errors", &target_errors, "true_m"_a, "measured_m"_a, "range_m"_a,
             "Error figures of independent measurements of one target as Estimates: relative_precision, "
             "bias_m, rmse_m,\nshare_above_3_percent, share_above_10_percent. range_m: (least, largest) "
             "distance that can be measured.");
  bind_estimates(module);
}

}  // namespace dtof::python
