// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml.
// clang-format off
#pragma once

#include <array>
#include <string_view>

namespace dtof {

/// The read-outs of the thesis and of this project (docs/reference/readouts.md).
enum class Readout : int {
  kEzPointer = 0,
  kHisPointer1 = 1,
  kHisPointer = 2,
  kSifh = 3,
  kFifh = 4,
  kThreeSteps = 5,
  kPifh = 6,
  kHistogram = 7,
  kCoarseHistogram = 8,
  kPoolPointer = 9,
  kPoolPointerLean = 10,
};

/// All read-outs.
inline constexpr std::array<Readout, 11> kAllReadouts = {
    Readout::kEzPointer,
    Readout::kHisPointer1,
    Readout::kHisPointer,
    Readout::kSifh,
    Readout::kFifh,
    Readout::kThreeSteps,
    Readout::kPifh,
    Readout::kHistogram,
    Readout::kCoarseHistogram,
    Readout::kPoolPointer,
    Readout::kPoolPointerLean};

/// The read-outs of the thesis.
inline constexpr std::array<Readout, 8> kThesisReadouts = {
    Readout::kEzPointer,
    Readout::kHisPointer1,
    Readout::kHisPointer,
    Readout::kSifh,
    Readout::kFifh,
    Readout::kThreeSteps,
    Readout::kPifh,
    Readout::kHistogram};

/// The read-outs with RTL, in dtof_array or an array of their own.
inline constexpr std::array<Readout, 11> kRtlReadouts = {
    Readout::kEzPointer,
    Readout::kHisPointer1,
    Readout::kHisPointer,
    Readout::kSifh,
    Readout::kFifh,
    Readout::kThreeSteps,
    Readout::kPifh,
    Readout::kHistogram,
    Readout::kCoarseHistogram,
    Readout::kPoolPointer,
    Readout::kPoolPointerLean};

/// Command-line name: ezpointer, hispointer1, hispointer, sifh, fifh, threesteps, pifh, histogram, coarsehistogram, poolpointer, poolpointer-lean.
std::string_view readout_name(Readout readout);
/// Display name as the thesis writes it, e.g. "hisPointer v1".
std::string_view readout_title(Readout readout);
/// One sentence on what the read-out does.
std::string_view readout_summary(Readout readout);
/// True if the result is a pointer.
bool is_pointer_readout(Readout readout);
/// True for pool read-outs: pixels use the results of other pixels in their engine's columns.
bool is_pool_readout(Readout readout);
/// True if the read-out scans a histogram.
bool has_histogram(Readout readout);
/// True if the read-out has RTL.
bool has_rtl(Readout readout);
/// True if an RTL parameter other than NP and SLOTS can be chosen for the read-out and changes its result;
/// false for an unknown name.
bool has_parameter(Readout readout, std::string_view parameter);
/// Default value of a parameter of readouts.toml for the read-out. Throws std::logic_error for an unknown
/// name.
int default_value(Readout readout, std::string_view parameter, int np);

}  // namespace dtof
