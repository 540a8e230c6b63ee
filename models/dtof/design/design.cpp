// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/frame_time.hpp"

namespace dtof {
namespace {

/// True for candidates of the same parameters if `one` sees more light than `other`, or costs less area for
/// as much.
bool better_choice(const DesignCandidate& one, const DesignCandidate& other) {
  const int slots = one.array.parameters.slots - other.array.parameters.slots;
  return slots != 0 ? slots > 0 : one.cost.mm2 < other.cost.mm2;
}

/// Within the limits. Of candidates that differ in SLOTS, ENGINE_COLUMNS and columns for each SRAM alone,
/// those with most SLOTS, for fewer see less light; then the smallest array.
std::set<std::size_t> worth_reading(std::span<const DesignCandidate> candidates, const DesignLimits& limits) {
  std::map<std::string, std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!limits_kept(candidates[i], limits).all()) {
      continue;
    }
    ReadoutParameters parameters = candidates[i].array.parameters;
    parameters.slots = 0;
    parameters.pool.engine_columns = 0;
    const auto [place, is_new] = best.emplace(parameters.to_string(), i);
    if (!is_new && better_choice(candidates[i], candidates[place->second])) {
      place->second = i;
    }
  }
  std::set<std::size_t> found;
  for (const auto& [parameters, i] : best) {
    found.insert(i);
  }
  return found;
}

/// Pixels that a frame of each of these read-outs or rivals may have.
double pixels_of(double work, std::size_t number, const DesignRequest& request, int frames) {
  const BenchSettings& bench = request.bench;
  return work / bench.sensor.acquisitions / static_cast<double>(number) /
         static_cast<double>(bench.klux.size() * bench.scenes.size()) / frames;
}

std::vector<ReadoutParameters> parameters_of(const std::vector<DesignOption>& options,
                                             const std::vector<std::size_t>& places) {
  std::vector<ReadoutParameters> parameters;
  for (const std::size_t place : places) {
    parameters.push_back(compared_parameters(options[place].candidate.array.parameters));
  }
  return parameters;
}

/// Options with the same parameters are read once.
std::size_t number_of(const std::vector<DesignOption>& options, const std::vector<std::size_t>& places) {
  return distinct_readouts(parameters_of(options, places)).size();
}

std::unique_ptr<Progress> make_progress(const DesignRequest& request, const std::string& title,
                                        std::size_t total) {
  if (!request.observer) {
    return std::make_unique<Progress>(title, total);
  }
  return std::make_unique<Progress>(
      total, [&request, title](std::size_t done, std::size_t of) { request.observer(title, done, of); });
}

/// Scores of the options at these places.
std::vector<ReadoutScore> read(const DesignRequest& request, const std::vector<DesignOption>& options,
                               const std::vector<std::size_t>& places, const BenchEffort& effort,
                               BenchTables& tables, const std::string& title) {
  const BenchSettings& bench = request.bench;
  const std::size_t lights = bench.klux.size();
  const std::vector<ReadoutParameters> parameters = parameters_of(options, places);
  const auto progress = make_progress(
      request, title,
      distinct_readouts(parameters).size() * lights *
          (bench.scenes.size() * static_cast<std::size_t>(effort.frames) + (effort.detection ? 2 : 0)));
  return run_bench(bench, parameters, effort, progress.get(), &tables);
}

/// The scores of several frames, but P_d and P_fa as they were.
void replace_errors(ReadoutScore& score, ReadoutScore by) {
  for (std::size_t light = 0; light < score.lights.size(); ++light) {
    by.lights[light].detected = score.lights[light].detected;
    by.lights[light].false_alarms = score.lights[light].false_alarms;
  }
  by.threshold = score.threshold;
  score = std::move(by);
}

