// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// A read-out with some parameters changed, written READOUT:PARAMETER=NUMBER,...: "hispointer:COUNT_WIDTH=8",
/// "poolpointer:COARSE_SHARE=12,TRACK_SHARE=14". Throws InputError for anything else, for a parameter that
/// the read-out does not have and for a value that ReadoutParameters::validate refuses. What the text does
/// not name is that of default_parameters (app/options.hpp).
ReadoutParameters parse_variant(const std::string& text, const SensorModel& sensor = {});

/// Display name of a read-out with these parameters: those that parse_variant knows and that are not the
/// sensor's default_parameters follow it, e.g. "hisPointer COUNT_WIDTH=8".
std::string variant_title(const ReadoutParameters& parameters, const SensorModel& sensor = {});

/// Names that parse_variant knows, with what has them, for messages and help.
std::string variant_parameters_help();

}  // namespace dtof
