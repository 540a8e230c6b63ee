// SPDX-License-Identifier: Apache-2.0
#include "rivals/rival_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include "dtof/metrics/error_estimates.hpp"
#include "dtof/metrics/error_statistics.hpp"

namespace dtof {
namespace {

constexpr const char* kMissing = "-";

std::string_view kind_name(ComparedRow::Kind kind) {
  switch (kind) {
    case ComparedRow::Kind::kRival:
      return "rival";
    case ComparedRow::Kind::kReference:
      return "reference";
    case ComparedRow::Kind::kReadout:
      break;
  }
  return "read-out";
}

std::string bits_text(const ComparedRow& row) { return row.bits ? fmt::format("{:g}", *row.bits) : kMissing; }

std::string share_text(const Estimate& share) {
  return fmt::format("{:.2f} +-{:.2f}", 100.0 * share.value,
                     50.0 * (share.interval.high - share.interval.low));
}

bool is_flat_scene(const std::string& scene) { return scene.starts_with("flat "); }

struct ClaimedShare {
  bool first;  ///< of its wall
  double percent;
  Estimate here;

  [[nodiscard]] bool agrees() const {
    const auto cases =
        static_cast<std::uint64_t>(std::llround(percent / 100.0 * static_cast<double>(kClaimedPixels)));
    const Interval claimed = estimate_share(cases, kClaimedPixels).interval;
    return claimed.low <= here.interval.high && here.interval.low <= claimed.high;
  }
};

std::vector<ClaimedShare> claimed_shares(const CheckedClaim& claim) {
  std::vector<ClaimedShare> shares;
  for (const auto& [wall, counts] :
       {std::pair(claim.claim.at_3_m, claim.at_3_m), std::pair(claim.claim.at_4_m, claim.at_4_m)}) {
    shares.push_back({true, wall.above_3_percent, estimate_share(counts.above_3_percent, counts.pixels)});
    shares.push_back({false, wall.above_10_percent, estimate_share(counts.above_10_percent, counts.pixels)});
  }
  return shares;
}

}  // namespace

const std::vector<ComparedFigure>& compared_figures() {
  static const std::vector<ComparedFigure> figures = {
      {"above 3 %", "above_3_percent", &SceneScore::all, &ErrorShares::above_3_percent},
      {"above 10 %", "above_10_percent", &SceneScore::all, &ErrorShares::above_10_percent},
      {"edges above 3 %", "edge_above_3_percent", &SceneScore::edges, &ErrorShares::above_3_percent},
      {"edges above 10 %", "edge_above_10_percent", &SceneScore::edges, &ErrorShares::above_10_percent},
      {"other pixels above 3 %", "rest_above_3_percent", &SceneScore::rest, &ErrorShares::above_3_percent},
      {"other pixels above 10 %", "rest_above_10_percent", &SceneScore::rest, &ErrorShares::above_10_percent},
      {"dim surfaces above 3 %", "dim_above_3_percent", &SceneScore::dims, &ErrorShares::above_3_percent},
      {"single pixels above 10 %", "single_above_10_percent", &SceneScore::singles,
       &ErrorShares::above_10_percent}};
  return figures;
}

ComparedScores::ComparedScores(std::vector<std::string> scenes, std::vector<ComparedRow> rows)
    : scenes_(std::move(scenes)), rows_(std::move(rows)) {}

void ComparedScores::add(std::size_t scene, std::size_t row, const SceneScore& score) {
  scores_[{scene, row}].push_back(score);
}

std::optional<std::size_t> ComparedScores::row(const std::string& title) const {
  const auto found = std::ranges::find(rows_, title, &ComparedRow::title);
  return found == rows_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - rows_.begin()));
}

std::optional<std::size_t> ComparedScores::scene(const std::string& name) const {
  const auto found = std::ranges::find(scenes_, name);
  return found == scenes_.end() ? std::nullopt
                                : std::optional(static_cast<std::size_t>(found - scenes_.begin()));
}

std::vector<std::size_t> ComparedScores::scenes_with_depth() const {
  std::vector<std::size_t> chosen;
  for (std::size_t s = 0; s < scenes_.size(); ++s) {
    if (!is_flat_scene(scenes_[s])) {
      chosen.push_back(s);
    }
  }
  return chosen;
}

std::uint64_t ComparedScores::pixels(const std::vector<std::size_t>& scenes,
                                     const ComparedFigure& figure) const {
  std::uint64_t sum = 0;
  for (const std::size_t scene : scenes) {
    for (const SceneScore& score : scores_.at({scene, 0})) {
      sum += (score.*figure.pixels).pixels;
    }
  }
  return sum;
}

