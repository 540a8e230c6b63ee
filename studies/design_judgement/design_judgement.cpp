// SPDX-License-Identifier: Apache-2.0
#include "design_judgement/design_judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "design_judgement/judgement_store.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/io/output_folder.hpp"

namespace dtof {
namespace {

// The judge's seeds are none of the search's: 1000 for the sweep, then one for each reading of the final.
constexpr std::uint64_t kJudgeSeeds = 1000;

std::string name_of(const ReadoutParameters& parameters, const SensorModel& sensor) {
  return command_options(parameters, sensor).substr(std::string("--readout ").size());
}

double mean_share(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Reads candidates of one sensor.
class Judge {
 public:
  Judge(const JudgementSettings& settings, const DesignRequest& request, int number)
      : settings_(settings), bench_(request.bench), number_(number) {
    bench_.threads = settings.threads;
  }

  /// Share above 3 % of each candidate in its worst light.
  [[nodiscard]] std::vector<double> sweep(std::span<const ReadoutParameters> candidates) {
    std::vector<double> shares;
    for (const ReadoutScore& score : read(candidates, settings_.sweep_pixels, 0, "sweep")) {
      shares.push_back(score.worst().above_3_percent.value);
    }
    return shares;
  }

  struct Final {
    std::vector<std::vector<double>> shares;  ///< [candidate][seed], in the candidate's worst light
    std::uint64_t pixels = 0;                 ///< of one seed
  };
  [[nodiscard]] Final final(std::span<const ReadoutParameters> candidates) {
    std::vector<std::vector<std::vector<double>>> by_light(
        candidates.size(), std::vector<std::vector<double>>(bench_.klux.size()));
    Final found;
    for (int seed = 1; seed <= settings_.final_seeds; ++seed) {
      const std::vector<ReadoutScore> scores =
          read(candidates, settings_.final_pixels, static_cast<std::uint64_t>(seed), "final");
      found.pixels = scores.front().pixels * static_cast<std::uint64_t>(frames(settings_.final_pixels));
      for (std::size_t c = 0; c < candidates.size(); ++c) {
        for (std::size_t light = 0; light < bench_.klux.size(); ++light) {
          by_light[c][light].push_back(scores[c].lights[light].above_3_percent.value);
        }
      }
    }
    for (const std::vector<std::vector<double>>& lights : by_light) {
      found.shares.push_back(*std::ranges::max_element(lights, {}, mean_share));
    }
    return found;
  }

 private:
  [[nodiscard]] int frames(double pixels) const {
    const double of_a_frame = static_cast<double>(bench_.sensor.columns) * bench_.sensor.rows *
                              static_cast<double>(bench_.scenes.size());
    return std::max(1, static_cast<int>(std::ceil(pixels / of_a_frame)));
  }

  [[nodiscard]] std::vector<ReadoutScore> read(std::span<const ReadoutParameters> candidates, double pixels,
                                               std::uint64_t part, const char* title) {
    bench_.seed = kJudgeSeeds * settings_.seed + part;
    const BenchEffort effort{.frames = frames(pixels)};
    Progress progress(fmt::format("sensor {} of {}: {}", number_, settings_.sensors, title),
                      candidates.size() * bench_.klux.size() * bench_.scenes.size() *
                          static_cast<std::size_t>(effort.frames));
    return run_bench(bench_, candidates, effort, &progress);
  }

  const JudgementSettings& settings_;
  BenchSettings bench_;
  int number_;
};

/// Fills in where the search lost `best`, and the shares on which it decided.
void find_loss(const DesignResult& result, const ReadoutParameters& best, SensorJudgement& judgement) {
  const auto share = [](const ReadoutScore& score) { return score.worst().above_3_percent.value; };
  const Recommendation& recommendation = result.recommendation;
  const DesignOption& chosen = result.options[*recommendation.chosen];
  if (chosen.candidate.array.parameters == best) {
    return;
  }
  const auto option = std::ranges::find(result.options, best,
                                        [](const DesignOption& o) { return o.candidate.array.parameters; });
  if (option == result.options.end()) {
    judgement.lost = Lost::kNotRead;
    return;
  }
  const auto place = static_cast<std::size_t>(option - result.options.begin());
  const std::vector<std::size_t>& within = recommendation.within;
  if (std::ranges::find(within, place) != within.end()) {
    judgement.lost = Lost::kInFinal;
    judgement.search_best = share(option->best_known());
    judgement.search_other = share(chosen.best_known());
    return;
  }
  judgement.lost = Lost::kInScreening;
  judgement.search_best = share(option->screened);
  for (const std::size_t i : within) {
    if (result.options[i].candidate.readout() == best.readout) {
      judgement.search_other = share(result.options[i].screened);
    }
  }
}

void validate(const JudgementSettings& settings) {
  if (settings.sensors < 1 || settings.finalists < 1 || settings.final_seeds < 2) {
    throw InputError("design judgement: needs a sensor, a finalist and two seeds of the final");
  }
  if (settings.ranges.most_columns < kLeastColumns || settings.ranges.most_rows < kLeastRows ||
      settings.ranges.most_acquisitions < kLeastAcquisitions) {
    throw InputError(
        fmt::format("design judgement: the ranges begin at {} columns, {} rows and {} acquisitions, so that "
                    "they cannot end "
                    "below",
                    kLeastColumns, kLeastRows, kLeastAcquisitions));
  }
}

/// Places of the grid's candidates, smallest share first.
std::vector<std::size_t> by_share(const std::vector<double>& shares) {
  std::vector<std::size_t> order(shares.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return shares[i]; });
  return order;
}

std::vector<ReadoutParameters> parameters_of(const std::vector<DesignCandidate>& candidates) {
  std::vector<ReadoutParameters> parameters;
  for (const DesignCandidate& candidate : candidates) {
    parameters.push_back(candidate.array.parameters);
  }
  return parameters;
}

}  // namespace

Verdict SensorJudgement::verdict() const {
  if (!keeps_limits) {
    return Verdict::kBeyond;
  }
  const bool differs_little = recommended.share.value <= best.share.value + kGoodDifference;
  return differs_little || ratio.value <= kGoodRatio ? Verdict::kWithin
         : ratio.interval.low <= kGoodRatio          ? Verdict::kUndecided
                                                     : Verdict::kBeyond;
}

Estimate share_ratio(std::span<const double> chosen, std::span<const double> best, std::uint64_t pixels) {
  const double mean_best = mean_share(best);
  const double floor = std::max(mean_best, 1.0 / static_cast<double>(pixels));
  const double value = std::max(mean_share(chosen), 1.0 / static_cast<double>(pixels)) / floor;
  std::vector<double> residuals;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    residuals.push_back((chosen[i] - value * best[i]) / floor);
  }
  const Interval spread = estimate_mean(residuals).interval;
  const double half = 0.5 * (spread.high - spread.low);
  return {value, {std::max(0.0, value - half), value + half}};
}

