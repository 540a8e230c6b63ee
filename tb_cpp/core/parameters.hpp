// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace dtof {

/// The read-outs of spec section 3. The numbers are the RTL's READOUT parameter (hdl/package/dtof_pkg.sv).
enum class Readout : int {
  kEzPointer = 0,
  kHisPointer1 = 1,
  kHisPointer = 2,
  kSifh = 3,
  kFifh = 4,
  kThreeSteps = 5,
  kPifh = 6,
  kHistogram = 7,
};

inline constexpr std::array<Readout, 8> kAllReadouts = {
    Readout::kEzPointer, Readout::kHisPointer1, Readout::kHisPointer, Readout::kSifh,
    Readout::kFifh,      Readout::kThreeSteps,  Readout::kPifh,       Readout::kHistogram};

/// Command-line name: ezpointer, hispointer1, hispointer, sifh, fifh, threesteps, pifh, histogram.
std::string_view readout_name(Readout readout);
/// Display name as the thesis writes it, e.g. "hisPointer v1".
std::string_view readout_title(Readout readout);
/// One sentence on what the read-out does.
std::string_view readout_summary(Readout readout);
/// Throws InputError naming the legal names.
Readout parse_readout(std::string_view name);
/// ezPointer and both hisPointers: the result comes from a pointer.
bool is_pointer_readout(Readout readout);

/// Parameters of a read-out, named as the RTL's (spec section 1; ranges in docs/readouts.md).
struct ReadoutParameters {
  Readout readout = Readout::kEzPointer;
  int np = 10;               ///< NP, bits of a timestamp
  int nb = 5;                ///< NB, bits of the coarse index (unused by ezPointer, three steps, histogram)
  int slots = 2;             ///< SLOTS
  int count_width = 10;      ///< COUNT_WIDTH
  int pointer_step = 1;      ///< POINTER_STEP, bins
  int fraction_bits = 0;     ///< FRACTION_BITS (pointer read-outs)
  int confidence_width = 4;  ///< CONFIDENCE_WIDTH (pointer read-outs)
  int guard = 46;            ///< GUARD, bins (hisPointer v2)
  bool window_centred = false;  ///< WINDOW_CENTRED (SiFH)

  /// Spec defaults: NB = floor(NP/2) + 1 for SiFH (Eq. 2.3), floor(NP/2) for FiFH and hisPointer,
  /// min(NP, 6) for PiFH, NP for the histogram; GUARD = ceil(FWHM / T_res) scaled to NP.
  static ReadoutParameters defaults(Readout readout, int np = 10);

  /// Throws InputError with one sentence if a parameter is outside its range.
  void validate() const;

  /// 2^NP.
  [[nodiscard]] int code_count() const { return 1 << np; }
  /// 2^NP - 1.
  [[nodiscard]] int no_detection() const { return (1 << np) - 1; }
  /// E.g. "sifh NP=10 SLOTS=2 NB=6 COUNT_WIDTH=10 WINDOW_CENTRED=0".
  [[nodiscard]] std::string to_string() const;

  bool operator==(const ReadoutParameters&) const = default;
};

}  // namespace dtof
