// SPDX-License-Identifier: Apache-2.0
#include "photon_models/fidelity_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/readout/run_frame.hpp"
#include "dtof/report/table.hpp"
#include "dtof/sensor/default_parameters.hpp"

namespace dtof {
namespace {

constexpr double kNormalQuantile = 1.959963984540054;  // of a two-sided 95 % interval

double processor_ms(const std::function<void()>& run) {
  const std::clock_t begin = std::clock();
  run();
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// `results[row]` are a column's; nothing is returned for a column without a target.
void add_column(const TargetMap& targets, int column, std::span<const PixelResult> results,
                const DepthScale& scale, int fraction_bits, std::vector<ColumnFigures>& figures) {
  ErrorStatistics statistics;
  RunningMoments relative;
  for (int row = 0; row < targets.rows(); ++row) {
    const PixelTarget& target = targets.at(column, row);
    if (target.returns_signal()) {
      const double measured =
          scale.depth(code_position(results[static_cast<std::size_t>(row)], fraction_bits));
      statistics.add(target.depth_m, measured);
      relative.add((measured - target.depth_m) / target.depth_m);
    }
  }
  if (statistics.count() > 0) {
    const ErrorSummary summary = statistics.summary();
    figures.push_back({relative.mean(), relative.mean_square(), summary.share_above_3_percent,
                       summary.share_above_10_percent});
  }
}

struct Figures {
  std::vector<ColumnFigures> exact;
  std::vector<ColumnFigures> fast;
};

/// One scene in one light: a cell for each read-out.
class SceneComparison {
 public:
  SceneComparison(const FidelitySettings& settings, const std::string& scene, const TargetMap& targets,
                  double klux, StreamCost& streams)
      : settings_(settings),
        targets_(targets),
        source_(settings.sensor, targets, klux, settings.seed),
        scale_(settings.sensor.integration_time_s, settings.sensor.np, settings.sensor.pulse_fwhm_s),
        streams_(streams),
        figures_(settings.readouts.size()) {
    for (const Readout readout : settings.readouts) {
      cells_.push_back({.scene = scene, .klux = klux, .readout = readout, .difference = {}});
    }
  }

  std::vector<FidelityCell> run(Progress& progress) {
    for (int frame = 0; frame < settings_.frames; ++frame) {
      read_frame(source_.at_frame(static_cast<std::uint32_t>(frame)));
      progress.advance();
    }
    for (std::size_t r = 0; r < cells_.size(); ++r) {
      FidelityCell& cell = cells_[r];
      cell.difference = compare_models(figures_[r].exact, figures_[r].fast);
      for (std::size_t t = 0; t < kTolerances.size(); ++t) {
        cell.taken[t] = choose_fidelity(source_, {.tolerance = kTolerances[t],
                                                  .use = PhotonUse::kSampler,
                                                  .readouts = std::span(&cell.readout, 1)});
      }
      cell.exact_ms /= settings_.frames;
      cell.fast_ms /= settings_.frames;
    }
    return cells_;
  }

 private:
  void read_frame(const PhotonSource& exact) {
    const auto columns = static_cast<std::size_t>(exact.columns());
    const FastPhotonSource fast(exact);
    std::vector<ColumnStream> streams(columns);
    const auto draw = [&](const StreamSource& source) {
      return processor_ms([&] {
        parallel_for(columns, settings_.threads,
                     [&](std::size_t i) { streams[i] = source.column(static_cast<int>(i)); });
      });
    };
    streams_.fast_ms += draw(fast);
    const double drawing_ms = draw(exact);
    streams_.exact_ms += drawing_ms;
    for (std::size_t r = 0; r < cells_.size(); ++r) {
      const ReadoutParameters parameters = default_parameters(cells_[r].readout, settings_.sensor);
      std::vector<std::vector<PixelResult>> results(columns);
      cells_[r].exact_ms +=
          drawing_ms + processor_ms([&] {
            parallel_for(columns, settings_.threads, [&](std::size_t i) {
              results[i] = make_readout_model(parameters)->run_column(streams[i], exact.acquisitions());
            });
          });
      for (std::size_t i = 0; i < columns; ++i) {
        add_column(targets_, static_cast<int>(i), results[i], scale_, parameters.fraction_bits,
                   figures_[r].exact);
      }
      read_fast(fast, parameters, r);
    }
  }

  void read_fast(const FastPhotonSource& fast, const ReadoutParameters& parameters, std::size_t r) {
    std::vector<PixelResult> frame;
    cells_[r].fast_ms +=
        processor_ms([&] { frame = run_sampled_frame(fast, parameters, settings_.threads); });
    const auto rows = static_cast<std::size_t>(fast.rows());
    const auto columns = static_cast<std::size_t>(fast.columns());
    std::vector<PixelResult> column(rows);
    for (std::size_t i = 0; i < columns; ++i) {
      for (std::size_t row = 0; row < rows; ++row) {
        column[row] = frame[row * columns + i];
      }
      add_column(targets_, static_cast<int>(i), column, scale_, parameters.fraction_bits, figures_[r].fast);
    }
  }

  const FidelitySettings& settings_;
  const TargetMap& targets_;
  PhotonSource source_;
  DepthScale scale_;
  StreamCost& streams_;
  std::vector<FidelityCell> cells_;
  std::vector<Figures> figures_;
};

std::string as_percent(double share) { return fmt::format("{:.3f}", 100.0 * share); }

/// What one read-out did over all scenes and lights.
struct ReadoutSummary {
  double largest = 0.0;  // upper limit of any difference
  double exact_ms = 0.0;
  double fast_ms = 0.0;
  std::size_t cells = 0;
};

ReadoutSummary summarise(const FidelityStudy& study, Readout readout) {
  ReadoutSummary summary;
  for (const FidelityCell& cell : study.cells) {
    if (cell.readout == readout) {
      summary.largest = std::max(summary.largest, cell.difference.upper_limit());
      summary.exact_ms += cell.exact_ms;
      summary.fast_ms += cell.fast_ms;
      ++summary.cells;
    }
  }
  const auto count = static_cast<double>(std::max<std::size_t>(summary.cells, 1));
  summary.exact_ms /= count;
  summary.fast_ms /= count;
  return summary;
}

std::string readout_section(const FidelityStudy& study, const FidelitySettings& settings) {
  Table table({"read-out", "largest difference, %", "limit that auto uses, %", "limit holds",
               "exact stream, CPU ms", "fast sampler, CPU ms", "fast / exact", "auto reckons with"});
  std::size_t holding = 0;
  std::size_t cheaper = 0;
  std::size_t as_reckoned = 0;
  for (const Readout readout : settings.readouts) {
    const ReadoutSummary summary = summarise(study, readout);
    const double limit = fast_sampler_difference(readout);
    holding += summary.largest <= limit ? 1 : 0;
    const bool is_cheaper = summary.fast_ms < summary.exact_ms;
    cheaper += is_cheaper ? 1 : 0;
    as_reckoned += is_cheaper == (fast_sampler_cost(readout) < 1.0) ? 1 : 0;
    table.add({std::string(readout_title(readout)), as_percent(summary.largest), as_percent(limit),
               summary.largest <= limit ? "yes" : "**no**", fmt::format("{:.0f}", summary.exact_ms),
               fmt::format("{:.0f}", summary.fast_ms),
               fmt::format("{:.2f}", summary.fast_ms / summary.exact_ms),
               fmt::format("{:.2f}", fast_sampler_cost(readout))});
  }
  const std::size_t readouts = settings.readouts.size();
  return fmt::format(
      "{}\nThe limits of `--fidelity auto` hold for {} of {} read-outs. The fast sampler costs less than the "
      "exact streams for {} of {} read-outs, and the order that `auto` assumes is right for {}. The streams "
      "of a frame took {:.0f} ms with the exact model and {:.0f} ms with the fast one. For streams the {} "
      "model is therefore the cheaper one, and the exact streams of `auto` cost {} than the fast ones.\n",
      table.markdown(), holding, readouts, cheaper, readouts, as_reckoned, study.streams.exact_ms,
      study.streams.fast_ms, study.streams.exact_ms <= study.streams.fast_ms ? "exact" : "fast",
      study.streams.exact_ms <= study.streams.fast_ms
          ? "less"
          : fmt::format("{:.0f} % more", 100.0 * (study.streams.exact_ms / study.streams.fast_ms - 1.0)));
}

std::string promise_section(const FidelityStudy& study) {
  Table table(
      {"tolerance", "exact", "fast", "CPU ms a frame", "all exact, CPU ms", "kept", "open", "broken"});
  std::size_t broken = 0;
  for (std::size_t t = 0; t < kTolerances.size(); ++t) {
    const double tolerance = kTolerances[t];
    std::array<std::size_t, 3> promises{};
    std::size_t fast = 0;
    double cost = 0.0;
    double exact_cost = 0.0;
    for (const FidelityCell& cell : study.cells) {
      const bool is_fast = cell.taken[t] == Fidelity::kFast;
      fast += is_fast ? 1 : 0;
      cost += is_fast ? cell.fast_ms : cell.exact_ms;
      exact_cost += cell.exact_ms;
      // The exact model differs from itself by nothing.
      ++promises[static_cast<std::size_t>(is_fast ? cell.difference.promise(tolerance) : Promise::kKept)];
    }
    broken += promises[static_cast<std::size_t>(Promise::kBroken)];
    const auto cells = static_cast<double>(study.cells.size());
    table.add({fmt::format("{:g}", tolerance), fmt::format("{}", study.cells.size() - fast),
               fmt::format("{}", fast), fmt::format("{:.0f}", cost / cells),
               fmt::format("{:.0f}", exact_cost / cells), fmt::format("{}", promises[0]),
               fmt::format("{}", promises[1]), fmt::format("{}", promises[2])});
  }
  return fmt::format(
      "## What auto takes, and whether it keeps its promise\n\nNumber of the {} scenes, lights and read-outs "
      "for "
      "which `--fidelity auto` takes each model; kept: the 95 % intervals of all four differences lie within "
      "the "
      "tolerance, broken: one lies outside by more than three standard errors.\n\n{}\n{}\n",
      study.cells.size(), table.markdown(),
      broken == 0 ? "No promise was broken." : fmt::format("**{} promises were broken.**", broken));
}

std::string scene_section(const FidelityStudy& study, const FidelitySettings& settings) {
  std::string text =
      "## Differences by scene\n\nFast sampler less exact model, in percentage points, with "
      "standard errors; auto: the model that it takes at tolerances ";
  for (const double tolerance : kTolerances) {
    text += fmt::format("{}{:g}", tolerance == kTolerances.front() ? "" : ", ", tolerance);
  }
  const double middle = settings.klux[settings.klux.size() / 2];
  text += fmt::format(" (e exact, f fast). At {:g} klux; the other lights are in the CSV.\n\n", middle);
  Table table({"scene", "read-out", "auto", "rmse", "bias", "above 3 %", "above 10 %", "exact, CPU ms",
               "fast, CPU ms"},
              3);
  for (const FidelityCell& cell : study.cells) {
    if (cell.klux != middle) {
      continue;
    }
    std::string models;
    for (const Fidelity model : cell.taken) {
      models += model == Fidelity::kFast ? 'f' : 'e';
    }
    std::vector<std::string> row = {cell.scene, std::string(readout_title(cell.readout)), models};
    for (const FigureDifference& figure : cell.difference.figures) {
      row.push_back(fmt::format("{:+.3f} ± {:.3f}", 100.0 * figure.value, 100.0 * figure.standard_error));
    }
    row.push_back(fmt::format("{:.0f}", cell.exact_ms));
    row.push_back(fmt::format("{:.0f}", cell.fast_ms));
    table.add(row);
  }
  return text + table.markdown();
}

void validate(const FidelitySettings& settings) {
  if (settings.frames < 1 || settings.scenes.empty() || settings.klux.empty() || settings.readouts.empty()) {
    throw InputError("fidelity: needs at least one frame, scene, light and read-out");
  }
  for (const Readout readout : settings.readouts) {
    if (is_pool_readout(readout)) {
      throw InputError(
          fmt::format("fidelity: {} reads streams, which are always exact", readout_name(readout)));
    }
  }
}

}  // namespace

double FigureDifference::upper_limit() const { return std::abs(value) + kNormalQuantile * standard_error; }

std::string_view promise_name(Promise promise) {
  switch (promise) {
    case Promise::kKept:
      return "kept";
    case Promise::kOpen:
      return "open";
    case Promise::kBroken:
      return "broken";
  }
  throw std::logic_error("unknown promise");
}

double ModelDifference::upper_limit() const {
  double largest = 0.0;
  for (const FigureDifference& figure : figures) {
    largest = std::max(largest, figure.upper_limit());
  }
  return largest;
}

Promise ModelDifference::promise(double tolerance) const {
  constexpr double kSurely = 3.0;
  const bool broken = std::ranges::any_of(figures, [&](const FigureDifference& figure) {
    return std::abs(figure.value) - kSurely * figure.standard_error > tolerance;
  });
  if (broken) {
    return Promise::kBroken;
  }
  return upper_limit() <= tolerance ? Promise::kKept : Promise::kOpen;
}

ModelDifference compare_models(std::span<const ColumnFigures> exact, std::span<const ColumnFigures> other) {
  if (exact.size() != other.size() || exact.size() < 2) {
    throw InputError(
        fmt::format("fidelity: {} columns cannot be compared with {}", exact.size(), other.size()));
  }
  RunningMoments exact_square;
  RunningMoments other_square;
  std::array<RunningMoments, 4> differences;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    exact_square.add(exact[i].mean_square);
    other_square.add(other[i].mean_square);
    differences[0].add(other[i].mean_square - exact[i].mean_square);
    differences[1].add(other[i].bias - exact[i].bias);
    differences[2].add(other[i].above_3_percent - exact[i].above_3_percent);
    differences[3].add(other[i].above_10_percent - exact[i].above_10_percent);
  }
  ModelDifference difference;
  for (std::size_t f = 0; f < differences.size(); ++f) {
    const auto count = static_cast<double>(differences[f].count());
    difference.figures[f] = {differences[f].mean(), std::sqrt(differences[f].variance() / count)};
  }
  difference.rmse = std::sqrt(exact_square.mean());
  // The difference of two roots is the difference of the squares over the sum of the roots.
  const double roots = difference.rmse + std::sqrt(other_square.mean());
  if (roots > 0.0) {
    difference.figures[0].value /= roots;
    difference.figures[0].standard_error /= roots;
  }
  return difference;
}

FidelityStudy run_fidelity_study(const FidelitySettings& settings) {
  validate(settings);
  Progress progress(
      "fidelity", settings.scenes.size() * settings.klux.size() * static_cast<std::size_t>(settings.frames));
  FidelityStudy study;
  for (const double klux : settings.klux) {
    for (const auto& [name, targets] : settings.scenes) {
      SceneComparison comparison(settings, name, targets, klux, study.streams);
      std::ranges::move(comparison.run(progress), std::back_inserter(study.cells));
    }
  }
  const auto frames = static_cast<double>(settings.scenes.size() * settings.klux.size()) * settings.frames;
  study.streams.exact_ms /= frames;
  study.streams.fast_ms /= frames;
  return study;
}

std::string fidelity_report(const FidelityStudy& study, const FidelitySettings& settings,
                            const std::string& command) {
  const TargetMap& first = settings.scenes.front().second;
  return fmt::format(
      "# What the fast photon model changes of what a user sees\n\n"
      "Figures of a scene with the fast model's sampler against those with the exact model: root mean square "
      "and "
      "mean of the relative error, share of pixels off by more than 3 % and by more than 10 %, before any "
      "look-up "
      "table; {} scenes of {} x {} pixels in {} lights, {} frames each, seed {}. A difference has a 95 % "
      "interval "
      "from the spread over columns, and the largest difference is the largest end of any of them. "
      "`--fidelity auto --tolerance t` takes the fast model where that is at most t and the exact one "
      "elsewhere; "
      "times are processor time of this run. Command: `{}`\n\n{}\n{}\n{}",
      settings.scenes.size(), first.columns(), first.rows(), settings.klux.size(), settings.frames,
      settings.seed, command, readout_section(study, settings), promise_section(study),
      scene_section(study, settings));
}

std::string fidelity_csv(const FidelityStudy& study) {
  Table table({"klux", "scene", "readout", "tolerance", "taken", "promise", "cost_ms", "exact_ms", "fast_ms",
               "rmse_exact", "rmse_difference", "rmse_standard_error", "bias_difference",
               "bias_standard_error", "above_3_percent_difference", "above_3_percent_standard_error",
               "above_10_percent_difference", "above_10_percent_standard_error"});
  for (const FidelityCell& cell : study.cells) {
    for (std::size_t t = 0; t < kTolerances.size(); ++t) {
      const double tolerance = kTolerances[t];
      const bool fast = cell.taken[t] == Fidelity::kFast;
      std::vector<std::string> row = {
          fmt::format("{:g}", cell.klux),
          cell.scene,
          std::string(readout_name(cell.readout)),
          fmt::format("{:g}", tolerance),
          fast ? "fast" : "exact",
          std::string(promise_name(fast ? cell.difference.promise(tolerance) : Promise::kKept)),
          fmt::format("{:.1f}", fast ? cell.fast_ms : cell.exact_ms),
          fmt::format("{:.1f}", cell.exact_ms),
          fmt::format("{:.1f}", cell.fast_ms),
          fmt::format("{:.6f}", cell.difference.rmse)};
      for (const FigureDifference& figure : cell.difference.figures) {
        row.push_back(fmt::format("{:.6f}", figure.value));
        row.push_back(fmt::format("{:.6f}", figure.standard_error));
      }
      table.add(row);
    }
  }
  return table.csv();
}

}  // namespace dtof
