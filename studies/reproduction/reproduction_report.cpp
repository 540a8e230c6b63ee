// SPDX-License-Identifier: Apache-2.0
#include "reproduction/reproduction_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "accuracy/accuracy_tables.hpp"
#include "dtof/report/table.hpp"
#include "reproduction/reproduction_part.hpp"

namespace dtof {
namespace {

class Rendering : public ReproductionPart {
 public:
  using ReproductionPart::ReproductionPart;

  void run() {
    statements();
    curves();
    histograms();
    filters();
    methods();
    readings();
  }

 private:
  void statements() {
    Table table({"thesis", "it says", "judged by", "agrees", "here"}, 5);
    Table csv({"thesis", "it_says", "judged_by", "agrees", "here"});
    std::array<int, 3> verdicts{};
    for (const JudgedStatement& statement : judged_statements(r_)) {
      const std::string agrees = verdict_word(statement.judgement.verdict);
      table.add({statement.place, statement.text, statement.rule, agrees, statement.judgement.here});
      csv.add({statement.place, statement.text, statement.rule, agrees, statement.judgement.here});
      ++verdicts[static_cast<std::size_t>(statement.judgement.verdict)];
    }
    report_.statements_csv = csv.csv();
    page()
        .set("signal_at_1_m", "{:g}", r_.sensor.signal_events_1m)
        .set("background_at_14_klux", "{:g}", r_.sensor.background_events_per_klux * 14.0)
        .set("acquisitions", "{}", r_.sensor.acquisitions)
        .set("frames", "{}", r_.settings.frames)
        .set("seed", "{}", r_.settings.seed)
        .set("more_frames", "{}", 10 * r_.settings.frames)
        .set("rare_outliers_percent", "{:g}", kRareOutliers * 100.0)
        .set("agree", "{}", verdicts[0])
        .set("disagree", "{}", verdicts[1])
        .set("open", "{}", verdicts[2])
        .set("statements", table);
  }

  void curves() {
    std::vector<AccuracyPoint> all;
    std::vector<PageData> lights;
    for (const auto& [klux, study] : r_.studies.at_klux) {
      all.insert(all.end(), study.points.begin(), study.points.end());
      const PlotLayout layout{.title = "Relative precision in %: " + flat(klux),
                              .x_label = "distance, m",
                              .y_label = "relative precision, %",
                              .logarithmic_y = true,
                              .y_limits = {3.0}};
      report_.pictures.push_back(
          {fmt::format("relative_precision_{:g}klux.svg", klux),
           accuracy_series(study.points, [](const auto& p) { return p.relative_precision.value * 100.0; }),
           layout});
      lights.push_back(PageData()
                           .set("title", "{}", layout.title)
                           .set("klux", "{:g}", klux)
                           .set("precision", accuracy_matrix(study.points, precision_cell)));
    }
    page().list("relative_precision", std::move(lights));
    report_.accuracy_csv = accuracy_csv(all).csv();
    const AccuracyStudy& study = r_.studies.at_klux.at(14.0);
    picture("mean_distance_title", "mean_distance_14klux.svg",
            accuracy_series(study.points, [](const auto& p) { return p.distance_m + p.bias_m.value; }),
            {.title = "Mean measured distance in m before the look-up table: " + flat(14.0),
             .x_label = "distance, m",
             .y_label = "mean measured distance, m"});
    page().set("bias_mm", accuracy_matrix(study.points, bias_cell));
  }

  /// `figure`: name of the picture's file.
  void one_histogram(const std::string& figure, const std::string& title, std::vector<PlotSeries> series) {
    picture(figure + "_title", figure + ".svg", std::move(series),
            {.title = title, .x_label = "bin (1 = code 0)", .y_label = "counts", .markers = false});
  }

  void histograms() {
    one_histogram(
        "figure_3_5", "Counts of one frame: " + flat(14.0, 1.0),
        {bins_of("whole frame", r_.whole_frame.one_frame), bins_of("first half", r_.half_frame.one_frame)});
    Table table({"histogram of", "counts in the highest bin, 95 %", "its number, 95 %"});
    const auto add = [&](const std::string& what, const HistogramPeaks& peaks) {
      table.add({what, fmt::format("{:g} to {:g}", peaks.count.low, peaks.count.high),
                 fmt::format("{:g} to {:g}", peaks.bin.low, peaks.bin.high)});
    };
    add("3,333 acquisitions (100 kHz, 30 frames/s)", r_.whole_frame);
    add("half of them: one measurement", r_.half_frame);
    add("33,333 acquisitions (as written in the thesis)", r_.long_frame);
    page().set("peaks_of_frames", table);
    one_histogram("figure_3_6",
                  "Counts of one frame, turned so that its peak is in the middle: " + flat(14.0, 1.0),
                  {bins_of("turned", r_.sides.one_frame)});
    one_histogram("figure_3_9", "Counts of SiFH's fine histogram of one frame: " + flat(14.0, 1.0),
                  {bins_of("second measurement", r_.fine.one_frame, r_.fine.first_bin)});
    one_histogram(
        "figure_3_13",
        fmt::format("Counts of one measurement (half a frame): flat target at 3 m, 14 and 50 klux, sensor {}",
                    r_.sensor.name),
        {bins_of("50 klux (a)", r_.sunny.one_frame), bins_of("14 klux (b)", r_.indoors.one_frame)});
    one_histogram("figure_3_15", "Counts of one measurement (half a frame): " + flat(14.0, 5.0),
                  {bins_of("5 m", r_.far.one_frame)});
    Table peaks({"half frames", "highest bin, 95 %", "its counts, 95 %", "off by more than 10 %, %"});
    const auto add_peaks = [&](const std::string& what, const HistogramPeaks& p) {
      peaks.add({what, fmt::format("{:g} to {:g}", p.bin.low, p.bin.high),
                 fmt::format("{:g} to {:g}", p.count.low, p.count.high),
                 format_estimate(p.fake_share, 100.0, 1)});
    };
    add_peaks("50 klux, 3 m", r_.sunny);
    add_peaks("14 klux, 3 m", r_.indoors);
    add_peaks("14 klux, 5 m", r_.far);
    page().set("peaks_of_half_frames", peaks);
    pile_up();
  }