/// Compares the contenders in four times as many frames, again and again, until the frames settle the choice
/// or the budget is spent. `effort`: of the comparison before.
void hold_contest(const DesignRequest& request, BenchEffort effort, BenchTables& tables,
                  DesignResult& result) {
  constexpr int kMoreFrames = 4;
  effort.detection = false;
  std::vector<std::size_t> left = contenders(result.options, request.limits);
  for (double work = request.contest_work; !left.empty();) {
    // A frame of a few pixels takes as long as one of this work.
    constexpr double kLeastWork = 1e5;
    const double pixels = std::max(static_cast<double>(result.options[left.front()].best_known().pixels),
                                   kLeastWork / std::max(request.bench.sensor.acquisitions, 1U));
    const double most = pixels_of(work, number_of(result.options, left), request, 1) *
                        static_cast<double>(request.bench.scenes.size()) / pixels;
    const int frames = std::min(kMoreFrames * effort.frames, static_cast<int>(most));
    if (frames <= effort.frames) {
      break;
    }
    work *= 1.0 - frames / most;
    effort.frames = frames;
    std::vector<ReadoutScore> scores = read(request, result.options, left, effort, tables, "contenders");
    for (std::size_t i = 0; i < left.size(); ++i) {
      replace_errors(*result.options[left[i]].score, std::move(scores[i]));
    }
    result.contest_frames = frames;
    left = contenders(result.options, request.limits);
  }
  result.settled = left.empty();
}

/// Why one read-out is left out.
std::string reason_of(std::span<const DesignCandidate> candidates, const DesignLimits& limits) {
  if (candidates.empty()) {
    return "not legal for this sensor, or with memories that cannot be made";
  }
  std::vector<std::string> options;
  for (const SingleWay& way : single_ways(candidates, limits)) {
    options.push_back(way.option);
  }
  return options.empty() ? "misses several limits" : fmt::format("needs {}", fmt::join(options, " or "));
}

std::vector<LeftOut> left_out(std::span<const DesignCandidate> candidates, const DesignLimits& limits) {
  std::vector<LeftOut> found;
  for (const Readout readout : kRtlReadouts) {
    std::vector<DesignCandidate> mine;
    for (const DesignCandidate& candidate : candidates) {
      if (candidate.readout() == readout) {
        mine.push_back(candidate);
      }
    }
    if (std::ranges::none_of(mine, [&](const DesignCandidate& c) { return limits_kept(c, limits).all(); })) {
      found.push_back({readout, reason_of(mine, limits)});
    }
  }
  return found;
}

/// For limits that no candidate keeps: if one misses the frame rate alone, what would make its frame fit.
/// Else empty. The candidate is the fastest one.
std::string what_would_fit(std::span<const DesignCandidate> candidates, const DesignRequest& request) {
  const DesignCandidate* fastest = nullptr;
  for (const DesignCandidate& candidate : candidates) {
    LimitsKept kept = limits_kept(candidate, request.limits);
    const bool misses = !kept.frame;
    kept.frame = true;
    if (misses && kept.all() && (fastest == nullptr || candidate.clocks < fastest->clocks)) {
      fastest = &candidate;
    }
  }
  if (fastest == nullptr) {
    return "";
  }
  const ArrayChoice& array = fastest->array;
  return "; " + frame_fit(array.parameters, array.rows, array.columns, request.bench.sensor.acquisitions,
                          request.limits.budget)
                    .sentence;
}

/// Reads the rivals. `effort`: of the read-outs' comparison.
void add_rivals(const DesignRequest& request, BenchEffort effort, DesignResult& result) {
  RivalChoice choice = choose_rivals(request.rivals, request.bench.sensor, request.limits.most_mm2);
  result.rivals_left_out = std::move(choice.left_out);
  result.rivals = std::move(choice.options);
  if (!result.rivals.empty()) {
    effort.pixels =
        std::min(effort.pixels, pixels_of(request.rival_work, result.rivals.size(), request, effort.frames));
    const auto progress = make_progress(request, "rivals", rival_steps(request.bench, effort));
    read_rivals(request.bench, result.rivals, effort, progress.get());
  }
  std::ranges::stable_sort(
      result.rivals, {}, [](const RivalOption& rival) { return rival.score.worst().above_3_percent.value; });
}

/// Every candidate of a request whose limits at least one of them keeps. Throws as check_design().
std::vector<DesignCandidate> possible_candidates(const DesignRequest& request) {
  if (request.frames < 2 || request.bench.klux.empty() || request.bench.scenes.empty()) {
    throw InputError("design: needs a scene, a light and at least 2 frames");
  }
  std::vector<DesignCandidate> candidates = design_candidates(request);
  if (std::ranges::none_of(candidates,
                           [&](const DesignCandidate& c) { return limits_kept(c, request.limits).all(); })) {
    throw InputError("design: " + what_would_be_needed(candidates, request.limits) +
                     what_would_fit(candidates, request));
  }
  return candidates;
}

}  // namespace