SensorJudgement judge_sensor(const JudgementSettings& settings, const DesignRequest& request, int number) {
  DesignRequest with_threads = request;
  with_threads.bench.threads = settings.threads;
  const DesignResult result = settings.design(with_threads);
  const DesignCandidate& chosen = result.options[*result.recommendation.chosen].candidate;
  const std::vector<DesignCandidate> grid = design_candidates(request);
  const std::vector<DesignCandidate> kept = smallest_of_each(kept_of(grid, request.limits));
  SensorJudgement judgement;
  judgement.grid = smallest_of_each(grid).size();
  judgement.kept = kept.size();
  judgement.read = result.options.size();

  Judge judge(settings, request, number);
  const std::vector<ReadoutParameters> swept = parameters_of(kept);
  const std::vector<std::size_t> order = by_share(judge.sweep(swept));
  std::vector<ReadoutParameters> finalists = {chosen.array.parameters};
  std::vector<double> areas = {chosen.cost.mm2};
  std::vector<std::size_t> places = {0};
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (swept[order[i]] == finalists.front()) {
      places.front() = i + 1;
    } else if (finalists.size() <= static_cast<std::size_t>(settings.finalists)) {
      finalists.push_back(swept[order[i]]);
      areas.push_back(kept[order[i]].cost.mm2);
      places.push_back(i + 1);
    }
  }
  judgement.keeps_limits = places.front() != 0;

  const Judge::Final final = judge.final(finalists);
  std::size_t best = 0;
  for (std::size_t c = 1; c < finalists.size(); ++c) {
    // A recommendation that misses a limit is no candidate.
    if ((best == 0 && !judgement.keeps_limits) ||
        mean_share(final.shares[c]) < mean_share(final.shares[best])) {
      best = c;
    }
  }
  const auto judged = [&](std::size_t c) {
    return JudgedCandidate{.name = name_of(finalists[c], request.bench.sensor),
                           .share = estimate_share_of_frames(final.shares[c], final.pixels),
                           .mm2 = areas[c],
                           .place = places[c]};
  };
  judgement.recommended = judged(0);
  judgement.best = judged(best);
  judgement.ratio = share_ratio(final.shares[0], final.shares[best],
                                final.pixels * static_cast<std::uint64_t>(settings.final_seeds));
  find_loss(result, finalists[best], judgement);
  return judgement;
}

std::vector<JudgedSensor> judge_designs(const JudgementSettings& settings) {
  validate(settings);
  if (!settings.store.empty()) {
    create_output_folder(settings.store);
  }
  std::vector<JudgedSensor> judged;
  for (int number = 1; number <= settings.sensors; ++number) {
    JudgedSensor one{.sensor = draw_sensor(settings.seed, number, settings.ranges), .judgement = {}};
    const std::filesystem::path file = settings.store / fmt::format("sensor_{:02}.csv", number);
    if (!settings.store.empty() && std::filesystem::exists(file)) {
      one.judgement = stored_judgement(file);
    } else {
      one.judgement = judge_sensor(settings, one.sensor.request, number);
      if (!settings.store.empty()) {
        store_judgement(file, one.judgement);
      }
    }
    if (settings.on_judged) {
      settings.on_judged(number, one.judgement);
    }
    judged.push_back(std::move(one));
  }
  return judged;
}

}  // namespace dtof