  void pile_up() {
    for (const auto& [name, distance, figure] : {std::tuple{"near_pile_up_title", 0.2, &r_.pile_up_near},
                                                 std::tuple{"far_pile_up_title", 0.5, &r_.pile_up_far}}) {
      picture(name, fmt::format("figure_2_4_{:g}m.svg", distance),
              {bins_of("arriving", figure->arriving, 1.0, 256),
               bins_of("delivered by the TDC", figure->delivered, 1.0, 256)},
              {.title = "Events per frame and bin: " + flat(14.0, distance),
               .x_label = "bin (1 = code 0)",
               .y_label = "events",
               .markers = false});
    }
  }

  void filters() {
    std::vector<PlotSeries> series;
    for (const FilteredCounts& filter : r_.filters) {
      series.push_back(bins_of(guard_title(filter.guard), filter.remaining, 1.0, 400));
    }
    picture("figure_3_11_title", "figure_3_11.svg", series,
            {.title = "Counts per frame that the filter leaves of the second measurement: " + flat(14.0, 1.0),
             .x_label = "bin (1 = code 0)",
             .y_label = "counts per frame and bin",
             .markers = false});
    std::vector<std::string> header = {"rmse after the look-up table, % of distance"};
    for (const AccuracyPoint& point : r_.guards.front().measured.points) {
      header.push_back(fmt::format("{:g} m", point.distance_m));
    }
    Table table(header);
    std::vector<std::string> better;
    for (const auto& [name, study] : r_.guards) {
      std::vector<std::string> row = {name};
      for (const AccuracyPoint& point : study.points) {
        row.push_back(format_estimate(rmse_against(point, 0.0).value, 100.0, 2));
      }
      table.add(row);
    }
    const AccuracyStudy& narrow = r_.guards.front().measured;
    const AccuracyStudy& wide = r_.guards.back().measured;
    for (const AccuracyPoint& point : narrow.points) {
      if (point.rmse_m.interval.low > wide.at(point.estimator, point.distance_m).rmse_m.interval.high) {
        better.push_back(fmt::format("{:g} m", point.distance_m));
      }
    }
    page()
        .set("rmse_of_filters", table)
        .set("narrow_filter", "{}", r_.guards.front().name)
        .set("wide_filter", "{}", r_.guards.back().name)
        .set("narrow_filter_is_worse_at", "{}", names_or_none(better));
  }

  void methods() {
    std::vector<std::string> header = {"method"};
    for (const AccuracyPoint& point : r_.methods.front().measured.points) {
      header.push_back(point.title);
    }
    Table table(header);
    std::vector<PageData> effects;
    const AccuracyStudy& none = r_.methods.front().measured;
    for (const auto& [name, study] : r_.methods) {
      std::vector<std::string> row = {name};
      std::vector<std::string> gain;
      std::vector<std::string> lose;
      for (const AccuracyPoint& point : study.points) {
        row.push_back(fmt::format("{} / {} / {:.1f}", precision_cell(point), rmse_cell(point),
                                  point.outlier_rate.value * 100.0));
        const Interval& with = point.rmse_m.covering();
        const Interval& without = none.at(point.estimator, point.distance_m).rmse_m.covering();
        if (with.high < without.low) {
          gain.push_back(point.title);
        } else if (with.low > without.high) {
          lose.push_back(point.title);
        }
      }
      table.add(row);
      if (&study != &none) {
        effects.push_back(PageData()
                              .set("method", "{}", name)
                              .set("rmse_falls_for", "{}", names_or_none(gain))
                              .set("rmse_rises_for", "{}", names_or_none(lose)));
      }
    }
    page()
        .set("method_frames", "{}", r_.method_frames)
        .set("methods", table)
        .list("effects_of_methods", std::move(effects))
        .set("background_events", "{:.2f}", r_.sensor.background_events(50.0, 1.0))
        .set("binned_background_events", "{:.2f}", 4.0 * r_.sensor.background_events(50.0, 1.0))
        .set("slots", "{}", r_.sensor.slots);
  }

  void readings() {
    Table table({"thesis", "read as", "judged by", "agrees", "here"}, 5);
    std::array<int, 3> verdicts{};
    for (const ThesisStatement& reading : alternative_readings()) {
      const Judgement judgement = judge(r_, reading);
      table.add({reading.place, reading.text, reading.rule, verdict_word(judgement.verdict), judgement.here});
      ++verdicts[static_cast<std::size_t>(judgement.verdict)];
    }
    page()
        .set("readings_that_agree", "{}", verdicts[0])
        .set("readings_that_disagree", "{}", verdicts[1])
        .set("open_readings", "{}", verdicts[2])
        .set("readings", table);
  }
};

}  // namespace

ReproductionReport render_reproduction(const Reproduction& reproduction, const std::string& command_line) {
  ReproductionReport report;
  Rendering(reproduction, report).run();
  add_variations(reproduction, report);
  report.page.set("command", "{}", command_line);
  return report;
}

std::string front_page(const ReproductionReport& report) {
  const std::string page = page_text("reproduction", report.page);
  return page.substr(0, page.find("\n## ") + 1);
}

}  // namespace dtof
