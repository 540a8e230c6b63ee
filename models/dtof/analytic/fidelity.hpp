// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "dtof/core/parameters.hpp"
#include "dtof/core/pixel_sampler.hpp"
#include "dtof/photon/photon_source.hpp"

namespace dtof {

/// Photon models of `--fidelity`.
enum class Fidelity {
  kExact,     ///< PhotonSource: event by event
  kFast,      ///< FastPhotonSource: times from a table of each distinct pixel
  kAnalytic,  ///< MeanPhotonSource: expected detections, no noise
};

/// Command-line name: exact, fast, analytic.
std::string_view fidelity_name(Fidelity fidelity);

/// How a read-out takes its photons.
enum class PhotonUse {
  kStream,   ///< acquisition by acquisition: the RTL, the models of poolPointer, recordings
  kSampler,  ///< measurement by measurement: the models of all other read-outs
};

/// Input of `--fidelity auto`.
struct FidelityRequest {
  /// Largest difference from the exact model that is allowed, >= 0 and finite; 0 asks for the exact model.
  /// Four figures of a scene are compared, for each read-out, in the mean over frames. These are root mean
  /// square and mean of the relative distance error, and the shares of pixels with errors above 3 % and above
  /// 10 %.
  double tolerance = 0.0;
  PhotonUse use = PhotonUse::kStream;
  std::span<const Readout> readouts;
};

/// Upper limit of the difference (FidelityRequest::tolerance) that the fast model's sampler makes for a
/// read-out. `dtof-study fidelity` measured the limit over eight scenes and three light levels and tells
/// whether it holds (reports/fidelity.md). Infinite for a read-out without a sampler.
double fast_sampler_difference(Readout readout);
/// Processor time of a frame with the fast model's sampler divided by that with exact streams, photons
/// included (reports/fidelity.md). Infinite for a read-out without a sampler.
double fast_sampler_cost(Readout readout);

/// True if fast_sampler_difference applies to this scene: rates, NP, SLOTS, acquisitions and pulse width in
/// bins lie in the measured range, and the sensor has no time gate.
bool within_measured_range(const PhotonSource& exact);

/// Chooses the cheapest photon model with noise that meets the request; a model without noise would show no
/// realistic frame. Streams always get the exact model, which is as fast as any (reports/fidelity.md). Throws
/// InputError for a tolerance outside its range.
Fidelity choose_fidelity(const PhotonSource& exact, const FidelityRequest& request);

/// Photon model by its command-line name; "auto" calls choose_fidelity. Throws InputError for an unknown
/// name.
Fidelity parse_fidelity(std::string_view name, const PhotonSource& exact, const FidelityRequest& request);

/// Returns the model's source for the scene, seed and frame of `exact`. Throws InputError if the model does
/// not support an effect of the sensor.
std::unique_ptr<StreamSource> make_source(Fidelity fidelity, const PhotonSource& exact);

}  // namespace dtof
