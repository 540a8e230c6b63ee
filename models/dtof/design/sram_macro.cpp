// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/sram_macro.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

constexpr std::array<int, 7> kMuxes = {1, 2, 4, 8, 16, 32, 64};
constexpr int kFewestRows = 16;
constexpr int kMostRows = 512;
constexpr double kMostAspect = 4.0;
constexpr double kAccessSlowNs = 2.2;  // of the anchor
constexpr int kAnchorWords = 10240;
constexpr int kAnchorBits = 10;
constexpr int kMostBanks = 64;
constexpr double kMaskUm2 = 12.0;

struct PowerLaw {
  double scale;
  double words_exponent;
  double bits_exponent;

  [[nodiscard]] double of(double words, double bits) const {
    return scale * std::pow(words, words_exponent) * std::pow(bits, bits_exponent);
  }
};

struct LinearInBits {
  double scale;
  double words_exponent;
  double offset;

  [[nodiscard]] double of(double words, double bits) const {
    return scale * std::pow(words, words_exponent) * (bits + offset);
  }
};

struct PortKind {
  double strip_width;
  double strip_height;
  double cell_area;
  double cell_height;
  PowerLaw access;
  LinearInBits read_energy;
  PowerLaw write_energy;
  PowerLaw leakage;
};

constexpr PortKind kOnePort = {29.0,
                               22.5,
                               0.242,
                               0.30,
                               {0.16173, 0.18204, 0.16401},
                               {7.7239e-4, 0.66146, 3.6932},
                               {4.0184e-3, 0.43953, 1.06473},
                               {5.1345e-6, 0.96475, 0.93028}};
constexpr PortKind kTwoPorts = {55.6,
                                35.7,
                                0.472,
                                0.356,
                                {0.17081, 0.17758, 0.16504},
                                {1.28916e-3, 0.62510, 4.6459},
                                {4.1414e-3, 0.45769, 1.05031},
                                {5.4041e-6, 0.97710, 0.94414}};

int divided_up(int value, int by) { return (value + by - 1) / by; }

struct Bank {
  double area;
  int mux;
  int rows;
};

/// The best legal array of so many words.
std::optional<Bank> best_bank(const PortKind& kind, int words, int bits) {
  std::optional<Bank> best;
  for (const int mux : kMuxes) {
    int rows = divided_up(words, mux);
    const double width = kind.strip_width + kind.cell_area / kind.cell_height * bits * mux;
    if (rows >= kFewestRows) {
      rows = std::max(
          rows, static_cast<int>(std::ceil((width / kMostAspect - kind.strip_height) / kind.cell_height)));
    }
    const double height = kind.strip_height + kind.cell_height * rows;
    const bool few = words < kFewestRows;
    const bool legal = few ? mux == 1
                           : rows >= kFewestRows && rows <= kMostRows &&
                                 std::max(width / height, height / width) <= kMostAspect;
    if (legal && (!best || width * height < best->area)) {
      best = Bank{width * height, mux, rows};
    }
  }
  return best;
}

}  // namespace

SramMacro sram_macro(const MacroSize& size) {
  if ((size.ports != 1 && size.ports != 2) || size.words < 1 || size.bits < 1) {
    throw InputError(
        fmt::format("no SRAM macro of {} ports, {} words and {} bits", size.ports, size.words, size.bits));
  }
  const PortKind& kind = size.ports == 1 ? kOnePort : kTwoPorts;
  int banks = 1;
  std::optional<Bank> best = best_bank(kind, size.words, size.bits);
  while (!best && banks < kMostBanks) {
    banks *= 2;
    best = best_bank(kind, divided_up(size.words, banks), size.bits);
  }
  if (!best) {
    throw InputError(fmt::format("an SRAM of {} words of {} bits has no organisation of {} to {} rows",
                                 size.words, size.bits, kFewestRows, kMostRows));
  }
  const int words = std::max(size.words, ((best->rows - 1) * best->mux + 1) * banks);
  const double mask_um2 = size.parts > 1 ? kMaskUm2 * size.parts : 0.0;
  return {.area_um2 = (best->area + mask_um2) * banks,
          .access_slow_ns =
              kAccessSlowNs * kind.access.of(words, size.bits) / kind.access.of(kAnchorWords, kAnchorBits),
          .read_pj = kind.read_energy.of(words, size.bits),
          .write_pj = kind.write_energy.of(words, size.bits),
          .leakage_uw = kind.leakage.of(words, size.bits)};
}

}  // namespace dtof
