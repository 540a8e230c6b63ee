// SPDX-License-Identifier: Apache-2.0
#include "dtof/analytic/fidelity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "dtof/core/error.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"

namespace dtof {
namespace {

constexpr std::array kModels = {Fidelity::kExact, Fidelity::kFast, Fidelity::kAnalytic};

struct FastSampler {
  Readout readout;
  double largest_difference;
  double relative_cost;
};

// Differences are upper ends of 95 % intervals, rounded up; costs are rounded. Neither is measured here: a
// choice that depended on the clock would change from run to run.
constexpr std::array kFastSamplers = {
    FastSampler{Readout::kEzPointer, 0.01, 0.55},  FastSampler{Readout::kHisPointer1, 0.01, 0.55},
    FastSampler{Readout::kHisPointer, 0.01, 0.45}, FastSampler{Readout::kSifh, 0.01, 0.45},
    FastSampler{Readout::kFifh, 0.01, 0.45},       FastSampler{Readout::kThreeSteps, 0.01, 0.55},
    FastSampler{Readout::kPifh, 0.015, 1.6},       FastSampler{Readout::kHistogram, 0.01, 0.5},
};

const FastSampler* find_sampler(Readout readout) {
  const auto* const row = std::ranges::find(kFastSamplers, readout, &FastSampler::readout);
  return row == kFastSamplers.end() ? nullptr : row;
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

double fast_sampler_difference(Readout readout) {
  const FastSampler* const sampler = find_sampler(readout);
  return sampler == nullptr ? std::numeric_limits<double>::infinity() : sampler->largest_difference;
}

double fast_sampler_cost(Readout readout) {
  const FastSampler* const sampler = find_sampler(readout);
  return sampler == nullptr ? std::numeric_limits<double>::infinity() : sampler->relative_cost;
}

bool within_measured_range(const PhotonSource& exact) {
  constexpr int kBits = 10;
  constexpr int kSlots = 2;
  constexpr std::uint32_t kFewestAcquisitions = 3333;
  constexpr double kMostSignal = 0.5;
  constexpr double kMostBackground = 0.55;
  constexpr double kPulseSigmaBins = 19.33;
  constexpr double kPulseTolerance = 0.02;
  const SensorModel& model = exact.model();
  const double pulse_sigma_bins = model.pulse_sigma_s() / model.time_resolution_s();
  if (!FastPhotonSource::supports(exact) || model.time_gate || model.np != kBits || model.slots != kSlots ||
      model.acquisitions < kFewestAcquisitions ||
      std::abs(pulse_sigma_bins / kPulseSigmaBins - 1.0) > kPulseTolerance) {
    return false;
  }
  for (int column = 0; column < exact.columns(); ++column) {
    for (int row = 0; row < exact.rows(); ++row) {
      const PixelRates rates = exact.rates(column, row);
      if (rates.signal > kMostSignal || rates.background > kMostBackground) {
        return false;
      }
    }
  }
  return true;
}

Fidelity choose_fidelity(const PhotonSource& exact, const FidelityRequest& request) {
  if (!std::isfinite(request.tolerance) || request.tolerance < 0.0) {
    throw InputError(
        fmt::format("--tolerance must be a finite number of at least 0, not {}", request.tolerance));
  }
  if (request.use == PhotonUse::kStream || !within_measured_range(exact)) {
    return Fidelity::kExact;
  }
  const bool kept = std::ranges::all_of(request.readouts, [&](Readout readout) {
    return fast_sampler_difference(readout) <= request.tolerance;
  });
  double cost = 0.0;
  for (const Readout readout : request.readouts) {
    cost += fast_sampler_cost(readout);
  }
  return kept && cost < static_cast<double>(request.readouts.size()) ? Fidelity::kFast : Fidelity::kExact;
}

Fidelity parse_fidelity(std::string_view name, const PhotonSource& exact, const FidelityRequest& request) {
  if (name == "auto") {
    return choose_fidelity(exact, request);
  }
  for (const Fidelity fidelity : kModels) {
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