Estimate ComparedScores::estimate(const std::vector<std::size_t>& scenes, std::size_t row,
                                  const ComparedFigure& figure) const {
  const std::uint64_t trials = pixels(scenes, figure);
  if (trials == 0) {
    return {};
  }
  std::vector<double> shares;
  for (std::size_t seed = 0; seed < scores_.at({scenes.front(), row}).size(); ++seed) {
    double judged = 0.0;
    double hits = 0.0;
    for (const std::size_t scene : scenes) {
      const ErrorShares& part = scores_.at({scene, row})[seed].*figure.pixels;
      judged += static_cast<double>(part.pixels);
      hits += static_cast<double>(part.pixels) * part.*figure.share;
    }
    if (judged > 0.0) {
      shares.push_back(hits / judged);
    }
  }
  const double mean = std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size());
  Estimate result =
      estimate_share(static_cast<std::uint64_t>(std::llround(mean * static_cast<double>(trials))), trials);
  result.value = mean;
  if (shares.size() > 1) {
    const Interval spread = estimate_mean(shares).interval;
    result.interval = {std::max(0.0, std::min(result.interval.low, spread.low)),
                       std::min(1.0, std::max(result.interval.high, spread.high))};
  }
  return result;
}

std::vector<std::size_t> accuracy_front(const ComparedScores& scores, const std::vector<std::size_t>& scenes,
                                        const ComparedFigure& figure) {
  struct Point {
    double bits;
    double share;
    std::size_t row;
  };
  std::vector<Point> points;
  for (std::size_t row = 0; row < scores.rows().size(); ++row) {
    const ComparedRow& compared = scores.rows()[row];
    if (compared.bits && compared.kind != ComparedRow::Kind::kReference) {
      points.push_back({*compared.bits, scores.estimate(scenes, row, figure).value, row});
    }
  }
  std::ranges::sort(points, [](const Point& a, const Point& b) {
    return std::pair(a.bits, a.share) < std::pair(b.bits, b.share);
  });
  std::vector<std::size_t> front;
  double best = std::numeric_limits<double>::infinity();
  for (const Point& point : points) {
    if (point.share < best) {
      best = point.share;
      front.push_back(point.row);
    }
  }
  return front;
}

std::vector<std::string> rivals_on_a_front(const std::map<double, ComparedScores>& lights) {
  std::vector<std::string> titles;
  for (const auto& [klux, scores] : lights) {
    const std::vector<std::size_t> scenes = scores.scenes_with_depth();
    if (scenes.empty()) {
      continue;
    }
    for (const std::size_t row : accuracy_front(scores, scenes, compared_figures()[0])) {
      const ComparedRow& compared = scores.rows()[row];
      if (compared.kind == ComparedRow::Kind::kRival &&
          std::ranges::find(titles, compared.title) == titles.end()) {
        titles.push_back(compared.title);
      }
    }
  }
  return titles;
}

Table overall_table(const ComparedScores& scores) {
  std::vector<std::string> header = {"estimator", "bits a pixel"};
  for (const ComparedFigure& figure : compared_figures()) {
    header.emplace_back(figure.name);
  }
  Table table(std::move(header));
  const std::vector<std::size_t> scenes = scores.scenes_with_depth();
  for (std::size_t row = 0; row < scores.rows().size(); ++row) {
    std::vector<std::string> cells = {scores.rows()[row].title, bits_text(scores.rows()[row])};
    for (const ComparedFigure& figure : compared_figures()) {
      cells.push_back(scores.pixels(scenes, figure) == 0 ? kMissing
                                                         : share_text(scores.estimate(scenes, row, figure)));
    }
    table.add(std::move(cells));
  }
  return table;
}

Table scene_by_scene_table(const ComparedScores& scores) {
  std::vector<std::string> header = {"estimator"};
  header.insert(header.end(), scores.scenes().begin(), scores.scenes().end());
  Table table(std::move(header));
  const ComparedFigure& first = compared_figures()[0];
  const ComparedFigure& second = compared_figures()[1];
  for (std::size_t row = 0; row < scores.rows().size(); ++row) {
    std::vector<std::string> cells = {scores.rows()[row].title};
    for (std::size_t scene = 0; scene < scores.scenes().size(); ++scene) {
      cells.push_back(fmt::format("{:.2f} / {:.2f}", 100.0 * scores.estimate({scene}, row, first).value,
                                  100.0 * scores.estimate({scene}, row, second).value));
    }
    table.add(std::move(cells));
  }
  return table;
}

Table front_table(const ComparedScores& scores) {
  Table table({"estimator", "what it is", "bits a pixel", "above 3 %", "above 10 %"}, 2);
  const std::vector<std::size_t> scenes = scores.scenes_with_depth();
  for (const std::size_t row : accuracy_front(scores, scenes, compared_figures()[0])) {
    table.add({scores.rows()[row].title, std::string(kind_name(scores.rows()[row].kind)),
               bits_text(scores.rows()[row]), share_text(scores.estimate(scenes, row, compared_figures()[0])),
               share_text(scores.estimate(scenes, row, compared_figures()[1]))});
  }
  return table;
}

