// SPDX-License-Identifier: Apache-2.0
#include "reproduction/reproduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "accuracy/accuracy_tables.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

constexpr double kNs = 1e-9;
constexpr std::array kGuards = {0, 16, 46};

std::vector<ReadoutParameters> defaults_of(std::span<const Readout> readouts, int slots) {
  std::vector<ReadoutParameters> parameters;
  for (const Readout readout : readouts) {
    parameters.push_back(ReadoutParameters::defaults(readout));
    parameters.back().slots = slots;
  }
  return parameters;
}

class Measuring {
 public:
  explicit Measuring(const ReproductionSettings& settings) {
    result_.settings = settings;
    result_.sensor = parse_preset("thesis");
    base_.sensor = result_.sensor;
    base_.frames = settings.frames;
    base_.run.seed = settings.seed;
    base_.run.threads = settings.threads;
    bare_ = base_;
    bare_.matched_filter = false;
    bare_.lookup_table = false;
  }

  Reproduction run() {
    result_.studies = thesis_studies(base_, kThesisReadouts, true);
    more_frames();
    figures();
    guards();
    methods();
    assumptions();
    steps();
    rates();
    lights();
    convergence();
    pulses();
    arrays();
    return std::move(result_);
  }

 private:
  // All sweeps that the statements speak of; the look-up table and the matched filter cost as much again.
  [[nodiscard]] static ThesisStudies thesis_studies(StudySettings settings, std::span<const Readout> readouts,
                                                    bool lookup_table) {
    settings.distances_m = thesis_distances();
    settings.readouts = defaults_of(readouts, settings.sensor.slots);
    settings.matched_filter = lookup_table;
    settings.lookup_table = lookup_table;
    ThesisStudies studies;
    for (const double klux : thesis_klux()) {
      settings.klux = klux;
      studies.at_klux.emplace(klux, run_accuracy_study(settings));
    }
    settings.sensor = with_sensors(settings.sensor, kThesisSensors / 10.0);
    settings.klux = 50.0;
    studies.tenth_at_50_klux = run_accuracy_study(settings);
    return studies;
  }

  void more_frames() {
    const auto open = [&](const ThesisStatement& statement) {
      return statement.judge(result_.studies).verdict == Verdict::kOpen;
    };
    if (std::ranges::any_of(precision_statements(), open) ||
        std::ranges::any_of(alternative_readings(), open)) {
      StudySettings settings = base_;
      settings.frames = 10 * base_.frames;
      result_.more_frames = thesis_studies(settings, thesis_readouts(), true);
    }
  }

  [[nodiscard]] FigureScene scene(double klux, double distance_m) const {
    constexpr int kFrames = 1000;  // as in the thesis; whole histograms are kept
    const ReproductionSettings& settings = result_.settings;
    return {result_.sensor,  klux, distance_m, std::min(settings.frames, kFrames), settings.seed,
            settings.threads};
  }

  void figures() {
    const std::uint32_t frame = result_.sensor.acquisitions;
    result_.whole_frame = histogram_peaks(scene(14.0, 1.0), frame);
    result_.half_frame = histogram_peaks(scene(14.0, 1.0), frame / 2);
    FigureScene long_frame = scene(14.0, 1.0);
    long_frame.sensor.acquisitions = 33'333;
    long_frame.frames = std::max(long_frame.frames / 20, 4);
    result_.long_frame = histogram_peaks(long_frame, long_frame.sensor.acquisitions);
    result_.sunny = histogram_peaks(scene(50.0, 3.0), frame / 2);
    result_.indoors = histogram_peaks(scene(14.0, 3.0), frame / 2);
    result_.far = histogram_peaks(scene(14.0, 5.0), frame / 2);
    result_.pile_up_near = pile_up(scene(14.0, 0.2));
    result_.pile_up_far = pile_up(scene(14.0, 0.5));
    result_.sides = side_shares(scene(14.0, 1.0));
    result_.fine = fine_histogram(scene(14.0, 1.0));
    for (const int guard : kGuards) {
      result_.filters.push_back(filtered_counts(scene(14.0, 1.0), guard));
    }
  }

