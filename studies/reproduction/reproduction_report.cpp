// SPDX-License-Identifier: Apache-2.0
#include "reproduction/reproduction_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "accuracy/accuracy_tables.hpp"
#include "dtof/report/table.hpp"
#include "reproduction/reproduction_part.hpp"

namespace dtof {
namespace {

class Rendering : public ReproductionPart {
 public:
  using ReproductionPart::ReproductionPart;

  ReproductionReport run() {
    front_page();
    curves();
    histograms();
    filters();
    methods();
    readings();
    ReproductionReport variations = render_variations(r_);
    report_.sections = std::move(text_) + variations.sections;
    std::ranges::move(variations.pictures, std::back_inserter(report_.pictures));
    return std::move(report_);
  }

 private:
  void front_page() {
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
    report_.front_page = fmt::format(
        "# Reproduction of the thesis\n\n"
        "Accuracy statements of the thesis against this project's models: preset thesis ({:g} / R^2 signal "
        "events "
        "per pulse, {:g} background events at 14 klux, {} acquisitions), {} frames per point, seed {}, "
        "look-up "
        "tables of calibration run 1. Relative precision is the thesis's own measure (Eq. 3.14).\n\n"
        "\"Agrees\" is computed by the rule beside it: yes and no mean that the 95 % intervals of all "
        "figures "
        "concerned lie wholly on the right side, or one wholly on the wrong side, of the limit; open that an "
        "interval holds it (then {} frames are judged where they were run). Intervals allow for outliers "
        "that "
        "were not seen, up to the sensor's range, where one to nine were seen; where none was, in so many "
        "frames "
        "that they are rarer than {:g} %, verdicts are about results without them "
        "([docs/reference/accuracy.md](../docs/reference/accuracy.md)). An asterisk marks figures with "
        "fewer than ten "
        "outliers.\n\n"
        "**{} statements agree, {} do not, {} stay open.**\n\n{}\n",
        r_.sensor.signal_events_1m, r_.sensor.background_events_per_klux * 14.0, r_.sensor.acquisitions,
        r_.settings.frames, r_.settings.seed, 10 * r_.settings.frames, kRareOutliers * 100.0, verdicts[0],
        verdicts[1], verdicts[2], table.markdown());
  }

  void curves() {
    text_ += "## Relative precision (Fig. 3.12, 3.14, 3.17)\n\n";
    std::vector<AccuracyPoint> all;
    for (const auto& [klux, study] : r_.studies.at_klux) {
      all.insert(all.end(), study.points.begin(), study.points.end());
      picture(fmt::format("relative_precision_{:g}klux.svg", klux),
              accuracy_series(study.points, [](const auto& p) { return p.relative_precision.value * 100.0; }),
              {.title = "Relative precision in %: " + flat(klux),
               .x_label = "distance, m",
               .y_label = "relative precision, %",
               .logarithmic_y = true,
               .y_limits = {3.0}});
      text_ += accuracy_matrix(study.points, precision_cell).markdown() + "\n";
    }
    text_ += "Every figure with its interval: [accuracy.csv](reproduction/accuracy.csv).\n\n";
    report_.accuracy_csv = accuracy_csv(all).csv();
    const AccuracyStudy& study = r_.studies.at_klux.at(14.0);
    text_ += "## Linearity (Fig. 3.16)\n\n";
    picture("mean_distance_14klux.svg",
            accuracy_series(study.points, [](const auto& p) { return p.distance_m + p.bias_m.value; }),
            {.title = "Mean measured distance in m before the look-up table: " + flat(14.0),
             .x_label = "distance, m",
             .y_label = "mean measured distance, m"});
    text_ +=
        "Bias before the look-up table, mm:\n\n" + accuracy_matrix(study.points, bias_cell).markdown() + "\n";
  }

  void one_histogram(const std::string& heading, const std::string& name, const std::string& title,
                     std::vector<PlotSeries> series) {
    text_ += fmt::format("## {}\n\n", heading);
    picture(name, std::move(series),
            {.title = title, .x_label = "bin (1 = code 0)", .y_label = "counts", .markers = false});
  }