std::vector<DesignCandidate> design_candidates(const DesignRequest& request) {
  const BenchSettings& bench = request.bench;
  const double brightest = std::ranges::max(bench.klux);
  std::map<int, double> slots_taken;
  for (int slots = 1; slots <= bench.sensor.slots; ++slots) {
    const SensorModel sensor = with_slots(bench.sensor, slots);
    for (const Scene scene : bench.scenes) {
      slots_taken[slots] += slot_rate(sensor, scaled_scene(scene, sensor, bench.seed), brightest) /
                            static_cast<double>(bench.scenes.size());
    }
  }
  return all_candidates(bench.sensor, request.limits.budget.clock_hz, slots_taken);
}

DesignRequest quick_design(DesignRequest request) {
  constexpr double kShare = 0.05;
  request.screening_work *= kShare;
  request.final_work *= kShare;
  request.contest_work *= kShare;
  request.detection = false;
  request.rivals = {};
  return request;
}

std::vector<const RivalOption*> more_accurate_rivals(const DesignResult& result) {
  std::vector<const RivalOption*> found;
  const LightScore& chosen = result.options[*result.recommendation.chosen].best_known().worst();
  for (const RivalOption& rival : result.rivals) {
    const LightScore& worst = rival.score.worst();
    if (worst.above_3_percent.value < chosen.above_3_percent.value && !as_good(chosen, worst)) {
      found.push_back(&rival);
    }
  }
  return found;
}

void check_design(const DesignRequest& request) { (void)possible_candidates(request); }

DesignResult run_design(const DesignRequest& request) {
  const std::vector<DesignCandidate> candidates = possible_candidates(request);
  DesignResult result;
  result.searched = candidates.size();
  result.frames = bench_frames(request.bench, request.frames);
  const std::vector<LimitChange> changes = limit_changes(request.limits);
  std::set<std::size_t> wanted = worth_reading(candidates, request.limits);
  for (const LimitChange& change : changes) {
    wanted.merge(worth_reading(candidates, change.limits));
  }
  for (const std::size_t i : wanted) {
    result.options.push_back({.candidate = candidates[i], .screened = {}, .score = std::nullopt});
  }
  std::vector<std::size_t> all(result.options.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = i;
  }
  BenchTables tables;
  const int engine_columns = bench_engine_columns(parameters_of(result.options, all));
  std::vector<ReadoutScore> screened =
      read(request, result.options, all,
           {.pixels = pixels_of(request.screening_work, number_of(result.options, all), request, 1),
            .engine_columns = engine_columns},
           tables, "parameters");
  for (std::size_t i = 0; i < all.size(); ++i) {
    result.options[i].screened = std::move(screened[i]);
  }
  std::set<std::size_t> chosen;
  for (const std::size_t i : finalists(result.options, request.limits)) {
    chosen.insert(i);
  }
  for (const LimitChange& change : changes) {
    for (const std::size_t i : finalists(result.options, change.limits)) {
      chosen.insert(i);
    }
  }
  const std::vector<std::size_t> best(chosen.begin(), chosen.end());
  const BenchEffort effort{
      .pixels = pixels_of(request.final_work, number_of(result.options, best), request, result.frames),
      .frames = result.frames,
      .detection = request.detection,
      .engine_columns = engine_columns};
  std::vector<ReadoutScore> scores = read(request, result.options, best, effort, tables, "read-outs");
  for (std::size_t i = 0; i < best.size(); ++i) {
    result.options[best[i]].score = std::move(scores[i]);
  }
  hold_contest(request, effort, tables, result);
  add_rivals(request, effort, result);
  result.recommendation = recommend(result.options, request.limits);
  result.left_out = left_out(candidates, request.limits);
  for (const LimitChange& change : changes) {
    Recommendation other = recommend(result.options, change.limits);
    std::string needed = other.chosen ? "" : what_would_be_needed(candidates, change.limits);
    result.consequences.push_back({change, std::move(other), std::move(needed)});
  }
  return result;
}

}  // namespace dtof
