// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/pixel_sampler.hpp"
#include "photon/photon_source.hpp"

namespace dtof {

/// Photon models, dearest first.
enum class Fidelity {
  kExact,     ///< PhotonSource: event by event
  kFast,      ///< FastPhotonSource: times from a table of each distinct pixel
  kAnalytic,  ///< MeanPhotonSource: expected detections, no noise
};

/// Command-line name: exact, fast, analytic.
std::string_view fidelity_name(Fidelity fidelity);

/// What a model leaves out of a pixel's distance, relative to the distance; the larger of the scene's
/// extremes. 0 for the exact model, infinite where the model lacks something that the sensor has.
///  - fast: mean displacement of an event by the table (ArrivalTable::displacement);
///  - analytic: the noise, at least the Cramer-Rao bound.
/// Pixels without a target do not count. Looks at no more than 256 pixels, spread evenly over the array.
double model_error(Fidelity fidelity, const PhotonSource& exact);

/// The cheapest model whose model_error is at most `tolerance`, a relative error of distance >= 0 (InputError
/// otherwise). With tolerance 0 the exact one.
Fidelity choose_fidelity(const PhotonSource& exact, double tolerance);

/// `name` is a model's, or "auto": then `tolerance` chooses. Throws InputError for another name.
Fidelity parse_fidelity(std::string_view name, const PhotonSource& exact, double tolerance);

/// A model's source for the exact source's scene, seed and frame. Throws InputError where the model lacks
/// something that the sensor has.
std::unique_ptr<StreamSource> make_source(Fidelity fidelity, const PhotonSource& exact);

}  // namespace dtof
