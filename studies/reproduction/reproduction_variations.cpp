// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "dtof/report/table.hpp"
#include "reproduction/reproduction_part.hpp"

namespace dtof {
namespace {

class Variations : public ReproductionPart {
 public:
  using ReproductionPart::ReproductionPart;

  void run() {
    assumptions();
    steps();
    rates();
    lights();
    hidden();
    pulses();
    arrays();
  }

 private:
  static std::array<int, 3> count_verdicts(const ThesisStudies& studies) {
    std::array<int, 3> counts{};
    for (const ThesisStatement& statement : precision_statements()) {
      ++counts[static_cast<std::size_t>(statement.judge(studies).verdict)];
    }
    return counts;
  }

  void assumptions() {
    std::vector<std::string> header = {"statement"};
    for (const auto& assumption : r_.assumptions) {
      header.push_back(assumption.name);
    }
    Table table(header);
    for (const ThesisStatement& statement : precision_statements()) {
      std::vector<std::string> row = {statement.text};
      for (const auto& assumption : r_.assumptions) {
        row.push_back(verdict_word(statement.judge(assumption.measured).verdict));
      }
      table.add(row);
    }
    Table near_target(header);
    for (const char* estimator : {"ezpointer", "hispointer", "sifh", "fifh"}) {
      std::vector<std::string> row = {
          fmt::format("{} at 0.2 m, 14 klux, %", readout_title(parse_readout(estimator)))};
      for (const auto& assumption : r_.assumptions) {
        row.push_back(format_estimate(
            precision_against(assumption.measured.at_klux.at(14.0).at(estimator, 0.2), 0.0).value, 100.0, 1));
      }
      near_target.add(row);
    }
    std::vector<std::string> lower;
    std::vector<std::string> higher;
    const auto nearest = [](const ThesisStudies& studies) {
      return studies.at_klux.at(14.0).at("ezpointer", 0.2).relative_precision.interval;
    };
    for (const auto& assumption : std::span(r_.assumptions).subspan(1)) {
      if (nearest(assumption.measured).high < nearest(r_.assumptions.front().measured).low) {
        lower.push_back(assumption.name);
      } else if (nearest(assumption.measured).low > nearest(r_.assumptions.front().measured).high) {
        higher.push_back(assumption.name);
      }
    }
    page()
        .set("verdicts_of_assumptions", table)
        .set("precision_near_the_target", near_target)
        .set("preset", "{}", r_.assumptions.front().name)
        .set("lower_with", "{}", names_or_none(lower))
        .set("higher_with", "{}", names_or_none(higher));
    most_agreeing();
  }

  void most_agreeing() {
    int most = -1;
    std::vector<std::string> with;
    for (const auto& assumption : r_.assumptions) {
      const int agree = count_verdicts(assumption.measured)[0];
      if (agree > most) {
        most = agree;
        with.clear();
      }
      if (agree == most) {
        with.push_back(assumption.name);
      }
    }
    page()
        .set("most_that_agree", "{}", most)
        .set("precision_statements", "{}", precision_statements().size())
        .set("most_agree_with", "{}", fmt::join(with, ", "))
        .set("agree_with_the_preset", "{}", count_verdicts(r_.assumptions.front().measured)[0]);
  }

  // Where the pointers' spread at 0.2 m comes from: the step, or the photons.
  void steps() {
    std::vector<std::string> header = {"ezPointer, 14 klux, relative precision %"};
    const std::vector<AccuracyPoint>& thesis = r_.steps.front().measured.points;
    for (const AccuracyPoint& point : thesis) {
      header.push_back(fmt::format("{:g} m", point.distance_m));
    }
    Table table(header);
    std::vector<PageData> others;
    for (const auto& [name, study] : r_.steps) {
      std::vector<std::string> row = {name};
      for (const AccuracyPoint& point : study.points) {
        row.push_back(format_estimate(precision_against(point, 0.0).value, 100.0, 1));
      }
      table.add(row);
      if (&study != &r_.steps.front().measured) {
        others.push_back(PageData()
                             .set("step", "{}", name)
                             .set("times_the_spread", "{:.2f}",
                                  study.points.front().relative_precision.value /
                                      thesis.front().relative_precision.value));
      }
    }
    page()
        .set("nearest_m", "{:g}", thesis.front().distance_m)
        .set("limit_percent", "{:g}", customer_limit(thesis.front().distance_m) * 100.0)
        .set("precision_of_steps", table)
        .list("other_steps", std::move(others));
  }