  void histograms() {
    one_histogram(
        "Fig. 3.5: which histogram has 17 counts", "figure_3_5.svg",
        "Counts of one frame: " + flat(14.0, 1.0),
        {bins_of("whole frame", r_.whole_frame.one_frame), bins_of("first half", r_.half_frame.one_frame)});
    Table table({"histogram of", "counts in the highest bin, 95 %", "its number, 95 %"});
    const auto add = [&](const std::string& what, const HistogramPeaks& peaks) {
      table.add({what, fmt::format("{:g} to {:g}", peaks.count.low, peaks.count.high),
                 fmt::format("{:g} to {:g}", peaks.bin.low, peaks.bin.high)});
    };
    add("3,333 acquisitions (100 kHz, 30 frames/s)", r_.whole_frame);
    add("half of them: one measurement", r_.half_frame);
    add("33,333 acquisitions (as written in the thesis)", r_.long_frame);
    text_ += table.markdown() + "\n";
    one_histogram("Fig. 3.6: the histogram turned around its peak", "figure_3_6.svg",
                  "Counts of one frame, turned so that its peak is in the middle: " + flat(14.0, 1.0),
                  {bins_of("turned", r_.sides.one_frame)});
    one_histogram("Fig. 3.9: SiFH's fine histogram", "figure_3_9.svg",
                  "Counts of SiFH's fine histogram of one frame: " + flat(14.0, 1.0),
                  {bins_of("second measurement", r_.fine.one_frame, r_.fine.first_bin)});
    one_histogram(
        "Fig. 3.13: 50 and 14 klux at 3 m", "figure_3_13.svg",
        fmt::format("Counts of one measurement (half a frame): flat target at 3 m, 14 and 50 klux, sensor {}",
                    r_.sensor.name),
        {bins_of("50 klux (a)", r_.sunny.one_frame), bins_of("14 klux (b)", r_.indoors.one_frame)});
    one_histogram("Fig. 3.15: 14 klux at 5 m", "figure_3_15.svg",
                  "Counts of one measurement (half a frame): " + flat(14.0, 5.0),
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
    text_ += peaks.markdown() + "\n## Fig. 2.4: pile-up\n\n";
    for (const auto& [distance, figure] :
         {std::pair{0.2, &r_.pile_up_near}, std::pair{0.5, &r_.pile_up_far}}) {
      picture(fmt::format("figure_2_4_{:g}m.svg", distance),
              {bins_of("arriving", figure->arriving, 1.0, 256),
               bins_of("delivered by the TDC", figure->delivered, 1.0, 256)},
              {.title = "Events per frame and bin: " + flat(14.0, distance),
               .x_label = "bin (1 = code 0)",
               .y_label = "events",
               .markers = false});
    }
  }

  void filters() {
    text_ += "## Fig. 3.11: how wide hisPointer's filter must be\n\n";
    std::vector<PlotSeries> series;
    for (const FilteredCounts& filter : r_.filters) {
      series.push_back(bins_of(guard_title(filter.guard), filter.remaining, 1.0, 400));
    }
    picture("figure_3_11.svg", series,
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
    text_ += table.markdown() +
             fmt::format("\nThe rmse with {} is above that with {} (intervals apart) at: {}.\n\n",
                         r_.guards.front().name, r_.guards.back().name, names_or_none(better));
  }

  void methods() {
    std::vector<std::string> header = {"method"};
    for (const AccuracyPoint& point : r_.methods.front().measured.points) {
      header.push_back(point.title);
    }
    Table table(header);
    std::string sentences;
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
        sentences += fmt::format("* {}: rmse falls for {}; rises for {}\n", name, names_or_none(gain),
                                 names_or_none(lose));
      }
    }
    text_ += fmt::format(
        "## Binning, time gating, coincidence at 50 klux and 3 m\n\n"
        "Relative precision / rmse without table / share of errors above 10 %, all in %; {} frames:\n\n{}\n"
        "Against none, intervals apart:\n\n{}\n"
        "A pixel has {:.2f} background events per acquisition, four binned ones have {:.2f}; the TDC has {} "
        "slots.\n\n",
        r_.method_frames, table.markdown(), sentences, r_.sensor.background_events(50.0, 1.0),
        4.0 * r_.sensor.background_events(50.0, 1.0), r_.sensor.slots);
  }

  void readings() {
    Table table({"thesis", "read as", "judged by", "agrees", "here"}, 5);
    std::array<int, 3> verdicts{};
    for (const ThesisStatement& reading : alternative_readings()) {
      const Judgement judgement = judge(r_, reading);
      table.add({reading.place, reading.text, reading.rule, verdict_word(judgement.verdict), judgement.here});
      ++verdicts[static_cast<std::size_t>(judgement.verdict)];
    }
    text_ += fmt::format(
        "## Other readings\n\nNarrower or wider ranges, plots with fewer points, judged by the same sweeps: "
        "{} "
        "agree, {} do not, {} stay open.\n\n{}\n",
        verdicts[0], verdicts[1], verdicts[2], table.markdown());
  }
};

}  // namespace

ReproductionReport render_reproduction(const Reproduction& reproduction) {
  return Rendering(reproduction).run();
}

}  // namespace dtof
