// SPDX-License-Identifier: Apache-2.0
#include "analytic/fidelity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"
#include "photon/fast_photon_source.hpp"
#include "photon/mean_photon_source.hpp"

namespace dtof {
namespace {

constexpr std::array kModels = {Fidelity::kExact, Fidelity::kFast, Fidelity::kAnalytic};

struct SamplerDifference {
  Readout readout;
  double largest;
};

// Upper ends of the 95 % intervals, rounded up; `dtof fidelity` measures them again.
constexpr std::array kSamplerDifferences = {
    SamplerDifference{Readout::kEzPointer, 0.01},  SamplerDifference{Readout::kHisPointer1, 0.01},
    SamplerDifference{Readout::kHisPointer, 0.01}, SamplerDifference{Readout::kSifh, 0.01},
    SamplerDifference{Readout::kFifh, 0.01},       SamplerDifference{Readout::kThreeSteps, 0.01},
    SamplerDifference{Readout::kPifh, 0.01},       SamplerDifference{Readout::kHistogram, 0.01},
};

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
  const auto* const row = std::ranges::find(kSamplerDifferences, readout, &SamplerDifference::readout);
  return row == kSamplerDifferences.end() ? std::numeric_limits<double>::infinity() : row->largest;
}

bool within_measured_range(const PhotonSource& exact) {
  constexpr int kMostBits = 10;
  constexpr int kSlots = 2;
  constexpr std::uint32_t kFewestAcquisitions = 3333;
  constexpr double kMostSignal = 0.5;
  constexpr double kMostBackground = 0.55;
  const SensorModel& model = exact.model();
  if (!FastPhotonSource::supports(model) || model.np > kMostBits || model.slots != kSlots ||
      model.acquisitions < kFewestAcquisitions) {
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
  const bool kept = std::ranges::all_of(request.readouts, [&](Readout readout) {
    return fast_sampler_difference(readout) <= request.tolerance;
  });
  return request.use == PhotonUse::kSampler && kept && within_measured_range(exact) ? Fidelity::kFast
                                                                                    : Fidelity::kExact;
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