  // Number of statements that agree over signal and background.
  void rates() {
    std::vector<std::string> header = {"signal at 1 m \\ background at 14 klux"};
    std::map<double, std::vector<std::string>> rows;
    for (const Reproduction::Rates& rates : r_.rates) {
      const std::string column = fmt::format("{:g}", rates.background);
      if (std::ranges::find(header, column) == header.end()) {
        header.push_back(column);
      }
      const std::array<int, 3> counts = count_verdicts(rates.studies);
      rows[rates.signal].push_back(fmt::format("{} / {} / {}", counts[0], counts[1], counts[2]));
    }
    Table table(header);
    for (const auto& [signal, cells] : rows) {
      std::vector<std::string> row = {fmt::format("{:g}", signal)};
      row.insert(row.end(), cells.begin(), cells.end());
      table.add(row);
    }
    page().set("verdicts_of_rates", table);
  }

  // Up to which background each read-out holds 3 %.
  void lights() {
    constexpr double kLimit = 0.03;
    constexpr double kMiddle = 3.0;
    std::map<std::string, std::map<double, double>> lowest;  // title, distance: klux
    std::vector<PlotSeries> series;
    std::vector<std::string> titles;
    for (const AccuracyStudy& study : r_.lights) {
      for (const AccuracyPoint& point : study.points) {
        if (!lowest.contains(point.title)) {
          titles.push_back(point.title);
          series.push_back({point.title, {}, {}});
        }
        double& klux = lowest[point.title].try_emplace(point.distance_m, 0.0).first->second;
        if (point.relative_precision.value > kLimit) {
          klux = point.klux;
        }
        if (point.distance_m == kMiddle) {
          PlotSeries& line = *std::ranges::find(series, point.title, &PlotSeries::label);
          line.x.push_back(point.klux);
          line.y.push_back(point.relative_precision.value * 100.0);
        }
      }
    }
    picture("tolerance_3m_title", "tolerance_3m.svg", series,
            {.title = "Relative precision in % over background light: flat target at 3 m, sensor " +
                      r_.sensor.name,
             .x_label = "klux",
             .y_label = "relative precision, %",
             .logarithmic_y = true,
             .y_limits = {3.0}});
    std::vector<std::string> header = {"lowest klux (steps of 4) with relative precision above 3 %"};
    for (const auto& [distance, klux] : lowest[titles.front()]) {
      header.push_back(fmt::format("at {:g} m", distance));
    }
    Table table(header);
    for (const std::string& title : titles) {
      std::vector<std::string> row = {title};
      for (const auto& [distance, klux] : lowest[title]) {
        row.push_back(klux == 0.0 ? fmt::format("above {:g}", r_.lights.front().points.front().klux)
                                  : fmt::format("{:g}", klux));
      }
      table.add(row);
    }
    page()
        .set("light_frames", "{}", r_.light_frames)
        .set("lowest_klux", table)
        .set("percent_of_one_miss", "{:.1f}", 100.0 * 0.5 / std::sqrt(r_.light_frames))
        .set("percent_of_one_miss_in_1000", "{:.1f}", 100.0 * 0.5 / std::sqrt(1000.0));
  }

  void hidden() {
    const AccuracyStudy& indoors = r_.convergence.front();
    const std::string light = flat(indoors.points.front().klux);
    picture("convergence_title", "convergence.svg",
            accuracy_series(indoors.points, [](const auto& p) { return p.distance_m + p.bias_m.value; }),
            {.title = "Mean measured distance in m before the look-up table: " + light,
             .x_label = "distance, m",
             .y_label = "mean measured distance, m"});
    picture("slope_title", "slope.svg",
            accuracy_series(indoors.points, [](const auto& p) { return p.slope->value; }),
            {.title = "Slope of measured over true distance: " + light,
             .x_label = "distance, m",
             .y_label = "slope",
             .y_limits = {1.0}});
    std::vector<PlotSeries> both;
    for (const PlotSeries& series :
         accuracy_series(indoors.points, [](const auto& p) { return p.relative_precision.value * 100.0; })) {
      both.push_back({series.label + ": relative precision", series.x, series.y});
    }
    for (const PlotSeries& series : accuracy_series(
             indoors.points, [](const auto& p) { return p.rmse_m.value / p.distance_m * 100.0; })) {
      both.push_back({series.label + ": rmse", series.x, series.y});
    }
    picture("hidden_title", "hidden.svg", both,
            {.title = "Relative precision and rmse after the look-up table in %: " + light,
             .x_label = "distance, m",
             .y_label = "%",
             .logarithmic_y = true,
             .y_limits = {3.0}});
    std::vector<PageData> lights;
    for (const AccuracyStudy& study : r_.convergence) {
      lights.push_back(hidden_errors(study));
    }
    page().list("hidden_errors", std::move(lights));
  }

