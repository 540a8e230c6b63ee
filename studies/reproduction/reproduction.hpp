// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "common/array_size.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "reproduction/thesis_figures.hpp"
#include "reproduction/thesis_statements.hpp"

namespace dtof {

struct ReproductionSettings {
  int frames = 1000;  ///< per point, as in the thesis; open statements get ten times as many
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Figures that were measured with one change.
template <typename Measured>
struct Changed {
  std::string name;
  Measured measured;
};

/// All measurements of `dtof-study reproduce`. The report is rendered from this alone.
struct Reproduction {
  ReproductionSettings settings;
  SensorModel sensor;
  ThesisStudies studies;
  std::optional<ThesisStudies> more_frames;  ///< ten times as many frames; set if a statement was open

  HistogramPeaks whole_frame;  ///< 14 klux, 1 m
  HistogramPeaks half_frame;
  HistogramPeaks long_frame;  ///< 33,333 acquisitions
  HistogramPeaks sunny;       ///< 50 klux, 3 m, half a frame
  HistogramPeaks indoors;     ///< 14 klux, 3 m, half a frame
  HistogramPeaks far;         ///< 14 klux, 5 m, half a frame
  PileUp pile_up_near;        ///< 0.2 m
  PileUp pile_up_far;         ///< 0.5 m
  SideShares sides;
  FineHistogram fine;
  std::vector<FilteredCounts> filters;         ///< 14 klux, 1 m; by side band, the last is the thesis's
  std::vector<Changed<AccuracyStudy>> guards;  ///< hisPointer with each side band, 14 klux

  /// 50 klux, 3 m, without the table; the first has no change.
  std::vector<Changed<AccuracyStudy>> methods;
  int method_frames = 0;
  std::vector<Changed<ThesisStudies>> assumptions;  ///< the first is the preset
  /// ezPointer at near targets, 14 klux; the first is the thesis's.
  std::vector<Changed<AccuracyStudy>> steps;
  struct Rates {
    double signal = 0.0;      ///< events at 1 m
    double background = 0.0;  ///< events at 14 klux
    ThesisStudies studies;
  };
  std::vector<Rates> rates;
  std::vector<AccuracyStudy> lights;  ///< from 50 klux down, at 2.5, 3 and 3.5 m
  int light_frames = 0;
  std::vector<AccuracyStudy> convergence;  ///< ezPointer and hisPointer every 0.25 m, at 14 and 50 klux
  struct Pulses {
    std::uint32_t acquisitions = 0;
    AccuracyStudy study;
  };
  std::vector<Pulses> pulses;  ///< ezPointer, 14 klux
  std::vector<double> array_sizes;
  std::vector<ArrayMargin> margins;
  std::vector<Changed<AccuracyStudy>> small_arrays;  ///< 50 klux
};

/// A statement of the thesis and the judgement on it.
struct JudgedStatement {
  std::string place;
  std::string text;
  std::string rule;
  Judgement judgement;
};
/// Judges by the frames of `studies`, or by ten times as many if these leave the statement open.
Judgement judge(const Reproduction& reproduction, const ThesisStatement& statement);
/// Judgements on the thesis's statements, on its figures and on its improvement methods.
std::vector<JudgedStatement> judged_statements(const Reproduction& reproduction);

/// Measures everything; takes minutes.
Reproduction measure_reproduction(const ReproductionSettings& settings);

}  // namespace dtof
