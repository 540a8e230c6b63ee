// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/core/parameters.hpp"
#include "dtof/readout/model.hpp"

namespace dtof {

/// Makes a variant of hisPointer (v2) whose coarse peak is the largest sum of two adjacent bins (lowest pair
/// on a tie). The pointer starts at the border between the two bins, and its window is centred there. A pulse
/// on a bin border is thus not split. Throws InputError unless `parameters` are legal for hisPointer.
std::unique_ptr<ReadoutModel> make_paired_his_pointer(const ReadoutParameters& parameters);

}  // namespace dtof
