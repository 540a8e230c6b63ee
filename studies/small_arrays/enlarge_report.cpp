// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/report/table.hpp"
#include "small_arrays/enlarge_study.hpp"

namespace dtof {
namespace {

constexpr std::array<EnlargeFigure, 9> kFigures = {
    {{"rmse", "rmse", &SceneScore::all, &ErrorShares::rmse},
     {"above 3 %", "above_3_percent", &SceneScore::all, &ErrorShares::above_3_percent},
     {"above 10 %", "above_10_percent", &SceneScore::all, &ErrorShares::above_10_percent},
     {"edges: rmse", "edge_rmse", &SceneScore::edges, &ErrorShares::rmse},
     {"edges above 3 %", "edge_above_3_percent", &SceneScore::edges, &ErrorShares::above_3_percent},
     {"edges above 10 %", "edge_above_10_percent", &SceneScore::edges, &ErrorShares::above_10_percent},
     {"other pixels: rmse", "rest_rmse", &SceneScore::rest, &ErrorShares::rmse},
     {"other pixels above 3 %", "rest_above_3_percent", &SceneScore::rest, &ErrorShares::above_3_percent},
     {"other pixels above 10 %", "rest_above_10_percent", &SceneScore::rest,
      &ErrorShares::above_10_percent}}};
constexpr std::size_t kJudged = 1;        // the figure that decides which array is best
constexpr std::size_t kWholeFigures = 3;  // those of all pixels

std::string per_cent(const Estimate& estimate) {
  return fmt::format("{:.2f} +-{:.2f}", 100.0 * estimate.value,
                     50.0 * (estimate.interval.high - estimate.interval.low));
}

std::string name_of(const EnlargeEntry& entry) {
  return fmt::format("{}, {}, {}", array_size_title(entry.array), entry.readout, entry.enlarger);
}

Estimate figure_of(const EnlargeEntry& entry, const EnlargeFigure& figure) {
  return estimate_mean(pooled_figure(entry.rows, figure));
}

/// First minus second: all have the seeds of the same photons' scenes.
Estimate difference(std::vector<double> first, const std::vector<double>& second) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    first[i] -= second[i];
  }
  return estimate_mean(first);
}

/// The word for a difference of errors with its interval.
const char* verdict(const Estimate& gap) {
  if (gap.interval.high < 0.0) {
    return "better";
  }
  return gap.interval.low > 0.0 ? "worse" : "not better or worse";
}

/// Which entries compete.
using Wanted = std::function<bool(const EnlargeEntry&)>;

/// The entry with least of a figure among those wanted.
const EnlargeEntry& best_of(const std::vector<EnlargeEntry>& entries, const EnlargeFigure& figure,
                            const Wanted& wanted) {
  const EnlargeEntry* best = nullptr;
  double least = 0.0;
  for (const EnlargeEntry& entry : entries) {
    if (!wanted(entry)) {
      continue;
    }
    const double value = figure_of(entry, figure).value;
    if (best == nullptr || value < least) {
      best = &entry;
      least = value;
    }
  }
  if (best == nullptr) {
    throw InputError("enlarge: there is no small array to compare with");
  }
  return *best;
}

/// The small arrays, in their order.
std::vector<ArraySize> small_arrays(const std::vector<EnlargeEntry>& entries) {
  std::vector<ArraySize> arrays;
  for (const EnlargeEntry& entry : entries) {
    if (entry.array != entries.front().array && std::ranges::find(arrays, entry.array) == arrays.end()) {
      arrays.push_back(entry.array);
    }
  }
  return arrays;
}

/// What was measured with one array.
Wanted measured_with(const ArraySize& array) {
  return [array](const EnlargeEntry& entry) { return entry.array == array && entry.readout != kNoError; };
}

Estimate gap_of(const EnlargeEntry& first, const EnlargeEntry& second, const EnlargeFigure& figure) {
  return difference(pooled_figure(first.rows, figure), pooled_figure(second.rows, figure));
}

/// Maps on which a small array is better or worse than the large one beyond the interval of the difference.
struct MapCount {
  int better = 0;
  int worse = 0;
};

MapCount count_maps(const EnlargeEntry& small, const EnlargeEntry& large, const EnlargeFigure& figure) {
  MapCount count;
  for (std::size_t i = 0; i < small.rows.size(); ++i) {
    const Estimate estimate = difference(pooled_figure(std::span(&small.rows[i], 1), figure),
                                         pooled_figure(std::span(&large.rows[i], 1), figure));
    count.better += estimate.interval.high < 0.0 ? 1 : 0;
    count.worse += estimate.interval.low > 0.0 ? 1 : 0;
  }
  return count;
}

/// How often the learned enlarger has least of a figure among the enlargers of an array and read-out.
struct LearnedCount {
  int best = 0;
  int all = 0;
};