Table compared_csv(const std::map<double, ComparedScores>& lights) {
  std::vector<std::string> header = {"klux", "scene", "estimator", "kind", "bits_per_pixel", "pixels"};
  for (const ComparedFigure& figure : compared_figures()) {
    for (const char* part : {"", "_low", "_high"}) {
      header.push_back(std::string(figure.column) + part);
    }
  }
  Table csv(std::move(header), 4);
  for (const auto& [klux, scores] : lights) {
    std::vector<std::pair<std::string, std::vector<std::size_t>>> sets;
    if (!scores.scenes_with_depth().empty()) {
      sets.emplace_back("all", scores.scenes_with_depth());
    }
    for (std::size_t scene = 0; scene < scores.scenes().size(); ++scene) {
      sets.emplace_back(scores.scenes()[scene], std::vector<std::size_t>{scene});
    }
    for (const auto& [name, scenes] : sets) {
      for (std::size_t row = 0; row < scores.rows().size(); ++row) {
        const ComparedRow& compared = scores.rows()[row];
        std::vector<std::string> cells = {fmt::format("{:g}", klux),
                                          name,
                                          compared.title,
                                          std::string(kind_name(compared.kind)),
                                          compared.bits ? fmt::format("{:g}", *compared.bits) : "",
                                          fmt::format("{}", scores.pixels(scenes, compared_figures()[0]))};
        for (const ComparedFigure& figure : compared_figures()) {
          if (scores.pixels(scenes, figure) == 0) {
            cells.insert(cells.end(), 3, "");
            continue;
          }
          const Estimate share = scores.estimate(scenes, row, figure);
          for (const double value : {share.value, share.interval.low, share.interval.high}) {
            cells.push_back(fmt::format("{:.6f}", value));
          }
        }
        csv.add(std::move(cells));
      }
    }
  }
  return csv;
}

std::string comparison_sentence(const std::map<double, ComparedScores>& lights, const std::string& rival,
                                const std::string& other) {
  std::vector<std::string> parts;
  std::string bits;
  for (const auto& [klux, scores] : lights) {
    const std::optional<std::size_t> a = scores.row(rival);
    const std::optional<std::size_t> b = scores.row(other);
    const std::vector<std::size_t> scenes = scores.scenes_with_depth();
    if (!a || !b || scenes.empty()) {
      return "";
    }
    const Estimate mine = scores.estimate(scenes, *a, compared_figures()[0]);
    const Estimate its = scores.estimate(scenes, *b, compared_figures()[0]);
    const char* verdict = mine.interval.high < its.interval.low   ? "fewer"
                          : mine.interval.low > its.interval.high ? "more"
                                                                  : "no certain difference";
    parts.push_back(fmt::format("{:g} klux {:.2f} against {:.2f} % ({})", klux, 100.0 * mine.value,
                                100.0 * its.value, verdict));
    bits = fmt::format("{} and {} bits a pixel", bits_text(scores.rows()[*a]), bits_text(scores.rows()[*b]));
  }
  return parts.empty() ? ""
                       : fmt::format("{} compared with {} ({}), pixels with an error above 3 %: {}.", rival,
                                     other, bits, fmt::join(parts, ", "));
}

void add_unbiased(WallCounts& counts, double wall_m, std::span<const double> measured_m) {
  const double middle = median({measured_m.begin(), measured_m.end()});
  for (const double measured : measured_m) {
    const double error = std::abs(measured - middle) / wall_m;
    ++counts.pixels;
    counts.above_3_percent += error > kRequirement ? 1 : 0;
    counts.above_10_percent += error > kOutlierError ? 1 : 0;
  }
}

Table claim_table(std::span<const CheckedClaim> claims) {
  Table table({"rival", "3 m: first estimate", "here", "agree", "4 m: first estimate", "here", "agree"});
  for (const CheckedClaim& claim : claims) {
    std::vector<std::string> cells = {claim.title};
    for (const ClaimedShare& share : claimed_shares(claim)) {
      if (share.first) {
        cells.push_back(fmt::format("{:g}", share.percent));
        cells.push_back(share_text(share.here));
        cells.emplace_back(share.agrees() ? "yes" : "no");
      } else {
        cells[cells.size() - 3] += fmt::format(" / {:g}", share.percent);
        cells[cells.size() - 2] += " / " + share_text(share.here);
        cells.back() += share.agrees() ? " / yes" : " / no";
      }
    }
    table.add(std::move(cells));
  }
  return table;
}

std::string claim_sentence(std::span<const CheckedClaim> claims) {
  std::size_t all = 0;
  std::size_t agreeing = 0;
  std::vector<std::string> others;
  for (const CheckedClaim& claim : claims) {
    bool agrees = true;
    for (const ClaimedShare& share : claimed_shares(claim)) {
      ++all;
      agreeing += share.agrees() ? 1 : 0;
      agrees = agrees && share.agrees();
    }
    if (!agrees) {
      others.push_back(claim.title);
    }
  }
  return fmt::format(
      "{} of {} shares agree{}.", agreeing, all,
      others.empty() ? ""
                     : fmt::format("; rivals with a share that does not agree: {}", fmt::join(others, ", ")));
}

}  // namespace dtof
