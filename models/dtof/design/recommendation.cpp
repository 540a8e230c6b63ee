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

std::size_t smallest_share(std::span<const DesignOption> options, const std::vector<std::size_t>& among) {
  return *std::ranges::min_element(among, {}, [&](std::size_t i) { return share_of(options[i]); });
}

/// The smallest array of those that are `good` beside the one with the smallest share.
std::size_t smallest_of(std::span<const DesignOption> options, const std::vector<std::size_t>& among,
                        const std::function<bool(const LightScore& one, const LightScore& best)>& good) {
  const std::size_t best = smallest_share(options, among);
  std::size_t chosen = best;
  for (const std::size_t i : among) {
    if (good(options[i].best_known().worst(), options[best].best_known().worst()) &&
        options[i].candidate.cost.mm2 < options[chosen].candidate.cost.mm2) {
      chosen = i;
    }
  }
  return chosen;
}

/// None of none.
std::optional<std::size_t> choice(std::span<const DesignOption> options,
                                  const std::vector<std::size_t>& among) {
  if (among.empty()) {
    return std::nullopt;
  }
  return smallest_of(options, among, [](const LightScore& one, const LightScore& best) {
    return one.above_3_percent.value <= good_share(best.above_3_percent.value);
  });
}

std::vector<std::size_t> of_readout(std::span<const DesignOption> options,
                                    const std::vector<std::size_t>& among, Readout readout) {
  std::vector<std::size_t> found;
  for (const std::size_t i : among) {
    if (options[i].candidate.readout() == readout) {
      found.push_back(i);
    }
  }
  return found;
}

/// Largest share of errors that is as good as another share: ratio * share + difference.
struct GoodLimit {
  double ratio;
  double difference;

  [[nodiscard]] double of(double share) const { return ratio * share + difference; }
};

GoodLimit good_limit(double smallest) {
  return kGoodRatio * smallest > smallest + kGoodDifference ? GoodLimit{kGoodRatio, 0.0}
                                                            : GoodLimit{1.0, kGoodDifference};
}

/// Share of `one` less the limit of the share of `other`, over the frames that both have.
Interval excess(const DesignOption& one, const DesignOption& other) {
  const std::vector<double>& ones = one.best_known().worst().above_3_of_frames;
  const std::vector<double>& others = other.best_known().worst().above_3_of_frames;
  const GoodLimit limit = good_limit(share_of(other));
  std::vector<double> differences;
  for (std::size_t i = 0; i < std::min(ones.size(), others.size()); ++i) {
    differences.push_back(ones[i] - limit.of(others[i]));
  }
  return estimate_mean(differences).interval;
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

double good_share(double smallest) { return good_limit(smallest).of(smallest); }

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

std::vector<std::size_t> finalists(std::span<const DesignOption> options, const DesignLimits& limits) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (limits_kept(options[i].candidate, limits).all()) {
      kept.push_back(i);
    }
  }
  // Parameters are compared by frames that all of them have read.
  std::vector<DesignOption> screened(options.begin(), options.end());
  for (DesignOption& option : screened) {
    option.score.reset();
  }
  std::vector<std::size_t> found;
  for (const Readout readout : kRtlReadouts) {
    const std::vector<std::size_t> mine = of_readout(options, kept, readout);
    if (mine.empty()) {
      continue;
    }
    const std::size_t best = smallest_share(screened, mine);
    const std::size_t smallest = smallest_of(screened, mine, as_good);
    found.push_back(best);
    if (smallest != best) {
      found.push_back(smallest);
    }
  }
  return found;
}

Recommendation recommend(std::span<const DesignOption> options, const DesignLimits& limits) {
  Recommendation found;
  const std::vector<std::size_t> all = finalists(options, limits);
  found.chosen = choice(options, all);
  std::vector<std::size_t> others;
  for (const Readout readout : kRtlReadouts) {
    const auto best = choice(options, of_readout(options, all, readout));
    if (best && readout == options[*found.chosen].candidate.readout()) {
      found.within.push_back(*found.chosen);
    } else if (best) {
      found.within.push_back(*best);
      others.push_back(*best);
    }
  }
  std::ranges::sort(found.within, {}, [&](std::size_t i) { return share_of(options[i]); });
  found.competitor = choice(options, others);
  return found;
}

std::vector<std::size_t> contenders(std::span<const DesignOption> options, const DesignLimits& limits) {
  const std::vector<std::size_t> within = finalists(options, limits);
  const std::size_t best = smallest_share(options, within);
  std::vector<std::size_t> found = {best};
  bool settled = true;
  for (const std::size_t i : within) {
    const Interval worse = i == best ? Interval{} : excess(options[i], options[best]);
    if (i == best || worse.low > 0.0) {
      continue;
    }
    found.push_back(i);
    const bool is_smaller = options[i].candidate.cost.mm2 < options[best].candidate.cost.mm2;
    settled = settled && (is_smaller ? worse : excess(options[best], options[i])).high <= 0.0;
  }
  return settled ? std::vector<std::size_t>() : found;
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
