// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "dtof/core/parameters.hpp"
#include "rtl/configuration.hpp"
#include "sources/sources.hpp"

namespace dtof {

/// Sees to it that find_rtl_configurations() finds the arrays that read `selected` columns of a source of so
/// many rows and columns: those that the program has not are loaded from the user's cache (ArrayCache), built
/// before if they are not there. A pool read-out's arrays are the engines that the source's columns cut into;
/// of another read-out one array of all rows and at most kMostColumnsOnDemand columns. Throws InputError with
/// one line if an array cannot be built: parameters that are illegal, no Verilator or compiler, no room.
void build_missing_arrays(const ReadoutParameters& parameters, int rows, int columns,
                          std::span<const int> selected,
                          std::span<const SourceFile> sources = project_sources());

/// The same for find_subsystems().
void build_missing_subsystems(const ReadoutParameters& parameters, int rows, int columns,
                              std::span<const int> selected,
                              std::span<const SourceFile> sources = project_sources());

/// The same for one array: make_array_model() then has `configuration`.
void build_missing_array(const RtlConfiguration& configuration,
                         std::span<const SourceFile> sources = project_sources());

/// Columns of an array whose columns are independent: more take longer to compile, and groups of them are
/// read one after the other.
inline constexpr int kMostColumnsOnDemand = 10;

/// Why no array can be built here: DTOF_CACHE=off, no Verilator, no compiler. Empty if it can.
std::string obstacle_to_building();

}  // namespace dtof
