// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

#include "app/accuracy_study.hpp"
#include "app/accuracy_tables.hpp"
#include "app/array_size.hpp"
#include "app/commands.hpp"
#include "app/output_folder.hpp"
#include "app/plot.hpp"
#include "app/table.hpp"
#include "app/thesis_figures.hpp"
#include "app/thesis_statements.hpp"
#include "io/atomic_file.hpp"
#include "sensor/preset.hpp"

namespace dtof {
namespace {

struct ReproduceOptions {
  int frames = 1000;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string out = "build/reproduce";
  std::string command_line;
};

std::vector<ReadoutParameters> defaults_of(std::span<const Readout> readouts) {
  std::vector<ReadoutParameters> parameters;
  for (const Readout readout : readouts) {
    parameters.push_back(ReadoutParameters::defaults(readout));
  }
  return parameters;
}

std::string percent(double share) { return fmt::format("{:.2f}", share * 100.0); }
std::string precision_cell(const AccuracyPoint& p) { return percent(p.relative_precision.value); }
std::string rmse_cell(const AccuracyPoint& p) { return percent(p.rmse_m.value / p.distance_m); }
std::string bias_cell(const AccuracyPoint& p) { return fmt::format("{:.0f}", p.bias_m.value * 1e3); }
std::string slope_cell(const AccuracyPoint& p) {
  return p.slope ? fmt::format("{:.2f}", p.slope->value) : "-";
}

/// The report grows section by section; its pictures lie in a folder beside it.
class Report {
 public:
  explicit Report(const ReproduceOptions& options) : options_(options), folder_(options.out) {
    create_output_folder(folder_ / "reproduction");
    base_.sensor = parse_preset("thesis");
    base_.frames = options.frames;
    base_.run.seed = options.seed;
    base_.run.threads = options.threads;
  }

  void run() {
    const auto start = std::chrono::steady_clock::now();
    studies_ = thesis_studies(base_, kAllReadouts, true);
    collect_statements();
    fmt::print("{}\n", front_page());
    std::fflush(stdout);
    write_curves();
    write_figures();
    write_reasons();
    write_convergence();
    write_array_size();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    write_file(folder_ / "reproduction.csv", csv_.csv());
    write_file(folder_ / "reproduction.md",
               front_page() + text_ + fmt::format("\nCommand: `{}`\n", options_.command_line));
    fmt::print("{:.0f} s. The report is {}\n", seconds, (folder_ / "reproduction.md").string());
  }

