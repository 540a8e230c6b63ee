// SPDX-License-Identifier: Apache-2.0
#include "design_judgement/judgement_store.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "dtof/io/atomic_file.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/report/table.hpp"

namespace dtof {
namespace {

std::string exact_text(double value) { return fmt::format("{:.17g}", value); }

/// Adds fields to a line, and their names to the header.
class Line {
 public:
  void add(const std::string& name, const std::string& value) {
    names_.push_back(name);
    values_.push_back(value);
  }
  void add(const std::string& name, double value) { add(name, exact_text(value)); }
  void add(const std::string& name, const Estimate& estimate) {
    add(name, estimate.value);
    add(name + "_low", estimate.interval.low);
    add(name + "_high", estimate.interval.high);
  }
  void add(const std::string& name, const JudgedCandidate& candidate) {
    add(name, candidate.name);
    add(name + "_share", candidate.share);
    add(name + "_mm2", candidate.mm2);
    add(name + "_place", static_cast<double>(candidate.place));
  }
  [[nodiscard]] std::string csv() const {
    Table table(names_);
    table.add(values_);
    return table.csv();
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::string> values_;
};

class Stored {
 public:
  explicit Stored(const std::filesystem::path& file) : table_(file) {}

  [[nodiscard]] double number(const std::string& name) const { return table_.column(name).front(); }
  [[nodiscard]] std::size_t count(const std::string& name) const {
    return static_cast<std::size_t>(number(name));
  }
  [[nodiscard]] Estimate estimate(const std::string& name) const {
    return {number(name), {number(name + "_low"), number(name + "_high")}};
  }
  [[nodiscard]] JudgedCandidate candidate(const std::string& name) const {
    return {.name = table_.texts(name).front(),
            .share = estimate(name + "_share"),
            .mm2 = number(name + "_mm2"),
            .place = count(name + "_place")};
  }

 private:
  CsvTable table_;
};

}  // namespace

void store_judgement(const std::filesystem::path& file, const SensorJudgement& judgement) {
  Line line;
  line.add("recommended", judgement.recommended);
  line.add("best", judgement.best);
  line.add("ratio", judgement.ratio);
  line.add("grid", static_cast<double>(judgement.grid));
  line.add("kept", static_cast<double>(judgement.kept));
  line.add("read", static_cast<double>(judgement.read));
  line.add("keeps_limits", judgement.keeps_limits ? 1.0 : 0.0);
  line.add("lost", static_cast<double>(judgement.lost));
  line.add("search_best", judgement.search_best);
  line.add("search_other", judgement.search_other);
  write_file(file, line.csv());
}

SensorJudgement stored_judgement(const std::filesystem::path& file) {
  const Stored stored(file);
  return {.grid = stored.count("grid"),
          .kept = stored.count("kept"),
          .read = stored.count("read"),
          .keeps_limits = stored.number("keeps_limits") != 0.0,
          .recommended = stored.candidate("recommended"),
          .best = stored.candidate("best"),
          .ratio = stored.estimate("ratio"),
          .lost = static_cast<Lost>(stored.count("lost")),
          .search_best = stored.number("search_best"),
          .search_other = stored.number("search_other")};
}

}  // namespace dtof
