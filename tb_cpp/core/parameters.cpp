// SPDX-License-Identifier: Apache-2.0
#include "core/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace dtof {
namespace {

struct ReadoutText {
  std::string_view name;
  std::string_view title;
  std::string_view summary;
};

constexpr double kFwhmOverRange = 2.0 / 45.0;  // thesis: FWHM 2 ns, T_int 45 ns

constexpr std::array<ReadoutText, kAllReadouts.size()> kTexts = {{
    {"ezpointer", "ezPointer", "one pointer a pixel steps towards each timestamp: a circular median"},
    {"hispointer1", "hisPointer v1", "coarse histogram, then the pointer starts at its peak"},
    {"hispointer", "hisPointer", "coarse histogram, then the pointer sees only a window around its peak"},
    {"sifh", "SiFH", "coarse histogram, then a fine histogram shifted onto its peak"},
    {"fifh", "FiFH", "coarse histogram, then a fine histogram of exactly its peak bin"},
    {"threesteps", "three steps", "three coarse histograms of 8 bins zoom in, then 16 fine bins"},
    {"pifh", "PiFH", "the range is scanned partition by partition in one small histogram"},
    {"histogram", "histogram", "all 2^NP bins of every pixel, the classical baseline"},
}};

const ReadoutText& text(Readout readout) { return kTexts[static_cast<std::size_t>(readout)]; }

void require_range(std::string_view name, int value, int lowest, int highest) {
  if (value < lowest || value > highest) {
    throw InputError(fmt::format("parameter {} is {}, but must be {} to {}", name, value, lowest, highest));
  }
}

}  // namespace

std::string_view readout_name(Readout readout) { return text(readout).name; }
std::string_view readout_title(Readout readout) { return text(readout).title; }
std::string_view readout_summary(Readout readout) { return text(readout).summary; }

Readout parse_readout(std::string_view name) {
  std::string legal;
  for (const Readout readout : kAllReadouts) {
    if (readout_name(readout) == name) {
      return readout;
    }
    legal += fmt::format("{}{}", legal.empty() ? "" : ", ", readout_name(readout));
  }
  throw InputError(fmt::format("unknown read-out '{}'; known are {}", name, legal));
}

bool is_pointer_readout(Readout readout) {
  return readout == Readout::kEzPointer || readout == Readout::kHisPointer1 ||
         readout == Readout::kHisPointer;
}

ReadoutParameters ReadoutParameters::defaults(Readout readout, int np) {
  ReadoutParameters parameters;
  parameters.readout = readout;
  parameters.np = np;
  parameters.guard = static_cast<int>(std::ceil(kFwhmOverRange * std::ldexp(1.0, np)));
  switch (readout) {
    case Readout::kSifh:
      parameters.nb = np / 2 + 1;
      break;
    case Readout::kPifh:
      parameters.nb = std::min(np, 6);
      break;
    case Readout::kHistogram:
      parameters.nb = np;
      break;
    default:
      parameters.nb = np / 2;
      break;
  }
  return parameters;
}

void ReadoutParameters::validate() const {
  require_range("NP", np, 3, 16);
  require_range("NB", nb, 1, np);
  require_range("SLOTS", slots, 1, 16);
  require_range("COUNT_WIDTH", count_width, 1, 16);
  require_range("POINTER_STEP", pointer_step, 1, (1 << (np - 1)) - 1);
  require_range("FRACTION_BITS", fraction_bits, 0, std::min(8, 16 - np));
  require_range("CONFIDENCE_WIDTH", confidence_width, 0, 8);
  require_range("GUARD", guard, 0, 1 << np);
}

std::string ReadoutParameters::to_string() const {
  std::string out = fmt::format("{} NP={} SLOTS={}", readout_name(readout), np, slots);
  if (readout != Readout::kEzPointer && readout != Readout::kThreeSteps && readout != Readout::kHistogram) {
    out += fmt::format(" NB={}", nb);
  }
  if (readout != Readout::kEzPointer) {
    out += fmt::format(" COUNT_WIDTH={}", count_width);
  }
  if (is_pointer_readout(readout)) {
    out += fmt::format(" POINTER_STEP={} FRACTION_BITS={} CONFIDENCE_WIDTH={}", pointer_step, fraction_bits,
                       confidence_width);
  }
  if (readout == Readout::kHisPointer) {
    out += fmt::format(" GUARD={}", guard);
  }
  if (readout == Readout::kSifh) {
    out += fmt::format(" WINDOW_CENTRED={}", window_centred ? 1 : 0);
  }
  return out;
}

}  // namespace dtof