 private:
  // All sweeps that the statements speak of; the look-up table and the matched filter cost as much again.
  [[nodiscard]] static ThesisStudies thesis_studies(StudySettings settings, std::span<const Readout> readouts,
                                                    bool lookup_table) {
    settings.distances_m = thesis_distances();
    settings.readouts = defaults_of(readouts);
    for (ReadoutParameters& readout : settings.readouts) {
      readout.slots = settings.sensor.slots;
    }
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

  [[nodiscard]] FigureScene scene(double klux, double distance_m) const {
    return {base_.sensor, klux, distance_m, options_.frames, options_.seed, options_.threads};
  }

  std::string picture(const std::string& name, const std::vector<PlotSeries>& series,
                      const PlotLayout& layout) const {
    write_plot(folder_ / "reproduction" / name, series, layout);
    return fmt::format("![{}](reproduction/{})\n\n", layout.title, name);
  }

  void add_statement(const std::string& place, const std::string& text, const Judgement& judgement) {
    const std::string agrees(verdict_text(judgement.verdict));
    statements_.add({place, text, agrees, judgement.here});
    const auto quoted = [](const std::string& cell) {
      std::string doubled;
      for (const char c : cell) {
        doubled += c == '"' ? "\"\"" : std::string(1, c);
      }
      return fmt::format("\"{}\"", doubled);
    };
    csv_.add({quoted(place), quoted(text), agrees, quoted(judgement.here)});
    ++verdicts_[static_cast<std::size_t>(judgement.verdict)];
  }

  // What the frames of `studies_` leave open, ten times as many decide or not.
  Judgement judge(const ThesisStatement& statement) {
    Judgement judgement = statement.judge(studies_);
    if (judgement.verdict == Verdict::kOpen) {
      if (more_frames_.at_klux.empty()) {
        StudySettings settings = base_;
        settings.frames = 10 * options_.frames;
        more_frames_ = thesis_studies(settings, thesis_readouts(), true);
      }
      judgement = statement.judge(more_frames_);
      judgement.here += fmt::format(" ({} frames)", 10 * options_.frames);
    }
    return judgement;
  }

  void collect_statements() {
    for (const ThesisStatement& statement : precision_statements()) {
      add_statement(statement.place, statement.text, judge(statement));
    }
    const std::uint32_t frame = base_.sensor.acquisitions;
    peaks_frame_ = histogram_peaks(scene(14.0, 1.0), frame);
    peaks_half_ = histogram_peaks(scene(14.0, 1.0), frame / 2);
    add_statement("Fig. 3.5", "14 klux, 1 m, \"one frame\": highest bin is 195 with 17 counts",
                  judge_peak(peaks_frame_, 17.0, 195.0));
    add_statement("Fig. 3.5", "the same, if the figure shows half a frame (one measurement)",
                  judge_peak(peaks_half_, 17.0, 195.0));
    pile_up_near_ = pile_up(scene(14.0, 0.2));
    pile_up_far_ = pile_up(scene(14.0, 0.5));
    add_statement("Fig. 2.4", "pile-up takes counts and narrows the pulse, at 0.2 m more than at 0.5 m",
                  judge_pile_up(pile_up_near_, pile_up_far_));
    peaks_fake_ = histogram_peaks(scene(50.0, 3.0), frame / 2);
    const auto fakes = static_cast<std::uint64_t>(std::lround(peaks_fake_.fake_share * options_.frames));
    const Comparison fake{"share of half frames whose highest bin is noise",
                          estimate_share(fakes, static_cast<std::uint64_t>(options_.frames)), 0.05};
    add_statement("Fig. 3.13a",
                  "50 klux, 3 m, one measurement: the histogram's highest bin is a fake (no rare event)",
                  all_of(std::span(&fake, 1), Side::kAbove));
    collect_methods();
  }

  // Improvement methods of thesis 2.2.4 where it says they do not help: 50 klux, 3 m.
  void collect_methods() {
    struct Method {
      const char* statement;  // null: not spoken of by the thesis
      std::string name;
      SensorModel sensor;
    };
    const auto changed = [&](auto change) {
      SensorModel sensor = base_.sensor;
      change(sensor);
      return sensor;
    };
    constexpr double kNs = 1e-9;
    const std::vector<Method> methods = {
        {nullptr, "none", base_.sensor},
        {"binning 2 x 2", "binning 2 x 2", changed([](auto& s) { s.binning = 2; })},
        {nullptr, "binning 2 x 2, eight slots", changed([](auto& s) {
           s.binning = 2;
           s.slots = 8;
         })},
        {"a time gate that keeps 0 to 3.5 m", "gate 0 to 27 ns", changed([](auto& s) {
           s.time_gate = TimeGate{0.0, 27 * kNs};
         })},
        {nullptr, "gate 17 to 27 ns (knows the target within 0.75 m)", changed([](auto& s) {
           s.time_gate = TimeGate{17 * kNs, 27 * kNs};
         })},
        {nullptr, "coincidence 1 ns", changed([](auto& s) { s.coincidence_window_s = 1 * kNs; })},
        {"a coincidence window of one pulse length (2 ns)", "coincidence 2 ns",
         changed([](auto& s) { s.coincidence_window_s = 2 * kNs; })},
        {nullptr, "coincidence 5 ns", changed([](auto& s) { s.coincidence_window_s = 5 * kNs; })}};
    StudySettings settings = base_;
    settings.klux = 50.0;
    settings.distances_m = {3.0};
    settings.frames = 3 * options_.frames;
    settings.matched_filter = false;
    settings.lookup_table = false;
    std::vector<std::string> header = {"method"};
    for (const Readout readout : thesis_readouts()) {
      header.emplace_back(readout_title(readout));
    }
    Table table(header);
    for (const Method& method : methods) {
      settings.sensor = method.sensor;
      settings.readouts = defaults_of(thesis_readouts());
      for (ReadoutParameters& readout : settings.readouts) {
        readout.slots = method.sensor.slots;
      }
      const AccuracyStudy study = run_accuracy_study(settings);
      std::vector<Comparison> comparisons;
      std::vector<std::string> row = {method.name};
      for (const AccuracyPoint& point : study.points) {
        const Estimate& rmse = point.rmse_m;
        const double r = point.distance_m;
        comparisons.push_back(
            {point.title, {rmse.value / r, {rmse.interval.low / r, rmse.interval.high / r}}, 0.03});
        row.push_back(fmt::format("{} / {} / {:.1f}", precision_cell(point), rmse_cell(point),
                                  point.outlier_rate.value * 100.0));
      }
      table.add(row);
      if (method.statement != nullptr) {
        add_statement(
            "3.4",
            fmt::format("50 klux, 3 m: {} brings no read-out to 3 % (by rmse without table, so that standing "
                        "still does not count)",
                        method.statement),
            all_of(comparisons, Side::kAbove));
      }
    }
    methods_ = fmt::format(
        "Relative precision / rmse without table / share of errors above 10 %, all in %; {} frames:\n\n{}\n"
        "Four binned pixels bring {:.1f} background events into an acquisition: a TDC of two slots is full "
        "before the "
        "target's light comes, which binning with eight slots avoids. A gate makes the background lopsided "
        "for a pointer "
        "on a circle. Coincidence keeps a larger share of the signal than of the background, but little of "
        "both: the "
        "pointer, which moves by their difference, gains; a coarse histogram, which needs counts, loses.\n\n",
        settings.frames, table.markdown(), 4.0 * base_.sensor.background_events(50.0, 1.0));
  }

  void write_curves() {
    text_ += "## Relative precision (Fig. 3.12, 3.14, 3.17)\n\n";
    std::vector<AccuracyPoint> all;
    for (const auto& [klux, study] : studies_.at_klux) {
      all.insert(all.end(), study.points.begin(), study.points.end());
      text_ += picture(
          fmt::format("relative_precision_{:g}klux.svg", klux),
          accuracy_series(study.points, [](const auto& p) { return p.relative_precision.value * 100.0; }),
          {.title = fmt::format("Relative precision, {:g} klux", klux),
           .x_label = "distance, m",
           .y_label = "relative precision, %",
           .logarithmic_y = true,
           .y_limits = {3.0}});
      text_ += accuracy_matrix(study.points, precision_cell).markdown() + "\n";
    }
    text_ += "Every figure with its interval: [accuracy.csv](reproduction/accuracy.csv).\n\n";
    write_file(folder_ / "reproduction" / "accuracy.csv", accuracy_csv(all).csv());
    const AccuracyStudy& study = studies_.at_klux.at(14.0);
    text_ += "## Linearity (Fig. 3.16)\n\n";
    text_ +=
        picture("mean_distance_14klux.svg",
                accuracy_series(study.points, [](const auto& p) { return p.distance_m + p.bias_m.value; }),
                {.title = "Mean measured distance before the look-up table, 14 klux",
                 .x_label = "distance, m",
                 .y_label = "mean measured distance, m"});
    text_ +=
        "Bias before the look-up table, mm:\n\n" + accuracy_matrix(study.points, bias_cell).markdown() + "\n";
  }

  static PlotSeries bins_of(const std::string& label, const std::vector<double>& values, std::size_t end) {
    PlotSeries series{label, {}, {}};
    for (std::size_t i = 0; i < std::min(end, values.size()); ++i) {
      series.x.push_back(static_cast<double>(i) + 1.0);  // the thesis counts bins from 1
      series.y.push_back(values[i]);
    }
    return series;
  }

  void write_figures() {
    text_ += "## Fig. 3.5: which histogram has 17 counts\n\n";
    text_ += picture("figure_3_5.svg",
                     {bins_of("whole frame", peaks_frame_.one_frame, 1023),
                      bins_of("first half", peaks_half_.one_frame, 1023)},
                     {.title = "Histogram of one frame, 1 m, 14 klux",
                      .x_label = "bin (1 = code 0)",
                      .y_label = "counts",
                      .markers = false});
    FigureScene long_frame = scene(14.0, 1.0);
    long_frame.sensor.acquisitions = 33'333;
    long_frame.frames = std::max(options_.frames / 20, 4);
    const HistogramPeaks peaks_long = histogram_peaks(long_frame, long_frame.sensor.acquisitions);
    Table table({"histogram of", "counts in the highest bin, 95 %", "its number, 95 %"});
    const auto add = [&](const std::string& what, const HistogramPeaks& peaks) {
      table.add({what, fmt::format("{:g} to {:g}", peaks.count.low, peaks.count.high),
                 fmt::format("{:g} to {:g}", peaks.bin.low, peaks.bin.high)});
    };
    add("3,333 acquisitions (100 kHz, 30 frames/s)", peaks_frame_);
    add("half of them: one measurement", peaks_half_);
    add("33,333 acquisitions (as written in the thesis)", peaks_long);
    text_ += table.markdown() + "\n";
    text_ += "## Fig. 2.4: pile-up\n\n";
    for (const auto& [distance, figure] : {std::pair{0.2, &pile_up_near_}, std::pair{0.5, &pile_up_far_}}) {
      text_ += picture(fmt::format("figure_2_4_{:g}m.svg", distance),
                       {bins_of("arriving", figure->arriving, 256),
                        bins_of("delivered by the TDC", figure->delivered, 256)},
                       {.title = fmt::format("Events a frame and bin, {:g} m, 14 klux", distance),
                        .x_label = "bin (1 = code 0)",
                        .y_label = "events",
                        .markers = false});
    }
    text_ += "## Binning, time gating, coincidence at 50 klux and 3 m\n\n" + methods_;
  }

  // Statements under other assumptions: which of them makes a statement come out.
  void write_reasons() {
    struct Variant {
      std::string name;
      SensorModel sensor;
      int frames;
    };
    std::vector<Variant> variants;
    const auto add = [&](const std::string& name, auto change, int frames) {
      SensorModel sensor = base_.sensor;
      change(sensor);
      variants.push_back({name, sensor, frames});
    };
    const int frames = options_.frames;
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
    std::vector<std::string> header = {"statement"};
    std::vector<ThesisStudies> studies;
    for (const Variant& variant : variants) {
      header.push_back(variant.name);
      StudySettings settings = base_;
      settings.sensor = variant.sensor;
      settings.frames = variant.frames;
      studies.push_back(thesis_studies(settings, thesis_readouts(), false));
    }
    Table table(header);
    for (const ThesisStatement& statement : precision_statements()) {
      std::vector<std::string> row = {statement.text};
      for (const ThesisStudies& study : studies) {
        row.emplace_back(verdict_text(statement.judge(study).verdict));
      }
      table.add(row);
    }
    text_ +=
        "## Why some statements do not come out\n\n"
        "Four things decide, each with its experiment below: the point at 0.2 m (the pointer's unit step, "
        "and the second "
        "photon of a pulse), which points a plot has (whole metres), the farthest distance judged (3 or 3.5 "
        "m), and the "
        "few outliers that 1,000 frames happen to hold.\n\nOther readings, judged by the same sweeps:\n\n";
    Table readings({"thesis", "read as", "agrees", "here"}, 4);
    for (const ThesisStatement& reading : alternative_readings()) {
      const Judgement judgement = judge(reading);
      readings.add(
          {reading.place, reading.text, std::string(verdict_text(judgement.verdict)), judgement.here});
    }
    text_ += readings.markdown() +
             "\nOther assumptions, one change each, at the same number of frames (a tenth for "
             "33,333 acquisitions):\n\n" +
             table.markdown() + "\n";
    Table near_target(header);
    for (const char* estimator : {"ezpointer", "hispointer", "sifh", "fifh"}) {
      std::vector<std::string> row = {
          fmt::format("{} at 0.2 m, 14 klux, %", readout_title(parse_readout(estimator)))};
      for (const ThesisStudies& study : studies) {
        row.push_back(
            format_estimate(study.at_klux.at(14.0).at(estimator, 0.2).relative_precision, 100.0, 1));
      }
      near_target.add(row);
    }
    text_ += "Relative precision at the nearest distance under the same assumptions:\n\n" +
             near_target.markdown() + "\n";
    write_step();
    write_rate_map();
    write_tolerance();
  }

  // Where the pointers' spread at 0.2 m comes from: the step, or the photons.
  void write_step() {
    StudySettings settings = base_;
    settings.matched_filter = false;
    settings.lookup_table = false;
    settings.distances_m = {0.2, 0.21, 0.22, 0.25, 0.3};
    Table table({"ezPointer, 14 klux, relative precision %", "0.2 m", "0.21 m", "0.22 m", "0.25 m", "0.3 m"});
    const auto add = [&](const std::string& name, int step, int fraction_bits) {
      ReadoutParameters pointer = ReadoutParameters::defaults(Readout::kEzPointer);
      pointer.pointer_step = step;
      pointer.fraction_bits = fraction_bits;
      settings.readouts = {pointer};
      std::vector<std::string> row = {name};
      for (const AccuracyPoint& point : run_accuracy_study(settings).points) {
        row.push_back(format_estimate(point.relative_precision, 100.0, 1));
      }
      table.add(row);
    };
    text_ += fmt::format(
        "A pointer at rest still steps by a bin a photon. The step as the cause of the spread at 0.2 m "
        "(limit {:g} %); "
        "that one slot or a dead time lowers it too shows the second photon of a pulse at work, which comes "
        "later than "
        "the first and widens what the pointer sees:\n\n",
        customer_limit(0.2) * 100.0);
    add("step of 1 bin (thesis)", 1, 0);
    add("step of 2 bins", 2, 0);
    add("step from 1 to 1/16 bin (FRACTION_BITS 4)", 1, 4);
    text_ += table.markdown() + "\n";
  }

  // Number of statements that agree over signal and background.
  void write_rate_map() {
    std::vector<std::string> header = {"signal at 1 m \\ background at 14 klux"};
    const std::vector<double> backgrounds = {0.10, 0.15, 0.20};
    for (const double background : backgrounds) {
      header.push_back(fmt::format("{:g}", background));
    }
    Table table(header);
    for (const double signal : {0.20, 0.30, 0.40}) {
      std::vector<std::string> row = {fmt::format("{:g}", signal)};
      for (const double background : backgrounds) {
        StudySettings settings = base_;
        settings.frames = std::max(options_.frames / 2, 4);
        settings.sensor.signal_events_1m = signal;
        settings.sensor.background_events_per_klux = background / 14.0;
        const ThesisStudies studies = thesis_studies(settings, thesis_readouts(), false);
        std::array<int, 3> counts{};
        for (const ThesisStatement& statement : precision_statements()) {
          ++counts[static_cast<std::size_t>(statement.judge(studies).verdict)];
        }
        row.push_back(fmt::format("{} / {} / {}", counts[0], counts[1], counts[2]));
      }
      table.add(row);
    }
    text_ +=
        "Both rates together, statements that agree / disagree / stay open:\n\n" + table.markdown() + "\n";
  }

  // Up to which background each read-out holds 3 % at 3 m.
  void write_tolerance() {
    StudySettings settings = base_;
    settings.distances_m = {2.5, 3.0, 3.5};
    settings.readouts = defaults_of(thesis_readouts());
    settings.matched_filter = false;
    settings.lookup_table = false;
    std::vector<PlotSeries> series;
    std::vector<std::vector<std::string>> first_above;
    for (const Readout readout : thesis_readouts()) {
      series.push_back({std::string(readout_title(readout)), {}, {}});
      first_above.push_back({std::string(readout_title(readout)), "above 50", "above 50", "above 50"});
    }
    settings.frames = 5 * options_.frames;  // outliers are rare, and they decide
    for (double klux = 50.0; klux >= 2.0; klux -= 4.0) {
      settings.klux = klux;
      const AccuracyStudy study = run_accuracy_study(settings);
      for (std::size_t i = 0; i < study.points.size(); ++i) {
        const std::size_t readout = i / settings.distances_m.size();
        const std::size_t distance = i % settings.distances_m.size();
        const double precision = study.points[i].relative_precision.value;
        if (precision > 0.03) {
          first_above[readout][distance + 1] = fmt::format("{:g}", klux);
        }
        if (distance == 1) {
          series[readout].x.push_back(klux);
          series[readout].y.push_back(precision * 100.0);
        }
      }
    }
    text_ += fmt::format(
        "How much light each read-out stands ({} frames a point). Near its limit a read-out is precise but "
        "for a few "
        "frames that miss the target: one miss by half the distance in 1,000 frames already makes {:.1f} % "
        "of relative "
        "precision. So the klux at which a read-out \"stops working\" depends on the distance judged and on "
        "the luck "
        "of a 1,000-frame run.\n\n",
        settings.frames, 100.0 * 0.5 / std::sqrt(1000.0));
    text_ += picture("tolerance_3m.svg", series,
                     {.title = "Relative precision at 3 m over background light",
                      .x_label = "klux",
                      .y_label = "relative precision, %",
                      .logarithmic_y = true,
                      .y_limits = {3.0}});
    Table table(
        {"lowest klux (steps of 4) with relative precision above 3 %", "at 2.5 m", "at 3 m", "at 3.5 m"});
    for (const std::vector<std::string>& row : first_above) {
      table.add(row);
    }
    text_ += table.markdown() + "\n";
  }

  void write_convergence() {
    StudySettings settings = base_;
    settings.distances_m.clear();
    for (int i = 1; i <= 24; ++i) {
      settings.distances_m.push_back(0.25 * i);
    }
    settings.readouts = defaults_of(std::array{Readout::kEzPointer, Readout::kHisPointer});
    settings.klux = 14.0;
    const AccuracyStudy study = run_accuracy_study(settings);
    text_ +=
        "## What relative precision hides\n\n"
        "Eq. 3.14 is a spread. A pointer that starts at mid-range and runs out of photons on its way has a "
        "small "
        "spread and a large error, which no look-up table mends once the slope is gone.\n\n";
    text_ +=
        picture("convergence.svg",
                accuracy_series(study.points, [](const auto& p) { return p.distance_m + p.bias_m.value; }),
                {.title = "Mean measured distance before the look-up table, 14 klux",
                 .x_label = "distance, m",
                 .y_label = "mean measured distance, m"});
    text_ += picture("slope.svg", accuracy_series(study.points, [](const auto& p) { return p.slope->value; }),
                     {.title = "Slope of measured over true distance, 14 klux",
                      .x_label = "distance, m",
                      .y_label = "slope",
                      .y_limits = {1.0}});
    std::vector<PlotSeries> hidden;
    for (const PlotSeries& series :
         accuracy_series(study.points, [](const auto& p) { return p.relative_precision.value * 100.0; })) {
      hidden.push_back({series.label + ": relative precision", series.x, series.y});
    }
    for (const PlotSeries& series :
         accuracy_series(study.points, [](const auto& p) { return p.rmse_m.value / p.distance_m * 100.0; })) {
      hidden.push_back({series.label + ": rmse", series.x, series.y});
    }
    text_ += picture("hidden.svg", hidden,
                     {.title = "Relative precision against rmse after the look-up table, 14 klux",
                      .x_label = "distance, m",
                      .y_label = "%",
                      .logarithmic_y = true,
                      .y_limits = {3.0}});
    write_hidden_table(study);
    settings.klux = 50.0;
    write_hidden_table(run_accuracy_study(settings));
    write_pulses();
  }

  void write_hidden_table(const AccuracyStudy& study) {
    Table table(
        {"distance m", "relative precision %", "bias mm", "slope", "rmse after table, %", "above 10 %, %"});
    for (const AccuracyPoint& point : study.points) {
      if (point.estimator == "ezpointer") {
        table.add({fmt::format("{:g}", point.distance_m), precision_cell(point), bias_cell(point),
                   slope_cell(point), rmse_cell(point),
                   fmt::format("{:.1f}", point.outlier_rate.value * 100.0)});
      }
    }
    text_ += fmt::format("ezPointer at {:g} klux:\n\n{}\n", study.points.front().klux, table.markdown());
  }

  // The cause: with more pulses, the same pointer arrives.
  void write_pulses() {
    StudySettings settings = base_;
    settings.frames = std::max(options_.frames / 10, 4);
    settings.readouts = defaults_of(std::array{Readout::kEzPointer});
    settings.matched_filter = false;
    settings.lookup_table = false;
    settings.distances_m = {3.0, 4.0, 5.0};
    std::vector<PlotSeries> series;
    for (const double distance : settings.distances_m) {
      series.push_back({fmt::format("{:g} m", distance), {}, {}});
    }
    for (const std::uint32_t acquisitions :
         {333U, 1000U, 2000U, 3333U, 5000U, 8000U, 13'000U, 20'000U, 33'333U}) {
      settings.sensor.acquisitions = acquisitions;
      const AccuracyStudy study = run_accuracy_study(settings);
      for (std::size_t i = 0; i < series.size(); ++i) {
        series[i].x.push_back(acquisitions);
        series[i].y.push_back(study.points[i].bias_m.value);
      }
    }
    text_ += "That lack of photons is the cause shows in frames of more pulses: the bias goes.\n\n";
    text_ += picture("pulses.svg", series,
                     {.title = "ezPointer's bias over the frame's pulses, 14 klux",
                      .x_label = "acquisitions a frame",
                      .y_label = "bias, m",
                      .logarithmic_x = true});
  }

  void write_array_size() {
    std::vector<double> sensors;
    constexpr int kStepsPerDecade = 8;
    for (int i = 0; i <= 3 * kStepsPerDecade / 2; ++i) {
      sensors.push_back(
          std::round(kThesisSensors / std::pow(10.0, static_cast<double>(i) / kStepsPerDecade)));
    }
    StudySettings settings = base_;
    settings.klux = 50.0;
    settings.readouts = defaults_of(kAllReadouts);
    settings.calibration_step_m = 0.1;
    const std::vector<ArrayMargin> margins = array_margins(settings, sensors);
    Table table({"read-out", "largest array by relative precision", "largest array by rmse after the table"});
    std::vector<PlotSeries> series;
    const auto text = [](const LargestArray& array) {
      if (array.sensors == 0.0) {
        return std::string("none tried");
      }
      return array.too_many == 0.0 ? fmt::format("at least {:g}", array.sensors)
                                   : fmt::format("{:g} (not {:g})", array.sensors, array.too_many);
    };
    for (std::size_t first = 0; first < margins.size(); first += sensors.size()) {
      const std::span<const ArrayMargin> one = std::span(margins).subspan(first, sensors.size());
      table.add({one.front().title, text(largest_array(one, &ArrayMargin::by_precision)),
                 text(largest_array(one, &ArrayMargin::by_rmse))});
      PlotSeries& line = series.emplace_back(PlotSeries{one.front().title, {}, {}});
      for (const ArrayMargin& margin : one) {
        line.x.push_back(margin.sensors);
        line.y.push_back(margin.by_rmse);
      }
    }
    text_ += fmt::format(
        "## Future work: the largest array at 50 klux\n\n"
        "Fewer sensors share the laser, so each gets 32,000 / sensors times the signal; the background "
        "stays. Limits: "
        "10 % below 1 m, 3 % from 1 to 3 m, at 0.2, 0.3, 0.5, 0.8, 1, 1.5, 2, 2.5 and 3 m. {} array sizes "
        "from {:g} "
        "to {:g} sensors.\n\n{}\n",
        sensors.size(), sensors.back(), sensors.front(), table.markdown());
    text_ += picture("array_size.svg", series,
                     {.title = "Worst rmse / limit from 0.2 to 3 m, 50 klux",
                      .x_label = "sensors that share the laser",
                      .y_label = "rmse after the look-up table / limit",
                      .logarithmic_y = true,
                      .y_limits = {1.0},
                      .logarithmic_x = true});
    text_ += "## Future work: read-outs on small arrays at 50 klux\n\n";
    settings.distances_m = thesis_distances();
    for (const double count : {3200.0, 8000.0, 16'000.0}) {
      settings.sensor = with_sensors(base_.sensor, count);
      const AccuracyStudy study = run_accuracy_study(settings);
      text_ += fmt::format(
          "{:g} sensors, relative precision, %:\n\n{}\n{:g} sensors, rmse after the look-up table, % of "
          "distance:\n\n{}\n",
          count, accuracy_matrix(study.points, precision_cell).markdown(), count,
          accuracy_matrix(study.points, rmse_cell).markdown());
    }
  }

  [[nodiscard]] std::string front_page() const {
    return fmt::format(
        "# Reproduction of the thesis\n\n"
        "Accuracy statements of the thesis against this project's models: preset thesis ({:g} / R^2 signal "
        "events a "
        "pulse, {:g} background events at 14 klux, {} acquisitions), {} frames a point, seed {}. Relative "
        "precision is "
        "the thesis's own measure (Eq. 3.14); \"agrees\" is computed: yes and no mean that the 95 % "
        "intervals lie "
        "wholly on the right or the wrong side of the limit, open that an interval holds it (then ten times "
        "the frames are judged). Where a handful of outliers makes the spread, the intervals are wide and "
        "rest on that handful.\n\n"
        "**{} statements agree, {} do not, {} stay open.**\n\n{}\n",
        base_.sensor.signal_events_1m, base_.sensor.background_events_per_klux * 14.0,
        base_.sensor.acquisitions, options_.frames, options_.seed, verdicts_[0], verdicts_[1], verdicts_[2],
        statements_.markdown());
  }

  const ReproduceOptions& options_;
  std::filesystem::path folder_;
  StudySettings base_;
  ThesisStudies studies_;
  ThesisStudies more_frames_;  // run when first needed
  HistogramPeaks peaks_frame_;
  HistogramPeaks peaks_half_;
  HistogramPeaks peaks_fake_;
  PileUp pile_up_near_;
  PileUp pile_up_far_;
  std::string methods_;
  Table statements_{{"thesis", "it says", "agrees", "here"}, 4};
  Table csv_{{"thesis", "it_says", "agrees", "here"}};
  std::array<int, 3> verdicts_{};
  std::string text_;
};

}  // namespace

void add_reproduce_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<ReproduceOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "reproduce", "The thesis's accuracy statements, measured: reproduction.md with tables and plots");
  command->add_option("-n,--frames", options->frames, "frames a point")
      ->check(CLI::Range(40, 1'000'000))
      ->capture_default_str();
  command->add_option("-s,--seed", options->seed, "seed of everything random")->capture_default_str();
  command->add_option("-j,--threads", options->threads, "threads, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("-o,--out", options->out, "output folder")->capture_default_str();
  command->callback([options] { Report(*options).run(); });
}

}  // namespace dtof
