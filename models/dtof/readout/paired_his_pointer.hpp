// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "dtof/core/parameters.hpp"
#include "dtof/readout/model.hpp"

namespace dtof {

/// hisPointer (v2) whose coarse peak is the largest sum of two adjacent bins, lowest pair on a tie: the
/// pointer starts, and its window is centred, at the border between the two. A pulse that falls on a border
/// is no longer split, which makes it the strongest rival of hisPointer's cost. `parameters` are
/// hisPointer's; throws InputError for illegal ones.
std::unique_ptr<ReadoutModel> make_paired_his_pointer(const ReadoutParameters& parameters);

}  // namespace dtof
