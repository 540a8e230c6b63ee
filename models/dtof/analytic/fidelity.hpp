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

/// Photon models.
enum class Fidelity {
  kExact,     ///< PhotonSource: event by event
  kFast,      ///< FastPhotonSource: times from a table of each distinct pixel
  kAnalytic,  ///< MeanPhotonSource: expected detections, no noise
};

/// Command-line name: exact, fast, analytic.
std::string_view fidelity_name(Fidelity fidelity);

/// How a read-out takes its photons.
enum class PhotonUse {
  kStream,   ///< acquisition by acquisition: the RTL, poolPointer, recordings
  kSampler,  ///< measurement by measurement: the models of all other read-outs
};

/// What `--fidelity auto` was asked for and is going to do with it.
struct FidelityRequest {
  /// Largest difference from the exact model that any of these figures of a scene may have, for any of the
  /// read-outs, in the mean over frames: root mean square and mean of the relative error of distance, share
  /// of pixels off by more than 3 %, and by more than 10 %. >= 0 and finite; 0 asks for the exact model.
  double tolerance = 0.0;
  PhotonUse use = PhotonUse::kStream;
  std::span<const Readout> readouts;
};

/// The largest such difference that the fast model's sampler makes for a read-out: an upper limit measured by
/// `dtof-study fidelity` (reports/fidelity.md) over eight scenes and three lights, which says whether it
/// holds.
/// Infinite for a read-out that has no sampler.
double fast_sampler_difference(Readout readout);
/// Processor time of a frame with the fast model's sampler over that with exact streams, photons included,
/// from the same report; infinite for a read-out that has no sampler.
double fast_sampler_cost(Readout readout);

/// True if the scene's rates, NP, SLOTS, number of acquisitions and width of the pulse in bins are within
/// what fast_sampler_difference was measured for; no time gate was.
bool within_measured_range(const PhotonSource& exact);

/// The cheapest model with noise that keeps the request (a model without noise shows no frame as a sensor
/// would). Streams are drawn by the exact model, which is as fast as any (reports/fidelity.md). Throws
/// InputError for a tolerance outside its range.
Fidelity choose_fidelity(const PhotonSource& exact, const FidelityRequest& request);

/// `name` is a model's, or "auto": then `request` chooses. Throws InputError for another name.
Fidelity parse_fidelity(std::string_view name, const PhotonSource& exact, const FidelityRequest& request);

/// A model's source for the exact source's scene, seed and frame. Throws InputError where the model lacks
/// something that the sensor has.
std::unique_ptr<StreamSource> make_source(Fidelity fidelity, const PhotonSource& exact);

}  // namespace dtof
