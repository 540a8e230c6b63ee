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

/// Registers a compiled configuration. Each configuration calls this when the program starts. Returns true.
bool register_rtl_configuration(const RtlConfiguration& configuration, ArrayModelFactory factory);

/// Configurations linked into this program, sorted by their text.
std::vector<RtlConfiguration> compiled_rtl_configurations();

/// Configuration that reads `columns` columns of `rows` rows with these parameters (those that the read-out
/// uses). Among arrays with enough rows, the one with the least simulation work; the thesis's variant
/// (two-port pointer SRAM, plain clear) is preferred. A pool read-out needs an array of exactly one engine
/// with exactly these rows and columns, since pixels depend on their neighbours; its shares are those of
/// `parameters`. With `waveform`, only arrays that record waveforms count. Throws InputError that lists what
/// is compiled.
RtlConfiguration find_rtl_configuration(const ReadoutParameters& parameters, int rows, int columns,
                                        bool waveform = false);

/// True if make_array_model() accepts `configuration`.
bool has_array(const RtlConfiguration& configuration);

/// Makes a model of a compiled configuration. Throws InputError that lists what is compiled if it is not.
std::unique_ptr<ArrayModel> make_array_model(const RtlConfiguration& configuration,
                                             VerilatedContext& context);

}  // namespace dtof
