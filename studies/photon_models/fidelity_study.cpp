// SPDX-License-Identifier: Apache-2.0
#include "photon_models/fidelity_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <functional>
#include <iterator>
#include <optional>
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

/// The read-outs' table, and what the sentences below it say.
void add_readouts(const FidelityStudy& study, const FidelitySettings& settings, PageData& data) {
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
  const bool fast_streams = study.streams.fast_ms < study.streams.exact_ms;
  std::optional<PageData> cheaper_fast_streams;
  if (fast_streams) {
    cheaper_fast_streams = PageData().set("percent_more", "{:.0f}",
                                          100.0 * (study.streams.exact_ms / study.streams.fast_ms - 1.0));
  }
  data.set("differences_of_readouts", table)
      .set("limits_that_hold", "{}", holding)
      .set("readouts", "{}", settings.readouts.size())
      .set("cheaper_samplers", "{}", cheaper)
      .set("as_assumed", "{}", as_reckoned)
      .set("exact_stream_ms", "{:.0f}", study.streams.exact_ms)
      .set("fast_stream_ms", "{:.0f}", study.streams.fast_ms)
      .part("cheaper_fast_streams", std::move(cheaper_fast_streams));
}

/// What auto takes at each tolerance.
void add_promises(const FidelityStudy& study, PageData& data) {
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
  std::optional<PageData> some_broken;
  if (broken > 0) {
    some_broken = PageData().set("promises", "{}", broken);
  }
  data.set("cells", "{}", study.cells.size())
      .set("what_auto_takes", table)
      .part("broken", std::move(some_broken));
}

void add_scenes(const FidelityStudy& study, const FidelitySettings& settings, PageData& data) {
  const double middle = settings.klux[settings.klux.size() / 2];
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
  data.set("tolerances", "{:g}", fmt::join(kTolerances, ", "))
      .set("middle_klux", "{:g}", middle)
      .set("differences_of_scenes", table);
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

PageData fidelity_page(const FidelityStudy& study, const FidelitySettings& settings,
                       const std::string& command) {
  const TargetMap& first = settings.scenes.front().second;
  PageData data;
  data.set("scenes", "{}", settings.scenes.size())
      .set("columns", "{}", first.columns())
      .set("rows", "{}", first.rows())
      .set("lights", "{}", settings.klux.size())
      .set("frames", "{}", settings.frames)
      .set("seed", "{}", settings.seed)
      .set("command", "{}", command);
  add_readouts(study, settings, data);
  add_promises(study, data);
  add_scenes(study, settings, data);
  return data;
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