LearnedCount count_learned(const std::vector<EnlargeEntry>& entries, const EnlargeFigure& figure) {
  LearnedCount count;
  for (const EnlargeEntry& entry : entries) {
    if (entry.enlarger != kLearned || entry.readout == kNoError) {
      continue;
    }
    const double learned = figure_of(entry, figure).value;
    const bool best = std::ranges::none_of(entries, [&](const EnlargeEntry& other) {
      return other.array == entry.array && other.readout == entry.readout &&
             figure_of(other, figure).value < learned;
    });
    count.best += best ? 1 : 0;
    ++count.all;
  }
  return count;
}

/// How the learned enlarger fares with one small array.
PageData learned_data(const std::vector<EnlargeEntry>& entries, const ArraySize& array) {
  const EnlargeFigure& judged = kFigures[kJudged];
  const Wanted measured = measured_with(array);
  const EnlargeEntry& learned = best_of(entries, judged, [&](const EnlargeEntry& entry) {
    return measured(entry) && entry.enlarger == kLearned;
  });
  const EnlargeEntry& other = best_of(entries, judged, [&](const EnlargeEntry& entry) {
    return measured(entry) && entry.enlarger != kLearned;
  });
  const EnlargeEntry& perfect = best_of(entries, judged, [&](const EnlargeEntry& entry) {
    return entry.array == array && entry.readout == kNoError;
  });
  PageData data;
  data.set("array", "{}", array_size_title(array))
      .set("learned_share", "{}", per_cent(figure_of(learned, judged)))
      .set("learned_readout", "{}", learned.readout)
      .set("against_large", "{}", verdict(gap_of(learned, entries.front(), judged)))
      .set("against_others", "{}", verdict(gap_of(learned, other, judged)))
      .set("other_share", "{}", per_cent(figure_of(other, judged)))
      .set("other_readout", "{}", other.readout)
      .set("other_enlarger", "{}", other.enlarger)
      .set("perfect_share", "{:.2f}", 100.0 * figure_of(perfect, judged).value)
      .set("perfect_enlarger", "{}", perfect.enlarger);
  return data;
}

PageData answer_data(const EnlargeLight& light) {
  const std::vector<EnlargeEntry> entries = entries_of(light.study);
  const LearnedCount count = count_learned(entries, kFigures[kJudged]);
  std::vector<PageData> arrays;
  for (const ArraySize& array : small_arrays(entries)) {
    arrays.push_back(learned_data(entries, array));
  }
  PageData data;
  data.set("klux", "{:g}", light.klux)
      .set("large_share", "{}", per_cent(figure_of(entries.front(), kFigures[kJudged])))
      .set("learned_best", "{}", count.best)
      .set("learned_cases", "{}", count.all)
      .list("arrays", std::move(arrays));
  return data;
}