  void guards() {
    StudySettings settings = base_;
    settings.klux = 14.0;
    settings.matched_filter = false;
    settings.distances_m = {0.5, 1.0, 2.0, 3.0};
    for (const int guard : kGuards) {
      settings.readouts = defaults_of(std::array{Readout::kHisPointer}, settings.sensor.slots);
      settings.readouts.front().guard = guard;
      result_.guards.push_back({guard_title(guard), run_accuracy_study(settings)});
    }
  }

  // Improvement methods of thesis 2.2.4 where it says that they do not help.
  void methods() {
    StudySettings settings = bare_;
    settings.klux = 50.0;
    settings.distances_m = {3.0};
    settings.frames = 4 * base_.frames;
    result_.method_frames = settings.frames;
    const auto add = [&](const std::string& name, auto change) {
      settings.sensor = result_.sensor;
      change(settings.sensor);
      settings.readouts = defaults_of(thesis_readouts(), settings.sensor.slots);
      result_.methods.push_back({name, run_accuracy_study(settings)});
    };
    add("none", [](auto&) {});
    add("binning 2 x 2", [](auto& s) { s.binning = 2; });
    add("binning 2 x 2, eight slots", [](auto& s) {
      s.binning = 2;
      s.slots = 8;
    });
    add("gate 0 to 27 ns (keeps 0 to 3.5 m)", [](auto& s) { s.time_gate = TimeGate{0.0, 27 * kNs}; });
    add("gate 17 to 27 ns (knows the target within 0.75 m)", [](auto& s) {
      s.time_gate = TimeGate{17 * kNs, 27 * kNs};
    });
    add("coincidence 1 ns", [](auto& s) { s.coincidence_window_s = 1 * kNs; });
    add("coincidence 2 ns (one pulse length)", [](auto& s) { s.coincidence_window_s = 2 * kNs; });
    add("coincidence 5 ns", [](auto& s) { s.coincidence_window_s = 5 * kNs; });
  }

