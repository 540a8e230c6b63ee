// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/recommendation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace dtof {
namespace {

constexpr double kChange = 0.1;

double share_of(const DesignOption& option) { return option.best_known().worst().above_3_percent.value; }

/// The smallest array of those that are as good as the best; none of none.
std::optional<std::size_t> best_of(std::span<const DesignOption> options,
                                   const std::vector<std::size_t>& among) {
  if (among.empty()) {
    return std::nullopt;
  }
  const std::size_t best =
      *std::ranges::min_element(among, {}, [&](std::size_t i) { return share_of(options[i]); });
  std::size_t chosen = best;
  for (const std::size_t i : among) {
    if (as_good(options[i].best_known().worst(), options[best].best_known().worst()) &&
        options[i].candidate.cost.mm2 < options[chosen].candidate.cost.mm2) {
      chosen = i;
    }
  }
  return chosen;
}

/// What an option of the command would have to be.
struct Need {
  std::string option;
  bool LimitsKept::*limit;
  bool most;  ///< the limit is an upper one
  std::function<double(const DesignCandidate&)> value;
};

/// Rounded so that the limit is kept: "1.19".
std::string rounded(double value, bool up) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return fmt::format("{:.6g}", (up ? std::ceil(value / step) : std::floor(value / step)) * step);
}

std::vector<Need> needs(const DesignLimits& limits) {
  const double clock_hz = limits.budget.clock_hz;
  return {
      {"--max-mm2", &LimitsKept::area, true, [](const DesignCandidate& c) { return c.cost.mm2; }},
      {"--max-mw", &LimitsKept::power, true, [=](const DesignCandidate& c) { return c.mw(clock_hz); }},
      {"--frame-rate", &LimitsKept::frame, false,
       [=](const DesignCandidate& c) { return c.frames_per_s(clock_hz); }},
      {"--clock-mhz", &LimitsKept::clock, false, [](const DesignCandidate& c) { return c.cost.fmax_mhz; }}};
}

}  // namespace

std::vector<LimitChange> limit_changes(const DesignLimits& limits) {
  std::vector<LimitChange> changes;
  const auto add = [&](const std::string& name, const std::function<double&(DesignLimits&)>& limit) {
    for (const double factor : {1.0 - kChange, 1.0 + kChange}) {
      DesignLimits changed = limits;
      limit(changed) *= factor;
      if (std::isfinite(limit(changed))) {
        changes.push_back({fmt::format("{} 10 % {}", name, factor < 1.0 ? "less" : "more"), changed});
      }
    }
  };
  add("area", [](DesignLimits& l) -> double& { return l.most_mm2; });
  add("power", [](DesignLimits& l) -> double& { return l.most_mw; });
  add("frame rate", [](DesignLimits& l) -> double& { return l.budget.frames_per_s; });
  add("clock", [](DesignLimits& l) -> double& { return l.budget.clock_hz; });
  return changes;
}

bool as_good(const LightScore& one, const LightScore& other) {
  return one.above_3_percent.value <= other.above_3_percent.covering().high &&
         one.above_3_percent.covering().low <= other.above_3_percent.value;
}

std::vector<std::size_t> representatives(std::span<const DesignOption> options, const DesignLimits& limits) {
  std::vector<std::size_t> found;
  for (const Readout readout : kRtlReadouts) {
    std::vector<std::size_t> mine;
    for (std::size_t i = 0; i < options.size(); ++i) {
      if (options[i].candidate.readout() == readout && limits_kept(options[i].candidate, limits).all()) {
        mine.push_back(i);
      }
    }
    // Parameters are compared by frames that all of them have read.
    std::vector<DesignOption> screened(options.begin(), options.end());
    for (DesignOption& option : screened) {
      option.score.reset();
    }
    if (const auto best = best_of(screened, mine)) {
      found.push_back(*best);
    }
  }
  return found;
}

Recommendation recommend(std::span<const DesignOption> options, const DesignLimits& limits) {
  Recommendation found;
  found.within = representatives(options, limits);
  std::ranges::sort(found.within, {}, [&](std::size_t i) { return share_of(options[i]); });
  found.chosen = best_of(options, found.within);
  std::vector<std::size_t> others;
  for (const std::size_t i : found.within) {
    if (i != found.chosen) {
      others.push_back(i);
    }
  }
  found.competitor = best_of(options, others);
  return found;
}

std::vector<SingleWay> single_ways(std::span<const DesignCandidate> candidates, const DesignLimits& limits) {
  std::vector<SingleWay> ways;
  for (const Need& need : needs(limits)) {
    const DesignCandidate* nearest = nullptr;
    for (const DesignCandidate& candidate : candidates) {
      LimitsKept kept = limits_kept(candidate, limits);
      const bool misses = !(kept.*need.limit);
      kept.*need.limit = true;
      const auto nearer = [&] {
        return nearest == nullptr || (need.most ? need.value(candidate) < need.value(*nearest)
                                                : need.value(candidate) > need.value(*nearest));
      };
      if (misses && kept.all() && nearer()) {
        nearest = &candidate;
      }
    }
    if (nearest != nullptr) {
      ways.push_back(
          {fmt::format("{} {}", need.option, rounded(need.value(*nearest), need.most)), nearest->readout()});
    }
  }
  return ways;
}

std::string what_would_be_needed(std::span<const DesignCandidate> candidates, const DesignLimits& limits) {
  std::vector<std::string> ways;
  for (const SingleWay& way : single_ways(candidates, limits)) {
    ways.push_back(fmt::format("{} ({})", way.option, readout_title(way.readout)));
  }
  if (!ways.empty()) {
    return fmt::format("no read-out keeps the limits; one of these would do: {}", fmt::join(ways, ", "));
  }
  for (const Need& need : needs(limits)) {
    const auto value = [&](const DesignCandidate& c) { return need.most ? need.value(c) : -need.value(c); };
    if (candidates.empty()) {
      return "no read-out is legal for this sensor";
    }
    const DesignCandidate& least = *std::ranges::min_element(candidates, {}, value);
    if (!(limits_kept(least, limits).*need.limit)) {
      ways.push_back(fmt::format("{} {} ({})", need.option, rounded(need.value(least), need.most),
                                 readout_title(least.readout())));
    }
  }
  if (ways.empty()) {
    return "no read-out keeps the limits together, though each limit alone is kept by some";
  }
  return fmt::format(
      "no read-out keeps the limits, and no single one is to blame; each alone would have to be at {}",
      fmt::join(ways, ", "));
}

}  // namespace dtof
