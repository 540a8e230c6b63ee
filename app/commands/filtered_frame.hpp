// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dtof/photon/sensor_model.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"

namespace dtof {

/// Refuses, by InputError, to filter a region whose columns are not one beside the other: the host filter
/// needs every pixel's neighbours.
void check_filtered_region(const Region& region, bool filter);

/// The distances, errors and figures of a frame after the host filter (dtof/host/host_filter.hpp). A pixel
/// without a distance that the filter gives none either is judged by its distance before.
FrameMaps filtered_maps(const MeasuredFrame& frame, const TabledReadout& readout,
                        const FramePipeline& pipeline);

}  // namespace dtof
