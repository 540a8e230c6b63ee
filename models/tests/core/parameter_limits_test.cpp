// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parameter_entry.hpp"
#include "dtof/core/parameters.hpp"

namespace dtof {
namespace {

using testing::StartsWith;

struct Row {
  std::string top;
  std::vector<std::pair<std::string, int>> settings;
  std::string sentence;  ///< empty: the settings are legal
};

// The table that scripts/lint_rtl.py tries on the RTL.
std::vector<Row> parameter_limits() {
  std::ifstream file(DTOF_PARAMETER_LIMITS);
  std::string line;
  while (std::getline(file, line) && line != "top,settings,sentence") {
  }
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::size_t top = line.find(',');
    const std::size_t settings = line.find(',', top + 1);
    Row row{.top = line.substr(0, top), .settings = {}, .sentence = line.substr(settings + 1)};
    std::istringstream words(line.substr(top + 1, settings - top - 1));
    for (std::string word; words >> word;) {
      const std::size_t equals = word.find('=');
      row.settings.emplace_back(word.substr(0, equals), std::stoi(word.substr(equals + 1)));
    }
    rows.push_back(row);
  }
  return rows;
}

// Parameters of the array alone: a model does not have them, or has one value of them.
const std::set<std::string> kOfTheArray = {
    "READOUT",       "PIXELS_PER_SRAM",  "SRAM_NUM",      "POINTER_PORTS", "ENGINE_COLUMNS",
    "ACQ_WIDTH",     "RIVAL_MOVES",      "SECOND_TARGET", "AMPLITUDE",     "PRIOR",
    "RAW_HISTOGRAM", "BROADCAST_STAGES", "PARITY"};

// The schedule that dtof_subsystem recommends is the models'.
bool is_schedule(const Row& row) {
  return row.sentence.starts_with("COARSE_SHARE ") || row.sentence.starts_with("TRACK_SHARE ");
}

ReadoutParameters model_parameters(const Row& row) {
  const bool pool = row.top != "dtof_array";
  ReadoutParameters parameters =
      ReadoutParameters::defaults(pool ? Readout::kPoolPointer : Readout::kEzPointer);
  for (const auto& [name, value] : row.settings) {
    if (name == "READOUT" && !pool) {
      // A number of dtof_array is the read-out's place in C++.
      parameters = ReadoutParameters::defaults(static_cast<Readout>(value));
    } else if (const ParameterEntry* const entry = find_parameter_entry(name);
               entry != nullptr && name != "ENGINE_COLUMNS") {
      entry->set(parameters, value);
    } else if (!kOfTheArray.contains(name)) {
      ADD_FAILURE() << "the models have no " << name;
    }
    if (pool && name == "NP") {
      parameters.fraction_bits = 16 - value;  // no parameter of the RTL, where it follows from NP
    }
  }
  return parameters;
}

std::optional<std::string> refusal(const ReadoutParameters& parameters) {
  try {
    parameters.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return std::nullopt;
}

TEST(ParameterLimits, ModelAndRtlRefuseTheSameWithTheSameSentence) {
  int refused = 0;
  int taken = 0;
  for (const Row& row : parameter_limits()) {
    SCOPED_TRACE(row.top + " " + testing::PrintToString(row.settings));
    if (row.top == "dtof_subsystem" && !is_schedule(row)) {
      continue;  // the models have nothing around an array
    }
    if (kOfTheArray.contains(row.sentence.substr(0, row.sentence.find(' ')))) {
      continue;
    }
    const std::optional<std::string> message = refusal(model_parameters(row));
    if (row.sentence.empty()) {
      EXPECT_EQ(message, std::nullopt);
      ++taken;
    } else {
      ASSERT_TRUE(message.has_value()) << row.sentence;
      EXPECT_THAT(*message, StartsWith(row.sentence));
      ++refused;
    }
  }
  // The table was read.
  EXPECT_GT(refused, 40);
  EXPECT_GT(taken, 20);
}

TEST(ParameterLimits, ARefusalNamesTheValue) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh);
  parameters.nb = 11;
  EXPECT_EQ(refusal(parameters), "NB must be 1 to NP, not 11");
  parameters = ReadoutParameters::defaults(Readout::kPoolPointer);
  parameters.pool.group_size = 5;
  EXPECT_EQ(refusal(parameters), "GROUP_SIZE must be a power of two from 4 to 32, not 5");
}

}  // namespace
}  // namespace dtof
