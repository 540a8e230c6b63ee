// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml.
// clang-format off
#include "dtof/core/readout.hpp"

#include <algorithm>
#include <stdexcept>

namespace dtof {
namespace {

struct Description {
  std::string_view name;
  std::string_view title;
  std::string_view summary;
  bool pointer;
  bool pool;
  bool histogram;
  bool rtl;
  std::array<std::string_view, 6> choices;  // empty ones are none
};

constexpr std::array<Description, kAllReadouts.size()> kDescriptions = {{
    {"ezpointer", "ezPointer",
     "one pointer a pixel steps towards each timestamp: a circular median",
     true, false, false, true,
     {"POINTER_STEP", "FRACTION_BITS", "CONFIDENCE_WIDTH"}},
    {"hispointer1", "hisPointer v1",
     "coarse histogram, then the pointer starts at its peak",
     true, false, true, true,
     {"NB", "COUNT_WIDTH", "POINTER_STEP", "FRACTION_BITS", "CONFIDENCE_WIDTH"}},
    {"hispointer", "hisPointer",
     "coarse histogram, then the pointer sees only a window around its peak",
     true, false, true, true,
     {"NB", "COUNT_WIDTH", "POINTER_STEP", "FRACTION_BITS", "CONFIDENCE_WIDTH", "GUARD"}},
    {"sifh", "SiFH",
     "coarse histogram, then a fine histogram shifted onto its peak",
     false, false, true, true,
     {"NB", "COUNT_WIDTH", "WINDOW_CENTRED"}},
    {"fifh", "FiFH",
     "coarse histogram, then a fine histogram of exactly its peak bin",
     false, false, true, true,
     {"NB", "COUNT_WIDTH"}},
    {"threesteps", "three steps",
     "three coarse histograms of 8 bins zoom in, then 16 fine bins",
     false, false, true, true,
     {"COUNT_WIDTH"}},
    {"pifh", "PiFH",
     "the range is scanned partition by partition in one small histogram",
     false, false, true, true,
     {"NB", "COUNT_WIDTH"}},
    {"histogram", "histogram",
     "all 2^NP bins of every pixel, the classical baseline",
     false, false, true, true,
     {"COUNT_WIDTH"}},
    {"coarsehistogram", "coarse histogram",
     "one coarse histogram for the whole frame; its highest pair of bins and their neighbours hold the place",
     false, false, true, true,
     {"NB", "COUNT_WIDTH", "FRACTION_BITS"}},
    {"poolpointer", "poolPointer",
     "neighbours in two dimensions share coarse histograms; each pixel picks and refines a candidate",
     false, true, false, true,
     {"COUNT_WIDTH", "CELL_SHIFT", "GROUP_SIZE", "LABELS", "SCORE_BITS", "ENGINE_COLUMNS"}},
    {"poolpointer-lean", "poolPointer lean",
     "poolPointer in half the memory: larger groups, shorter words",
     false, true, false, true,
     {"COUNT_WIDTH", "CELL_SHIFT", "GROUP_SIZE", "LABELS", "SCORE_BITS", "ENGINE_COLUMNS"}},
}};

const Description& description(Readout readout) { return kDescriptions[static_cast<std::size_t>(readout)]; }

}  // namespace

std::string_view readout_name(Readout readout) { return description(readout).name; }
std::string_view readout_title(Readout readout) { return description(readout).title; }
std::string_view readout_summary(Readout readout) { return description(readout).summary; }
bool is_pointer_readout(Readout readout) { return description(readout).pointer; }
bool is_pool_readout(Readout readout) { return description(readout).pool; }
bool has_histogram(Readout readout) { return description(readout).histogram; }
bool has_rtl(Readout readout) { return description(readout).rtl; }

bool has_parameter(Readout readout, std::string_view parameter) {
  const auto& choices = description(readout).choices;
  return !parameter.empty() && std::find(choices.begin(), choices.end(), parameter) != choices.end();
}

int default_value(Readout readout, std::string_view parameter, int np) {
  if (readout == Readout::kSifh && parameter == "NB") {
    return (np / 2) + 1;
  }
  if (readout == Readout::kPifh && parameter == "NB") {
    return std::min(np, 6);
  }
  if (readout == Readout::kHistogram && parameter == "NB") {
    return np;
  }
  if (readout == Readout::kCoarseHistogram && parameter == "NB") {
    return std::min(np, 5);
  }
  if (readout == Readout::kCoarseHistogram && parameter == "FRACTION_BITS") {
    return std::min(2, (16 - np));
  }
  if (readout == Readout::kPoolPointer && parameter == "NB") {
    return 5;
  }
  if (readout == Readout::kPoolPointer && parameter == "COUNT_WIDTH") {
    return 7;
  }
  if (readout == Readout::kPoolPointer && parameter == "FRACTION_BITS") {
    return 16 - np;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "NB") {
    return 5;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "COUNT_WIDTH") {
    return 7;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "FRACTION_BITS") {
    return 16 - np;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "GROUP_SIZE") {
    return 8;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "LABELS") {
    return 4;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "OFFSET_BITS") {
    return 0;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "ADVANTAGE_WIDTH") {
    return 4;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "POINTER_SHIFT") {
    return 4;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "RIVAL_MOVES") {
    return 0;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "ENGINE_COLUMNS") {
    return 50;
  }
  if (readout == Readout::kPoolPointerLean && parameter == "TRACK_SHARE") {
    return 20;
  }
  if (parameter == "NP") {
    return 10;
  }
  if (parameter == "NB") {
    return np / 2;
  }
  if (parameter == "SRAM_NUM") {
    return 200;
  }
  if (parameter == "PIXELS_PER_SRAM") {
    return 160;
  }
  if (parameter == "SLOTS") {
    return 2;
  }
  if (parameter == "COUNT_WIDTH") {
    return 10;
  }
  if (parameter == "POINTER_STEP") {
    return 1;
  }
  if (parameter == "FRACTION_BITS") {
    return 0;
  }
  if (parameter == "CONFIDENCE_WIDTH") {
    return 4;
  }
  if (parameter == "GUARD") {
    return ((2 << np) + 44) / 45;
  }
  if (parameter == "WINDOW_CENTRED") {
    return 0;
  }
  if (parameter == "POINTER_PORTS") {
    return 2;
  }
  if (parameter == "SIGNALLED_CLEAR") {
    return 0;
  }
  if (parameter == "PARITY") {
    return 0;
  }
  if (parameter == "TIME_GATE") {
    return 0;
  }
  if (parameter == "RAW_HISTOGRAM") {
    return 0;
  }
  if (parameter == "GROUP_SIZE") {
    return 4;
  }
  if (parameter == "LABELS") {
    return 5;
  }
  if (parameter == "SCORE_BITS") {
    return 4;
  }
  if (parameter == "OFFSET_BITS") {
    return 6;
  }
  if (parameter == "ADVANTAGE_WIDTH") {
    return 7;
  }
  if (parameter == "POINTER_SHIFT") {
    return 1;
  }
  if (parameter == "RIVAL_MOVES") {
    return 1;
  }
  if (parameter == "CELL_SHIFT") {
    return 9;
  }
  if (parameter == "SECOND_TARGET") {
    return 0;
  }
  if (parameter == "AMPLITUDE") {
    return 0;
  }
  if (parameter == "PRIOR") {
    return 0;
  }
  if (parameter == "ENGINE_COLUMNS") {
    return 34;
  }
  if (parameter == "ACQ_WIDTH") {
    return 16;
  }
  if (parameter == "BROADCAST_STAGES") {
    return 2;
  }
  if (parameter == "COARSE_SHARE") {
    return 14;
  }
  if (parameter == "TRACK_SHARE") {
    return 30;
  }
  throw std::logic_error("no parameter of this name");
}

}  // namespace dtof
