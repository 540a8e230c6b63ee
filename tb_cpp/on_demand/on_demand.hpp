// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "dtof/core/parameters.hpp"
#include "rtl/configuration.hpp"
#include "sources/sources.hpp"

namespace dtof {

/// Makes sure that find_rtl_configurations() finds the arrays for the columns `selected` of a source. Arrays
/// that the program lacks are loaded from the user's cache (ArrayCache), after they are built if necessary.
/// For a pool read-out they are the engines of the source's columns. For others it is one array of all rows
/// and at most kMostColumnsOnDemand columns. Throws InputError with one line if an array cannot be built:
/// illegal parameters, no Verilator, no compiler, no disk space.
void build_missing_arrays(const ReadoutParameters& parameters, int rows, int columns,
                          std::span<const int> selected,
                          std::span<const SourceFile> sources = project_sources());

/// Same, for find_subsystems().
void build_missing_subsystems(const ReadoutParameters& parameters, int rows, int columns,
                              std::span<const int> selected,
                              std::span<const SourceFile> sources = project_sources());

/// Same, for one array: make_array_model() then accepts `configuration`.
void build_missing_array(const RtlConfiguration& configuration,
                         std::span<const SourceFile> sources = project_sources());

/// Columns of an array whose columns are independent. More columns take longer to compile; groups of columns
/// are read one after the other.
inline constexpr int kMostColumnsOnDemand = 10;

/// Why arrays cannot be built (DTOF_CACHE=off, no Verilator, no compiler); empty if they can.
std::string obstacle_to_building();

}  // namespace dtof
