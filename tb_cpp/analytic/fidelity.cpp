// SPDX-License-Identifier: Apache-2.0
#include "analytic/fidelity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "metrics/cramer_rao.hpp"
#include "metrics/depth.hpp"
#include "photon/arrival_table.hpp"
#include "photon/fast_photon_source.hpp"
#include "photon/mean_photon_source.hpp"
#include "photon/physics.hpp"

namespace dtof {
namespace {

constexpr std::array<Fidelity, 3> kCheapestFirst = {Fidelity::kAnalytic, Fidelity::kFast, Fidelity::kExact};

double pixel_error_bins(Fidelity fidelity, const SensorModel& model, const PixelRates& rates,
                        ArrivalTable& table) {
  if (fidelity == Fidelity::kFast) {
    table.build(rates);
    return table.displacement();
  }
  constexpr int kMostSlots = 16;  // more change nothing at rates a bound can be computed for
  return cramer_rao_bound({.signal_events = rates.signal,
                           .background_events = rates.background,
                           .centre_bins = rates.centre_bins,
                           .sigma_bins = pulse_sigma_s(model.pulse_fwhm_s) / model.time_resolution_s(),
                           .np = model.np,
                           .acquisitions = static_cast<double>(model.acquisitions),
                           .kept_events = std::min(model.slots, kMostSlots)});
}

}  // namespace

std::string_view fidelity_name(Fidelity fidelity) {
  switch (fidelity) {
    case Fidelity::kExact:
      return "exact";
    case Fidelity::kFast:
      return "fast";
    case Fidelity::kAnalytic:
      return "analytic";
  }
  throw std::logic_error("unknown photon model");
}

double model_error(Fidelity fidelity, const PhotonSource& exact) {
  if (fidelity == Fidelity::kExact) {
    return 0.0;
  }
  const SensorModel& model = exact.model();
  if (!FastPhotonSource::supports(model)) {
    return std::numeric_limits<double>::infinity();
  }
  constexpr int kMostPixels = 256;
  const int pixels = exact.columns() * exact.rows();
  const int looked_at = std::min(pixels, kMostPixels);
  const double bin_depth = DepthScale(model.integration_time_s, model.np, model.pulse_fwhm_s).bin_depth();
  ArrivalTable table(model);
  double largest = 0.0;
  for (int i = 0; i < looked_at; ++i) {
    const auto pixel =
        looked_at == 1 ? 0 : static_cast<int>(static_cast<std::int64_t>(i) * (pixels - 1) / (looked_at - 1));
    const int column = pixel / exact.rows();
    const int row = pixel % exact.rows();
    const PixelTarget& target = exact.targets().at(column, row);
    if (target.returns_signal()) {
      const double bins = pixel_error_bins(fidelity, model, exact.rates(column, row), table);
      largest = std::max(largest, bins * bin_depth / target.depth_m);
    }
  }
  return largest;
}

Fidelity choose_fidelity(const PhotonSource& exact, double tolerance) {
  if (!std::isfinite(tolerance) || tolerance < 0.0) {
    throw InputError(fmt::format("--tolerance must be a finite number of at least 0, not {}", tolerance));
  }
  return *std::ranges::find_if(kCheapestFirst, [&](Fidelity fidelity) {
    return fidelity == Fidelity::kExact || (tolerance > 0.0 && model_error(fidelity, exact) <= tolerance);
  });
}

Fidelity parse_fidelity(std::string_view name, const PhotonSource& exact, double tolerance) {
  if (name == "auto") {
    return choose_fidelity(exact, tolerance);
  }
  for (const Fidelity fidelity : kCheapestFirst) {
    if (name == fidelity_name(fidelity)) {
      return fidelity;
    }
  }
  throw InputError(fmt::format("unknown photon model '{}': known are exact, fast, analytic and auto", name));
}

std::unique_ptr<StreamSource> make_source(Fidelity fidelity, const PhotonSource& exact) {
  switch (fidelity) {
    case Fidelity::kExact:
      return std::make_unique<PhotonSource>(exact);
    case Fidelity::kFast:
      return std::make_unique<FastPhotonSource>(exact);
    case Fidelity::kAnalytic:
      return std::make_unique<MeanPhotonSource>(exact);
  }
  throw std::logic_error("unknown photon model");
}

}  // namespace dtof
