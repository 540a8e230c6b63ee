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
  int frames = 1000;  ///< per point, as in the thesis; ten times as many decide what they leave open
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Figures that were measured with one thing changed.
template <typename Measured>
struct Changed {
  std::string name;
  Measured measured;
};

/// Everything that `dtof-study reproduce` measures; the report is rendered from this alone.
struct Reproduction {
  ReproductionSettings settings;
  SensorModel sensor;
  ThesisStudies studies;
  std::optional<ThesisStudies> more_frames;  ///< ten times as many, where a statement was open

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
  std::vector<FilteredCounts> filters;         ///< 14 klux, 1 m; by GUARD, the thesis's last
  std::vector<Changed<AccuracyStudy>> guards;  ///< hisPointer with these, 14 klux

  /// 50 klux, 3 m, without the table; the first changes nothing.
  std::vector<Changed<AccuracyStudy>> methods;
  int method_frames = 0;
  std::vector<Changed<ThesisStudies>> assumptions;  ///< the first is the preset
  std::vector<Changed<AccuracyStudy>> steps;        ///< ezPointer near, 14 klux; the first is the thesis's
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

/// A statement of the thesis with what was found.
struct JudgedStatement {
  std::string place;
  std::string text;
  std::string rule;
  Judgement judgement;
};
/// By the frames of `studies`, or by ten times as many where these leave it open.
Judgement judge(const Reproduction& reproduction, const ThesisStatement& statement);
/// Those of the thesis, with its figures and improvement methods.
std::vector<JudgedStatement> judged_statements(const Reproduction& reproduction);

/// Minutes.
Reproduction measure_reproduction(const ReproductionSettings& settings);

}  // namespace dtof
