// SPDX-License-Identifier: Apache-2.0
#include "photon_models/speed_error_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

namespace dtof {
namespace {

Table curve_table(const std::vector<ErrorCurve>& curves) {
  std::vector<std::string> head = {"frames"};
  for (const ErrorCurve& curve : curves) {
    head.insert(head.end(), {curve.model + ", CPU ms", "error, %"});
  }
  Table table(head);
  const std::vector<int>& frames = curves.front().frames;
  for (std::size_t n = 0; n < frames.size(); ++n) {
    std::vector<std::string> row = {fmt::format("{}", frames[n])};
    for (const ErrorCurve& curve : curves) {
      // The analytic model's one point holds for any number.
      const std::size_t point = std::min(n, curve.cpu_ms.size() - 1);
      row.insert(row.end(), {fmt::format("{:.3g}", curve.cpu_ms[point]),
                             fmt::format("{:.3g}", curve.error_percent[point])});
    }
    table.add(row);
  }
  return table;
}

/// The model that reaches the error at the least cost; nothing if none does.
std::optional<PageData> cheapest_model(const std::vector<ErrorCurve>& curves, double error) {
  const ErrorCurve* cheapest = nullptr;
  double cost = std::numeric_limits<double>::infinity();
  for (const ErrorCurve& curve : curves) {
    const double own = cost_to_reach(curve, error);  // not a number is never less
    if (own < cost) {
      cost = own;
      cheapest = &curve;
    }
  }
  if (cheapest == nullptr) {
    return std::nullopt;
  }
  return PageData().set("model", "{}", cheapest->model).set("cost_ms", "{:.3g}", cost);
}

/// The cheapest model for a stream, for a read-out of a frame, and for a sweep with several errors.
void add_advice(const ModelCosts& costs, const std::vector<ErrorCurve>& curves, PageData& data) {
  data.flag("exact_stream", costs.exact_stream_ms <= costs.fast_stream_ms)
      .set("stream_ms", "{:.0f}", std::min(costs.exact_stream_ms, costs.fast_stream_ms))
      .set("other_stream_ms", "{:.0f}", std::max(costs.exact_stream_ms, costs.fast_stream_ms))
      .flag("exact_frame", costs.exact_stream_ms <= costs.fast_sampler_ms)
      .set("frame_ms", "{:.0f}", std::min(costs.exact_stream_ms, costs.fast_sampler_ms))
      .set("other_frame_ms", "{:.0f}", std::max(costs.exact_stream_ms, costs.fast_sampler_ms));
  constexpr std::array kErrors = {1.0, 0.3, 0.1, 0.03};
  std::vector<PageData> sweeps;
  for (const double error : kErrors) {
    PageData sweep;
    sweep.set("error", "{:g}", error)
        .part("cheapest", cheapest_model(curves, error))
        .flag("last", error == kErrors.back());
    sweeps.push_back(std::move(sweep));
  }
  data.list("sweeps", std::move(sweeps));
}

}  // namespace

PageData speed_error_page(const SpeedErrorResults& results) {
  const std::size_t result_tests = results.scenes * results.readouts;
  PageData data;
  data.set("sensor", "{}", results.sensor)
      .set("seed", "{}", results.seed)
      .set("frames", "{}", results.frames)
      .set("scenes", "{}", results.scenes)
      .set("command", "{}", results.command_line)
      .set("models", results.models)
      .set("curves", curve_table(results.curves))
      .set("reference_frames", "{}", results.reference_frames)
      .set("acquisitions", "{}", results.acquisitions)
      .set("million_detections", "{:.1f}", static_cast<double>(results.detections) * 1e-6)
      .set("threads", "{}", results.threads)
      .set("result_tests", "{}", result_tests)
      .set("rare_p", "{:.0e}", 0.01 / static_cast<double>(result_tests));
  add_advice(results.costs, results.curves, data);
  return data;
}

}  // namespace dtof