  static PageData hidden_errors(const AccuracyStudy& study) {
    constexpr double kLimit = 0.03;
    Table table(
        {"distance m", "relative precision %", "bias mm", "slope", "rmse after table, %", "above 10 %, %"});
    std::vector<std::string> hides;
    int judged = 0;
    for (const AccuracyPoint& point : study.points) {
      if (point.estimator != "ezpointer") {
        continue;
      }
      ++judged;
      table.add({fmt::format("{:g}", point.distance_m), precision_cell(point), bias_cell(point),
                 slope_cell(point), rmse_cell(point),
                 fmt::format("{:.1f}", point.outlier_rate.value * 100.0)});
      if (point.relative_precision.value <= kLimit && point.rmse_m.value > kLimit * point.distance_m) {
        hides.push_back(fmt::format("{:g}", point.distance_m));
      }
    }
    PageData data;
    data.set("klux", "{:g}", study.points.front().klux)
        .set("hidden_at", "{}", hides.size())
        .set("distances", "{}", judged)
        .set("hidden_at_m", "{}", names_or_none(hides))
        .set("figures", table);
    return data;
  }

  // With more pulses, does the same pointer arrive?
  void pulses() {
    std::vector<PlotSeries> series;
    for (const AccuracyPoint& point : r_.pulses.front().study.points) {
      series.push_back({fmt::format("{:g} m", point.distance_m), {}, {}});
    }
    for (const Reproduction::Pulses& pulses : r_.pulses) {
      for (std::size_t i = 0; i < series.size(); ++i) {
        series[i].x.push_back(pulses.acquisitions);
        series[i].y.push_back(pulses.study.points[i].bias_m.value);
      }
    }
    const auto usual =
        std::ranges::find(r_.pulses, r_.sensor.acquisitions, &Reproduction::Pulses::acquisitions);
    const Reproduction::Pulses& few = usual == r_.pulses.end() ? r_.pulses.front() : *usual;
    const Reproduction::Pulses& most = r_.pulses.back();
    page()
        .set("farthest_m", "{:g}", r_.pulses.front().study.points.back().distance_m)
        .set("usual_bias_m", "{:.2f}", few.study.points.back().bias_m.value)
        .set("usual_acquisitions", "{}", few.acquisitions)
        .set("bias_with_most_m", "{:.2f}", most.study.points.back().bias_m.value)
        .set("most_acquisitions", "{}", most.acquisitions);
    picture("pulses_title", "pulses.svg", series,
            {.title = "ezPointer's bias in m over the frame's pulses: " + flat(14.0),
             .x_label = "acquisitions per frame",
             .y_label = "bias, m",
             .logarithmic_x = true});
  }

  void arrays() {
    Table table({"read-out", "largest array by relative precision", "largest array by rmse after the table"});
    std::vector<PlotSeries> series;
    const auto text = [](const LargestArray& array) {
      if (array.sensors == 0.0) {
        return std::string("none tried");
      }
      return array.too_many == 0.0 ? fmt::format("at least {:g}", array.sensors)
                                   : fmt::format("{:g} (not {:g})", array.sensors, array.too_many);
    };
    const std::size_t sizes = r_.array_sizes.size();
    for (std::size_t first = 0; first < r_.margins.size(); first += sizes) {
      const std::span<const ArrayMargin> one = std::span(r_.margins).subspan(first, sizes);
      table.add({one.front().title, text(largest_array(one, &ArrayMargin::by_precision)),
                 text(largest_array(one, &ArrayMargin::by_rmse))});
      PlotSeries& line = series.emplace_back(PlotSeries{one.front().title, {}, {}});
      for (const ArrayMargin& margin : one) {
        line.x.push_back(margin.sensors);
        line.y.push_back(margin.by_rmse);
      }
    }
    page()
        .set("array_sizes", "{}", sizes)
        .set("least_sensors", "{:g}", r_.array_sizes.back())
        .set("most_sensors", "{:g}", r_.array_sizes.front())
        .set("largest_arrays", table);
    picture("array_size_title", "array_size.svg", series,
            {.title = "Worst rmse / limit: flat target at 0.2 to 3 m, 50 klux, sensor " + r_.sensor.name,
             .x_label = "sensors that share the laser",
             .y_label = "rmse after the look-up table / limit",
             .logarithmic_y = true,
             .y_limits = {1.0},
             .logarithmic_x = true});
    small_arrays();
  }

  void small_arrays() {
    std::vector<PageData> arrays;
    for (const auto& [name, study] : r_.small_arrays) {
      arrays.push_back(PageData()
                           .set("array", "{}", name)
                           .set("precision", accuracy_matrix(study.points, precision_cell))
                           .set("rmse", accuracy_matrix(study.points, rmse_cell)));
    }
    page().list("small_arrays", std::move(arrays));
  }
};

}  // namespace

void add_variations(const Reproduction& reproduction, ReproductionReport& report) {
  Variations(reproduction, report).run();
}

}  // namespace dtof
