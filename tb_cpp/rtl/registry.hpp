// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "rtl/array_model.hpp"
#include "rtl/configuration.hpp"

class VerilatedContext;

namespace dtof {

using ArrayModelFactory = std::function<std::unique_ptr<ArrayModel>(VerilatedContext&)>;

/// Called by each compiled configuration when the program starts; returns true.
bool register_rtl_configuration(const RtlConfiguration& configuration, ArrayModelFactory factory);

/// Configurations linked into this program, sorted by their text.
std::vector<RtlConfiguration> compiled_rtl_configurations();

/// Configuration to read out `columns` columns of `rows` rows: of those with these parameters (parameters
/// that the read-out does not use are not compared) and enough rows, the one that simulates least; the
/// thesis's variant (two-port pointer SRAM, plain clear) before others. Of poolPointer the columns are
/// those of one engine, and the array has just as many rows and columns: one more would be heard. A pool
/// read-out's shares are those of `parameters`. With `waveform` only those that record one count. Throws
/// InputError listing what is compiled.
RtlConfiguration find_rtl_configuration(const ReadoutParameters& parameters, int rows, int columns,
                                        bool waveform = false);

/// Whether make_array_model() has `configuration`.
bool has_array(const RtlConfiguration& configuration);

/// Throws InputError listing what is compiled if `configuration` is not.
std::unique_ptr<ArrayModel> make_array_model(const RtlConfiguration& configuration,
                                             VerilatedContext& context);

}  // namespace dtof
