// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Parses a read-out with changed parameters, READOUT:PARAMETER=NUMBER,...: "hispointer:COUNT_WIDTH=8",
/// "poolpointer:COARSE_SHARE=12,TRACK_SHARE=14". Other parameters are those of default_parameters
/// (sensor/default_parameters.hpp). Throws InputError for anything else, a parameter that the read-out does
/// not have, and a value that ReadoutParameters::validate refuses.
ReadoutParameters parse_variant(const std::string& text, const SensorModel& sensor = {});

/// Display name of a read-out, with those parameters of parse_variant that differ from the sensor's
/// default_parameters, e.g. "hisPointer COUNT_WIDTH=8".
std::string variant_title(const ReadoutParameters& parameters, const SensorModel& sensor = {});

/// Parameters that parse_variant accepts, with their read-outs, for messages and help.
std::string variant_parameters_help();

}  // namespace dtof