  void assumptions() {
    const auto add = [&](const std::string& name, auto change, int frames) {
      StudySettings settings = base_;
      settings.frames = frames;
      change(settings.sensor);
      result_.assumptions.push_back({name, thesis_studies(settings, thesis_readouts(), false)});
    };
    const int frames = base_.frames;
    add(
        "preset", [](auto&) {}, frames);
    add(
        "signal 0.20 (derived)", [](auto& s) { s.signal_events_1m = 0.20; }, frames);
    add(
        "signal 0.25", [](auto& s) { s.signal_events_1m = 0.25; }, frames);
    add(
        "signal 0.35", [](auto& s) { s.signal_events_1m = 0.35; }, frames);
    add(
        "background x 0.8", [](auto& s) { s.background_events_per_klux *= 0.8; }, frames);
    add(
        "background x 1.25", [](auto& s) { s.background_events_per_klux *= 1.25; }, frames);
    add(
        "one slot", [](auto& s) { s.slots = 1; }, frames);
    add(
        "four slots", [](auto& s) { s.slots = 4; }, frames);
    add(
        "dead time 5 ns", [](auto& s) { s.dead_time_s = 5e-9; }, frames);
    add(
        "33,333 acquisitions", [](auto& s) { s.acquisitions = 33'333; }, std::max(frames / 10, 4));
  }

  void steps() {
    StudySettings settings = bare_;
    settings.klux = 14.0;
    settings.distances_m = {0.2, 0.21, 0.22, 0.25, 0.3};
    const auto add = [&](const std::string& name, int step, int fraction_bits) {
      ReadoutParameters pointer = ReadoutParameters::defaults(Readout::kEzPointer);
      pointer.pointer_step = step;
      pointer.fraction_bits = fraction_bits;
      settings.readouts = {pointer};
      result_.steps.push_back({name, run_accuracy_study(settings)});
    };
    add("step of 1 bin (thesis)", 1, 0);
    add("step of 2 bins", 2, 0);
    add("step from 1 to 1/16 bin (FRACTION_BITS 4)", 1, 4);
  }

  void rates() {
    for (const double signal : {0.20, 0.30, 0.40}) {
      for (const double background : {0.10, 0.15, 0.20}) {
        StudySettings settings = base_;
        settings.sensor.signal_events_1m = signal;
        settings.sensor.background_events_per_klux = background / 14.0;
        result_.rates.push_back({signal, background, thesis_studies(settings, thesis_readouts(), false)});
      }
    }
  }

  void lights() {
    StudySettings settings = bare_;
    settings.distances_m = {2.5, 3.0, 3.5};
    settings.readouts = defaults_of(thesis_readouts(), settings.sensor.slots);
    settings.frames = 5 * base_.frames;  // outliers are rare, and they decide
    result_.light_frames = settings.frames;
    for (double klux = 50.0; klux >= 2.0; klux -= 4.0) {
      settings.klux = klux;
      result_.lights.push_back(run_accuracy_study(settings));
    }
  }

  void convergence() {
    StudySettings settings = base_;
    for (int i = 1; i <= 24; ++i) {
      settings.distances_m.push_back(0.25 * i);
    }
    settings.readouts =
        defaults_of(std::array{Readout::kEzPointer, Readout::kHisPointer}, settings.sensor.slots);
    for (const double klux : {14.0, 50.0}) {
      settings.klux = klux;
      result_.convergence.push_back(run_accuracy_study(settings));
    }
  }

  void pulses() {
    StudySettings settings = bare_;
    settings.klux = 14.0;
    settings.frames = std::max(base_.frames / 10, 4);
    settings.readouts = defaults_of(std::array{Readout::kEzPointer}, settings.sensor.slots);
    settings.distances_m = {3.0, 4.0, 5.0};
    for (const std::uint32_t acquisitions :
         {333U, 1000U, 2000U, 3333U, 5000U, 8000U, 13'000U, 20'000U, 33'333U}) {
      settings.sensor.acquisitions = acquisitions;
      result_.pulses.push_back({acquisitions, run_accuracy_study(settings)});
    }
  }

  void arrays() {
    constexpr int kStepsPerDecade = 8;
    for (int i = 0; i <= 3 * kStepsPerDecade / 2; ++i) {
      result_.array_sizes.push_back(
          std::round(kThesisSensors / std::pow(10.0, static_cast<double>(i) / kStepsPerDecade)));
    }
    StudySettings settings = base_;
    settings.klux = 50.0;
    settings.readouts = defaults_of(kThesisReadouts, settings.sensor.slots);
    settings.calibration_step_m = 0.1;
    result_.margins = array_margins(settings, result_.array_sizes);
    settings.distances_m = thesis_distances();
    for (const double count : {3200.0, 8000.0, 16'000.0}) {
      settings.sensor = with_sensors(result_.sensor, count);
      result_.small_arrays.push_back({fmt::format("{:g} sensors", count), run_accuracy_study(settings)});
    }
  }

  Reproduction result_;
  StudySettings base_;
  StudySettings bare_;  // without look-up table and matched filter
};

const AccuracyPoint& guard_point(const Reproduction& reproduction, std::size_t index, double distance_m) {
  return reproduction.guards[index].measured.at("hispointer", distance_m);
}

}  // namespace

Judgement judge(const Reproduction& reproduction, const ThesisStatement& statement) {
  Judgement judgement = statement.judge(reproduction.studies);
  if (judgement.verdict == Verdict::kOpen && reproduction.more_frames) {
    judgement = statement.judge(*reproduction.more_frames);
    judgement.here += fmt::format(" ({} frames)", 10 * reproduction.settings.frames);
  }
  return judgement;
}

std::vector<JudgedStatement> judged_statements(const Reproduction& r) {
  std::vector<JudgedStatement> all;
  for (const ThesisStatement& statement : precision_statements()) {
    all.push_back({statement.place, statement.text, statement.rule, judge(r, statement)});
  }
  const auto fakes = [](const HistogramPeaks& peaks) {
    constexpr double kRareEvent = 0.05;
    return std::vector{
        Comparison{"share of half frames whose highest bin is noise", peaks.fake_share, kRareEvent}};
  };
  const std::string in_spread = "the figure lies in the middle 95 % of single frames";
  all.push_back({"Fig. 2.4", "pile-up takes counts and narrows the pulse, at 0.2 m more than at 0.5 m",
                 "mean histograms: events lost and full width at half maximum; no interval",
                 judge_pile_up(r.pile_up_near, r.pile_up_far)});
  all.push_back({"Fig. 3.5", "14 klux, 1 m, \"one frame\": highest bin is 195 with 17 counts", in_spread,
                 judge_peak(r.whole_frame, 17.0, 195.0)});
  all.push_back({"Fig. 3.5", "the same, if the figure shows half a frame (one measurement)", in_spread,
                 judge_peak(r.half_frame, 17.0, 195.0)});
  all.push_back({"Fig. 3.6", "14 klux, 1 m: turned around its peak, the histogram has equal sides",
                 "mean share of the counts above the highest bin: interval within 48 to 52 %",
                 judge_sides(r.sides)});
  all.push_back({"Fig. 3.9", "14 klux, 1 m: SiFH's fine histogram has its peak in bin 195", in_spread,
                 judge_fine_peak(r.fine, 195.0)});
  all.push_back(
      {"Fig. 3.11",
       fmt::format("14 klux, 1 m: SiFH's narrower filter ({}) cuts the pulse, hisPointer's ({}) keeps "
                   "it, and the pointer is the better for it",
                   guard_title(kGuards.front()), guard_title(kGuards.back())),
       "middle 95 % of frames of the share kept apart, and intervals of the rmse after the look-up "
       "table apart",
       judge_filters(r.filters.front(), r.filters.back(), guard_point(r, 0, 1.0).rmse_m,
                     guard_point(r, r.guards.size() - 1, 1.0).rmse_m)});
  all.push_back({"Fig. 3.13a",
                 "50 klux, 3 m, one measurement: the histogram's highest bin is a fake (no rare event)",
                 "share of half frames whose highest bin is more than 10 % off: above 5 %",
                 all_of(fakes(r.sunny), Side::kAbove)});
  all.push_back({"Fig. 3.13b", "14 klux, 3 m, one measurement: the histogram's highest bin is the target",
                 "share of half frames whose highest bin is more than 10 % off: below 5 %",
                 all_of(fakes(r.indoors), Side::kBelow)});
  all.push_back({"Fig. 3.15", "14 klux, 5 m: the position of the highest bin fluctuates for want of signal",
                 "share of half frames whose highest bin is more than 10 % off: intervals at 5 m and at 3 m "
                 "apart",
                 judge_far_peak(r.far, r.indoors)});
  for (const std::size_t method : {1U, 3U, 6U}) {
    std::vector<Comparison> comparisons;
    for (const AccuracyPoint& point : r.methods[method].measured.points) {
      comparisons.push_back(rmse_against(point, 0.03));
    }
    all.push_back({"3.4", fmt::format("50 klux, 3 m: {} brings no read-out to 3 %", r.methods[method].name),
                   "rmse without look-up table of each of the five: above 3 % of the distance; relative "
                   "precision would reward a pointer that stands still",
                   all_of(comparisons, Side::kAbove)});
  }
  return all;
}

Reproduction measure_reproduction(const ReproductionSettings& settings) { return Measuring(settings).run(); }

}  // namespace dtof
