// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/random.hpp"
#include "rtl/registry.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {

// Scenes of the columns in tests of the pool read-outs' RTL.

template <typename Condition>
std::vector<RtlConfiguration> configurations_with(const Condition& condition) {
  std::vector<RtlConfiguration> chosen;
  std::ranges::copy_if(compiled_rtl_configurations(), std::back_inserter(chosen), condition);
  return chosen;
}

// Scene of a column.
enum class View : std::uint8_t {
  kFlat,         // one depth
  kSlope,        // up to a coarse bin from pixel to pixel
  kSteps,        // another depth every few pixels, across the groups' borders
  kAlternating,  // two depths in turn: every neighbour disagrees
  kDrift,  // the depth moves while the frame lasts: pointers run, those near a candidate into their limits
  kRolesChange,  // two depths, one brighter until the pointer phase, then only the other
  kEnds,         // the first and the last codes
  kOneCode,      // the same code in every slot of every pixel: bins, scores and advantages saturate
  kNothing,      // background only
};

inline constexpr std::array<View, 9> kViews = {View::kFlat,        View::kSlope,   View::kSteps,
                                               View::kAlternating, View::kDrift,   View::kRolesChange,
                                               View::kEnds,        View::kOneCode, View::kNothing};

inline std::string_view view_name(View view) {
  constexpr std::array<std::string_view, kViews.size()> kNames = {
      "flat", "slope", "steps", "alternating", "drift", "roles change", "ends", "one code", "nothing"};
  return kNames[static_cast<std::size_t>(view)];
}

// A column of surfaces in light of random strength: photons in order of arrival; those beyond SLOTS are lost.
class Surfaces {
 public:
  Surfaces(const RtlConfiguration& configuration, std::uint32_t acquisitions, CounterRandom& random)
      : parameters_(configuration.parameters),
        rows_(configuration.pixels_per_sram),
        acquisitions_(acquisitions),
        track_end_(PoolSchedule(acquisitions, parameters_.pool).track_end),
        random_(random) {}

  ColumnStream column(View view) {
    constexpr std::array<double, 5> kBackgrounds = {0.0, 0.05, 0.3, 1.0, 2.5};
    constexpr std::array<double, 4> kSignals = {0.02, 0.1, 0.5, 0.9};
    background_ = kBackgrounds[static_cast<std::size_t>(pick(random_, kBackgrounds.size()))];
    signal_ = kSignals[static_cast<std::size_t>(pick(random_, kSignals.size()))];
    width_ = 0.02 * codes() * random_.uniform();
    depth_ = codes() * random_.uniform();
    other_ = codes() * random_.uniform();
    slope_ = coarse_bin() * (2.0 * random_.uniform() - 1.0);
    one_code_ = static_cast<Timestamp>(pick(random_, parameters_.no_detection()));
    ColumnStream column;
    for (int row = 0; row < rows_; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < acquisitions_; ++acquisition) {
        append(column, view, row, acquisition);
      }
      column.finish_row();
    }
    return column;
  }

 private:
  [[nodiscard]] double codes() const { return parameters_.code_count(); }
  [[nodiscard]] double coarse_bin() const { return codes() / 32.0; }

  void append(ColumnStream& column, View view, int row, std::uint32_t acquisition) {
    const auto slots = static_cast<std::size_t>(parameters_.slots);
    photons_.clear();
    if (view == View::kOneCode) {
      photons_.assign(slots, one_code_);
    } else {
      if (view != View::kNothing && random_.uniform() < signal_) {
        add(surface(view, row, acquisition) + width_ * (random_.uniform() + random_.uniform() - 1.0));
      }
      for (double left = background_; left > 0.0; left -= 1.0) {
        if (random_.uniform() < left) {
          add(codes() * random_.uniform());
        }
      }
      std::ranges::sort(photons_);
      photons_.resize(std::min(photons_.size(), slots));
    }
    for (const Timestamp code : photons_) {
      column.append({acquisition, code});
    }
  }

  void add(double code) {
    if (code >= 0.0 && code < codes()) {
      photons_.push_back(static_cast<Timestamp>(code));
    }
  }

  double surface(View view, int row, std::uint32_t acquisition) {
    constexpr int kStep = 5;
    const bool pointing = acquisition >= track_end_;
    switch (view) {
      case View::kSlope:
        return depth_ + slope_ * row;
      case View::kSteps:
        return (row / kStep) % 2 == 0 ? depth_ : other_;
      case View::kAlternating:
        return row % 2 == 0 ? depth_ : other_;
      case View::kDrift:
        return depth_ + (pointing ? 2.0 * slope_ * (acquisition - track_end_ + 1) / acquisitions_ : 0.0) +
               (pointing ? slope_ : 0.0);
      case View::kRolesChange:
        return pointing || random_.uniform() < 0.4 ? other_ : depth_;
      case View::kEnds:
        return row % 2 == 0 ? 0.001 * codes() : 0.998 * codes();
      default:
        return depth_;
    }
  }

  ReadoutParameters parameters_;
  int rows_;
  std::uint32_t acquisitions_;
  std::uint32_t track_end_;
  CounterRandom& random_;

  double background_ = 0.0;
  double signal_ = 0.0;
  double width_ = 0.0;
  double depth_ = 0.0;
  double other_ = 0.0;
  double slope_ = 0.0;
  Timestamp one_code_ = 0;
  std::vector<Timestamp> photons_;
};

inline std::vector<ColumnStream> surface_columns(const RtlConfiguration& configuration,
                                                 std::uint32_t acquisitions, View view,
                                                 CounterRandom& random) {
  Surfaces surfaces(configuration, acquisitions, random);
  std::vector<ColumnStream> columns;
  columns.reserve(static_cast<std::size_t>(configuration.sram_num));
  for (int column = 0; column < configuration.sram_num; ++column) {
    columns.push_back(surfaces.column(view));
  }
  return columns;
}

}  // namespace dtof