/// "14 klux: none; 50 klux: 100 x 80": small arrays whose learned maps are better than the large array's.
std::string winners(std::span<const EnlargeLight> lights) {
  std::vector<std::string> texts;
  for (const EnlargeLight& light : lights) {
    const std::vector<EnlargeEntry> entries = entries_of(light.study);
    std::vector<std::string> better;
    for (const ArraySize& array : small_arrays(entries)) {
      const Wanted measured = measured_with(array);
      const EnlargeEntry& learned = best_of(entries, kFigures[kJudged], [&](const EnlargeEntry& entry) {
        return measured(entry) && entry.enlarger == kLearned;
      });
      if (gap_of(learned, entries.front(), kFigures[kJudged]).interval.high < 0.0) {
        better.push_back(array_size_title(array));
      }
    }
    texts.push_back(fmt::format("{:g} klux: {}", light.klux,
                                better.empty() ? "none" : fmt::format("{}", fmt::join(better, ", "))));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// For each light, figure of all pixels and small array: the best map of the array beside the large array's.
Table best_of_each_array(std::span<const EnlargeLight> lights) {
  Table table({"klux", "figure, %", "large array", "best of the small array", "small array", "difference",
               "verdict", "better on", "worse on"},
              2);
  for (const EnlargeLight& light : lights) {
    const std::vector<EnlargeEntry> entries = entries_of(light.study);
    const EnlargeEntry& large = entries.front();
    const std::vector<ArraySize> arrays = small_arrays(entries);
    for (std::size_t f = 0; f < kWholeFigures; ++f) {
      for (const ArraySize& array : arrays) {
        const EnlargeEntry& small = best_of(entries, kFigures[f], measured_with(array));
        const Estimate gap = gap_of(small, large, kFigures[f]);
        const MapCount maps = count_maps(small, large, kFigures[f]);
        const auto of = [&](int count) { return fmt::format("{} of {} maps", count, large.rows.size()); };
        table.add({fmt::format("{:g}", light.klux), kFigures[f].title,
                   per_cent(figure_of(large, kFigures[f])), name_of(small),
                   per_cent(figure_of(small, kFigures[f])), per_cent(gap), verdict(gap), of(maps.better),
                   of(maps.worse)});
      }
    }
  }
  return table;
}

Table all_maps(const std::vector<EnlargeEntry>& entries) {
  std::vector<std::string> header = {"array", "read-out", "enlarger"};
  for (const EnlargeFigure& figure : kFigures) {
    header.emplace_back(figure.title);
  }
  Table table(std::move(header), 3);
  for (const EnlargeEntry& entry : entries) {
    std::vector<std::string> row = {array_size_title(entry.array), entry.readout, entry.enlarger};
    for (const EnlargeFigure& figure : kFigures) {
      row.push_back(per_cent(figure_of(entry, figure)));
    }
    table.add(std::move(row));
  }
  return table;
}

/// The large array, and the small ones with its read-out.
Table map_by_map(const std::vector<EnlargeEntry>& entries) {
  const EnlargeEntry& large = entries.front();
  std::vector<std::string> header = {"array", "read-out", "enlarger"};
  for (const EnlargeRow* const row : large.rows) {
    header.push_back(row->scene);
  }
  Table table(std::move(header), 3);
  for (const EnlargeEntry& entry : entries) {
    if (&entry != &large && entry.readout != large.readout) {
      continue;
    }
    std::vector<std::string> cells = {array_size_title(entry.array), entry.readout, entry.enlarger};
    for (const EnlargeRow* const& row : entry.rows) {
      const auto value = [&](std::size_t f) {
        return 100.0 * estimate_mean(pooled_figure(std::span(&row, 1), kFigures[f])).value;
      };
      cells.push_back(fmt::format("{:.2f} / {:.2f}", value(1), value(2)));
    }
    table.add(std::move(cells));
  }
  return table;
}

}  // namespace

std::span<const EnlargeFigure> enlarge_figures() { return kFigures; }

std::vector<double> pooled_figure(std::span<const EnlargeRow* const> rows, const EnlargeFigure& figure) {
  std::vector<double> values;
  for (std::size_t seed = 0; seed < rows.front()->seeds.size(); ++seed) {
    const bool root = figure.value == &ErrorShares::rmse;
    double pixels = 0.0;
    double sum = 0.0;
    for (const EnlargeRow* const row : rows) {
      const ErrorShares& part = row->seeds[seed].*figure.pixels;
      const double value = part.*figure.value;
      pixels += static_cast<double>(part.pixels);
      sum += static_cast<double>(part.pixels) * (root ? value * value : value);
    }
    const double mean = pixels > 0.0 ? sum / pixels : 0.0;
    values.push_back(root ? std::sqrt(mean) : mean);
  }
  return values;
}

std::vector<EnlargeEntry> entries_of(const EnlargeStudy& study) {
  std::vector<EnlargeEntry> entries;
  for (const EnlargeRow& row : study.rows) {
    const auto same = std::ranges::find_if(entries, [&](const EnlargeEntry& entry) {
      return entry.array == row.array && entry.readout == row.readout && entry.enlarger == row.enlarger;
    });
    (same == entries.end() ? entries.emplace_back(EnlargeEntry{row.array, row.readout, row.enlarger, {}})
                           : *same)
        .rows.push_back(&row);
  }
  return entries;
}

void add_enlarge_results(std::span<const EnlargeLight> lights, PageData& page) {
  std::vector<PageData> answers;
  std::vector<PageData> tables;
  for (const EnlargeLight& light : lights) {
    const std::vector<EnlargeEntry> entries = entries_of(light.study);
    answers.push_back(answer_data(light));
    tables.emplace_back()
        .set("klux", "{:g}", light.klux)
        .set("all_maps", all_maps(entries))
        .set("map_by_map", map_by_map(entries));
  }
  page.set("winners", "{}", winners(lights))
      .list("answers", std::move(answers))
      .set("best_of_each_array", best_of_each_array(lights))
      .list("lights", std::move(tables));
}

std::string enlarge_csv(std::span<const EnlargeLight> lights) {
  std::vector<std::string> header = {"klux", "scene", "array", "readout", "enlarger", "pixels"};
  for (const EnlargeFigure& figure : kFigures) {
    for (const char* part : {"", "_low", "_high"}) {
      header.push_back(std::string(figure.column) + part);
    }
  }
  Table table(std::move(header), 5);
  for (const EnlargeLight& light : lights) {
    for (const EnlargeRow& row : light.study.rows) {
      const EnlargeRow* const one = &row;
      std::vector<std::string> cells = {fmt::format("{:g}", light.klux),
                                        row.scene,
                                        array_size_title(row.array),
                                        row.readout,
                                        row.enlarger,
                                        fmt::format("{}", row.seeds.front().all.pixels)};
      for (const EnlargeFigure& figure : kFigures) {
        const Estimate estimate = estimate_mean(pooled_figure(std::span(&one, 1), figure));
        for (const double value : {estimate.value, estimate.interval.low, estimate.interval.high}) {
          cells.push_back(fmt::format("{:.6f}", value));
        }
      }
      table.add(std::move(cells));
    }
  }
  return table.csv();
}

}  // namespace dtof
